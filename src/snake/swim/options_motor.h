// SPDX-License-Identifier: MIT
#ifndef SRC_SNAKE_SWIM_OPTIONS_MOTOR_H
#define SRC_SNAKE_SWIM_OPTIONS_MOTOR_H

#include "moray/snake/options.h"

moray_motor_options moray_motor_options_default(void);

// Motor and supply of the robot. Error: MORAY_INPUT (table).
moray_status moray_motor_make(const moray_motor_options *given, moray_robot *robot);

#endif
