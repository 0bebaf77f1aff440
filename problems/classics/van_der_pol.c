// SPDX-License-Identifier: MIT
//
// Van der Pol oscillator (BOCOP's example): damp it in a fixed time.
//
//   minimise integral of (x1^2 + x2^2 + u^2) / 2
//   x1' = x2,  x2' = (1 - x1^2) x2 - x1 + u
//   t in [0, 2],  x(0) = (1, 0), u and the end free
//
// CTDirect's reference for BOCOP's data is J = 1.047921, which is what 100 intervals of the trapezoid give. Refined:
// 1.0478069.
#include "classics.h"

static void oscillate(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    const moray_num x1 = at->x[0], x2 = at->x[1], u = at->u[0];
    out->f[0] = x2;
    out->f[1] = (1 - x1 * x1) * x2 - x1 + u;
    out->g[0] = (x1 * x1 + x2 * x2 + u * u) / 2;
}

static moray_status build(moray_ocp **ocp, const void *data)
{
    const moray_phase_spec phase = {.name = "oscillator",
                                    .nx = 2,
                                    .nu = 1,
                                    .nq = 1,
                                    .continuous = oscillate,
                                    .tf = moray_fixed(2),
                                    .x0 = MORAY_BOUNDS(moray_fixed(1), moray_fixed(0))};
    return classic_new(ocp, "van der pol", &phase, classic_first_integral, data);
}

const struct classic classic_van_der_pol = {.name = "van-der-pol",
                                            .title = "Van der Pol oscillator, tf = 2",
                                            .source = "BOCOP; CTDirect",
                                            .published = "1.047921",
                                            .build = build,
                                            .scheme = "trapezoid",
                                            .intervals = 100,
                                            .fixed_mesh = true};
