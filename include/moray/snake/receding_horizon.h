// SPDX-License-Identifier: MIT
//
// Receding horizon: a controller that makes a new plan from the measured state every so often.
#ifndef MORAY_SNAKE_RECEDING_HORIZON_H
#define MORAY_SNAKE_RECEDING_HORIZON_H

#include "moray/export.h"
#include "moray/snake/heading.h"
#include "moray/snake/controllers.h"

MORAY_BEGIN

// What is planned: problems of one phase with the states and first control of a steering problem, from a state at t on.
typedef struct moray_replanner {
    // Makes the problem that begins at t. Error: any; no problem is left then.
    moray_status (*make)(void *self, double t, const double state[MORAY_STEERING_STATES], void **problem,
                         const moray_ocp **ocp);
    void (*free)(void *problem);
    // Whether what the last problem was made of has changed by t, so that a plan is due at once; NULL: it never does.
    bool (*changed)(const void *self, double t);
    void *self;
    int nu; // controls
} moray_replanner;

typedef struct moray_receding_horizon_spec {
    int links;
    moray_replanner replanner;
    moray_settings settings;               // of each solve
    const moray_steering_limits *limits;   // of the plans' offset
    const moray_straight_motion *planned;  // of the plans' model: the gait that all plans keep
    const moray_straight_motion *measured; // of the swimmer's model
    double scale;                          // of the swimmer's offset to the plans'
    double horizon, interval;              // length of a plan; between two plans [s]
    double look;                           // between two looks for a change [s]; 0: none
    const moray_solution *first;           // where the first plan starts from; NULL: from going straight on
} moray_receding_horizon_spec;

typedef struct moray_receding_horizon moray_receding_horizon;

// Copies the spec, not what it points to. Error: MORAY_INPUT, MORAY_MEMORY. Free with moray_receding_horizon_free.
MORAY_API moray_status moray_receding_horizon_new(moray_receding_horizon **receding,
                                                  const moray_receding_horizon_spec *spec);
MORAY_API void moray_receding_horizon_free(moray_receding_horizon *receding);

// Plans when one is due, and at a look that finds a change. Where a solve fails the swimmer goes on with the plan it
// has.
MORAY_API moray_controller moray_receding_horizon_controller(moray_receding_horizon *receding);

// Plans made so far, and what they cost of the processor, set-up included.
typedef struct moray_receding_horizon_record {
    int plans, failures, iterations;
    double seconds, longest; // of all plans, of the longest after the first
    char first_failure[200];
} moray_receding_horizon_record;
MORAY_API const moray_receding_horizon_record *moray_receding_horizon_record_of(const moray_receding_horizon *receding);

// ---- Heading tracking -----------------------------------------------------------------------------------------------

typedef struct moray_heading_replanner {
    moray_heading_spec spec; // start, undulation and times are set anew every time
    double horizon;          // [s]
    bool preview;            // the reference is known over the horizon; else it is taken to stay as it is at t
    moray_reference held;    // for this
    double held_time, held_heading;
    double tolerance; // change of the reference that calls for a plan at once [rad]
} moray_heading_replanner;

// Uses it, so that it must outlive the plans.
MORAY_API moray_replanner moray_heading_replan(moray_heading_replanner *replanner);

MORAY_END

#endif
