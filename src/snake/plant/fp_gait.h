// SPDX-License-Identifier: MIT
//
// The first-principles model with its joints on the gait, at one input: [heading, p_x, p_y, their rates, alpha, omega,
// delta, phi_0, taper, t], or with phi_0, phi_0', phi_0'' before alpha and no taper.
#ifndef SRC_SNAKE_PLANT_FP_GAIT_H
#define SRC_SNAKE_PLANT_FP_GAIT_H

#include "moray/snake/plant.h"
#include "snake/plant/fp_columns.h"
#include "snake/plant/reference.h"

typedef struct fp_setting {
    moray_plant_spec spec;
    fp_robot robot;
    moray_plant_size size;
} fp_setting;

enum { FP_RANKS = 3 }; // angles, rates and accelerations

typedef struct fp_gait {
    const fp_setting *of;
    reference gait;                                                      // with alpha for its amplitude
    int place[GAIT_KINDS];                                               // of the gait's inputs; -1: it has none
    double *theta, *dtheta, *ddtheta, *u;                                // N or N-1 each, as what follows
    double *joints[FP_RANKS], *on_links[FP_RANKS], *on_joints[FP_RANKS]; // on: derivatives of a weighted sum
    double *slope[GAIT_KINDS][FP_RANKS];                                 // of the joints by the gait's inputs
    double on_mean[FP_RANKS];
    fp_link_d *links;
    fp_dual_link_d *dual;
    fp_motion_d motion;
    fp_balance_d balance;
    double ddp[2], power;
    fp_columns columns;
    double *memory;
} fp_gait;

// `of` is borrowed; at most `most` columns of the Hessian are asked for at once. Error: MORAY_MEMORY.
moray_status moray_fp_gait_new(fp_gait *at, const fp_setting *of, int most);
void moray_fp_gait_free(fp_gait *at);

// Motion of the links, then their accelerations, torques and power. What follows is at the input that was moved to.
void moray_fp_gait_move(fp_gait *at, const double *in);

// Gradient of weight . out, but for what is constant in it.
void moray_fp_gait_gradient(fp_gait *at, const double *weight, double *gradient);

// That of theta_i, less what it has by the heading.
void moray_fp_gait_angle_gradient(fp_gait *at, int i, double *gradient);

// The part of the Hessian of weight . out by n of the inputs: out[n x n].
void moray_fp_gait_hessian(fp_gait *at, const double *weight, int n, const int *input, double *out);

#endif
