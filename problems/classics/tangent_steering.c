// SPDX-License-Identifier: MIT
//
// Linear tangent steering (Bryson and Ho 1975, sec. 2.4; Betts 2001; rocket steering of COPS).
//
//   minimise tf
//   x'' = a cos u,  y'' = a sin u,  a = 100,  |u| <= pi / 2
//   from rest at the origin to x' = 45, y = 5, y' = 0        tf = 0.55457088
//
// Closed form: tan u falls linearly from k to -k; tf = 45 k / (a asinh k) and y(tf) = 5 give k = 1.4085083557.
#include <math.h>
#include <tgmath.h>

#include "classics.h"

static const double a = 100;

static void steer(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = at->x[1];
    out->f[1] = a * moray_cos(at->u[0]);
    out->f[2] = at->x[3];
    out->f[3] = a * moray_sin(at->u[0]);
}

static moray_status build(moray_ocp **ocp, const void *data)
{
    const moray_phase_spec phase = {.name = "burn",
                                    .nx = 4,
                                    .nu = 1,
                                    .continuous = steer,
                                    .tf = moray_at_least(0),
                                    .x0 = MORAY_BOUNDS(moray_fixed(0), moray_fixed(0), moray_fixed(0), moray_fixed(0)),
                                    .xf = MORAY_BOUNDS(moray_free(), moray_fixed(45), moray_fixed(5), moray_fixed(0)),
                                    .u = MORAY_BOUNDS(moray_between(-M_PI_2, M_PI_2))};
    return classic_new(ocp, "tangent steering", &phase, classic_final_time, data);
}

// COPS: u = 0, tf = 1, states straight.
static const moray_samples start = {2, (const double[]){0, 1}, (const double[]){0, 0, 0, 0, 0, 45, 5, 0},
                                    (const double[]){0, 0}};

const struct classic classic_tangent_steering = {.name = "tangent-steering",
                                                 .title = "Linear tangent steering",
                                                 .source = "Bryson and Ho 1975, 2.4; Betts 2001",
                                                 .published = "0.55457088",
                                                 .closed_form = 0.5545708783,
                                                 .build = build,
                                                 .straight = &start};
