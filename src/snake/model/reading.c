// SPDX-License-Identifier: MIT
#include "snake/model/reading.h"

#include <math.h>

#include "snake/model/control.h"

moray_robot moray_reading_robot(const moray_robot *robot, moray_reading reading)
{
    moray_robot read = *robot;
    if (reading & MORAY_READ_L_PRINTED)
        read.l /= 2;
    return read;
}

// h_1 (h_4 v_nr + h_5 v_tr) of (23h) less h_1 (h_4 v_tr + h_5 v_nr) of (16c).
double moray_reading_23h_excess(const moray_robot *robot, const double current[2], const double *x)
{
    const int N = robot->links;
    const control_coefficients k = moray_control_coefficients_of(robot);
    const double c = cos(x[N - 1]), s = sin(x[N - 1]), m = robot->m;
    const double v_tr = x[2 * N + 2] - (current[0] * c + current[1] * s);
    const double v_nr = x[2 * N + 3] - (-current[0] * s + current[1] * c);
    double sum = 0, q = 0;
    for (int i = 0; i < N; i++) {
        const double phi = i < N - 1 ? x[i] : 0, across = phi + (i > 0 ? x[i - 1] : 0);
        sum += phi;
        q += across * across;
    }
    const double h_1 = 1 / (N * N * m * k.m_tilde - 4 * k.mu_p * k.mu_p * sum * sum);                // (17)
    const double h_4 = 2 * sum * (N * k.c_p * m - N * robot->c_t * k.mu_p - k.c_n_hat * k.mu_p * q); // (16c)
    const double h_5 = 4 * k.c_p * k.mu_p * sum * sum - N * N * m * robot->c_n;
    return h_1 * (h_4 - h_5) * (v_nr - v_tr);
}
