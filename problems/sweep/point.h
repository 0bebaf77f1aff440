// SPDX-License-Identifier: MIT
#ifndef PROBLEMS_SWEEP_POINT_H
#define PROBLEMS_SWEEP_POINT_H

#include "sweep/arguments.h"

// One run of the program for a point, in this process: its settings as --set, robot as --robot, current_x and
// current_y, or current_speed and current_deg (whereto it flows), together as --current; a moray_sweep_fn with the
// arguments as `self`.
moray_status sweep_run_program(const moray_sweep_point *point, FILE *summary, void *arguments);

#endif
