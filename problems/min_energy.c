// SPDX-License-Identifier: MIT
//
// The gait of least work per distance along a course, of the joints or, with [motor] and [battery], of motors and what
// the robot draws besides, at or above a speed: optimised on the control-oriented
// model, from there on the first-principles model, and proved by simulating both.
#include "gait/job/job.h"

static const moray_option options[] = {
    GAIT_LIMIT("speed_m_s", speed, "m/s",
               "least speed along the course; by default what the paper's gait makes in the same model and current"),
    GAIT_LIMIT("power_W", power, "W", "mean power of the joints, or at the terminals of their motors"),
};

static const gait_program program = {
    .name = "min_energy",
    .summary = "Optimises the gait of an underwater snake robot for the least work per distance "
               "along a course, of the joints or all told, at or above a speed, and proves "
               "it on the first-principles model.",
    .goal = MORAY_GAIT_THRIFTIEST,
    .options = options,
    .n_options = sizeof options / sizeof *options,
    .power = INFINITY,
    .speed = NAN};

int main(int argc, char **argv)
{
    gait_job job = gait_job_defaults(&program);
    return gait_job_main(&program, &job, argc, argv);
}
