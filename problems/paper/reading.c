// SPDX-License-Identifier: MIT
#include "reading.h"

#include <math.h>

// h_1 (h_4 v_nr + h_5 v_tr) of (23h) less h_1 (h_4 v_tr + h_5 v_nr) of (16c), with the coefficients of (13).
static void add_23h_excess(const moray_swimmer *swimmer, const double *x, double *dx)
{
    const moray_robot *robot = moray_swimmer_robot(swimmer);
    const int N = robot->links;
    const double L = 2 * robot->l, m = robot->m, c_t = robot->c_t, c_n = robot->c_n;
    const double c_p = (c_n - c_t) / (2 * L), mu_p = robot->mu_n / (2 * L), c_n_hat = c_n / (4 * L * L);
    double V[2], sum = 0, q = 0;
    moray_swimmer_current(swimmer, V);
    const double c = cos(x[N - 1]), s = sin(x[N - 1]);
    const double v_tr = x[2 * N + 2] - (V[0] * c + V[1] * s), v_nr = x[2 * N + 3] - (-V[0] * s + V[1] * c);
    for (int i = 0; i < N; i++) {
        const double phi = i < N - 1 ? x[i] : 0, across = phi + (i > 0 ? x[i - 1] : 0);
        sum += phi;
        q += across * across;
    }
    const double h_1 = 1 / (N * N * m * (m + robot->mu_n) - 4 * mu_p * mu_p * sum * sum); // (17)
    const double h_4 = 2 * sum * (N * c_p * m - N * c_t * mu_p - c_n_hat * mu_p * q);     // (16c)
    const double h_5 = 4 * c_p * mu_p * sum * sum - N * N * m * c_n;
    dx[2 * N + 3] += h_1 * (h_4 - h_5) * (v_nr - v_tr);
}

moray_status paper_reading_swimmer(moray_swimmer **swimmer, const moray_robot *robot, moray_model model,
                                   paper_reading reading)
{
    const bool misprints = model == MORAY_CONTROL_ORIENTED;
    moray_robot read = *robot;
    if (misprints && reading & PAPER_L_PRINTED)
        read.l /= 2;
    MORAY_TRY(moray_swimmer_new(swimmer, &read, model));
    if (misprints && reading & PAPER_23H_PRINTED)
        moray_swimmer_set_extra(*swimmer, add_23h_excess);
    return moray_ok();
}
