// SPDX-License-Identifier: MIT
//
// Second derivatives of the first-principles model, by hand and in real numbers: how the gradient of F (fp_adjoint.h)
// moves along many directions of the motion at once. Directions lie side by side, so that a processor takes as many of
// them as its registers hold.
#ifndef SRC_SNAKE_MODEL_FP_TANGENT_H
#define SRC_SNAKE_MODEL_FP_TANGENT_H

#include <stddef.h>

#include "snake/model/fp_adjoint.h"

enum { FP_LANES = 8 }; // rows of directions are padded to a multiple of it

// n directions [rows x stride] of theta_i and theta_i' [N rows], phi_i'' [N-1] and the velocity of (p_x, p_y) [2]; the
// stride is a multiple of FP_LANES, and what is behind n whatever finite number it is.
typedef struct fp_directions {
    int n, stride;
    double *theta, *dtheta, *ubar, *v;
} fp_directions;

// Likewise how the members of an fp_gradient move along them.
typedef struct fp_tangents {
    double *theta, *dtheta, *ddtheta, *v;
} fp_tangents;

// What moray_fp_accelerations_d, moray_fp_torques_d and moray_fp_adjoint_d took and left, all borrowed.
typedef struct fp_point {
    const fp_robot *robot;
    const double *V; // [2]
    const fp_motion_d *motion;
    const fp_link_d *links;
    const fp_balance_d *balance;
    const double *ddtheta, *u;
    const fp_weights *weight;
    const fp_dual_link_d *dual;
} fp_point;

static inline int fp_stride(int n)
{
    return (n + FP_LANES - 1) / FP_LANES * FP_LANES;
}

// Bytes of the scratch memory, aligned as malloc does, for N links.
size_t moray_fp_tangents_bytes(int N);

// How many directions the processor takes at a time at most: 2, 4 or 8.
int moray_fp_widest(void);

// `wide` of them at a time: moray_fp_widest(), or less to try that.
void moray_fp_tangents(int wide, const fp_point *at, const fp_directions *along, void *memory, const fp_tangents *out);

#endif
