// SPDX-License-Identifier: MIT
//
// Bioreactor over one day (BOCOP): algae that grow in the light feed bacteria that make methane; the most methane from
// one day of a periodic operation, half of it in the dark.
//
//   maximise integral of mu2 b / (beta + c)
//   y' = mu y / (1 + y) - (r + u) y,  s' = -mu2 b + u beta (gamma y - s),  b' = (mu2 - u beta) b,  0 <= u <= 1
//   mu = mubar max(0, sin(2 pi t / 10))^2 of the light,  mu2 = mu2m s / (s + Ks)
//   t in [0, 10],  (y, s, b)(10) = (y, s, b)(0),  y, s >= 0,  b >= 0.001,  y(0), b(0) >= 1
//   beta = gamma = mubar = 1, c = 2, Ks = 0.05, mu2m = 0.1, r = 0.005                                  J = 0.614134
#include <math.h>
#include <tgmath.h>

#include "classics.h"

static const double beta = 1, c = 2, gam = 1, Ks = 0.05, mu2m = 0.1, mubar = 1, r = 0.005, day = 10;

static void ferment(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    const moray_num y = at->x[0], s = at->x[1], b = at->x[2], u = at->u[0];
    const moray_num sun = moray_max(0, moray_sin(2 * M_PI * at->t / day));
    const moray_num mu = mubar * sun * sun, mu2 = mu2m * s / (s + Ks);
    out->f[0] = mu * y / (1 + y) - (r + u) * y;
    out->f[1] = -mu2 * b + u * beta * (gam * y - s);
    out->f[2] = (mu2 - u * beta) * b;
    out->g[0] = mu2 * b / (beta + c);
}

static void methane(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    const moray_phase_ends *end = &at->phase[0];
    out->objective = -end->q[0];
    for (int i = 0; i < 3; i++)
        out->e[i] = end->xf[i] - end->x0[i];
}

static moray_status build(moray_ocp **ocp, const void *data)
{
    (void)data;
    const moray_bounds some = moray_at_least(0), living = moray_at_least(0.001), well = moray_at_least(1);
    const moray_bounds same = moray_fixed(0);
    const moray_phase_spec phase = {.name = "day",
                                    .nx = 3,
                                    .nu = 1,
                                    .nq = 1,
                                    .continuous = ferment,
                                    .tf = moray_fixed(day),
                                    .x = MORAY_BOUNDS(some, some, living),
                                    .x0 = MORAY_BOUNDS(well, some, well),
                                    .u = MORAY_BOUNDS(moray_between(0, 1))};
    return moray_ocp_new(ocp, &(moray_ocp_spec){.name = "bioreactor",
                                                .phases = 1,
                                                .phase = &phase,
                                                .endpoint = methane,
                                                .ne = 3,
                                                .e = MORAY_BOUNDS(same, same, same)});
}

// BOCOP: 0.1 everywhere.
const struct classic classic_bioreactor = {
    .name = "bioreactor",
    .title = "Bioreactor, one day",
    .source = "BOCOP; CTDirect",
    .published = "0.614134",
    .maximised = true,
    .build = build,
    .straight = &(const moray_samples){2, (const double[]){0, 10}, (const double[]){0.1, 0.1, 0.1, 0.1, 0.1, 0.1},
                                       (const double[]){0.1, 0.1}}};
