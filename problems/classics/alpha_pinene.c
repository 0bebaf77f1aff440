// SPDX-License-Identifier: MIT
//
// Isomerisation of alpha-pinene (Box, Hunter, MacGregor and Erjavec 1973; Dolan, More and Munson, COPS 3.0, problem
// 11): five rates of reaction from 8 samples of five substances.
//
//   minimise sum_k |y(t_k) - z_k|^2,  theta >= 0
//   y1' = -(theta1 + theta2) y1,  y2' = theta1 y1,  y3' = theta2 y1 - (theta3 + theta4) y3 + theta5 y5,
//   y4' = theta3 y3,  y5' = theta4 y3 - theta5 y5
//   t in [0, 36420] min,  y(0) = (100, 0, 0, 0, 0)        J = 19.87217   (COPS)
#include "classics.h"

enum { ny = 5, n = 8 };

static const double time[n] = {1230, 3060, 4920, 7800, 10680, 15030, 22620, 36420};
static const double value[n * ny] = {88.35, 7.3,  2.3,  0.4,  1.75, 76.4, 15.6, 4.5,  0.7,  2.8, 65.1, 23.1, 5.3,  1.1,
                                     5.8,   50.4, 32.9, 6.0,  1.5,  9.3,  37.5, 42.7, 6.0,  1.9, 12.0, 25.9, 49.1, 5.9,
                                     2.2,   17.0, 14.0, 57.4, 5.1,  2.6,  21.0, 4.5,  63.1, 3.8, 2.9,  25.7};

static void turn(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    const moray_num *y = at->x, *theta = at->s;
    out->f[0] = -(theta[0] + theta[1]) * y[0];
    out->f[1] = theta[0] * y[0];
    out->f[2] = theta[1] * y[0] - (theta[2] + theta[3]) * y[2] + theta[4] * y[4];
    out->f[3] = theta[2] * y[2];
    out->f[4] = theta[3] * y[2] - theta[4] * y[4];
}

static void see(const moray_node *at, moray_num *y, const void *data)
{
    (void)data;
    for (int i = 0; i < ny; i++)
        y[i] = at->x[i];
}

static const moray_observations observed = {.n = n, .ny = ny, .time = time, .value = value, .observe = see};

static moray_status build(moray_ocp **ocp, const void *data)
{
    (void)data;
    const moray_phase_spec phase = {
        .name = "flask",
        .nx = ny,
        .continuous = turn,
        .tf = moray_fixed(36420),
        .x0 = MORAY_BOUNDS(moray_fixed(100), moray_fixed(0), moray_fixed(0), moray_fixed(0), moray_fixed(0)),
        .observed = observed};
    const moray_ocp_spec spec = {.name = "alpha-pinene",
                                 .phases = 1,
                                 .ns = 5,
                                 .phase = &phase,
                                 .endpoint = classic_no_objective,
                                 .s = MORAY_BOUNDS(moray_at_least(0), moray_at_least(0), moray_at_least(0),
                                                   moray_at_least(0), moray_at_least(0))};
    return moray_ocp_new(ocp, &spec);
}

static double start(int phase, double tau, double *x, double *u, const void *data)
{
    (void)phase, (void)u, (void)data;
    return classic_start_on_data(&observed, 36420, tau, x);
}

const struct classic classic_alpha_pinene = {.name = "alpha-pinene",
                                             .title = "Isomerisation of alpha-pinene",
                                             .source = "COPS 3.0; Box et al. 1973",
                                             .published = "19.87217",
                                             .build = build,
                                             .start = start};
