// SPDX-License-Identifier: MIT
//
// Rayleigh problem with a mixed constraint (Betts 2010; PSOPT).
//
//   minimise integral of u^2 + x1^2
//   x1' = x2,  x2' = -x1 + x2 (1.4 - 0.14 x2^2) + 4 u,  u + x1 / 6 <= 0
//   t in [0, 4.5],  x(0) = (-5, -5)
//
// Betts prints J = 44.8044433, and every family of schemes converges to 44.80444 here. PSOPT prints 44.77625 on 79
// intervals of Hermite-Simpson: its Simpson rule evaluates the integrand at the mean of the end states instead of the
// state in the middle (integrate.cxx), which takes 0.028 off this integral.
#include "classics.h"

static void circuit(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    const moray_num x1 = at->x[0], x2 = at->x[1], u = at->u[0];
    out->f[0] = x2;
    out->f[1] = -x1 + x2 * (1.4 - 0.14 * x2 * x2) + 4 * u;
    out->c[0] = u + x1 / 6;
    out->g[0] = u * u + x1 * x1;
}

static moray_status build(moray_ocp **ocp, const void *data)
{
    const moray_phase_spec phase = {.name = "circuit",
                                    .nx = 2,
                                    .nu = 1,
                                    .nc = 1,
                                    .nq = 1,
                                    .continuous = circuit,
                                    .tf = moray_fixed(4.5),
                                    .x0 = MORAY_BOUNDS(moray_fixed(-5), moray_fixed(-5)),
                                    .c = MORAY_BOUNDS(moray_at_most(0))};
    return classic_new(ocp, "rayleigh", &phase, classic_first_integral, data);
}

// PSOPT: the states stay where they begin.
static const moray_samples start = {2, (const double[]){0, 4.5}, (const double[]){-5, -5, -5, -5},
                                    (const double[]){0, 0}};

const struct classic classic_rayleigh = {.name = "rayleigh",
                                         .title = "Rayleigh, mixed constraint",
                                         .source = "Betts 2010; PSOPT",
                                         .published = "44.77625",
                                         .computed = "44.8044",
                                         .build = build,
                                         .straight = &start};
