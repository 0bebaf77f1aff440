// SPDX-License-Identifier: MIT
//
// Heading tracking as heading_tracking poses it, with the paper's gait, over ever longer horizons.
#include "benchmark.h"

static const double step = 30 * DEG, between = 40; // the reference goes there and back, the first time half-way
static const double unit = 10 * DEG;               // of the heading error
static const int per_period = 5;                   // intervals

static moray_status begin(void *self)
{
    horizon_case *c = self;
    c->robot = moray_robot_paper();
    const moray_gait paper = moray_gait_paper(&c->robot);
    c->gait = moray_gait_map(&c->robot, &paper, MORAY_CONTROL_ORIENTED, c->model);
    c->reference = (moray_reference){.time = c->time, .heading = c->heading};
    for (double t = between / 2, from = 0; t < c->seconds; t += between, from = step - from) {
        const int n = c->reference.n;
        if (n + 2 > HORIZON_POINTS)
            return moray_error(MORAY_INPUT, "horizon = %g s: at most %g s", c->seconds, between * HORIZON_POINTS / 2);
        c->time[n] = c->time[n + 1] = t;
        c->heading[n] = from;
        c->heading[n + 1] = step - from;
        c->reference.n += 2;
    }
    return moray_ok();
}

static moray_steering_limits limits_of(const horizon_case *c)
{
    const moray_gait paper = moray_gait_paper(&c->robot);
    const moray_steering_limits limits = {
        .offset = 0.015, .offset_rate = 0.01, .offset_acceleration = MORAY_INFINITY, .power = MORAY_INFINITY};
    return moray_steering_limits_map(&c->robot, &limits, &paper, MORAY_CONTROL_ORIENTED, c->model);
}

static moray_status solve(void *self, moray_linear_solver linear, bool timed, moray_solution **solution)
{
    horizon_case *c = self;
    const int least = (int)ceil(per_period * c->seconds * c->gait.omega / (2 * M_PI));
    const int intervals = moray_reference_intervals(&c->reference, 0, c->seconds, least);
    const moray_settings settings = benchmark_settings("radau5", intervals, linear, timed);
    const moray_heading_spec spec = {.robot = c->robot,
                                     .model = c->model,
                                     .current = {0.1, 0.1},
                                     .limits = limits_of(c),
                                     .weight = {.heading = 1 / (unit * unit), .steering = 0.003},
                                     .reference = &c->reference,
                                     .max_error = MORAY_INFINITY,
                                     .t1 = c->seconds};
    MORAY_TRY(moray_heading_plan_make(&c->plan, &spec, &settings, &c->gait, NULL));
    *solution = c->plan.solution;
    c->plan.solution = NULL; // the caller's now
    return moray_ok();
}

static void forget(void *self)
{
    horizon_case *c = self;
    moray_steering_plan_free(&c->plan);
}

subject horizon_subject(horizon_case *c)
{
    return (subject){begin, solve, forget, NULL, c};
}
