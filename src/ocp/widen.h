// SPDX-License-Identifier: MIT
#ifndef SRC_OCP_WIDEN_H
#define SRC_OCP_WIDEN_H

#include "ocp/transcription.h"

// Looks at the functions of the problem where the caches of t are. Where they depend on more than their patterns know,
// the problem gets wider ones, for transcriptions to come: t keeps those that it was made of. *found: how many
// dependences are new. Maps that the user gave are left as they are. Error: MORAY_MEMORY.
moray_status moray_widen_patterns(const struct transcription *t, int *found);

#endif
