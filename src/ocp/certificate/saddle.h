// SPDX-License-Identifier: MIT
#ifndef SRC_OCP_SADDLE_H
#define SRC_OCP_SADDLE_H

#include "ocp/solution.h"

// Where a solution is a saddle or a maximum, moves its iterate along the direction that bends down most, within its
// bounds; kept[columns] is where it stood. Error: MORAY_MEMORY.
moray_status moray_leave_saddle(moray_solution *solution, double *kept, bool *moved);

#endif
