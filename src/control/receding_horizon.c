// SPDX-License-Identifier: MIT
#include "moray/control/receding_horizon.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "moray/clock.h"
#include "ocp/solution.h"

enum { PER_INTERVAL = 4 };        // samples of a guess
static const double WARM = 1e-5;  // barrier where a plan starts from the one before
static const double EARLY = 1e-9; // of an interval: rounding by which a measurement may come before it is due

struct moray_receding_horizon {
    moray_receding_horizon_spec spec;
    double due;    // time of the next plan
    void *problem; // of the plan in force; NULL: it is the spec's
    moray_solution *solution;
    moray_receding_horizon_record record;
    moray_replan *replan; // [room]
    int room;
    int nx, nu, ns; // of the plans
    int n;          // samples of a guess
    double guess[]; // times, states, controls
};

// ---- Plans ---------------------------------------------------------------------------------------------------------

static moray_status check_sizes(const moray_receding_horizon *r, const moray_ocp *ocp, const char *what)
{
    int nx, nu;
    if (ocp->phases != 1)
        return moray_error(MORAY_INPUT, "%s has %d phases: must be 1", what, ocp->phases);
    moray_ocp_widths(ocp, 0, &nx, &nu);
    if (nx != r->nx || nu != r->nu || ocp->ns != r->ns)
        return moray_error(MORAY_INPUT,
                           "%s has %d states, %d controls, %d parameters: the receding horizon has %d, %d, %d", what,
                           nx, nu, ocp->ns, r->nx, r->nu, r->ns);
    return moray_ok();
}

// A plan that was seen from another state: the gap to this one closes along it, in even steps, so that no interval
// alone has to make up for it.
static void close_gap(const double *state, int n, int nx, double *x)
{
    for (int i = 0; i < nx; i++) {
        const double gap = state[i] - x[i];
        for (int k = 0; k < n; k++)
            x[(size_t)k * (size_t)nx + (size_t)i] += gap * (1 - k / (n - 1.0));
    }
}

// The last plan, moved on to begin in the state; without one the state stays, and controls are the zeros that they were
// made of.
static moray_guess guess_from(moray_receding_horizon *r, double t, const double *state, moray_samples *samples)
{
    const moray_solution *from = r->solution ? r->solution : r->spec.first;
    const size_t nx = (size_t)r->nx, nu = (size_t)r->nu;
    double *time = r->guess, *x = time + r->n, *u = x + nx * (size_t)r->n;
    for (int k = 0; k < r->n; k++) {
        time[k] = t + r->spec.horizon * k / (r->n - 1);
        memcpy(x + (size_t)k * nx, state, nx * sizeof *x);
        if (from)
            moray_solution_at(from, 0, time[k], x + (size_t)k * nx, u + (size_t)k * nu);
    }
    close_gap(state, r->n, r->nx, x);
    *samples = (moray_samples){.n = r->n, .time = time, .x = x, .u = nu > 0 ? u : NULL};
    const double *s = r->spec.s ? r->spec.s : from ? moray_solution_parameters(from) : NULL;
    return (moray_guess){.phase = samples, .s = s};
}

static moray_status solve(moray_receding_horizon *r, double t, const double *state, const moray_ocp *ocp,
                          moray_solution **solution, int *iterations)
{
    moray_samples samples;
    moray_guess guess = {.from = r->solution, .along_time = true};
    if (!r->spec.ocp || !r->solution)
        guess = guess_from(r, t, state, &samples);
    moray_settings settings = r->spec.settings;
    settings.rough = true;
    if (r->solution)
        settings.barrier = WARM;
    MORAY_TRY(moray_solve(ocp, &settings, &guess, solution));
    const moray_nlp_info *info = moray_solution_info(*solution);
    *iterations = info->iterations;
    if (info->outcome == MORAY_NLP_SOLVED || info->outcome == MORAY_NLP_ACCEPTABLE)
        return moray_ok();
    return moray_solution_failure(*solution);
}

static void drop(const moray_receding_horizon *r, void *problem, moray_solution *solution)
{
    moray_solution_free(solution);
    if (problem)
        r->spec.replanner.free(problem);
}

// The problem from here on.
static moray_status pose(moray_receding_horizon *r, double t, const double *state, void **problem,
                         const moray_ocp **ocp)
{
    const moray_replanner *replanner = &r->spec.replanner;
    *ocp = r->spec.ocp;
    return r->spec.ocp ? moray_ocp_restart(r->spec.ocp, t, r->spec.horizon, state)
                       : replanner->make(replanner->self, t, state, problem, ocp);
}

// Puts a new plan in force; `why` tells the failure when the old one stays. Error: problems of other sizes; no memory,
// which is no failure of the plan.
static moray_status plan(moray_receding_horizon *r, double t, const double *state, int *iterations, moray_status *why)
{
    void *problem = NULL;
    const moray_ocp *ocp;
    moray_solution *solution = NULL;
    *why = pose(r, t, state, &problem, &ocp);
    if (moray_failed(*why))
        return why->code == MORAY_MEMORY ? *why : moray_ok();
    moray_status status = check_sizes(r, ocp, "the problem");
    if (!moray_failed(status))
        *why = solve(r, t, state, ocp, &solution, iterations);
    if (why->code == MORAY_MEMORY)
        status = *why;
    if (moray_failed(status) || moray_failed(*why)) {
        drop(r, problem, solution);
        return status;
    }
    drop(r, r->problem, r->solution);
    r->problem = problem;
    r->solution = solution;
    return moray_ok();
}

