// SPDX-License-Identifier: MIT
//
// What maps of user functions share whose derivatives the library finds: patterns by trial, directions merged by
// colouring, Hessians as central differences of Jacobians.
#ifndef SRC_BASE_NUMERIC_MAP_H
#define SRC_BASE_NUMERIC_MAP_H

#include "moray/map.h"

struct numeric_map;

// What they differ in.
struct numeric_kind {
    void (*value)(void *self, const double *in, double *out); // as of moray_map
    // Derivative of every output along direction[n_in] at in; `rough`: good enough for a difference of two.
    void (*along)(struct numeric_map *map, const double *in, const double *direction, bool rough, double *slope);
    // jac[out][in] |= output depends on input; hess[r][c] |= some second derivative, r >= c.
    void (*mark)(struct numeric_map *map, const double *at, bool *jac, bool *hess);
    void (*release)(struct numeric_map *map); // of what the kind allocated
    double hessian_step;
};

// First member of the `self` of such a map.
struct numeric_map {
    const struct numeric_kind *kind;
    void *user;
    void (*release_user)(void *user);
    int n_in, n_out;
    moray_pattern jac, hess;     // the map's own, kept here to be freed
    int *jac_group, *hess_group; // direction that each column belongs to
    int jac_groups, hess_groups;
    double *size;                                          // [n_in]: steps are relative to size + |in|
    double *point, *direction, *slope, *values, *gradient; // scratch; gradient: 2 n_in, ahead and behind
};

// Sizes up the map on `self`, whose kind, user, release_user, n_in and n_out are set and whose kind can evaluate.
// size[n_in]: typical magnitudes, NULL for 1. Whatever it returns, the map's release frees self. Error: MORAY_MEMORY;
// MORAY_INPUT when the function is not finite at the probe.
moray_status moray_numeric_map_new(moray_map *map, struct numeric_map *self, const double *probe, const double *size);

// moray_map_from_complex and moray_map_from_real with typical magnitudes of the inputs.
moray_status moray_complex_map_new(moray_map *map, int n_in, int n_out, moray_complex_fn *function, void *user,
                                   void (*release_user)(void *user), const double *probe, const double *size);
moray_status moray_real_map_new(moray_map *map, int n_in, int n_out, moray_real_fn *function, void *user,
                                void (*release_user)(void *user), const double *probe, const double *size);

#endif
