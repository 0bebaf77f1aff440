// SPDX-License-Identifier: MIT
//
// Electric vehicle (Petit and Sciarretta 2011; OptimalControlProblems.jl): the current that drives a car over a hilly
// road in a given time, from rest to rest, with the least energy.
//
//   minimise integral of b1 u v + b2 u^2
//   x' = v,  v' = h1 u - h2 v^2 - h0 - (3 + 0.4 x - x^2 + 0.1 x^3)
//   t in [0, 1],  (x, v) from (0, 0) to (10, 0),  h0 = 0.1, h1 = 1, h2 = 1e-3, b1 = b2 = 1e3            J = 1.2286e6
#include "classics.h"

static const double b1 = 1e3, b2 = 1e3, h0 = 0.1, h1 = 1, h2 = 1e-3;

static void drive(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    const moray_num x = at->x[0], v = at->x[1], u = at->u[0];
    const moray_num road = 3 + 0.4 * x - x * x + 0.1 * x * x * x;
    out->f[0] = v;
    out->f[1] = h1 * u - h2 * v * v - h0 - road;
    out->g[0] = b1 * u * v + b2 * u * u;
}

static moray_status build(moray_ocp **ocp, const void *data)
{
    const moray_phase_spec phase = {.name = "road",
                                    .nx = 2,
                                    .nu = 1,
                                    .nq = 1,
                                    .continuous = drive,
                                    .tf = moray_fixed(1),
                                    .x0 = MORAY_BOUNDS(moray_fixed(0), moray_fixed(0)),
                                    .xf = MORAY_BOUNDS(moray_fixed(10), moray_fixed(0))};
    return classic_new(ocp, "electric vehicle", &phase, classic_first_integral, data);
}

// OptimalControlProblems.jl: 0.1 everywhere.
const struct classic classic_electric_vehicle = {
    .name = "electric-vehicle",
    .title = "Electric vehicle",
    .source = "Petit and Sciarretta 2011",
    .published = "1.2286e6",
    .build = build,
    .straight = &(const moray_samples){2, (const double[]){0, 1}, (const double[]){0.1, 0.1, 0.1, 0.1},
                                       (const double[]){0.1, 0.1}}};
