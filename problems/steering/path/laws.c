// SPDX-License-Identifier: MIT
#include "path.h"

static const double look_every = 0.1; // of a feedback [s]
static const double patience = 1.5;   // times the duration of the plan, before the end is given up

// ---- Laws ----------------------------------------------------------------------------------------------------------

const steer_number path_numbers[PATH_NUMBERS] = {
    [PATH_GAIN] = {"gain_m_rad", "gain, cm/deg", 100 * DEG, .logarithmic = true, .lower = 0.002, .upper = 2},
    [PATH_LOOKAHEAD] = {"lookahead_m", "lookahead, m", 1, .logarithmic = true, .lower = 0.1, .upper = 20},
    [PATH_AHEAD] = {"ahead_m", "ahead, m", 1, .upper = 5},
    [PATH_INTEGRAL] = {"integral_gain_m_s", "integral, cm/s", 100, .upper = 0.3},
};

static moray_status set_guidance(steer_steersman *h)
{
    const path_job *job = (const path_job *)h->job;
    const bool planned = h->trial->law->kind == STEER_PLANNED;
    const double *number = h->trial->number;
    h->own.guidance = (moray_guidance){.path = &job->path,
                                       .plan = planned ? &job->plan[h->trial->plan] : NULL,
                                       .plan_scale = h->plan.scale,
                                       .lookahead = number[PATH_LOOKAHEAD],
                                       .ahead = planned ? 0 : number[PATH_AHEAD],
                                       .gain = planned ? 0 : number[PATH_INTEGRAL],
                                       .period = look_every};
    steer_set_feedback(h, number[PATH_GAIN], moray_guidance_target, planned ? moray_guidance_feed : NULL,
                       &h->own.guidance);
    return moray_ok();
}

static moray_status set_receding(steer_steersman *h)
{
    const path_job *job = (const path_job *)h->job;
    const moray_straight_motion *straight = &h->job->straight[h->trial->gait][h->trial->plan];
    moray_path_replanner *replanner = &h->own.path;
    *replanner = (moray_path_replanner){.spec = path_spec(job, h->trial->plan, false),
                                        .horizon = h->job->look_ahead_periods * 2 * M_PI / straight->gait.omega};
    replanner->spec.tube = MORAY_INFINITY;
    replanner->spec.speed =
        job->path.length / moray_path_duration(&job->path, 0, straight->speed, h->job->common.current);
    return steer_set_receding(h, "radau4", moray_path_replan(replanner), &replanner->spec.limits, 0, h->plan.solution);
}

enum { SIGHT = 1 << PATH_GAIN | 1 << PATH_LOOKAHEAD | 1 << PATH_AHEAD };

const steer_law path_laws[PATH_LAWS] = {
    [PATH_LOS] = {"line of sight", .set = set_guidance, .tuned = SIGHT, .start = {0.06, 0.4, 0.4, 0}, .afresh = true,
                  .curve = 1},
    [PATH_ILOS] = {"line of sight", .set = set_guidance, .tuned = SIGHT | 1 << PATH_INTEGRAL,
                   .start = {0.06, 0.4, 0.4, 0.02}, .afresh = true, .curve = 2},
    [PATH_PLAN] = {"plan", STEER_PLANNED, .start = {NAN, NAN, NAN, NAN}},
    [PATH_BOTH] = {"plan and feedback", STEER_PLANNED, .set = set_guidance,
                   .tuned = 1 << PATH_GAIN | 1 << PATH_LOOKAHEAD, .start = {0.06, 1.5, NAN, NAN}, .curve = 3},
    [PATH_RECEDING] = {"receding", STEER_RECEDING, .set = set_receding, .start = {NAN, NAN, NAN, NAN}},
};

void path_choose_trials(steer_job *job)
{
    const int found = 1 + (int)job->common.model;
    steer_trial *paper = steer_add(job, "ILOS, paper's gait", &path_laws[PATH_ILOS], 0, MORAY_CONTROL_ORIENTED);
    steer_trial *sight = steer_add(job, "LOS, gait found", &path_laws[PATH_LOS], found, MORAY_CONTROL_ORIENTED);
    sight->like = paper;
    steer_add(job, "ILOS, gait found", &path_laws[PATH_ILOS], found, MORAY_CONTROL_ORIENTED)->like = sight;
    steer_add_plans(job, &path_laws[PATH_PLAN], &path_laws[PATH_BOTH]);
    steer_add_receding(job, &path_laws[PATH_RECEDING]);
}

// ---- Swimming ------------------------------------------------------------------------------------------------------

void path_start(steer_steersman *h, moray_closed_loop_spec *spec)
{
    const path_job *job = (const path_job *)h->job;
    h->seeker = (moray_path_seeker){&job->path, 0};
    spec->heading = job->heading;
    spec->position[0] = job->start[0];
    spec->position[1] = job->start[1];
    spec->duration = patience * steer_duration(steer_last_plan(h->job)->solution);
    spec->observe = moray_path_seek;
    spec->observer = &h->seeker;
}

double path_judge(const steer_trial *trial, const steer_steersman *h, const moray_closed_loop *closed_loop,
                  double *score)
{
    const path_job *job = (const path_job *)h->job;
    const moray_path_score s = moray_closed_loop_path_score(closed_loop, &job->path, job->reach);
    const double seconds = isnan(s.time) ? 2 * closed_loop->track.t[closed_loop->track.n - 1] : s.time;
    (void)trial;
    score[PATH_RMS] = s.rms;
    score[PATH_SETTLED_RMS] = s.settled_rms;
    score[PATH_SETTLED_LARGEST] = s.settled_largest;
    score[PATH_TIME] = s.time;
    score[PATH_POWER] = s.power;
    score[PATH_COST] = 100 * s.rms * s.rms * seconds + job->weight_time * seconds;
    return score[PATH_COST];
}

double path_swum(const steer_job *job, const steer_trial *trial)
{
    const double period = 2 * M_PI / job->straight[trial->gait][trial->plan].gait.omega;
    return trial->record[MORAY_FIRST_PRINCIPLES].plans * job->replan_periods * period;
}
