// SPDX-License-Identifier: MIT
//
// The links of the first-principles model over a period of steady swimming, and the fluid forces on them.
#ifndef PROBLEMS_PAPER_CHAIN_H
#define PROBLEMS_PAPER_CHAIN_H

#include "paper.h"

enum { CHAIN_PERIOD = 360, CHAIN_POINTS = CHAIN_PERIOD + 1 }; // samples in a period; the last one begins the next

// A link in the frame of the chain: angle and centre, each with its first and second derivative in time.
typedef struct chain_link {
    double theta[3], x[3], y[3];
} chain_link;

// One period. The frame is turned by the mean heading, for the paper aligns the forward direction with x (Sec. II-C).
typedef struct chain {
    int N;
    double heading, current[2]; // of the frame [rad]; of the water in it [m/s]
    const moray_swim_track *orbit;
    chain_link *link; // of link i at sample k: link[k * N + i]
    double *force;    // N m p_x'' at each sample, from the model's own acceleration [N]
} chain;

// Swims the gait of the first-principles model to steady state in a current. Error: those of moray_swim_steady.
moray_status chain_swim(paper *p, const double current[2], const moray_gait *gait, chain *c);

// Half the way that the heading swings over the period [rad].
double chain_heading_swing(const chain *c);

// Mean over the period of values[CHAIN_POINTS].
double chain_mean(const double *values);

#endif
