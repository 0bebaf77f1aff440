// SPDX-License-Identifier: MIT
//
// Heading references, and the problem of following one.
#ifndef MORAY_SNAKE_HEADING_H
#define MORAY_SNAKE_HEADING_H

#include "moray/export.h"
#include "moray/snake/controllers.h"
#include "moray/snake/steering.h"

MORAY_BEGIN

// A reference heading over time: straight lines between points, constant outside them; two points at one time make a
// jump, which counts as made after that time. Or a sine around zero.
typedef struct moray_reference {
    int n;
    double *time, *heading;   // [n], ascending; [rad]
    double amplitude, period; // of the sine, where n = 0
} moray_reference;

// From "steps:T=H,T=H,..." (0 before the first), "ramps:T=H,...", "sine:AMPLITUDE,PERIOD", with times in s and headings
// in deg, or the path of a CSV file of the columns t_s and heading_deg. Free with
// moray_reference_free. Error: MORAY_INPUT, MORAY_IO naming the text or the line; MORAY_MEMORY.
MORAY_API moray_status moray_reference_read(moray_reference *reference, const char *text);
MORAY_API void moray_reference_free(moray_reference *reference);

// Heading [rad] and its rate at t.
MORAY_API double moray_reference_at(const moray_reference *reference, double t, double *rate);

// Largest rate within [t0, t1], jumps aside [rad/s].
MORAY_API double moray_reference_fastest(const moray_reference *reference, double t0, double t1);

// The intervals of equal length on [t0, t1], at least `least` and at most 1.3 times as many, whose ends lie nearest to
// the jumps, and to the corners unless they are many: a collocation scheme that uses no point twice (radau, gauss) then
// integrates the error exactly.
MORAY_API int moray_reference_intervals(const moray_reference *reference, double t0, double t1, int least);

typedef struct moray_heading_weights {
    double heading;  // of the squared error [1/rad^2]
    double power;    // of the power of joints or motors [1/W]
    double steering; // of (phi_0'' / limit of phi_0)^2 [s^4]
} moray_heading_weights;

// The problem of following the reference: the objective is the mean over [t0, t1] of the weighted sum. The error is
// that of the heading without its undulation: the mean link angle of the first-principles model swings by some 4 deg
// with every stroke, which no offset within its limits would stop.
typedef struct moray_heading_spec {
    moray_robot robot;
    moray_model model;
    bool averaged;     // on the period-averaged plant
    double current[2]; // [m/s]
    moray_steering_limits limits;
    moray_heading_weights weight;
    const moray_reference *reference; // must outlive the problem
    double max_error;                 // largest |error| allowed [rad]; MORAY_INFINITY: any
    double t0, t1;
    double start[MORAY_STEERING_STATES]; // state at t0
    double undulation[2];                // of the heading: factors of cos and sin of omega t [rad]
} moray_heading_spec;

// Plans; start and undulation of the spec are set by this, t0 is 0. On the averaged plant the gait is found within the
// limits, from `gait` on. Elsewhere it is `gait`, whatever the limits of gait and power: the undulation's phase omega t
// goes round so often that a free omega has a local optimum every fraction of a percent. Starts from the plan `from`
// (of any model, averaged or not), or with NULL from the reference as though it were followed. Errors:
// MORAY_INPUT, those of moray_straight_motion_find and moray_solve. Returns MORAY_OK whenever the solver ran, solved or
// not. Free with moray_steering_plan_free.
MORAY_API moray_status moray_heading_plan_make(moray_steering_plan *plan, const moray_heading_spec *spec,
                                               const moray_settings *settings, const moray_gait *gait,
                                               const moray_steering_plan *from);

MORAY_END

#endif
