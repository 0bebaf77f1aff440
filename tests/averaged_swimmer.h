// SPDX-License-Identifier: MIT
//
// A swimmer of the averaged plant in a current, as it is believed to swim and turn. Included once by a test.
#ifndef TESTS_AVERAGED_SWIMMER_H
#define TESTS_AVERAGED_SWIMMER_H

#include "rk4.h"
#include "tap.h"

#include "moray/snake/navigator.h"

enum { body = MORAY_BODY_STATES };

typedef struct swimmer {
    moray_map map;
    moray_gait gait;
    moray_belief belief;
    double offset, rate, current[2];
} swimmer;

// Rates of [heading, p_x, p_y, turning, v_t, v_n] through the water, over ground in the current.
static bool rates(double t, const double *x, double *dx, void *self)
{
    const swimmer *s = self;
    enum { inputs = MORAY_STEERING_STATES + 1 + MORAY_STEERING_PARAMETERS + 1, first = MORAY_STEERING_STATES + 1 };
    double in[inputs] = {0}, out[MORAY_STEERING_STATES + 1];
    memcpy(in, x, body * sizeof *x);
    in[MORAY_STATE_PHI_0] = s->belief.turning * (s->offset + s->rate * t);
    in[MORAY_STATE_V_PHI_0] = s->belief.turning * s->rate;
    in[first + MORAY_STEERING_AMPLITUDE] = s->belief.amplitude * s->gait.amplitude;
    in[first + MORAY_STEERING_OMEGA] = s->gait.omega;
    in[first + MORAY_STEERING_DELTA] = s->gait.delta;
    s->map.value(s->map.self, in, out);
    memcpy(dx, out, body * sizeof *dx);
    dx[MORAY_STATE_P_X] += s->current[0];
    dx[MORAY_STATE_P_Y] += s->current[1];
    return true;
}

static void swim(swimmer *s, double seconds, int steps, double *x)
{
    const moray_integrator classical = {.self = &steps};
    CHECK_OK(rk4_run(&classical, &(moray_ode){.n = body, .rhs = rates, .self = s}, 0, seconds, x, NULL, 0, NULL, NULL),
             "swum");
}

static swimmer swimmer_of(const moray_navigator_spec *spec, moray_belief belief)
{
    swimmer s = {.gait = spec->gait, .belief = belief, .current = {belief.current[0], belief.current[1]}};
    const moray_plant_spec plant = {.robot = spec->robot, .joints = MORAY_JOINTS_STEERED};
    CHECK_OK(moray_average_plant(&s.map, &plant), "averaged plant");
    return s;
}

#endif
