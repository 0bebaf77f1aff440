// SPDX-License-Identifier: MIT
//
// Controllers of the laws that the programs share, and the trials of them.
#include "steer.h"

static const double look_every = 0.1; // of a feedback [s]

// ---- Feedback ------------------------------------------------------------------------------------------------------

static double planned_heading(const moray_swim_sample *sample, void *self)
{
    const steer_steersman *h = self;
    const double t = fmin(sample->t, steer_duration(h->plan.solution));
    double x[MORAY_STEERING_STATES];
    moray_solution_at(h->plan.solution, 0, t, x, NULL);
    return moray_straight_motion_heading(h->planned, t, x[MORAY_STATE_THETA]);
}

static double planned_offset(const moray_swim_sample *sample, double t, void *self)
{
    const steer_steersman *h = self;
    (void)sample;
    return moray_plan_offset(&h->plan, t).value;
}

void steer_set_feedback(steer_steersman *h, double gain, double (*target)(const moray_swim_sample *, void *),
                        double (*feed)(const moray_swim_sample *, double, void *), void *self)
{
    const moray_steering_limits limits = steer_limits(h->job, h->model);
    h->feedback =
        (moray_feedback){.target = target,
                         .feed = feed,
                         .self = self,
                         .gain = gain * steer_offset_ratio(h->job, h->trial->gait, MORAY_CONTROL_ORIENTED, h->model),
                         .straight = &h->job->straight[h->trial->gait][h->model],
                         .offset = limits.offset,
                         .offset_rate = limits.offset_rate,
                         .period = look_every};
    h->controller = moray_feedback_controller(&h->feedback);
}

moray_status steer_set_both(steer_steersman *h)
{
    int gain = 0;
    while (!(h->trial->law->tuned & 1u << gain))
        gain++;
    steer_set_feedback(h, h->trial->number[gain], planned_heading, planned_offset, h);
    return moray_ok();
}

// ---- Receding horizon ----------------------------------------------------------------------------------------------

// Limits of plans of the trial's gait that keep both their own offset limits and, times `scale`, the swimmer's.
static moray_steering_limits replanning_limits(const steer_steersman *h, double scale)
{
    const moray_model plan = h->trial->plan;
    const moray_gait *gait = &h->job->straight[h->trial->gait][plan].gait;
    const moray_steering_limits swum = steer_limits(h->job, h->model);
    moray_steering_limits limits = steer_limits(h->job, plan);
    limits.theta_max =
        moray_fixed(moray_theta_max_from_amplitude(&h->job->snake.robot, plan, gait->amplitude, gait->delta));
    limits.omega = moray_fixed(gait->omega);
    limits.delta = moray_fixed(gait->delta);
    limits.power = MORAY_INFINITY;
    limits.offset = fmin(limits.offset, swum.offset / fabs(scale));
    limits.offset_rate = fmin(limits.offset_rate, swum.offset_rate / fabs(scale));
    return limits;
}

moray_status steer_set_receding(steer_steersman *h, const char *scheme, moray_replanner replanner,
                                moray_steering_limits *limits, double look, const moray_solution *first)
{
    const steer_job *job = h->job;
    const moray_straight_motion *straight = job->straight[h->trial->gait];
    const double period = 2 * M_PI / straight[h->trial->plan].gait.omega;
    const double scale = steer_offset_ratio(job, h->trial->gait, h->trial->plan, h->model);
    *limits = replanning_limits(h, scale);
    moray_swim_receding_horizon_spec spec = {.links = job->snake.robot.links,
                                             .replanner = replanner,
                                             .settings = moray_settings_default(),
                                             .limits = limits,
                                             .planned = &straight[h->trial->plan],
                                             .measured = &straight[h->model],
                                             .scale = scale,
                                             .horizon = job->look_ahead_periods * period,
                                             .interval = job->replan_periods * period,
                                             .watch = look,
                                             .first = first};
    spec.settings.scheme = scheme;
    spec.settings.intervals = (int)ceil(4 * job->look_ahead_periods);
    spec.settings.tolerance = 1e-6;
    spec.settings.max_iterations = 200;
    MORAY_TRY(moray_swim_receding_horizon_new(&h->receding, &spec));
    h->controller = moray_swim_receding_horizon_controller(h->receding);
    return moray_ok();
}

// ---- Trials of them ------------------------------------------------------------------------------------------------

steer_trial *steer_add(steer_job *job, const char *name, const steer_law *law, int gait, moray_model plan)
{
    steer_trial *trial = &job->trial[job->n_trials++];
    *trial = (steer_trial){.name = name, .law = law, .gait = gait, .plan = plan, .tuned = law->tuned};
    for (int k = 0; k < STEER_NUMBERS; k++)
        trial->number[k] = law->start[k];
    for (int k = 0; k < STEER_SCORES; k++)
        trial->score[0][k] = trial->score[1][k] = NAN;
    return trial;
}

void steer_add_plans(steer_job *job, const steer_law *blind, const steer_law *both)
{
    static const char *const names[][2] = {{"control-oriented plan", "control-or. plan + feedback"},
                                           {"first-principles plan", "first-pr. plan + feedback"}};
    for (int model = 0; model <= (int)job->snake.model; model++) {
        const int gait = job->program->one_gait ? 0 : 1 + model;
        const steer_trial *alone = steer_add(job, names[model][0], blind, gait, (moray_model)model);
        steer_add(job, names[model][1], both, gait, (moray_model)model)->subset[0] = alone;
    }
}

void steer_add_receding(steer_job *job, const steer_law *law)
{
    static const char *const names[] = {"receding, control-oriented", "receding, first-principles"};
    for (int model = 0; model <= (int)job->snake.model && job->receding; model++)
        steer_add(job, names[model], law, 1 + (int)job->snake.model, (moray_model)model);
}
