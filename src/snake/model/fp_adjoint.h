// SPDX-License-Identifier: MIT
//
// Gradients of the first-principles model, all at once, by hand: of a weighted sum
//     F = lambda . (mean theta'', p_x'', p_y'') + rho . u + pi sum u_i phi_i'
// of what the joints' motion brings about. Written for complex numbers, so that one complex step through it is a row of
// the Hessian.
#ifndef SRC_SNAKE_MODEL_FP_ADJOINT_H
#define SRC_SNAKE_MODEL_FP_ADJOINT_H

#include "snake/model/fp_model.h"

typedef struct fp_weights {
    const double *lambda; // [3]
    const double *rho;    // [N-1]; NULL for zeros
    double pi;
} fp_weights;

// Scratch of a link. With virtual accelerations of the chain, theta''_k of the link and xi_k of its centre, F is the
// virtual power of the links' net forces and moments.
typedef struct fp_dual_link {
    double complex turn; // virtual theta''
    fp_vector_z xi, net, on_v, on_a;
} fp_dual_link;

// Derivatives of F by theta_i, theta_i', theta_i'' [N each] and by the velocity of (p_x, p_y); theta'' counts as given
// but for its mean.
typedef struct fp_gradient {
    double complex *theta, *dtheta, *ddtheta;
    double complex v_x, v_y;
} fp_gradient;

// After moray_fp_accelerations_z and moray_fp_torques_z with the same motion and links; ddtheta[N] and u[N-1] from
// there.
void moray_fp_adjoint(const fp_robot *robot, const double V[2], const fp_motion_z *motion, const fp_link_z *links,
                      const double complex *ddtheta, const double complex *u, const fp_weights *weight,
                      fp_dual_link *dual, fp_gradient *out);

// Derivatives by the joints where those by the angles, of given mean, are on_angles[N]; returns that by the mean.
double complex moray_fp_pull_angles(int N, const double complex *on_angles, double complex *on_joints);

#endif
