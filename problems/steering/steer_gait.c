// SPDX-License-Identifier: MIT
//
// The gaits that are steered: the fastest one, and one on both models.
#include "steer.h"

moray_status steer_fastest_gait(const steer_input *input, const moray_robot *robot, double power, moray_gait *gait)
{
    const moray_gait_problem_spec spec = {.robot = *robot,
                                          .model = MORAY_FIRST_PRINCIPLES,
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
    const moray_search_settings settings = moray_search_settings_default();
    moray_gait_search *search;
    moray_orbit_result orbit;
    moray_search_info info;
    MORAY_TRY(moray_gait_search_new(&search, &spec, "lobatto5", 12));
    moray_status status = moray_gait_search_run(search, &settings, gait, &orbit, &info);
    if (!moray_failed(status) && info.violation > 1e-6)
        status = moray_error(MORAY_NOT_SOLVED, "power_W = %g: no gait within the limits gets by with it", power);
    moray_gait_search_free(search);
    return status;
}

moray_status steer_straight_motions(moray_straight_motion straight[2], const moray_robot *robot, const moray_gait *gait,
                                    moray_model from)
{
    for (int model = 0; model < 2; model++) {
        const moray_gait mapped = moray_gait_map(robot, gait, from, (moray_model)model);
        MORAY_TRY(moray_straight_motion_find(&straight[model], robot, (moray_model)model, &mapped));
    }
    return moray_ok();
}

double steer_offset_ratio(const moray_straight_motion straight[2], moray_model from, moray_model to)
{
    return from == to ? 1 : -straight[to].gait.amplitude / straight[from].gait.amplitude;
}

moray_steering_limits steer_replanning_limits(const moray_robot *robot, const moray_straight_motion *straight,
                                              const moray_steering_limits *own, const moray_steering_limits *swum,
                                              double scale)
{
    const moray_gait *gait = &straight->gait;
    moray_steering_limits limits = *own;
    limits.theta_max =
        moray_fixed(moray_theta_max_from_amplitude(robot, straight->model, gait->amplitude, gait->delta));
    limits.omega = moray_fixed(gait->omega);
    limits.delta = moray_fixed(gait->delta);
    limits.power = MORAY_INFINITY;
    limits.offset = fmin(limits.offset, swum->offset / fabs(scale));
    limits.offset_rate = fmin(limits.offset_rate, swum->offset_rate / fabs(scale));
    return limits;
}
