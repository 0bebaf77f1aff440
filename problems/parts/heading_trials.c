// SPDX-License-Identifier: MIT
#include <string.h>

#include "heading_job.h"

static const double look_every = 0.1;     // of a pilot, or for a new command [s]
static const double command_change = DEG; // that calls for a new plan

// How a simulation is run: tolerance, samples a second.
typedef struct accuracy {
    double tolerance, per_second;
} accuracy;
static const accuracy rough = {1e-6, 10}, careful = {1e-8, 20};

// ---- Helms
// ------------------------------------------------------------------------------------------------------------

// What a pilot steers for.
typedef struct aim {
    const moray_reference *reference;
    double lead;
    const moray_heading_plan *plan;
    double scale; // of the plan's offsets
} aim;

static double reference_ahead(const moray_swim_sample *sample, void *self)
{
    const aim *to = self;
    double rate;
    return moray_reference_at(to->reference, sample->t + to->lead, &rate);
}

static double planned(const moray_swim_sample *sample, void *self)
{
    const aim *to = self;
    double x[MORAY_STEERING_STATES];
    moray_solution_at(to->plan->solution, 0, sample->t, x, NULL);
    return moray_cruise_heading(&to->plan->cruise, sample->t, x[0]);
}

static double planned_offset(const moray_swim_sample *sample, double t, void *self)
{
    const aim *to = self;
    (void)sample;
    return moray_plan_offset(&(moray_plan){to->plan->solution, to->scale}, t).value;
}

// All that a helm may need, for one trial on one model.
typedef struct helmsman {
    aim aim;
    moray_plan plan;
    moray_pilot pilot;
    moray_heading_replanner replanner;
    moray_recede *recede;
    moray_helm helm;
} helmsman;

// Offsets of the model per offset of the other, with the trial's gait.
static double offset_ratio(const heading_job *job, const heading_trial *trial, moray_model from, moray_model to)
{
    const moray_cruise *cruise = job->cruise[trial->gait];
    return from == to ? 1 : -cruise[to].gait.amplitude / cruise[from].gait.amplitude; // erratum E3
}

static moray_steering_limits limits_of(const heading_job *job, moray_model model)
{
    return steer_limits(&job->input, &job->common.robot, &job->cruise[0][model]);
}

static void set_pilot(const heading_job *job, const heading_trial *trial, moray_model model, helmsman *h)
{
    const double ratio = offset_ratio(job, trial, MORAY_CONTROL_ORIENTED, model);
    const bool both = trial->law == HEADING_BOTH;
    const moray_steering_limits limits = limits_of(job, model);
    h->aim = (aim){&job->reference, trial->lead, &job->plan[trial->plan], h->plan.scale};
    h->pilot = (moray_pilot){.target = both ? planned : reference_ahead,
                             .feed = both ? planned_offset : NULL,
                             .self = &h->aim,
                             .gain = trial->gain * ratio,
                             .cruise = &job->cruise[trial->gait][model],
                             .offset = limits.offset,
                             .offset_rate = limits.offset_rate,
                             .period = look_every};
    h->helm = moray_pilot_helm(&h->pilot);
}

// Limits of plans of the trial's gait, such that those of the swimmer hold too.
static moray_steering_limits replanning_limits(const heading_job *job, const heading_trial *trial, moray_model model,
                                               double scale)
{
    const moray_gait *gait = &job->cruise[trial->gait][trial->plan].gait;
    const moray_steering_limits swum = limits_of(job, model);
    moray_steering_limits limits = limits_of(job, trial->plan);
    limits.theta_max =
        moray_fixed(moray_theta_max_from_amplitude(&job->common.robot, trial->plan, gait->amplitude, gait->delta));
    limits.omega = moray_fixed(gait->omega);
    limits.delta = moray_fixed(gait->delta);
    limits.power = MORAY_INFINITY;
    limits.offset = fmin(limits.offset, swum.offset / fabs(scale));
    limits.offset_rate = fmin(limits.offset_rate, swum.offset_rate / fabs(scale));
    return limits;
}

