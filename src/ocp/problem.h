// SPDX-License-Identifier: MIT
//
// The problem as the transcription sees it: every function a map, every bound in place.
#ifndef SRC_OCP_PROBLEM_H
#define SRC_OCP_PROBLEM_H

#include "moray/ocp.h"
#include "ocp/mesh.h"

// A map of a user function. Transcriptions of before its patterns were widened go on using the older one.
struct own_map {
    moray_map map;
    struct own_map *older;
};

struct wrapped_phase; // calls a user's continuous function as a map does

// What is observed of a phase, see moray_observations.
struct observed {
    int n, ny;
    double *time, *value, *weight; // weight[ny]
    const moray_map *map;          // in = [x, u, s, t], out = [y]
    struct own_map *own;
    moray_observe_fn *observe;
    const char **names; // NULL where the user named nothing
    moray_loss loss;
    double threshold;
    moray_bounds *residual, sum; // [ny], NULL: free
    bool has_sum, events_only;
};

struct phase {
    const char *name;
    int nx, nu, nc, nq, ns;
    const moray_map *map; // in = [x, u, s, t], out = [f, c, g]
    struct own_map *own;  // where it comes from a user function; the widest first
    struct wrapped_phase *wrapped;
    struct observed observed;
    moray_bounds t0, tf, duration;
    bool has_duration;
    struct method method; // of its own; stages 0: none
    int intervals;        // of the first mesh; 0: those of the settings
    double *mesh;         // [intervals + 1]; NULL: of equal length
    int *held;            // [n_held] controls that are constant over each of these intervals
    int n_held;
    moray_bounds *x, *x0, *xf, *u, *u0, *uf, *c, *q;
    bool end_controls, bounds_end_controls;     // whether the endpoint reads u0 and uf; whether one is narrower than u
    const char **x_names, **u_names, **c_names; // NULL where the user named nothing
};

struct endpoint {
    const moray_map *map; // in = [x0, t0, xf, tf, q, u0 and uf if read, of each phase in turn, s], out = [J, e]
    struct own_map *own;  // as of a phase
};

// Phases and endpoint stand apart: solves, to which the problem is constant, widen the patterns of their maps.
struct moray_ocp {
    const char *name;
    int phases, ns, ne;
    struct phase *phase;
    struct endpoint *endpoint;
    moray_endpoint_fn *endpoint_fn;
    moray_endpoint_real_fn *endpoint_real_fn;
    moray_phase_ends *ends; // scratch for endpoint_fn
    moray_real_phase_ends *real_ends;
    moray_bounds *s, *e;
    const char **s_names, **e_names;
    const void *data;
    void **owned; // every block that the copies took
    int n_owned, owned_room;
};

// Bounds from here on say nothing of how large a quantity is.
#define MORAY_ENDLESS 1e15

// A value within bounds: their middle, the one that is not endless, or 0.
double moray_bounds_middle(moray_bounds bounds);
bool moray_bounds_are_fixed(moray_bounds bounds);

// Turns the user functions of the spec into maps. Error: MORAY_MEMORY, MORAY_INPUT.
moray_status moray_wrap_functions(moray_ocp *ocp, const moray_ocp_spec *spec);
void moray_unwrap_functions(moray_ocp *ocp);
bool moray_phase_is_differenced(const struct phase *p); // of a function that knows only double

#endif
