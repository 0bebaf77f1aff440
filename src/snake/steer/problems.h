// SPDX-License-Identifier: MIT
//
// The problems of collocation behind the plans of moray/snake/{heading,path,turn}.h.
#ifndef SRC_SNAKE_STEER_PROBLEMS_H
#define SRC_SNAKE_STEER_PROBLEMS_H

#include "moray/snake/heading.h"
#include "moray/snake/path.h"
#include "moray/snake/turn.h"

// Builds the problem: minimise sum weight_m q_m + weight_power x work + weight_time (tf - t0) + the task's own.
// Error: MORAY_INPUT naming what is wrong, MORAY_MEMORY.
moray_status moray_steering_new(moray_steering **problem, const moray_steering_spec *spec);
void moray_steering_free(moray_steering *problem);
const moray_ocp *moray_steering_ocp(const moray_steering *problem);

// Work of joints or motors over the phase [J]; the task's integrals are the first of moray_solution_integrals.
double moray_steering_work(const moray_steering *problem, const moray_solution *solution);

// The parameters of a gait, for a guess; its offset is none of them.
void moray_steering_parameters(const moray_gait *gait, double s[MORAY_STEERING_PARAMETERS]);

// The state of a steering problem that swims so at t = 0, with this mean heading, in the current, from p = 0.
void moray_straight_motion_start(const moray_straight_motion *straight, double heading, const double current[2],
                                 double state[MORAY_STEERING_STATES]);

// The current at a place and time: of the water, or where there is none the uniform one.
void moray_steering_current(const moray_water *water, const double current[2], double x, double y, double t,
                            double V[2]);

// Error of all: those of moray_steering_new, and MORAY_INPUT. Free with moray_steering_problem_free.
moray_status moray_heading_new(moray_steering_problem *problem, const moray_heading_spec *spec);
moray_status moray_path_problem_new(moray_steering_problem *problem, const moray_path_spec *spec);
moray_status moray_turn_new(moray_steering_problem *problem, const moray_turn_spec *spec);
void moray_steering_problem_free(moray_steering_problem *problem); // safe on a zeroed problem, and twice

#endif
