// SPDX-License-Identifier: MIT
#ifndef SRC_OCP_DIFFERENCES_H
#define SRC_OCP_DIFFERENCES_H

#include "ocp/solution.h"

// *worst: the largest disagreement between the derivatives of the programme at the solution and differences of its
// functions along directions that move every variable at once, and so trust no pattern. Error: MORAY_MEMORY.
moray_status moray_difference_solution(const moray_solution *solution, double *worst);

#endif
