// SPDX-License-Identifier: MIT
#ifndef SRC_OCP_RINGING_H
#define SRC_OCP_RINGING_H

#include "ocp/solution.h"

// 1 + the first control, counted through the phases, that goes to and fro within a few nodes time and again; 0: none.
// Where a finer mesh shows it again it is not the control that moves: on singular arcs the conditions at the nodes of
// Lobatto schemes say little of a control that alternates.
int moray_find_ringing(const moray_solution *solution);

#endif
