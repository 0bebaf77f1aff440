// SPDX-License-Identifier: MIT
//
// What maps of user functions share whose derivatives the library finds. Derivatives are taken along groups of inputs
// of which no output feels two. A second derivative of output k along the groups G and H is one number
// d2 f_k / d in_r d in_c, because k feels one input r of G and one input c of H: a Hessian takes one second derivative
// for every pair of groups that meet, of inputs that enter some output nonlinearly.
#ifndef SRC_BASE_NUMERIC_MAP_H
#define SRC_BASE_NUMERIC_MAP_H

#include "moray/map.h"

struct numeric_map;

// Groups of inputs, no two of a group in one row of a table [n_out][n_in].
struct numeric_groups {
    int count;
    int *group;  // [n_in], -1 where in none
    int *member; // [n_out][count]: the input of that group in that row, -1 where none is
};

// Errors that are no news: of `along` and `bend` relative to the moduli of what they are made of, and to the value or
// slope out of whose rounding they come.
struct numeric_doubt {
    double slope, slope_of_value, bend, bend_of_slope, bend_of_value;
};

// What they differ in.
struct numeric_kind {
    void (*value)(void *self, const double *in, double *out); // as of moray_map
    // First, second derivative of every output along direction[n_in].
    void (*along)(struct numeric_map *map, const double *in, const double *direction, double *slope);
    void (*bend)(struct numeric_map *map, const double *in, const double *direction, double *curvature);
    // Second derivatives along pairs of groups of map->nonlinear, all at one point: `around` first, NULL where none is
    // needed.
    void (*around)(struct numeric_map *map, const double *in);
    void (*bend_pair)(struct numeric_map *map, const double *in, int g, int h, double *curvature);
    // What the outputs feel at a point, exactly, so that rounding is never taken for dependence nor a small dependence
    // for rounding. Of slopes told by moray_mark_slope; of curvatures in map->bent[n_out]: the slope along
    // map->direction, in map->sum, changes along map->other.
    void (*mark_slopes)(struct numeric_map *map, const double *at);
    void (*find_bent)(struct numeric_map *map, const double *at);
    // Another map of the same function, with scratch of its own. NULL: no memory.
    struct numeric_map *(*twin)(const struct numeric_map *map);
    void (*release)(struct numeric_map *map); // of what the kind allocated
    struct numeric_doubt doubt;
};

// First member of the `self` of such a map.
struct numeric_map {
    const struct numeric_kind *kind;
    void *user;
    void (*release_user)(void *user);
    int n_in, n_out;
    bool *feels;                             // [n_out][n_in]: the output depends on the input
    bool *bends;                             // [n_out][n_in]: nonlinearly
    bool *curved;                            // [n_in][n_in], lower: some output has that second derivative
    bool *bent;                              // [n_out] scratch
    int marks;                               // of feels, bends and curved that are set
    struct numeric_groups linear, nonlinear; // of feels, of bends
    moray_pattern jac, hess;                 // the map's own, kept here to be freed; jac in the order of groups
    int *slot;                               // [n_in][n_in]: entry of hess, -1
    bool *meets;                             // [nonlinear.count squared], g >= h: pairs with some entry
    double *size;                            // [n_in]: steps are relative to size + |in|
    double *point, *direction, *other;       // [n_in] scratch
    double *slope, *out, *sum, *behind;      // [n_out] scratch
    double *dense;                           // [3 n_out] scratch
    double *values;                          // [jac.nnz] scratch
};

// Where patterns are looked for: points[n][n_in], the first of which must be in the domain of the function; typical
// magnitudes size[n_in] of the inputs, NULL for 1.
struct numeric_probe {
    const double *points, *size;
    int n;
};

// Sizes up the map on `self`, new from its kind (NULL: there was no memory). Takes over user, which `release_user`
// frees with the map or on error. Error: MORAY_MEMORY; MORAY_INPUT when the function is not finite at the first point.
moray_status moray_numeric_map_new(moray_map *map, struct numeric_map *self, int n_in, void *user,
                                   void (*release_user)(void *user), const struct numeric_probe *probe);
// The same with points at and around `at`, for functions of which no more is known.
moray_status moray_numeric_map_around(moray_map *map, struct numeric_map *self, int n_in, void *user,
                                      void (*release_user)(void *user), const double *at);

// moray_map_from_complex and moray_map_from_real that look where they are told.
moray_status moray_complex_map_new(moray_map *map, int n_in, int n_out, moray_complex_fn *function, void *user,
                                   void (*release_user)(void *user), const struct numeric_probe *probe);
moray_status moray_real_map_new(moray_map *map, int n_in, int n_out, moray_real_fn *function, void *user,
                                void (*release_user)(void *user), const struct numeric_probe *probe);

bool moray_map_is_numeric(const moray_map *map);

// Whether the patterns of such a map explain the first and second derivative along one dense direction at `in`, output
// by output: a dependence that they lack is seen unless it is small beside the error of the derivatives. Costs as much
// as a Jacobian and a Hessian.
bool moray_map_pattern_holds(const moray_map *map, const double *in);

// Looks at points[n][n_in] with a twin of such a map, whose patterns hold those of `map` and what is found there;
// *found: how many dependences are new. The twin uses the data of `map`, which must outlive it. Error: MORAY_MEMORY.
moray_status moray_map_widened(moray_map *wider, const moray_map *map, const double *points, int n, int *found);

// ---- For the kinds ----

// direction[j] = size + |in| for the inputs of a group, else 0.
void moray_set_direction(const struct numeric_map *map, const double *in, const struct numeric_groups *groups,
                         int which, double *direction);
void moray_mark_slope(struct numeric_map *map, int output, int input);

// ---- Patterns (numeric_pattern.c) ----

// Patterns, groups and pairs from the marks. Error: MORAY_MEMORY.
moray_status moray_numeric_arrange(struct numeric_map *map);
void moray_numeric_release_arrangement(struct numeric_map *map);

// Raises the marks by what is felt at the point, and arranges the map anew where they grew. Error: MORAY_MEMORY.
moray_status moray_numeric_mark(struct numeric_map *map, const double *at);

#endif
