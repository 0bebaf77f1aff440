// SPDX-License-Identifier: MIT
//
// Motion of the links about the mean motion, and the work of the fluid on them.
#ifndef PROBLEMS_PAPER_LINKS_H
#define PROBLEMS_PAPER_LINKS_H

#include "chain.h"

// Paths of the links about the mean motion over a period, along and across the direction of travel through the water
// [m]: along[i * CHAIN_POINTS + k] of link i at sample k, and its amplitudes, half of largest less least.
typedef struct link_paths {
    int N;
    double *along, *across;                     // N * CHAIN_POINTS
    double *along_amplitude, *across_amplitude; // N
    double *station;                            // mean place of each link along [m], N
} link_paths;

// Swims the gait of the settings on a model. Error: those of moray_swim_steady.
moray_status link_paths_of(paper *p, moray_model model, link_paths *paths);

enum { NORMAL, TANGENTIAL, DIRECTIONS };

// First-principles model over a period: by the components of the fluid force across and along each link.
typedef struct link_work {
    double *of_link[DIRECTIONS]; // work with the velocity through the water [J], N each
    double work[DIRECTIONS];     // their sums
    double force[DIRECTIONS];    // mean force along the heading [N]
    double torque_work;          // of the fluid torque (4) [J]
    double joint_work;           // [J]
    double residual;             // sum of all work less the gain of kinetic energy [J]
} link_work;

// Components of the force (2) on a link in the current, in the link's own directions.
void link_force(const moray_robot *robot, const double current[2], const chain_link *link, double force[DIRECTIONS]);

// Error: MORAY_MEMORY.
moray_status link_work_of(paper *p, const chain *c, link_work *w);

#endif
