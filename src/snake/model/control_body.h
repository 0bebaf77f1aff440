// SPDX-License-Identifier: MIT
//
// The body of the control-oriented model: its accelerations as functions of four scalar features of the shape and of
// theta, v_t, v_n, with first and second derivatives. (14) inserted into (15b), (15c) gives two linear equations in the
// accelerations,
//     N m  dv_t - 2 mu_p s dv_n = -mu_p z - c_p w + 2 c_p s v_nr - (N c_t + c_n^ q) v_tr
//     N mt dv_n - 2 mu_p s dv_t = 2 c_p s v_tr - N c_n v_nr,        mt = m + mu_n,
// whose solution is (16b), (16c). In the invariant frame they stand for dv_t - theta' v_n and dv_n + theta' v_t, the
// accelerations in the plane, here and in the added mass. Derivatives follow by differentiating the equations rather
// than the solution.
#ifndef SRC_SNAKE_MODEL_CONTROL_BODY_H
#define SRC_SNAKE_MODEL_CONTROL_BODY_H

#include "moray/snake/model.h"

// s = sum phi, q = |A^T phi|^2, w = phi^T A Dbar v_phi, z = phi^T A Dbar ubar
enum { FEATURE_S, FEATURE_Q, FEATURE_W, FEATURE_Z, FEATURES };
enum { BODY_THETA, BODY_V_T, BODY_V_N, BODY_INPUTS };

// Constants of the robot and the current.
typedef struct control_body {
    double N, m, mt, c_t, c_n;
    double c_p, mu_p, ch_n;  // c_p, mu_p, c_n^ of (13)
    double damping, turning; // of v_theta and of v_tr s in (20)
    double frame;            // of theta' v_n, -theta' v_t in (15b), (15c): 0 as printed, 1 invariant (erratum E7)
    double V_x, V_y;
} control_body;

// What follows from features y and (theta, v_t, v_n). Suffix _y: derivative by the features; _b: by the body inputs.
typedef struct body_point {
    double y[FEATURES];
    double v_t, v_n, sine, cosine; // of theta
    double V_t, V_n, v_tr, v_nr;   // current and relative velocity in the body frame
    double h_1;                    // (17); NaN where the inertia is not positive definite
    double dv_t, dv_n;             // without the turning of the frame
    double kappa;                  // mu_p dv_t + c_p v_tr: the normal force (14b) that bends the body, per A^T phi
    double dv_t_y[FEATURES], dv_n_y[FEATURES], kappa_y[FEATURES];
    double tr_b[BODY_INPUTS], nr_b[BODY_INPUTS];
    double dv_t_b[BODY_INPUTS], dv_n_b[BODY_INPUTS], kappa_b[BODY_INPUTS];
} body_point;

// Weights of a scalar lambda . (dp_x, dp_y, dv_theta, dv_t, dv_n) + kappa bend, where bend is itself a function of the
// shape.
typedef struct body_weights {
    double dp_x, dp_y, dv_theta, dv_t, dv_n, bend;
} body_weights;

// First derivatives of that scalar by the features, bend held, and what its second derivatives consist of. With all
// gradients taken by the same inputs, x v y = x y^T + y x^T, and the scalar's gradient by the features g:
//     Hessian = grad s v a + grad kappa v grad bend + grad q v e + sum_y g_y Hessian(y) + kappa Hessian(bend) + bb,
//     a = a_dv_t grad dv_t + a_dv_n grad dv_n  by shape inputs, a_b by body inputs; e is zero by shape inputs.
typedef struct body_curvature {
    double g[FEATURES];
    double a_dv_t, a_dv_n, a_b[BODY_INPUTS], e_b[BODY_INPUTS];
    double bb[BODY_INPUTS]; // by theta and (theta, v_t, v_n)
} body_curvature;

control_body moray_body_of(const moray_robot *robot, const double current[2]);

// Features of the shape, and bt_phi = (A Dbar)^T phi; N-1 entries each.
void moray_body_features(int N, const double *phi, const double *v_phi, const double *ubar, double *bt_phi,
                         double y[FEATURES]);

void moray_body_values(const control_body *body, const double y[FEATURES], const double in[BODY_INPUTS],
                       body_point *at);

// (23b)-(23d) and (23f)-(23h), the last with erratum E1.
void moray_body_rates(const control_body *body, const body_point *at, double v_theta, double dpose[3],
                      double dvelocity[3]);

// (22) in two parts: load = G (mt ubar + c_n v_phi), u = load + kappa bt_phi, where G = (D D^T)^{-1}; load may be u.
// All of N-1 entries, scratch too.
void moray_body_joint_forces(const control_body *body, const body_point *at, const double *v_phi, const double *ubar,
                             const double *bt_phi, double *scratch, double *load, double *u);

void moray_body_gradients(const control_body *body, body_point *at); // after moray_body_values
body_curvature moray_body_second(const control_body *body, const body_point *at, const body_weights *weight);

#endif
