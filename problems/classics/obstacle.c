// SPDX-License-Identifier: MIT
//
// Obstacle avoidance (PROPT; PSOPT): sail at constant speed round two discs.
//
//   minimise integral of x'^2 + y'^2
//   x' = V cos theta,  y' = V sin theta,  V = 2.138
//   (x - 0.4)^2 + (y - 0.5)^2 >= 0.1,  (x - 0.8)^2 + (y - 1.5)^2 >= 0.1
//   t in [0, 1],  (0, 0) to (1.2, 1.6)        J = 4.571044
//
// The integrand is V^2 whatever the path, so J = V^2 = 4.571044 exactly: the value tests feasibility only.
#include <tgmath.h>

#include "classics.h"

static const double V = 2.138;

static moray_num square(moray_num x)
{
    return x * x;
}

static void sail(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    const moray_num x = at->x[0], y = at->x[1], theta = at->u[0];
    out->f[0] = V * moray_cos(theta);
    out->f[1] = V * moray_sin(theta);
    out->c[0] = square(x - 0.4) + square(y - 0.5);
    out->c[1] = square(x - 0.8) + square(y - 1.5);
    out->g[0] = square(out->f[0]) + square(out->f[1]);
}

static moray_status build(moray_ocp **ocp, const void *data)
{
    const moray_phase_spec phase = {.name = "leg",
                                    .nx = 2,
                                    .nu = 1,
                                    .nc = 2,
                                    .nq = 1,
                                    .continuous = sail,
                                    .tf = moray_fixed(1),
                                    .x = MORAY_BOUNDS(moray_between(0, 2), moray_between(0, 2)),
                                    .x0 = MORAY_BOUNDS(moray_fixed(0), moray_fixed(0)),
                                    .xf = MORAY_BOUNDS(moray_fixed(1.2), moray_fixed(1.6)),
                                    .u = MORAY_BOUNDS(moray_between(-10, 10)),
                                    .c = MORAY_BOUNDS(moray_at_least(0.1), moray_at_least(0.1))};
    return classic_new(ocp, "obstacle", &phase, classic_first_integral, data);
}

const struct classic classic_obstacle = {.name = "obstacle",
                                         .title = "Obstacle avoidance",
                                         .source = "PROPT; PSOPT",
                                         .published = "4.571044",
                                         .closed_form = 4.571044,
                                         .build = build};
