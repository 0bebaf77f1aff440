// SPDX-License-Identifier: MIT
#include <string.h>

#include "job.h"

static const double look_every = 0.1;             // of a feedback [s]
static const double rough = 1e-6, careful = 1e-8; // tolerances of simulations
static const double patience = 1.5;               // times the duration of the plan, before the end is given up
enum { per_second = 20 };

// ---- Controllers
// ---------------------------------------------------------------------------------------------------------

// All that a controller may need, for one trial on one model.
typedef struct steersman {
    moray_guidance guidance;
    moray_plan plan;
    moray_feedback feedback;
    moray_path_replanner replanner;
    moray_receding_horizon *receding;
    moray_controller controller;
} steersman;

static moray_steering_limits limits_of(const path_job *job, moray_model model)
{
    return steer_limits(&job->input, &job->common.robot, &job->straight[0][model]);
}

static void set_feedback(const path_job *job, const path_trial *trial, moray_model model, steersman *h)
{
    const moray_steering_limits limits = limits_of(job, model);
    const bool both = trial->law == PATH_BOTH;
    h->guidance = (moray_guidance){.path = &job->path,
                                   .plan = both ? &job->plan[trial->plan] : NULL,
                                   .plan_scale = h->plan.scale,
                                   .lookahead = trial->lookahead,
                                   .ahead = trial->ahead,
                                   .gain = trial->integral_gain,
                                   .period = look_every};
    h->feedback = (moray_feedback){
        .target = moray_guidance_target,
        .feed = both ? moray_guidance_feed : NULL,
        .self = &h->guidance,
        .gain = trial->gain * steer_offset_ratio(job->straight[trial->gait], MORAY_CONTROL_ORIENTED, model),
        .straight = &job->straight[trial->gait][model],
        .offset = limits.offset,
        .offset_rate = limits.offset_rate,
        .period = look_every};
    h->controller = moray_feedback_controller(&h->feedback);
}

static moray_status set_receding(const path_job *job, const path_trial *trial, moray_model model, steersman *h)
{
    const moray_straight_motion *straight = &job->straight[trial->gait][trial->plan];
    const double period = 2 * M_PI / straight->gait.omega, horizon = job->look_ahead_periods * period;
    const double scale = steer_offset_ratio(job->straight[trial->gait], trial->plan, model);
    const moray_steering_limits own = limits_of(job, trial->plan), swum = limits_of(job, model);
    const double seconds = moray_path_duration(&job->path, 0, straight->speed, job->common.current);
    h->replanner = (moray_path_replanner){.spec = path_spec(job, trial->plan, false), .horizon = horizon};
    h->replanner.spec.limits = steer_replanning_limits(&job->common.robot, straight, &own, &swum, scale);
    h->replanner.spec.tube = MORAY_INFINITY;
    h->replanner.spec.speed = job->path.length / seconds;
    moray_receding_horizon_spec spec = {.links = job->common.robot.links,
                                        .replanner = moray_path_replan(&h->replanner),
                                        .settings = moray_settings_default(),
                                        .limits = &h->replanner.spec.limits,
                                        .planned = straight,
                                        .measured = &job->straight[trial->gait][model],
                                        .scale = scale,
                                        .horizon = horizon,
                                        .interval = job->replan_periods * period,
                                        .first = job->plan[trial->plan].solution};
    spec.settings.scheme = "radau4";
    spec.settings.intervals = (int)ceil(4 * job->look_ahead_periods);
    spec.settings.tolerance = 1e-6;
    spec.settings.max_iterations = 200;
    MORAY_TRY(moray_receding_horizon_new(&h->receding, &spec));
    h->controller = moray_receding_horizon_controller(h->receding);
    return moray_ok();
}

static moray_status set_controller(const path_job *job, const path_trial *trial, moray_model model, steersman *h)
{
    *h = (steersman){
        .plan = {job->plan[trial->plan].solution, steer_offset_ratio(job->straight[trial->gait], trial->plan, model)}};
    if (trial->law == PATH_RECEDING)
        return set_receding(job, trial, model, h);
    if (trial->law == PATH_PLAN)
        h->controller = moray_plan_controller(&h->plan);
    else
        set_feedback(job, trial, model, h);
    return moray_ok();
}

