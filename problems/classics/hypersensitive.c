// SPDX-License-Identifier: MIT
//
// Hypersensitive problem (Rao and Mease 2000): the start and the end matter, the long middle does not.
//
//   minimise integral of (x^2 + u^2) / 2
//   x' = -x^3 + u,  t in [0, 50],  x from 1.5 to 1
//
// PSOPT prints J = 1.330826 on 50 nodes. Closed form for long times: the Hamiltonian vanishes, so the costates are
// -x^3 - x sqrt(x^4 + 1) out and -x^3 + x sqrt(x^4 + 1) in, and J is their integral over x: 1.3308069049.
#include "classics.h"

static void drift(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    const moray_num x = at->x[0], u = at->u[0];
    out->f[0] = -x * x * x + u;
    out->g[0] = (x * x + u * u) / 2;
}

static moray_status build(moray_ocp **ocp, const void *data)
{
    const moray_phase_spec phase = {.name = "drift",
                                    .nx = 1,
                                    .nu = 1,
                                    .nq = 1,
                                    .continuous = drift,
                                    .tf = moray_fixed(50),
                                    .x0 = MORAY_BOUNDS(moray_fixed(1.5)),
                                    .xf = MORAY_BOUNDS(moray_fixed(1))};
    return classic_new(ocp, "hypersensitive", &phase, classic_first_integral, data);
}

const struct classic classic_hypersensitive = {.name = "hypersensitive",
                                               .title = "Hypersensitive, tf = 50",
                                               .source = "Rao and Mease 2000; PSOPT",
                                               .published = "1.330826",
                                               .computed = "1.330807",
                                               .closed_form = 1.3308069049,
                                               .build = build};
