// SPDX-License-Identifier: MIT
#ifndef SRC_OCP_SECOND_START_H
#define SRC_OCP_SECOND_START_H

#include "ocp/solution.h"

// Where straight lines between the bounds lead nowhere: what the dynamics do from the guessed start, in the guessed
// times, with controls off the middle of their bounds, which keeps to no symmetry. Not guess->phase where they leave
// what is finite. Free with moray_guess_free. Error: MORAY_MEMORY.
moray_status moray_second_start(const moray_solution *failed, moray_guess *guess);

#endif