double path_real_time(const path_job *job, const path_trial *trial, const moray_receding_horizon_record *record)
{
    const double period = 2 * M_PI / job->straight[trial->gait][trial->plan].gait.omega;
    return record->plans * job->replan_periods * period / record->seconds;
}

// ---- Swimming ------------------------------------------------------------------------------------------------------

static moray_status swim(const path_job *job, path_trial *trial, moray_model model, double tolerance,
                         moray_closed_loop *closed_loop)
{
    steersman h;
    double t0, tf;
    moray_path_seeker seeker = {&job->path, 0};
    MORAY_TRY(set_controller(job, trial, model, &h));
    moray_solution_times(path_last_plan(job)->solution, 0, &t0, &tf);
    const double duration = patience * tf;
    const moray_closed_loop_spec plan = {.robot = &job->common.robot,
                                         .straight = &job->straight[trial->gait][model],
                                         .heading = job->heading,
                                         .position = {job->start[0], job->start[1]},
                                         .current = {job->common.current[0], job->common.current[1]},
                                         .controller = &h.controller,
                                         .duration = duration,
                                         .intervals = (int)ceil(per_second * duration),
                                         .tolerance = tolerance,
                                         .observe = moray_path_seek,
                                         .observer = &seeker};
    const moray_status status = moray_closed_loop_run(closed_loop, &plan);
    if (h.receding)
        trial->record[model] = *moray_receding_horizon_record_of(h.receding);
    moray_receding_horizon_free(h.receding);
    return status;
}

moray_status path_swim(const path_job *job, path_trial *trial, moray_model model, moray_closed_loop *closed_loop)
{
    return swim(job, trial, model, careful, closed_loop);
}

static moray_status score(const path_job *job, path_trial *trial, moray_model model, double tolerance)
{
    moray_closed_loop closed_loop;
    moray_path_score *s = &trial->score[model];
    MORAY_TRY(swim(job, trial, model, tolerance, &closed_loop));
    *s = moray_closed_loop_path_score(&closed_loop, &job->path, job->reach);
    const double seconds = isnan(s->time) ? 2 * closed_loop.track.t[closed_loop.track.n - 1] : s->time;
    trial->cost[model] = 100 * s->rms * s->rms * seconds + job->weight_time * seconds;
    moray_closed_loop_free(&closed_loop);
    return moray_ok();
}

// ---- Tuning --------------------------------------------------------------------------------------------------------

enum { most = 4 };

typedef struct tuning {
    const path_job *job;
    path_trial *trial;
    moray_status status; // of the last simulation
} tuning;

// Gain and lookahead on logarithmic scales, of line of sight the distance ahead too, and the integral gain.
static int read(path_trial *trial, const double *x)
{
    int n = 2;
    trial->gain = exp(x[0]);
    trial->lookahead = exp(x[1]);
    if (trial->law == PATH_SIGHT)
        trial->ahead = x[n++];
    if (trial->integral)
        trial->integral_gain = x[n++];
    return n;
}

// What the plans minimise, but for the steering, on the first-principles model.
static bool judge(void *self, const double *x, double *f, double *c, double *gradient, double *jacobian)
{
    tuning *t = self;
    (void)c, (void)gradient, (void)jacobian;
    read(t->trial, x);
    t->status = score(t->job, t->trial, MORAY_FIRST_PRINCIPLES, rough);
    *f = t->trial->cost[MORAY_FIRST_PRINCIPLES];
    moray_ticker_show(&t->job->ticker, "path_following: tuning %s: gain %.3g m/rad, lookahead %.2f m: cost %.5g",
                      t->trial->name, t->trial->gain, t->trial->lookahead, *f);
    return !moray_failed(t->status);
}

