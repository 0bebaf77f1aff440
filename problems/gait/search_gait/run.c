// SPDX-License-Identifier: MIT
#include <stdlib.h>
#include <string.h>

#include "moray/clock.h"
#include "moray/parallel.h"
#include "search_gait.h"

const char *const search_gait_locals[] = {"slsqp", "mma", "cobyla", NULL};
const char *const search_gait_globals[] = {"none", "mlsl", "isres", "direct", NULL};

static const moray_search_method local_methods[] = {MORAY_SEARCH_SLSQP, MORAY_SEARCH_MMA, MORAY_SEARCH_COBYLA};
static const moray_search_method global_methods[] = {MORAY_SEARCH_SLSQP, MORAY_SEARCH_MLSL, MORAY_SEARCH_ISRES,
                                                     MORAY_SEARCH_DIRECT}; // "none" is not run

static const double KEPT = 1e-6; // violation of a limit, relative to it, that an optimum may have

double search_gait_theta_max(const search_gait *run, const moray_gait *gait)
{
    return moray_theta_max_from_amplitude(&run->spec.robot, run->spec.model, gait->amplitude, gait->delta);
}

static moray_status interrupted(void)
{
    return moray_error(MORAY_INTERRUPTED, "interrupted while searching; nothing is written");
}

// ---- Searching -----------------------------------------------------------------------------------------------------

static bool show_search(void *observer, const moray_search_progress *at)
{
    const search_gait *run = observer;
    const bool fastest = search_gait_fastest(run);
    moray_ticker_show(&run->job.ticker, "search_gait: %s, %d orbits, %.5f %s%s", run->activity, at->evaluations,
                      fastest ? -at->objective : at->objective, fastest ? "m/s" : "J/m",
                      at->violation > KEPT ? " (beyond limits)" : "");
    return !moray_interrupted();
}

static moray_search_settings local_settings(search_gait *run)
{
    moray_search_settings settings = moray_search_settings_default();
    settings.method = local_methods[run->local_method];
    settings.progress = show_search;
    settings.observer = run;
    return settings;
}

// A local search and where it ends.
typedef struct descent {
    moray_gait gait; // where it starts, then where it ends
    moray_orbit_result orbit;
    moray_search_info info;
    bool found; // an optimum
    int orbits;
    double seconds;
    moray_status status; // there was no search
} descent;

// Searches until a search from its own end gains no more: SLSQP may lose its way at first.
static void search_from(search_gait *run, moray_gait_search *search, descent *d)
{
    const moray_search_settings settings = local_settings(run);
    const double start = moray_clock();
    double before = INFINITY;
    bool found = true;
    for (int round = 0; round < 3 && found && !moray_interrupted(); round++) {
        found = !moray_failed(moray_gait_search_run(search, &settings, &d->gait, &d->orbit, &d->info));
        d->orbits += d->info.evaluations;
        if (d->info.violation <= KEPT && before - d->info.objective < 1e-9)
            break;
        before = d->info.violation <= KEPT ? d->info.objective : INFINITY;
    }
    d->seconds = moray_clock() - start;
    d->found = found && d->info.outcome != MORAY_SEARCH_FAILED && d->info.violation <= KEPT;
}

// By a search of its own, so that it depends on none before; its orbits begin from that of the paper's gait, if there
// is one.
static void search_locally(search_gait *run, descent *d)
{
    moray_gait_search *search;
    moray_orbit_result paper;
    d->status = moray_gait_search_new(&search, &run->spec, run->job.common.scheme, run->job.common.intervals);
    if (moray_failed(d->status))
        return;
    (void)moray_orbit_solve(moray_gait_search_orbit(search), &run->job.paper.gait[run->spec.model], &paper);
    search_from(run, search, d);
    moray_gait_search_free(search);
}

static bool same_gait(const search_gait *run, const moray_gait *a, const moray_gait *b)
{
    const double angle = 0.5 * DEG;
    return fabs(search_gait_theta_max(run, a) - search_gait_theta_max(run, b)) < angle &&
           fabs(a->delta - b->delta) < angle && fabs(a->omega / b->omega - 1) < 0.01;
}

// The optimum where this end belongs, a new one if it is none of those known; NULL when there are too many.
static optimum *place(search_gait *run, const moray_gait *gait, const moray_orbit_result *orbit, double objective)
{
    int k = 0;
    while (k < run->n && !same_gait(run, gait, &run->optimum[k].gait))
        k++;
    if (k == SEARCH_GAIT_OPTIMA)
        return NULL;
    optimum *at = &run->optimum[k];
    if (k == run->n)
        run->optimum[run->n++] = (optimum){.objective = INFINITY};
    if (objective < at->objective) {
        at->gait = *gait;
        at->orbit = *orbit;
        at->objective = objective;
    }
    return at;
}

