// SPDX-License-Identifier: MIT
//
// The joint distance (29) and its approximations, and Propositions 1 and 2 on simulated motion.
#ifndef PROBLEMS_PAPER_MAPPING_H
#define PROBLEMS_PAPER_MAPPING_H

#include "paper.h"

enum { DISTANCE_29, DISTANCE_30, DISTANCE_31, DISTANCES };

// (29), (30), (31) of joint 1 where Omega t has come to `phase` [rad], in m.
void joint_distance(double l, double theta_max, double delta, double phase, double phi[DISTANCES]);

// Against (29) over a period [m]: largest difference of the curves, and difference of the amplitudes.
typedef struct distance_errors {
    double curve[DISTANCES], amplitude[DISTANCES], exact_amplitude;
} distance_errors;
distance_errors distance_errors_of(double l, double theta_max, double delta);

// Amplitudes over a period of steady swimming; half of largest less least.
typedef struct swum_amplitudes {
    int N;
    double theta_max, delta;
    double alpha, joint_angle;                  // (27); first-principles model, mean over the joints [rad]
    double link_least, link_mean, link_largest; // of theta_i - heading over the links [rad]
    double a, joint_coordinate;                 // (33); control-oriented model, mean over the joints [m]
    double joint_distance;                      // (28) of the first-principles motion, mean over the joints [m]
    double inner_angle, end_angle;              // (12) in the control-oriented model, mean over the links [rad]
} swum_amplitudes;

// Swims the gait on both models of the robot with N links in still water. Error: those of moray_swim_steady.
moray_status swum_amplitudes_of(paper *p, int N, double theta_max, double delta, swum_amplitudes *s);

// Propositions 1 and 2 for several theta_max, delta, N.
moray_status show_swum_amplitudes(paper *p);

#endif
