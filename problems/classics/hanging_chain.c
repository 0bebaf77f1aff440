// SPDX-License-Identifier: MIT
//
// Hanging chain (Cesari 1983; Dolan, More and Munson, COPS 3.0): the shape of least potential energy.
//
//   minimise integral of x sqrt(1 + u^2)
//   x' = u,  integral of sqrt(1 + u^2) = 4,  t in [0, 1],  x from 1 to 3        J = 5.06848
//
// Closed form: the catenary x = c cosh((t - b) / c) + k with 2 c sinh(1 / 2c) = sqrt(4^2 - 2^2) and
// tanh((1/2 - b) / c) = 2 / 4, J = 5.0684801110. The scheme is part of COPS's 5.06891 (200 intervals).
#include <tgmath.h>

#include "classics.h"

static void hang(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    const moray_num x = at->x[0], u = at->u[0], ds = moray_sqrt(1 + u * u);
    out->f[0] = u;
    out->g[0] = x * ds;
    out->g[1] = ds;
}

static moray_status build(moray_ocp **ocp, const void *data)
{
    const moray_phase_spec phase = {.name = "chain",
                                    .nx = 1,
                                    .nu = 1,
                                    .nq = 2,
                                    .continuous = hang,
                                    .tf = moray_fixed(1),
                                    .x0 = MORAY_BOUNDS(moray_fixed(1)),
                                    .xf = MORAY_BOUNDS(moray_fixed(3)),
                                    .q = MORAY_BOUNDS(moray_free(), moray_fixed(4))};
    return classic_new(ocp, "hanging chain", &phase, classic_first_integral, data);
}

// COPS: a parabola through both ends with its lowest point at t = 1/4.
static double start(int phase, double tau, double *x, double *u, const void *data)
{
    (void)phase;
    (void)data;
    x[0] = 8 * tau * (tau / 2 - 0.25) + 1;
    u[0] = 8 * (tau - 0.25);
    return tau;
}

const struct classic classic_hanging_chain = {.name = "hanging-chain",
                                              .title = "Hanging chain",
                                              .source = "COPS 3.0; PSOPT",
                                              .published = "5.06848",
                                              .closed_form = 5.0684801110,
                                              .build = build,
                                              .start = start};
