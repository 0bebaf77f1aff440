// SPDX-License-Identifier: MIT
//
// Bryson-Denham (Bryson and Ho 1975, sec. 3.11), also known as Breakwell's problem: turn a unit mass round within l.
//
//   minimise integral of w u^2
//   x' = v,  v' = u,  x <= l,  t in [0, 1],  (x, v) from (0, 1) to (0, -1)
//
//   Bryson-Denham:  w = 1/2, l = 1/9    J = 4          (PSOPT; GPOPS)
//   energy form:    w = 1,   l = 1/9    J = 8          (dymos, with 8 / (9 l))
//   Breakwell:      w = 1/2, l = 0.1    J = 4.444444   (PSOPT prints 4.444439)
//
// Closed form for l <= 1/6: J = w 8 / (9 l), with x = l and u = 0 from t = 3 l to 1 - 3 l.
#include "classics.h"

struct wall {
    double l, w;
};

static void push(const moray_node *at, moray_rates *out, const void *data)
{
    const struct wall *wall = data;
    out->f[0] = at->x[1];
    out->f[1] = at->u[0];
    out->g[0] = wall->w * at->u[0] * at->u[0];
}

static moray_status build(moray_ocp **ocp, const void *data)
{
    const struct wall *wall = data;
    const moray_phase_spec phase = {.name = "turn",
                                    .nx = 2,
                                    .nu = 1,
                                    .nq = 1,
                                    .continuous = push,
                                    .tf = moray_fixed(1),
                                    .x = MORAY_BOUNDS(moray_at_most(wall->l), moray_free()),
                                    .x0 = MORAY_BOUNDS(moray_fixed(0), moray_fixed(1)),
                                    .xf = MORAY_BOUNDS(moray_fixed(0), moray_fixed(-1))};
    return classic_new(ocp, "bryson-denham", &phase, classic_first_integral, data);
}

const struct classic classic_bryson_denham = {.name = "bryson-denham",
                                              .title = "Bryson-Denham, l = 1/9",
                                              .source = "Bryson and Ho 1975, 3.11",
                                              .published = "4",
                                              .closed_form = 4,
                                              .build = build,
                                              .data = &(const struct wall){1. / 9, 0.5},
                                              .scheme = "hermite-simpson",
                                              .intervals = 30};

const struct classic classic_bryson_denham_energy = {.name = "bryson-denham-energy",
                                                     .title = "Bryson-Denham, integral of u^2",
                                                     .source = "Bryson and Ho 1975, 3.11; dymos",
                                                     .published = "8",
                                                     .closed_form = 8,
                                                     .build = build,
                                                     .data = &(const struct wall){1. / 9, 1},
                                                     .scheme = "hermite-simpson",
                                                     .intervals = 30};

const struct classic classic_breakwell = {.name = "breakwell",
                                          .title = "Breakwell, l = 0.1",
                                          .source = "Bryson and Ho 1975, 3.11; PSOPT",
                                          .published = "4.444444",
                                          .closed_form = 4.4444444444,
                                          .build = build,
                                          .data = &(const struct wall){0.1, 0.5},
                                          .scheme = "hermite-simpson",
                                          .intervals = 30};
