// SPDX-License-Identifier: MIT
//
// Steering laws: controllers for moray_swim_run that carry out a plan, feed back the heading, or both; and where
// swimmers start from. Offsets are those of the swimmer's model; by erratum E3 a gain that turns the one towards its
// target turns the other away.
#ifndef MORAY_SNAKE_CONTROLLERS_H
#define MORAY_SNAKE_CONTROLLERS_H

#include "moray/export.h"
#include "moray/snake/steering.h"
#include "moray/snake/swim.h"

MORAY_BEGIN

// ---- Straight swimming ---------------------------------------------------------------------------------------------

// Steady swimming of a gait without offset, in still water, at mean heading 0.
typedef struct moray_straight_motion {
    moray_model model;
    moray_gait gait;                // offset 0
    double speed, power;            // [m/s], [W]
    double undulation[2];           // of the heading: factors of cos and sin of omega t [rad]
    double body[MORAY_BODY_STATES]; // state of moray_state_body where omega t is a multiple of 2 pi, at p = 0
} moray_straight_motion;

// Error: those of moray_orbit_new and moray_orbit_solve.
MORAY_API moray_status moray_straight_motion_find(moray_straight_motion *straight, const moray_robot *robot,
                                                  moray_model model, const moray_gait *gait);

// By how much a gait turns whose offset stays what it is, in still water [rad/s]. Error: as above.
MORAY_API moray_status moray_turn_rate(const moray_robot *robot, moray_model model, const moray_gait *gait,
                                       double *rate);

// Heading at t without the undulation.
MORAY_API double moray_straight_motion_heading(const moray_straight_motion *straight, double t, double heading);

// ---- Plans made ----------------------------------------------------------------------------------------------------

// A plan from t = 0 on that begins in the straight motion of its gait.
typedef struct moray_steering_plan {
    moray_steering_problem problem;
    moray_solution *solution;
    moray_straight_motion straight; // its speed is the start's, its undulation is what the heading is without
} moray_steering_plan;
MORAY_API void moray_steering_plan_free(moray_steering_plan *plan); // safe on a zeroed plan, and twice

// ---- Plans carried out ---------------------------------------------------------------------------------------------

// The offset of a plan, times `scale`: 1, or from one model to the other alpha/a with the sign of erratum E3.
typedef struct moray_plan {
    const moray_solution *solution;
    double scale;
} moray_plan;

MORAY_API moray_offset moray_plan_offset(const moray_plan *plan, double t);

// Blindly. The plan must outlive the controller.
MORAY_API moray_swim_controller moray_plan_controller(moray_plan *plan);

// ---- Feedback ------------------------------------------------------------------------------------------------------

// phi_0 = feed + gain (target - heading), the heading without its undulation, limited in range and rate. Decided every
// `period`, with straight lines in between.
typedef struct moray_feedback {
    double (*target)(const moray_swim_sample *sample, void *self);         // heading to steer for [rad]
    double (*feed)(const moray_swim_sample *sample, double t, void *self); // offset wanted at t, soon; NULL: none
    void *self;                                                            // of both
    double gain;                                                           // [m/rad or rad/rad]
    const moray_straight_motion *straight; // of the swimmer's model: what undulation there is
    double offset, offset_rate;            // limits
    double period;                         // [s]
    double from, slope, value;             // now: since when, how fast, from what
} moray_feedback;

// The feedback must outlive the controller.
MORAY_API moray_swim_controller moray_feedback_controller(moray_feedback *feedback);

MORAY_END

#endif
