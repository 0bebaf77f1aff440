// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "app/steering_guess.h"
#include "moray/path.h"

enum { states = MORAY_STEERING_STATES };

// The path as though it were followed at the cruise's speed, crabbing.
static void guess_along_path(steering_guess *guess, const moray_path_spec *spec, const moray_cruise *cruise)
{
    const int n = guess->samples.n;
    const double length = spec->path->length, step = (length - spec->along) / (n - 1);
    double seconds = 0;
    for (int k = 0; k < n; k++) {
        double *x = guess->x + k * states;
        const double along = spec->along + step * k;
        const moray_path_point at = moray_path_at(spec->path, along);
        const double course = creal(at.course), c = cos(course), s = sin(course), *V = spec->current;
        const double side = V[1] * c - V[0] * s, crab = asin(side / cruise->speed);
        moray_cruise_start(cruise, course - crab, V, x);
        x[1] = creal(at.x);
        x[2] = creal(at.y);
        guess->time[k] = seconds;
        guess->u[2 * k + 1] = along;
        seconds += step / (cruise->speed * cos(crab) + V[0] * c + V[1] * s);
    }
    moray_steering_parameters(&cruise->gait, guess->s);
}

// Begins in the plan's cruise at the position; averaged, without its undulation.
static moray_status pose_problem(moray_path_plan *plan, moray_path_spec *spec, const double position[2], double heading)
{
    double across;
    moray_cruise_start(&plan->cruise, heading, spec->current, spec->start);
    if (spec->averaged) {
        spec->start[0] = heading;
        spec->start[3] = 0;
    }
    memcpy(spec->start + 1, position, 2 * sizeof *position);
    spec->along = 0;
    moray_path_project(spec->path, position[0], position[1], &spec->along, &across);
    spec->t0 = spec->duration = 0;
    const double seconds = moray_path_duration(spec->path, spec->along, plan->cruise.speed, spec->current);
    spec->speed = (spec->path->length - spec->along) / seconds;
    return moray_path_problem_new(&plan->problem, spec);
}

// On the same model and gait from the solution itself, else from samples of it at this plan's speed.
static moray_status solve(moray_path_plan *plan, const moray_path_spec *spec, const moray_settings *settings,
                          const moray_path_plan *from)
{
    const moray_ocp *ocp = moray_steering_ocp(plan->problem.steering);
    const double *V = spec->current;
    if (from && from->cruise.model == spec->model) {
        const moray_guess guess = moray_guess_from_solution(from->solution);
        return moray_solve(ocp, settings, &guess, &plan->solution);
    }
    steering_guess samples;
    MORAY_TRY(steering_guess_new(&samples, 16 * settings->intervals + 1, 2));
    if (from)
        steering_guess_from_other(&samples, &spec->robot, from->solution, &from->cruise, spec->model,
                                  moray_path_duration(spec->path, spec->along, plan->cruise.speed, V) /
                                      moray_path_duration(spec->path, spec->along, from->cruise.speed, V));
    else
        guess_along_path(&samples, spec, &plan->cruise);
    const moray_guess guess = {.phase = &samples.samples, .s = samples.s};
    const moray_status status = moray_solve(ocp, settings, &guess, &plan->solution);
    free(samples.time);
    return status;
}

static moray_status make(moray_path_plan *plan, moray_path_spec *spec, const moray_settings *settings,
                         const moray_gait *gait, const double position[2], double heading, const moray_path_plan *from)
{
    MORAY_TRY(moray_cruise_find(&plan->cruise, &spec->robot, spec->model, gait));
    MORAY_TRY(moray_path_passable(spec->path, plan->cruise.speed, spec->current));
    MORAY_TRY(pose_problem(plan, spec, position, heading));
    MORAY_TRY(solve(plan, spec, settings, from));
    if (!spec->averaged)
        return moray_ok();
    const moray_gait found = moray_steering_gait(moray_solution_parameters(plan->solution));
    return moray_cruise_find(&plan->cruise, &spec->robot, spec->model, &found);
}

moray_status moray_path_plan_make(moray_path_plan *plan, const moray_path_spec *spec, const moray_settings *settings,
                                  const moray_gait *gait, const double position[2], double heading,
                                  const moray_path_plan *from)
{
    moray_path_spec own = *spec;
    if (!own.averaged)
        steering_keep_gait(&own.limits, &own.robot, own.model, gait);
    *plan = (moray_path_plan){0};
    const moray_status status = make(plan, &own, settings, gait, position, heading, from);
    if (moray_failed(status))
        moray_path_plan_free(plan);
    return status;
}

void moray_path_plan_free(moray_path_plan *plan)
{
    moray_solution_free(plan->solution);
    moray_path_problem_free(&plan->problem);
    *plan = (moray_path_plan){0};
}
