// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "moray/heading.h"

enum { states = MORAY_STEERING_STATES, most_rounds = 5 };
static const double same_speed = 1e-3, same_angle = 1e-3; // [m/s], [rad]

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

// ---- Rounds
// -----------------------------------------------------------------------------------------------------------

static moray_status solve_from(moray_heading_plan *plan, const moray_settings *settings, const moray_guess *guess)
{
    moray_solution *solution = NULL;
    MORAY_TRY(moray_solve(moray_steering_ocp(plan->problem.steering), settings, guess, &solution));
    plan->solution = solution;
    plan->seconds += moray_solution_info(solution)->seconds;
    plan->rounds++;
    return moray_ok();
}

static moray_status solve_first(moray_heading_plan *plan, const moray_heading_spec *spec,
                                const moray_settings *settings, const moray_heading_plan *from)
{
    if (from && from->cruise.model == spec->model) {
        const moray_guess guess = moray_guess_from_solution(from->solution);
        return solve_from(plan, settings, &guess);
    }
    guess_samples samples;
    MORAY_TRY(guess_new(&samples, 16 * settings->intervals + 1));
    if (from)
        guess_from_other(&samples, &spec->robot, from, spec->model);
    else
        guess_from_reference(&samples, spec, &plan->cruise);
    const moray_status status = solve_from(plan, settings, &(moray_guess){.phase = &samples.samples, .s = samples.s});
    free(samples.time);
    return status;
}

// The problem of a plan that begins in the plan's cruise.
static moray_status pose_problem(moray_heading_plan *plan, moray_heading_spec *spec)
{
    double rate;
    const double heading = moray_reference_at(spec->reference, 0, &rate);
    moray_cruise_start(&plan->cruise, heading, spec->current, spec->start);
    if (spec->averaged)
        spec->start[0] = heading;
    memcpy(spec->undulation, plan->cruise.undulation, sizeof spec->undulation);
    if (spec->averaged)
        memset(spec->undulation, 0, sizeof spec->undulation);
    return moray_heading_new(&plan->problem, spec);
}

static bool agree(const moray_cruise *one, const moray_cruise *other)
{
    return fabs(one->speed - other->speed) < same_speed &&
           hypot(one->undulation[0] - other->undulation[0], one->undulation[1] - other->undulation[1]) < same_angle;
}

// One more round from the plan's own solution, with the cruise of the gait found there.
static moray_status solve_again(moray_heading_plan *plan, moray_heading_spec *spec, const moray_settings *settings)
{
    moray_heading before = plan->problem;
    moray_solution *solution = plan->solution;
    plan->problem = (moray_heading){0};
    moray_status status = pose_problem(plan, spec);
    if (!moray_failed(status)) {
        moray_settings warm = *settings;
        warm.intervals = 0; // the mesh found so far
        const moray_guess guess = moray_guess_from_solution(solution);
        status = solve_from(plan, &warm, &guess);
    }
    if (plan->solution != solution)
        moray_solution_free(solution);
    else if (moray_failed(status)) // nothing may be left that needs the problem before
        moray_solution_free(solution), plan->solution = NULL;
    moray_heading_free(&before);
    return status;
}

static bool solved(const moray_heading_plan *plan)
{
    return moray_solution_info(plan->solution)->outcome == MORAY_NLP_SOLVED;
}

static moray_status make(moray_heading_plan *plan, moray_heading_spec *spec, const moray_settings *settings,
                         const moray_gait *gait, const moray_heading_plan *from)
{
    MORAY_TRY(moray_cruise_find(&plan->cruise, &spec->robot, spec->model, gait));
    MORAY_TRY(pose_problem(plan, spec));
    MORAY_TRY(solve_first(plan, spec, settings, from));
    while (plan->rounds < most_rounds && solved(plan)) {
        const moray_gait found = moray_steering_gait(moray_solution_parameters(plan->solution));
        const moray_cruise before = plan->cruise;
        MORAY_TRY(moray_cruise_find(&plan->cruise, &spec->robot, spec->model, &found));
        if (agree(&before, &plan->cruise))
            break;
        MORAY_TRY(solve_again(plan, spec, settings));
    }
    return moray_ok();
}

moray_status moray_heading_plan_make(moray_heading_plan *plan, const moray_heading_spec *spec,
                                     const moray_settings *settings, const moray_gait *gait,
                                     const moray_heading_plan *from)
{
    moray_heading_spec own = *spec;
    moray_gait start = *gait;
    if (from) {
        start = moray_steering_gait(moray_solution_parameters(from->solution));
        start = moray_gait_map(&spec->robot, &start, from->cruise.model, spec->model);
    }
    own.t0 = 0;
    *plan = (moray_heading_plan){0};
    const moray_status status = make(plan, &own, settings, &start, from);
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
