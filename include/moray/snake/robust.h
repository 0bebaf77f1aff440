// SPDX-License-Identifier: MIT
//
// Heading control found by collocation over scenarios at once: gains, the best fixed controller for a set of robots,
// currents and references; or a whole manoeuvre, one offset over time with one gain for all of them.
#ifndef MORAY_SNAKE_ROBUST_H
#define MORAY_SNAKE_ROBUST_H

#include "moray/export.h"
#include "moray/ocp.h"
#include "moray/snake/heading_law.h"
#include "moray/snake/navigator.h"

MORAY_BEGIN

enum { MORAY_ROBUST_SCENARIOS = 64 }; // at most

// What may be true.
typedef struct moray_scenario {
    moray_belief belief;              // of the averaged plant
    double speed;                     // at the start, straight ahead through the water [m/s]
    double turn;                      // rate of turning per offset of the control-oriented model [rad/(s m)]
    const moray_reference *reference; // followed from its heading at 0 on
} moray_scenario;

typedef struct moray_robust_spec {
    moray_robot robot;
    moray_gait gait;                // of the control-oriented model
    double offset, offset_rate;     // limits, of that
    double lag;                     // time constant of the offset behind its command: joints, looks, dead time [s]
    double noise, sampling;         // standard deviation of a measured heading [rad], time between two [s]
    const moray_scenario *scenario; // [n], borrowed
    int n;
    double duration; // [s]
    moray_heading_gains start;
    double weight_steering;  // of a plan: of the mean square of wanted' in units of offset_rate, above 0
    moray_settings settings; // of the solve
} moray_robust_spec;

// One phase a scenario, in which the averaged plant swims under the law, its limits rounded off; the gains,
// proportional, forward and integral, are the parameters that all phases share; the objective is the mean over
// scenarios and time of the squared error, in units of 10 deg. Leads and derivatives stay 0. Error: MORAY_INPUT,
// MORAY_NOT_SOLVED with the diagnosis, those of moray_ocp_new and moray_solve.
MORAY_API moray_status moray_robust_gains(moray_heading_gains *found, double *objective, const moray_robust_spec *spec);

typedef struct moray_robust_point {
    double wanted, heading; // [m], [rad]
} moray_robust_point;

// The command wanted(t) + gain (heading(t) - theta), the same for all scenarios; heading(t) is the mean of their
// headings. Offsets and gain are those of the control-oriented model.
typedef struct moray_robust_plan {
    double duration; // [s], from 0 on
    int n;
    moray_robust_point *point; // [n] at equal times, owned
    double gain;               // [m/rad]; 0: blind
} moray_robust_plan;

// One phase with the states of all scenarios, as above, which share wanted(t), whose rate is the control, and the gain;
// blind: without a gain. The objective is that of the gains and the weighted square of the rate. Error: MORAY_INPUT,
// MORAY_MEMORY, MORAY_NOT_SOLVED with the diagnosis; the plan is then empty. Free with moray_robust_plan_free.
MORAY_API moray_status moray_robust_plan_make(moray_robust_plan *plan, double *objective, const moray_robust_spec *spec,
                                              bool blind);
MORAY_API void moray_robust_plan_free(moray_robust_plan *plan); // safe on a zeroed plan, and twice

// At t, of the nearest end beyond the ends.
MORAY_API double moray_robust_plan_wanted(const moray_robust_plan *plan, double t);
MORAY_API double moray_robust_plan_heading(const moray_robust_plan *plan, double t);

MORAY_END

#endif
