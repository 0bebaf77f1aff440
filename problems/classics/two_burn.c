// SPDX-License-Identifier: MIT
//
// Two-burn orbit transfer (Betts 2001, ch. 5; PSOPT): from a low inclined orbit to the geostationary one by two
// burns of fixed thrust, in four phases: coast, burn, coast, burn, whose times are free.
//
//   maximise w(tf)
//   elements' = those of orbit.h under delta = g0 T / w (thrust direction),  w' = -T / Isp in the burns
//   T = 1.2 lb, Isp = 300 s, g0 = 32.174 ft/s^2
//   thrust direction, pitch theta and yaw phi from the velocity: cos theta cos phi along v, cos theta sin phi along v x
//   r, sin theta along v x (v x r) from (21837080.052835 ft, 0, 0, -0.25396764647494, 0, pi), w = 1, to p = 19323
//   nautical miles + Re, f = g = h = k = 0
#include <math.h>
#include <stddef.h>
#include <tgmath.h>

#include "classics.h"
#include "orbit.h"

static const double T = 1.2, Isp = 300, g0 = 32.174;

static void coast(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    orbit_rates(at->x, (const moray_num[]){0, 0, 0}, out->f);
}

static void burn(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    const moray_num acceleration = g0 * T / at->x[6], theta = at->u[0], phi = at->u[1];
    moray_num radial, transverse;
    orbit_velocity(at->x, &radial, &transverse);
    const moray_num v = moray_sqrt(radial * radial + transverse * transverse);
    const moray_num along = acceleration * moray_cos(theta) * moray_cos(phi) / v,
                    across = acceleration * moray_sin(theta) / v;
    orbit_rates(at->x,
                (const moray_num[]){along * radial - across * transverse, along * transverse + across * radial,
                                    -acceleration * moray_cos(theta) * moray_sin(phi)},
                out->f);
    out->f[6] = -T / Isp;
}

static void weight(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    moray_num *e = out->e;
    out->objective = -at->phase[3].xf[6];
    for (int p = 0; p < 3; p++) {
        for (int i = 0; i < 6; i++)
            *e++ = at->phase[p + 1].x0[i] - at->phase[p].xf[i];
        *e++ = at->phase[p + 1].t0 - at->phase[p].tf;
    }
    *e = at->phase[3].x0[6] - at->phase[1].xf[6];
}

static const double x0[] = {21837080.052835, 0, 0, -0.25396764647494, 0, M_PI, 1};
static const double begin[] = {0, 2690, 2840, 21650, 21700}; // of the phases, guessed [s]

#define COAST .nx = 6, .continuous = coast, .x = coasting
#define BURN .nx = 7, .nu = 2, .continuous = burn, .x = x, .u = u
static moray_status build(moray_ocp **ocp, const void *data)
{
    (void)data;
    const moray_bounds unit = moray_between(-1, 1), p = moray_between(1e7, 2e8), L = moray_between(M_PI, 30 * M_PI);
    const moray_bounds_list x = MORAY_BOUNDS(p, unit, unit, unit, unit, L, moray_between(0, 2)), coasting = {x.at, 6};
    const moray_bounds_list u = MORAY_BOUNDS(moray_between(-M_PI, M_PI), moray_between(-M_PI, M_PI));
    const moray_bounds any = moray_free(), zero = moray_fixed(0);
    const moray_phase_spec phase[] = {
        {.name = "first coast",
         COAST,
         .t0 = zero,
         .tf = moray_between(2000, 3000),
         .x0 = MORAY_BOUNDS(moray_fixed(x0[0]), zero, zero, moray_fixed(x0[3]), zero, moray_fixed(x0[5]))},
        {.name = "first burn",
         BURN,
         .t0 = moray_between(2000, 3000),
         .tf = moray_between(2100, 3100),
         .x0 = MORAY_BOUNDS(any, any, any, any, any, any, moray_fixed(x0[6]))},
        {.name = "second coast", COAST, .t0 = moray_between(2100, 3100), .tf = moray_between(21600, 21800)},
        {.name = "second burn",
         BURN,
         .t0 = moray_between(21600, 21800),
         .tf = moray_between(21650, 21900),
         .xf = MORAY_BOUNDS(moray_fixed(19323 * 6076.1154855643 + 20925662.73), zero, zero, zero, zero, any, any)}};
    moray_bounds e[22];
    for (int i = 0; i < 22; i++)
        e[i] = zero;
    return moray_ocp_new(
        ocp,
        &(moray_ocp_spec){.name = "two burn", .phases = 4, .phase = phase, .endpoint = weight, .ne = 22, .e = {e, 22}});
}

// PSOPT: simulated, with the burns at constant angles.
static double start(int phase, double tau, double *x, double *u, const void *data)
{
    (void)data;
    static const moray_num angles[4][2] = {
        {0}, {0.148637e-2 * M_PI / 180, -9.08446 * M_PI / 180}, {0}, {-0.136658e-2 * M_PI / 180, 49.7892 * M_PI / 180}};
    const double duration = begin[phase + 1] - begin[phase];
    const bool burns = phase % 2 == 1;
    for (int i = 0; i < 7 && phase == 0 && tau == 0; i++)
        x[i] = x0[i];
    if (tau > 0)
        orbit_propagate(burns ? burn : coast, burns ? 7 : 6, x, angles[phase], NULL, duration / CLASSIC_PARTS);
    for (int i = 0; i < 2 && burns; i++)
        u[i] = creal(angles[phase][i]);
    return begin[phase] + tau * duration;
}

const struct classic classic_two_burn = {.name = "two-burn",
                                         .title = "Two-burn orbit transfer",
                                         .source = "Betts 2001; PSOPT",
                                         .published = "0.2367249",
                                         .maximised = true,
                                         .build = build,
                                         .start = start};
