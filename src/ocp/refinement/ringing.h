// SPDX-License-Identifier: MIT
#ifndef SRC_OCP_RINGING_H
#define SRC_OCP_RINGING_H

#include "ocp/solution.h"

// 1 + the control, counted through the phases, that goes to and fro most within a few nodes time and again; 0: none
// does. *swing: how far from one turn to the next, of its range, and as a mean over the phase. Where a finer mesh shows
// as much it is not the control that moves: on singular arcs the conditions at the nodes of some schemes say little of
// a control that alternates.
int moray_find_ringing(const moray_solution *solution, double *swing);

#endif
