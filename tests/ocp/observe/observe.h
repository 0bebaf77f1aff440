// SPDX-License-Identifier: MIT
//
// Shared by the tests of observations.
#ifndef TESTS_OBSERVE_H
#define TESTS_OBSERVE_H

#include "tap.h"

#include <complex.h>
#include <string.h>
#include <unistd.h>

#include "moray/fit.h"

#include "ocp/solution.h"
#include "rk4.h"

static const int rk4_steps = 50;
static const moray_integrator rk4 = {rk4_run, &rk4_steps};

static inline void refused(moray_status status, moray_code code, const char *what)
{
    CHECK(status.code == code, "%s: %s", what, status.text);
}

static inline void nothing(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)at, (void)data;
    out->objective = 0;
}

static inline void see_state(const moray_node *at, moray_num *y, const void *data)
{
    (void)data;
    y[0] = at->x[0];
}

static inline void grow(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = at->s[0];
}

struct task {
    moray_continuous_fn *dynamics;
    moray_observations data;
    int ns;
    double tf;
    moray_bounds x0;
};

static inline moray_status problem(moray_ocp **ocp, const struct task *task)
{
    static const char *const names[] = {"slope", "twin", "offset"};
    const moray_bounds x0[] = {task->x0};
    const moray_phase_spec phase = {.name = "line",
                                    .nx = 1,
                                    .continuous = task->dynamics,
                                    .tf = moray_fixed(task->tf),
                                    .x0 = MORAY_BOUNDS_OF(x0),
                                    .observed = task->data};
    return moray_ocp_new(
        ocp, &(moray_ocp_spec){
                 .name = "fit", .phases = 1, .phase = &phase, .ns = task->ns, .s_names = names, .endpoint = nothing});
}

static inline moray_solution *solve(const moray_ocp *ocp, const moray_settings *settings, const double *s)
{
    moray_solution *solution = NULL;
    CHECK_OK(moray_solve(ocp, settings, &(moray_guess){.s = s}, &solution), "solve");
    return solution;
}

static unsigned long long seed = 12;

static inline double noise(void)
{
    double sum = 0;
    for (int i = 0; i < 12; i++)
        sum += tap_random(&seed, 0, 1);
    return sum - 6;
}

static inline void test_map(const moray_map *map)
{
    moray_derivative_report report;
    double *in = calloc((size_t)(map->n_in + map->n_out), sizeof *in), *weight = in + map->n_in;
    double jacobian = 0, hessian = 0;
    for (int trial = 0; trial < 5; trial++) {
        for (int i = 0; i < map->n_in; i++)
            in[i] = noise();
        for (int i = 0; i < map->n_out; i++)
            weight[i] = 1.3 * cos(i);
        CHECK_OK(moray_check_derivatives(map, in, weight, &report), "differences");
        jacobian = tap_worse(jacobian, report.jacobian_error), hessian = tap_worse(hessian, report.hessian_error);
    }
    CHECK(jacobian < 1e-7 && hessian < 1e-6, "derivatives of the losses against differences: %.1e, %.1e", jacobian,
          hessian);
    for (int a = 0, twice = 0; a < map->hess.nnz; a++) {
        for (int b = 0; b < a; b++)
            twice += map->hess.row[a] == map->hess.row[b] && map->hess.col[a] == map->hess.col[b];
        if (twice || map->hess.row[a] < map->hess.col[a])
            CHECK(false, "entry %d of the Hessian stands twice or above the diagonal", a);
    }
    free(in);
}

#endif
