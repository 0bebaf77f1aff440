// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "snake/steer/guess.h"
#include "moray/snake/path.h"
#include "snake/steer/problems.h"

enum { states = MORAY_STEERING_STATES };

// ---- Guesses -------------------------------------------------------------------------------------------------------

// A point that swims where it heads at the straight's speed, and turns no faster than the robot.
typedef struct dot {
    const moray_path_spec *spec;
    double speed, turn_rate; // the latter at the limit of the offset, with its sign
    double x, y, heading, rate, along, time;
} dot;

// Heads for the path, crabbing on it.
static void step(dot *d, double seconds)
{
    const double lookahead = 1.5, settling = 2; // [m], [s]
    double across, V[2];
    moray_steering_current(d->spec->water, d->spec->current, d->x, d->y, d->time, V);
    moray_path_project(d->spec->path, d->x, d->y, &d->along, &across);
    const double course = creal(moray_path_at(d->spec->path, d->along + 0.5 * lookahead).course);
    const double crab = moray_crab_angle(d->speed, V, course);
    const double error = remainder(course + crab - atan(across / lookahead) - d->heading, 2 * M_PI);
    const double fastest = fabs(d->turn_rate);
    d->rate = fmin(fmax(error / settling, -fastest), fastest);
    d->x += seconds * (d->speed * cos(d->heading) + V[0]);
    d->y += seconds * (d->speed * sin(d->heading) + V[1]);
    d->heading += seconds * d->rate;
    d->time += seconds;
}

static void take(const dot *d, double *x, double *u)
{
    const double c = cos(d->heading), s = sin(d->heading);
    double V[2];
    moray_steering_current(d->spec->water, d->spec->current, d->x, d->y, d->time, V);
    const double v[2] = {d->speed * c + V[0], d->speed * s + V[1]};
    const bool body_frame = d->spec->model == MORAY_CONTROL_ORIENTED;
    const double sample[states] = {d->heading,
                                   d->x,
                                   d->y,
                                   d->rate,
                                   body_frame ? c * v[0] + s * v[1] : v[0],
                                   body_frame ? c * v[1] - s * v[0] : v[1],
                                   d->spec->limits.offset * d->rate / d->turn_rate,
                                   0};
    memcpy(x, sample, sizeof sample);
    u[0] = 0;
    u[1] = d->along;
}

// The way of such a point to the end of the path.
static moray_status guess_by_dot(steering_guess *guess, const moray_path_spec *spec,
                                 const moray_straight_motion *straight, double heading)
{
    const int n = guess->samples.n;
    const double seconds = moray_path_duration(spec->path, spec->along, straight->speed, spec->current);
    moray_gait gait = straight->gait;
    double arrived = 0;
    gait.offset = spec->limits.offset;
    dot d = {.spec = spec, .speed = straight->speed, .heading = heading, .along = spec->along};
    MORAY_TRY(moray_turn_rate(&spec->robot, spec->model, &gait, &d.turn_rate));
    d.x = spec->start[MORAY_STATE_P_X];
    d.y = spec->start[MORAY_STATE_P_Y];
    dot first = d;
    for (; first.along < spec->path->length && arrived < 3 * seconds; arrived += seconds / n)
        step(&first, seconds / n);
    for (int k = 0; k < n; k++) {
        guess->time[k] = arrived * k / (n - 1);
        step(&d, k == 0 ? 0 : arrived / (n - 1));
        take(&d, guess->x + k * states, guess->u + 2 * k);
    }
    moray_steering_parameters(&straight->gait, guess->s);
    return moray_ok();
}

// ---- Plans ---------------------------------------------------------------------------------------------------------

// Begins in the plan's straight at the position; averaged, without its undulation.
static moray_status pose_problem(moray_steering_plan *plan, moray_path_spec *spec, const double position[2],
                                 double heading)
{
    double across, V[2];
    moray_steering_current(spec->water, spec->current, position[0], position[1], 0, V);
    moray_straight_motion_start(&plan->straight, heading, V, spec->start);
    if (spec->averaged) {
        spec->start[MORAY_STATE_THETA] = heading;
        spec->start[MORAY_STATE_V_THETA] = 0;
    }
    memcpy(spec->start + MORAY_STATE_P_X, position, 2 * sizeof *position);
    spec->along = 0;
    moray_path_project(spec->path, position[0], position[1], &spec->along, &across);
    spec->t0 = spec->duration = 0;
    const double seconds = moray_path_duration(spec->path, spec->along, plan->straight.speed, spec->current);
    spec->speed = (spec->path->length - spec->along) / seconds;
    return moray_path_problem_new(&plan->problem, spec);
}

