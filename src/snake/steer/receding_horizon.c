// SPDX-License-Identifier: MIT
#include "moray/snake/receding_horizon.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { states = MORAY_STEERING_STATES, per_interval = 4 }; // samples of a guess

struct moray_receding_horizon {
    moray_receding_horizon_spec spec;
    double due;    // time of the next plan
    void *problem; // of the plan now carried out
    moray_solution *solution;
    moray_receding_horizon_record record;
    int n;          // samples of a guess
    double guess[]; // times, states, controls
};

// Processor time of this process [s].
static double processor(void)
{
    struct timespec at;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &at);
    return (double)at.tv_sec + 1e-9 * (double)at.tv_nsec;
}

// ---- From the swimmer to the plan ----------------------------------------------------------------------------------

// Undulation of the heading and its rate at t.
static void undulation(const moray_straight_motion *straight, double t, double *angle, double *rate)
{
    const double omega = straight->gait.omega, c = cos(omega * t), s = sin(omega * t), *factor = straight->undulation;
    *angle = factor[0] * c + factor[1] * s;
    *rate = omega * (factor[1] * c - factor[0] * s);
}

// The state that a plan starts from: the measured one, with the undulation that the plan's model has in place of that
// of the swimmer's, and the offset as it is.
static void measure(const moray_receding_horizon *r, const moray_swim_sample *sample, double state[states])
{
    const moray_straight_motion *from = r->spec.measured, *to = r->spec.planned;
    const moray_offset offset = moray_receding_horizon_controller((moray_receding_horizon *)r).offset(sample->t, r);
    moray_state_body(from->model, r->spec.links, sample->x, state);
    if (from->model != to->model) {
        double angle[2], rate[2];
        undulation(from, sample->t, &angle[0], &rate[0]);
        undulation(to, sample->t, &angle[1], &rate[1]);
        state[0] += angle[1] - angle[0];
        state[3] += rate[1] - rate[0];
        const double turn = to->model == MORAY_FIRST_PRINCIPLES ? state[0] : -state[0], v[2] = {state[4], state[5]};
        state[4] = v[0] * cos(turn) - v[1] * sin(turn);
        state[5] = v[0] * sin(turn) + v[1] * cos(turn);
    }
    state[6] = offset.value / r->spec.scale;
    state[7] = offset.rate / r->spec.scale;
    const moray_steering_limits *limits = r->spec.limits; // kept to rounding only
    state[6] = fmin(fmax(state[6], -limits->offset), limits->offset);
    state[7] = fmin(fmax(state[7], -limits->offset_rate), limits->offset_rate);
}

// ---- Plans ---------------------------------------------------------------------------------------------------------

// The last plan, moved on; without one a straight line from the start.
static moray_guess guess_of(moray_receding_horizon *r, double t, const double state[states], moray_samples *samples,
                            double *s)
{
    const moray_solution *from = r->solution ? r->solution : r->spec.first;
    const int nu = r->spec.replanner.nu;
    double *time = r->guess, *x = time + r->n, *u = x + states * r->n;
    for (int k = 0; k < r->n; k++) {
        time[k] = t + r->spec.horizon * k / (r->n - 1);
        memset(u + k * nu, 0, (size_t)nu * sizeof *u);
        memcpy(x + k * states, state, states * sizeof *x);
        if (from)
            moray_solution_at(from, 0, time[k], x + k * states, u + k * nu);
    }
    moray_steering_parameters(&r->spec.planned->gait, s);
    *samples = (moray_samples){.n = r->n, .time = time, .x = x, .u = u};
    return (moray_guess){.phase = samples, .s = s};
}

static moray_status solve(moray_receding_horizon *r, double t, const double state[states], const moray_ocp *ocp,
                          moray_solution **solution)
{
    double s[MORAY_STEERING_PARAMETERS];
    moray_samples samples;
    const moray_guess guess = guess_of(r, t, state, &samples, s);
    moray_settings settings = r->spec.settings;
    if (r->solution)
        settings.barrier = 1e-5;
    MORAY_TRY(moray_solve(ocp, &settings, &guess, solution));
    const moray_nlp_info *info = moray_solution_info(*solution);
    r->record.iterations += info->iterations;
    if (info->outcome == MORAY_NLP_SOLVED || info->outcome == MORAY_NLP_ACCEPTABLE)
        return moray_ok();
    return moray_error(MORAY_NOT_SOLVED, "%.250s", moray_solution_diagnosis(*solution));
}

static void drop(const moray_receding_horizon *r, void *problem, moray_solution *solution)
{
    moray_solution_free(solution);
    if (problem)
        r->spec.replanner.free(problem);
}

