// SPDX-License-Identifier: MIT
#ifndef SRC_OCP_DIFFERENCES_H
#define SRC_OCP_DIFFERENCES_H

#include "ocp/certificate/witness.h"

// *worst: the largest disagreement between the derivatives of the programme at the solution and differences of its
// functions along directions that move every variable at once, and so trust no pattern. Error: MORAY_MEMORY.
moray_status moray_difference_solution(const struct witness *w, double *worst);

// *worst: the largest disagreement of a derivative in use at a node or at the endpoint with the witness's, relative to
// what its function moves by; where[size] says which. *untold: the share of those that are not 0 that the witness says
// nothing of. Error: MORAY_MEMORY.
moray_status moray_compare_columns(const struct witness *w, double *worst, double *untold, char *where, int size);

#endif
