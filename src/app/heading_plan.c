// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "moray/heading.h"

enum { states = MORAY_STEERING_STATES };

// ---- Guesses
// ----------------------------------------------------------------------------------------------------------

// Samples in one block: time, x, u.
typedef struct guess_samples {
    moray_samples samples;
    double *time, *x, *u;
    double s[MORAY_STEERING_PARAMETERS];
} guess_samples;

static moray_status guess_new(guess_samples *guess, int n)
{
    double *block = calloc((size_t)(n * (1 + states + 1)), sizeof *block);
    if (!block)
        return moray_error(MORAY_MEMORY, "no memory for a guess of %d samples", n);
    *guess = (guess_samples){.time = block, .x = block + n, .u = block + n * (1 + states)};
    guess->samples = (moray_samples){.n = n, .time = guess->time, .x = guess->x, .u = guess->u};
    return moray_ok();
}

// The reference as though it were followed at the cruise's speed.
static void guess_from_reference(guess_samples *guess, const moray_heading_spec *spec, const moray_cruise *cruise)
{
    double p[2] = {0, 0}, rate;
    const int n = guess->samples.n;
    const double step = (spec->t1 - spec->t0) / (n - 1);
    for (int k = 0; k < n; k++) {
        double *x = guess->x + k * states;
        guess->time[k] = spec->t0 + step * k;
        moray_cruise_start(cruise, moray_reference_at(spec->reference, guess->time[k], &rate), spec->current, x);
        memcpy(x + 1, p, sizeof p);
        p[0] += step * (cruise->speed * cos(x[0]) + spec->current[0]);
        p[1] += step * (cruise->speed * sin(x[0]) + spec->current[1]);
    }
    moray_steering_parameters(&cruise->gait, guess->s);
}

// A solution of one model as the other sees it: velocities in the other frame, offsets in the ratio of the amplitudes.
static void guess_from_other(guess_samples *guess, const moray_robot *robot, const moray_heading_plan *from,
                             moray_model to)
{
    const moray_gait gait = moray_steering_gait(moray_solution_parameters(from->solution));
    const moray_gait mapped = moray_gait_map(robot, &gait, from->cruise.model, to);
    const double scale = -mapped.amplitude / gait.amplitude; // erratum E3
    const int n = guess->samples.n;
    double t0, t1;
    moray_solution_times(from->solution, 0, &t0, &t1);
    for (int k = 0; k < n; k++) {
        double *x = guess->x + k * states;
        guess->time[k] = t0 + (t1 - t0) * k / (n - 1);
        moray_solution_at(from->solution, 0, guess->time[k], x, guess->u + k);
        const double turn = to == MORAY_FIRST_PRINCIPLES ? x[0] : -x[0], v[2] = {x[4], x[5]};
        x[4] = v[0] * cos(turn) - v[1] * sin(turn);
        x[5] = v[0] * sin(turn) + v[1] * cos(turn);
        x[6] *= scale;
        x[7] *= scale;
        guess->u[k] *= scale;
    }
    moray_steering_parameters(&mapped, guess->s);
}

// ---- Plans
// ------------------------------------------------------------------------------------------------------------

// Leaves no choice of a gait.
static void keep_gait(moray_heading_spec *spec, const moray_gait *gait)
{
    moray_steering_limits *limits = &spec->limits;
    const double theta_max = moray_theta_max_from_amplitude(&spec->robot, spec->model, gait->amplitude, gait->delta);
    limits->theta_max = moray_fixed(theta_max);
    limits->omega = moray_fixed(gait->omega);
    limits->delta = moray_fixed(gait->delta);
    limits->power = MORAY_INFINITY;
}

// Begins in the plan's cruise; averaged, without its undulation.
static moray_status pose_problem(moray_heading_plan *plan, moray_heading_spec *spec)
{
    double rate;
    const double heading = moray_reference_at(spec->reference, 0, &rate);
    moray_cruise_start(&plan->cruise, heading, spec->current, spec->start);
    if (spec->averaged) {
        spec->start[0] = heading;
        spec->start[3] = 0;
    }
    for (int k = 0; k < 2; k++)
        spec->undulation[k] = spec->averaged ? 0 : plan->cruise.undulation[k];
    return moray_heading_new(&plan->problem, spec);
}

static moray_status solve(moray_heading_plan *plan, const moray_heading_spec *spec, const moray_settings *settings,
                          const moray_heading_plan *from)
{
    const moray_ocp *ocp = moray_steering_ocp(plan->problem.steering);
    if (from && from->cruise.model == spec->model) {
        const moray_guess guess = moray_guess_from_solution(from->solution);
        return moray_solve(ocp, settings, &guess, &plan->solution);
    }
    guess_samples samples;
    MORAY_TRY(guess_new(&samples, 16 * settings->intervals + 1));
    if (from)
        guess_from_other(&samples, &spec->robot, from, spec->model);
    else
        guess_from_reference(&samples, spec, &plan->cruise);
    const moray_guess guess = {.phase = &samples.samples, .s = samples.s};
    const moray_status status = moray_solve(ocp, settings, &guess, &plan->solution);
    free(samples.time);
    return status;
}

static moray_status make(moray_heading_plan *plan, moray_heading_spec *spec, const moray_settings *settings,
                         const moray_gait *gait, const moray_heading_plan *from)
{
    MORAY_TRY(moray_cruise_find(&plan->cruise, &spec->robot, spec->model, gait));
    MORAY_TRY(pose_problem(plan, spec));
    MORAY_TRY(solve(plan, spec, settings, from));
    if (!spec->averaged)
        return moray_ok();
    const moray_gait found = moray_steering_gait(moray_solution_parameters(plan->solution));
    return moray_cruise_find(&plan->cruise, &spec->robot, spec->model, &found);
}

moray_status moray_heading_plan_make(moray_heading_plan *plan, const moray_heading_spec *spec,
                                     const moray_settings *settings, const moray_gait *gait,
                                     const moray_heading_plan *from)
{
    moray_heading_spec own = *spec;
    own.t0 = 0;
    if (!own.averaged)
        keep_gait(&own, gait);
    *plan = (moray_heading_plan){0};
    const moray_status status = make(plan, &own, settings, gait, from);
    if (moray_failed(status))
        moray_heading_plan_free(plan);
    return status;
}

void moray_heading_plan_free(moray_heading_plan *plan)
{
    moray_solution_free(plan->solution);
    moray_heading_free(&plan->problem);
    *plan = (moray_heading_plan){0};
}
