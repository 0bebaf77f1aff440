// SPDX-License-Identifier: MIT
//
// What a diagnosis tells of the meshes that were tried, word by word, for a history set by hand.
#include "tap.h"

#include <string.h>

#include "moray/ocp.h"

#include "ocp/solution.h"

enum { MOST = 4 };

static void first(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = at->u[0] - at->u[1];
    out->c[0] = at->x[0];
}

static void second(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = at->u[0];
    out->f[1] = at->u[1] + at->u[2];
    out->c[0] = at->x[0];
    out->c[1] = at->x[1];
}

static void total(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase[1].xf[0] * at->phase[1].xf[0];
}

static moray_solution *begin(moray_ocp **ocp)
{
    static const char *const one[] = {"rudder", "sail"}, *const two[] = {"left", "right", "brake"},
                             *const wall[] = {"wall"}, *const walls[] = {"quay", "pier"};
    const moray_bounds wide = moray_between(-99, 99);
    const moray_phase_spec phases[] = {{.name = "out",
                                        .nx = 1,
                                        .nu = 2,
                                        .nc = 1,
                                        .continuous = first,
                                        .tf = moray_fixed(1),
                                        .c = MORAY_BOUNDS(wide),
                                        .u_names = one,
                                        .c_names = wall},
                                       {.name = "back",
                                        .nx = 2,
                                        .nu = 3,
                                        .nc = 2,
                                        .continuous = second,
                                        .t0 = moray_fixed(1),
                                        .tf = moray_fixed(2),
                                        .c = MORAY_BOUNDS(wide, wide),
                                        .u_names = two,
                                        .c_names = walls}};
    moray_settings settings = moray_settings_default();
    moray_solution *solution = NULL;
    settings.intervals = 5;
    CHECK_OK(moray_ocp_new(ocp, &(moray_ocp_spec){.phases = 2, .phase = phases, .endpoint = total}), "a regatta");
    CHECK_OK(moray_solve(*ocp, &settings, NULL, &solution), "solved");
    solution->info.iterations = 17;
    return solution;
}

// The meshes; of the last the objective is the solution's, unless it is to differ.
static void check(moray_solution *solution, const moray_mesh_record *meshes, int n, bool last, const char *told)
{
    moray_mesh_record made[MOST], *kept = solution->history;
    const int count = solution->meshes;
    char text[diagnosis_size];
    memcpy(made, meshes, (size_t)n * sizeof *made);
    if (last)
        made[n - 1].objective = solution->iterate.objective;
    solution->history = made, solution->meshes = n;
    moray_diagnose(solution);
    snprintf(text, sizeof text,
             "solved after 17 iterations.\n%sNo constraint is violated by more than 1.0e-08 (scaled).\n", told);
    const char *said = moray_solution_diagnosis(solution);
    CHECK(!strncmp(said, text, strlen(text)), "%s ... expected %s", said, text);
    solution->history = kept, solution->meshes = count;
}

static void test_changes(moray_solution *solution)
{
    static const struct {
        moray_mesh_record mesh;
        const char *told;
    } cases[] = {
        {{.intervals = 12, .ringing = 1, .changed_to = "radau3"},
         "On 12 intervals the control rudder of phase out went to and fro from node to node, as on fewer: a singular "
         "arc, on which this scheme rings; changed to radau3.\n"},
        {{.intervals = 13, .ringing = 2, .changed_to = "gauss3"},
         "On 13 intervals the control sail of phase out went to and fro from node to node, as on fewer: a singular "
         "arc, on which this scheme rings; changed to gauss3.\n"},
        {{.intervals = 9, .ringing = 3, .changed_to = "radau3"},
         "On 9 intervals the control left of phase back went to and fro from node to node, as on fewer: a singular "
         "arc, on which this scheme rings; changed to radau3.\n"},
        {{.intervals = 9, .ringing = 5, .changed_to = "radau3"},
         "On 9 intervals the control brake of phase back went to and fro from node to node, as on fewer: a singular "
         "arc, on which this scheme rings; changed to radau3.\n"},
        {{.intervals = 8, .equation = 1, .changed_to = "radau3"},
         "The path constraint wall of phase out is an equation in which no control stands, of higher index, for which "
         "this scheme is not made; changed to radau3.\n"},
        {{.intervals = 8, .equation = 2, .changed_to = "radau3"},
         "The path constraint quay of phase back is an equation in which no control stands, of higher index, for which "
         "this scheme is not made; changed to radau3.\n"},
        {{.intervals = 8, .equation = 3, .changed_to = "radau3"},
         "The path constraint pier of phase back is an equation in which no control stands, of higher index, for which "
         "this scheme is not made; changed to radau3.\n"},
        {{.intervals = 31, .changed_to = "lobatto4"}, "On 31 intervals that did no better; back to lobatto4.\n"},
        {{.intervals = 31, .ringing = 0, .seen = 2}, ""},
        {{.intervals = 6, .dependences = 4},
         "At the solution of 6 intervals the functions depend on 4 more inputs or pairs of them than elsewhere; solved "
         "again with these.\n"},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        const moray_mesh_record meshes[] = {
            {.intervals = 5, .error = INFINITY}, cases[k].mesh, {.intervals = 20, .error = INFINITY}};
        check(solution, meshes + 1, 2, true, cases[k].told);
        check(solution, meshes, 3, true, cases[k].told);
    }
}

