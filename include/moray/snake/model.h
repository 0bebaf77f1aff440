// SPDX-License-Identifier: MIT
//
// Underwater snake robot: parameters, gait, control-oriented and first-principles models. Equation numbers are those of
// Kelasidi et al., "A control-oriented model of underwater snake robots exposed to currents"; errata E1-E4 in
// README.md. Units are SI throughout; angles in rad.
#ifndef MORAY_SNAKE_MODEL_H
#define MORAY_SNAKE_MODEL_H

#include "moray/export.h"
#include "moray/map.h"
#include "moray/ode.h"
#include "moray/snake/motor.h"

MORAY_BEGIN

// Which hydrodynamics: all zero is the paper's. Those of the first-principles model but for the last;
// src/snake/README.md has the equations, and which erratum each one answers. The control-oriented model knows linear
// drag only.
typedef enum { MORAY_ROTATION_PAPER, MORAY_ROTATION_STRIP } moray_rotation;
typedef enum { MORAY_DRAG_LINEAR, MORAY_DRAG_QUADRATIC, MORAY_DRAG_BOTH } moray_drag;
typedef enum { MORAY_ADDED_MASS_PAPER, MORAY_ADDED_MASS_INVARIANT } moray_added_mass;
typedef enum { MORAY_FRAME_PAPER, MORAY_FRAME_INVARIANT } moray_frame;
typedef struct moray_hydrodynamics {
    moray_rotation rotation; // drag and added mass at the centre of a link, or spread evenly along it in place of (4)
    moray_drag drag;         // the terms of (2) relative to the water: linear, quadratic, both (Remark 2, erratum E8)
    moray_added_mass added_mass; // (2) as printed, or the same to every observer who moves with a constant velocity
    moray_frame frame; // (15b), (15c) of the control-oriented model, or with theta' v_n, -theta' v_t (erratum E7)
    int pieces; // every link cut into so many with the joints between them held: (2)-(4) with lambda_1, lambda_2 of
                // (l/pieces)^3, lambda_3 of (l/pieces)^4 for each, J of the whole; 0 or 1: not cut. Not with strip.
} moray_hydrodynamics;

// Strip, both drags, invariant added mass and frame.
MORAY_API moray_hydrodynamics moray_hydrodynamics_consistent(void);

enum { MORAY_MOST_LINKS = 1000 };

// A link that differs from the others. l to lambda_3 are those of moray_robot; cm and cb are how far the centre of mass
// and that of buoyancy, at which the water acts, lie from the link's middle towards the head [m]; a fin at fin_at from
// there, which may be beyond the link's end, adds drag and added mass of its own.
typedef struct moray_link {
    double l, m, J, c_t, c_n, mu_n, lambda_1, lambda_2, lambda_3;
    double cm, cb;
    double fin_c_t, fin_c_n, fin_mu_n, fin_at;
} moray_link;

// The robot. Every field is set; moray_robot_check says whether they make sense. Where the links are not equal, the
// fields of a link are those of the nearest equal robot, the means over all links (so that length, mass and
// coefficients in all are the robot's), which is what the control-oriented model swims; `link` then has each one
// relative to these.
typedef struct moray_robot {
    int links;                           // N = 2..MORAY_MOST_LINKS
    double l;                            // half a link [m]; L = 2l (erratum E2)
    double m, J;                         // mass [kg] and moment of inertia [kg m^2] of a link
    double c_t, c_n;                     // tangential and normal drag per link [kg/s]
    double mu_n;                         // normal added mass per link [kg]
    double lambda_1, lambda_2, lambda_3; // fluid torque (4): added inertia, linear and quadratic drag
    double rot_damping, rot_gain;        // lambda~_1 [1/s], lambda~_2 [1/(m^2 s)] of (20), control-oriented model only
    double k_p, k_d;                     // joint controller (34) [1/s^2], [1/s]
    moray_hydrodynamics hydro;
    const moray_link *link; // [links], borrowed, from link 1, the tail, on: its fields over those of the robot (a fin's
                            // over c_t, c_n, mu_n; cm, cb, fin_at over the link's own l); NULL: all links are equal
    moray_motor motor; // of every joint of the first-principles model, at whose terminals power is counted where it is
                       // fitted; the control-oriented model's joints, which are not rotary, have none
    moray_supply supply;
} moray_robot;

