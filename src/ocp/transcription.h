// SPDX-License-Identifier: MIT
//
// The nonlinear programme of a problem on a mesh. Decision vector: for every phase the nodes in the order of time
// (state, then control where collocated), integrals, controls at ends without one that are asked for, free times, what
// moving data see; then the parameters. Constraints: for every phase path constraints, defects, definitions of the
// integrals and of those controls, holds of controls, length, what moving data see; then the events.
#ifndef SRC_OCP_TRANSCRIPTION_H
#define SRC_OCP_TRANSCRIPTION_H

#include "base/triplets.h"
#include "ocp/layout.h"
#include "ocp/observe/fit_map.h"

// What the functions of a phase gave at every node of the current point.
struct phase_cache {
    const moray_map *map; // with the patterns that the problem had when it was transcribed
    double t0, tf;
    double *in, *out; // [nodes][n_in], [nodes][n_out] of the phase's map
    double *jac;      // [nodes][nnz] of the map's Jacobian
    double *lambda;   // [nodes][nx] scratch: multipliers of f
    double *by_time;  // [nodes][2][nx] scratch of sights, see sight.h; NULL without
    int *column;      // [n_in - 1] scratch: columns of the node at hand
    bool *held;       // [n_in] scratch: inputs that keep their values while a solver works
    // Entries of the Jacobian by rows: entry[row_start[r]] to entry[row_start[r + 1]] are those of row r. slope[nnz] is
    // scratch of sizes, the largest of each among the nodes.
    int *row_start, *entry;
    double *slope;
};

struct transcription {
    const moray_ocp *ocp;
    struct layout layout;
    moray_nlp nlp;
    triplets jac, hess;
    double *bounds; // x_lower, x_upper, g_lower, g_upper
    double *scale;  // x_scale, g_scale
    double *x;      // the point that the caches belong to
    bool have_values, have_jacobians;
    struct phase_cache *phase;
    struct fit_map *fit;       // NULL where nothing is observed
    const moray_map *endpoint; // the problem's, or the fit's
    bool gauss_newton;         // the Hessian is that of the sum of squares alone
    double *no_lambda;         // [rows] scratch for it
    double *end_in, *end_out, *end_jac;
    int *end_column;           // column of each endpoint input, -1 for fixed times
    double *weight, *map_hess; // scratch for one call of a map's Hessian
    moray_status failure;      // the last function that was not finite, and where
    int failures;              // how often
};

// Error: MORAY_MEMORY, MORAY_INPUT.
moray_status moray_transcription_new(struct transcription **result, const moray_ocp *ocp, const struct mesh *meshes);
void moray_transcription_free(struct transcription *t);

void moray_transcription_callbacks(struct transcription *t); // sets those of t->nlp

// Brings the caches to x. False where a value is not finite (t->failure says which).
bool moray_transcription_values(struct transcription *t, const double *x);
bool moray_transcription_jacobians(struct transcription *t, const double *x);

// With the caches in place: g[rows], and walks over the constraint Jacobian and the Hessian of the Lagrangian.
void moray_assemble_constraints(const struct transcription *t, double *g);
void moray_walk_jacobian(const struct transcription *t, triplets *out);
void moray_walk_hessian(const struct transcription *t, double sigma, const double *lambda, triplets *out);

// lambda_f[nodes][nx]: derivative of the constraint part of the Lagrangian with respect to f at every node.
void moray_dynamics_multipliers(const struct transcription *t, int p, const double *lambda, double *lambda_f);

// d(factor out_row)/d(in_col) at a node: into the column of x, u or s, or through t = t0 + T tau into the free times.
void moray_put_input(const struct transcription *t, int p, const struct node *node, const int *column, int row, int in,
                     double value, triplets *out);

// Columns of the inputs x, u, s of a node (not t), in t->phase[p].column; -1 for a control where none is collocated.
const int *moray_node_columns(const struct transcription *t, int p, const struct node *node);

#endif
