// SPDX-License-Identifier: MIT
//
// Jackson's catalysts (Jackson 1968; BOCOP): which of two catalysts to fill a tube reactor with, part by part, for the
// most of the third substance. The mixture is singular in the middle, where the scheme that it begins with rings.
//
//   maximise c(4)
//   a' = -u (k1 a - k2 b),  b' = u (k1 a - k2 b) - (1 - u) k3 b,  c' = (1 - u) k3 b,  0 <= u <= 1
//   t in [0, 4],  (a, b, c)(0) = (1, 0, 0),  0 <= a, b, c <= 1.1,  k1 = k3 = 1, k2 = 10        J = 0.1918
#include "classics.h"

static const double k1 = 1, k2 = 10, k3 = 1;

static void react(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    const moray_num a = at->x[0], b = at->x[1], u = at->u[0];
    const moray_num first = u * (k1 * a - k2 * b), second = (1 - u) * k3 * b;
    out->f[0] = -first;
    out->f[1] = first - second;
    out->f[2] = second;
}

static void most(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = -at->phase[0].xf[2];
}

static moray_status build(moray_ocp **ocp, const void *data)
{
    const moray_bounds part = moray_between(0, 1.1);
    const moray_phase_spec phase = {.name = "tube",
                                    .nx = 3,
                                    .nu = 1,
                                    .continuous = react,
                                    .tf = moray_fixed(4),
                                    .x = MORAY_BOUNDS(part, part, part),
                                    .x0 = MORAY_BOUNDS(moray_fixed(1), moray_fixed(0), moray_fixed(0)),
                                    .u = MORAY_BOUNDS(moray_between(0, 1))};
    return classic_new(ocp, "jackson", &phase, most, data);
}

const struct classic classic_jackson = {.name = "jackson",
                                        .title = "Jackson's catalysts",
                                        .source = "Jackson 1968; BOCOP",
                                        .published = "0.1918",
                                        .maximised = true,
                                        .build = build,
                                        .scheme = "hermite-simpson"};
