// SPDX-License-Identifier: MIT
//
// The programme's derivatives on a problem that uses everything: two phases of different size, free times, parameters,
// path constraints, integrals, explicit time, every scheme; against differences of its values.
#include "tap.h"

#include <stdlib.h>
#include <string.h>
#include <tgmath.h>

#include "ocp/names.h"
#include "ocp/transcription.h"

static void first_leg(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    const moray_num *x = at->x, *u = at->u, *s = at->s;
    out->f[0] = x[1] * s[0] + sin(at->t) * u[0];
    out->f[1] = -x[0] * x[2] + u[0] * u[0];
    out->f[2] = at->t * at->t * x[1] + s[1] * u[0];
    out->c[0] = x[0] * u[0] + s[0] * at->t;
    out->g[0] = u[0] * u[0] + x[2] * s[1] * at->t;
    out->g[1] = exp(x[0] * 0.1);
}

static void second_leg(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = at->x[0] * at->u[1] - cos(at->x[1]) * at->s[0];
    out->f[1] = at->u[0] / (2 + at->x[0] * at->x[0]);
    out->c[0] = at->u[0] * at->u[1];
    out->c[1] = at->x[1] * at->t;
    out->g[0] = at->x[0] * at->s[0] * at->s[1];
}

static void verdict(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    const moray_phase_ends *one = &at->phase[0], *two = &at->phase[1];
    out->objective = two->tf * one->q[0] + two->xf[0] * two->xf[1] + at->s[0] * one->x0[1] + two->q[0] * one->q[1];
    out->objective += one->t0 * (one->x0[0] + one->t0) * one->tf;
    out->e[0] = one->tf - two->t0;
    out->e[1] = one->xf[0] * at->s[1] - two->x0[0] + two->x0[1] * two->t0;
    if (two->u0) {
        out->objective += two->u0[1] * two->uf[0] * one->tf;
        out->e[0] += exp(two->u0[0] * 0.3) * two->uf[1] * two->xf[1];
    }
}

static void watch(const moray_node *at, moray_num *y, const void *data)
{
    (void)data;
    y[0] = at->x[0] * at->u[1] * at->t + at->s[0];
    y[1] = sin(at->x[1]) * at->s[1] + at->u[0] * at->u[0];
}

// Of the second leg, whose times are free: in any interval of it, twice at one time, a value missing.
static const double watched_at[] = {1.8, 1.1, 2.2, 1.1}, watched[] = {0.3, 0.1, -0.2, 0.4, NAN, 0.2, 0.5, 0};

static moray_status make_problem(moray_ocp **ocp, moray_bounds t0, bool end_controls, bool hold, bool data)
{
    const moray_bounds near[] = {moray_between(-1, 2), moray_between(-2, 1)};
    const bool held[] = {false, hold};
    const moray_phase_spec phases[] = {{.name = "first",
                                        .nx = 3,
                                        .nu = 1,
                                        .nc = 1,
                                        .nq = 2,
                                        .continuous = first_leg,
                                        .t0 = t0,
                                        .tf = moray_between(0.5, 2),
                                        .c = MORAY_BOUNDS(moray_between(-5, 5))},
                                       {.name = "second",
                                        .nx = 2,
                                        .nu = 2,
                                        .nc = 2,
                                        .nq = 1,
                                        .end_controls = end_controls,
                                        .held = held,
                                        .intervals = hold ? 1 : 0,
                                        .continuous = second_leg,
                                        .t0 = moray_between(0.5, 2),
                                        .tf = moray_between(2, 4),
                                        .observed = {.n = data ? 4 : 0,
                                                     .ny = 2,
                                                     .time = watched_at,
                                                     .value = watched,
                                                     .observe = watch,
                                                     .residual = MORAY_BOUNDS_OF(near),
                                                     .sum = moray_at_most(3)},
                                        .c = MORAY_BOUNDS(moray_at_most(3), moray_fixed(1))}};
    return moray_ocp_new(ocp, &(moray_ocp_spec){.name = "everything",
                                                .phases = 2,
                                                .phase = phases,
                                                .ns = 2,
                                                .ne = 2,
                                                .endpoint = verdict,
                                                .e = MORAY_BOUNDS(moray_fixed(0), moray_fixed(0))});
}

