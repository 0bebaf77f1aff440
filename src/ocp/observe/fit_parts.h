// SPDX-License-Identifier: MIT
//
// What the map of a fit is made of.
#ifndef SRC_OCP_FIT_PARTS_H
#define SRC_OCP_FIT_PARTS_H

#include "ocp/observe/fit_map.h"

// Of a phase: the places that one observation of it has in the patterns, in local inputs [x, u, s].
struct part {
    const moray_map *map;
    const struct phase *phase;
    int first;         // input of the fit where the first time begins
    int inputs, pairs; // local inputs that h depends on, and pairs of them, lower triangle
    int *input;        // [inputs]
    int *a, *b;        // [pairs]
    int *event;        // [n][ny] output of the fit with the residual, -1: none
    int sum;           // output with the sum of the losses, -1: none
    double *in, *out, *jac, *hess, *weight, *gradient, *bend; // scratch for one time
};

struct fit_map {
    moray_map map;
    const moray_map *base;
    const moray_ocp *ocp;
    struct part *part;     // [phases]
    int s;                 // input of the first parameter
    int *jac_at, *hess_at; // where values go, time by time: slopes of the objective, of the sum, of residuals; pairs
    bool gauss_newton;
};

static inline int moray_fit_width(const struct part *part)
{
    return part->phase->nx + part->phase->nu;
}

// The input of the fit of a local input.
static inline int moray_fit_place(const struct fit_map *fit, const struct part *part, int k, int local)
{
    return local < moray_fit_width(part) ? part->first + k * moray_fit_width(part) + local
                                         : fit->s + local - moray_fit_width(part);
}

// How often the losses of a phase are counted for weights of the outputs.
static inline double moray_fit_weight(const struct part *part, const double *weight)
{
    return (part->phase->observed.events_only ? 0 : weight[0]) + (part->sum >= 0 ? weight[part->sum] : 0);
}

// Which inputs an observation of phase p depends on, by its map; its inputs begin at `first`, its events at
// output `event`. Error: MORAY_MEMORY. All
// of it goes with moray_fit_map_free.
moray_status moray_fit_part_new(struct part *part, const moray_ocp *ocp, int p, int first, int event);

// Patterns of the fit's map, and where in them the values of every time go. Error: MORAY_MEMORY.
moray_status moray_fit_make_patterns(struct fit_map *fit);

#endif
