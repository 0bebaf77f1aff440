// SPDX-License-Identifier: MIT
//
// What the figures of a solve are drawn of: steps of the mesh, and iterations. The test stands in for who draws.
#include "tap.h"

#include <stdlib.h>
#include <stdint.h>
#include <string.h>

#include "moray/app/run.h"

// ---- Who draws -----------------------------------------------------------------------------------------------------

enum { CURVES = 8 };

typedef struct drawn {
    char name[40], title[100], x_label[40], label[CURVES][80];
    bool log_y;
    int n, points[CURVES];
    double *x[CURVES], *y[CURVES];
} drawn;

static drawn figures[2];
static int n_figures;

static double *copy(const double *values, int n)
{
    double *kept = malloc((size_t)n * sizeof *kept);
    memcpy(kept, values, (size_t)n * sizeof *kept);
    return kept;
}

moray_status moray_output_figure(moray_output *output, const moray_figure *figure)
{
    (void)output;
    drawn *d = &figures[n_figures++];
    *d = (drawn){.n = figure->n_curves, .log_y = figure->log_y};
    snprintf(d->name, sizeof d->name, "%s", figure->name);
    snprintf(d->title, sizeof d->title, "%s", figure->title);
    snprintf(d->x_label, sizeof d->x_label, "%s", figure->x_label);
    for (int k = 0; k < d->n; k++) {
        const moray_curve *curve = &figure->curves[k];
        snprintf(d->label[k], sizeof d->label[k], "%s", curve->label);
        d->points[k] = curve->n;
        d->x[k] = copy(curve->x, curve->n);
        d->y[k] = copy(curve->y, curve->n);
    }
    return moray_ok();
}

static void forget(void)
{
    for (int i = 0; i < n_figures; i++)
        for (int k = 0; k < figures[i].n; k++) {
            free(figures[i].x[k]);
            free(figures[i].y[k]);
        }
    n_figures = 0;
}

// ---- What is solved ------------------------------------------------------------------------------------------------

// A mass from rest to rest by way of a point, with a force that hinders it; either phase comes first.
static void move(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = at->x[1];
    out->f[1] = at->u[0] - csin(at->x[0]);
    out->g[0] = at->u[0] * at->u[0];
}

// data: which phase is the later one.
static void join(const moray_ends *at, moray_end_values *out, const void *data)
{
    const int late = *(const int *)data;
    out->objective = at->phase[0].q[0] + at->phase[1].q[0];
    for (int i = 0; i < 2; i++)
        out->e[i] = at->phase[1 - late].xf[i] - at->phase[late].x0[i];
}

static moray_solution *solve(moray_ocp **ocp, int refinements, const int *late)
{
    const moray_phase_spec phases[2] = {{.name = "late",
                                         .nx = 2,
                                         .nu = 1,
                                         .nq = 1,
                                         .continuous = move,
                                         .t0 = moray_fixed(1.5),
                                         .tf = moray_fixed(4),
                                         .xf = MORAY_BOUNDS(moray_fixed(2), moray_fixed(0))},
                                        {.name = "early",
                                         .nx = 2,
                                         .nu = 1,
                                         .nq = 1,
                                         .continuous = move,
                                         .t0 = moray_fixed(0.5),
                                         .tf = moray_fixed(1.5),
                                         .x0 = MORAY_BOUNDS(moray_fixed(0), moray_fixed(0))}};
    const moray_phase_spec phase[2] = {phases[*late], phases[1 - *late]};
    moray_settings settings = moray_settings_default();
    moray_solution *solution = NULL;
    settings.intervals = 5;
    settings.mesh_tolerance = 1e-6;
    settings.max_refinements = refinements;
    CHECK_OK(moray_ocp_new(ocp, &(moray_ocp_spec){.phases = 2,
                                                  .phase = phase,
                                                  .ne = 2,
                                                  .e = MORAY_BOUNDS(moray_fixed(0), moray_fixed(0)),
                                                  .endpoint = join,
                                                  .data = late}),
             "a problem");
    CHECK_OK(moray_solve(*ocp, &settings, NULL, &solution), "solved");
    return solution;
}

// ---- What must be drawn --------------------------------------------------------------------------------------------

static void check_mesh(const moray_solution *solution, const drawn *d, int late)
{
    int all = 0, wrong = 0;
    for (int p = 0; p < 2; p++) {
        const int n = moray_solution_intervals(solution, p, NULL);
        double *edge = malloc((size_t)(2 * n + 1) * sizeof *edge), *error = edge + n + 1;
        moray_solution_intervals(solution, p, edge);
        CHECK_OK(moray_solution_interval_errors(solution, p, error), "errors");
        CHECK(d->points[p] == 2 * n, "two points for each of %d intervals", n);
        for (int k = 0; k < 2 * n && k < d->points[p]; k++)
            wrong += d->x[p][k] != edge[k / 2 + k % 2] ||
                     (error[k / 2] > 0 ? d->y[p][k] != error[k / 2] : !isnan(d->y[p][k]));
        all += n;
        free(edge);
    }
    char title[100];
    snprintf(title, sizeof title, "The mesh: %d intervals and the error of each", all);
    CHECK(wrong == 0 && d->n == 3, "steps from edge to edge, as high as the error");
    CHECK(strcmp(d->title, title) == 0 && strcmp(d->x_label, "time [s]") == 0 && d->log_y, "%s", d->title);
    CHECK(strcmp(d->label[late], "late") == 0 && strcmp(d->label[1 - late], "early") == 0,
          "by the names of the phases");
    CHECK(d->points[2] == 2 && d->x[2][0] == 0.5 && d->x[2][1] == 4 && d->y[2][0] == 1e-4 && d->y[2][1] == 1e-4,
          "what is accepted, from the first to the last: %g to %g", d->x[2][0], d->x[2][1]);
}