static void keep_record(moray_receding_horizon *r, const moray_replan *made, const char *why)
{
    moray_receding_horizon_record *record = &r->record;
    record->seconds += made->seconds;
    record->iterations += made->iterations;
    if (record->plans > 0)
        record->longest = fmax(record->longest, made->seconds);
    r->replan[record->plans++] = *made;
    if (made->failed && record->failures++ == 0)
        snprintf(record->first_failure, sizeof record->first_failure, "t = %.6g: %.170s", made->t, why);
}

static moray_status make_room(moray_receding_horizon *r)
{
    if (r->record.plans < r->room)
        return moray_ok();
    const int room = 2 * r->room + 64;
    moray_replan *larger = realloc(r->replan, (size_t)room * sizeof *larger);
    if (!larger)
        return moray_error(MORAY_MEMORY, "no memory for the record of %d plans", room);
    r->replan = larger;
    r->room = room;
    return moray_ok();
}

moray_status moray_receding_horizon_measure(moray_receding_horizon *r, double t, const double *x)
{
    const moray_replanner *replanner = &r->spec.replanner;
    const bool changed = replanner->changed && r->record.plans > 0 && replanner->changed(replanner->self, t);
    if (t < r->due - EARLY * r->spec.interval && !changed)
        return moray_ok();
    MORAY_TRY(make_room(r));
    moray_replan made = {.t = t};
    moray_status why = moray_ok();
    const double start = moray_processor_clock();
    MORAY_TRY(plan(r, t, x, &made.iterations, &why));
    made.seconds = moray_processor_clock() - start;
    made.failed = moray_failed(why);
    keep_record(r, &made, why.text);
    r->due = t + r->spec.interval;
    return moray_ok();
}

void moray_receding_horizon_control(const moray_receding_horizon *r, double t, double *u)
{
    memset(u, 0, (size_t)r->nu * sizeof *u);
    if (r->solution)
        moray_solution_at(r->solution, 0, t, NULL, u);
}

// ---- As a controller -----------------------------------------------------------------------------------------------

static void control(double t, double *u, const void *self)
{
    moray_receding_horizon_control(self, t, u);
}

static moray_status measure(const moray_closed_loop_sample *sample, void *self)
{
    return moray_receding_horizon_measure(self, sample->t, sample->x);
}

moray_controller moray_receding_horizon_controller(moray_receding_horizon *receding)
{
    const moray_receding_horizon_spec *spec = &receding->spec;
    return (moray_controller){.nu = receding->nu,
                              .control = control,
                              .measure = measure,
                              .period = spec->watch > 0 ? spec->watch : spec->interval,
                              .self = receding};
}

// ---- Handling ------------------------------------------------------------------------------------------------------

static moray_status check(const moray_receding_horizon *r)
{
    const moray_receding_horizon_spec *spec = &r->spec;
    if (!(spec->interval > 0 && spec->horizon >= spec->interval && isfinite(spec->horizon)))
        return moray_error(MORAY_INPUT, "horizon = %g, replanned every %g: the horizon must be the longer",
                           spec->horizon, spec->interval);
    if (!(spec->watch >= 0 && spec->watch <= spec->interval))
        return moray_error(MORAY_INPUT, "watch = %g: must lie between 0 and the interval, %g", spec->watch,
                           spec->interval);
    if (spec->settings.intervals < 1)
        return moray_error(MORAY_INPUT, "intervals = %d: a plan has at least 1", spec->settings.intervals);
    if (!spec->ocp == !spec->replanner.make)
        return moray_error(MORAY_INPUT, "a receding horizon needs a problem or a replanner, and only one");
    if (r->nx < 1 || r->nu < 0 || r->ns < 0)
        return moray_error(MORAY_INPUT, "plans of %d states, %d controls, %d parameters: must be at least 1, 0 and 0",
                           r->nx, r->nu, r->ns);
    if (spec->ocp)
        MORAY_TRY(check_sizes(r, spec->ocp, "the problem"));
    return spec->first ? check_sizes(r, spec->first->transcription->ocp, "the first plan") : moray_ok();
}

moray_status moray_receding_horizon_new(moray_receding_horizon **result, const moray_receding_horizon_spec *spec)
{
    *result = NULL;
    moray_receding_horizon asked = {
        .spec = *spec, .nx = spec->replanner.nx, .nu = spec->replanner.nu, .ns = spec->replanner.ns};
    if (spec->ocp) {
        moray_ocp_widths(spec->ocp, 0, &asked.nx, &asked.nu);
        asked.ns = spec->ocp->ns;
    }
    MORAY_TRY(check(&asked));
    const size_t n = PER_INTERVAL * (size_t)spec->settings.intervals + 1;
    const size_t width = 1 + (size_t)asked.nx + (size_t)asked.nu;
    moray_receding_horizon *r = calloc(1, sizeof *r + n * width * sizeof *r->guess);
    if (!r)
        return moray_error(MORAY_MEMORY, "no memory for a receding horizon");
    *r = asked;
    r->n = (int)n;
    r->due = -INFINITY;
    *result = r;
    return moray_ok();
}

void moray_receding_horizon_free(moray_receding_horizon *receding)
{
    if (!receding)
        return;
    drop(receding, receding->problem, receding->solution);
    free(receding->replan);
    free(receding);
}

const moray_solution *moray_receding_horizon_plan(const moray_receding_horizon *receding)
{
    return receding->solution;
}

const moray_receding_horizon_record *moray_receding_horizon_record_of(const moray_receding_horizon *receding)
{
    return &receding->record;
}

const moray_replan *moray_receding_horizon_replans(const moray_receding_horizon *receding)
{
    return receding->replan;
}
