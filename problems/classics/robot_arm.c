// SPDX-License-Identifier: MIT
//
// Robot arm (Moessner-Beigel 1995; Dolan, More and Munson, COPS 3.0): turn a telescopic arm from rest to rest in
// minimum time. Bang-bang.
//
//   minimise tf
//   L rho'' = u_rho,  I_theta theta'' = u_theta,  I_phi phi'' = u_phi,  |u| <= 1,  L = 5
//   I_phi = ((L - rho)^3 + rho^3) / 3,  I_theta = I_phi sin^2 phi
//   (rho, theta, phi) from (4.5, 0, pi/4) to (4.5, 2 pi/3, pi/4)
//
// COPS prints 9.14138 on 200 intervals of the trapezoid. The least of that programme is 9.141395, from a dozen random
// starts and to 1e-12: what is printed lies 1.5e-5 below. With --refinements 20: 9.140736.
#include <math.h>
#include <tgmath.h>

#include "classics.h"

static const double L = 5;

static moray_num cube(moray_num x)
{
    return x * x * x;
}

static void turn(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    const moray_num rho = at->x[0], phi = at->x[2];
    const moray_num I_phi = (cube(L - rho) + cube(rho)) / 3, I_theta = I_phi * moray_sin(phi) * moray_sin(phi);
    out->f[0] = at->x[3];
    out->f[1] = at->x[4];
    out->f[2] = at->x[5];
    out->f[3] = at->u[0] / L;
    out->f[4] = at->u[1] / I_theta;
    out->f[5] = at->u[2] / I_phi;
}

static moray_status build(moray_ocp **ocp, const void *data)
{
    const moray_bounds rest = moray_fixed(0), torque = moray_between(-1, 1);
    const moray_phase_spec phase = {
        .name = "turn",
        .nx = 6,
        .nu = 3,
        .continuous = turn,
        .tf = moray_at_least(0),
        .x = MORAY_BOUNDS(moray_between(0, L), moray_between(-M_PI, M_PI), moray_between(0, M_PI), moray_free(),
                          moray_free(), moray_free()),
        .x0 = MORAY_BOUNDS(moray_fixed(4.5), moray_fixed(0), moray_fixed(M_PI / 4), rest, rest, rest),
        .xf = MORAY_BOUNDS(moray_fixed(4.5), moray_fixed(2 * M_PI / 3), moray_fixed(M_PI / 4), rest, rest, rest),
        .u = MORAY_BOUNDS(torque, torque, torque)};
    return classic_new(ocp, "robot arm", &phase, classic_final_time, data);
}

// COPS: theta = 2 pi/3 tau^2, tf = 1, everything else stays.
static double start(int phase, double tau, double *x, double *u, const void *data)
{
    (void)phase;
    (void)data;
    x[0] = 4.5;
    x[1] = 2 * M_PI / 3 * tau * tau;
    x[2] = M_PI / 4;
    x[3] = x[5] = 0;
    x[4] = 4 * M_PI / 3 * tau;
    u[0] = u[1] = u[2] = 0;
    return tau;
}

const struct classic classic_robot_arm = {.name = "robot-arm",
                                          .title = "Robot arm, 200 intervals",
                                          .source = "COPS 3.0",
                                          .published = "9.14138",
                                          .computed = "9.14140",
                                          .build = build,
                                          .start = start,
                                          .scheme = "trapezoid",
                                          .intervals = 200,
                                          .fixed_mesh = true};
