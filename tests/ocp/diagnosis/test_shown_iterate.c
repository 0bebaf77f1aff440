// SPDX-License-Identifier: MIT
//
// What a diagnosis shows of an iterate set by hand: the largest violation, what is at its bounds and where, what is
// furthest from the guess, word by word.
#include "tap.h"

#include <string.h>

#include "moray/ocp.h"

#include "ocp/names.h"
#include "ocp/solution.h"

enum { NODES = 10 }; // of radau3 on three intervals

static void first(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = 0 * at->u[0];
    out->c[0] = at->u[0] - 2 * at->x[0];
}

static void second(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = 0 * at->x[0];
    out->f[1] = 0 * at->u[1] + 0 * at->u[0];
}

static void total(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->s[0];
    out->e[0] = at->s[0] + at->s[1];
    out->e[1] = at->phase[1].xf[1];
}

static moray_solution *begin(moray_ocp **ocp)
{
    static const char *const speed[] = {"speed"}, *const places[] = {"east", "north"}, *const helm[] = {"helm"},
                             *const both[] = {"port", "starboard"}, *const wall[] = {"wall"},
                             *const mass[] = {"m", "k"}, *const goals[] = {"sum", "arrival"};
    const moray_phase_spec phases[] = {{.name = "out",
                                        .nx = 1,
                                        .nu = 1,
                                        .nc = 1,
                                        .continuous = first,
                                        .tf = moray_fixed(3),
                                        .x = MORAY_BOUNDS(moray_between(-4, 6)),
                                        .u = MORAY_BOUNDS(moray_at_least(-1)),
                                        .c = MORAY_BOUNDS(moray_between(-20, 20)),
                                        .x_names = speed,
                                        .u_names = helm,
                                        .c_names = wall},
                                       {.name = "back",
                                        .nx = 2,
                                        .nu = 2,
                                        .continuous = second,
                                        .t0 = moray_fixed(3),
                                        .tf = moray_between(4, 9),
                                        .x0 = MORAY_BOUNDS(moray_fixed(0), moray_free()),
                                        .u = MORAY_BOUNDS(moray_at_most(2), moray_between(-5, 5)),
                                        .x_names = places,
                                        .u_names = both}};
    moray_settings settings = moray_settings_default();
    moray_solution *solution = NULL;
    settings.max_iterations = 0;
    settings.intervals = 3;
    settings.scheme = "radau3";
    settings.own_scaling = false;
    CHECK_OK(moray_ocp_new(ocp, &(moray_ocp_spec){.phases = 2,
                                                  .phase = phases,
                                                  .ns = 2,
                                                  .s = MORAY_BOUNDS(moray_between(0, 8), moray_between(-8, 0)),
                                                  .s_names = mass,
                                                  .ne = 2,
                                                  .e = MORAY_BOUNDS(moray_at_most(3), moray_between(-7, 7)),
                                                  .e_names = goals,
                                                  .endpoint = total}),
             "a voyage");
    CHECK_OK(moray_solve(*ocp, &settings, NULL, &solution), "begun");
    solution->info.outcome = MORAY_NLP_INTERRUPTED;
    solution->info.iterations = 3;
    return solution;
}

// Inside all bounds, with nothing violated, where the guess is.
static double *settle(moray_solution *solution)
{
    const struct transcription *t = solution->transcription;
    double *x = solution->iterate.x;
    for (int p = 0; p < 2; p++)
        for (int n = 0; n < NODES; n++) {
            const struct node *node = &t->layout.phase[p].node[n];
            for (int i = 0; i < 1 + p; i++)
                x[node->x + i] = p && i == 0 ? 0 : 1 + p;
            for (int i = 0; i < 1 + p && node->collocated; i++)
                x[node->x + 1 + p + i] = 0.5;
        }
    x[t->layout.phase[1].tf] = 6;
    x[t->layout.s] = 4, x[t->layout.s + 1] = -4;
    memcpy(solution->guess, x, (size_t)t->nlp.n * sizeof *x);
    return x;
}

static double *entry(const moray_solution *solution, int p, int n, int i)
{
    return solution->iterate.x + solution->transcription->layout.phase[p].node[n].x + i;
}

static void check(moray_solution *solution, const char *violation, const char *active, const char *furthest)
{
    char text[1200];
    moray_transcription_jacobians(solution->transcription, solution->iterate.x);
    moray_diagnose(solution);
    snprintf(text, sizeof text,
             "interrupted after 3 iterations.\n%s\n%s\nFurthest from the guess: %s.\nTry: go on, with this solution as "
             "the guess.\n",
             violation, active, furthest);
    CHECK(!strcmp(moray_solution_diagnosis(solution), text), "%s expected %s", moray_solution_diagnosis(solution),
          text);
}

static const char none_violated[] = "No constraint is violated by more than 1.0e-08 (scaled).",
                  none_active[] = "No bound is active.";

