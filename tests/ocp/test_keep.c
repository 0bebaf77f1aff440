// SPDX-License-Identifier: MIT
//
// A solution of numbers that are all different, kept in a file and read back; and that file with one number, line or
// count changed.
#include "tap.h"

#include <stdlib.h>
#include <string.h>

#include "moray/ocp.h"
#include "ocp/solution.h"

static const char *const path = "test_keep.solution";

static void drift(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = at->u[0];
    out->c[0] = at->x[0];
    out->g[0] = at->u[0];
}

static void verdict(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase[0].xf[0] + at->s[0];
    out->e[0] = at->phase[1].x0[0];
}

static moray_ocp *build(void)
{
    const moray_phase_spec phase = {.name = "leg",
                                    .nx = 1,
                                    .nu = 1,
                                    .nc = 1,
                                    .nq = 1,
                                    .continuous = drift,
                                    .tf = moray_between(1, 2),
                                    .x = MORAY_BOUNDS(moray_between(-9, 9)),
                                    .u = MORAY_BOUNDS(moray_between(-9, 9)),
                                    .c = MORAY_BOUNDS(moray_between(-9, 9))};
    moray_phase_spec both[] = {phase, phase};
    both[1].name = "next";
    moray_ocp *ocp = NULL;
    CHECK_OK(moray_ocp_new(&ocp, &(moray_ocp_spec){.name = "kept",
                                                   .phases = 2,
                                                   .phase = both,
                                                   .ns = 1,
                                                   .s = MORAY_BOUNDS(moray_between(-9, 9)),
                                                   .ne = 1,
                                                   .e = MORAY_BOUNDS(moray_between(-9, 9)),
                                                   .endpoint = verdict}),
             "problem");
    return ocp;
}

// Every number another one.
static moray_solution *begin(const moray_ocp *ocp, const char *scheme)
{
    moray_solution *solution = NULL;
    moray_settings settings = moray_settings_default();
    settings.max_iterations = 0;
    settings.scheme = scheme;
    settings.intervals = 2;
    CHECK_OK(moray_solve(ocp, &settings, NULL, &solution), "begun");
    const moray_nlp *nlp = &solution->transcription->nlp;
    moray_iterate *it = &solution->iterate;
    for (int j = 0; j < nlp->n; j++) {
        it->x[j] = 1 + 1 / (j + 3.);
        it->z_lower[j] = 1 / (j + 100.);
        it->z_upper[j] = 1 / (j + 300.);
    }
    for (int i = 0; i < nlp->m; i++)
        it->lambda[i] = -1 / (i + 1000.);
    it->objective = 1 / 7.;
    solution->info.iterations = 17;
    solution->info.seconds = 1 / 9.;
    return solution;
}

static void test_back(const moray_ocp *ocp, const char *scheme, moray_nlp_outcome outcome)
{
    moray_solution *solution = begin(ocp, scheme), *loaded = NULL;
    const int n = solution->transcription->nlp.n, m = solution->transcription->nlp.m;
    solution->info.outcome = outcome;
    CHECK_OK(moray_solution_save(solution, path), "saved");
    CHECK_OK(moray_solution_load(&loaded, ocp, NULL, path), "loaded");
    const moray_iterate *was = &solution->iterate, *is = &loaded->iterate;
    const size_t columns = (size_t)n * sizeof(double), rows = (size_t)m * sizeof(double);
    CHECK(loaded->transcription->nlp.n == n && loaded->transcription->nlp.m == m, "%s: of the same mesh", scheme);
    CHECK(memcmp(was->x, is->x, columns) == 0 && memcmp(was->z_lower, is->z_lower, columns) == 0 &&
              memcmp(was->z_upper, is->z_upper, columns) == 0 && memcmp(was->lambda, is->lambda, rows) == 0,
          "%s: every number is back", scheme);
    CHECK(memcmp(loaded->guess, was->x, columns) == 0, "%s: and is what a solve would begin from", scheme);
    CHECK(is->objective == was->objective && loaded->info.iterations == 17 && loaded->info.seconds == 1 / 9. &&
              loaded->info.outcome == outcome,
          "%s: objective, iterations, seconds and outcome", scheme);
    for (int p = 0; p < 2; p++)
        CHECK(moray_mesh_equal(&solution->transcription->layout.phase[p].mesh,
                               &loaded->transcription->layout.phase[p].mesh),
              "%s: mesh of phase %d", scheme, p);
    moray_solution_free(loaded);
    moray_solution_free(solution);
}

