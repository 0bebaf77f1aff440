// SPDX-License-Identifier: MIT
//
// The errata of the paper, each shown by what it does.
#ifndef PROBLEMS_PAPER_ERRATA_H
#define PROBLEMS_PAPER_ERRATA_H

#include "swim.h"

// Reading of the equations of the control-oriented model, by simulation.
moray_status erratum_23h(paper *p);        // E1
moray_status erratum_half_link(paper *p);  // E2
moray_status erratum_force_sign(paper *p); // of c_p in (13)

// Reading of parameters.
moray_status erratum_offset_sign(paper *p); // E3
moray_status erratum_frequency(paper *p);   // E4, omega = 120 deg
moray_status erratum_lambda(paper *p);      // E4, lambda_1..3 of (19) and of (4)

// Sums over the links of the three parts of the tangential force (14a), with the accelerations of the swimmer's state.
typedef struct tangential_force {
    double added_mass, c_p, drag; // the terms in mu_p, in c_p, and in c_t and c_n^ [N]
} tangential_force;

// For a state x, joint accelerations ubar and dv_n = dx[2N+3], in the current.
tangential_force tangential_force_of(const moray_robot *robot, const double current[2], const double *x,
                                     const double *ubar, double dv_n);

#endif
