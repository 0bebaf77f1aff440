// SPDX-License-Identifier: MIT
//
// Catalytic cracking of gas oil (Tjoa and Biegler 1991; Dolan, More and Munson, COPS 3.0, problem 12): three rates of
// reaction from 21 samples of gas oil and gasoline.
//
//   minimise sum_k |y(t_k) - z_k|^2,  y1' = -(theta1 + theta3) y1^2,  y2' = theta1 y1^2 - theta2 y2,  theta >= 0
//   t in [0, 0.95],  y(0) = (1, 0)        J = 5.23660e-3   (COPS)
#include "classics.h"

enum { ny = 2, n = 21 };

static const double time[n] = {0,   0.025, 0.05, 0.075, 0.1, 0.125, 0.15, 0.175, 0.2,  0.225, 0.25,
                               0.3, 0.35,  0.4,  0.45,  0.5, 0.55,  0.65, 0.75,  0.85, 0.95};
static const double value[n * ny] = {
    1.0000, 0,      0.8105, 0.2000, 0.6208, 0.2886, 0.5258, 0.3010, 0.4345, 0.3215, 0.3903, 0.3123, 0.3342, 0.2716,
    0.3034, 0.2551, 0.2735, 0.2258, 0.2405, 0.1959, 0.2283, 0.1789, 0.2071, 0.1457, 0.1669, 0.1198, 0.1530, 0.0909,
    0.1339, 0.0719, 0.1265, 0.0561, 0.1200, 0.0460, 0.0990, 0.0280, 0.0870, 0.0190, 0.0770, 0.0140, 0.0690, 0.0100};

static void crack(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    const moray_num *y = at->x, *theta = at->s;
    out->f[0] = -(theta[0] + theta[2]) * y[0] * y[0];
    out->f[1] = theta[0] * y[0] * y[0] - theta[1] * y[1];
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
    const moray_phase_spec phase = {.name = "cracker",
                                    .nx = ny,
                                    .continuous = crack,
                                    .tf = moray_fixed(0.95),
                                    .x0 = MORAY_BOUNDS(moray_fixed(1), moray_fixed(0)),
                                    .observed = observed};
    const moray_ocp_spec spec = {.name = "gas oil",
                                 .phases = 1,
                                 .ns = 3,
                                 .phase = &phase,
                                 .endpoint = classic_no_objective,
                                 .s = MORAY_BOUNDS(moray_at_least(0), moray_at_least(0), moray_at_least(0))};
    return moray_ocp_new(ocp, &spec);
}

static double start(int phase, double tau, double *x, double *u, const void *data)
{
    (void)phase, (void)u, (void)data;
    return classic_start_on_data(&observed, 0.95, tau, x);
}

const struct classic classic_gas_oil = {.name = "gas-oil",
                                        .title = "Catalytic cracking of gas oil",
                                        .source = "COPS 3.0; Tjoa, Biegler 1991",
                                        .published = "5.23660e-3",
                                        .build = build,
                                        .start = start};
