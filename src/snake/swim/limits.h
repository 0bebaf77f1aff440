// SPDX-License-Identifier: MIT
//
// Checks of the limits that a problem sets to gaits and steering. Error: MORAY_INPUT naming the limit, its value and
// what is allowed.
#ifndef SRC_SNAKE_SWIM_LIMITS_H
#define SRC_SNAKE_SWIM_LIMITS_H

#include "moray/ocp.h"

// A range within least..most; the text is in units of `unit`.
moray_status moray_limits_check_range(const char *name, moray_bounds range, double least, double most, double unit);

moray_status moray_limits_check_above_zero(const char *name, double value);

// Ranges of theta_max of (24), omega and delta [rad], [rad/s], [rad].
moray_status moray_limits_check_gait(moray_bounds theta_max, moray_bounds omega, moray_bounds delta);

#endif
