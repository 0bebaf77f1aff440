// SPDX-License-Identifier: MIT
//
// Gains of heading feedback found by collocation over scenarios at once: the best fixed controller for a set of robots,
// currents and references.
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
    moray_settings settings; // of the solve
} moray_robust_spec;

// One phase a scenario, in which the averaged plant swims under the law, its limits rounded off; the gains,
// proportional, forward and integral, are the parameters that all phases share; the objective is the mean over
// scenarios and time of the squared error, in units of 10 deg. Leads and derivatives stay 0. Error: MORAY_INPUT,
// MORAY_NOT_SOLVED with the diagnosis, those of moray_ocp_new and moray_solve.
MORAY_API moray_status moray_robust_gains(moray_heading_gains *found, double *objective, const moray_robust_spec *spec);

MORAY_END

#endif