// The programme as a map, so that the derivative checker can look at it: out = [f, g].
static void programme_value(void *self, const double *x, double *out)
{
    const moray_nlp *nlp = self;
    nlp->objective(nlp->self, x, true, out);
    nlp->constraints(nlp->self, x, false, out + 1);
}
static void programme_jacobian(void *self, const double *x, double *values)
{
    const moray_nlp *nlp = self;
    nlp->gradient(nlp->self, x, true, values);
    nlp->jacobian(nlp->self, x, false, values + nlp->n);
}
static void programme_hessian(void *self, const double *x, const double *weight, double *values)
{
    const moray_nlp *nlp = self;
    nlp->hessian(nlp->self, x, true, weight[0], weight + 1, values);
}

static moray_status programme_as_map(moray_nlp *nlp, moray_map *map)
{
    *map = (moray_map){.n_in = nlp->n,
                       .n_out = 1 + nlp->m,
                       .self = nlp,
                       .value = programme_value,
                       .jacobian = programme_jacobian,
                       .hessian = programme_hessian};
    MORAY_TRY(moray_pattern_new(&map->hess, nlp->nnz_hess));
    memcpy(map->hess.row, nlp->hess_row, (size_t)nlp->nnz_hess * sizeof *map->hess.row);
    memcpy(map->hess.col, nlp->hess_col, (size_t)nlp->nnz_hess * sizeof *map->hess.col);
    MORAY_TRY(moray_pattern_new(&map->jac, nlp->n + nlp->nnz_jac));
    for (int j = 0; j < nlp->n; j++)
        map->jac.col[j] = j;
    for (int k = 0; k < nlp->nnz_jac; k++) {
        map->jac.row[nlp->n + k] = nlp->jac_row[k] + 1;
        map->jac.col[nlp->n + k] = nlp->jac_col[k];
    }
    return moray_ok();
}

static bool strictly_sorted(const int *row, const int *col, int nnz)
{
    for (int k = 1; k < nnz; k++)
        if (row[k] < row[k - 1] || (row[k] == row[k - 1] && col[k] <= col[k - 1]))
            return false;
    return true;
}

// Of what is there on some schemes only.
static void check_names(const struct layout *layout, const moray_ocp *ocp, const double *x)
{
    const struct phase_layout *second = &layout->phase[1];
    char name[160];
    if (second->u_row[0] >= 0) {
        moray_layout_column_name(layout, ocp, x, second->u_end[0] + 1, name, sizeof name);
        CHECK(strcmp(name, "initial control u[1] of phase second") == 0, "a control at an end is named: %s", name);
        moray_layout_row_name(layout, ocp, x, second->u_row[0] + 1, name, sizeof name);
        CHECK(strcmp(name, "definition of initial control u[1] of phase second") == 0, "and its row: %s", name);
    }
    if (second->node[2].before >= 0) {
        moray_layout_row_name(layout, ocp, x, second->hold_row, name, sizeof name);
        CHECK(strstr(name, "hold of control u[1] of phase second at t = "), "a hold is named: %s", name);
    }
}

static void check_names_of_data(const struct layout *layout, const moray_ocp *ocp, const double *x)
{
    const struct sight *sight = layout->phase[1].sight;
    char name[160];
    if (!sight)
        return;
    CHECK(sight[0].interval == 1 && sight[1].interval == 0, "data stand in their intervals");
    moray_layout_column_name(layout, ocp, x, sight[1].x + 3, name, sizeof name);
    CHECK(strcmp(name, "control u[1] of phase second observed at t = 1.1") == 0, "what is seen is named: %s", name);
    moray_layout_row_name(layout, ocp, x, sight[2].row, name, sizeof name);
    CHECK(strcmp(name, "definition of state x[0] of phase second observed at t = 2.2") == 0, "so is its row: %s", name);
    moray_layout_row_name(layout, ocp, x, layout->events + 2 + 4, name, sizeof name); // after a missing one
    CHECK(strcmp(name, "residual y[1] of phase second at t = 2.2") == 0, "and a residual: %s", name);
    moray_layout_row_name(layout, ocp, x, layout->rows - 1, name, sizeof name);
    CHECK(strcmp(name, "sum of the observations of phase second") == 0, "and their sum: %s", name);
}

