// SPDX-License-Identifier: MIT
//
// Problems with delays, by the method of steps: what happens from 0 to n h stands as n copies of states and controls
// side by side in one phase from 0 to h, each beginning where the one before ends.
#ifndef MORAY_DELAY_H
#define MORAY_DELAY_H

#include "moray/export.h"
#include "moray/ocp.h"

MORAY_BEGIN

typedef struct moray_delay_node {
    const moray_num *x, *u;           // [nx], [nu] at t
    const moray_num *past_x, *past_u; // [nx] at t - x_delay h, [nu] at t - u_delay h
    moray_num t;
} moray_delay_node;

// f[nx], c[nc] and one integrand g[1] at a node.
typedef void moray_delay_fn(const moray_delay_node *at, moray_rates *out, const void *data);
// x[nx] and u[nu] at t before 0.
typedef void moray_past_fn(moray_num t, moray_num *x, moray_num *u, const void *data);

// Minimised is the integral of g, and `final` of x(n h), which may be NULL.
// There are no observations.
typedef struct moray_delay_spec {
    const char *name;
    int nx, nu, nc;
    double step;          // h
    int steps;            // n
    int x_delay, u_delay; // in steps: 0 to n; `past` is asked for what is before 0
    moray_delay_fn *continuous;
    moray_past_fn *past;
    moray_num (*final)(const moray_num *x, const void *data);
    moray_bounds_list x, x0, xf, u, c; // as of a phase: x0 at time 0, xf at n h
    const void *data;
} moray_delay_spec;

typedef struct moray_delay moray_delay;

// Copies the spec, not data. Error: MORAY_INPUT, MORAY_MEMORY. Free with moray_delay_free, after the solutions.
MORAY_API moray_status moray_delay_new(moray_delay **delay, const moray_delay_spec *spec);
MORAY_API void moray_delay_free(moray_delay *delay);

// The problem, to be solved and certified as any other.
MORAY_API const moray_ocp *moray_delay_ocp(const moray_delay *delay);

// x[nx] and u[nu] of a solution at t, clamped to 0..n h; where the control jumps between steps, its value before the
// jump. Either may be NULL. Error: MORAY_MEMORY.
MORAY_API moray_status moray_delay_at(const moray_delay *delay, const moray_solution *solution, double t, double *x,
                                      double *u);

MORAY_END

#endif
