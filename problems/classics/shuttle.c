// SPDX-License-Identifier: MIT
//
// Space shuttle re-entry (Betts 2001, ch. 5): the largest cross range, without a limit on heating.
//
//   maximise latitude theta(tf)
//   h' = v sin gamma,  phi' = v / r cos gamma sin psi / cos theta,  theta' = v / r cos gamma cos psi
//   v' = -D / m - g sin gamma
//   gamma' = L / (m v) cos beta + cos gamma (v / r - g / v)
//   psi' = L sin beta / (m v cos gamma) + v / (r cos theta) cos gamma sin psi sin theta
//   r = Re + h, g = mu / r^2, rho = rho0 exp(-h / hr), L, D = (cL, cD) S rho v^2 / 2
//   cL = a0 + a1 alpha, cD = b0 + b1 alpha + b2 alpha^2 (alpha in degrees), -90 <= alpha <= 90, -90 <= beta <= 1 deg
//   (260000 ft, 0, 0, 25600 ft/s, -1 deg, 90 deg) to h = 80000 ft, v = 2500 ft/s, gamma = -5 deg
//                                                                                       theta(tf) = 34.1412 deg
#include <math.h>
#include <tgmath.h>

#include "degree.h"
#include "classics.h"

static const double Re = 20902900, mu = 0.14076539e17, rho0 = 0.002378, hr = 23800, S = 2690, m = 203000 / 32.174;
static const double a0 = -0.20704, a1 = 0.029244, b0 = 0.07854, b1 = -0.61592e-2, b2 = 0.621408e-3;

static void reenter(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    const moray_num theta = at->x[2], v = at->x[3], gamma = at->x[4], psi = at->x[5], beta = at->u[1];
    const moray_num r = Re + at->x[0], g = mu / (r * r), alpha = at->u[0] / DEG;
    const moray_num pressure = rho0 * moray_exp(-at->x[0] / hr) * v * v / 2;
    const moray_num L = (a0 + a1 * alpha) * S * pressure, D = (b0 + b1 * alpha + b2 * alpha * alpha) * S * pressure;
    out->f[0] = v * moray_sin(gamma);
    out->f[1] = v / r * moray_cos(gamma) * moray_sin(psi) / moray_cos(theta);
    out->f[2] = v / r * moray_cos(gamma) * moray_cos(psi);
    out->f[3] = -D / m - g * moray_sin(gamma);
    out->f[4] = L / (m * v) * moray_cos(beta) + moray_cos(gamma) * (v / r - g / v);
    out->f[5] = L * moray_sin(beta) / (m * v * moray_cos(gamma)) +
                v / (r * moray_cos(theta)) * moray_cos(gamma) * moray_sin(psi) * moray_sin(theta);
}

static void cross_range(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = -at->phase[0].xf[2] / DEG;
}

static moray_status build(moray_ocp **ocp, const void *data)
{
    const moray_bounds upright = moray_between(-89 * DEG, 89 * DEG);
    const moray_phase_spec phase = {
        .name = "entry",
        .nx = 6,
        .nu = 2,
        .continuous = reenter,
        .tf = moray_between(100, 4000),
        .x = MORAY_BOUNDS(moray_between(0, 300000), moray_free(), upright, moray_between(1, 40000), upright,
                          moray_between(-M_PI, M_PI)),
        .x0 = MORAY_BOUNDS(moray_fixed(260000), moray_fixed(0), moray_fixed(0), moray_fixed(25600),
                           moray_fixed(-1 * DEG), moray_fixed(90 * DEG)),
        .xf = MORAY_BOUNDS(moray_fixed(80000), moray_free(), moray_free(), moray_fixed(2500), moray_fixed(-5 * DEG),
                           moray_free()),
        .u = MORAY_BOUNDS(moray_between(-90 * DEG, 90 * DEG), moray_between(-90 * DEG, 1 * DEG))};
    return classic_new(ocp, "shuttle", &phase, cross_range, data);
}

// Straight where both ends are given, else as at the beginning; no lift control; 2000 s.
static const moray_samples start = {
    2, (const double[]){0, 2000},
    (const double[]){260000, 0, 0, 25600, -1 * DEG, 90 * DEG, 80000, 0, 0, 2500, -5 * DEG, 90 * DEG},
    (const double[]){0, 0, 0, 0}};

const struct classic classic_shuttle = {.name = "shuttle",
                                        .title = "Space shuttle re-entry",
                                        .source = "Betts 2001",
                                        .published = "34.1412",
                                        .maximised = true,
                                        .build = build,
                                        .straight = &start,
                                        .intervals = 40};