// The paper's gait, or a random one that holds the course: none else is a start. Error: MORAY_NOT_SOLVED when there
// seems to be none.
static moray_status start_gait(search_gait *run, int k, moray_gait *gait)
{
    const int most_draws = 30;
    moray_orbit_result orbit;
    *gait = run->job.paper.gait[run->spec.model];
    for (int draw = 0; k > 0; draw++) {
        *gait = gait_job_random(&run->job, &run->demand);
        const moray_status status = moray_orbit_solve(moray_gait_search_orbit(run->search), gait, &orbit);
        if (!moray_failed(status) || moray_interrupted())
            return moray_ok();
        if (draw == most_draws)
            return moray_error(MORAY_NOT_SOLVED,
                               "current = %g,%g: of %d gaits drawn from the limits none holds the course",
                               run->spec.current[0], run->spec.current[1], most_draws);
    }
    return moray_ok();
}

// The optimum where a search ended; NULL if at none.
static optimum *take(search_gait *run, const descent *d)
{
    run->orbits += d->orbits;
    run->seconds += d->seconds;
    return d->found ? place(run, &d->gait, &d->orbit, d->info.objective) : NULL;
}

// A moray_task_fn; result: a descent, in which the gait is where it starts.
static void search_task(int k, void *result, void *self)
{
    search_gait *run = self;
    char activity[64];
    snprintf(activity, sizeof activity, "start %d of %d", k + 1, run->starts);
    run->activity = activity;
    if (!moray_interrupted())
        search_locally(run, result);
}

static moray_status search_side_by_side(search_gait *run, descent *d)
{
    for (int k = 0; k < run->starts; k++)
        MORAY_TRY(start_gait(run, k, &d[k].gait));
    MORAY_TRY(moray_parallel(run->starts, sizeof *d, d, search_task, run, run->job.jobs));
    if (moray_interrupted())
        return interrupted();
    for (int k = 0; k < run->starts; k++) {
        MORAY_TRY(d[k].status);
        optimum *at = take(run, &d[k]);
        run->lost += at == NULL;
        if (at)
            at->hits++;
    }
    return moray_ok();
}

static moray_status search_from_starts(search_gait *run)
{
    srand48(run->seed);
    run->starts = 1 + run->job.random_starts;
    descent *d = calloc((size_t)run->starts, sizeof *d);
    if (!d)
        return moray_error(MORAY_MEMORY, "no memory for %d starts", run->starts);
    const moray_status status = search_side_by_side(run, d);
    free(d);
    return status;
}

// The global search's end counts as the optimum to which a local search leads from it.
static moray_status search_globally(search_gait *run)
{
    moray_search_settings settings = local_settings(run);
    descent d = {.gait = run->job.paper.gait[run->spec.model]};
    settings.method = global_methods[run->global_method];
    settings.max_evaluations = run->global_orbits;
    settings.seed = (unsigned long)run->seed;
    run->activity = search_gait_globals[run->global_method];
    MORAY_TRY(moray_gait_search_run(run->search, &settings, &d.gait, &d.orbit, &run->global));
    search_locally(run, &d);
    MORAY_TRY(d.status);
    optimum *at = take(run, &d);
    if (at)
        at->global = true;
    return moray_interrupted() ? interrupted() : moray_ok();
}

static int by_objective(const void *one, const void *other)
{
    const optimum *a = one, *b = other;
    return (a->objective > b->objective) - (a->objective < b->objective);
}

// ---- Polishing -----------------------------------------------------------------------------------------------------

static moray_bounds around(moray_bounds limits, double value, double reach)
{
    return moray_between(fmax(limits.lower, fmin(value, limits.upper) - reach),
                         fmin(limits.upper, fmax(value, limits.lower) + reach));
}

// Near the optimum alone: Ipopt starts by moving away from the limits, and may come back in another valley.
static moray_gait_problem_spec nearby(const search_gait *run, const moray_gait *gait)
{
    moray_gait_problem_spec spec = run->spec;
    spec.limits.theta_max = around(spec.limits.theta_max, search_gait_theta_max(run, gait), 2 * DEG);
    spec.limits.delta = around(spec.limits.delta, gait->delta, 4 * DEG);
    spec.limits.omega = around(spec.limits.omega, gait->omega, 0.1 * gait->omega);
    return spec;
}

