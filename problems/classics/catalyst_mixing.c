// SPDX-License-Identifier: MIT
//
// Catalyst mixing (von Stryk 1999; Dolan, More and Munson, COPS 3.0; Vassiliadis 1999): which part of a tube reactor
// to fill with which of two catalysts. The mixture is singular in the middle.
//
//   minimise x1(1) + x2(1) - 1
//   x1' = u (10 x2 - x1),  x2' = u (x1 - 10 x2) - (1 - u) x2,  0 <= u <= 1
//   t in [0, 1],  x(0) = (1, 0)        J = -0.04805   (PSOPT: -0.04805320; COPS, 800 intervals: -0.0480556)
#include "classics.h"

static void react(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    const moray_num x1 = at->x[0], x2 = at->x[1], u = at->u[0];
    out->f[0] = u * (10 * x2 - x1);
    out->f[1] = u * (x1 - 10 * x2) - (1 - u) * x2;
}

static void yield(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase[0].xf[0] + at->phase[0].xf[1] - 1;
}

static moray_status build(moray_ocp **ocp, const void *data)
{
    const moray_phase_spec phase = {.name = "tube",
                                    .nx = 2,
                                    .nu = 1,
                                    .continuous = react,
                                    .tf = moray_fixed(1),
                                    .x0 = MORAY_BOUNDS(moray_fixed(1), moray_fixed(0)),
                                    .u = MORAY_BOUNDS(moray_between(0, 1))};
    return classic_new(ocp, "catalyst mixing", &phase, yield, data);
}

// COPS: nothing reacts.
static const moray_samples start = {2, (const double[]){0, 1}, (const double[]){1, 0, 1, 0}, (const double[]){0, 0}};

const struct classic classic_catalyst_mixing = {.name = "catalyst-mixing",
                                                .title = "Catalyst mixing",
                                                .source = "COPS 3.0; Vassiliadis 1999; PSOPT",
                                                .published = "-0.04805",
                                                .build = build,
                                                .straight = &start,
                                                .scheme = "radau3"};
