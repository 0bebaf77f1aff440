// SPDX-License-Identifier: MIT
//
// The fastest change of heading, or from pose to pose, at the limits of the joint offset and its rate.
#ifndef MORAY_SNAKE_TURN_H
#define MORAY_SNAKE_TURN_H

#include "moray/export.h"
#include "moray/snake/controllers.h"
#include "moray/snake/steering.h"

MORAY_BEGIN

// The problem of turning in the least time: at its end heading and turning are those of the straight motion, and the
// offset is back at rest. The heading swings with every stroke, and the stroke that the turn ends in is free: what is
// to be reached is the heading without its undulation, factors of cos and sin of omega t at whatever time it ends.
typedef struct moray_turn_spec {
    moray_robot robot;
    moray_model model;
    bool averaged;            // on the period-averaged plant
    double current[2];        // [m/s]
    const moray_water *water; // in place of it, which is then what guesses and times go by; NULL: uniform
    moray_steering_limits limits;
    double heading;           // at the end [rad]
    bool to_position;         // the end lies at this position too
    double position[2];       // [m]
    double steering;          // weight of the integral of (phi_0'' / limit of phi_0)^2, beside the time [s^4]
    double shortest, longest; // the turn may take [s]
    double start[MORAY_STEERING_STATES]; // state at t = 0
    double undulation[2];                // of the heading [rad]
} moray_turn_spec;

// A plan from p = 0 and mean heading 0 on. `start`, `undulation` and the times of the spec are set by this; the rest as
// moray_heading_plan_make. `turn_rate`: how fast the robot turns with its offset at the limit, for the guess and the
// longest time [rad/s].
MORAY_API moray_status moray_turn_plan_make(moray_steering_plan *plan, const moray_turn_spec *spec,
                                            const moray_settings *settings, const moray_gait *gait, double turn_rate,
                                            const moray_steering_plan *from, double stretch);

MORAY_END

#endif
