// SPDX-License-Identifier: MIT
//
// The problem of following a path, and the guidance laws of the field.
#ifndef MORAY_SNAKE_PATH_H
#define MORAY_SNAKE_PATH_H

#include "moray/export.h"
#include "moray/control/path.h"
#include "moray/snake/controllers.h"
#include "moray/snake/receding_horizon.h"
#include "moray/snake/steering.h"

MORAY_BEGIN

// Who keeps in mind where on the path the swimmer is; begin with where it starts.
typedef struct moray_path_seeker {
    const moray_path *path;
    double along;
} moray_path_seeker;
MORAY_API bool moray_path_seek(const moray_swim_sample *sample,
                               void *seeker); // an observer: false at the end of the path

// ---- Following -----------------------------------------------------------------------------------------------------

typedef struct moray_path_weights {
    double across;   // of the integral of the squared distance to the path [1/(m^2 s)]
    double time;     // of the time to the end of the path [1/s]
    double steering; // of the integral of (phi_0'' / limit of phi_0)^2 [s^3]
} moray_path_weights;

typedef struct moray_path_spec {
    moray_robot robot;
    moray_model model;
    bool averaged;
    double current[2];        // [m/s]
    const moray_water *water; // in place of it, which is then what guesses and times go by; NULL: uniform
    moray_steering_limits limits;
    moray_path_weights weight;
    const moray_path *path;              // must outlive the problem
    double tube;                         // largest distance to the path [m]; MORAY_INFINITY: any
    double reach;                        // distance along the path within which a start outside the tube comes into it
    double t0, duration;                 // duration 0: to the end of the path, whenever that is
    double start[MORAY_STEERING_STATES]; // state at t0
    double along;                        // where on the path that is [m]
    double speed;                        // typical, along the path [m/s]
} moray_path_spec;

// One control more than a steering problem has: the distance along the path. With a given duration the time gained is
// what is made good at the end, along the course of the path where it should then be, at the typical speed.
// Begins at the position, with this mean heading; `start`, `along`, `t0`, `duration` and `speed` of the spec are set by
// this; the rest as moray_heading_plan_make. Error: MORAY_NOT_SOLVED too, where the path is not passable.
MORAY_API moray_status moray_path_plan_make(moray_steering_plan *plan, const moray_path_spec *spec,
                                            const moray_settings *settings, const moray_gait *gait,
                                            const double position[2], double heading, const moray_steering_plan *from);

// Plans of a given length from any state on, in receding horizon.
typedef struct moray_path_replanner {
    moray_path_spec spec; // start and times are set anew every time; along: near the start of the next
    double horizon;       // [s]
} moray_path_replanner;

// Uses it, so that it must outlive the plans.
MORAY_API moray_replanner moray_path_replan(moray_path_replanner *replanner);

// ---- Guidance ------------------------------------------------------------------------------------------------------

// Headings to steer for, from where the swimmer is: line of sight theta = course(along + ahead) - atan((e + gain y) /
// lookahead) with y' = lookahead e / ((e + gain y)^2 + lookahead^2) (Borhaug, Pavlov and Pettersen 2008; gain 0:
// without integral action); or what the plan steered at this place of the path, corrected by - atan((e - e of the plan)
// / lookahead) in the same way.
typedef struct moray_guidance {
    const moray_path *path;
    const moray_steering_plan *plan; // NULL: line of sight
    double plan_scale;               // offsets of the swimmer per offset of the plan
    double lookahead, ahead;         // [m]
    double gain;                     // of the integral [m/s]
    double period;                   // between two measurements [s]
    double along, integral;          // now; integral y [m]
} moray_guidance;

MORAY_API double moray_guidance_target(const moray_swim_sample *sample, void *guidance);         // of a moray_feedback
MORAY_API double moray_guidance_feed(const moray_swim_sample *sample, double t, void *guidance); // with a plan

MORAY_END

#endif
