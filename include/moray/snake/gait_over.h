// SPDX-License-Identifier: MIT
//
// One gait for several scenarios: models, coefficients, currents. One programme, with one phase for each of them.
#ifndef MORAY_SNAKE_GAIT_OVER_H
#define MORAY_SNAKE_GAIT_OVER_H

#include "moray/export.h"
#include "moray/snake/gait_problem.h"

MORAY_BEGIN

enum { MORAY_SCENARIOS = 16 };

// A gait problem, whose goal is not used; limits.power is the baseline's power there. Model (first-principles or
// control-oriented), joints (MORAY_JOINTS_ON_GAIT) and the limits of theta_max, delta and taper are those of the first
// scenario for all.
typedef struct moray_gait_scenario {
    const char *name; // borrowed
    moray_gait_problem_spec problem;
    double speed; // the baseline's, through the water [m/s]: what is gained over
} moray_gait_scenario;

typedef enum { MORAY_OVER_WORST, MORAY_OVER_MEAN } moray_over_goal;

typedef struct moray_gait_over moray_gait_over;

// maximise  t,  t <= speed_k / speed of the baseline_k - 1,  power_k = power of the baseline_k,  and what else the
// limits say, for every scenario k; or the mean of speed_k / speed of the baseline_k - 1. Amplitude, delta and taper
// are shared. omega and the offset are each scenario's own: a gait is compared at equal power, and keeps its heading.
// Error: MORAY_INPUT naming what is wrong, MORAY_MEMORY.
MORAY_API moray_status moray_gait_over_new(moray_gait_over **over, const moray_gait_scenario *scenario, int n,
                                           moray_over_goal goal);
MORAY_API void moray_gait_over_free(moray_gait_over *over);

// Solves from the orbits of gaits, gait[n] and orbit[n]: as moray_gait_problem_solve, of equal amplitude, delta and
// taper, which are taken from the first. Errors and result: those of moray_solve.
MORAY_API moray_status moray_gait_over_solve(const moray_gait_over *over, const moray_settings *settings,
                                             const moray_gait *gait, const moray_swim_track *orbit,
                                             moray_solution **solution);

// What a solution predicts for scenario k (power_price 0), and the gain that it maximised: a ratio, 0.01 for 1 %.
MORAY_API moray_gait_prediction moray_gait_over_prediction(const moray_gait_over *over, const moray_solution *solution,
                                                           int k);
MORAY_API double moray_gait_over_gain(const moray_solution *solution);

MORAY_END

#endif
