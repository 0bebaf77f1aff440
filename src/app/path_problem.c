// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdlib.h>
#include <tgmath.h>

#include "moray/path.h"

enum { states = MORAY_STEERING_STATES, integrals = 2 };

struct moray_path_task {
    moray_path_spec spec;
    double first_across; // at the start
    double weight[integrals];
    moray_bounds along[1], c[2], e[2];
    bool tube;
};

static const char *const control_names[] = {"distance along the path"};
static const char *const path_names[] = {"nearest point of the path", "distance to the path in the tube"};
static const char *const event_names[] = {"way made along the path", "distance to the path at its end"};

// Width of the tube, wide enough for the start at first.
static moray_num tube_at(const struct moray_path_task *task, moray_num along)
{
    const moray_path_spec *spec = &task->spec;
    const double excess = fabs(task->first_across) * 1.05 - spec->tube;
    const moray_num part = (along - spec->along) / spec->reach;
    if (!(excess > 0) || !(creal(part) < 1))
        return spec->tube + 0 * along;
    return spec->tube + excess * (1 - part);
}

// [offset from the nearest point along the path, distance over tube], [weighted squares, rate of way made]
static void extra(void *self, const double complex *in, double complex *out)
{
    const struct moray_path_task *task = self;
    const moray_path_spec *spec = &task->spec;
    const moray_num along = in[states + 1];
    const moray_path_point at = moray_path_at(spec->path, along);
    const moray_num c = cos(at.course), s = sin(at.course), dx = in[1] - at.x, dy = in[2] - at.y;
    const moray_num across = c * dy - s * dx, steering = in[states] / spec->limits.offset;
    const bool body_frame = spec->model == MORAY_CONTROL_ORIENTED;
    const moray_num ch = body_frame ? cos(in[0]) : 1, sh = body_frame ? sin(in[0]) : 0;
    const moray_num v_x = ch * in[4] - sh * in[5], v_y = sh * in[4] + ch * in[5];
    *out++ = c * dx + s * dy;
    if (task->tube)
        *out++ = across / tube_at(task, along);
    *out++ = spec->weight.across * across * across + spec->weight.steering * steering * steering;
    *out = (c * v_x + s * v_y) / (1 - at.curvature * across);
}

// Way made along the path; at its end, if that is where the phase ends, the distance to it.
static void events(const moray_ends *at, moray_verdict *out, const void *data)
{
    const struct moray_path_task *task = data;
    const moray_path *path = task->spec.path;
    const moray_path_point end = moray_path_at(path, path->length);
    const double c = cos(creal(end.course)), s = sin(creal(end.course));
    out->e[0] = at->phase->q[1];
    out->e[1] = c * (at->phase->xf[2] - creal(end.y)) - s * (at->phase->xf[1] - creal(end.x));
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

static void set_task(struct moray_path_task *task, const moray_path_spec *spec)
{
    const bool to_end = spec->duration == 0;
    const double rest = spec->path->length - spec->along;
    double along = spec->along;
    *task = (struct moray_path_task){
        .spec = *spec,
        .weight = {1, to_end ? 0 : -spec->weight.time / spec->speed},
        .along = {moray_between(spec->along - 2, spec->path->length + (to_end ? 2 : 3 * spec->speed * spec->duration))},
        .c = {moray_fixed(0), moray_between(-1, 1)},
        .e = {to_end ? moray_fixed(rest) : moray_between(-1e4, 1e4),
              to_end ? moray_fixed(0) : moray_between(-1e4, 1e4)},
        .tube = spec->tube < MORAY_INFINITY};
    moray_path_project(spec->path, spec->start[1], spec->start[2], &along, &task->first_across);
}

static moray_steering_spec steering_spec(const moray_path_spec *spec, struct moray_path_task *task)
{
    const bool to_end = spec->duration == 0;
    const double rest = spec->path->length - spec->along;
    moray_steering_spec steering = {
        .robot = spec->robot,
        .model = spec->model,
        .averaged = spec->averaged,
        .current = {spec->current[0], spec->current[1]},
        .limits = spec->limits,
        .t0 = moray_fixed(spec->t0),
        .tf = to_end ? moray_between(spec->t0 + 0.3 * rest / spec->speed, spec->t0 + 3 * rest / spec->speed)
                     : moray_fixed(spec->t0 + spec->duration),
        .task = {.name = "path",
                 .nu = 1,
                 .nc = 1 + task->tube,
                 .nq = integrals,
                 .extra = extra,
                 .ne = 2,
                 .events = events,
                 .self = task,
                 .u = task->along,
                 .c = task->c,
                 .e = task->e,
                 .u_names = control_names,
                 .c_names = path_names,
                 .e_names = event_names,
                 .weight = task->weight,
                 .weight_time = to_end ? spec->weight.time : 0}};
    for (int r = 0; r < states; r++) {
        steering.x0[r] = moray_fixed(spec->start[r]);
        steering.xf[r] = to_end && r >= 6 ? moray_fixed(0) : moray_free(); // steering done
    }
    return steering;
}

moray_status moray_path_problem_new(moray_path_problem *problem, const moray_path_spec *spec)
{
    *problem = (moray_path_problem){0};
    MORAY_TRY(check(spec));
    problem->task = calloc(1, sizeof *problem->task);
    if (!problem->task)
        return moray_error(MORAY_MEMORY, "no memory for the path problem");
    set_task(problem->task, spec);
    const moray_steering_spec steering = steering_spec(spec, problem->task);
    const moray_status status = moray_steering_new(&problem->steering, &steering);
    if (moray_failed(status))
        moray_path_problem_free(problem);
    return status;
}

void moray_path_problem_free(moray_path_problem *problem)
{
    moray_steering_free(problem->steering);
    free(problem->task);
    *problem = (moray_path_problem){0};
}
