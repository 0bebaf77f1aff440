// SPDX-License-Identifier: MIT
//
// The fastest gait along a course in a current: optimised on the control-oriented model, from there on the
// first-principles model, and proved by simulating both.
#include "gait/job/job.h"

static const moray_option options[] = {
    GAIT_LIMIT("power_W", power, "W",
               "mean joint power; by default what the paper's gait uses in the same model and current"),
};

static const gait_program program = {
    .name = "max_speed",
    .summary = "Optimises the gait of an underwater snake robot for speed along a course, and "
               "proves it on the first-principles model.",
    .goal = MORAY_GAIT_FASTEST,
    .options = options,
    .n_options = sizeof options / sizeof *options,
    .power = NAN,
    .speed = INFINITY};

int main(int argc, char **argv)
{
    gait_job job = gait_job_defaults(&program);
    return gait_job_main(&program, &job, argc, argv);
}
