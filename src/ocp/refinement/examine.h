// SPDX-License-Identifier: MIT
//
// How well the interpolated solution obeys the problem between the nodes: the certificate and the refinement ask alike.
#ifndef SRC_OCP_EXAMINE_H
#define SRC_OCP_EXAMINE_H

#include "ocp/certificate/witness.h"

// Violations between nodes may be this many times the mesh tolerance: they are seen at single points, not integrated.
enum { violation_slack = 100 };

// Points at which a phase is looked at between its nodes, at least, spread over the intervals by their widths.
enum { points_of_phase = 512 };
int moray_points_between(const struct interval *interval, int at_least);

// A phase under examination, with room for one evaluation.
struct examiner {
    const moray_solution *solution;
    int p;
    int n;                               // quantities that are integrated: the states, then the integrals q
    double *in, *out;                    // of the phase's map at the last point
    const struct phase_witness *witness; // sizes of u and c
    double *size;                        // [n]: of the state and max |x| over the phase, of the integral and |q|
    double *slope, *error;
};

// An error is relative to what a quantity moves by and what it is. The witness must last. Error: MORAY_MEMORY.
moray_status moray_examiner_new(struct examiner *e, const struct witness *witness, int p);
void moray_examiner_free(struct examiner *e);

// Where the rate of the i-th integrated quantity stands in the map's output.
int moray_examiner_output(const struct examiner *e, int i);

// Functions of the phase at time t of an interval with its interpolated control; state from the interpolant unless
// given.
void moray_examiner_place(struct examiner *e, const struct interval *interval, double t, const double *x); // in e->in
void moray_examiner_place_by_basis(struct examiner *e, const struct interval *interval, double t, const double *ell,
                                   const double *integral);
void moray_examiner_evaluate(struct examiner *e, const struct interval *interval, double t, const double *x);

// Integral over an interval of |x~' - f(x~, u~)| / (size + max |x|), or of the same of an integrand and its q, of the
// worst of them. Raises *outside (NULL: not asked) to the largest violation of bounds and path constraints seen,
// relative to size + |bound|.
double moray_examiner_interval(struct examiner *e, const struct interval *interval, double *outside);

// The larger of the two, violations by their slack: what the certificate will ask of an interval.
double moray_examiner_error(struct examiner *e, const struct interval *interval);

#endif
