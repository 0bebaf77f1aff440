// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdlib.h>

#include "moray/snake/heading.h"
#include "snake/steer/problems.h"

typedef struct heading_task {
    moray_heading_spec spec;
    double weight;         // of the integral
    moray_bounds error[1]; // allowed
    bool tube;
} heading_task;

static const char *const error_names[] = {"heading error"};

// [error where it is bounded, weighted sum of squares]
static void extra(void *self, const double complex *in, double complex *out)
{
    const heading_task *task = self;
    const moray_heading_spec *spec = &task->spec;
    const double complex *s = in + MORAY_STEERING_STATES + 1, t = s[MORAY_STEERING_PARAMETERS];
    double rate;
    const double reference = moray_reference_at(spec->reference, creal(t), &rate);
    const double complex swing = spec->undulation[0] * ccos(s[MORAY_STEERING_OMEGA] * t) +
                                 spec->undulation[1] * csin(s[MORAY_STEERING_OMEGA] * t);
    const double complex error = in[MORAY_STATE_THETA] - swing - (reference + rate * (t - creal(t)));
    const double complex steering = in[MORAY_STEERING_STATES] / spec->limits.offset;
    if (task->tube)
        *out++ = error;
    *out = spec->weight.heading * error * error + spec->weight.steering * steering * steering;
}

static moray_status check(const moray_heading_spec *spec)
{
    if (!(spec->t1 > spec->t0))
        return moray_error(MORAY_INPUT, "horizon from %g s to %g s: must end after it begins", spec->t0, spec->t1);
    if (!(spec->max_error > 0))
        return moray_error(MORAY_INPUT, "largest heading error = %g: must be above 0", spec->max_error);
    if (!(spec->limits.offset < MORAY_INFINITY))
        return moray_error(MORAY_INPUT, "offset: must be limited, the steering effort counts in it");
    return moray_ok();
}

static moray_steering_spec steering_spec(const moray_heading_spec *spec, heading_task *task)
{
    moray_steering_spec steering = {.robot = spec->robot,
                                    .model = spec->model,
                                    .averaged = spec->averaged,
                                    .current = {spec->current[0], spec->current[1]},
                                    .limits = spec->limits,
                                    .t0 = moray_fixed(spec->t0),
                                    .tf = moray_fixed(spec->t1),
                                    .task = {.name = "heading",
                                             .nc = task->tube,
                                             .nq = 1,
                                             .extra = extra,
                                             .self = task,
                                             .c = task->error,
                                             .c_names = error_names,
                                             .weight = &task->weight,
                                             .weight_power = spec->weight.power / (spec->t1 - spec->t0)}};
    for (int r = 0; r < MORAY_STEERING_STATES; r++) {
        steering.x0[r] = moray_fixed(spec->start[r]);
        steering.xf[r] = moray_free();
    }
    return steering;
}

moray_status moray_heading_new(moray_steering_problem *problem, const moray_heading_spec *spec)
{
    *problem = (moray_steering_problem){0};
    MORAY_TRY(check(spec));
    heading_task *task = calloc(1, sizeof *task);
    if (!task)
        return moray_error(MORAY_MEMORY, "no memory for the heading problem");
    *task = (heading_task){.spec = *spec,
                           .weight = 1 / (spec->t1 - spec->t0),
                           .error = {moray_between(-spec->max_error, spec->max_error)},
                           .tube = spec->max_error < MORAY_INFINITY};
    problem->task = task;
    const moray_steering_spec steering = steering_spec(spec, task);
    const moray_status status = moray_steering_new(&problem->steering, &steering);
    if (moray_failed(status))
        moray_steering_problem_free(problem);
    return status;
}