static void test_last(moray_solution *solution)
{
    const moray_mesh_record solved = {.intervals = 44, .objective = 7, .error = NAN, .outcome = MORAY_NLP_SOLVED};
    moray_mesh_record failed = solved, loose = solved;
    failed.outcome = MORAY_NLP_ITERATION_LIMIT;
    loose.outcome = MORAY_NLP_ACCEPTABLE;
    check(solution, &solved, 1, true, "");
    check(solution, &solved, 1, false,
          "The error did not fall any more with finer meshes, the last of 44 intervals; this is the best.\n");
    check(solution, &loose, 1, false,
          "The error did not fall any more with finer meshes, the last of 44 intervals; this is the best.\n");
    char told[200];
    snprintf(told, sizeof told, "A finer mesh of 44 intervals was not solved (%s); this is the best that was.\n",
             moray_nlp_outcome_text(MORAY_NLP_ITERATION_LIMIT));
    check(solution, &failed, 1, false, told);
}

// Two meshes, of errors and objectives, between one that tells nothing and the last, which is of none.
static void check_apart(moray_solution *solution, double error, double one, double other, bool apart)
{
    const moray_mesh_record meshes[] = {{.intervals = 10, .error = 0.9 * error, .objective = one},
                                        {.intervals = 14, .error = 1e-2, .objective = 1e6},
                                        {.intervals = 20, .error = error, .objective = other},
                                        {.intervals = 30, .error = NAN}};
    char told[200] = "";
    if (apart)
        snprintf(told, sizeof told, "The optima of 10 and 20 intervals differ, %.6g and %.6g: try other guesses.\n",
                 one, other);
    check(solution, meshes, 4, true, told);
}

static void test_disagreement(moray_solution *solution)
{
    for (int sign = -1; sign <= 1; sign += 2)
        for (int turned = 0; turned < 2; turned++) {
            const double one = 2 * sign, near = 2.2 * sign, far = 2.24 * sign;
            check_apart(solution, 9e-3, turned ? near : one, turned ? one : near, false);
            check_apart(solution, 9e-3, turned ? far : one, turned ? one : far, true);
            check_apart(solution, 2e-2, turned ? far : one, turned ? one : far, false);
            check_apart(solution, 9e-3, turned ? 0.5 * sign : -one, turned ? one : -0.5 * sign, true);
        }
    check_apart(solution, 9e-3, 0, 0, false);
    const double kept = solution->iterate.objective; // of the last mesh, with the one before
    const moray_mesh_record meshes[] = {{.intervals = 10, .error = 1e-3, .objective = 2},
                                        {.intervals = 20, .error = 1e-3}};
    solution->iterate.objective = 3;
    check(solution, meshes, 2, true, "The optima of 10 and 20 intervals differ, 2 and 3: try other guesses.\n");
    solution->iterate.objective = kept;
}

int main(void)
{
    moray_ocp *ocp = NULL;
    moray_solution *solution = begin(&ocp);
    test_changes(solution);
    test_last(solution);
    test_disagreement(solution);
    moray_solution_free(solution);
    moray_ocp_free(ocp);
    return tap_done();
}
