// SPDX-License-Identifier: MIT
//
// Mesh after mesh where a limit jumps: the error of a mesh hangs on where its nodes fall, so that it rises and falls.
// When that ends, and of which mesh the solution is, by the history alone.
#include "tap.h"

#include <string.h>

#include "moray/ocp.h"
#include "ocp/solution.h"

enum { patience = 8 };
static const double least_fall = 0.9, margin = 0.98; // of the errors before, and of the mesh tolerance

struct task {
    double jump; // until then u is at most 1, then 2
    double rate; // at which f grows
    int calls;   // of first iterations, which are the meshes
    int halt_at; // 0: never
};

static void run(const moray_node *at, moray_rates *out, const void *data)
{
    const struct task *task = data;
    out->f[0] = at->u[0] * moray_exp(task->rate * at->t);
    out->c[0] = at->u[0] - (creal(at->t) < task->jump ? 1 : 2);
    out->g[0] = -at->u[0];
}

static void rest(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = at->u[0];
    out->g[0] = at->u[0] * at->u[0] + at->u[1] * at->u[1];
}

static void cost(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase[0].q[0] + at->phase[1].q[0] + at->s[0] * at->s[0];
}

static bool watch(void *observer, const moray_progress *progress)
{
    struct task *task = observer;
    task->calls += progress->iteration == 0;
    return task->calls != task->halt_at;
}

static moray_solution *solve(moray_ocp **ocp, struct task *task, const char *scheme, int refinements, int variables)
{
    static const moray_bounds zero = {0, 0}, u = {-5, 5}, c = {-MORAY_INFINITY, 0};
    const moray_phase_spec phase[] = {{.nx = 1,
                                       .nu = 1,
                                       .nc = 1,
                                       .nq = 1,
                                       .continuous = run,
                                       .tf = moray_fixed(1),
                                       .x0 = {&zero, 1},
                                       .u = {&u, 1},
                                       .c = {&c, 1},
                                       .scheme = scheme},
                                      {.nx = 1,
                                       .nu = 2,
                                       .nq = 1,
                                       .continuous = rest,
                                       .tf = moray_fixed(1),
                                       .x0 = {&zero, 1},
                                       .intervals = 1,
                                       .scheme = "radau3"}};
    moray_settings settings = moray_settings_default();
    moray_solution *solution = NULL;
    settings.intervals = 4;
    settings.max_refinements = refinements;
    settings.max_variables = variables;
    settings.progress = watch;
    settings.observer = task;
    CHECK_OK(
        moray_ocp_new(ocp, &(moray_ocp_spec){.phases = 2, .phase = phase, .ns = 1, .endpoint = cost, .data = task}),
        "a problem");
    CHECK_OK(moray_solve(*ocp, &settings, NULL, &solution), "runs");
    return solution;
}