// ---- Changed ----

enum { most_lines = 200, width = 200 };
static char lines[most_lines][width];
static int count;

static void read_lines(void)
{
    FILE *file = fopen(path, "r");
    for (count = 0; file && count < most_lines && fgets(lines[count], width, file);)
        count++;
    if (file)
        fclose(file);
}

// With one line (from 1) as the text, and so many of all.
static void check_refused(const moray_ocp *ocp, int line, const char *text, int of, const char *expected)
{
    FILE *file = fopen(path, "w");
    for (int k = 0; file && k < of; k++)
        fputs(k + 1 == line ? text : lines[k], file);
    if (file)
        fclose(file);
    moray_solution *solution = NULL;
    const moray_status status = moray_solution_load(&solution, ocp, NULL, path);
    CHECK(status.code == MORAY_INPUT && !solution && strstr(status.text, expected), "%s", status.text);
}

// Each of the numbers of a line in turn is none.
static void check_numbers(const moray_ocp *ocp, int line, int numbers)
{
    static const char *const none[] = {"nan", "inf", "-inf", "x"};
    char text[width], expected[width];
    snprintf(expected, sizeof expected, "line %d: a finite number expected", line);
    for (int k = 0; k < numbers; k++) {
        text[0] = 0;
        for (int i = 0; i < numbers; i++)
            snprintf(text + strlen(text), sizeof text - strlen(text), "%s ", i == k ? none[(line + k) % 4] : "1.5");
        strcat(text, "\n");
        check_refused(ocp, line, text, count, expected);
    }
    text[0] = 0;
    for (int i = 0; i <= numbers; i++)
        strcat(text, "1.5 ");
    strcat(text, "\n");
    snprintf(expected, sizeof expected, "line %d: %s expected", line, numbers == 1 ? "one number" : "fewer numbers");
    check_refused(ocp, line, text, count, expected);
}

