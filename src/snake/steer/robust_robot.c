// SPDX-License-Identifier: MIT
#include "snake/steer/robust.h"

#include <math.h>
#include <string.h>
#include <tgmath.h>

#include "moray/angle.h"

enum { plant_inputs = MORAY_STEERING_STATES + 1 + MORAY_STEERING_PARAMETERS + 1 };

double complex moray_robust_limited(double complex value, double limit)
{
    return limit * tanh(value / limit);
}

double complex moray_robust_reference(const robust_robot *robot, double complex t, double *rate)
{
    const double now = moray_reference_at(robot->own->reference, creal(t), rate);
    return now + *rate * (t - creal(t));
}

void moray_robust_rates(const robust_robot *robot, const double complex *x, double complex command, double complex *dx)
{
    const moray_robust_spec *spec = robot->spec;
    const moray_belief *belief = &robot->own->belief;
    const double complex v_phi_0 = moray_robust_limited((command - x[ROBUST_PHI_0]) / spec->lag, spec->offset_rate);
    double complex full[plant_inputs] = {[MORAY_STATE_THETA] = x[ROBUST_THETA],
                                         [MORAY_STATE_V_THETA] = x[ROBUST_V_THETA],
                                         [MORAY_STATE_V_1] = x[ROBUST_V_T],
                                         [MORAY_STATE_V_2] = x[ROBUST_V_N],
                                         [MORAY_STATE_PHI_0] = belief->turning * x[ROBUST_PHI_0],
                                         [MORAY_STATE_V_PHI_0] = belief->turning * v_phi_0};
    double complex rates[MORAY_STEERING_STATES + 1];
    double complex *p = full + MORAY_STEERING_STATES + 1;
    p[MORAY_STEERING_AMPLITUDE] = spec->gait.amplitude * belief->amplitude;
    p[MORAY_STEERING_OMEGA] = spec->gait.omega;
    p[MORAY_STEERING_DELTA] = spec->gait.delta;
    moray_average_rates(robot->plant, full, rates);
    dx[ROBUST_THETA] = x[ROBUST_V_THETA];
    dx[ROBUST_V_THETA] = rates[MORAY_STATE_V_THETA];
    dx[ROBUST_V_T] = rates[MORAY_STATE_V_1];
    dx[ROBUST_V_N] = rates[MORAY_STATE_V_2];
    dx[ROBUST_PHI_0] = v_phi_0;
}

// In still water: how a robot turns in a uniform current is how it turns without.
moray_status moray_robust_robot_new(robust_robot *robot, const moray_robust_spec *spec, const moray_scenario *own)
{
    const moray_plant_spec plant = {.robot = spec->robot, .joints = MORAY_JOINTS_STEERED};
    *robot = (robust_robot){.spec = spec, .own = own};
    return moray_average_new(&robot->plant, &plant);
}

void moray_robust_bounds(const moray_robust_spec *spec, moray_bounds x[ROBUST_STATES])
{
    const double speed = spec->scenario->speed, all_round = 4 * M_PI;
    x[ROBUST_THETA] = moray_between(-all_round, all_round);
    x[ROBUST_V_THETA] = moray_between(-1, 1);
    x[ROBUST_V_T] = moray_between(0.1 * speed, 3 * speed);
    x[ROBUST_V_N] = moray_between(-speed, speed);
    x[ROBUST_PHI_0] = moray_between(-spec->offset, spec->offset);
}

void moray_robust_start(const moray_scenario *own, double x[ROBUST_STATES])
{
    double rate;
    memset(x, 0, ROBUST_STATES * sizeof *x);
    x[ROBUST_THETA] = moray_reference_at(own->reference, 0, &rate);
    x[ROBUST_V_T] = own->speed;
}

void moray_robust_guess(const moray_scenario *own, double t, double x[ROBUST_STATES])
{
    const double late = 1;
    double rate;
    memset(x, 0, ROBUST_STATES * sizeof *x);
    x[ROBUST_THETA] = moray_reference_at(own->reference, fmax(t - late, 0), &rate);
    x[ROBUST_V_THETA] = rate;
    x[ROBUST_V_T] = own->speed;
    x[ROBUST_PHI_0] = rate / own->turn;
}

moray_num moray_robust_noise(const moray_robust_spec *spec, moray_num gain)
{
    const double each =
        spec->noise * spec->noise * spec->sampling / (2 * ROBUST_ERROR_UNIT * ROBUST_ERROR_UNIT) / spec->n;
    moray_num noise = 0;
    for (int k = 0; k < spec->n; k++)
        noise += each * gain * fabs(spec->scenario[k].turn);
    return noise;
}

moray_status moray_robust_check(const moray_robust_spec *spec)
{
    if (spec->n < 1 || spec->n > MORAY_ROBUST_SCENARIOS)
        return moray_error(MORAY_INPUT, "%d scenarios: must be from 1 to %d", spec->n, MORAY_ROBUST_SCENARIOS);
    if (!(spec->start.proportional > 0 && spec->lag > 0 && spec->offset > 0 && spec->offset_rate > 0 &&
          spec->noise >= 0 && spec->sampling >= 0))
        return moray_error(MORAY_INPUT, "gain to start from = %g, lag = %g s, limits %g, %g: must be above 0",
                           spec->start.proportional, spec->lag, spec->offset, spec->offset_rate);
    return moray_ok();
}
