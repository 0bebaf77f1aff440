// SPDX-License-Identifier: MIT
//
// A swimmer steered in receding horizon.
#ifndef MORAY_SNAKE_RECEDING_HORIZON_H
#define MORAY_SNAKE_RECEDING_HORIZON_H

#include "moray/control/receding_horizon.h"
#include "moray/snake/heading.h"
#include "moray/snake/controllers.h"

// Plans of a steering problem's states and parameters, the second derivative of the offset the first of the controls.
typedef struct moray_swim_receding_horizon_spec {
    int links;
    moray_replanner replanner;             // nx = MORAY_STEERING_STATES, ns = MORAY_STEERING_PARAMETERS
    moray_settings settings;               // of each solve
    const moray_steering_limits *limits;   // of the plans' offset
    const moray_straight_motion *planned;  // of the plans' model: the gait that all plans keep
    const moray_straight_motion *measured; // of the swimmer's model
    double scale;                          // of the swimmer's offset to the plans'
    double horizon, interval;              // length of a plan; between two plans [s]
    double watch;                          // between two looks for a change [s]; 0: none
    const moray_solution *first;           // where the first plan starts from; NULL: from going straight on
} moray_swim_receding_horizon_spec;

typedef struct moray_swim_receding_horizon moray_swim_receding_horizon;

// A moray_receding_horizon behind a swimmer's eyes: it plans from what the swimmer's state is to the plans' model.
// Copies the spec, not what it points to. Error: those of moray_receding_horizon_new, and MORAY_INPUT for a replanner
// of other sizes. Free with moray_swim_receding_horizon_free.
moray_status moray_swim_receding_horizon_new(moray_swim_receding_horizon **receding,
                                             const moray_swim_receding_horizon_spec *spec);
void moray_swim_receding_horizon_free(moray_swim_receding_horizon *receding);

// Where a solve fails the swimmer goes on with the plan it has.
moray_swim_controller moray_swim_receding_horizon_controller(moray_swim_receding_horizon *receding);

const moray_receding_horizon *moray_swim_receding_horizon_engine(const moray_swim_receding_horizon *receding);

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
moray_replanner moray_heading_replan(moray_heading_replanner *replanner);

#endif
