// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "snake/steer/guess.h"
#include "moray/snake/heading.h"
#include "snake/steer/problems.h"

enum { states = MORAY_STEERING_STATES };

// The reference as though it were followed at the straight's speed.
static void guess_from_reference(steering_guess *guess, const moray_heading_spec *spec,
                                 const moray_straight_motion *straight)
{
    double p[2] = {0, 0}, rate;
    const int n = guess->samples.n;
    const double step = (spec->t1 - spec->t0) / (n - 1);
    for (int k = 0; k < n; k++) {
        double *x = guess->x + k * states;
        guess->time[k] = spec->t0 + step * k;
        moray_straight_motion_start(straight, moray_reference_at(spec->reference, guess->time[k], &rate), spec->current,
                                    x);
        memcpy(x + MORAY_STATE_P_X, p, sizeof p);
        p[0] += step * (straight->speed * cos(x[MORAY_STATE_THETA]) + spec->current[0]);
        p[1] += step * (straight->speed * sin(x[MORAY_STATE_THETA]) + spec->current[1]);
    }
    moray_steering_parameters(&straight->gait, guess->s);
}

// Begins in the plan's straight; averaged, without its undulation.
static moray_status pose_problem(moray_steering_plan *plan, moray_heading_spec *spec)
{
    double rate;
    const double heading = moray_reference_at(spec->reference, 0, &rate);
    moray_straight_motion_start(&plan->straight, heading, spec->current, spec->start);
    if (spec->averaged) {
        spec->start[MORAY_STATE_THETA] = heading;
        spec->start[MORAY_STATE_V_THETA] = 0;
    }
    for (int k = 0; k < 2; k++)
        spec->undulation[k] = spec->averaged ? 0 : plan->straight.undulation[k];
    return moray_heading_new(&plan->problem, spec);
}

static moray_status solve(moray_steering_plan *plan, const moray_heading_spec *spec, const moray_settings *settings,
                          const moray_steering_plan *from)
{
    const moray_ocp *ocp = moray_steering_ocp(plan->problem.steering);
    if (from && from->straight.model == spec->model) {
        const moray_guess guess = moray_guess_from_solution(from->solution);
        return moray_solve(ocp, settings, &guess, &plan->solution);
    }
    steering_guess samples;
    MORAY_TRY(moray_steering_guess_new(&samples, 16 * settings->intervals + 1, 1));
    if (from)
        moray_steering_guess_from_other(&samples, &spec->robot, from->solution, &from->straight, spec->model, 1);
    else
        guess_from_reference(&samples, spec, &plan->straight);
    const moray_guess guess = {.phase = &samples.samples, .s = samples.s};
    const moray_status status = moray_solve(ocp, settings, &guess, &plan->solution);
    free(samples.time);
    return status;
}

static moray_status make(moray_steering_plan *plan, moray_heading_spec *spec, const moray_settings *settings,
                         const moray_gait *gait, const moray_steering_plan *from)
{
    MORAY_TRY(moray_straight_motion_find(&plan->straight, &spec->robot, spec->model, gait));
    MORAY_TRY(pose_problem(plan, spec));
    MORAY_TRY(solve(plan, spec, settings, from));
    if (!spec->averaged)
        return moray_ok();
    const moray_gait found = moray_steering_gait(moray_solution_parameters(plan->solution));
    return moray_straight_motion_find(&plan->straight, &spec->robot, spec->model, &found);
}

moray_status moray_heading_plan_make(moray_steering_plan *plan, const moray_heading_spec *spec,
                                     const moray_settings *settings, const moray_gait *gait,
                                     const moray_steering_plan *from)
{
    moray_heading_spec own = *spec;
    own.t0 = 0;
    if (!own.averaged)
        moray_steering_keep_gait(&own.limits, &own.robot, own.model, gait);
    *plan = (moray_steering_plan){0};
    const moray_status status = make(plan, &own, settings, gait, from);
    if (moray_failed(status))
        moray_steering_plan_free(plan);
    return status;
}
