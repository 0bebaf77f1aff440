// SPDX-License-Identifier: MIT
//
// The terms I-VIII of (6) over a period of steady swimming.
#ifndef PROBLEMS_PAPER_FORCES_H
#define PROBLEMS_PAPER_FORCES_H

#include "chain.h"

enum { TERMS = 8 };
extern const char *const term_names[TERMS];

typedef struct force_terms {
    double *over_time; // term j at sample k: over_time[j * CHAIN_POINTS + k], summed over the links [N]
    double *of_link;   // mean of term j on link i: of_link[j * N + i] [N]
    double *at_once;   // term j on link i at sample 0: at_once[j * N + i] [N]
    double mean[TERMS], peak[TERMS];
    double thrust;           // sum of the positive means [N]
    double share[TERMS];     // mean over thrust
    double cancelled[TERMS]; // of the magnitudes on the links, the part that the sum over the links loses; mean in time
    double residual;         // largest |sum of the terms - N m p_x''| [N]
} force_terms;

// The terms of (6) for one link in the current.
void force_terms_of_link(const moray_robot *robot, const double current[2], const chain_link *link, double term[TERMS]);

// Error: MORAY_MEMORY.
moray_status force_terms_of(paper *p, const chain *c, force_terms *f);

#endif
