// SPDX-License-Identifier: MIT
//
// A chain of masses between springs with a cubic part, the first held by a wall, the last pushed by the control to
// bring it to rest from a bulge. Any number of states, each of which meets few others (squares of all of them in one
// integrand would need a derivative by each); written as a user writes functions, so that set-up finds the patterns by
// looking.
//
//   minimise  int q_n^2 + v_n^2 + u^2 dt  over [0, 10]
//   q_i' = v_i,  v_i' = F_(i+1) - F_i,  F_i = q_i - q_(i-1) + (q_i - q_(i-1))^3 / 10,  q_0 = 0,  F_(n+1) = u
#include <stdlib.h>
#include <tgmath.h>

#include "benchmark.h"

static const double duration = 10, bulge = 0.5;

static moray_num force(const moray_num *q, int i)
{
    const moray_num stretch = i > 0 ? q[i] - q[i - 1] : q[i];
    return stretch + stretch * stretch * stretch / 10;
}

static void chain(const moray_node *at, moray_rates *out, const void *data)
{
    const int masses = ((const chain_case *)data)->states / 2;
    const moray_num *q = at->x, *v = at->x + masses;
    out->g[0] = q[masses - 1] * q[masses - 1] + v[masses - 1] * v[masses - 1] + at->u[0] * at->u[0];
    for (int i = 0; i < masses; i++) {
        out->f[i] = v[i];
        out->f[masses + i] = (i + 1 < masses ? force(q, i + 1) : at->u[0]) - force(q, i);
    }
}

static void cost_of_chain(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase[0].q[0];
}

static moray_status build(chain_case *c)
{
    moray_bounds *x0 = calloc((size_t)c->states, sizeof *x0);
    if (!x0)
        return moray_error(MORAY_MEMORY, "no memory for %d states", c->states);
    const int masses = c->states / 2;
    for (int i = 0; i < c->states; i++)
        x0[i] = moray_fixed(i < masses ? bulge * sin(M_PI * (i + 1) / masses) : 0);
    const moray_phase_spec phase = {.name = "chain",
                                    .nx = c->states,
                                    .nu = 1,
                                    .nq = 1,
                                    .continuous = chain,
                                    .t0 = moray_fixed(0),
                                    .tf = moray_fixed(duration),
                                    .x0 = {x0, c->states}};
    const moray_status status = moray_ocp_new(
        &c->ocp,
        &(moray_ocp_spec){.name = "chain", .phases = 1, .phase = &phase, .endpoint = cost_of_chain, .data = c});
    free(x0);
    return status;
}

static moray_status solve(void *self, moray_linear_solver linear, bool timed, moray_solution **solution)
{
    chain_case *c = self;
    const moray_settings settings = benchmark_settings("hermite-simpson", 20, linear, timed);
    MORAY_TRY(build(c));
    return moray_solve(c->ocp, &settings, NULL, solution);
}

static void forget(void *self)
{
    chain_case *c = self;
    moray_ocp_free(c->ocp);
    c->ocp = NULL;
}

subject chain_subject(chain_case *c)
{
    return (subject){NULL, solve, forget, NULL, c};
}
