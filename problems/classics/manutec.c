// SPDX-License-Identifier: MIT
//
// Manutec r3 robot (Otter and Tuerk 1988, DFVLR model 2; von Stryk and Schlemmer 1994; PSOPT): a point-to-point motion
// of three joints (waist, shoulder, elbow) with the least energy in a fixed time.
//
//   minimise integral of u1^2 + u2^2 + u3^2
//   M(q) q'' + c(q, q') + dV/dq = F u, |u| <= 7.5 V, |q'| <= (3, 1.5, 5.2), t in [0, 0.53], without load
//   from rest at (0, -1.5, 0) to rest at (1, -1.95, 1)        J = 20.4042
//
// Lagrange's equations of rigid arms and rotors; rotor i turns ratio_i times as fast as its joint. Inertias are about
// the joints; those of arm 3 are the ones in the published simulation code, which its own heading gives differently.
#include <math.h>
#include <tgmath.h>

#include "classics.h"
#include "linear.h"

static const double g = 9.81, l = 0.5;     // length of arm 2 [m]
static const double m2 = 56.5, z2 = 0.205; // mass [kg], centre of mass along the arm [m]
static const double m3 = 60.3, z3 = 0.202; // its 0.028 m across the arm is in I3, and here:
static const double m3_x3 = 60.3 * 0.028;  // [kg m]
static const double I1 = 1.16;             // arm 1 about the vertical [kg m^2]
static const double I2xx = 4.9544125, I2yy = 6.7759085, I2zz = 2.311496, I2xz = -2.45219;
static const double I3xx = 7.8704812, I3yy = 8.1077564, I3zz = 0.4372752, I3xz = -0.0110568;
static const double Ir = 1.3e-3, ratio[] = {-105, 210, 60}; // rotors
static const double F[] = {-126, 252, 72};                  // [N m / V]

static void move(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    const moray_num *q = at->x, *w = at->x + 3, *u = at->u;
    const moray_num s2 = moray_sin(q[1]), c2 = moray_cos(q[1]), s3 = moray_sin(q[1] + q[2]),
                    c3 = moray_cos(q[1] + q[2]), bend = moray_sin(q[2]);
    // kinetic energy w' M w / 2
    const moray_num elbow = l * m3 * z3 * moray_cos(q[2]);
    const moray_num M11 = I1 + ratio[0] * ratio[0] * Ir + I2yy * s2 * s2 + I2zz * c2 * c2 + I3yy * s3 * s3 +
                          I3zz * c3 * c3 + m3 * l * (l * s2 + 2 * z3 * s3) * s2;
    const moray_num M12 = (I2xz - l * m3_x3) * c2 + I3xz * c3, M13 = I3xz * c3;
    const moray_num M22 = I2xx + I3xx + ratio[1] * ratio[1] * Ir + m3 * l * l + 2 * elbow;
    const moray_num M23 = I3xx + elbow + ratio[2] * Ir, M33 = I3xx + ratio[2] * ratio[2] * Ir;
    // derivatives of M with respect to q2 and q3, and of the potential
    const moray_num M11_3 = 2 * (I3yy - I3zz) * s3 * c3 + 2 * m3 * l * z3 * s2 * c3;
    const moray_num M11_2 = M11_3 + 2 * (I2yy - I2zz) * s2 * c2 + 2 * m3 * l * (l * s2 + z3 * s3) * c2;
    const moray_num M12_2 = -(I2xz - l * m3_x3) * s2 - I3xz * s3, M12_3 = -I3xz * s3, M13_2 = M12_3, M13_3 = M12_3;
    const moray_num M23_3 = -l * m3 * z3 * bend, M22_3 = 2 * M23_3;
    const moray_num V_3 = -g * m3 * z3 * s3, V_2 = V_3 - g * (m2 * z2 + m3 * l) * s2;
    moray_num M[3][3] = {{M11, M12, M13}, {M12, M22, M23}, {M13, M23, M33}};
    for (int i = 0; i < 3; i++)
        out->f[i] = w[i];
    out->f[3] = F[0] * u[0] - (M11_2 * w[1] + M11_3 * w[2]) * w[0] - (M12_2 * w[1] + M12_3 * w[2]) * w[1] -
                (M13_2 * w[1] + M13_3 * w[2]) * w[2];
    out->f[4] = F[1] * u[1] + M11_2 * w[0] * w[0] / 2 - M22_3 * w[1] * w[2] - M23_3 * w[2] * w[2] - V_2;
    out->f[5] = F[2] * u[2] + M11_3 * w[0] * w[0] / 2 + M22_3 * w[1] * w[1] / 2 - V_3;
    linear_solve3(M, out->f + 3);
    out->g[0] = u[0] * u[0] + u[1] * u[1] + u[2] * u[2];
}

static moray_status build(moray_ocp **ocp, const void *data)
{
    const moray_bounds rest = moray_fixed(0), voltage = moray_between(-7.5, 7.5);
    const moray_phase_spec phase = {
        .name = "motion",
        .nx = 6,
        .nu = 3,
        .nq = 1,
        .continuous = move,
        .tf = moray_fixed(0.53),
        .x = MORAY_BOUNDS(moray_between(-2.97, 2.97), moray_between(-2.01, 2.01), moray_between(-2.86, 2.86),
                          moray_between(-3, 3), moray_between(-1.5, 1.5), moray_between(-5.2, 5.2)),
        .x0 = MORAY_BOUNDS(moray_fixed(0), moray_fixed(-1.5), moray_fixed(0), rest, rest, rest),
        .xf = MORAY_BOUNDS(moray_fixed(1), moray_fixed(-1.95), moray_fixed(1), rest, rest, rest),
        .u = MORAY_BOUNDS(voltage, voltage, voltage)};
    return classic_new(ocp, "manutec r3", &phase, classic_first_integral, data);
}

const struct classic classic_manutec = {.name = "manutec",
                                        .title = "Manutec r3 robot, least energy",
                                        .source = "von Stryk and Schlemmer 1994; PSOPT",
                                        .published = "20.4042",
                                        .build = build};
