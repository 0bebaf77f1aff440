// SPDX-License-Identifier: MIT
//
// What the certificate knows by itself: derivatives of the user's functions at a solution by differences of whole
// columns, so that they trust neither the derivatives nor the patterns in use, and sizes of everything, so that no unit
// matters.
#ifndef SRC_OCP_WITNESS_H
#define SRC_OCP_WITNESS_H

#include "ocp/certificate/kept.h"
#include "ocp/solution.h"

struct phase_witness {
    moray_bounds *box; // [n_in] of x, u, s, t: where the functions may be asked
    double *size;      // [n_in] how far each moves in the phase
    double *out_size;  // [n_out] of f, c, g: how far each moves where an input moves by its size
    double *integral;  // [nq] size of q
    double *slope;     // [n_in][n_out] the largest derivatives along the phase
    struct kept kept;  // differences at every node; doubt: how far off rounding and bends may have led
};

struct witness {
    const moray_solution *solution;
    struct phase_witness *phase;
    moray_bounds *end_box;           // [n_in] of the endpoint
    double *end_size, *end_out_size; // [n_in], [n_out] of the endpoint
    struct kept end;                 // its differences, as of one node
    double duration;                 // of the longest phase
};

// Error: MORAY_MEMORY. Free with moray_witness_free, which is safe after an error.
moray_status moray_witness_new(struct witness *e, const moray_solution *solution);
void moray_witness_free(struct witness *e);

// The same sizes but for what derivatives in use and differences differ by, at the cost of an iteration: for the
// refinement, which asks mesh by mesh, and for curvature. No derivatives but the largest, of those in use.
moray_status moray_witness_of_sizes(struct witness *e, const moray_solution *solution);

// Entries that differences of this quality, or a kink, say nothing about keep the derivatives in use: whether they do
// not.
bool moray_witness_speaks(double doubt, double kink, double size, double out_size);

// Differences at a node of phase p, or at the endpoint (p < 0): its block is the one at hand.
const struct kept *moray_witness_at(const struct witness *e, int p, int node);

// size[columns] and size[rows] of the programme.
void moray_witness_columns(const struct witness *e, double *size);
void moray_witness_rows(const struct witness *e, double *size);

// How far the objective moves where what it depends on moves by its size; 1 where it does not.
double moray_witness_objective(const struct witness *e);

// Derivatives in use at a node of phase p, or at the endpoint (p < 0), as [n_in][n_out].
void moray_witness_in_use(const struct witness *e, int p, int node, double *jac);

#endif
