// SPDX-License-Identifier: MIT
//
// The adjoint of the first-principles model in the number type REAL; fp_adjoint.h includes this text once for each
// type, which is why it has no include guard.

// Scratch of a link. With virtual accelerations of the chain, theta''_k of the link and xi_k of its centre, F is the
// virtual power of the links' net forces and moments.
typedef struct TYPED(fp_dual_link) {
    REAL turn; // virtual theta''
    TYPED(fp_vector) xi, net, on_v, on_a;
} TYPED(fp_dual_link);

// Derivatives of F by theta_i, theta_i', theta_i'' [N each] and by the velocity of (p_x, p_y); theta'' counts as given
// but for its mean.
typedef struct TYPED(fp_gradient) {
    REAL *theta, *dtheta, *ddtheta;
    REAL v_x, v_y;
} TYPED(fp_gradient);

// After moray_fp_accelerations and moray_fp_torques with the same motion and links; balances, ddtheta[N] and u[N-1]
// from there.
void TYPED(moray_fp_adjoint)(const fp_robot *robot, const double V[2], const TYPED(fp_motion) * motion,
                             const TYPED(fp_link) * links, const TYPED(fp_balance) * factored, const REAL *ddtheta,
                             const REAL *u, const fp_weights *weight, TYPED(fp_dual_link) * dual,
                             TYPED(fp_gradient) * out);

// Derivatives by the joints where those by the angles, of given mean, are on_angles[N]; returns that by the mean.
REAL TYPED(moray_fp_pull_angles)(int N, const REAL *on_angles, REAL *on_joints);
