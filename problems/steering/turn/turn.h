// SPDX-License-Identifier: MIT
#ifndef PROBLEMS_STEERING_TURN_TURN_H
#define PROBLEMS_STEERING_TURN_TURN_H

#include "steering/steer.h"

typedef struct turn_job {
    steer_job steer;
    double angle;        // change of the heading [rad]
    double end[2], band; // [m]; [rad]
} turn_job;

static inline bool turn_to_position(const turn_job *job)
{
    return !isnan(job->end[0]);
}

// Plans: averaged, control-oriented, and with the first-principles model first-principles. Error: MORAY_NOT_SOLVED
// saying what limits the robot, and those of moray_turn_plan_make.
moray_status turn_make_plans(turn_job *job);

extern const steer_program turn_steering;

#endif
