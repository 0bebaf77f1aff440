// SPDX-License-Identifier: MIT
#include "steer.h"

#include <string.h>

steer_input steer_input_default(void)
{
    return (steer_input){.theta_max = {1 * DEG, 20 * DEG},
                         .omega = {30 * DEG, 360 * DEG},
                         .delta = {15 * DEG, 90 * DEG},
                         .offset = 0.015,
                         .offset_rate = 0.01,
                         .power = NAN};
}

static bool single(const double range[2])
{
    return range[0] == range[1];
}

bool steer_gait_given(const steer_input *input)
{
    return single(input->theta_max) && single(input->omega) && single(input->delta);
}

static double into(const double range[2], double value)
{
    return fmin(fmax(value, range[0]), range[1]);
}

moray_gait steer_first_gait(const steer_input *input, const moray_robot *robot)
{
    const moray_gait paper = moray_gait_paper(robot);
    const double theta_max =
        moray_theta_max_from_amplitude(robot, MORAY_CONTROL_ORIENTED, paper.amplitude, paper.delta);
    moray_gait gait = {.omega = into(input->omega, paper.omega), .delta = into(input->delta, paper.delta)};
    gait.amplitude =
        moray_amplitude_from_theta_max(robot, MORAY_CONTROL_ORIENTED, into(input->theta_max, theta_max), gait.delta);
    return gait;
}

moray_steering_limits steer_limits(const steer_input *input, const moray_robot *robot,
                                   const moray_straight_motion *straight)
{
    const double usual = steer_gait_given(input) ? MORAY_INFINITY : straight->power;
    const moray_gait gait = steer_first_gait(input, robot);
    const moray_steering_limits limits = {
        .theta_max = moray_between(input->theta_max[0], input->theta_max[1]),
        .omega = moray_between(input->omega[0], input->omega[1]),
        .delta = moray_between(input->delta[0], input->delta[1]),
        .offset = input->offset,
        .offset_rate = input->offset_rate,
        .offset_acceleration = MORAY_INFINITY,
        .power = isnan(input->power) ? usual : fmin(input->power, MORAY_INFINITY),
    };
    return moray_steering_limits_map(robot, &limits, &gait, MORAY_CONTROL_ORIENTED, straight->model);
}

steer_saturation steer_saturation_of(const moray_solution *solution, const moray_steering_limits *limits)
{
    enum { points = 4000 };
    const double at_limit = 0.999;
    steer_saturation share = {0, 0};
    double t0, t1;
    moray_solution_times(solution, 0, &t0, &t1);
    for (int k = 0; k < points; k++) {
        const moray_offset offset = moray_steering_offset(solution, t0 + (t1 - t0) * (k + 0.5) / points);
        share.offset += (fabs(offset.value) > at_limit * limits->offset) / (double)points;
        share.rate += (fabs(offset.rate) > at_limit * limits->offset_rate) / (double)points;
    }
    return share;
}

void steer_diagnosis(const moray_solution *solution, char *text, size_t size)
{
    snprintf(text, size, "%s", moray_solution_diagnosis(solution));
    for (char *at = strchr(text, '\n'); at; at = strchr(at, '\n'))
        *at = ' ';
}

bool steer_go_on(void *observer, const moray_search_progress *progress)
{
    (void)observer, (void)progress;
    return !moray_interrupted();
}

moray_status steer_interruption(void)
{
    return moray_interrupted() ? moray_error(MORAY_INTERRUPTED, "interrupted; nothing is written") : moray_ok();
}
