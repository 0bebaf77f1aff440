// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdlib.h>
#include <tgmath.h>

#include "moray/snake/path.h"
#include "snake/steer/problems.h"

enum { states = MORAY_STEERING_STATES };

typedef struct path_task {
    moray_path_spec spec;
    double first_across; // at the start
    double weight;       // of the integral
    moray_bounds along[1], c[2];
    bool tube;
    double ahead[2], way,
        rate; // of what is made good beyond the distance `way` along this unit vector, in the objective
} path_task;

static const char *const control_names[] = {"distance along the path"};
static const char *const path_names[] = {"nearest point of the path", "distance to the path in the tube"};

// Width of the tube, wide enough for the start at first.
static moray_num tube_at(const path_task *task, moray_num along)
{
    const moray_path_spec *spec = &task->spec;
    const double excess = fabs(task->first_across) * 1.05 - spec->tube;
    const moray_num part = (along - spec->along) / spec->reach;
    if (!(excess > 0) || !(creal(part) < 1))
        return spec->tube + 0 * along;
    return spec->tube + excess * (1 - part);
}

// [offset from the nearest point along the path, distance over tube], [weighted squares]
static void extra(void *self, const double complex *in, double complex *out)
{
    const path_task *task = self;
    const moray_path_spec *spec = &task->spec;
    const moray_num along = in[states + 1];
    const moray_path_point at = moray_path_at(spec->path, along);
    const moray_num c = cos(at.course), s = sin(at.course), dx = in[MORAY_STATE_P_X] - at.x,
                    dy = in[MORAY_STATE_P_Y] - at.y;
    const moray_num across = c * dy - s * dx, steering = in[states] / spec->limits.offset;
    *out++ = c * dx + s * dy;
    if (task->tube)
        *out++ = across / tube_at(task, along);
    *out = spec->weight.across * across * across + spec->weight.steering * steering * steering;
}

// Time gained by what is made good.
static void gain(const moray_ends *at, moray_end_values *out, const void *data)
{
    const path_task *task = data;
    const moray_num *p = at->phase->xf + MORAY_STATE_P_X;
    out->objective = -task->rate * (task->ahead[0] * p[0] + task->ahead[1] * p[1] - task->way);
}

static moray_status check(const moray_path_spec *spec)
{
    if (!(spec->tube > 0))
        return moray_error(MORAY_INPUT, "tube_m = %g: must be above 0, or none", spec->tube);
    if (!(spec->reach > 0))
        return moray_error(MORAY_INPUT, "reach_m = %g: must be above 0", spec->reach);
    if (!(spec->limits.offset < MORAY_INFINITY))
        return moray_error(MORAY_INPUT, "offset: must be limited, the steering effort counts in it");
    if (spec->duration < 0 || (spec->duration == 0 && !(spec->along < spec->path->length)))
        return moray_error(MORAY_INPUT, "a plan of %g s from %g m along a path of %g m: nothing to follow",
                           spec->duration, spec->along, spec->path->length);
    if (!(spec->speed > 0))
        return moray_error(MORAY_INPUT, "speed along the path = %g m/s: must be above 0", spec->speed);
    return moray_ok();
}

// What is made good by the end of a plan of given length: along the course of the path where it would typically be.
static void reward(path_task *task, const moray_path_spec *spec)
{
    const moray_path_point end = moray_path_at(spec->path, spec->along + spec->speed * spec->duration);
    task->rate = spec->weight.time / spec->speed;
    task->ahead[0] = cos(creal(end.course));
    task->ahead[1] = sin(creal(end.course));
    task->way = task->ahead[0] * creal(end.x) + task->ahead[1] * creal(end.y);
}

static void set_task(path_task *task, const moray_path_spec *spec)
{
    const double beyond = spec->duration == 0 ? 2 : 3 * spec->speed * spec->duration;
    double along = spec->along;
    *task = (path_task){.spec = *spec,
                        .weight = 1,
                        .along = {moray_between(spec->along - 2, spec->path->length + beyond)},
                        .c = {moray_fixed(0), moray_between(-1, 1)},
                        .tube = spec->tube < MORAY_INFINITY};
    if (spec->duration > 0)
        reward(task, spec);
    moray_path_project(spec->path, spec->start[MORAY_STATE_P_X], spec->start[MORAY_STATE_P_Y], &along,
                       &task->first_across);
}

static void set_ends(moray_steering_spec *steering, const moray_path_spec *spec)
{
    const moray_path_point end = moray_path_at(spec->path, spec->path->length);
    const double seconds = (spec->path->length - spec->along) / spec->speed;
    for (int r = 0; r < states; r++) {
        steering->x0[r] = moray_fixed(spec->start[r]);
        steering->xf[r] = moray_free();
    }
    steering->t0 = moray_fixed(spec->t0);
    steering->tf = moray_fixed(spec->t0 + spec->duration);
    if (spec->duration > 0)
        return;
    steering->tf = moray_between(spec->t0 + 0.3 * seconds, spec->t0 + 3 * seconds);
    steering->xf[MORAY_STATE_P_X] = moray_fixed(creal(end.x));
    steering->xf[MORAY_STATE_P_Y] = moray_fixed(creal(end.y));
    steering->xf[MORAY_STATE_PHI_0] = steering->xf[MORAY_STATE_V_PHI_0] = moray_fixed(0); // steering done
}

static moray_steering_spec steering_spec(const moray_path_spec *spec, path_task *task)
{
    const bool to_end = spec->duration == 0;
    moray_steering_spec steering = {.robot = spec->robot,
                                    .model = spec->model,
                                    .averaged = spec->averaged,
                                    .current = {spec->current[0], spec->current[1]},
                                    .water = spec->water,
                                    .limits = spec->limits,
                                    .task = {.name = "path",
                                             .nu = 1,
                                             .nc = 1 + task->tube,
                                             .nq = 1,
                                             .extra = extra,
                                             .events = to_end ? NULL : gain,
                                             .self = task,
                                             .u = task->along,
                                             .c = task->c,
                                             .u_names = control_names,
                                             .c_names = path_names,
                                             .weight = &task->weight,
                                             .weight_time = to_end ? spec->weight.time : 0}};
    set_ends(&steering, spec);
    return steering;
}

moray_status moray_path_problem_new(moray_steering_problem *problem, const moray_path_spec *spec)
{
    *problem = (moray_steering_problem){0};
    MORAY_TRY(check(spec));
    problem->task = calloc(1, sizeof(path_task));
    if (!problem->task)
        return moray_error(MORAY_MEMORY, "no memory for the path problem");
    set_task(problem->task, spec);
    const moray_steering_spec steering = steering_spec(spec, problem->task);
    const moray_status status = moray_steering_new(&problem->steering, &steering);
    if (moray_failed(status))
        moray_steering_problem_free(problem);
    return status;
}
