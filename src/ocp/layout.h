// SPDX-License-Identifier: MIT
//
// Where everything stands in the decision vector and among the constraints.
#ifndef SRC_OCP_LAYOUT_H
#define SRC_OCP_LAYOUT_H

#include "ocp/mesh.h"
#include "ocp/problem.h"

enum { absent = -1 }; // in the place of a node, column or row

// A point of the mesh. Neighbouring intervals share the point between them.
struct node {
    double tau;    // time in the phase, 0..1
    double weight; // quadrature weight in tau; 0 where not collocated
    bool collocated;
    int x;            // first column of the state; the control follows where collocated
    int path;         // first row of the path constraints, where collocated
    int before, hold; // the node whose held controls it has, or absent; first of the rows that say so
};

struct interval {
    const moray_scheme *scheme;
    int first;    // node
    double width; // in tau
    int defect;   // first row; defect i of state r is row defect + i nx + r
};

// Where a datum that moves is seen, see sight.h: in an interval, with columns and rows of its own.
struct sight {
    int interval, x, row;
};

struct phase_layout {
    struct mesh mesh;
    int nodes;
    struct node *node;
    struct interval *interval;
    int t0, tf;          // columns, absent where fixed
    int q;               // first column of the integrals
    int integral_row;    // first row of their definitions
    int u_end[2];        // first columns of the controls at the ends: of a node, or after q; absent where nothing asks
    int u_row[2];        // first rows of the definitions of those after q, after those of the integrals; else absent
    int hold_row;        // first row of all that hold controls
    int length_row;      // tf - t0 >= 0, or within its bounds; absent where those of the times say so already
    struct sight *sight; // [observations] of data that move; else NULL
};

struct layout {
    moray_scheme scheme[MORAY_GAUSS + 1][MORAY_MAX_STAGES + 1]; // by family and stages, made when first used
    int phases;
    struct phase_layout *phase;
    int s, events; // first column of the parameters, first row of the events
    int columns, rows;
};

// Takes over nothing: copies the meshes. Error: MORAY_MEMORY, MORAY_INPUT (stages).
moray_status moray_layout_new(struct layout *layout, const moray_ocp *ocp, const struct mesh *meshes);
void moray_layout_free(struct layout *layout);

// The interval at an end (0, 1) of a phase, and ell[points] of its nodes' controls in the control there.
const struct interval *moray_layout_end(const struct phase_layout *phase, int end, double *ell);

// Time of tau in phase p at the decision vector x.
double moray_layout_time(const struct layout *layout, const moray_ocp *ocp, const double *x, int p, double tau);
void moray_layout_span(const struct layout *layout, const moray_ocp *ocp, const double *x, int p, double *t0,
                       double *tf);

#endif