// Link i = 0..links-1 with units; of equal links all alike, without a fin.
MORAY_API moray_link moray_robot_link(const moray_robot *robot, int i);

// Makes the robot of links with units, link[robot->links]: sets its l, m, J, c_t, c_n, mu_n, lambda_1..3 to the means
// and turns link[] into the ratios, which it refers to from then on; not where all links are equal to the last bit.
MORAY_API void moray_robot_from_links(moray_robot *robot, moray_link *link);

// An elliptic-cylinder link in a fluid, from which the coefficients of moray_robot follow (Sec. V-A).
typedef struct moray_link_geometry {
    double length;             // 2l [m]
    double a_e, b_e;           // in-plane and vertical semi-axis [m]
    double rho;                // fluid density [kg/m^3]
    double C_f, C_D, C_A, C_M; // drag and added-mass constants [-]
} moray_link_geometry;

// The robot of Sec. V-A (a_e = 0.05, b_e = 0.03, 2l = 0.14, N = 10) and its links.
MORAY_API moray_robot moray_robot_paper(void);
MORAY_API moray_link_geometry moray_link_geometry_paper(void);

// Sets l, m, J, c_t, c_n, mu_n and lambda_1..3 of the robot; leaves the rest. J is that of the solid elliptic cylinder.
MORAY_API void moray_robot_from_geometry(moray_robot *robot, const moray_link_geometry *geometry);

// Error: MORAY_INPUT naming the first field that is not usable, its value and what is allowed.
MORAY_API moray_status moray_robot_check(const moray_robot *robot);

// Whether any gait of it makes way. Two links do not: turned about the joint's axis of symmetry they are the same robot
// with the same motion of the joint, swimming the other way. Error: MORAY_NOT_SOLVED, saying so.
MORAY_API moray_status moray_robot_check_swims(const moray_robot *robot);

typedef enum { MORAY_CONTROL_ORIENTED, MORAY_FIRST_PRINCIPLES } moray_model;

MORAY_API const char *moray_model_name(moray_model model); // "control-oriented", "first-principles"
MORAY_API const char *moray_model_key(moray_model model);  // "control", "fp", as options and summaries have it

// A free periodic motion of the joints, beyond the paper: a truncated Fourier series in each of them,
//     phi_i(t) = c_i + sum_k p_ik sin(k omega t) + q_ik cos(k omega t),   k = 1..harmonics.
// at[joints (1 + 2 harmonics)], borrowed: c of all joints, then p and q of all joints for one harmonic after the other.
typedef struct moray_series {
    int joints, harmonics;
    const double *at;
} moray_series;
enum { MORAY_SERIES_HARMONICS = 12 }; // at most

// Gait (25): phi_ref,i(t) = A_i sin(omega t + (i-1) delta) + offset, i = 1..N-1. A_i and offset are a and phi_0 in m
// for the control-oriented model, alpha and phi_0 in rad for the first-principles model. Where the offset moves,
// offset_rate and offset_acceleration are phi_0' and phi_0'' at t, fed forward. Eel-like motion, beyond the paper, with
// a negative taper: A_i = amplitude (1 + taper s_i) with s_i = 2 (i-1)/(N-2) - 1 from -1 at the first joint, the tail,
// to 1 at the last (0 where N = 2). And beyond that, what swims heeds a
// series to be added; what needs a gait (25) alone (orbits, searches, plans, comparisons on both models) refuses one.
typedef struct moray_gait {
    double amplitude, omega, delta, offset, taper, offset_rate, offset_acceleration;
    const moray_series *series; // of the gait's omega, for N-1 joints; NULL: none
} moray_gait;

// phi_ref, its first and second time derivative at t, each of n_joints = N-1 entries.
MORAY_API void moray_gait_reference(const moray_gait *gait, int n_joints, double t, double *phi, double *dphi,
                                    double *ddphi);

