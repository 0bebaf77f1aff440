// SPDX-License-Identifier: MIT
#include "orbit.h"

#include <stddef.h>
#include <tgmath.h>

static const double mu = 1.407645794e16, Re = 20925662.73; // ft^3/s^2, ft
static const double J[] = {1082.639e-6, -2.565e-6, -1.608e-6};

// Harmonics 2 to 4 in the directions radial, transverse, normal, of which z has these components:
//   radial  mu / r^2 sum (k + 1) (Re / r)^k P_k J_k,   the others  -mu / r^2 sum (Re / r)^k P_k' J_k times theirs,
// with P_k(z_r), z_r the sine of the latitude.
static void oblateness(moray_num r, const moray_num *z, moray_num *delta)
{
    const moray_num s = z[0], s2 = s * s;
    const moray_num P[] = {(3 * s2 - 1) / 2, (5 * s2 - 3) * s / 2, ((35 * s2 - 30) * s2 + 3) / 8};
    const moray_num slope[] = {3 * s, (15 * s2 - 3) / 2, (35 * s2 - 15) * s / 2};
    moray_num radial = 0, north = 0, ratio = Re / r;
    for (int k = 2; k <= 4; k++) {
        ratio *= Re / r;
        radial += (k + 1) * ratio * P[k - 2] * J[k - 2];
        north -= ratio * slope[k - 2] * J[k - 2];
    }
    delta[0] += mu / (r * r) * radial;
    delta[1] += mu / (r * r) * north * z[1];
    delta[2] += mu / (r * r) * north * z[2];
}

void orbit_rates(const moray_num *element, const moray_num *thrust, moray_num *rate)
{
    const moray_num p = element[0], f = element[1], g = element[2], h = element[3], k = element[4], L = element[5];
    const moray_num sinL = moray_sin(L), cosL = moray_cos(L), q = 1 + f * cosL + g * sinL, s2 = 1 + h * h + k * k;
    const moray_num z[] = {2 * (h * sinL - k * cosL) / s2, 2 * (h * cosL + k * sinL) / s2, (2 - s2) / s2};
    const moray_num root = moray_sqrt(p / mu), node = (h * sinL - k * cosL) / q;
    moray_num delta[] = {thrust[0], thrust[1], thrust[2]};
    oblateness(p / q, z, delta);
    rate[0] = 2 * p / q * root * delta[1];
    rate[1] = root * (sinL * delta[0] + ((q + 1) * cosL + f) / q * delta[1] - g * node * delta[2]);
    rate[2] = root * (-cosL * delta[0] + ((q + 1) * sinL + g) / q * delta[1] + f * node * delta[2]);
    rate[3] = root * s2 * cosL / (2 * q) * delta[2];
    rate[4] = root * s2 * sinL / (2 * q) * delta[2];
    rate[5] = moray_sqrt(mu * p) * (q / p) * (q / p) + root * node * delta[2];
}

void orbit_velocity(const moray_num *element, moray_num *radial, moray_num *transverse)
{
    const moray_num f = element[1], g = element[2], L = element[5], root = moray_sqrt(mu / element[0]);
    *radial = root * (f * moray_sin(L) - g * moray_cos(L));
    *transverse = root * (1 + f * moray_cos(L) + g * moray_sin(L));
}

enum { steps = 4, max_states = 8 };

void orbit_propagate(moray_continuous_fn *dynamics, int n, double *x, const moray_num *u, const moray_num *s,
                     double time)
{
    const double h = time / steps, offset[] = {0, 0.5, 0.5, 1}, weight[] = {1, 2, 2, 1};
    moray_num y[max_states], f[max_states] = {0}, c[1];
    for (int step = 0; step < steps; step++) {
        double sum[max_states] = {0};
        for (int stage = 0; stage < 4; stage++) {
            for (int i = 0; i < n; i++)
                y[i] = x[i] + offset[stage] * h * f[i];
            dynamics(&(moray_node){.x = y, .u = u, .s = s}, &(moray_rates){.f = f, .c = c}, NULL);
            for (int i = 0; i < n; i++)
                sum[i] += weight[stage] * creal(f[i]);
        }
        for (int i = 0; i < n; i++)
            x[i] += h / 6 * sum[i];
    }
}