static moray_status set_receding(const heading_job *job, const heading_trial *trial, moray_model model, helmsman *h)
{
    const moray_cruise *cruise = &job->cruise[trial->gait][trial->plan];
    const double period = 2 * M_PI / cruise->gait.omega, horizon = job->look_ahead_periods * period;
    const double scale = offset_ratio(job, trial, trial->plan, model);
    h->replanner = (moray_heading_replanner){.spec = heading_spec(job, trial->plan, false),
                                             .horizon = horizon,
                                             .preview = trial->preview,
                                             .tolerance = command_change};
    h->replanner.spec.limits = replanning_limits(job, trial, model, scale);
    h->replanner.spec.max_error = MORAY_INFINITY;
    memcpy(h->replanner.spec.undulation, cruise->undulation, sizeof cruise->undulation);
    moray_recede_spec spec = {.links = job->common.robot.links,
                              .replanner = moray_heading_replan(&h->replanner),
                              .settings = moray_settings_default(),
                              .limits = &h->replanner.spec.limits,
                              .planned = cruise,
                              .measured = &job->cruise[trial->gait][model],
                              .scale = scale,
                              .horizon = horizon,
                              .interval = job->replan_periods * period,
                              .look = trial->preview ? 0 : look_every};
    spec.settings.scheme = "radau3";
    spec.settings.intervals = (int)ceil(4 * job->look_ahead_periods);
    spec.settings.tolerance = 1e-6;
    spec.settings.max_iterations = 200;
    MORAY_TRY(moray_recede_new(&h->recede, &spec));
    h->helm = moray_recede_helm(h->recede);
    return moray_ok();
}

static moray_status set_helm(const heading_job *job, const heading_trial *trial, moray_model model, helmsman *h)
{
    *h = (helmsman){.plan = {job->plan[trial->plan].solution, offset_ratio(job, trial, trial->plan, model)}};
    if (trial->law == HEADING_RECEDING)
        return set_receding(job, trial, model, h);
    if (trial->law == HEADING_PLAN)
        h->helm = moray_plan_helm(&h->plan);
    else
        set_pilot(job, trial, model, h);
    return moray_ok();
}

// ---- Swimming
// ---------------------------------------------------------------------------------------------------------

static moray_status swim(const heading_job *job, heading_trial *trial, moray_model model, accuracy how,
                         moray_voyage *voyage)
{
    helmsman h;
    double rate;
    MORAY_TRY(set_helm(job, trial, model, &h));
    const moray_voyage_plan plan = {.robot = &job->common.robot,
                                    .cruise = &job->cruise[trial->gait][model],
                                    .heading = moray_reference_at(&job->reference, 0, &rate),
                                    .current = {job->common.current[0], job->common.current[1]},
                                    .helm = &h.helm,
                                    .duration = job->horizon,
                                    .intervals = (int)ceil(how.per_second * job->horizon),
                                    .tolerance = how.tolerance};
    const moray_status status = moray_voyage_run(voyage, &plan);
    if (h.recede)
        trial->record[model] = *moray_recede_record_of(h.recede);
    moray_recede_free(h.recede);
    return status;
}

moray_status heading_swim(const heading_job *job, heading_trial *trial, moray_model model, moray_voyage *voyage)
{
    return swim(job, trial, model, careful, voyage);
}

static moray_status score(const heading_job *job, heading_trial *trial, moray_model model, accuracy how)
{
    moray_voyage voyage;
    MORAY_TRY(swim(job, trial, model, how, &voyage));
    trial->score[model] = moray_voyage_heading_score(&voyage, &job->cruise[trial->gait][model], &job->reference);
    moray_voyage_free(&voyage);
    return moray_ok();
}

// ---- Tuning
// -----------------------------------------------------------------------------------------------------------

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
    MORAY_TRY(moray_search(&problem, &settings, x, &info));
    trial->gain = exp(x[0]);
    trial->lead = lead ? x[1] : 0;
    trial->evaluations = info.evaluations;
    return moray_ok();
}

// ---- All
// --------------------------------------------------------------------------------------------------------------

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
    for (int model = first; model <= (int)last && job->recede; model++)
        add(job, (heading_trial){.name = receding_names[model],
                                 .law = HEADING_RECEDING,
                                 .gait = found,
                                 .plan = (moray_model)model,
                                 .preview = true});
    if (job->recede)
        add(job, (heading_trial){.name = "receding, nothing known ahead", .law = HEADING_RECEDING, .gait = found});
}

static bool can_run(const heading_job *job, const heading_trial *trial)
{
    const bool gait_known = job->cruise[trial->gait][0].speed > 0;
    const bool plan_known = trial->law == HEADING_FEEDBACK || job->plan[trial->plan].solution;
    return !trial->run && gait_known && plan_known;
}

static moray_status run_trial(heading_job *job, heading_trial *trial)
{
    moray_ticker_show(&job->ticker, "heading_tracking: %s", trial->name);
    if (trial->law == HEADING_FEEDBACK || trial->law == HEADING_BOTH)
        MORAY_TRY(tune(job, trial));
    for (int model = 0; model < 2; model++)
        MORAY_TRY(score(job, trial, (moray_model)model, careful));
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
