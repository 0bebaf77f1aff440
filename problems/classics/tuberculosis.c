// SPDX-License-Identifier: MIT
//
// Two-strain tuberculosis (Jung, Lenhart and Feng 2002; Betts 2010, sec. 6.16; PSOPT): effort in finding cases u1 and
// in holding them to their treatment u2, so that the resistant strain spreads little at a moderate cost.
//
//   minimise integral of L2 + I2 + B1 u1^2 / 2 + B2 u2^2 / 2
//   S'  = Lambda - beta1 S I1/N - beta3 S I2/N - mu S
//   T'  = u1 r1 L1 - mu T + (1 - (1 - u2)(p + q)) r2 I1 - beta2 T I1/N - beta3 T I2/N
//   L1' = beta1 S I1/N - (mu + k1) L1 - u1 r1 L1 + (1 - u2) p r2 I1 + beta2 T I1/N - beta3 L1 I2/N
//   I1' = k1 L1 - (mu + d1) I1 - r2 I1
//   L2' = (1 - u2) q r2 I1 - (mu + k2) L2 + beta3 (S + L1 + T) I2/N
//   I2' = k2 L2 - (mu + d2) I2,      S + T + L1 + I1 + L2 + I2 = N,  which the equations keep, so that rows depend
//   t in [0, 5],  (S, T, L1, I1, L2, I2)(0) = (76, 1, 36, 4, 2, 1) N/120,  0.05 <= u1, u2 <= 0.95       J = 5152.0731
#include "classics.h"

static const double beta1 = 13, beta2 = 13, beta3 = 0.029, mu = 0.0143, d1 = 0, d2 = 0, k1 = 0.5, k2 = 1, r1 = 2,
                    r2 = 1;
static const double p = 0.4, q = 0.1, N = 30000, B1 = 50, B2 = 500;

static void spread(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    const moray_num S = at->x[0], T = at->x[1], L1 = at->x[2], I1 = at->x[3], L2 = at->x[4], I2 = at->x[5];
    const moray_num u1 = at->u[0], u2 = at->u[1], met1 = I1 / N, met2 = beta3 * I2 / N;
    out->f[0] = mu * N - beta1 * S * met1 - S * met2 - mu * S;
    out->f[1] = u1 * r1 * L1 - mu * T + (1 - (1 - u2) * (p + q)) * r2 * I1 - beta2 * T * met1 - T * met2;
    out->f[2] =
        beta1 * S * met1 - (mu + k1) * L1 - u1 * r1 * L1 + (1 - u2) * p * r2 * I1 + beta2 * T * met1 - L1 * met2;
    out->f[3] = k1 * L1 - (mu + d1) * I1 - r2 * I1;
    out->f[4] = (1 - u2) * q * r2 * I1 - (mu + k2) * L2 + (S + L1 + T) * met2;
    out->f[5] = k2 * L2 - (mu + d2) * I2;
    out->c[0] = S + T + L1 + I1 + L2 + I2;
    out->g[0] = L2 + I2 + B1 * u1 * u1 / 2 + B2 * u2 * u2 / 2;
}

static moray_status build(moray_ocp **ocp, const void *data)
{
    const moray_bounds effort = moray_between(0.05, 0.95), part = moray_between(0, N);
    const moray_phase_spec phase = {.name = "years",
                                    .nx = 6,
                                    .nu = 2,
                                    .nc = 1,
                                    .nq = 1,
                                    .continuous = spread,
                                    .tf = moray_fixed(5),
                                    .x = MORAY_BOUNDS(part, part, part, part, part, part),
                                    .x0 = MORAY_BOUNDS(moray_fixed(76 * N / 120), moray_fixed(N / 120),
                                                       moray_fixed(36 * N / 120), moray_fixed(4 * N / 120),
                                                       moray_fixed(2 * N / 120), moray_fixed(N / 120)),
                                    .u = MORAY_BOUNDS(effort, effort),
                                    .c = MORAY_BOUNDS(moray_fixed(N))};
    return classic_new(ocp, "tuberculosis", &phase, classic_first_integral, data);
}

const struct classic classic_tuberculosis = {.name = "tuberculosis",
                                             .title = "Two-strain tuberculosis",
                                             .source = "Betts 2010, sec. 6.16",
                                             .published = "5152.0731",
                                             .build = build};
