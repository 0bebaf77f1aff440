// SPDX-License-Identifier: MIT
//
// Modes in which a program that steers has no use for some of its keys.
#include "options.h"

bool steer_without_receding(const void *settings)
{
    return !((const steer_job *)settings)->receding;
}

bool steer_mesh_given(const void *settings)
{
    return ((const steer_job *)settings)->common.intervals > 0;
}

bool steer_water_given(const void *settings)
{
    return ((const steer_job *)settings)->water_file[0] != 0;
}

bool steer_one_plan(const void *settings)
{
    const steer_job *job = settings;
    return job->snake.model == MORAY_CONTROL_ORIENTED || steer_gait_given(job);
}