// Amplitude from the link-angle amplitude theta_max of (24), and back: (27) alpha = 2 sin(delta/2) theta_max;
// (33) a = 2l cos(delta/2) sin theta_max. With a taper they hold for the middle of the body. The wave of link angles
// whose differences (1) are a tapered gait has in link i
//     theta_max,i = alpha/(2 sin(delta/2)) sqrt((1 + taper s)^2 + (taper cot(delta/2)/(N-2))^2),
// and that which gives one by (29), phi_i = l sin theta_i + l sin theta_{i+1},
//     sin theta_max,i = a/(2l cos(delta/2)) sqrt((1 + taper s)^2 + (taper tan(delta/2)/(N-2))^2),
// where s is s_i halfway between its two joints: -+ (N-1)/(N-2) for the first and the last link.
MORAY_API double moray_amplitude_from_theta_max(const moray_robot *robot, moray_model model, double theta_max,
                                                double delta);
MORAY_API double moray_theta_max_from_amplitude(const moray_robot *robot, moray_model model, double amplitude,
                                                double delta);

// That of link i = 1..N of a gait with a taper; the largest is that of link N, the head, or link 1, the tail.
MORAY_API double moray_theta_max_of_link(const moray_robot *robot, moray_model model, const moray_gait *gait, int link);

// The same gait for the other model: equal theta_max, omega, delta, taper; offset and its derivatives in the same ratio
// to the amplitude, with the opposite sign (erratum E3). A series is not mapped but left out.
MORAY_API moray_gait moray_gait_map(const moray_robot *robot, const moray_gait *gait, moray_model from, moray_model to);

// The gait with its constant offset and its series as one series of so many harmonics (those of its own beyond them are
// left out): at[joints (1 + 2 harmonics)].
MORAY_API void moray_series_of_gait(const moray_gait *gait, int joints, int harmonics, double *at);

// A series of the control-oriented model for the first-principles model, into at as long as series->at: every joint's
// share in every harmonic keeps the wave of link angles that it has in its surroundings, of a phase shift delta taken
// from its neighbours, with (27) and (33) for that delta. Of a gait (25) it is moray_gait_map; offsets go by the ratio
// of the first harmonics.
MORAY_API void moray_series_to_first_principles(const moray_robot *robot, const moray_series *series, double *at);

// ---- Models as ordinary differential equations: joints steered to a motion ubar = phi'' --------------------------
//
// State of the control-oriented model, (21), 2N+4: phi (N-1), theta, p_x, p_y, v_phi (N-1), v_theta, v_t, v_n.
// State of the first-principles model, 2N+4: theta_1..N, p_x, p_y, and their time derivatives in the same order.

typedef struct moray_swimmer moray_swimmer; // one robot, one model, its scratch space; not for two threads at once

// Makes a swimmer of a copy of the robot. Error: MORAY_INPUT (moray_robot_check), MORAY_MEMORY.
MORAY_API moray_status moray_swimmer_new(moray_swimmer **swimmer, const moray_robot *robot, moray_model model);
MORAY_API void moray_swimmer_free(moray_swimmer *swimmer);

// Another robot of as many links in its place. Error: MORAY_INPUT.
MORAY_API moray_status moray_swimmer_set_robot(moray_swimmer *swimmer, const moray_robot *robot);
MORAY_API const moray_robot *moray_swimmer_robot(const moray_swimmer *swimmer);
MORAY_API moray_model moray_swimmer_model(const moray_swimmer *swimmer);
MORAY_API int moray_swimmer_states(const moray_swimmer *swimmer); // 2N+4

MORAY_API void moray_swimmer_set_current(moray_swimmer *swimmer, double V_x, double V_y);
MORAY_API void moray_swimmer_current(const moray_swimmer *swimmer, double V[2]);

// Something that the model leaves out: adds to the state derivative dx[2N+4] in the state x[2N+4]. NULL: nothing.
typedef void moray_swimmer_extra_fn(const moray_swimmer *swimmer, const double *x, double *dx);
MORAY_API void moray_swimmer_set_extra(moray_swimmer *swimmer, moray_swimmer_extra_fn *extra);

