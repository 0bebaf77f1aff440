// SPDX-License-Identifier: MIT
//
// A solver that stalls where constraints hold has its best point, and nothing else is tried; where one of them does not
// hold it has failed, on whichever side of its bounds and wherever among the rows that is. Which of what is tried next
// helps, and what then is told.
#include "tap.h"

#include <string.h>
#include <tgmath.h>

#include "moray/ocp.h"

#include "ocp/solution.h"

enum { EVENTS = 3 };

// An event and how far it is off at the start, from where the first solves cannot go: nothing else is defined, once
// begun.
struct asked {
    int event;
    double off;
    int stalls;    // solves that do
    bool rigid;    // what stalls is not defined where the state ends elsewhere, either
    bool equation; // between states
    int begun;
};

static void follow(const moray_node *at, moray_rates *out, const void *data)
{
    const struct asked *asked = data;
    out->f[0] = at->u[0];
    out->c[0] = at->x[0] - (asked->equation ? sin(at->t) : 0);
}

static void ends(const moray_ends *at, moray_end_values *out, const void *data)
{
    const struct asked *asked = data;
    const bool stalls = asked->begun > 0 && asked->begun <= asked->stalls;
    bool elsewhere = asked->rigid && creal(at->phase[0].xf[0]) != 0;
    for (int i = 0; i < EVENTS; i++)
        elsewhere = elsewhere || creal(at->s[i]) != 0;
    out->objective = at->s[0] + 2 * at->s[1] + 3 * at->s[2] + 0 * at->phase[0].xf[0] + (stalls && elsewhere ? NAN : 0);
    for (int i = 0; i < EVENTS; i++)
        out->e[i] = at->s[i] + (i == asked->event ? asked->off : 0);
}

static bool watch(void *observer, const moray_progress *progress)
{
    struct asked *asked = observer;
    asked->begun += progress->iteration == 0;
    return true;
}

static moray_solution *solve(moray_ocp **ocp, struct asked *asked)
{
    const moray_bounds event = asked->off == 0 ? moray_between(-9, 9) : moray_fixed(0);
    const moray_bounds row = asked->equation ? moray_fixed(0) : moray_between(-9, 9);
    const moray_phase_spec phase = {.nx = 1,
                                    .nu = 1,
                                    .nc = 1,
                                    .continuous = follow,
                                    .tf = moray_fixed(1),
                                    .x0 = MORAY_BOUNDS(moray_fixed(0)),
                                    .c = MORAY_BOUNDS(row)};
    moray_settings settings = moray_settings_default();
    moray_solution *solution = NULL;
    settings.intervals = 3;
    settings.max_refinements = 0;
    settings.progress = watch;
    settings.observer = asked;
    CHECK_OK(moray_ocp_new(ocp, &(moray_ocp_spec){.phases = 1,
                                                  .phase = &phase,
                                                  .ns = EVENTS,
                                                  .ne = EVENTS,
                                                  .e = MORAY_BOUNDS(event, event, event),
                                                  .endpoint = ends,
                                                  .data = asked}),
             "problem");
    CHECK_OK(moray_solve(*ocp, &settings, NULL, &solution), "runs");
    return solution;
}

// Attempts that all stall, but the last where it is solved.
static void check(struct asked asked, int attempts, bool solved)
{
    moray_ocp *ocp = NULL;
    moray_solution *solution = solve(&ocp, &asked);
    int meshes;
    const moray_mesh_record *tried = moray_solution_history(solution, &meshes);
    CHECK(meshes == attempts, "event %d off by %g: %d attempts, expected %d", asked.event, asked.off, meshes, attempts);
    for (int k = 0; k < meshes; k++)
        CHECK(tried[k].outcome == (solved && k == meshes - 1 ? MORAY_NLP_SOLVED : MORAY_NLP_STALLED), "attempt %d: %s",
              k, moray_nlp_outcome_text(tried[k].outcome));
    CHECK(moray_is_solved(solution) == solved, "the result is that of the last where it is solved");
    CHECK_NEAR(moray_solution_objective(solution), solved ? -asked.off * (asked.event + 1) : 0, 1e-6, "objective");
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

// An equation between states is tried with Radau's scheme before all else.
static void test_scheme(int stalls)
{
    struct asked asked = {.off = 3, .stalls = stalls, .equation = true};
    moray_ocp *ocp = NULL;
    moray_solution *solution = solve(&ocp, &asked);
    const struct mesh *mesh = &solution->transcription->layout.phase[0].mesh;
    int meshes;
    const moray_mesh_record *tried = moray_solution_history(solution, &meshes);
    if (stalls == 1) {
        CHECK(meshes == 2 && tried[0].equation == 1 && tried[0].changed_to && !strcmp(tried[0].changed_to, "radau3"),
              "for its equation the first is left");
        CHECK(mesh->method.family == MORAY_RADAU && mesh->method.stages == 3 && mesh->intervals == 3,
              "on as many intervals");
    } else {
        CHECK(meshes == 4 && mesh->method.family == MORAY_LOBATTO, "where all stall the first is the result, of %d",
              meshes);
    }
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

int main(void)
{
    check((struct asked){.stalls = 9}, 1, false);
    for (int event = 0; event < EVENTS; event++)
        for (int side = -1; side <= 1; side += 2) {
            check((struct asked){.event = event, .off = 3 * side, .stalls = 9}, 3, false);
            check((struct asked){.event = event, .off = 2 * side, .stalls = 1}, 2, true);
            check((struct asked){.event = event, .off = 2 * side, .stalls = 2}, 3, true);
        }
    // A start that is not defined is no attempt.
    check((struct asked){.off = 3, .stalls = 9, .rigid = true}, 2, false);
    check((struct asked){.off = 3, .stalls = 1, .equation = true}, 2, true);
    check((struct asked){.off = 3, .stalls = 3, .equation = true}, 4, true);
    test_scheme(1);
    test_scheme(9);
    return tap_done();
}
