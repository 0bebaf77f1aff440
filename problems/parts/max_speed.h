// SPDX-License-Identifier: MIT
#ifndef PARTS_MAX_SPEED_H
#define PARTS_MAX_SPEED_H

#include "moray/moray.h"

#define DEG (M_PI / 180)

// One optimisation: the problem on one model, its best solution, and what the gait is worth when it is swum.
typedef struct stage {
    moray_model model;
    double power; // limit of the mean joint power [W]
    moray_gait_problem *problem;
    moray_solution *solution;
    int starts, agreeing; // how many, and how many of them ended at the best solution
    moray_certificate certificate;
    moray_gait_promise promise;
    moray_gait_trial trial;
    moray_gait_gain gain; // over the paper's gait
} stage;

typedef struct max_speed {
    moray_common common; // model complex: both stages, control-oriented first; control: that alone
    double theta_max[2], omega[2], delta[2], offset[2], offset_angle[2];
    double power, joint_rate, joint_effort; // power NaN: what the paper's gait uses
    moray_joints joints;
    int random_starts;
    moray_basin basin;
    moray_gait_trial paper;
    stage stage[2]; // by model
    moray_ticker ticker;
} max_speed;

static inline const stage *last_stage(const max_speed *run)
{
    return &run->stage[run->common.model];
}

// Table or JSON on standard output, and the files of --out. Error: MORAY_IO, MORAY_MEMORY.
moray_status max_speed_report(max_speed *run);

#endif