static void check_programme(const moray_ocp *ocp, moray_family family, int stages, unsigned long long seed)
{
    struct mesh mesh[2];
    struct transcription *t;
    moray_map map;
    const struct method method = {family, stages},
                        other = {family == MORAY_RADAU ? MORAY_GAUSS : MORAY_RADAU, stages}; // a scheme for each phase
    CHECK(!moray_failed(moray_mesh_uniform(&mesh[0], 3, method)) &&
              !moray_failed(moray_mesh_uniform(&mesh[1], 2, other)),
          "mesh");
    mesh[0].edge[1] = 0.2; // unequal intervals, of unequal order
    mesh[0].stages[2] = stages + 1;
    mesh[1].t0 = 0.6, mesh[1].tf = 2.9; // where data are looked for
    moray_status status = moray_transcription_new(&t, ocp, mesh);
    if (!CHECK(!moray_failed(status), "family %d, %d stages: transcribed: %s", family, stages, status.text))
        return;
    CHECK_OK(programme_as_map(&t->nlp, &map), "programme as a map");
    CHECK(strictly_sorted(t->nlp.jac_row, t->nlp.jac_col, t->nlp.nnz_jac) &&
              strictly_sorted(t->nlp.hess_row, t->nlp.hess_col, t->nlp.nnz_hess),
          "no entry stands twice");
    double *x = calloc((size_t)map.n_in, sizeof *x), *weight = calloc((size_t)map.n_out, sizeof *weight);
    for (int j = 0; j < map.n_in; j++)
        x[j] = tap_random(&seed, 0.2, 1);
    if (t->layout.phase[1].sight)
        x[t->layout.phase[1].t0] = 0.7, x[t->layout.phase[1].tf] = 2.8;
    for (int i = 0; i < map.n_out; i++)
        weight[i] = tap_random(&seed, -1, 1);
    moray_derivative_report report;
    CHECK_OK(moray_check_derivatives(&map, x, weight, &report), "checked");
    CHECK(report.jacobian_error < 1e-9, "family %d, %d stages: Jacobian %.1e (row %d, column %d)", family, stages,
          report.jacobian_error, report.jacobian_row, report.jacobian_col);
    CHECK(report.hessian_error < 1e-9, "family %d, %d stages: Hessian %.1e (row %d, column %d: %g, %g)", family, stages,
          report.hessian_error, report.hessian_row, report.hessian_col, report.hessian_given, report.hessian_reference);
    char name[160];
    moray_layout_column_name(&t->layout, ocp, x, t->layout.columns - 1, name, sizeof name);
    CHECK(strcmp(name, "parameter s[1]") == 0, "the last column is named: %s", name);
    moray_layout_row_name(&t->layout, ocp, x, t->layout.phase[1].interval[1].defect + 1, name, sizeof name);
    CHECK(strstr(name, "defect of state x[1] of phase second at t = "), "a defect is named: %s", name);
    moray_layout_row_name(&t->layout, ocp, x, t->layout.events + 1, name, sizeof name);
    CHECK(strcmp(name, "event e[1]") == 0, "the last event is named: %s", name);
    check_names(&t->layout, ocp, x);
    check_names_of_data(&t->layout, ocp, x);
    free(x);
    free(weight);
    moray_pattern_free(&map.jac);
    moray_pattern_free(&map.hess);
    moray_transcription_free(t);
    moray_mesh_free(&mesh[0]);
    moray_mesh_free(&mesh[1]);
}

int main(void)
{
    moray_ocp *free_start, *fixed_start, *with_controls, *holding, *with_data;
    CHECK_OK(make_problem(&free_start, moray_between(0, 0.4), false, false, false), "a problem with free times");
    CHECK_OK(make_problem(&fixed_start, moray_fixed(0.25), false, false, false), "a problem with a fixed start");
    CHECK_OK(make_problem(&with_controls, moray_between(0, 0.4), true, false, false), "whose endpoint reads controls");
    CHECK_OK(make_problem(&holding, moray_between(0, 0.4), true, true, false), "that holds one");
    CHECK_OK(make_problem(&with_data, moray_between(0, 0.4), false, false, true), "with data that move over its mesh");
    for (int stages = 1; stages <= 4; stages++)
        for (int family = 0; family < 3; family++)
            if (family != MORAY_LOBATTO || stages > 1) {
                check_programme(free_start, (moray_family)family, stages, 7u + (unsigned)stages);
                check_programme(fixed_start, (moray_family)family, stages, 70u + (unsigned)stages);
                check_programme(with_controls, (moray_family)family, stages, 700u + (unsigned)stages);
                check_programme(with_data, (moray_family)family, stages, 77u + (unsigned)stages);
                if (family != MORAY_LOBATTO)
                    check_programme(holding, (moray_family)family, stages, 7000u + (unsigned)stages);
            }
    moray_ocp_free(free_start);
    moray_ocp_free(fixed_start);
    moray_ocp_free(with_controls);
    moray_ocp_free(holding);
    moray_ocp_free(with_data);
    return tap_done();
}
