// SPDX-License-Identifier: MIT
#ifndef PARTS_MAX_SPEED_H
#define PARTS_MAX_SPEED_H

#include "moray/moray.h"

#define DEG (M_PI / 180)

typedef struct max_speed {
    moray_common common;
    double theta_max[2], omega[2], delta[2], offset[2], offset_angle[2];
    double power, joint_rate, joint_effort; // power NaN: what the paper's gait uses
    moray_joints joints;
    int starts;
    // found along the way
    moray_basin basin;
    moray_gait_problem *problem;
    moray_solution *solution;
    int agreeing; // starts that ended at the best solution
    moray_certificate certificate;
    moray_gait_trial paper, best;
    moray_gait_promise promise;
    moray_gait_gain gain;
    moray_ticker ticker;
} max_speed;

// Table or JSON on standard output, and the files of --out. Error: MORAY_IO, MORAY_MEMORY.
moray_status max_speed_report(max_speed *run);

#endif