static moray_status polish(search_gait *run, optimum *o)
{
    const moray_gait_problem_spec spec = nearby(run, &o->gait);
    moray_orbit *orbit = moray_gait_search_orbit(run->search);
    moray_orbit_result result;
    moray_swim_track track;
    o->at = run->demand;
    MORAY_TRY(moray_orbit_solve(orbit, &o->gait, &result));
    MORAY_TRY(moray_orbit_floquet(orbit, &o->floquet));
    MORAY_TRY(moray_gait_problem_new(&o->at.problem, &spec));
    MORAY_TRY(moray_orbit_track(orbit, 101, &track));
    const moray_status status = gait_job_solve_from(&run->job, o->at.problem, &o->gait, &track, &o->at.solution);
    moray_swim_track_free(&track);
    if (moray_failed(status))
        return status;
    if (moray_interrupted())
        return interrupted();
    o->at.prediction = moray_gait_problem_prediction(o->at.problem, o->at.solution);
    o->at.starts = run->starts;
    o->at.agreeing = o->hits;
    return moray_ok();
}

static moray_status make_search(search_gait *run)
{
    gait_job *job = &run->job;
    MORAY_TRY(gait_job_prepare(job));
    MORAY_TRY(gait_job_demand(job, job->snake.model, &run->demand));
    run->spec = gait_job_spec(job, &run->demand, job->goal, job->snake.current);
    return moray_gait_search_new(&run->search, &run->spec, job->common.scheme, job->common.intervals);
}

moray_status search_gait_run(search_gait *run)
{
    MORAY_TRY(make_search(run));
    MORAY_TRY(search_from_starts(run));
    if (run->global_method > 0)
        MORAY_TRY(search_globally(run));
    if (run->n == 0)
        return moray_error(MORAY_NOT_SOLVED,
                           "none of %d starts leads to a gait within the limits that holds the course", run->starts);
    qsort(run->optimum, (size_t)run->n, sizeof *run->optimum, by_objective);
    const double speed = moray_course_speed(&run->optimum[0].orbit.steady, run->spec.course);
    if (speed <= 0)
        return moray_error(MORAY_NOT_SOLVED,
                           "current = %g,%g: the robot cannot stem it: within the limits the best gait makes %.4f m/s "
                           "along the course",
                           run->spec.current[0], run->spec.current[1], speed);
    for (; run->shown < run->n && run->shown < SEARCH_GAIT_SHOWN; run->shown++) {
        const moray_status status = polish(run, &run->optimum[run->shown]);
        if (moray_failed(status)) {
            gait_job_stage_free(&run->optimum[run->shown].at);
            return status;
        }
    }
    stage *at[SEARCH_GAIT_SHOWN];
    for (int k = 0; k < run->shown; k++)
        at[k] = &run->optimum[k].at;
    MORAY_TRY(gait_job_prove(&run->job, at, run->shown));
    return gait_job_climb(&run->job, at, run->shown);
}

// ---- Ridge ---------------------------------------------------------------------------------------------------------

// From the gait before, or where that fails from the paper's.
static double best_at(search_gait *run, double delta, moray_gait *gait)
{
    moray_gait_problem_spec spec = run->spec;
    moray_orbit_result orbit;
    moray_search_info info = {.violation = INFINITY};
    const moray_search_settings settings = local_settings(run);
    moray_gait_search *search;
    const double theta_max = search_gait_theta_max(run, gait);
    spec.limits.delta = moray_fixed(delta);
    if (moray_failed(moray_gait_search_new(&search, &spec, run->job.common.scheme, run->job.common.intervals)))
        return NAN;
    gait->delta = delta;
    gait->amplitude = moray_amplitude_from_theta_max(&spec.robot, spec.model, theta_max, delta);
    const bool found = !moray_failed(moray_gait_search_run(search, &settings, gait, &orbit, &info));
    moray_gait_search_free(search);
    if (!found || info.violation > KEPT)
        return NAN;
    return search_gait_value(run, moray_course_speed(&orbit.steady, spec.course), orbit.steady.power);
}

moray_status search_gait_ridge(search_gait *run)
{
    const moray_bounds range = run->spec.limits.delta;
    moray_gait gait = run->job.paper.gait[run->spec.model];
    run->activity = "the ridge";
    for (int k = 0; k < SEARCH_GAIT_RIDGE; k++) {
        const double delta = range.lower + (range.upper - range.lower) * k / (SEARCH_GAIT_RIDGE - 1);
        run->ridge[0][k] = delta / DEG;
        run->ridge[1][k] = best_at(run, delta, &gait);
        if (isnan(run->ridge[1][k]))
            gait = run->job.paper.gait[run->spec.model];
        if (moray_interrupted())
            return interrupted();
    }
    return moray_ok();
}