static void test_changed(const moray_ocp *ocp)
{
    moray_solution *solution = begin(ocp, "radau3");
    const int n = solution->transcription->nlp.n, m = solution->transcription->nlp.m;
    CHECK_OK(moray_solution_save(solution, path), "saved");
    moray_solution_free(solution);
    read_lines();
    FILE *file = fopen(path, "w");
    for (int k = 0; file && k < count; k++)
        fprintf(file, "%s%s", k % 2 ? " \t" : "  ", lines[k]);
    if (file)
        fclose(file);
    CHECK_OK(moray_solution_load(&solution, ocp, NULL, path), "blanks before a line");
    moray_solution_free(solution);
    const int first = 11; // after a head of two lines, two phases of three, outcome and objective
    CHECK(count == first - 1 + n + m + 1, "%d lines: %d columns, %d rows", count, n, m);
    for (int line = 4; line <= 8; line += line == 5 ? 2 : 1)
        check_numbers(ocp, line, 2);
    for (int j = 0; j < n; j++)
        check_numbers(ocp, first + j, 3);
    for (int i = 0; i < m; i++)
        check_numbers(ocp, first + n + i, 1);
    char text[width], expected[width];
    for (int of = 3; of < count; of++) {
        snprintf(expected, sizeof expected, "line %d: more expected", of + 1);
        check_refused(ocp, 0, NULL, of, expected);
    }
    for (int wrong = 0; wrong < 3; wrong++) {
        const int has[] = {2 + (wrong == 0), 1 + (wrong == 1), 1 + (wrong == 2)};
        snprintf(text, sizeof text, "scheme radau phases %d parameters %d events %d\n", has[0], has[1], has[2]);
        snprintf(expected, sizeof expected, "has %d phases, %d parameters and %d events; problem kept has 2, 1 and 1",
                 has[0], has[1], has[2]);
        check_refused(ocp, 2, text, count, expected);
    }
    for (int wrong = 0; wrong < 4; wrong++) {
        snprintf(text, sizeof text, "phase %d %d %d %d intervals 2\n", 1 + (wrong == 0), 1 + (wrong == 1),
                 1 + (wrong == 2), 1 + (wrong == 3));
        snprintf(
            expected, sizeof expected,
            "a phase of %d states, %d controls, %d path constraints and %d integrals; phase next has 1, 1, 1 and 1",
            1 + (wrong == 0), 1 + (wrong == 1), 1 + (wrong == 2), 1 + (wrong == 3));
        check_refused(ocp, 6, text, count, expected);
    }
    for (int wrong = 0; wrong < 2; wrong++) {
        snprintf(text, sizeof text, "objective 1 variables %d constraints %d\n", n + (wrong == 0), m + (wrong == 1));
        snprintf(expected, sizeof expected, "has %d variables and %d constraints, the problem %d and %d on this mesh",
                 n + (wrong == 0), m + (wrong == 1), n, m);
        check_refused(ocp, 10, text, count, expected);
    }
    static const char *const names[] = {"kep", "kepts", "other"};
    for (int k = 0; k < 3; k++) {
        snprintf(text, sizeof text, "moray-solution 1 %s\n", names[k]);
        snprintf(expected, sizeof expected, "test_keep.solution: is of problem %s, not of kept", names[k]);
        check_refused(ocp, 1, text, count, expected);
    }
    check_refused(ocp, 1, "moray-solution 2 kept\n", count, "line 1: moray-solution 1 expected");
    check_refused(ocp, 2, "scheme radau phases 2 parameters 1 events 1 more\n", count,
                  "line 2: scheme, phases, parameters and events expected");
    check_refused(ocp, 3, "phase 1 1 1 1 intervals 2 gauss more\n", count, "line 3: phase nx nu nc nq intervals k");
    check_refused(ocp, 10, "objective 1 variables 1 constraints 1 more\n", count,
                  "line 10: objective, variables and constraints expected");
    check_refused(ocp, 10, "objective inf variables 1 constraints 1\n", count,
                  "line 10: objective, variables and constraints expected");
    check_refused(ocp, 9, "outcome 0 iterations 1 seconds nan\n", count, "line 9: outcome, iterations and seconds");
    check_refused(ocp, 5, "3 1.5\n", count, "line 5: 1 as the end of the last interval expected");
    check_refused(ocp, count, "end of it\n", count, "the end expected");
    check_refused(ocp, count, "end\nmore\n", count, "nothing after the end expected");
    check_refused(ocp, 9, "outcome -1 iterations 1 seconds 0\n", count, "line 9: outcome");
    check_refused(ocp, 9, "outcome 0 iterations 1 seconds 0 more\n", count, "line 9: outcome");
    check_refused(ocp, 3, "phase 1 1 1 1 intervals 0\n", count, "line 3: phase nx nu");
    check_refused(ocp, 3, "phase 1 1 1 1 intervals 1000001\n", count, "line 3: phase nx nu");
    check_refused(ocp, 3, "phase 1 1 1 1 intervals 2 euler\n", count, "line 3: phase nx nu");
    check_refused(ocp, 4, "3 0\n", count, "line 4: stages and a later end");
    check_refused(ocp, 5, "3 0.5\n", count, "line 5: stages and a later end");
}

int main(void)
{
    moray_ocp *ocp = build();
    static const char *const schemes[] = {"gauss1",    "radau1",        "radau3",         "lobatto2",
                                          "lobatto64", "radau3,gauss2", "lobatto3,radau2"};
    for (size_t k = 0; k < sizeof schemes / sizeof *schemes; k++)
        test_back(ocp, schemes[k], MORAY_NLP_ITERATION_LIMIT);
    test_changed(ocp);
    moray_ocp_free(ocp);
    remove(path);
    return tap_done();
}
