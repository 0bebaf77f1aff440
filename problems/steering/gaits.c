// SPDX-License-Identifier: MIT
//
// The gaits that are steered: the first, the fastest, and one on both models.
#include "steer.h"

static bool single(const double range[2])
{
    return range[0] == range[1];
}

bool steer_gait_given(const steer_job *job)
{
    return single(job->input.theta_max) && single(job->input.omega) && single(job->input.delta);
}

static double into(const double range[2], double value)
{
    return fmin(fmax(value, range[0]), range[1]);
}

moray_gait steer_first_gait(const steer_job *job)
{
    const moray_robot *robot = &job->snake.robot;
    const steer_input *input = &job->input;
    const moray_gait paper = moray_gait_paper(robot);
    const double theta_max =
        moray_theta_max_from_amplitude(robot, MORAY_CONTROL_ORIENTED, paper.amplitude, paper.delta);
    moray_gait gait = {.omega = into(input->omega, paper.omega), .delta = into(input->delta, paper.delta)};
    gait.amplitude =
        moray_amplitude_from_theta_max(robot, MORAY_CONTROL_ORIENTED, into(input->theta_max, theta_max), gait.delta);
    return gait;
}

moray_steering_limits steer_limits(const steer_job *job, moray_model model)
{
    const steer_input *input = &job->input;
    const double usual = steer_gait_given(job) ? MORAY_INFINITY : job->straight[0][model].power;
    const moray_gait gait = steer_first_gait(job);
    const moray_steering_limits limits = {
        .theta_max = moray_between(input->theta_max[0], input->theta_max[1]),
        .omega = moray_between(input->omega[0], input->omega[1]),
        .delta = moray_between(input->delta[0], input->delta[1]),
        .offset = input->offset,
        .offset_rate = input->offset_rate,
        .offset_acceleration = MORAY_INFINITY,
        .power = isnan(input->power) ? usual : fmin(input->power, MORAY_INFINITY),
    };
    return moray_steering_limits_map(&job->snake.robot, &limits, &gait, MORAY_CONTROL_ORIENTED, model);
}

moray_status steer_fastest_gait(steer_job *job, moray_model model, double power, moray_gait *gait)
{
    const steer_input *input = &job->input;
    const moray_gait_problem_spec spec = {.robot = job->snake.robot,
                                          .model = model,
                                          .goal = MORAY_GAIT_FASTEST,
                                          .joints = MORAY_JOINTS_ON_GAIT,
                                          .limits = {.theta_max = {input->theta_max[0], input->theta_max[1]},
                                                     .omega = {input->omega[0], input->omega[1]},
                                                     .delta = {input->delta[0], input->delta[1]},
                                                     .offset = moray_fixed(0),
                                                     .taper = moray_fixed(0),
                                                     .power = power,
                                                     .joint_rate = MORAY_INFINITY,
                                                     .joint_effort = MORAY_INFINITY}};
    moray_search_settings settings = moray_search_settings_default();
    moray_gait_search *search;
    moray_orbit_result orbit;
    moray_search_info info;
    settings.progress = steer_go_on;
    settings.observer = job;
    MORAY_TRY(moray_gait_search_new(&search, &spec, "lobatto5", 12));
    moray_status status = moray_gait_search_run(search, &settings, gait, &orbit, &info);
    if (!moray_failed(status) && info.violation > 1e-6)
        status = moray_error(MORAY_NOT_SOLVED, "power_W = %g: no gait within the limits gets by with it", power);
    if (steer_clock_up(&job->clock))
        status = moray_error(MORAY_NOT_SOLVED, "the fastest gait is not found in the time given (--time)");
    moray_gait_search_free(search);
    return status;
}

moray_status steer_straight_motions(steer_job *job, int index, const moray_gait *gait, moray_model from)
{
    const moray_robot *robot = &job->snake.robot;
    for (int model = 0; model < 2; model++) {
        const moray_gait mapped = moray_gait_map(robot, gait, from, (moray_model)model);
        MORAY_TRY(moray_straight_motion_find(&job->straight[index][model], robot, (moray_model)model, &mapped));
    }
    return moray_ok();
}

moray_status steer_find_turn_rate(steer_job *job, moray_model model, const moray_gait *gait)
{
    moray_gait turning = *gait;
    turning.offset = steer_limits(job, model).offset;
    return moray_turn_rate(&job->snake.robot, model, &turning, &job->turn_rate[model]);
}

double steer_offset_ratio(const steer_job *job, int gait, moray_model from, moray_model to)
{
    const moray_straight_motion *straight = job->straight[gait];
    return from == to ? 1 : -straight[to].gait.amplitude / straight[from].gait.amplitude;
}
