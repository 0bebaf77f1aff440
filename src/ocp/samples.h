// SPDX-License-Identifier: MIT
//
// Guesses that own their samples.
#ifndef SRC_OCP_SAMPLES_H
#define SRC_OCP_SAMPLES_H

#include "ocp/problem.h"

// Room for rows[p] samples of every phase; with = true also for parameters. Fill through the pointers, which guess
// borrows and moray_guess_free frees. Error: MORAY_MEMORY.
struct samples {
    double *time, *x, *u;
};
moray_status moray_guess_allocate(moray_guess *guess, const moray_ocp *ocp, const int *rows, bool parameters,
                                  struct samples *phase, double **s);

#endif
