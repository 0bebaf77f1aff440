// SPDX-License-Identifier: MIT
//
// Robertson's reaction (Robertson 1966; dymos): three substances and rates from 0.04 to 3e7, a boundary layer of
// microseconds in 40 s. Nothing is free: the programme is the stiff initial-value problem itself.
//
//   x' = -0.04 x + 1e4 y z,  y' = 0.04 x - 1e4 y z - 3e7 y^2,  z' = 3e7 y^2
//   t in [0, 40],  (x, y, z)(0) = (1, 0, 0)                                                        x(40) = 0.71583
#include "classics.h"

static void react(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    const moray_num x = at->x[0], y = at->x[1], z = at->x[2];
    const moray_num first = 0.04 * x - 1e4 * y * z, second = 3e7 * y * y;
    out->f[0] = -first;
    out->f[1] = first - second;
    out->f[2] = second;
}

static moray_status build(moray_ocp **ocp, const void *data)
{
    const moray_phase_spec phase = {.name = "reaction",
                                    .nx = 3,
                                    .continuous = react,
                                    .tf = moray_fixed(40),
                                    .x0 = MORAY_BOUNDS(moray_fixed(1), moray_fixed(0), moray_fixed(0))};
    return classic_new(ocp, "robertson", &phase, classic_first_state, data);
}

// dymos: straight.
const struct classic classic_robertson = {
    .name = "robertson",
    .title = "Robertson's reaction",
    .source = "Robertson 1966; dymos",
    .published = "0.71583",
    .maximised = true,
    .build = build,
    .straight = &(const moray_samples){2, (const double[]){0, 40}, (const double[]){1, 0, 0, 0.7, 0, 0.3}, NULL}};
