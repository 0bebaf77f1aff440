// SPDX-License-Identifier: MIT
//
// Moon lander (Meditch 1964; GPOPS; PSOPT): land softly on least thrust. Free fall, then full thrust.
//
//   minimise integral of T
//   h' = v,  v' = -1 + T / m,  m' = -T / 2.349,  0 <= T <= 1.227
//   (h, v, m) from (1, -0.783, 1) to h = v = 0
//
// GPOPS and PSOPT print 1.4204, on 70 nodes of a polynomial that smears the switch. Closed form: fall until
// t = 0.2392591, then full thrust for 1.1575490 by the rocket equation: J = 1.2270 x 1.1575490 = 1.4203125990.
#include "classics.h"

static void descend(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    const moray_num v = at->x[1], m = at->x[2], T = at->u[0];
    out->f[0] = v;
    out->f[1] = -1 + T / m;
    out->f[2] = -T / 2.349;
    out->g[0] = T;
}

static moray_status build(moray_ocp **ocp, const void *data)
{
    const moray_phase_spec phase = {
        .name = "descent",
        .nx = 3,
        .nu = 1,
        .nq = 1,
        .continuous = descend,
        .tf = moray_at_least(0),
        .x = MORAY_BOUNDS(moray_between(-20, 20), moray_between(-20, 20), moray_between(0.01, 1)),
        .x0 = MORAY_BOUNDS(moray_fixed(1), moray_fixed(-0.783), moray_fixed(1)),
        .xf = MORAY_BOUNDS(moray_fixed(0), moray_fixed(0), moray_free()),
        .u = MORAY_BOUNDS(moray_between(0, 1.227))};
    return classic_new(ocp, "moon lander", &phase, classic_first_integral, data);
}

// PSOPT: straight, half thrust, tf = 1.5.
static const moray_samples start = {2, (const double[]){0, 1.5}, (const double[]){1, -0.783, 1, 0, 0, 0.01},
                                    (const double[]){1.227 / 2, 1.227 / 2}};

const struct classic classic_moon_lander = {.name = "moon-lander",
                                            .title = "Moon lander",
                                            .source = "Meditch 1964; GPOPS; PSOPT",
                                            .published = "1.4204",
                                            .computed = "1.42031",
                                            .closed_form = 1.4203125990,
                                            .build = build,
                                            .straight = &start};
