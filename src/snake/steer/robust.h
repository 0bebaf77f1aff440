// SPDX-License-Identifier: MIT
//
// A robot of a scenario on the averaged plant, its offset behind its command: what plans and gains over scenarios
// share.
#ifndef SRC_SNAKE_STEER_ROBUST_H
#define SRC_SNAKE_STEER_ROBUST_H

#include <complex.h>

#include "moray/snake/robust.h"
#include "snake/plant/average.h"

enum { ROBUST_THETA, ROBUST_V_THETA, ROBUST_V_T, ROBUST_V_N, ROBUST_PHI_0, ROBUST_STATES };

typedef struct robust_robot {
    const moray_robust_spec *spec;
    const moray_scenario *own;
    moray_average *plant;
} robust_robot;

// Error: MORAY_INPUT, MORAY_MEMORY. free(robot->plant).
moray_status moray_robust_robot_new(robust_robot *robot, const moray_robust_spec *spec, const moray_scenario *own);

// Keeps a value within its limit, rounded off.
double complex moray_robust_limited(double complex value, double limit);

// The reference of the scenario at t, and its rate.
double complex moray_robust_reference(const robust_robot *robot, double complex t, double *rate);

// x[ROBUST_STATES] -> dx, the offset on its way to a command within its limit.
void moray_robust_rates(const robust_robot *robot, const double complex *x, double complex command, double complex *dx);

// Bounds within which the robot swims ahead, as the averaged plant takes for granted; the state at 0.
void moray_robust_bounds(const moray_robust_spec *spec, moray_bounds x[ROBUST_STATES]);
void moray_robust_start(const moray_scenario *own, double x[ROBUST_STATES]);

// The reference as though it were followed, somewhat late: the sizes of all that is solved for are taken from here.
void moray_robust_guess(const moray_scenario *own, double t, double x[ROBUST_STATES]);

// What the noise of the heading costs under a gain, of the mean squared error in units of 10 deg.
#define ROBUST_ERROR_UNIT (10 * MORAY_DEGREE)
moray_num moray_robust_noise(const moray_robust_spec *spec, moray_num gain);

// Error: MORAY_INPUT.
moray_status moray_robust_check(const moray_robust_spec *spec);

#endif
