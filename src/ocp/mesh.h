// SPDX-License-Identifier: MIT
#ifndef SRC_OCP_MESH_H
#define SRC_OCP_MESH_H

#include "moray/scheme.h"

// What refinement did to an interval before.
enum mesh_past {
    mesh_untouched,
    mesh_merged, // of several
    mesh_settled // merged, then refined after all, or part of such a one
};

// A scheme by its family and its stages.
struct method {
    moray_family family;
    int stages;
};

// Intervals of one phase: edges[intervals + 1] from 0 to 1, stages[intervals]; raised_from[intervals] is the error with
// fewer stages where the last refinement added some, else 0.
struct mesh {
    struct method method; // family of all intervals; stages of new ones
    int intervals;
    double *edge, *raised_from;
    int *stages;
    enum mesh_past *past;
    double t0, tf; // where the phase is, for data that move over the mesh; 0, 0: not known
};

// Error: MORAY_MEMORY. Free with moray_mesh_free, which is safe on a zeroed mesh.
moray_status moray_mesh_new(struct mesh *mesh, int intervals);
moray_status moray_mesh_uniform(struct mesh *mesh, int intervals, struct method method);
moray_status moray_mesh_of(struct mesh *mesh, const double *edge, int intervals,
                           struct method method); // edge NULL: uniform
moray_status moray_mesh_copy(struct mesh *copy, const struct mesh *mesh);
void moray_mesh_free(struct mesh *mesh);
bool moray_mesh_equal(const struct mesh *one, const struct mesh *other); // in edges and schemes

#endif
