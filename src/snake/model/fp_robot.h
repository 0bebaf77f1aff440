// SPDX-License-Identifier: MIT
//
// The robot as the first-principles model takes it: moray_robot with its hydrodynamics worked into coefficients. A link
// feels, with rel = v - V of its centre along (t) and across (n) it,
//     f_t = -c_t rel_t - q_t |rel_t| rel_t
//     f_n = -c_n rel_n - q_n (square drag) - mu_n n.a + mu_n theta' (-V_t, or rel_t in the invariant form)
//     tau = -(inertia - J) theta'' - lambda_2 theta' - lambda_3 |theta'| theta' - q_n (moment of the square drag).
#ifndef SRC_SNAKE_MODEL_FP_ROBOT_H
#define SRC_SNAKE_MODEL_FP_ROBOT_H

#include "moray/snake/model.h"

typedef struct fp_robot {
    int links;
    double l, m, mu_n;
    double inertia;            // of a link and the fluid that turns with it
    double lambda_2, lambda_3; // of what linear drag along the link gives, too
    double c_t, c_n;           // linear drag, 0: none
    double q_t, q_n;           // quadratic drag, 0: none
    bool strip, invariant;     // square drag by the integral along the link; form of the added mass
    int pieces;                // where it is not: whose centres it acts at
} fp_robot;

fp_robot moray_fp_robot_of(const moray_robot *robot);

#endif
