// SPDX-License-Identifier: MIT
//
// Where the robot is, what current it is in and how well it swims and turns, estimated while it swims: a Kalman filter
// on the period-averaged plant, and a receding horizon that plans from what it estimates.
#ifndef MORAY_SNAKE_NAVIGATOR_H
#define MORAY_SNAKE_NAVIGATOR_H

#include "moray/export.h"
#include "moray/snake/controllers.h"
#include "moray/snake/heading.h"
#include "moray/snake/instruments.h"
#include "moray/snake/path.h"

MORAY_BEGIN

// ---- What is believed of the robot ---------------------------------------------------------------------------------

// The averaged plant swims and turns as the robot does with `amplitude` times the gait's amplitude in its thrust and
// `turning` times the offset in its turning.
typedef struct moray_belief {
    double amplitude, turning;
    double current[2]; // [m/s]
} moray_belief;

// The factors with which the averaged plant of the robot has this speed straight ahead [m/s], and this rate of turning
// at a constant offset [rad/s], both of the control-oriented model. Error: MORAY_NOT_SOLVED where it has them with none
// from 1/3 to 3; those of moray_average_plant.
MORAY_API moray_status moray_belief_find(moray_belief *belief, const moray_robot *robot, const moray_gait *gait,
                                         double speed, double offset, double rate);

// ---- Estimation ----------------------------------------------------------------------------------------------------

typedef struct moray_navigator_spec {
    moray_robot robot;
    moray_gait gait;                      // of the control-oriented model
    double heading, position[2], speed;   // at t = 0, swimming steadily through the water
    moray_belief belief;                  // then
    double current_doubt;                 // standard deviation of either component [m/s]; 0: known
    double factor_doubt;                  // of the logarithms of the two factors; 0: known
    double heading_error, position_error; // of the readings; both above 0
    double rate_error;                    // of the heading's rate, likewise; 0: it is not read
} moray_navigator_spec;

typedef struct moray_navigator moray_navigator;

// Error: MORAY_INPUT, MORAY_MEMORY. Free with moray_navigator_free.
MORAY_API moray_status moray_navigator_new(moray_navigator **navigator, const moray_navigator_spec *spec);
MORAY_API void moray_navigator_free(moray_navigator *navigator);

// The joint offset and its rate from the time last told of on, of the control-oriented model; then the time is t.
// Error: MORAY_NUMERIC.
MORAY_API moray_status moray_navigator_advance(moray_navigator *navigator, double t, double offset, double rate);

// Takes a reading in, heading without undulation, as of now. Error: MORAY_NUMERIC.
MORAY_API moray_status moray_navigator_read(moray_navigator *navigator, double heading, double p_x, double p_y);

// The heading's rate without undulation, of a gyro. Error: MORAY_NUMERIC.
MORAY_API moray_status moray_navigator_read_rate(moray_navigator *navigator, double rate);

MORAY_API moray_belief moray_navigator_belief(const moray_navigator *navigator);

// Standard deviation of what is estimated of the current's larger component [m/s].
MORAY_API double moray_navigator_doubt(const moray_navigator *navigator);

// The state of the averaged plant that swims in this current, offset and rate aside.
MORAY_API void moray_navigator_state(const moray_navigator *navigator, double state[MORAY_BODY_STATES]);

// ---- Receding horizon on the estimate ------------------------------------------------------------------------------

typedef struct moray_adaptive_spec {
    moray_navigator_spec navigator;
    const moray_straight_motion *measured; // believed of the swimmer: its undulation
    double scale;                          // offsets of the swimmer per offset of the control-oriented model
    moray_steering_limits limits;          // of the control-oriented model; only those of the offset count
    moray_heading_replanner *heading;      // one of the two; its model averaged
    moray_path_replanner *path;
    moray_settings settings; // of each solve
    double dead_time; // known, of the actuators [s]: what is estimated and planned from is the state so much later
    double horizon, interval, look; // length of a plan; between two plans; between two measurements [s]
} moray_adaptive_spec;

typedef struct moray_adaptive moray_adaptive;

// Disturbances of the plant are in what is estimated, so that no offset stays in what is followed. `reading` says which
// reading the controller is shown; it may be set until the first measurement. Error: MORAY_INPUT, MORAY_MEMORY.
MORAY_API moray_status moray_adaptive_new(moray_adaptive **adaptive, const moray_adaptive_spec *spec);
MORAY_API void moray_adaptive_free(moray_adaptive *adaptive);
MORAY_API void moray_adaptive_look_at(moray_adaptive *adaptive, const moray_reading *reading);
MORAY_API moray_swim_controller moray_adaptive_controller(moray_adaptive *adaptive);
MORAY_API const moray_navigator *moray_adaptive_navigator(const moray_adaptive *adaptive);
MORAY_API const moray_receding_horizon_record *moray_adaptive_record(const moray_adaptive *adaptive);

MORAY_END

#endif
