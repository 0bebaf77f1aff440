// SPDX-License-Identifier: MIT
//
// Steering problems: a robot swims on a gait (25) and steers by the joint offset phi_0(t), a piecewise polynomial of
// limited range, rate and acceleration. One phase; states and control are those of MORAY_JOINTS_STEERED, parameters
// the gait's. A task adds what is to be followed or reached. On the first-principles model the robot's motors limit
// torques at every time, by their lines, and rates, those of a whole stroke: alpha omega + |phi_0'|.
#ifndef MORAY_SNAKE_STEERING_H
#define MORAY_SNAKE_STEERING_H

#include "moray/export.h"
#include "moray/ocp.h"
#include "moray/snake/plant.h"
#include "moray/snake/swim.h"

MORAY_BEGIN

enum { MORAY_STEERING_AMPLITUDE, MORAY_STEERING_OMEGA, MORAY_STEERING_DELTA, MORAY_STEERING_PARAMETERS };
enum { MORAY_STEERING_CONTROLS = 16 }; // at most: phi_0'' and the task's

// MORAY_INFINITY: no limit.
typedef struct moray_steering_limits {
    moray_bounds theta_max;                          // [rad] amplitude of (24), through (33) or (27)
    moray_bounds omega, delta;                       // [rad/s], [rad]
    double offset, offset_rate, offset_acceleration; // |phi_0| [m or rad], |phi_0'|, |phi_0''|
    double power;                                    // mean of the joints, or at the terminals of their motors [W]
} moray_steering_limits;

// The limits of the offset that mean the same to the other model, with the gait of `from`.
MORAY_API moray_steering_limits moray_steering_limits_map(const moray_robot *robot, const moray_steering_limits *limits,
                                                          const moray_gait *gait, moray_model from, moray_model to);

// What a task adds to the steered robot.
typedef struct moray_steering_task {
    const char *name;
    int nu, nc, nq;                // further controls (below MORAY_STEERING_CONTROLS), path outputs, integrands
    moray_complex_fn *extra;       // in = [x, phi_0'', further u, s, t] -> [path outputs, integrands]
    int ne;                        // events
    moray_endpoint_fn *events;     // its objective is added to the one below; data: self
    void *self;                    // of both; must outlive the problem
    const moray_bounds *u, *c, *e; // [nu], [nc], [ne]
    const char *const *u_names, *const *c_names, *const *e_names;
    const double *weight; // [nq], of the integrals in the objective
    double weight_power;  // of the work of joints or motors [1/J]
    double weight_time;   // of tf - t0 [1/s]
} moray_steering_task;

typedef struct moray_steering_spec {
    moray_robot robot;
    moray_model model;
    bool averaged;            // the period-averaged plant; control-oriented model only
    double current[2];        // [m/s]
    const moray_water *water; // in place of it, as of a moray_plant_spec; NULL: uniform
    moray_steering_limits limits;
    moray_bounds t0, tf;
    moray_bounds x0[MORAY_STEERING_STATES], xf[MORAY_STEERING_STATES]; // narrow the limits at the ends
    moray_steering_task task;
} moray_steering_spec;

typedef struct moray_steering moray_steering;

// A problem with the task it owns; of a plan.
typedef struct moray_steering_problem {
    moray_steering *steering;
    void *task;
} moray_steering_problem;

// The gait of a solution's parameters, offset 0.
MORAY_API moray_gait moray_steering_gait(const double s[MORAY_STEERING_PARAMETERS]);

// phi_0 at t, clamped to the phase; beyond its end the offset rests at its last value.
MORAY_API moray_offset moray_steering_offset(const moray_solution *solution, double t);

MORAY_END

#endif
