// SPDX-License-Identifier: MIT
#include "controllers.h"

#include <string.h>

static const double look_every = 0.1;     // of a feedback, or for a new command [s]
static const double command_change = DEG; // that calls for a new plan

static double reference_ahead(const moray_swim_sample *sample, void *self)
{
    const heading_aim *to = self;
    double rate;
    return moray_reference_at(to->reference, sample->t + to->lead, &rate);
}

static double planned(const moray_swim_sample *sample, void *self)
{
    const heading_aim *to = self;
    double x[MORAY_STEERING_STATES];
    moray_solution_at(to->plan->solution, 0, sample->t, x, NULL);
    return moray_straight_motion_heading(&to->plan->straight, sample->t, x[0]);
}

static double planned_offset(const moray_swim_sample *sample, double t, void *self)
{
    const heading_aim *to = self;
    (void)sample;
    return moray_plan_offset(&(moray_plan){to->plan->solution, to->scale}, t).value;
}

// Offsets of the model per offset of the other, with the trial's gait.
static double offset_ratio(const heading_job *job, const heading_trial *trial, moray_model from, moray_model to)
{
    const moray_straight_motion *straight = job->straight[trial->gait];
    return from == to ? 1 : -straight[to].gait.amplitude / straight[from].gait.amplitude; // erratum E3
}

static moray_steering_limits limits_of(const heading_job *job, moray_model model)
{
    return steer_limits(&job->input, &job->common.robot, &job->straight[0][model]);
}

static void set_feedback(const heading_job *job, const heading_trial *trial, moray_model model, heading_steersman *h)
{
    const double ratio = offset_ratio(job, trial, MORAY_CONTROL_ORIENTED, model);
    const bool both = trial->law == HEADING_BOTH;
    const moray_steering_limits limits = limits_of(job, model);
    h->aim = (heading_aim){&job->reference, trial->lead, &job->plan[trial->plan], h->plan.scale};
    h->feedback = (moray_feedback){.target = both ? planned : reference_ahead,
                                   .feed = both ? planned_offset : NULL,
                                   .self = &h->aim,
                                   .gain = trial->gain * ratio,
                                   .straight = &job->straight[trial->gait][model],
                                   .offset = limits.offset,
                                   .offset_rate = limits.offset_rate,
                                   .period = look_every};
    h->controller = moray_feedback_controller(&h->feedback);
}

// Limits of plans of the trial's gait, such that those of the swimmer hold too.
static moray_steering_limits replanning_limits(const heading_job *job, const heading_trial *trial, moray_model model,
                                               double scale)
{
    const moray_gait *gait = &job->straight[trial->gait][trial->plan].gait;
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

static moray_status set_receding(const heading_job *job, const heading_trial *trial, moray_model model,
                                 heading_steersman *h)
{
    const moray_straight_motion *straight = &job->straight[trial->gait][trial->plan];
    const double period = 2 * M_PI / straight->gait.omega, horizon = job->look_ahead_periods * period;
    const double scale = offset_ratio(job, trial, trial->plan, model);
    h->replanner = (moray_heading_replanner){.spec = heading_spec(job, trial->plan, false),
                                             .horizon = horizon,
                                             .preview = trial->preview,
                                             .tolerance = command_change};
    h->replanner.spec.limits = replanning_limits(job, trial, model, scale);
    h->replanner.spec.max_error = MORAY_INFINITY;
    memcpy(h->replanner.spec.undulation, straight->undulation, sizeof straight->undulation);
    moray_receding_horizon_spec spec = {.links = job->common.robot.links,
                                        .replanner = moray_heading_replan(&h->replanner),
                                        .settings = moray_settings_default(),
                                        .limits = &h->replanner.spec.limits,
                                        .planned = straight,
                                        .measured = &job->straight[trial->gait][model],
                                        .scale = scale,
                                        .horizon = horizon,
                                        .interval = job->replan_periods * period,
                                        .look = trial->preview ? 0 : look_every};
    spec.settings.scheme = "radau3";
    spec.settings.intervals = (int)ceil(4 * job->look_ahead_periods);
    spec.settings.tolerance = 1e-6;
    spec.settings.max_iterations = 200;
    MORAY_TRY(moray_receding_horizon_new(&h->receding, &spec));
    h->controller = moray_receding_horizon_controller(h->receding);
    return moray_ok();
}

moray_status heading_set_controller(const heading_job *job, const heading_trial *trial, moray_model model,
                                    heading_steersman *h)
{
    *h = (heading_steersman){.plan = {job->plan[trial->plan].solution, offset_ratio(job, trial, trial->plan, model)}};
    if (trial->law == HEADING_RECEDING)
        return set_receding(job, trial, model, h);
    if (trial->law == HEADING_PLAN)
        h->controller = moray_plan_controller(&h->plan);
    else
        set_feedback(job, trial, model, h);
    return moray_ok();
}
