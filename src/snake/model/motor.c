// SPDX-License-Identifier: MIT
#include "moray/snake/motor.h"

#include <math.h>

#include "snake/model/model.h"

#define REAL double
#define TYPED(name) name##_d
#include "snake/model/fp_motor.inc"
#undef REAL
#undef TYPED

moray_status moray_motor_check(const moray_motor *motor)
{
    const struct {
        const char *name;
        double value, least, most;
        bool open; // the least itself is not allowed
    } of[] = {{"forward efficiency", motor->forward, 0, 1, true},
              {"backward efficiency", motor->backward, 0, 1, false},
              {"friction", motor->friction, 0, INFINITY, false},
              {"viscous friction", motor->viscous, 0, INFINITY, false},
              {"copper", motor->copper, 0, INFINITY, false},
              {"smooth_rate", motor->smooth_rate, 0, INFINITY, true},
              {"smooth_power", motor->smooth_power, 0, INFINITY, true}};
    if (motor->lines < 0 || motor->lines > MORAY_MOTOR_LINES)
        return moray_error(MORAY_INPUT, "motor: %d lines of torque over speed: must be 0 to %d", motor->lines,
                           MORAY_MOTOR_LINES);
    if (!motor->fitted && motor->lines > 0)
        return moray_error(MORAY_INPUT, "motor: %d lines of torque over speed, but none is fitted", motor->lines);
    for (int k = 0; k < motor->lines; k++)
        if (!(motor->torque[k] > 0 && motor->slope[k] >= 0) || !isfinite(motor->torque[k]) ||
            !isfinite(motor->slope[k]))
            return moray_error(
                MORAY_INPUT,
                "motor: line %d: torque = %g N m, slope = %g N m s/rad: must be finite, the torque above "
                "0, the slope at least 0",
                k + 1, motor->torque[k], motor->slope[k]);
    for (unsigned k = 0; k < sizeof of / sizeof *of && motor->fitted; k++)
        if (!isfinite(of[k].value) || of[k].value < of[k].least || of[k].value > of[k].most ||
            (of[k].open && of[k].value == of[k].least))
            return moray_error(MORAY_INPUT, "motor: %s = %g: must be %s %g and at most %g", of[k].name, of[k].value,
                               of[k].open ? "above" : "at least", of[k].least, of[k].most);
    return moray_ok();
}

moray_status moray_supply_check(const moray_supply *supply)
{
    const struct {
        const char *name, *unit;
        double value;
        bool any; // infinite is allowed
    } of[] = {{"constant power", "W", supply->constant, false},
              {"battery", "Wh", supply->battery, false},
              {"joint rate", "rad/s", supply->rate, true}};
    for (unsigned k = 0; k < sizeof of / sizeof *of; k++)
        if (!(of[k].value >= 0) || (isinf(of[k].value) && !of[k].any))
            return moray_error(MORAY_INPUT, "supply: %s = %g %s: must be %sat least 0", of[k].name, of[k].value,
                               of[k].unit, of[k].any ? "" : "finite and ");
    return moray_ok();
}

double moray_motor_torque(const moray_motor *motor, double u, double v)
{
    double slope;
    return motor->fitted ? u + friction_d(motor, v, &slope) : u;
}

double moray_motor_power(const moray_motor *motor, double u, double v)
{
    return terminals_d(motor, u, v).value;
}

double moray_motor_load(const moray_motor *motor, double u, double v)
{
    double most = 0, slope;
    for (int k = 0; k < motor->lines; k++)
        most = fmax(most, fabs(u + friction_d(motor, v, &slope) + motor->slope[k] * v) / motor->torque[k]);
    return most;
}

moray_status moray_motor_set_table(moray_motor *motor, const double *speed, const double *torque, int n)
{
    double before = 0;
    if (n < 2 || n > MORAY_MOTOR_LINES + 1)
        return moray_error(MORAY_INPUT, "a motor's table of %d points: must have 2 to %d", n, MORAY_MOTOR_LINES + 1);
    if (speed[0] != 0)
        return moray_error(MORAY_INPUT, "a motor's table: begins at a speed of %g: must begin at rest, 0", speed[0]);
    for (int k = 0; k + 1 < n; k++) {
        const double slope = (torque[k] - torque[k + 1]) / (speed[k + 1] - speed[k]);
        if (!(speed[k + 1] > speed[k]) || !(torque[k] > 0) || !(torque[k + 1] >= 0) || !(slope >= 0))
            return moray_error(MORAY_INPUT,
                               "a motor's table, point %d: speeds must rise and torques fall, to 0 at the last at the "
                               "earliest",
                               k + 2);
        if (slope < before)
            return moray_error(MORAY_INPUT,
                               "a motor's table, point %d: torque falls less steeply than before: must be concave",
                               k + 2);
        before = motor->slope[k] = slope;
        motor->torque[k] = torque[k] + slope * speed[k];
    }
    motor->lines = n - 1;
    return moray_ok();
}