// The largest torque of every joint of the first-principles model [N m], 0: none. The joints give what their motion
// asked for would take, cut off there, and then do not follow it. Error: MORAY_INPUT, MORAY_MEMORY.
MORAY_API moray_status moray_swimmer_set_torque(moray_swimmer *swimmer, double most);
MORAY_API double moray_swimmer_torque(const moray_swimmer *swimmer);

// State at rest over ground: all velocities zero, straight body at heading
// theta, position (p_x, p_y). x[2N+4].
MORAY_API void moray_swimmer_rest(const moray_swimmer *swimmer, double theta, double p_x, double p_y, double *x);

// Joint coordinates and rates (N-1 each) of the state.
MORAY_API void moray_swimmer_joints(const moray_swimmer *swimmer, const double *x, double *phi, double *v_phi);

// States of the plants with the joints on the gait, and behind them, where it is steered, of the joint offset.
// Velocity: v_t, v_n along and across the head link in the control-oriented model, v_x, v_y in the other, whose theta
// is the mean.
enum {
    MORAY_STATE_THETA,
    MORAY_STATE_P_X,
    MORAY_STATE_P_Y,
    MORAY_STATE_V_THETA,
    MORAY_STATE_V_1,
    MORAY_STATE_V_2,
    MORAY_BODY_STATES,
    MORAY_STATE_PHI_0 = MORAY_BODY_STATES,
    MORAY_STATE_V_PHI_0, // phi_0'
    MORAY_STEERING_STATES
};

// Those of the body: of a full state of the model; and the full state whose joints are on the gait at t.
MORAY_API void moray_state_body(moray_model model, int links, const double *x, double body[MORAY_BODY_STATES]);
MORAY_API void moray_swimmer_on_gait(const moray_swimmer *swimmer, const moray_gait *gait, double t,
                                     const double body[MORAY_BODY_STATES], double *x);

// The same with joints phi[N-1] at the rates v_phi[N-1].
MORAY_API void moray_swimmer_with_joints(const moray_swimmer *swimmer, const double *phi, const double *v_phi,
                                         const double body[MORAY_BODY_STATES], double *x);

// State derivative with joint accelerations ubar[N-1], or those that the limit of the torques leaves of them; also the
// joint efforts u[N-1] (force in N by (22), or torque in N m by inverse dynamics of (5)) unless NULL. False where the
// dynamics are singular or not finite.
MORAY_API bool moray_swimmer_rates(moray_swimmer *swimmer, const double *x, const double *ubar, double *dx, double *u);

// What the water does to the links of the first-principles model, along[N] and across[N] each [N]; with ubar NULL
// without what their accelerations take (the added mass). False for the control-oriented model, which knows no such
// forces of single links, and where the dynamics are singular or not finite.
MORAY_API bool moray_swimmer_water_forces(moray_swimmer *swimmer, const double *x, const double *ubar, double *along,
                                          double *across);

// Power of the joints at efforts u and rates v_phi: at the terminals of its motors where the model has them, else sum
// u_i v_phi,i [W].
MORAY_API double moray_swimmer_power(const moray_swimmer *swimmer, const double *u, const double *v_phi);

// (34): ubar[N-1] that steers the state to the gait at time t.
MORAY_API void moray_swimmer_control(const moray_swimmer *swimmer, const moray_gait *gait, double t, const double *x,
                                     double *ubar);

// Outputs of a state: heading (theta, or mean link angle), position, ground velocity, largest |link angle - heading|
// ((12) for the control-oriented model).
typedef struct moray_pose {
    double heading, p_x, p_y, v_x, v_y, link_angle;
} moray_pose;
MORAY_API moray_pose moray_swimmer_pose(const moray_swimmer *swimmer, const double *x);

// Half the length of link i = 0..N-1 as the model has it [m].
MORAY_API double moray_swimmer_half_length(const moray_swimmer *swimmer, int i);

// Centres and orientations of the N links in the plane, for drawing: x_i[N], y_i[N], angle_i[N]. For the
// control-oriented model the centres of (8) and theta + (12).
MORAY_API void moray_swimmer_links(const moray_swimmer *swimmer, const double *x, double *x_i, double *y_i,
                                   double *angle_i);

MORAY_END

#endif
