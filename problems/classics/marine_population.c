// SPDX-License-Identifier: MIT
//
// A marine population in eight stages of life (Rothschild, Sharov, Kearsley and Bondarenko 1997; Dolan, More and
// Munson, COPS 3.0, problem 6): rates of growth g and mortality m from 21 counts of each stage.
//
//   minimise sum_k |y(t_k) - z_k|^2,  yj' = g(j-1) y(j-1) - (mj + gj) yj,  g(0) = g(8) = 0,  g, m >= 0
//   t in [0, 10]        J = 1.97465e7   (COPS)
#include "classics.h"

enum { ny = 8, n = 21 };

static const double time[n] = {0, 0.5, 1, 1.5, 2, 2.5, 3, 3.5, 4, 4.5, 5, 5.5, 6, 6.5, 7, 7.5, 8, 8.5, 9, 9.5, 10};
static const double value[n * ny] = {
    20000, 17000, 10000, 15000, 12000, 9000, 7000, 3000, 12445, 15411, 13040, 13338, 13484, 8426, 6615, 4022, 7705,
    13074, 14623, 11976, 12453, 9272,  6891, 5020, 4664, 8579,  12434, 12603, 11738, 9710,  6821, 5722, 2977, 7053,
    11219, 11340, 13665, 8534,  6242,  5695, 1769, 5054, 10065, 11232, 12112, 9600,  6647,  7034, 943,  3907, 9473,
    10334, 11115, 8826,  6842,  7348,  581,  2624, 7421, 10297, 12427, 8747,  7199,  7684,  355,  1744, 5369, 7748,
    10057, 8698,  6542,  7410,  223,   1272, 4713, 6869, 9564,  8766,  6810,  6961,  137,   821,  3451, 6050, 8671,
    8291,  6827,  7525,  87,    577,   2649, 5454, 8430, 7411,  6423,  8388,  49,    337,   2058, 4115, 7435, 7627,
    6268,  7189,  32,    228,   1440,  3790, 6474, 6658, 5859,  7467,  17,    168,   1178,  3087, 6524, 5880, 5562,
    7144,  11,    99,    919,   2596,  5360, 5762, 4480, 7256,  7,     65,    647,   1873,  4556, 5058, 4944, 7538,
    4,     44,    509,   1571,  4009,  4527, 4233, 6649, 2,     27,    345,   1227,  3677,  4229, 3805, 6378, 1,
    20,    231,   934,   3197,  3695,  3159, 6454, 1,    12,    198,   707,   2562,  3163,  3232, 5566};

static void live(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    const moray_num *y = at->x, *m = at->s, *g = at->s + ny;
    for (int j = 0; j < ny; j++) {
        const moray_num grown = j > 0 ? g[j - 1] * y[j - 1] : 0, growing = j < ny - 1 ? g[j] : 0;
        out->f[j] = grown - (m[j] + growing) * y[j];
    }
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
        .name = "season", .nx = ny, .continuous = live, .tf = moray_fixed(10), .observed = observed};
    const moray_ocp_spec spec = {.name = "marine population",
                                 .phases = 1,
                                 .ns = 15,
                                 .phase = &phase,
                                 .endpoint = classic_no_objective,
                                 .s = MORAY_BOUNDS(moray_at_least(0), moray_at_least(0), moray_at_least(0),
                                                   moray_at_least(0), moray_at_least(0), moray_at_least(0),
                                                   moray_at_least(0), moray_at_least(0), moray_at_least(0),
                                                   moray_at_least(0), moray_at_least(0), moray_at_least(0),
                                                   moray_at_least(0), moray_at_least(0), moray_at_least(0))};
    return moray_ocp_new(ocp, &spec);
}

static double start(int phase, double tau, double *x, double *u, const void *data)
{
    (void)phase, (void)u, (void)data;
    return classic_start_on_data(&observed, 10, tau, x);
}

const struct classic classic_marine_population = {.name = "marine-population",
                                                  .title = "Marine population",
                                                  .source = "COPS 3.0; Rothschild et al. 1997",
                                                  .published = "1.97465e7",
                                                  .build = build,
                                                  .start = start};
