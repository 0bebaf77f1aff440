// SPDX-License-Identifier: MIT
//
// Hang glider (Bulirsch, Nerz, Pesch and von Stryk 1993; Dolan, More and Munson, COPS 3.0): the longest flight through
// a thermal updraft.
//
//   maximise x(tf)
//   x' = vx,  y' = vy,  m vx' = -L sin eta - D cos eta,  m vy' = L cos eta - D sin eta - m g,  0 <= cL <= 1.4
//   updraft  U = 2.5 (1 - r) exp(-r),  r = (x / 100 - 2.5)^2,  w = vy - U,  v^2 = vx^2 + w^2,  sin eta = w / v
//   D = (0.034 + 0.069662 cL^2) rho S v^2 / 2,  L = cL rho S v^2 / 2,  rho = 1.13, S = 14, m = 100, g = 9.81
//   (0, 1000, 13.23, -1.288) to (free, 900, 13.23, -1.288)
//
// COPS prints 1247.987 on 2000 intervals of the trapezoid. Refined: 1247.9876. PSOPT's 1250.190 is of a coarse mesh.
#include <tgmath.h>

#include "classics.h"

static const double m = 100, g = 9.81;

static void glide(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    const moray_num vx = at->x[2], vy = at->x[3], cL = at->u[0], offset = at->x[0] / 100 - 2.5, r = offset * offset;
    const moray_num w = vy - 2.5 * (1 - r) * moray_exp(-r), v = moray_sqrt(vx * vx + w * w);
    const moray_num pressure = 1.13 * 14 * v * v / 2, L = cL * pressure, D = (0.034 + 0.069662 * cL * cL) * pressure;
    out->f[0] = vx;
    out->f[1] = vy;
    out->f[2] = (-L * w - D * vx) / v / m;
    out->f[3] = (L * vx - D * w) / v / m - g;
}

static moray_status build(moray_ocp **ocp, const void *data)
{
    const moray_phase_spec phase = {
        .name = "flight",
        .nx = 4,
        .nu = 1,
        .continuous = glide,
        .tf = moray_at_least(0),
        .x = MORAY_BOUNDS(moray_at_least(0), moray_free(), moray_at_least(0), moray_free()),
        .x0 = MORAY_BOUNDS(moray_fixed(0), moray_fixed(1000), moray_fixed(13.23), moray_fixed(-1.288)),
        .xf = MORAY_BOUNDS(moray_free(), moray_fixed(900), moray_fixed(13.23), moray_fixed(-1.288)),
        .u = MORAY_BOUNDS(moray_between(0, 1.4))};
    return classic_new(ocp, "hang glider", &phase, classic_first_state, data);
}

// COPS: straight flight for one second.
static const moray_samples start = {2, (const double[]){0, 1},
                                    (const double[]){0, 1000, 13.23, -1.288, 13.23, 900, 13.23, -1.288},
                                    (const double[]){0.7, 0.7}};

#define GLIDER(id, n, ...)                                                                                             \
    const struct classic classic_##id = {.title = "Hang glider, " #n " intervals",                                     \
                                         .source = "COPS 3.0",                                                         \
                                         .maximised = true,                                                            \
                                         .build = build,                                                               \
                                         .straight = &start,                                                           \
                                         .scheme = "trapezoid",                                                        \
                                         .intervals = n,                                                               \
                                         .fixed_mesh = true,                                                           \
                                         __VA_ARGS__}
GLIDER(hang_glider_50, 50, .name = "hang-glider-50");
GLIDER(hang_glider_100, 100, .name = "hang-glider-100");
GLIDER(hang_glider_200, 200, .name = "hang-glider-200");
GLIDER(hang_glider_500, 500, .name = "hang-glider-500");
GLIDER(hang_glider_1000, 1000, .name = "hang-glider-1000");
GLIDER(hang_glider, 2000, .name = "hang-glider", .published = "1247.987");
