// SPDX-License-Identifier: MIT
//
// MUMPS keeps its state in global variables: one thread at a time. A callback may solve a problem of its own.
#ifndef SRC_NLP_MUMPS_LOCK_H
#define SRC_NLP_MUMPS_LOCK_H

void moray_mumps_lock(void);
void moray_mumps_unlock(void);

#endif
