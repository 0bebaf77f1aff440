// SPDX-License-Identifier: MIT
//
// The robot as the first-principles model takes it: moray_robot with its hydrodynamics worked into coefficients of
// every link about its centre of mass. With rel = v - V of that centre along (t) and across (n) the link and w =
// theta',
//     f_t = -c_t rel_t - q_t |rel_t| rel_t
//     f_n = -c_n rel_n - c_1 w - (square drag) - mu_n n.a - mu_1 theta'' + mu_n w (-V_t, or rel_t in the invariant
//     form) tau = -c_1 rel_n - lambda_2 w - lambda_3 |w| w - (its moment) - (inertia - J) theta'' - mu_1 n.a + mu_1 w
//     (likewise).
#ifndef SRC_SNAKE_MODEL_FP_ROBOT_H
#define SRC_SNAKE_MODEL_FP_ROBOT_H

#include "moray/snake/model.h"

typedef struct fp_part {
    bool plain;             // rear, front and weight are 1, mu_1, c_1, lever, q_fin 0
    double l, rear, front;  // half the link; from the joint behind to the centre of mass, from there to the next, in l
    double weight;          // mass over the mean of all
    double m, mu_n, mu_1;   // mass, added mass and its first moment
    double inertia, uneven; // of the link and the fluid that turns with it; that less the mean of all
    double c_t, c_n, c_1;   // linear drag and the first moment of that across, 0: none
    double lambda_2, lambda_3; // of what linear drag along the link gives, too
    double q_t, q_n;           // quadratic drag, 0: none
    double half, lever;        // half the length that q_n acts on, and the middle of that
    double q_fin, fin;         // quadratic drag of a fin, and its place
} fp_part;

typedef struct fp_robot {
    int links;
    bool alike;            // all links are the first part, which is plain
    const fp_part *part;   // borrowed
    bool strip, invariant; // square drag by the integral along the link; form of the added mass
    moray_motor motor;     // behind every joint
    int pieces;            // where it is not: whose centres it acts at
} fp_robot;

// How many parts a robot has: one where its links are equal.
int moray_fp_parts(const moray_robot *robot);

// Fills so many parts, which the result refers to.
fp_robot moray_fp_robot_of(const moray_robot *robot, fp_part *part);

// The part of links that are alike, in an object of its own: where the functions that it is handed to are inlined, the
// compiler knows what is plain about it and leaves the rest out.
static inline fp_part fp_part_alike(const fp_robot *robot)
{
    fp_part part = robot->part[0];
    part.plain = true;
    part.rear = part.front = part.weight = 1;
    return part;
}

static inline const fp_part *fp_part_of(const fp_robot *robot, int i, const fp_part *alike)
{
    return alike ? alike : &robot->part[i];
}

#define FP_INLINE static inline __attribute__((always_inline))

#endif
