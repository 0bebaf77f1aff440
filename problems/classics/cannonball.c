// SPDX-License-Identifier: MIT
//
// Multi-phase cannonball (dymos): how large an iron ball, shot with at most 400 kJ, flies farthest. A large one starts
// slowly, a small one is stopped by the air, whose density is that of a table. Two phases, which meet at the apex.
//
//   maximise r(tf)
//   v' = -D / m - g sin c,  c' = -g cos c / v,  h' = v sin c,  r' = v cos c,  D = rho(h) v^2 / 2 CD A
//   m = 4/3 pi radius^3 7870 kg/m^3,  A = pi radius^2,  CD = 0.5,  0.01 <= radius <= 0.1 m,  m v(0)^2 / 2 <= 400 kJ
//   h(0) = r(0) = 0, c = 0 at the apex, h(tf) = 0
//   rho: U.S. Standard Atmosphere 1976, every 1000 ft                                             r(tf) = 3183.25 m
// dymos checks its value to 0.3 m, and interpolates straight; here a spline goes through the same numbers.
#include <math.h>
#include <tgmath.h>

#include "classics.h"
#include "degree.h"
#include "moray/table.h"

static const double ft = 0.3048, slug_ft3 = 515.378818, g = 9.80665, CD = 0.5, iron = 7870, energy = 4e5;

enum { heights = 12, nx = 4 };
static const double height_ft[heights] = {-1000, 0, 1000, 2000, 3000, 4000, 5000, 6000, 7000, 8000, 9000, 10000};
static const double density[heights] = {2.44752e-3, 2.37717e-3, 2.30839e-3, 2.24114e-3, 2.17539e-3, 2.11114e-3,
                                        2.04834e-3, 1.98698e-3, 1.92704e-3, 1.86850e-3, 1.81132e-3, 1.75549e-3};
static moray_spline *air; // made once, for the life of the program

static moray_status make_air(void)
{
    double h[heights], rho[heights];
    for (int i = 0; i < heights; i++)
        h[i] = height_ft[i] * ft, rho[i] = density[i] * slug_ft3;
    return air ? moray_ok() : moray_spline_new(&air, heights, h, rho, MORAY_NOT_A_KNOT, MORAY_LINEAR);
}

static moray_num mass(moray_num radius)
{
    return 4 * M_PI / 3 * radius * radius * radius * iron;
}

static void fly(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    const moray_num v = at->x[0], c = at->x[1], radius = at->s[0];
    const moray_num drag = moray_spline_at(air, at->x[2]) * v * v / 2 * CD * M_PI * radius * radius;
    out->f[0] = -drag / mass(radius) - g * moray_sin(c);
    out->f[1] = -g * moray_cos(c) / v;
    out->f[2] = v * moray_sin(c);
    out->f[3] = v * moray_cos(c);
}

static void shoot(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    const moray_phase_ends *up = &at->phase[0], *down = &at->phase[1];
    for (int i = 0; i < nx; i++)
        out->e[i] = down->x0[i] - up->xf[i];
    out->e[nx] = down->t0 - up->tf;
    out->e[nx + 1] = mass(at->s[0]) * up->x0[0] * up->x0[0] / 2;
    out->objective = -down->xf[3];
}

static moray_status build(moray_ocp **ocp, const void *data)
{
    (void)data;
    const moray_bounds zero = moray_fixed(0), any = moray_free(), far = moray_between(0, 1e4);
    const moray_bounds_list x = MORAY_BOUNDS(moray_between(1, 2000), moray_between(-M_PI / 2, M_PI / 2), far, far);
    const moray_phase_spec phase[] = {{.name = "ascent",
                                       .nx = nx,
                                       .continuous = fly,
                                       .x = x,
                                       .tf = moray_between(1, 100),
                                       .x0 = MORAY_BOUNDS(any, any, zero, zero),
                                       .xf = MORAY_BOUNDS(any, zero, any, any)},
                                      {.name = "descent",
                                       .nx = nx,
                                       .continuous = fly,
                                       .x = x,
                                       .t0 = moray_between(1, 100),
                                       .tf = moray_between(1.5, 200),
                                       .duration = moray_between(0.5, 100),
                                       .xf = MORAY_BOUNDS(any, any, zero, any)}};
    MORAY_TRY(make_air());
    return moray_ocp_new(ocp,
                         &(moray_ocp_spec){.name = "cannonball",
                                           .phases = 2,
                                           .phase = phase,
                                           .ns = 1,
                                           .s = MORAY_BOUNDS(moray_between(0.01, 0.1)),
                                           .ne = nx + 2,
                                           .e = MORAY_BOUNDS(zero, zero, zero, zero, zero, moray_between(0, energy)),
                                           .endpoint = shoot});
}

// dymos: 10 s each, straight between these.
static double start(int phase, double tau, double *x, double *u, const void *data)
{
    static const double at[][2][nx] = {{{200, 25 * DEG, 0, 0}, {150, 0, 100, 100}},
                                       {{150, 0, 100, 100}, {200, -45 * DEG, 0, 200}}};
    (void)u, (void)data;
    for (int i = 0; i < nx; i++)
        x[i] = at[phase][0][i] + tau * (at[phase][1][i] - at[phase][0][i]);
    return 10 * (phase + tau);
}

const struct classic classic_cannonball = {.name = "cannonball",
                                           .title = "Cannonball in tabulated air",
                                           .source = "dymos, multi-phase cannonball",
                                           .published = "3183",
                                           .maximised = true,
                                           .parameters = (const double[]){0.05},
                                           .build = build,
                                           .start = start};
