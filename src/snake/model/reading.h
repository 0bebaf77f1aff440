// SPDX-License-Identifier: MIT
//
// The control-oriented model as printed, errata and all.
#ifndef SRC_SNAKE_MODEL_READING_H
#define SRC_SNAKE_MODEL_READING_H

#include "moray/snake/model.h"

// The robot whose L = 2l is the l that (8), (12) and (13) mean in this reading.
moray_robot moray_reading_robot(const moray_robot *robot, moray_reading reading);

// What (23h) as printed gives for dv_n beyond (16c), in a regular state x[2N+4].
double moray_reading_23h_excess(const moray_robot *robot, const double current[2], const double *x);

#endif
