// SPDX-License-Identifier: MIT
//
// The first-principles model (2)-(5) for joints of prescribed acceleration, in the number type REAL; fp_model.h
// includes this text once for each type, which is why it has no include guard.

typedef struct TYPED(fp_vector) {
    REAL x, y;
} TYPED(fp_vector);

// Link i: cosine and sine of theta_i; position relative to (p_x, p_y), velocity and acceleration of its centre of mass;
// fluid force (2) without its first term, in the plane and along and across the link; fluid torque (4) likewise.
typedef struct TYPED(fp_link) {
    REAL c, s;
    TYPED(fp_vector) r, v, a, f;
    REAL f_t, f_n, tau;
} TYPED(fp_link);

// Second derivatives of the potential P(a, b) of the quadratic drag across a link, for a drag of 1 [m/s]; by Euler's
// theorem dP/da = (aa a + ab b) / 2 and dP/db = (ab a + bb b) / 2.
typedef struct TYPED(fp_drag) {
    REAL aa, ab, bb;
} TYPED(fp_drag);

// At the velocity a across, and b = theta' times half the length that the drag acts on; fp_drag.inc has the formulas.
TYPED(fp_drag) TYPED(moray_fp_drag_slopes)(const fp_robot *robot, REAL a, REAL b);

// theta_1..N and their rates, velocity of (p_x, p_y), and phi''[N-1].
typedef struct TYPED(fp_motion) {
    const REAL *theta, *dtheta;
    REAL v_x, v_y;
    const REAL *ubar;
} TYPED(fp_motion);

// The N angles of the given mean with angles_i - angles_{i+1} = joints_i, joints[N-1]: (1) read backwards. Serves
// angles, rates and accelerations alike.
void TYPED(moray_fp_angles)(int N, REAL mean, const REAL *joints, REAL *angles);

// The symmetric positive definite matrix of the three balances of the whole chain, moment about (p_x, p_y) and forces,
// by mean theta'' and p_x'', p_y'': D L^T of its L D L^T in the upper triangle.
typedef struct TYPED(fp_balance) {
    REAL S[3][3];
} TYPED(fp_balance);

// Accelerations of the links ddtheta[N] and of (p_x, p_y) ddp[2] in the current V, by these balances, which it leaves
// factored; leaves the state of every link in links[N]. False where the balances are singular.
bool TYPED(moray_fp_accelerations)(const fp_robot *robot, const double V[2], const TYPED(fp_motion) * motion,
                                   TYPED(fp_link) * links, TYPED(fp_balance) * balance, REAL *ddtheta, REAL *ddp);

// Solves the balances for other loads h, which are overwritten.
void TYPED(moray_fp_solve_balance)(const TYPED(fp_balance) * balance, REAL h[3]);

// Joint torques u[N-1] of (5a) by inverse dynamics, after fp_accelerations; returns the power at the motors' terminals,
// or sum u_i phi_i' without motors.
REAL TYPED(moray_fp_torques)(const fp_robot *robot, const TYPED(fp_motion) * motion, const TYPED(fp_link) * links,
                             const REAL *ddtheta, REAL *u);

// What the supply allows, of every line of the motors and then of every joint: u_m + slope phi', out[lines (N-1)].
void TYPED(moray_fp_supply)(const fp_robot *robot, const TYPED(fp_motion) * motion, const REAL *u, REAL *out);