static void plan(moray_receding_horizon *r, const moray_swim_sample *sample)
{
    const moray_replanner *replanner = &r->spec.replanner;
    double state[states];
    void *problem = NULL;
    const moray_ocp *ocp;
    moray_solution *solution = NULL;
    measure(r, sample, state);
    moray_status status = replanner->make(replanner->self, sample->t, state, &problem, &ocp);
    if (!moray_failed(status))
        status = solve(r, sample->t, state, ocp, &solution);
    if (moray_failed(status)) {
        if (r->record.failures++ == 0)
            snprintf(r->record.first_failure, sizeof r->record.first_failure, "t = %.6g s: %.170s", sample->t,
                     status.text);
        drop(r, problem, solution);
        return;
    }
    drop(r, r->problem, r->solution);
    r->problem = problem;
    r->solution = solution;
}

static void look(const moray_swim_sample *sample, void *self)
{
    moray_receding_horizon *r = self;
    const moray_replanner *replanner = &r->spec.replanner;
    const double t = sample->t, rounding = 1e-9 * r->spec.interval;
    const bool changed = replanner->changed && r->record.plans > 0 && replanner->changed(replanner->self, t);
    if (t < r->due - rounding && !changed)
        return;
    const double start = processor();
    plan(r, sample);
    const double spent = processor() - start;
    r->due = t + r->spec.interval;
    r->record.seconds += spent;
    if (r->record.plans++ > 0)
        r->record.longest = fmax(r->record.longest, spent);
}

static moray_offset offset(double t, const void *self)
{
    const moray_receding_horizon *r = self;
    if (!r->solution)
        return (moray_offset){0};
    return moray_plan_offset(&(moray_plan){r->solution, r->spec.scale}, t);
}

moray_controller moray_receding_horizon_controller(moray_receding_horizon *receding)
{
    const moray_receding_horizon_spec *spec = &receding->spec;
    return (moray_controller){
        .offset = offset, .look = look, .period = spec->look > 0 ? spec->look : spec->interval, .self = receding};
}

// ---- Handling ------------------------------------------------------------------------------------------------------

moray_status moray_receding_horizon_new(moray_receding_horizon **result, const moray_receding_horizon_spec *spec)
{
    *result = NULL;
    if (!(spec->interval > 0 && spec->horizon >= spec->interval))
        return moray_error(MORAY_INPUT, "horizon = %g s, replanned every %g s: the horizon must be the longer",
                           spec->horizon, spec->interval);
    const int n = per_interval * spec->settings.intervals + 1;
    moray_receding_horizon *r = calloc(1, sizeof *r + (size_t)(n * (1 + states + spec->replanner.nu)) * sizeof(double));
    if (!r)
        return moray_error(MORAY_MEMORY, "no memory for a receding horizon");
    r->spec = *spec;
    r->n = n;
    r->due = -INFINITY;
    *result = r;
    return moray_ok();
}

void moray_receding_horizon_free(moray_receding_horizon *receding)
{
    if (!receding)
        return;
    drop(receding, receding->problem, receding->solution);
    free(receding);
}

const moray_receding_horizon_record *moray_receding_horizon_record_of(const moray_receding_horizon *receding)
{
    return &receding->record;
}

// ---- Heading tracking ----------------------------------------------------------------------------------------------

static moray_status make_heading(void *self, double t, const double state[states], void **problem,
                                 const moray_ocp **ocp)
{
    moray_heading_replanner *r = self;
    moray_heading_spec spec = r->spec;
    double rate;
    moray_heading *heading = calloc(1, sizeof *heading);
    if (!heading)
        return moray_error(MORAY_MEMORY, "no memory for a plan");
    memcpy(spec.start, state, sizeof spec.start);
    spec.t0 = t;
    spec.t1 = t + r->horizon;
    if (!r->preview) {
        r->held = (moray_reference){.n = 1, .time = &r->held_time, .heading = &r->held_heading};
        r->held_time = t;
        r->held_heading = moray_reference_at(r->spec.reference, nextafter(t, INFINITY), &rate);
        spec.reference = &r->held;
    }
    const moray_status status = moray_heading_new(heading, &spec);
    if (moray_failed(status)) {
        free(heading);
        return status;
    }
    *problem = heading;
    *ocp = moray_steering_ocp(heading->steering);
    return status;
}

static bool heading_changed(const void *self, double t)
{
    const moray_heading_replanner *r = self;
    double rate;
    const double heading = moray_reference_at(r->spec.reference, nextafter(t, INFINITY), &rate);
    return fabs(heading - r->held_heading) > r->tolerance;
}

static void free_heading(void *problem)
{
    moray_heading_free(problem);
    free(problem);
}

moray_replanner moray_heading_replan(moray_heading_replanner *replanner)
{
    return (moray_replanner){.make = make_heading,
                             .free = free_heading,
                             .changed = replanner->preview ? NULL : heading_changed,
                             .self = replanner,
                             .nu = 1};
}
