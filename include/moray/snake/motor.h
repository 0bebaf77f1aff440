// SPDX-License-Identifier: MIT
//
// The motor behind a joint of the first-principles model: what it draws at its terminals, and what it can give. At the
// joint it turns at v = phi' and gives the torque u of (5a) and its own friction,
//     u_m = u + friction sgn v + viscous v,
// sgn smoothed to v/sqrt(v^2 + smooth_rate^2). The power u_m v of the gear is drawn as u_m v / forward where the motor
// drives, and backward u_m v is given back where it is driven; with copper u_m^2 of the winding. In one formula, p =
// u_m v,
//     P = (1/forward + backward)/2 p + (1/forward - backward)/2 |p| + copper u_m^2,
// |p| smoothed to sqrt(p^2 + smooth_power^2) - smooth_power.
#ifndef MORAY_SNAKE_MOTOR_H
#define MORAY_SNAKE_MOTOR_H

#include "moray/export.h"
#include "moray/status.h"

MORAY_BEGIN

enum { MORAY_MOTOR_LINES = 8 };

typedef struct moray_motor {
    bool fitted;              // or the power is that of the joints, u v, and all else is as if it were not there
    double forward, backward; // efficiency of the gear in either direction, above 0 to 1 and 0 to 1
    double friction, viscous; // [N m], [N m s/rad]
    double copper;            // 1/K_m^2 of the motor constant at the joint [W/(N m)^2]
    double smooth_rate;       // [rad/s]
    double smooth_power;      // [W]
    int lines;                // of the speed and torque that the supply allows, each
    double torque[MORAY_MOTOR_LINES], slope[MORAY_MOTOR_LINES]; // |u_m + slope v| <= torque; [N m], [N m s/rad]
} moray_motor;

// What feeds the robot: `constant`, the power that it draws whatever the joints do, electronics and hotel load, counts
// in the work per distance over ground of a thriftiest gait, not in powers of joints or motors.
typedef struct moray_supply {
    double constant; // [W]
    double battery;  // [Wh]; 0: none
    double rate;     // what every joint of the first-principles model can turn at [rad/s]; 0 or infinite: no limit
} moray_supply;

// Error of both: MORAY_INPUT naming the field that is not usable, its value and what is allowed; a motor that is not
// fitted is good unless it has lines.
MORAY_API moray_status moray_motor_check(const moray_motor *motor);
MORAY_API moray_status moray_supply_check(const moray_supply *supply);

// What the motor gives where the joint takes u, its friction besides; u where none is fitted [N m].
MORAY_API double moray_motor_torque(const moray_motor *motor, double u, double v);

// Power at the terminals [W].
MORAY_API double moray_motor_power(const moray_motor *motor, double u, double v);

// How near to what the supply allows: the largest |u_m + slope v| / torque; 0 without lines.
MORAY_API double moray_motor_load(const moray_motor *motor, double u, double v);

// Lines through the points (speed, torque) of a table, n >= 2, speed from 0 on [rad/s], torque falling to what is left
// at the last. Error: MORAY_INPUT where the table does not fall, or is not concave.
MORAY_API moray_status moray_motor_set_table(moray_motor *motor, const double *speed, const double *torque, int n);

MORAY_END

#endif
