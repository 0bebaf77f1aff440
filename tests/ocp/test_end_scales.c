// SPDX-License-Identifier: MIT
//
// Scales of controls at ends that no node has, of held ones and of what moving data see; of an objective by its
// steepest column, wherever that is; and the guess that a solution keeps.
#include "tap.h"

#include <string.h>

#include "moray/ocp.h"
#include "ocp/guess_sizes.h"
#include "ocp/solution.h"

enum { nx = 2, nu = 3 };
static const double size_x[nx] = {4, 0.5}, size_u[nu] = {2, 16, 0.25};

static void go(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = at->u[0];
    out->f[1] = at->u[1] + at->u[2];
}

static void see(const moray_node *at, moray_num *seen, const void *data)
{
    (void)data;
    seen[0] = at->x[0] * at->u[1];
}

static void cost(const moray_ends *at, moray_end_values *out, const void *data)
{
    const double *slope = data;
    out->objective = slope[0] * at->phase[0].x0[0] + slope[1] * at->phase[1].xf[1] + slope[2] * at->s[0];
}

static moray_solution *begin(moray_ocp **ocp, const double slope[3])
{
    static const double time[] = {1.2, 1.5}, value[] = {0, 0};
    static const bool held[] = {false, true, false};
    const moray_bounds x[] = {{-4, 1}, {0, 0.5}}, u[] = {{-1, 2}, {-16, 3}, {0, 0.25}};
    moray_phase_spec phase[2];
    for (int p = 0; p < 2; p++)
        phase[p] = (moray_phase_spec){.nx = nx,
                                      .nu = nu,
                                      .continuous = go,
                                      .t0 = moray_between(0, 1),
                                      .tf = moray_between(1.5, 3),
                                      .intervals = 2,
                                      .x = MORAY_BOUNDS_OF(x),
                                      .u = MORAY_BOUNDS_OF(u),
                                      .end_controls = true};
    phase[0].held = held;
    phase[1].observed =
        (moray_observations){.n = 2, .ny = 1, .time = time, .value = value, .observe = see, .events_only = true};
    moray_settings settings = moray_settings_default();
    moray_solution *solution = NULL;
    settings.scheme = "gauss2";
    settings.max_iterations = 0;
    CHECK_OK(moray_ocp_new(ocp, &(moray_ocp_spec){.phases = 2,
                                                  .phase = phase,
                                                  .ns = 1,
                                                  .s = MORAY_BOUNDS(moray_between(-1, 8)),
                                                  .endpoint = cost,
                                                  .data = slope}),
             "a problem");
    CHECK_OK(moray_solve(*ocp, &settings, NULL, &solution), "begun");
    return solution;
}

// What stands at an entry is the inverse of the size.
static void check(const double *scale, int entry, double size, const char *what)
{
    CHECK(fabs(scale[entry] * size - 1) < 1e-12, "%s: %g", what, scale[entry]);
}

static void test_scales(const struct transcription *t)
{
    const double *of_x = t->nlp.x_scale, *of_g = t->nlp.g_scale;
    for (int p = 0; p < 2; p++) {
        const struct phase_layout *layout = &t->layout.phase[p];
        for (int end = 0; end < 2; end++)
            for (int r = 0; r < nu; r++) {
                check(of_x, layout->u_end[end] + r, size_u[r], "a control at an end");
                check(of_g, layout->u_row[end] + r, size_u[r], "and what defines it");
            }
    }
    const struct phase_layout *holding = &t->layout.phase[0], *seen = &t->layout.phase[1];
    int holds = 0;
    for (int n = 0; n < holding->nodes; n++)
        if (holding->node[n].before != absent) {
            check(of_g, holding->node[n].hold, size_u[1], "what holds a control");
            holds++;
        }
    CHECK(holds == 2, "once in each interval");
    for (int k = 0; k < 2; k++)
        for (int i = 0; i < nx + nu; i++) {
            const double size = i < nx ? size_x[i] : size_u[i - nx];
            check(of_x, seen->sight[k].x + i, size, "what data see");
            check(of_g, seen->sight[k].row + i, size, "and what defines it");
            CHECK(t->nlp.x_lower[seen->sight[k].x + i] == -MORAY_INFINITY &&
                      t->nlp.x_upper[seen->sight[k].x + i] == MORAY_INFINITY,
                  "which alone bounds it");
        }
}

static void test_objective(void)
{
    static const double slopes[][3] = {{-40, 1, 1}, {1, -3000, 1}, {1, 1, -7}, {1, 1, 7}};
    static const double steepest[] = {40 * 4, 3000 * 0.5, 7 * 8, 7 * 8};
    for (int k = 0; k < 4; k++) {
        moray_ocp *ocp;
        moray_solution *solution = begin(&ocp, slopes[k]);
        CHECK_NEAR(solution->transcription->nlp.f_scale * steepest[k], 1, 1e-12, "the steepest slope becomes 1");
        test_scales(solution->transcription);
        moray_solution_free(solution);
        moray_ocp_free(ocp);
    }
}

// ---- The guess ----

static void test_guess(void)
{
    static const double slope[] = {1, 1, 1};
    moray_ocp *ocp;
    moray_solution *solution = begin(&ocp, slope), *next = NULL;
    for (int j = 0; j < solution->transcription->nlp.n; j++)
        CHECK(solution->guess[j] == solution->iterate.x[j], "without an iteration the solution is its guess");
    moray_settings settings = solution->settings;
    settings.max_iterations = 30;
    CHECK_OK(moray_solve(ocp, &settings, NULL, &next), "solved");
    double moved = 0;
    for (int j = 0; j < next->transcription->nlp.n; j++) {
        CHECK(next->guess[j] == solution->guess[j], "which stays what it was");
        moved = tap_worse(moved, fabs(next->iterate.x[j] - next->guess[j]));
    }
    CHECK(moved > 1, "when the solution moves, by %g", moved);
    moray_solution_free(solution);
    moray_solution_free(next);
    moray_solution_free(NULL);
    moray_ocp_free(ocp);
}

int main(void)
{
    test_objective();
    test_guess();
    return tap_done();
}
