// SPDX-License-Identifier: MIT
//
// How well the interpolated solution obeys the problem between the nodes: the certificate and the refinement ask alike.
#ifndef OCP_EXAMINE_H
#define OCP_EXAMINE_H

#include "ocp/solution.h"

// A phase under examination, with room for one evaluation.
struct examiner {
    const moray_solution *solution;
    int p;
    double *in, *out; // of the phase's map at the last point
    double *x_size;   // [nx]: 1 + max |x| over the phase
    double *slope, *error;
};

// Error: MORAY_MEMORY.
moray_status examiner_new(struct examiner *e, const moray_solution *solution, int p);
void examiner_free(struct examiner *e);

// Functions of the phase at time t with the interpolated control; state from the interpolant unless given.
void examiner_evaluate(struct examiner *e, double t, const double *x);

// Integral over an interval of |x~' - f(x~, u~)| / (1 + max |x|), of the worst state. Raises *outside (NULL: not asked)
// to the largest violation of bounds and path constraints seen, relative to 1 + |bound|.
double examiner_interval(struct examiner *e, const struct interval *interval, double *outside);

#endif
