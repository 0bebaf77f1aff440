// SPDX-License-Identifier: MIT
#include "controllers.h"

// How a simulation is run: tolerance, samples a second.
typedef struct accuracy {
    double tolerance, per_second;
} accuracy;
static const accuracy rough = {1e-6, 10}, careful = {1e-8, 20};

// ---- Swimming ------------------------------------------------------------------------------------------------------

static moray_status swim(const heading_job *job, heading_trial *trial, moray_model model, accuracy how,
                         moray_closed_loop *closed_loop)
{
    heading_steersman h;
    double rate;
    MORAY_TRY(heading_set_controller(job, trial, model, &h));
    const moray_closed_loop_spec plan = {.robot = &job->common.robot,
                                         .straight = &job->straight[trial->gait][model],
                                         .heading = moray_reference_at(&job->reference, 0, &rate),
                                         .current = {job->common.current[0], job->common.current[1]},
                                         .controller = &h.controller,
                                         .duration = job->horizon,
                                         .intervals = (int)ceil(how.per_second * job->horizon),
                                         .tolerance = how.tolerance};
    const moray_status status = moray_closed_loop_run(closed_loop, &plan);
    if (h.receding)
        trial->record[model] = *moray_receding_horizon_record_of(h.receding);
    moray_receding_horizon_free(h.receding);
    return status;
}

moray_status heading_swim(const heading_job *job, heading_trial *trial, moray_model model,
                          moray_closed_loop *closed_loop)
{
    return swim(job, trial, model, careful, closed_loop);
}

static moray_status score(const heading_job *job, heading_trial *trial, moray_model model, accuracy how)
{
    moray_closed_loop closed_loop;
    MORAY_TRY(swim(job, trial, model, how, &closed_loop));
    trial->score[model] =
        moray_closed_loop_heading_score(&closed_loop, &job->straight[trial->gait][model], &job->reference);
    moray_closed_loop_free(&closed_loop);
    return moray_ok();
}

// ---- Tuning --------------------------------------------------------------------------------------------------------

typedef struct tuning {
    const heading_job *job;
    heading_trial *trial;
    moray_status status; // of a simulation that failed
} tuning;

// What the plans minimise, but for the steering, on the first-principles model; the gain on a logarithmic scale.
static bool judge(void *self, const double *x, double *f, double *c, double *gradient, double *jacobian)
{
    tuning *t = self;
    (void)c, (void)gradient, (void)jacobian;
    t->trial->gain = exp(x[0]);
    if (t->trial->law == HEADING_FEEDBACK && t->trial->preview)
        t->trial->lead = x[1];
    const moray_status status = score(t->job, t->trial, MORAY_FIRST_PRINCIPLES, rough);
    if (moray_failed(status))
        t->status = status;
    const moray_heading_score *s = &t->trial->score[MORAY_FIRST_PRINCIPLES];
    *f = s->rms * s->rms / (100 * DEG * DEG) + t->job->weight_power * s->power;
    moray_ticker_show(&t->job->ticker, "heading_tracking: tuning %s: gain %.3g m/rad, lead %.2f s: RMS %.3f deg",
                      t->trial->name, t->trial->gain, t->trial->lead, s->rms / DEG);
    return !moray_failed(status);
}

static moray_status tune(const heading_job *job, heading_trial *trial)
{
    const bool lead = trial->law == HEADING_FEEDBACK && trial->preview;
    const double lower[] = {log(0.002), 0}, upper[] = {log(2), 8};
    double x[] = {log(0.12), 2.5};
    tuning t = {.job = job, .trial = trial, .status = moray_ok()};
    const moray_search_problem problem = {.n = 1 + lead, .lower = lower, .upper = upper, .self = &t, .evaluate = judge};
    moray_search_settings settings = moray_search_settings_default();
    moray_search_info info;
    settings.method = MORAY_SEARCH_COBYLA;
    settings.x_tolerance = 3e-3;
    settings.f_tolerance = 3e-4;
    settings.max_evaluations = job->evaluations * (1 + lead);
    settings.progress = steer_go_on;
    MORAY_TRY(moray_search(&problem, &settings, x, &info));
    trial->gain = exp(x[0]);
    trial->lead = lead ? x[1] : 0;
    trial->evaluations = info.evaluations;
    return moray_ok();
}

// ---- All -----------------------------------------------------------------------------------------------------------

static const char *const plan_names[] = {"control-oriented plan", "first-principles plan"};
static const char *const both_names[] = {"control-or. plan + feedback", "first-pr. plan + feedback"};
static const char *const receding_names[] = {"receding, control-oriented", "receding, first-principles"};

static void add(heading_job *job, heading_trial trial)
{
    job->trial[job->n_trials++] = trial;
}

void heading_choose_trials(heading_job *job)
{
    const moray_model first = MORAY_CONTROL_ORIENTED, last = job->common.model;
    const int found = 1 + (int)last;
    const bool given = steer_gait_given(&job->input);
    if (!given)
        add(job, (heading_trial){.name = "feedback, paper's gait"});
    add(job, (heading_trial){.name = given ? "feedback" : "feedback, gait found", .gait = found});
    add(job, (heading_trial){
                 .name = given ? "feedback ahead" : "feedback ahead, gait found", .gait = found, .preview = true});
    for (int model = first; model <= (int)last; model++) {
        const heading_trial blind = {.name = plan_names[model],
                                     .law = HEADING_PLAN,
                                     .gait = 1 + model,
                                     .plan = (moray_model)model,
                                     .preview = true};
        heading_trial both = blind;
        both.name = both_names[model];
        both.law = HEADING_BOTH;
        add(job, blind);
        add(job, both);
    }
    for (int model = first; model <= (int)last && job->receding; model++)
        add(job, (heading_trial){.name = receding_names[model],
                                 .law = HEADING_RECEDING,
                                 .gait = found,
                                 .plan = (moray_model)model,
                                 .preview = true});
    if (job->receding)
        add(job, (heading_trial){.name = "receding, nothing known ahead", .law = HEADING_RECEDING, .gait = found});
}

static bool can_run(const heading_job *job, const heading_trial *trial)
{
    const bool gait_known = job->straight[trial->gait][0].speed > 0;
    const bool plan_known = trial->law == HEADING_FEEDBACK || job->plan[trial->plan].solution;
    return !trial->run && gait_known && plan_known;
}

static moray_status run_trial(heading_job *job, heading_trial *trial)
{
    moray_ticker_show(&job->ticker, "heading_tracking: %s", trial->name);
    if (trial->law == HEADING_FEEDBACK || trial->law == HEADING_BOTH)
        MORAY_TRY(tune(job, trial));
    for (int model = 0; model < 2; model++) {
        if (moray_interrupted())
            return moray_error(MORAY_INTERRUPTED, "interrupted while steering by %s; nothing is written", trial->name);
        MORAY_TRY(score(job, trial, (moray_model)model, careful));
    }
    trial->run = true;
    moray_ticker_note(&job->ticker,
                      "%s: RMS heading error %.3f deg on the control-oriented model, %.3f deg on the "
                      "first-principles model",
                      trial->name, trial->score[0].rms / DEG, trial->score[1].rms / DEG);
    return moray_ok();
}

moray_status heading_run_trials(heading_job *job)
{
    for (int k = 0; k < job->n_trials; k++)
        if (can_run(job, &job->trial[k]))
            MORAY_TRY(run_trial(job, &job->trial[k]));
    return moray_ok();
}