static void drop(moray_solution *solution, moray_ocp *ocp)
{
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

// ---- What the history says ----

// How many meshes should have been tried, of those that were solved; and the best of them.
static int expected_meshes(const moray_mesh_record *history, int meshes, int refinements, int *best)
{
    int vain = 0;
    *best = 0;
    for (int k = 0; k < meshes; k++) {
        const double least = history[*best].error, error = history[k].error;
        vain = k == 0 || error < least_fall * least ? 0 : vain + 1;
        *best = error < least ? k : *best;
        if (k == refinements || error <= margin * 1e-6 || vain == patience)
            return k + 1;
    }
    return meshes + 1;
}

static double largest_error(const moray_solution *solution)
{
    double largest = 0;
    for (int p = 0; p < 2; p++) {
        double error[1000];
        CHECK_OK(moray_solution_interval_errors(solution, p, error), "errors");
        for (int k = 0; k < moray_solution_intervals(solution, p, NULL); k++)
            largest = tap_worse(largest, error[k]);
    }
    return largest;
}

static void check_best(const moray_solution *solution, const moray_mesh_record *best)
{
    CHECK(moray_solution_size(solution).variables == best->variables &&
              moray_solution_objective(solution) == best->objective,
          "the solution is of the mesh of least error");
    CHECK(fabs(largest_error(solution) - best->error) <= 1e-12 * best->error, "which it has: %g", best->error);
}

static const char *const schemes[] = {"radau2", "radau3", "gauss3", "lobatto4", "hermite-simpson"};
static const double jumps[] = {0.11, 0.23, 0.31, 0.37, 0.43, 0.57, 0.61, 0.71};

static void test_ends(void)
{
    int impatient = 0, good = 0, went_back = 0;
    for (int i = 0; i < 40; i++) {
        struct task task = {.jump = jumps[i % 8]};
        moray_ocp *ocp;
        int meshes, best;
        moray_solution *solution = solve(&ocp, &task, schemes[i / 8], 30, 0);
        const moray_mesh_record *history = moray_solution_history(solution, &meshes);
        const int expected = expected_meshes(history, meshes, 30, &best);
        CHECK(meshes == expected && task.calls == meshes, "%s, jump at %g: %d meshes, expected %d", schemes[i / 8],
              task.jump, meshes, expected);
        check_best(solution, &history[best]);
        good += history[meshes - 1].error < 1e-6;
        impatient += history[meshes - 1].error > 1e-6;
        went_back += best < meshes - 1;
        drop(solution, ocp);
    }
    CHECK(impatient > 5 && good > 5 && went_back > 5, "%d ended good, %d in vain, %d with one of before", good,
          impatient, went_back);
}

static void test_refinements(void)
{
    for (int refinements = 0; refinements < 9; refinements++) {
        struct task task = {.jump = 0.37};
        moray_ocp *ocp;
        int meshes, best;
        moray_solution *solution = solve(&ocp, &task, "radau3", refinements, 0);
        const moray_mesh_record *history = moray_solution_history(solution, &meshes);
        CHECK(meshes == refinements + 1, "%d meshes", meshes);
        expected_meshes(history, meshes, refinements, &best);
        check_best(solution, &history[best]);
        drop(solution, ocp);
    }
}

// Variables of a mesh are those of its points: as many with radau3 as a node but the first of a phase has.
static int counted(const moray_mesh_record *record)
{
    return 1 + 2 * (record->nodes - 1 - 4) + 3 * 3;
}

static void test_variables(double jump, double rate)
{
    struct task task = {.jump = jump, .rate = rate};
    moray_ocp *ocp;
    int meshes, fewer;
    moray_solution *solution = solve(&ocp, &task, "radau3", 5, 0), *limited;
    const moray_mesh_record *history = moray_solution_history(solution, &meshes);
    for (int k = 1, most = counted(&history[0]); k < meshes; k++) {
        if (counted(&history[k]) <= most)
            continue;
        most = counted(&history[k]);
        for (int less = 0; less < 2; less++) {
            moray_ocp *again;
            limited = solve(&again, &task, "radau3", 5, most - less);
            moray_solution_history(limited, &fewer);
            CHECK(less ? fewer == k : fewer > k, "%d variables, mesh %d has %d: %d are tried", most - less, k, most,
                  fewer);
            drop(limited, again);
        }
    }
    drop(solution, ocp);
}

static void test_halt(void)
{
    for (int halt_at = 1; halt_at < 5; halt_at++) {
        struct task task = {.jump = 0.37, .halt_at = halt_at};
        moray_ocp *ocp;
        int meshes, best;
        moray_solution *solution = solve(&ocp, &task, "radau3", 9, 0);
        const moray_mesh_record *history = moray_solution_history(solution, &meshes);
        CHECK(meshes == halt_at && moray_solution_info(solution)->outcome == MORAY_NLP_INTERRUPTED &&
                  history[meshes - 1].outcome == MORAY_NLP_INTERRUPTED,
              "stopped on mesh %d", meshes);
        CHECK(isnan(history[meshes - 1].error), "of which nothing is known");
        if (halt_at > 1) {
            expected_meshes(history, meshes - 1, 9, &best);
            check_best(solution, &history[best]);
            CHECK(history[best].outcome == MORAY_NLP_SOLVED, "as it was solved");
        }
        drop(solution, ocp);
    }
}

int main(void)
{
    test_ends();
    test_refinements();
    test_variables(0.37, 0);
    test_variables(2, 4); // more stages at the end than at the start
    test_halt();
    return tap_done();
}