// From a start on; keeps what is better than what the trial has.
static moray_status tune_from(const path_job *job, path_trial *trial, double *x)
{
    const double lower[most] = {log(0.002), log(0.1), 0, 0}, upper[most] = {log(2), log(20), 5, 0.3};
    path_trial own = *trial;
    tuning t = {.job = job, .trial = &own};
    const moray_search_problem problem = {
        .n = read(&own, x), .lower = lower, .upper = upper, .self = &t, .evaluate = judge};
    moray_search_settings settings = moray_search_settings_default();
    moray_search_info info;
    settings.method = MORAY_SEARCH_COBYLA;
    settings.x_tolerance = 1e-3;
    settings.f_tolerance = 1e-4;
    settings.max_evaluations = job->evaluations * problem.n;
    settings.progress = steer_go_on;
    const moray_status status = moray_search(&problem, &settings, x, &info);
    MORAY_TRY(steer_interruption());
    if (moray_failed(status))
        return status.code == MORAY_NUMERIC ? t.status : status;
    read(&own, x);
    own.cost[MORAY_FIRST_PRINCIPLES] = info.objective;
    own.evaluations = trial->evaluations + info.evaluations;
    if (trial->evaluations == 0 || info.objective < trial->cost[MORAY_FIRST_PRINCIPLES])
        *trial = own;
    trial->evaluations = own.evaluations;
    return moray_ok();
}

// Too, if not NULL, from what `like` was tuned to.
static moray_status tune(const path_job *job, path_trial *trial, const path_trial *like)
{
    double x[most] = {log(0.06), log(trial->law == PATH_SIGHT ? 0.4 : 1.5), 0.4, 0.02};
    MORAY_TRY(tune_from(job, trial, x));
    if (!like)
        return moray_ok();
    double again[most] = {log(like->gain), log(like->lookahead), like->ahead, 0.02};
    return tune_from(job, trial, again);
}

// ---- All -----------------------------------------------------------------------------------------------------------

static const char *const plan_names[] = {"control-oriented plan", "first-principles plan"};
static const char *const both_names[] = {"control-or. plan + feedback", "first-pr. plan + feedback"};
static const char *const receding_names[] = {"receding, control-oriented", "receding, first-principles"};

static void add(path_job *job, path_trial trial)
{
    job->trial[job->n_trials++] = trial;
}

static void choose_trials(path_job *job)
{
    const moray_model first = MORAY_CONTROL_ORIENTED, last = job->common.model;
    const int found = 1 + (int)last;
    add(job, (path_trial){.name = "ILOS, paper's gait", .integral = true});
    add(job, (path_trial){.name = "LOS, gait found", .gait = found});
    add(job, (path_trial){.name = "ILOS, gait found", .gait = found, .integral = true});
    for (int model = first; model <= (int)last; model++) {
        const path_trial blind = {
            .name = plan_names[model], .law = PATH_PLAN, .gait = 1 + model, .plan = (moray_model)model};
        path_trial both = blind;
        both.name = both_names[model];
        both.law = PATH_BOTH;
        add(job, blind);
        add(job, both);
    }
    for (int model = first; model <= (int)last && job->receding; model++)
        add(job, (path_trial){
                     .name = receding_names[model], .law = PATH_RECEDING, .gait = found, .plan = (moray_model)model});
}

moray_status path_run_trials(path_job *job)
{
    choose_trials(job);
    for (int k = 0; k < job->n_trials; k++) {
        path_trial *trial = &job->trial[k];
        moray_ticker_show(&job->ticker, "path_following: %s", trial->name);
        if (trial->law == PATH_SIGHT || trial->law == PATH_BOTH)
            MORAY_TRY(tune(job, trial, trial->law == PATH_SIGHT && k > 0 ? &job->trial[k - 1] : NULL));
        for (int model = 0; model < 2; model++) {
            MORAY_TRY(steer_interruption());
            MORAY_TRY(score(job, trial, (moray_model)model, careful));
        }
    }
    return moray_ok();
}
