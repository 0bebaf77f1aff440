// SPDX-License-Identifier: MIT
//
// The optimal-gait problem: the periodic orbit of a swimming robot and the gait (25) that makes it the fastest along a
// course, or the thriftiest.
#ifndef MORAY_SNAKE_GAIT_PROBLEM_H
#define MORAY_SNAKE_GAIT_PROBLEM_H

#include "moray/export.h"
#include "moray/ocp.h"
#include "moray/sensitivity.h"
#include "moray/snake/plant.h"
#include "moray/snake/swim.h"

MORAY_BEGIN

// Bounds of the gait parameters and of what the gait may ask of the joints; moray_free() and MORAY_INFINITY: no limit.
typedef struct moray_gait_limits {
    moray_bounds theta_max; // [rad] amplitude of (24), through (33) or (27); with a taper that of every link may be
                            // no larger (moray_theta_max_of_link), that in the middle no smaller. Control-oriented
                            // model: where the offset is free, the upper bound holds for every link angle (12) too: at
                            // any time with the joints on the gait, else at the nodes of the mesh. With link_angles,
                            // and for a series, that is what the upper bound holds for, on both models:
                            // |link angle - heading|, not for amplitudes
    moray_bounds omega;     // [rad/s]
    moray_bounds delta;     // [rad]
    moray_bounds offset;    // phi_0 of the model [m or rad]
    moray_bounds taper;     // of the amplitude along the body, within -1:1; 0 for all links alike
    double power;           // mean of the joints, or at the terminals of their motors [W]
    double joint_rate;      // amplitude of every phi_i' [m/s or rad/s]
    double joint_effort;    // |u_i| [N or N m], at the nodes of the mesh
    double course_speed;    // least speed along the course [m/s]; 0: none
    bool link_angles;       // theta_max.upper bounds what the links do, not the amplitude of (24)
} moray_gait_limits;

typedef enum {
    MORAY_GAIT_FASTEST,   // largest speed along the course
    MORAY_GAIT_THRIFTIEST // least work of joints or motors and of the constant power, per distance along the course
} moray_gait_goal;

typedef struct moray_gait_problem_spec {
    moray_robot robot;
    moray_model model;
    moray_gait_goal goal;
    moray_joints joints; // MORAY_JOINTS_ON_GAIT; MORAY_JOINTS_CLOSED_LOOP, control-oriented model only; or
                         // MORAY_JOINTS_SERIES, with the limits of delta, taper and theta_max.lower unused, those of
                         // the offset for every c_i, and q_11 = 0, which decides when time starts
    int harmonics;       // of a series
    double current[2];   // [m/s]
    double course;       // [rad]
    moray_gait_limits limits;
} moray_gait_problem_spec;

typedef struct moray_gait_problem moray_gait_problem;

// Builds the problem: one phase over one period, from p = 0; states periodic but for the position; no net motion across
// the course; the goal. All derivatives analytic. Error: MORAY_INPUT naming what is wrong,
// MORAY_MEMORY.
MORAY_API moray_status moray_gait_problem_new(moray_gait_problem **problem, const moray_gait_problem_spec *spec);
MORAY_API void moray_gait_problem_free(moray_gait_problem *problem);
MORAY_API const moray_ocp *moray_gait_problem_ocp(const moray_gait_problem *problem);

// The gait as parameters s = (a, omega, delta, phi_0, taper), and back.
enum { MORAY_GAIT_PARAMETERS = 5 };
MORAY_API moray_gait moray_gait_from_parameters(const double s[MORAY_GAIT_PARAMETERS]);
MORAY_API void moray_gait_to_parameters(const moray_gait *gait, double s[MORAY_GAIT_PARAMETERS]);

// Solves from the orbit of `gait` (parameters of the problem's model): a track over one period, from t = 0, p = 0, as
// moray_swim_steady leaves it. MORAY_INPUT where gait or problem is of a series; other errors and result: those of
// moray_solve.
MORAY_API moray_status moray_gait_problem_solve(const moray_gait_problem *problem, const moray_settings *settings,
                                                const moray_gait *gait, const moray_swim_track *orbit,
                                                moray_solution **solution);

// Solves from another solution over one period on the same model, of a problem with six states as this one's, at
// parameters s; those of a series are (omega, coefficients as in moray_series). Errors and result: those of
// moray_solve.
MORAY_API moray_status moray_gait_problem_continue(const moray_gait_problem *problem, const moray_settings *settings,
                                                   const moray_solution *from, const double *s,
                                                   moray_solution **solution);

// What a solution predicts, over one period: velocity over ground, speed through the water, speed along the course,
// mean power.
typedef struct moray_gait_prediction {
    moray_gait gait; // of a series omega alone: its coefficients are among moray_solution_parameters
    double v_x, v_y, speed, course_speed, power;
    double power_price; // by how much the goal improves per watt more that is allowed [m/s or J/m, per W]
} moray_gait_prediction;
MORAY_API moray_gait_prediction moray_gait_problem_prediction(const moray_gait_problem *problem,
                                                              const moray_solution *solution);

// Derivatives of a prediction by the parameter that was last taken of a sensitivity of the solution.
typedef struct moray_gait_slope {
    moray_gait gait;
    double course_speed, power;
} moray_gait_slope;
MORAY_API moray_gait_slope moray_gait_problem_slope(const moray_gait_problem *problem, const moray_solution *solution,
                                                    const moray_sensitivity *sensitivity);

MORAY_END

#endif
