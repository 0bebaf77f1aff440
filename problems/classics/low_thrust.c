// SPDX-License-Identifier: MIT
//
// Low-thrust orbit transfer (Betts 2001, ch. 5): from a low circular orbit to a high elliptic inclined one on the
// least propellant, in some eight revolutions about the oblate Earth.
//
//   maximise w(tf)
//   elements' = those of orbit.h under delta = g0 T (1 + tau / 100) u / w,  w' = -T (1 + tau / 100) / Isp,  |u| = 1
//   T = 4.446618e-3 lb, Isp = 450 s, g0 = 32.174 ft/s^2, -50 <= tau <= 0 a parameter
//   (p, f, g, h, k, L, w) from (21837080.052835 ft, 0, 0, -0.25396764647494, 0, pi, 1) to p = 40007346.015232,
//   |(f, g)| = 0.73550320568829, |(h, k)| = 0.61761258786099, f h + g k = 0, g h - k f <= 0
//
// With |u|^2 = 1, as stated, w = 0.2201791 (Betts). PSOPT prints 0.2203403 and 0.220338: its code asks for |u|^2
// between 0.999 and 1.001, and the thrust that this gives away is worth 1.6e-4 lb.
#include <math.h>
#include <tgmath.h>

#include "classics.h"
#include "orbit.h"

static const double T = 4.446618e-3, Isp = 450, g0 = 32.174;

static void spiral(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    const moray_num *u = at->u, w = at->x[6], thrust = T * (1 + at->s[0] / 100);
    orbit_rates(at->x, (const moray_num[]){g0 * thrust * u[0] / w, g0 * thrust * u[1] / w, g0 * thrust * u[2] / w},
                out->f);
    out->f[6] = -thrust / Isp;
    out->c[0] = u[0] * u[0] + u[1] * u[1] + u[2] * u[2];
}

static void weight(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    const moray_num *x = at->phase[0].xf, f = x[1], g = x[2], h = x[3], k = x[4];
    out->objective = -x[6];
    out->e[0] = moray_sqrt(f * f + g * g);
    out->e[1] = moray_sqrt(h * h + k * k);
    out->e[2] = f * h + g * k;
    out->e[3] = g * h - k * f;
}

static const double x0[] = {21837080.052835, 0, 0, -0.25396764647494, 0, M_PI, 1};

static moray_status build(moray_ocp **ocp, const void *data)
{
    const double *slack = data;
    const moray_bounds unit = moray_between(-1, 1);
    const moray_phase_spec phase = {
        .name = "spiral",
        .nx = 7,
        .nu = 3,
        .nc = 1,
        .continuous = spiral,
        .t0 = moray_fixed(0),
        .tf = moray_between(50000, 100000),
        .x = MORAY_BOUNDS(moray_between(2e7, 6e7), unit, unit, unit, unit, moray_between(M_PI, 20 * M_PI),
                          moray_between(0.1, 1)),
        .x0 = MORAY_BOUNDS(moray_fixed(x0[0]), moray_fixed(x0[1]), moray_fixed(x0[2]), moray_fixed(x0[3]),
                           moray_fixed(x0[4]), moray_fixed(x0[5]), moray_fixed(x0[6])),
        .xf = MORAY_BOUNDS(moray_fixed(40007346.015232), moray_free(), moray_free(), moray_free(), moray_free(),
                           moray_free(), moray_free()),
        .u = MORAY_BOUNDS(moray_between(-1.1, 1.1), moray_between(-1.1, 1.1), moray_between(-1.1, 1.1)),
        .c = MORAY_BOUNDS(moray_between(1 - *slack, 1 + *slack))};
    return moray_ocp_new(
        ocp, &(moray_ocp_spec){.name = "low thrust",
                               .phases = 1,
                               .phase = &phase,
                               .endpoint = weight,
                               .ns = 1,
                               .s = MORAY_BOUNDS(moray_between(-50, 0)),
                               .ne = 4,
                               .e = MORAY_BOUNDS(moray_fixed(0.73550320568829), moray_fixed(0.61761258786099),
                                                 moray_fixed(0), moray_between(-10, 0))});
}

// Simulated under transverse thrust for 90000 s, with tau in the middle of its bounds.
static double start(int phase, double tau, double *x, double *u, const void *data)
{
    (void)phase;
    (void)data;
    const double duration = 90000;
    for (int i = 0; i < 7 && tau == 0; i++)
        x[i] = x0[i];
    if (tau > 0)
        orbit_propagate(spiral, 7, x, (const moray_num[]){0, 1, 0}, (const moray_num[]){-25}, duration / CLASSIC_PARTS);
    u[0] = u[2] = 0;
    u[1] = 1;
    return duration * tau;
}

// |u|^2 = 1, or to within `slack`.
#define LOW_THRUST(slack, ...)                                                                                         \
    {                                                                                                                  \
        .source = "Betts 2001; PSOPT", .maximised = true, .data = &(const double){slack}, .build = build,              \
        .start = start, .intervals = 60, .tolerance = 1e-9, __VA_ARGS__                                                \
    }

const struct classic classic_low_thrust =
    LOW_THRUST(0, .name = "low-thrust", .title = "Low-thrust orbit transfer", .published = "0.2201791");

const struct classic classic_low_thrust_slack =
    LOW_THRUST(0.001, .name = "low-thrust-slack", .title = "Low-thrust orbit transfer, |u|^2 to 1e-3",
               .published = "0.2203403", .computed = "0.2203404");
