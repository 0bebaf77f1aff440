// SPDX-License-Identifier: MIT
#ifndef MORAY_ANGLE_H
#define MORAY_ANGLE_H

#define MORAY_DEGREE (3.14159265358979323846 / 180) // [rad]

#endif
