// SPDX-License-Identifier: MIT
//
// Goddard's rocket: the thrust programme that carries a sounding rocket highest. Singular thrust after a full boost.
//
//   maximise h(tf)
//   h' = v,  v' = (T - D) / m - 1 / h^2,  m' = -2 T,  0 <= T <= 3.5
//   D = 310 v^2 exp(-500 (h - 1)),  (h, v, m) from (1, 0, 1) to m = 0.6
//
// Three different "Goddards" are in print:
//   COPS 3.0 (these data):               h(tf) = 1.01283
//   BOCOP (these data and v <= 0.1):     h(tf) = 1.01257
//   PSOPT prints 1.025336, but its drag is 310 v^2 exp(-500 h), which is nothing at h = 1: another problem.
#include <math.h>
#include <tgmath.h>

#include "classics.h"

static void climb(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    const moray_num h = at->x[0], v = at->x[1], m = at->x[2], T = at->u[0];
    const moray_num D = 310 * v * v * moray_exp(-500 * (h - 1));
    out->f[0] = v;
    out->f[1] = (T - D) / m - 1 / (h * h);
    out->f[2] = -2 * T;
}

static moray_status build(moray_ocp **ocp, const void *data)
{
    const double *v_max = data;
    const moray_phase_spec phase = {
        .name = "ascent",
        .nx = 3,
        .nu = 1,
        .continuous = climb,
        .tf = moray_at_least(0),
        .x = MORAY_BOUNDS(moray_at_least(1), moray_between(0, *v_max), moray_between(0.6, 1)),
        .x0 = MORAY_BOUNDS(moray_fixed(1), moray_fixed(0), moray_fixed(1)),
        .xf = MORAY_BOUNDS(moray_free(), moray_free(), moray_fixed(0.6)),
        .u = MORAY_BOUNDS(moray_between(0, 3.5))};
    return classic_new(ocp, "goddard", &phase, classic_first_state, data);
}

// COPS: at the ground, tf = 1.
static double start(int phase, double tau, double *x, double *u, const void *data)
{
    (void)phase;
    (void)data;
    x[0] = 1;
    x[1] = tau * (1 - tau);
    x[2] = 1 - 0.4 * tau;
    u[0] = 3.5 / 2;
    return tau;
}

const struct classic classic_goddard = {.name = "goddard",
                                        .title = "Goddard rocket",
                                        .source = "COPS 3.0",
                                        .published = "1.01283",
                                        .maximised = true,
                                        .build = build,
                                        .data = &(const double){MORAY_INFINITY},
                                        .start = start};

const struct classic classic_goddard_slow = {.name = "goddard-slow",
                                             .title = "Goddard rocket, v <= 0.1",
                                             .source = "BOCOP; CTDirect",
                                             .published = "1.01257",
                                             .maximised = true,
                                             .build = build,
                                             .data = &(const double){0.1},
                                             .start = start};
