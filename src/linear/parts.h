// SPDX-License-Identifier: MIT
//
// Pieces of the factorisation. Unknowns are numbered as given; positions are their places in the pivot order.
#ifndef SRC_LINEAR_PARTS_H
#define SRC_LINEAR_PARTS_H

#include <stddef.h>

#include "linear/ldl.h"

// Who meets whom in the matrix, without the diagonal, each entry from both ends.
struct graph {
    int n;
    int *start, *near;               // neighbours of i: near[start[i]] to near[start[i + 1] - 1]
    double *size, *diagonal, *scale; // absolute values of the entries; [n] each; what equilibrates them
    double *block;
};

// A front: a dense matrix over its columns, which are eliminated in it, and the rows that they reach above.
struct node {
    int parent;         // -1: a root
    int child, sibling; // first child, next child of the same parent; -1: none
    int first, columns; // positions first to first + columns - 1
    int rows;           // rows below the columns
    int structure;      // of them in plan->rows and plan->into
    int own;            // rows of those that are columns of the parent
    size_t update;      // place of what it leaves to its parent: rows x rows, lower triangle
};

// What the pattern determines.
struct plan {
    int n, puts, slots, nodes, pairs;
    int *order, *position;    // [n] unknown at a position, and the reverse
    int *parent, *count;      // [n] elimination tree by positions, entries in a column of L
    int *block;               // holds the arrays above
    struct node *node;        // children before parents
    int *rows, *into;         // positions in ascending order; their places in the parent's front
    int *source, *slot;       // [puts] entries as given in the order of columns; the slot each is added to
    int *start, *row, *place; // columns of slots, [n + 1]; position of the row; place in the front's panel
    int tallest, widest;      // rows, columns of a front, at most
    size_t update_room, panel_room;
    double flops;
};

// ---- Ordering ------------------------------------------------------------------------------------------------------

moray_status moray_ldl_graph_new(struct graph *graph, int n, const moray_pattern *pattern, const double *values);
void moray_ldl_graph_free(struct graph *graph);
// Brings the largest entry of each row near 1.
void moray_ldl_graph_equilibrate(struct graph *graph);
// mate[i] <- the unknown that makes a 2x2 pivot with i, or -1, by entries that are not less than strong times the
// largest of the row. Returns how many pairs.
int moray_ldl_graph_pair(const struct graph *graph, double strong, int *mate, int *work); // work[2 n + 2]
// order[n] <- a pivot order of little fill that keeps pairs together. Error: MORAY_MEMORY.
moray_status moray_ldl_graph_order(const struct graph *graph, const int *mate, int *order);

// ---- Symbolic ------------------------------------------------------------------------------------------------------

// Error: MORAY_MEMORY.
moray_status moray_ldl_plan_new(struct plan *plan, const struct graph *graph, const moray_pattern *pattern);
void moray_ldl_plan_free(struct plan *plan);
// Numbers positions by the elimination tree, children first, and counts the columns of L.
void moray_ldl_plan_tree(struct plan *plan, const struct graph *graph, int *work); // work[4 n]
// Moves what stands at position c to place[c].
void moray_ldl_plan_renumber(struct plan *plan, const int *place, int *work); // work[n]
// Makes the fronts, and numbers positions by them.
moray_status moray_ldl_plan_fronts(struct plan *plan, const int *mate, int *work); // work[7 n]
// Finds the rows of each front and their places in the parent.
moray_status moray_ldl_plan_structure(struct plan *plan, const struct graph *graph, int *work); // work[n + 1]
// place[position] <- row of the front, for the columns and rows of front s; other entries are left.
void moray_ldl_plan_places(const struct plan *plan, int s, int *place);
// Leads each entry given to its place.
moray_status moray_ldl_plan_entries(struct plan *plan, const moray_pattern *pattern, int *work); // work[n + 1]

// ---- Numeric -------------------------------------------------------------------------------------------------------

// A front as it is at hand: the columns planned, then those passed up to it, then the rows.
struct front {
    int columns, width, height; // planned; with those passed up; with the rows
    int pivots;                 // eliminated: they come first
    size_t panel, index;        // of its height x width entries by columns; of its width positions and pivots
};

struct moray_ldl {
    int n;
    moray_pattern pattern; // as given
    struct plan plan;
    bool planned, factored;
    struct front *front;               // [nodes]
    double *value, *scaled;            // [slots] as given, and in the scale of the factors
    double *scale, *peak;              // [n]
    double *update, *panel, *kept;     // contribution blocks; factors; [tallest x widest] columns before division
    double *pivot;                     // inverse of D, two numbers a pivot: diagonal, coupling to the next
    int *index;                        // position of each column of a panel, in the order of elimination
    double *local;                     // [tallest] part of a right-hand side
    double *permuted, *rhs, *solution; // [n]
    size_t panel_room, index_room, kept_room, local_room, panel_used, index_used;
    double threshold;
    double usual;        // work of the first factorisation in this order; 0: none yet
    double surplus;      // work of those after it above that
    double most_entries; // in the factors, delayed pivots included
    moray_ldl_inertia inertia;
    moray_ldl_statistics statistics;
};

// Sums up repeated values and equilibrates. False where a value is not finite.
bool moray_ldl_load(moray_ldl *ldl, const double *values);
// Lays out the front of a node behind those before and fills it from the matrix and the node's children. Error:
// MORAY_NOT_SOLVED when the factors fill up, MORAY_MEMORY.
moray_status moray_ldl_front_assemble(moray_ldl *ldl, int node);
// Eliminates what can be eliminated, and leaves the rest to the parent.
void moray_ldl_front_eliminate(moray_ldl *ldl, int node);

// C[i + j ldc] -= sum over k < depth of L[i + k ldl] W[j + k ldw], for j < columns and j <= i < rows.
void moray_ldl_kernel_update(int rows, int columns, int depth, const double *L, int ldl, const double *W, int ldw,
                             double *C, int ldc);
// x <- L^-1 x, and x[pivots] <- L^-T x with what stands below: unit lower triangle of the first `pivots` columns,
// height rows.
void moray_ldl_kernel_forward(int height, int pivots, const double *L, int ldl, double *x);
void moray_ldl_kernel_backward(int height, int pivots, const double *L, int ldl, double *x);

// The largest |x[i]|, i < n.
double moray_ldl_kernel_largest(int n, const double *x);

#endif
