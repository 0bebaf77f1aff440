// SPDX-License-Identifier: MIT
//
// Methanol to hydrocarbons (Maria 1989; Dolan, More and Munson, COPS 3.0, problem 13): five rates of reaction from 17
// samples of three substances.
//
//   minimise sum_k |y(t_k) - z_k|^2,  theta >= 0,  with d = (theta2 + theta5) y1 + y2
//   y1' = -(2 theta2 - theta1 y2 / d + theta3 + theta4) y1
//   y2' = theta1 y1 (theta2 y1 - y2) / d + theta3 y1
//   y3' = theta1 y1 (y2 + theta5 y1) / d + theta4 y1
//   t in [0, 1.122],  y(0) = (1, 0, 0)        J = 9.02229e-3   (COPS)
#include "classics.h"

enum { ny = 3, n = 17 };

static const double time[n] = {0,     0.050, 0.065, 0.080, 0.123, 0.233, 0.273, 0.354, 0.397,
                               0.418, 0.502, 0.553, 0.681, 0.750, 0.916, 0.937, 1.122};
static const double value[n * ny] = {
    1.0000, 0.0000, 0.0000, 0.7085, 0.1621, 0.0811, 0.5971, 0.1855, 0.0965, 0.5537, 0.1989, 0.1198, 0.3684,
    0.2845, 0.1535, 0.1712, 0.3491, 0.2097, 0.1198, 0.3098, 0.2628, 0.0747, 0.3576, 0.2467, 0.0529, 0.3347,
    0.2884, 0.0415, 0.3388, 0.2757, 0.0261, 0.3557, 0.3167, 0.0208, 0.3483, 0.2954, 0.0085, 0.3836, 0.2950,
    0.0053, 0.3611, 0.2937, 0.0019, 0.3609, 0.2831, 0.0018, 0.3485, 0.2846, 0.0006, 0.3698, 0.2899};

static void react(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    const moray_num *y = at->x, *theta = at->s;
    const moray_num d = (theta[1] + theta[4]) * y[0] + y[1];
    out->f[0] = -(2 * theta[1] - theta[0] * y[1] / d + theta[2] + theta[3]) * y[0];
    out->f[1] = theta[0] * y[0] * (theta[1] * y[0] - y[1]) / d + theta[2] * y[0];
    out->f[2] = theta[0] * y[0] * (y[1] + theta[4] * y[0]) / d + theta[3] * y[0];
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
    const moray_phase_spec phase = {.name = "reactor",
                                    .nx = ny,
                                    .continuous = react,
                                    .tf = moray_fixed(1.122),
                                    .x0 = MORAY_BOUNDS(moray_fixed(1), moray_fixed(0), moray_fixed(0)),
                                    .observed = observed};
    const moray_ocp_spec spec = {.name = "methanol",
                                 .phases = 1,
                                 .ns = 5,
                                 .phase = &phase,
                                 .endpoint = classic_no_objective,
                                 .s = MORAY_BOUNDS(moray_at_least(0), moray_at_least(0), moray_at_least(0),
                                                   moray_at_least(0), moray_at_least(0))};
    return moray_ocp_new(ocp, &spec);
}

// COPS: nothing is there, and rates of 1.
static const moray_samples start = {2, (const double[]){0, 1.122}, (const double[]){1e-3, 1e-3, 1e-3, 1e-3, 1e-3, 1e-3},
                                    NULL};

const struct classic classic_methanol = {.name = "methanol",
                                         .title = "Methanol to hydrocarbons",
                                         .source = "COPS 3.0; Maria 1989",
                                         .published = "9.02229e-3",
                                         .build = build,
                                         .straight = &start,
                                         .parameters = (const double[]){1, 1, 1, 1, 1}};
