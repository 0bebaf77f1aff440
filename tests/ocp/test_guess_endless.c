// SPDX-License-Identifier: MIT
//
// Guesses of final times that nothing bounds: two phases in turn, of a state that always goes 2 a unit of time, on ways
// of 10 and of 100.
#include "tap.h"

#include <stdlib.h>

#include "moray/ocp.h"
#include "ocp/solution.h"

static void go_on(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = 0 * at->u[0];
    out->f[1] = 2;
}

static void end_somewhere(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase[0].tf;
}

static moray_solution *begin_ways(moray_ocp **ocp, moray_bounds tf, moray_bounds duration)
{
    const moray_bounds u[] = {{-1, 1}}, x[3][2] = {{{-MORAY_INFINITY, MORAY_INFINITY}, {0, 0}},
                                                   {{-MORAY_INFINITY, MORAY_INFINITY}, {10, 10}},
                                                   {{-MORAY_INFINITY, MORAY_INFINITY}, {110, 110}}};
    moray_phase_spec phase[2];
    moray_solution *solution = NULL;
    moray_settings settings = moray_settings_default();
    settings.max_iterations = 0;
    settings.intervals = 3;
    for (int p = 0; p < 2; p++)
        phase[p] = (moray_phase_spec){.nx = 2,
                                      .nu = 1,
                                      .continuous = go_on,
                                      .t0 = p ? moray_at_least(0) : moray_fixed(0),
                                      .tf = tf,
                                      .duration = duration,
                                      .x0 = {x[p], 2},
                                      .xf = {x[p + 1], 2},
                                      .u = {u, 1}};
    CHECK_OK(moray_ocp_new(ocp, &(moray_ocp_spec){.phases = 2, .phase = phase, .endpoint = end_somewhere}), "ways");
    CHECK_OK(moray_solve(*ocp, &settings, NULL, &solution), "begun");
    return solution;
}

static void check_ways(struct transcription *t, const moray_guess *guess, const double times[2][2], const char *what)
{
    double *x = calloc((size_t)t->nlp.n, sizeof *x), t0, tf;
    CHECK_OK(moray_fill_guess(t, guess, x), what);
    for (int p = 0; p < 2; p++) {
        moray_layout_span(&t->layout, t->ocp, x, p, &t0, &tf);
        CHECK(fabs(t0 - times[p][0]) < 1e-9 && fabs(tf - times[p][1]) < 1e-9, "%s: from %g to %g", what, t0, tf);
    }
    free(x);
}

static void test_ways(void)
{
    // The first of the fourth roots of powers of ten that is as long as the way takes.
    const double first = pow(10, 0.75), second = pow(10, 1.75), long_ways[2][2] = {{0, first}, {first, first + second}};
    const double of_samples[2][2] = {{0, 6}, {7, 9}}, of_durations[2][2] = {{0, 2.5}, {2.5, 5}};
    const double jump[] = {0, 6}, later[] = {7, 9}, nowhere[4] = {0}, idle[2] = {0};
    const moray_samples tables[] = {{2, jump, nowhere, idle}, {2, later, nowhere, idle}};
    const moray_samples half[] = {{2, jump, nowhere, idle}, {0}};
    const double half_sampled[2][2] = {{0, 6}, {6, 6 + second}};
    for (int k = 0; k < 2; k++) {
        moray_ocp *ocp;
        moray_solution *solution = begin_ways(&ocp, (moray_bounds){0, k ? 1e15 : MORAY_INFINITY}, (moray_bounds){0, 0});
        struct transcription *t = solution->transcription;
        check_ways(t, NULL, long_ways, "as long as it takes");
        check_ways(t, &(moray_guess){.phase = tables}, of_samples, "as samples say");
        check_ways(t, &(moray_guess){.phase = half}, half_sampled, "as those of one phase say");
        solution->iterate.x[t->layout.phase[0].tf] = 6;
        solution->iterate.x[t->layout.phase[1].t0] = 7, solution->iterate.x[t->layout.phase[1].tf] = 9;
        CHECK(moray_transcription_values(t, solution->iterate.x), "values");
        struct transcription *other;
        struct mesh meshes[2];
        for (int p = 0; p < 2; p++)
            CHECK_OK(moray_mesh_copy(&meshes[p], &t->layout.phase[p].mesh), "mesh");
        CHECK_OK(moray_transcription_new(&other, ocp, meshes), "another");
        check_ways(other, &(moray_guess){.from = solution}, of_samples, "as in a solution");
        moray_transcription_free(other);
        for (int p = 0; p < 2; p++)
            moray_mesh_free(&meshes[p]);
        moray_solution_free(solution);
        moray_ocp_free(ocp);
    }
    moray_ocp *ocp;
    moray_solution *solution = begin_ways(&ocp, moray_at_least(0), moray_between(2, 3));
    check_ways(solution->transcription, NULL, of_durations, "as durations say");
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

int main(void)
{
    test_ways();
    return tap_done();
}
