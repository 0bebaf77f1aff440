// SPDX-License-Identifier: MIT
//
// The fed-batch reactor of Park and Ramirez (AIChE J. 34, 1988): the most secreted protein after 15 h. At the guess,
// where there is plenty of glucose, protein is hardly made, so that slopes there say nothing of how much it comes to:
// neither the straight start nor the dynamics solve it in these scales, other scales do.
#include "tap.h"

#include <tgmath.h>

#include "moray/ocp.h"

enum { iterations = 400 };

// States: secreted and whole protein, cells, glucose, volume. Control: feed.
static void grow(const moray_node *at, moray_rates *out, const void *data)
{
    const moray_num secreted = at->x[0], whole = at->x[1], cells = at->x[2], glucose = at->x[3], volume = at->x[4];
    const moray_num thinned = at->u[0] / volume;
    const moray_num growth = 21.87 * glucose / ((glucose + 0.4) * (glucose + 62.5));
    (void)data;
    out->f[0] = 4.75 * growth / (0.12 + growth) * (whole - secreted) - thinned * secreted;
    out->f[1] = glucose * exp(-5 * glucose) / (0.1 + glucose) * cells - thinned * whole;
    out->f[2] = (growth - thinned) * cells;
    out->f[3] = -7.3 * growth * cells + thinned * (20 - glucose);
    out->f[4] = at->u[0];
}

static void harvest(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = -at->phase[0].xf[0] * at->phase[0].xf[4];
}

// Stops at the third iteration of the k-th solve.
struct stop {
    int solve, stop_in;
};

static bool observe(void *observer, const moray_progress *progress)
{
    struct stop *stop = observer;
    stop->solve += progress->iteration == 0;
    return !(stop->solve == stop->stop_in && progress->iteration == 3);
}

static moray_solution *solve(moray_ocp *ocp, int stop_in)
{
    struct stop stop = {0, stop_in};
    moray_solution *solution = NULL;
    moray_settings settings = moray_settings_default();
    settings.max_iterations = iterations;
    settings.max_refinements = 1;
    settings.progress = observe;
    settings.observer = &stop;
    CHECK_OK(moray_solve(ocp, &settings, NULL, &solution), "reactor");
    if (!solution)
        exit(1);
    return solution;
}

int main(void)
{
    const moray_bounds some = moray_at_least(0);
    const moray_phase_spec phase = {
        .nx = 5,
        .nu = 1,
        .continuous = grow,
        .tf = moray_fixed(15),
        .x = MORAY_BOUNDS(some, some, some, some, some),
        .x0 = MORAY_BOUNDS(moray_fixed(0), moray_fixed(0), moray_fixed(1), moray_fixed(5), moray_fixed(1)),
        .u = MORAY_BOUNDS(moray_between(0, 2))};
    const moray_ocp_spec spec = {.name = "reactor", .phases = 1, .phase = &phase, .endpoint = harvest};
    int meshes;
    moray_ocp *ocp = NULL;
    CHECK_OK(moray_ocp_new(&ocp, &spec), "reactor");
    moray_solution *solution = solve(ocp, 0);
    const moray_mesh_record *tried = moray_solution_history(solution, &meshes);
    CHECK(moray_solution_info(solution)->outcome == MORAY_NLP_SOLVED, "solved: %s", moray_solution_diagnosis(solution));
    CHECK(tried[0].outcome != MORAY_NLP_SOLVED && tried[1].outcome != MORAY_NLP_SOLVED &&
              tried[2].outcome == MORAY_NLP_SOLVED,
          "third of the attempts");
    CHECK(meshes == 4 && tried[3].nodes > tried[2].nodes, "and refined as often as asked for beside these: %d", meshes);
    CHECK(moray_solution_objective(solution) < -25, "a harvest of 25 or more: %.4g",
          -moray_solution_objective(solution));
    moray_solution_free(solution);
    solution = solve(ocp, 2);
    CHECK(moray_solution_info(solution)->outcome == MORAY_NLP_INTERRUPTED,
          "a second attempt that is interrupted is told");
    moray_solution_free(solution);
    moray_ocp_free(ocp);
    return tap_done();
}
