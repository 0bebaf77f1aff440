// SPDX-License-Identifier: MIT
//
// The control-oriented model forwards: from joint forces to accelerations, by the fluid forces (14) and the balances
// (15) with the matrices of Sec. III-A written out. Slow, and independent of the library's models.
#ifndef PROBLEMS_PAPER_FORWARD_H
#define PROBLEMS_PAPER_FORWARD_H

#include "paper.h"

typedef struct paper_forward {
    int N;
    double m, mu_n, c_t, c_n, c_p, mu_p, ch_n; // (13) with L = 2l, erratum E2
    double *Dbar;                              // N x (N-1)
    double *at_phi, *dbar_v, *dbar_acc;        // A^T phi, Dbar v_phi, Dbar phi'': N each
    double *matrix, *residual, *trial;         // (N+1)^2, N+1, N+1
} paper_forward;

// Its arrays are p's own.
moray_status paper_forward_new(paper *p, const moray_robot *robot, paper_forward *f);

// Joints, relative velocities of the body in the water, joint forces: N-1 joints.
typedef struct paper_situation {
    const double *phi, *v_phi, *u;
    double v_tr, v_nr;
} paper_situation;

// Accelerations z = (phi'', v_t', v_n'), N+1 of them. False where they are not determined.
bool paper_forward_accelerations(const paper_forward *f, const paper_situation *at, double *z);

#endif
