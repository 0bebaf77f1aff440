// SPDX-License-Identifier: MIT
#ifndef PROBLEMS_SWEEP_POINT_H
#define PROBLEMS_SWEEP_POINT_H

#include "sweep/arguments.h"

// Keys of a current: its two components, or its speed and where it flows to.
#define CURRENT_X "current_x"
#define CURRENT_Y "current_y"
#define CURRENT_SPEED "current_speed"
#define CURRENT_DEG "current_deg"

// One run of the program for a point, in this process: its settings as --set, robot as --robot, those of the current
// together as --current; a moray_sweep_fn with the arguments as `self`.
moray_status sweep_run_program(const moray_sweep_point *point, FILE *summary, void *arguments);

#endif
