// SPDX-License-Identifier: MIT
#ifndef SRC_OCP_BENDS_H
#define SRC_OCP_BENDS_H

#include "ocp/certificate/witness.h"

// The Hessian that inertia is told by, node by node and at the endpoint: what it makes of a few dense directions
// against second differences of the functions, weighted as the Lagrangian weighs them. Raises *worst to a hundredth of
// the largest disagreement, relative to what is found and to what would matter to the curvature; where[size] says where
// it is. Costs some 60 evaluations of the functions a node, however wide they are. Error: MORAY_MEMORY.
moray_status moray_difference_bends(const struct witness *w, double *worst, char *where, int size);

#endif
