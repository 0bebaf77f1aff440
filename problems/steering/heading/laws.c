// SPDX-License-Identifier: MIT
#include "heading.h"

#include <string.h>

static const double look_every = 0.1;      // for a new command [s]
static const double command_change = DEG;  // that calls for a new plan
static const double error_unit = 10 * DEG; // in what tuning minimises

// ---- Laws ----------------------------------------------------------------------------------------------------------

const steer_number heading_numbers[HEADING_NUMBERS] = {
    [HEADING_GAIN] = {"gain_m_rad", "gain, cm/deg", 100 * DEG, .logarithmic = true, .lower = 0.002, .upper = 2},
    [HEADING_LEAD] = {"lead_s", "ahead, s", 1, .upper = 8},
};

static double reference_ahead(const moray_swim_sample *sample, void *self)
{
    const steer_steersman *h = self;
    double rate;
    return moray_reference_at(&((const heading_job *)h->job)->reference, sample->t + h->trial->number[HEADING_LEAD],
                              &rate);
}

static moray_status set_feedback(steer_steersman *h)
{
    steer_set_feedback(h, h->trial->number[HEADING_GAIN], reference_ahead, NULL, h);
    return moray_ok();
}

static moray_status set_receding(steer_steersman *h)
{
    const moray_straight_motion *straight = &h->job->straight[h->trial->gait][h->trial->plan];
    const bool preview = h->trial->law->preview;
    moray_heading_replanner *replanner = &h->own.heading;
    *replanner = (moray_heading_replanner){.spec = heading_spec((const heading_job *)h->job, h->trial->plan, false),
                                           .horizon = h->job->look_ahead_periods * 2 * M_PI / straight->gait.omega,
                                           .preview = preview,
                                           .tolerance = command_change};
    replanner->spec.max_error = MORAY_INFINITY;
    memcpy(replanner->spec.undulation, straight->undulation, sizeof straight->undulation);
    return steer_set_receding(h, "radau3", moray_heading_replan(replanner), &replanner->spec.limits,
                              preview ? 0 : look_every, NULL);
}

enum { GAIN = 1 << HEADING_GAIN, LEAD = 1 << HEADING_LEAD };

const steer_law heading_laws[HEADING_LAWS] = {
    [HEADING_FEEDBACK] = {"feedback", .set = set_feedback, .tuned = GAIN, .start = {0.12, 0}, .curve = 1},
    [HEADING_AHEAD] = {"feedback", .preview = true, .set = set_feedback, .tuned = GAIN | LEAD, .start = {0.12, 2.5},
                       .curve = 2},
    [HEADING_PLAN] = {"plan", STEER_PLANNED, .preview = true, .start = {NAN, 0}, .curve = 3},
    [HEADING_BOTH] = {"plan and feedback", STEER_PLANNED, .preview = true, .set = steer_set_both, .tuned = GAIN,
                      .start = {0.12, 0}},
    [HEADING_RECEDING] = {"receding", STEER_RECEDING, .preview = true, .set = set_receding, .start = {NAN, 0}},
    [HEADING_UNKNOWING] = {"receding", STEER_RECEDING, .set = set_receding, .start = {NAN, 0}},
};

void heading_choose_trials(steer_job *job)
{
    const moray_model any = MORAY_CONTROL_ORIENTED;
    const int found = 1 + (int)job->common.model;
    const bool given = steer_gait_given(job);
    if (!given)
        steer_add(job, "feedback, paper's gait", &heading_laws[HEADING_FEEDBACK], 0, any);
    steer_add(job, given ? "feedback" : "feedback, gait found", &heading_laws[HEADING_FEEDBACK], found, any);
    steer_add(job, given ? "feedback ahead" : "feedback ahead, gait found", &heading_laws[HEADING_AHEAD], found, any);
    steer_add_plans(job, &heading_laws[HEADING_PLAN], &heading_laws[HEADING_BOTH]);
    steer_add_receding(job, &heading_laws[HEADING_RECEDING]);
    if (job->receding)
        steer_add(job, "receding, nothing known ahead", &heading_laws[HEADING_UNKNOWING], found, any);
}

// ---- Swimming ------------------------------------------------------------------------------------------------------

void heading_start(steer_steersman *h, moray_closed_loop_spec *spec)
{
    const heading_job *job = (const heading_job *)h->job;
    double rate;
    spec->heading = moray_reference_at(&job->reference, 0, &rate);
    spec->duration = job->horizon;
}

// What the plans minimise, but for the steering.
double heading_judge(const steer_trial *trial, const steer_steersman *h, const moray_closed_loop *closed_loop,
                     double *score)
{
    const heading_job *job = (const heading_job *)h->job;
    const moray_heading_score s =
        moray_closed_loop_heading_score(closed_loop, &h->job->straight[trial->gait][h->model], &job->reference);
    score[HEADING_RMS] = s.rms;
    score[HEADING_FINAL] = s.final;
    score[HEADING_LARGEST] = s.largest;
    score[HEADING_POWER] = s.power;
    return s.rms * s.rms / (error_unit * error_unit) + job->weight_power * s.power;
}
