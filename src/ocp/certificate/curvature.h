// SPDX-License-Identifier: MIT
#ifndef SRC_OCP_CURVATURE_H
#define SRC_OCP_CURVATURE_H

#include "ocp/certificate/witness.h"

// *worst: how far the Lagrangian bends down along a direction that the active constraints leave free, 0 at a minimum,
// NAN where no factorisation tells: minus d' H d for d' S d = 1, where H is in sizes of variables and objective and S
// weighs nodes as their parts of the phase. direction[columns], unless NULL: where it does, in user units, its largest
// entry of the size of its variable; 0 at a minimum. Error: MORAY_MEMORY.
moray_status moray_measure_curvature(const struct witness *w, double *worst, double *direction);

#endif
