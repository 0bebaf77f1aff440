// SPDX-License-Identifier: MIT
//
// The keys of [motor] and [battery].
#include "snake/swim/options_motor.h"

#include <math.h>

#include "moray/angle.h"

moray_motor_options moray_motor_options_default(void)
{
    moray_motor_options none = {.efficiency = NAN,
                                .back_efficiency = NAN,
                                .friction = NAN,
                                .viscous = NAN,
                                .constant = INFINITY,
                                .rate = INFINITY,
                                .smooth_rate = 5 * MORAY_DEGREE,
                                .smooth_power = 5e-3,
                                .battery = NAN};
    for (int k = 0; k < MORAY_MOTOR_LINES + 1; k++)
        none.speed[k] = none.torque[k] = NAN;
    return none;
}

static int length(const double *list)
{
    int n = 0;
    while (n < MORAY_MOTOR_LINES + 1 && !isnan(list[n]))
        n++;
    return n;
}

static moray_status make_table(const moray_motor_options *given, moray_motor *motor)
{
    const int speeds = length(given->speed), torques = length(given->torque);
    if (speeds != torques)
        return moray_error(MORAY_INPUT,
                           "motor_speed_deg_s, motor_torque_N_m: %d and %d numbers: must be as many, a torque for each "
                           "speed",
                           speeds, torques);
    return speeds > 0 ? moray_motor_set_table(motor, given->speed, given->torque, speeds) : moray_ok();
}

static double or_else(double value, double other)
{
    return isnan(value) ? other : value;
}

moray_status moray_motor_make(const moray_motor_options *given, moray_robot *robot)
{
    moray_motor motor = {.forward = or_else(given->efficiency, 1),
                         .backward = or_else(given->back_efficiency, isnan(given->efficiency) ? 1 : 0),
                         .friction = or_else(given->friction, 0),
                         .viscous = or_else(given->viscous, 0),
                         .copper = 1 / (given->constant * given->constant),
                         .smooth_rate = given->smooth_rate,
                         .smooth_power = given->smooth_power};
    MORAY_TRY(make_table(given, &motor));
    motor.fitted = !isnan(given->efficiency) || !isnan(given->back_efficiency) || !isnan(given->friction) ||
                   !isnan(given->viscous) || motor.copper > 0 || motor.lines > 0;
    robot->motor = motor;
    robot->supply = (moray_supply){.rate = given->rate,
                                   .constant = given->hotel + (robot->links - 1) * given->idle,
                                   .battery = or_else(given->battery, 0)};
    return moray_ok();
}
