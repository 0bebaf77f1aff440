// SPDX-License-Identifier: MIT
//
// What is tried, and what is not, where a first mesh cannot be solved: too far to go in the time there is.
#include "tap.h"

#include <string.h>

#include "moray/ocp.h"

#include "ocp/solution.h"

static void walk(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = at->u[0] * at->s[0];
    out->g[0] = at->u[0] * at->u[0];
}

static void effort(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase[0].q[0] + at->phase[1].q[0];
    out->e[0] = at->phase[1].x0[0] - at->phase[0].xf[0];
}

static moray_ocp *new_problem(void)
{
    const moray_phase_spec phases[] = {{.nx = 1,
                                        .nu = 1,
                                        .nq = 1,
                                        .continuous = walk,
                                        .tf = moray_fixed(1),
                                        .x0 = MORAY_BOUNDS(moray_fixed(0)),
                                        .u = MORAY_BOUNDS(moray_between(-1, 1))},
                                       {.nx = 1,
                                        .nu = 1,
                                        .nq = 1,
                                        .continuous = walk,
                                        .t0 = moray_fixed(1),
                                        .tf = moray_fixed(2),
                                        .xf = MORAY_BOUNDS(moray_fixed(9)),
                                        .u = MORAY_BOUNDS(moray_between(-1, 1))}};
    moray_ocp *ocp = NULL;
    CHECK_OK(moray_ocp_new(&ocp, &(moray_ocp_spec){.phases = 2,
                                                   .phase = phases,
                                                   .ns = 1,
                                                   .s = MORAY_BOUNDS(moray_between(0.5, 1.5)),
                                                   .ne = 1,
                                                   .e = MORAY_BOUNDS(moray_fixed(0)),
                                                   .endpoint = effort}),
             "too far");
    return ocp;
}

// Stops the k-th solve at its second iteration.
struct stop {
    int solves, in;
};

static bool watch(void *observer, const moray_progress *progress)
{
    struct stop *stop = observer;
    stop->solves += progress->iteration == 0;
    return !(stop->solves == stop->in && progress->iteration == 2);
}

// `tried` solves in all, of which the last record is the result's, the first of the solves.
static void check(const moray_settings *asked, const moray_guess *guess, int stop_in, int tried, const char *what)
{
    moray_ocp *ocp = new_problem();
    moray_solution *solution = NULL;
    moray_settings settings = *asked;
    struct stop stop = {0, stop_in};
    int meshes;
    settings.progress = watch;
    settings.observer = &stop;
    settings.max_refinements = 3;
    settings.intervals = 4;
    CHECK_OK(moray_solve(ocp, &settings, guess, &solution), what);
    const moray_mesh_record *history = moray_solution_history(solution, &meshes), *last = &history[meshes - 1];
    const moray_nlp_info *info = moray_solution_info(solution);
    CHECK(meshes == tried, "%s: %d attempts, expected %d", what, meshes, tried);
    CHECK(!moray_is_solved(solution) && (info->outcome == MORAY_NLP_INTERRUPTED) == (stop_in > 0), "which fail: %s",
          moray_nlp_outcome_text(info->outcome));
    CHECK(last->iterations == info->iterations && last->objective == solution->iterate.objective,
          "the last record is of the result");
    CHECK(solution->settings.own_scaling == asked->own_scaling &&
              solution->settings.max_iterations == asked->max_iterations,
          "whose settings are those asked for");
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

// ---- A solve that runs out of iterations has failed, though its constraints hold ----

static void bowl(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = at->u[0];
}

static void least(const moray_ends *at, moray_end_values *out, const void *data)
{
    const moray_num x = at->phase[0].xf[0];
    (void)data;
    out->objective = x * x * x * x + (x - 3) * (x - 3);
}

static void test_feasible(void)
{
    const moray_phase_spec phase = {
        .nx = 1, .nu = 1, .nq = 1, .continuous = bowl, .tf = moray_fixed(1), .x0 = MORAY_BOUNDS(moray_fixed(0))};
    moray_settings settings = moray_settings_default();
    moray_ocp *ocp = NULL;
    moray_solution *solution = NULL;
    int meshes;
    settings.max_iterations = 2;
    CHECK_OK(moray_ocp_new(&ocp, &(moray_ocp_spec){.phases = 1, .phase = &phase, .endpoint = least}), "a bowl");
    CHECK_OK(moray_solve(ocp, &settings, NULL, &solution), "begun");
    double worst = 0;
    for (int i = 0; i < solution->transcription->nlp.m; i++)
        worst = tap_worse(worst, fabs(solution->iterate.g[i]));
    moray_solution_history(solution, &meshes);
    CHECK(moray_solution_info(solution)->outcome == MORAY_NLP_ITERATION_LIMIT && worst < 1e-9,
          "out of iterations where the dynamics hold to %.1e", worst);
    CHECK(meshes == 3, "is tried otherwise: %d attempts", meshes);
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

int main(void)
{
    const double time[] = {0, 1}, late[] = {1, 2}, x[] = {0, 1}, u[] = {1, 1}, s = 1;
    const moray_samples none[2] = {{0}, {0}}, both[2] = {{2, time, x, u}, {2, late, x, u}};
    const moray_samples second[2] = {{.n = 0}, {2, late, x, u}};
    moray_settings usual = moray_settings_default();
    usual.max_iterations = 60;
    check(&usual, NULL, 0, 3, "without a guess another start, then other scales");
    check(&usual, &(moray_guess){.s = &s}, 0, 3, "with one of parameters alone");
    check(&usual, &(moray_guess){.phase = none}, 0, 3, "with one of no samples");
    check(&usual, &(moray_guess){.phase = both}, 0, 1, "with one none");
    check(&usual, &(moray_guess){.phase = second}, 0, 1, "with one of a phase none");
    check(&usual, NULL, 1, 1, "none after an interruption");
    check(&usual, NULL, 2, 2, "none after one of the second");
    check(&usual, NULL, 3, 3, "nor of the third");
    moray_settings other = usual;
    other.max_iterations = 0;
    check(&other, NULL, 0, 1, "none without iterations");
    other = usual;
    other.own_scaling = false;
    check(&other, NULL, 0, 1, "none where scales are the solver's");
    other = usual;
    other.max_cpu_seconds = 1e-6;
    check(&other, NULL, 0, 1, "none without time");
    other.max_cpu_seconds = 1e3;
    check(&other, NULL, 0, 3, "with time for all of them all");
    test_feasible();
    return tap_done();
}
