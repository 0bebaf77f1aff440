// SPDX-License-Identifier: MIT
//
// The whole manoeuvre planned beforehand on the averaged plant of the robot believed, to be swum with feedback around
// it.
#include "sea.h"

static moray_steering_limits limits_of(const sea_job *job)
{
    const moray_gait *gait = &job->gait;
    return (moray_steering_limits){.theta_max = moray_fixed(moray_theta_max_from_amplitude(
                                       &job->believed, MORAY_CONTROL_ORIENTED, gait->amplitude, gait->delta)),
                                   .omega = moray_fixed(gait->omega),
                                   .delta = moray_fixed(gait->delta),
                                   .offset = job->offset,
                                   .offset_rate = job->offset_rate,
                                   .offset_acceleration = MORAY_INFINITY,
                                   .power = MORAY_INFINITY};
}

static bool show_iteration(void *observer, const moray_progress *at)
{
    const sea_job *job = observer;
    (void)at;
    return !moray_interrupted() && !steer_clock_up(&job->clock);
}

static moray_settings settings_of(sea_job *job, int intervals)
{
    moray_settings settings = moray_settings_default();
    settings.scheme = "radau3";
    settings.intervals = intervals;
    settings.tolerance = 1e-6;
    settings.max_iterations = 300;
    settings.progress = show_iteration;
    settings.observer = job;
    return settings;
}

// Its heading and places are means over an undulation: there is none to be taken off.
static moray_status take(moray_steering_plan *plan)
{
    const moray_nlp_outcome outcome = moray_solution_info(plan->solution)->outcome;
    for (int k = 0; k < 2; k++)
        plan->straight.undulation[k] = 0;
    if (outcome == MORAY_NLP_SOLVED)
        return moray_ok();
    if (outcome != MORAY_NLP_INTERRUPTED)
        return moray_solution_failure(plan->solution);
    return moray_interrupted() ? moray_error(MORAY_INTERRUPTED, "interrupted; nothing is written")
                               : moray_error(MORAY_NOT_SOLVED, "not all draws were planned in the time given (--time)");
}

moray_status sea_plan_heading(sea_job *job, sea_draw *draw)
{
    const double per_period = 1.5, period = 2 * M_PI / job->gait.omega;
    moray_heading_spec spec = sea_heading_spec(job, draw);
    spec.limits = limits_of(job);
    spec.t1 = job->duration;
    const int least = (int)ceil(per_period * job->duration / period);
    const moray_settings settings =
        settings_of(job, moray_reference_intervals(&draw->reference, 0, job->duration, least));
    MORAY_TRY(moray_heading_plan_make(&draw->plan, &spec, &settings, &job->gait, NULL));
    return take(&draw->plan);
}

moray_status sea_plan_path(sea_job *job)
{
    const double per_period = 1.5, period = 2 * M_PI / job->gait.omega, position[2] = {0, SEA_BESIDE};
    const double speed = job->believed_straight.speed;
    moray_path_spec spec = sea_path_spec(job, speed);
    spec.limits = limits_of(job);
    const moray_settings settings = settings_of(job, (int)ceil(per_period * job->path.length / speed / period));
    MORAY_TRY(moray_path_plan_make(&job->plan, &spec, &settings, &job->gait, position, job->path.piece->course, NULL));
    return take(&job->plan);
}