// On the same model and gait from the solution itself, else from samples of it at this plan's speed.
static moray_status solve(moray_steering_plan *plan, const moray_path_spec *spec, const moray_settings *settings,
                          double heading, const moray_steering_plan *from)
{
    const moray_ocp *ocp = moray_steering_ocp(plan->problem.steering);
    const double *V = spec->current;
    if (from && from->straight.model == spec->model) {
        const moray_guess guess = moray_guess_from_solution(from->solution);
        return moray_solve(ocp, settings, &guess, &plan->solution);
    }
    steering_guess samples;
    moray_status status = moray_ok();
    MORAY_TRY(moray_steering_guess_new(&samples, 16 * settings->intervals + 1, 2));
    if (from)
        moray_steering_guess_from_other(&samples, &spec->robot, from->solution, &from->straight, spec->model,
                                        moray_path_duration(spec->path, spec->along, plan->straight.speed, V) /
                                            moray_path_duration(spec->path, spec->along, from->straight.speed, V));
    else
        status = guess_by_dot(&samples, spec, &plan->straight, heading);
    const moray_guess guess = {.phase = &samples.samples, .s = samples.s};
    if (!moray_failed(status))
        status = moray_solve(ocp, settings, &guess, &plan->solution);
    free(samples.time);
    return status;
}

static moray_status make(moray_steering_plan *plan, moray_path_spec *spec, const moray_settings *settings,
                         const moray_gait *gait, const double position[2], double heading,
                         const moray_steering_plan *from)
{
    MORAY_TRY(moray_straight_motion_find(&plan->straight, &spec->robot, spec->model, gait));
    MORAY_TRY(moray_path_passable(spec->path, plan->straight.speed, spec->current));
    MORAY_TRY(pose_problem(plan, spec, position, heading));
    MORAY_TRY(solve(plan, spec, settings, heading, from));
    if (!spec->averaged)
        return moray_ok();
    const moray_gait found = moray_steering_gait(moray_solution_parameters(plan->solution));
    return moray_straight_motion_find(&plan->straight, &spec->robot, spec->model, &found);
}

moray_status moray_path_plan_make(moray_steering_plan *plan, const moray_path_spec *spec,
                                  const moray_settings *settings, const moray_gait *gait, const double position[2],
                                  double heading, const moray_steering_plan *from)
{
    moray_path_spec own = *spec;
    if (!own.averaged)
        moray_steering_keep_gait(&own.limits, &own.robot, own.model, gait);
    *plan = (moray_steering_plan){0};
    const moray_status status = make(plan, &own, settings, gait, position, heading, from);
    if (moray_failed(status))
        moray_steering_plan_free(plan);
    return status;
}

// ---- Receding horizon ----------------------------------------------------------------------------------------------

static moray_status make_again(void *self, double t, const double *state, void **problem, const moray_ocp **ocp)
{
    moray_path_replanner *r = self;
    double across;
    moray_steering_problem *path = calloc(1, sizeof *path);
    if (!path)
        return moray_error(MORAY_MEMORY, "no memory for a plan");
    memcpy(r->spec.start, state, sizeof r->spec.start);
    r->spec.t0 = t;
    r->spec.duration = r->horizon;
    moray_path_project(r->spec.path, state[MORAY_STATE_P_X], state[MORAY_STATE_P_Y], &r->spec.along, &across);
    const moray_status status = moray_path_problem_new(path, &r->spec);
    if (moray_failed(status)) {
        free(path);
        return status;
    }
    *problem = path;
    *ocp = moray_steering_ocp(path->steering);
    return status;
}

static void free_again(void *problem)
{
    moray_steering_problem_free(problem);
    free(problem);
}

moray_replanner moray_path_replan(moray_path_replanner *replanner)
{
    return (moray_replanner){.nx = states,
                             .nu = 2,
                             .ns = MORAY_STEERING_PARAMETERS,
                             .make = make_again,
                             .free = free_again,
                             .self = replanner};
}
