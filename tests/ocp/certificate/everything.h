// SPDX-License-Identifier: MIT
//
// A problem of two phases that has all that a programme may, and random points with random multipliers.
#ifndef TESTS_OCP_EVERYTHING_H
#define TESTS_OCP_EVERYTHING_H

#include "tap.h"

#include "moray/ocp.h"

#include "ocp/solution.h"

enum { NX0 = 2, NU0 = 2, NX1 = 1, NU1 = 2, NS = 2, NE = 4, DATA = 3 };

static void first(const moray_node *at, moray_rates *out, const void *data)
{
    const moray_num *x = at->x, *u = at->u, *s = at->s;
    (void)data;
    out->f[0] = x[1] * u[0] + s[0] * at->t;
    out->f[1] = u[1] - x[0] * x[0];
    out->c[0] = x[0] * u[1];
    out->c[1] = u[0] + at->t * x[1];
    out->g[0] = u[0] * u[0] + x[1] * x[1];
}

static void second(const moray_node *at, moray_rates *out, const void *data)
{
    const moray_num *x = at->x, *u = at->u, *s = at->s;
    (void)data;
    out->f[0] = u[0] * x[0] - s[1] * u[1];
    out->c[0] = x[0] * x[0] * at->t;
    out->g[0] = x[0] * u[0];
    out->g[1] = s[0] * s[1] * x[0] + at->t;
}

static void see(const moray_node *at, moray_num *y, const void *data)
{
    (void)data;
    y[0] = at->x[0] + at->u[1] * at->s[0];
}

static void ends(const moray_ends *at, moray_end_values *out, const void *data)
{
    const moray_phase_ends *one = &at->phase[0], *two = &at->phase[1];
    (void)data;
    out->objective = one->q[0] - 2 * two->q[0] + two->q[1] * two->tf + one->xf[0] * at->s[1] + one->u0[1] * one->uf[0];
    out->e[0] = one->xf[1] - two->x0[0];
    out->e[1] = one->tf - two->t0;
    out->e[2] = at->s[0] * at->s[1] + one->uf[1] * one->x0[0];
    out->e[3] = two->xf[0] * two->xf[0];
}

static moray_solution *begin(moray_ocp **ocp, const char *scheme)
{
    static const double time[DATA] = {2.2, 2.9, 3.4}, value[DATA] = {1, 2, 3}, mesh[] = {0, 0.4, 1};
    static const bool held[NU1] = {true, false};
    const moray_bounds low = moray_at_least(-3), high = moray_at_most(4), box = moray_between(-2, 1),
                       none = moray_free();
    const moray_phase_spec phases[] = {
        {.name = "one",
         .nx = NX0,
         .nu = NU0,
         .nc = 2,
         .nq = 1,
         .continuous = first,
         .tf = moray_between(1, 3),
         .x = MORAY_BOUNDS(low, none),
         .x0 = MORAY_BOUNDS(moray_fixed(1), box),
         .u = MORAY_BOUNDS(box, high),
         .u0 = MORAY_BOUNDS(moray_between(-1, 0.5), none),
         .c = MORAY_BOUNDS(low, moray_between(-0.1, 0.2)),
         .end_controls = true},
        {.name = "two",
         .nx = NX1,
         .nu = NU1,
         .nc = 1,
         .nq = 2,
         .continuous = second,
         .t0 = moray_between(1, 3),
         .tf = moray_between(2, 6),
         .duration = moray_between(0.5, 2),
         .mesh = mesh,
         .intervals = 2,
         .x = MORAY_BOUNDS(high),
         .u = MORAY_BOUNDS(none, low),
         .c = MORAY_BOUNDS(high),
         .q = MORAY_BOUNDS(none, low),
         .held = held,
         .observed = {.n = DATA, .ny = 1, .time = time, .value = value, .observe = see}}};
    moray_settings settings = moray_settings_default();
    moray_solution *solution = NULL;
    settings.max_iterations = 0;
    settings.intervals = 2;
    settings.scheme = scheme;
    CHECK_OK(moray_ocp_new(ocp, &(moray_ocp_spec){.phases = 2,
                                                  .phase = phases,
                                                  .ns = NS,
                                                  .s = MORAY_BOUNDS(low, moray_between(-0.2, 0.1)),
                                                  .ne = NE,
                                                  .e = MORAY_BOUNDS(moray_fixed(0), moray_fixed(0), high, low),
                                                  .endpoint = ends}),
             scheme);
    CHECK_OK(moray_solve(*ocp, &settings, NULL, &solution), "begun");
    return solution;
}

// Multipliers of bounds are 0 or more but for a few, and a few are of sides without a bound.
static void scatter(moray_solution *solution, unsigned long long *seed)
{
    const struct transcription *t = solution->transcription;
    moray_iterate *at = &solution->iterate;
    for (int j = 0; j < t->nlp.n; j++) {
        at->x[j] += tap_random(seed, -0.3, 0.3);
        at->z_lower[j] = tap_random(seed, 0, 1) < 0.1 ? tap_random(seed, -2, 2) : fmax(0, tap_random(seed, -2, 1));
        at->z_upper[j] = tap_random(seed, 0, 1) < 0.1 ? tap_random(seed, -2, 2) : fmax(0, tap_random(seed, -2, 1));
    }
    at->x[t->layout.phase[0].tf] = 1.5, at->x[t->layout.phase[1].t0] = 1.9, at->x[t->layout.phase[1].tf] = 3.7;
    for (int i = 0; i < t->nlp.m; i++)
        at->lambda[i] = tap_random(seed, -3, 2);
    at->objective = tap_random(seed, -3, 3);
    CHECK(moray_transcription_jacobians(solution->transcription, at->x), "finite");
}

#endif
