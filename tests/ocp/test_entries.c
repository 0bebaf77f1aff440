// SPDX-License-Identifier: MIT
//
// Names of all variables and constraints, from where the layout has them: of phases with controls at the ends, free
// times between which there is a row, held controls and data that move.
#include "tap.h"

#include <stdlib.h>
#include <string.h>

#include "moray/ocp.h"
#include "ocp/names.h"
#include "ocp/solution.h"

enum { phases = 2, parameters = 2, events = 2, name_size = 200 };
static const int nx[phases] = {2, 3}, nu[phases] = {2, 1}, nc[phases] = {1, 2}, nq[phases] = {2, 1};

static void zero(const moray_node *at, moray_rates *out, const void *data)
{
    (void)at, (void)out, (void)data;
}

static void see(const moray_node *at, moray_num *y, const void *data)
{
    (void)data;
    y[0] = at->x[0];
}

static void close(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase[0].tf - at->phase[0].t0;
}

static moray_solution *solve(moray_ocp **ocp)
{
    static const double time[] = {1.2, 1.5}, value[] = {0, 0};
    static const bool held[] = {false, true};
    const moray_bounds any[3] = {moray_free(), moray_free(), moray_free()};
    moray_phase_spec phase[phases];
    for (int p = 0; p < phases; p++)
        phase[p] = (moray_phase_spec){.name = p ? "back" : "out",
                                      .nx = nx[p],
                                      .nu = nu[p],
                                      .nc = nc[p],
                                      .nq = nq[p],
                                      .continuous = zero,
                                      .t0 = moray_between(0, 1),
                                      .tf = moray_between(1.5, 3),
                                      .duration = moray_between(1, 2),
                                      .intervals = 2,
                                      .c = {any, nc[p]},
                                      .end_controls = true};
    phase[0].held = held;
    phase[1].observed = (moray_observations){.n = 2, .ny = 1, .time = time, .value = value, .observe = see};
    moray_settings settings = moray_settings_default();
    moray_solution *solution = NULL;
    settings.scheme = "gauss2";
    settings.max_refinements = 0;
    CHECK_OK(moray_ocp_new(ocp, &(moray_ocp_spec){.phases = phases,
                                                  .phase = phase,
                                                  .ns = parameters,
                                                  .ne = events,
                                                  .s = {any, parameters},
                                                  .e = {any, events},
                                                  .endpoint = close}),
             "a problem");
    CHECK_OK(moray_solve(*ocp, &settings, NULL, &solution), "solved");
    return solution;
}

// A name is what the entry is, of which phase, and when where there is a time.
static void check(const moray_solution *solution, bool row, int entry, const char *what, int index, int p, double time)
{
    const struct transcription *t = solution->transcription;
    char got[name_size], want[name_size];
    int n = snprintf(want, sizeof want, index < 0 ? "%s" : "%s[%d]", what, index);
    if (p >= 0)
        n += snprintf(want + n, sizeof want - (size_t)n, " of phase %s", p ? "back" : "out");
    if (!isnan(time))
        snprintf(want + n, sizeof want - (size_t)n, " at t = %.6g", time);
    (row ? moray_layout_row_name : moray_layout_column_name)(&t->layout, t->ocp, solution->iterate.x, entry, got,
                                                             sizeof got);
    CHECK(strcmp(got, want) == 0, "%s %d is the %s, expected %s", row ? "row" : "column", entry, got, want);
}

static void check_node(const moray_solution *solution, int p, int n)
{
    const struct transcription *t = solution->transcription;
    const struct node *node = &t->layout.phase[p].node[n];
    const double time = moray_layout_time(&t->layout, t->ocp, solution->iterate.x, p, node->tau);
    for (int r = 0; r < nx[p]; r++)
        check(solution, false, node->x + r, "state x", r, p, time);
    for (int r = 0; r < nu[p] && node->collocated; r++)
        check(solution, false, node->x + nx[p] + r, "control u", r, p, time);
    for (int r = 0; r < nc[p] && node->collocated; r++)
        check(solution, true, node->path + r, "path constraint c", r, p, time);
    if (node->before >= 0 && p == 0)
        check(solution, true, node->hold, "hold of control u", 1, p, time);
}

static void check_defects(const moray_solution *solution, int p)
{
    const struct transcription *t = solution->transcription;
    const struct phase_layout *layout = &t->layout.phase[p];
    for (int k = 0; k < layout->mesh.intervals; k++)
        for (int j = 1; j < layout->interval[k].scheme->points; j++) {
            const double tau = layout->node[layout->interval[k].first + j].tau,
                         time = moray_layout_time(&t->layout, t->ocp, solution->iterate.x, p, tau);
            for (int r = 0; r < nx[p]; r++)
                check(solution, true, layout->interval[k].defect + (j - 1) * nx[p] + r, "defect of state x", r, p,
                      time);
        }
}

static void check_ends(const moray_solution *solution, int p)
{
    static const char *const control[] = {"initial control u", "final control u"},
                             *const defined[] = {"definition of initial control u", "definition of final control u"};
    const struct phase_layout *layout = &solution->transcription->layout.phase[p];
    check(solution, false, layout->t0, "initial time", -1, p, NAN);
    check(solution, false, layout->tf, "final time", -1, p, NAN);
    check(solution, true, layout->length_row, "length", -1, p, NAN);
    for (int m = 0; m < nq[p]; m++) {
        check(solution, false, layout->q + m, "integral q", m, p, NAN);
        check(solution, true, layout->integral_row + m, "definition of integral q", m, p, NAN);
    }
    for (int end = 0; end < 2; end++)
        for (int r = 0; r < nu[p]; r++) {
            check(solution, false, layout->u_end[end] + r, control[end], r, p, NAN);
            check(solution, true, layout->u_row[end] + r, defined[end], r, p, NAN);
        }
}

// What data of the second phase see, whose time is a datum.
static void check_sights(const moray_solution *solution)
{
    static const char *const wanted[] = {"state x[%d] of phase back observed at t = %g",
                                         "control u[%d] of phase back observed at t = %g",
                                         "definition of state x[%d] of phase back observed at t = %g",
                                         "definition of control u[%d] of phase back observed at t = %g"};
    const struct phase_layout *layout = &solution->transcription->layout.phase[1];
    for (int k = 0; k < 2; k++)
        for (int i = 0; i < nx[1] + nu[1]; i++)
            for (int row = 0; row < 2; row++) {
                char want[name_size];
                const bool control = i >= nx[1];
                snprintf(want, sizeof want, wanted[2 * row + control], control ? i - nx[1] : i, k ? 1.5 : 1.2);
                const int first = row ? layout->sight[k].row : layout->sight[k].x;
                check(solution, row, first + i, want, -1, -1, NAN);
            }
}

int main(void)
{
    moray_ocp *ocp;
    moray_solution *solution = solve(&ocp);
    if (!solution)
        return 1;
    const struct layout *layout = &solution->transcription->layout;
    for (int p = 0; p < phases; p++) {
        for (int n = 0; n < layout->phase[p].nodes; n++)
            check_node(solution, p, n);
        check_defects(solution, p);
        check_ends(solution, p);
    }
    check_sights(solution);
    for (int i = 0; i < parameters; i++)
        check(solution, false, layout->s + i, "parameter s", i, -1, NAN);
    for (int i = 0; i < events; i++)
        check(solution, true, layout->events + i, "event e", i, -1, NAN);
    moray_solution_free(solution);
    moray_ocp_free(ocp);
    return tap_done();
}