// Time of a node of a phase of three intervals.
static double time_of(int p, int n)
{
    static const double radau[] = {0, 0.15505102572168219, 0.64494897427831781, 1};
    return 3 * p + 3 * ((n / 3 + radau[n % 3]) / 3);
}

static void test_active(moray_solution *solution)
{
    static const char nothing[] = "state speed of phase out at t = 0, 1 instead of 1 (scaled distance 0.0e+00)";
    char active[600], furthest[300];
    settle(solution);
    check(solution, none_violated, none_active, nothing);
    for (int n = 2; n < 9; n += 3) // at 2, 5 and 8
        *entry(solution, 0, n, 1) = -1;
    *entry(solution, 1, 4, 2) = 2;
    *entry(solution, 1, 7, 3) = -5, *entry(solution, 1, 9, 3) = 5;
    snprintf(active, sizeof active,
             "Active: control helm of phase out at its lower bound -1 on 3 of 9 nodes, t = %.6g .. %.6g.\n"
             "Active: control port of phase back at its upper bound 2 on 1 of 9 nodes, t = %.6g .. %.6g.\n"
             "Active: control starboard of phase back at its lower bound -5 on 1 of 9 nodes, t = %.6g .. %.6g.\n"
             "Active: control starboard of phase back at its upper bound 5 on 1 of 9 nodes, t = %.6g .. %.6g.",
             time_of(0, 2), time_of(0, 8), time_of(1, 4), time_of(1, 4), time_of(1, 7), time_of(1, 7), 6., 6.);
    snprintf(furthest, sizeof furthest,
             "control starboard of phase back at t = %.6g, -5 instead of 0.5 (scaled distance 5.5e+00)", time_of(1, 7));
    check(solution, none_violated, active, furthest);
    double *x = settle(solution);
    const struct layout *layout = &solution->transcription->layout;
    x[layout->s] = 7, x[layout->s + 1] = -4 + 1e-6;
    *entry(solution, 1, 9, 1) = 2;
    snprintf(active, sizeof active, "Active: event sum at its upper bound 3.");
    x[layout->s] = 7 - 0.9e-5;
    check(solution, none_violated, active, "parameter m, 7 instead of 4 (scaled distance 3.0e+00)");
    x[layout->s] = 7 - 1.2e-5;
    check(solution, none_violated, none_active, "parameter m, 7 instead of 4 (scaled distance 3.0e+00)");
    settle(solution);
    x[layout->s + 1] = 0, x[layout->s] = 3 - 2e-5, x[layout->phase[1].tf] = 9 - 1e-6;
    check(solution, none_violated,
          "Active: final time of phase back at its upper bound 9.\nActive: parameter k at its upper bound 0.",
          "parameter k, 0 instead of -4 (scaled distance 4.0e+00)");
}

static void test_violated(moray_solution *solution)
{
    char violation[300], furthest[300];
    const struct layout *layout = &solution->transcription->layout;
    double *x = settle(solution);
    x[layout->s] = 7.5;
    check(solution, "Largest violation: event sum, 3.5 where at most 3 is allowed (scaled 5.0e-01).",
          "Active: event sum at its upper bound 3.", "parameter m, 7.5 instead of 4 (scaled distance 3.5e+00)");
    settle(solution);
    *entry(solution, 0, 5, 1) = 25; // helm: the wall is at 25 - 2
    snprintf(violation, sizeof violation,
             "Largest violation: path constraint wall of phase out at t = %.6g, 23 where -20 to 20 is allowed (scaled "
             "3.0e+00).",
             time_of(0, 5));
    snprintf(furthest, sizeof furthest,
             "control helm of phase out at t = %.6g, 25 instead of 0.5 (scaled distance 2.4e+01)", time_of(0, 5));
    char active[300];
    snprintf(active, sizeof active,
             "Active: path constraint wall of phase out at its upper bound 20 on 1 of 9 nodes, t = %.6g .. %.6g.",
             time_of(0, 5), time_of(0, 5));
    check(solution, violation, active, furthest);
    settle(solution);
    x[layout->s] = 7 + 2e-8;
    check(solution, "Largest violation: event sum, 3 where at most 3 is allowed (scaled 2.0e-08).",
          "Active: event sum at its upper bound 3.", "parameter m, 7 instead of 4 (scaled distance 3.0e+00)");
    x[layout->s] = 7 + 0.5e-8;
    check(solution, none_violated, "Active: event sum at its upper bound 3.",
          "parameter m, 7 instead of 4 (scaled distance 3.0e+00)");
}

int main(void)
{
    moray_ocp *ocp = NULL;
    moray_solution *solution = begin(&ocp);
    test_active(solution);
    test_violated(solution);
    moray_solution_free(solution);
    moray_ocp_free(ocp);
    return tap_done();
}