static void check_convergence(const moray_solution *solution, const drawn *d, int curves)
{
    int n, wrong = 0, begun = 0;
    const moray_progress *at = moray_solution_iterations(solution, &n);
    CHECK(d->n == curves && d->points[0] == n && d->points[1] == n && d->log_y, "%d curves of %d points", d->n, n);
    for (int k = 0; k < n; k++) {
        const double want[] = {at[k].infeasibility, at[k].dual_infeasibility};
        for (int j = 0; j < 2; j++)
            wrong += d->x[j][k] != k || (want[j] > 0 ? d->y[j][k] != want[j] : !isnan(d->y[j][k]));
        begun += at[k].iteration == 0;
        if (d->n == 3)
            wrong +=
                d->x[2][k] != k || (at[k].iteration == 0 ? d->y[2][k] != fmax(want[0], want[1]) : !isnan(d->y[2][k]));
    }
    CHECK(wrong == 0, "iteration by iteration, of %d solves", begun);
    CHECK(curves == (begun > 1 ? 3 : 2), "starts are marked where there are several");
}

// Without a force a step of Newton's method is enough.
static void push(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = at->x[1];
    out->f[1] = at->u[0];
    out->g[0] = at->u[0] * at->u[0];
}

static void whole(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase[0].q[0];
}

// One phase needs no name; two points are a curve; of a solve that has not begun there is nothing to be seen.
static void test_one_phase(void)
{
    static const int most[] = {100, 100, 0}, points[] = {0, 2, 1};
    for (int k = 0; k < 3; k++) {
        const moray_phase_spec phase = {.name = "alone",
                                        .nx = 2,
                                        .nu = 1,
                                        .nq = 1,
                                        .continuous = k == 1 ? push : move,
                                        .tf = moray_fixed(2),
                                        .x0 = MORAY_BOUNDS(moray_fixed(0), moray_fixed(0)),
                                        .xf = MORAY_BOUNDS(moray_fixed(2), moray_fixed(0))};
        moray_settings settings = moray_settings_default();
        moray_solution *solution = NULL;
        moray_ocp *ocp;
        int n;
        settings.max_iterations = most[k];
        CHECK_OK(moray_ocp_new(&ocp, &(moray_ocp_spec){.phases = 1, .phase = &phase, .endpoint = whole}), "a problem");
        CHECK_OK(moray_solve(ocp, &settings, NULL, &solution), "solved");
        moray_solution_iterations(solution, &n);
        CHECK(k == 0 ? n > 2 : n == points[k], "%d points", n);
        CHECK_OK(moray_solution_draw(solution, 1e-4, "s", NULL), "drawn");
        CHECK(n_figures == (k < 2 ? 2 : 0), "%d figures", n_figures);
        if (k == 0)
            CHECK(figures[0].n == 2 && strcmp(figures[0].label[0], "error of an interval") == 0, "%s",
                  figures[0].label[0]);
        if (k < 2)
            check_convergence(solution, &figures[n_figures - 1], 2);
        forget();
        moray_solution_free(solution);
        moray_ocp_free(ocp);
    }
}

int main(void)
{
    test_one_phase();
    for (int k = 0; k < 4; k++) {
        const int refinements = k % 2 ? 3 : 0, late = k / 2;
        moray_ocp *ocp;
        moray_solution *solution = solve(&ocp, refinements, &late);
        CHECK_OK(moray_solution_draw(solution, 1e-4, "s", NULL), "drawn");
        CHECK(n_figures == 2 && strcmp(figures[0].name, "mesh") == 0 && strcmp(figures[1].name, "convergence") == 0,
              "%d figures", n_figures);
        check_mesh(solution, &figures[0], late);
        check_convergence(solution, &figures[1], refinements ? 3 : 2);
        forget();
        int n;
        moray_progress *at = (moray_progress *)(uintptr_t)moray_solution_iterations(solution, &n);
        for (int i = 1; i < n; i++) { // for whose zeros a logarithm has no place
            at[i].infeasibility = at[i].iteration == 1 ? 0 : at[i].infeasibility;
            at[i].dual_infeasibility = at[i].iteration == 2 ? 0 : at[i].dual_infeasibility;
        }
        CHECK_OK(moray_solution_draw(solution, 1e-4, "s", NULL), "drawn");
        check_convergence(solution, &figures[1], refinements ? 3 : 2);
        forget();
        CHECK_OK(moray_solution_draw(solution, 1e-4, NULL, NULL), "without a unit of time");
        CHECK(strcmp(figures[0].x_label, "time") == 0, "%s", figures[0].x_label);
        forget();
        moray_solution_free(solution);
        moray_ocp_free(ocp);
    }
    return tap_done();
}
