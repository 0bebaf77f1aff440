// SPDX-License-Identifier: MIT
//
// What a run shows of a solution, a fit and a certificate: its tables row by row and its summary, against the solution
// itself and numbers by hand.
#include "tracks.h"

#include <stdint.h>

enum { NS = 2, LONGEST = 20000 };

// ---- Numbers by hand -----------------------------------------------------------------------------------------------

static double value[NS] = {1.25, -0.5}, error[NS] = {0.125, INFINITY}, lower[NS] = {1, -3}, upper[NS] = {1.5, 2},
              covariance[NS * NS] = {0.015625, NAN, NAN, NAN};
static const char *const s_units[NS] = {"1/s", NULL}, *const q_units[] = {"N^2"};
static const moray_app_units with_integrals[] = {{.x = x_units, .u = u_units, .q = q_units}, {0}};
static const moray_app_constant constants[] = {{.key = "mass"}, {.key = "drag"}, {.key = "grip"}};

static void complete(rig *r)
{
    r->app.objective = "effort";
    r->app.s_units = s_units;
    r->app.units = with_integrals;
    r->app.constants = constants;
    r->app.n_constants = 3;
    for (int i = 0; i < 3; i++)
        r->run.constant[i] = 2.5 * (i + 1);
    r->run.common = moray_common_default();
    snprintf(r->run.common.scheme, sizeof r->run.common.scheme, "radau7");
    r->run.common.intervals = 17;
    r->run.mesh_tol = 3e-5;
    r->run.certified = true;
    r->run.certificate = (moray_certificate){.pass = true,
                                             .kkt = 1e-9,
                                             .mesh_error = 2e-7,
                                             .between_nodes = 3e-6,
                                             .resimulation = 4e-5,
                                             .derivatives = 5e-8,
                                             .directions = 6e-8,
                                             .hamiltonian = 7e-3,
                                             .gap = 8e-4,
                                             .curvature = 0.25,
                                             .composed = 9e-2,
                                             .untold = 0.5,
                                             .unseen = 0.75,
                                             .mesh_limit = 3e-5,
                                             .why = "of reasons"};
    r->run.fitted = true;
    r->run.fit = (moray_fit){.observations = 11,
                             .freedom = 4,
                             .sum = 0.625,
                             .variance = 0.0625,
                             .ns = NS,
                             .value = value,
                             .error = error,
                             .lower = lower,
                             .upper = upper,
                             .covariance = covariance,
                             .undetermined = 1,
                             .names = "s[1]"};
}

// ---- Tables --------------------------------------------------------------------------------------------------------

static void check_text(const moray_table_row *row, const char *label, double number, const char *unit)
{
    char text[40];
    snprintf(text, sizeof text, "%.9g", number);
    CHECK(strcmp(row->label, label) == 0 && row->text && strcmp(row->text, text) == 0, "%s: %s, not %s: %s", row->label,
          row->text ? row->text : "nothing", label, text);
    CHECK(unit ? row->unit && strcmp(row->unit, unit) == 0 : !row->unit, "in %s", row->unit ? row->unit : "nothing");
}

static void check_row(const moray_table_row *row, const char *label, const double *numbers, int n)
{
    CHECK(strcmp(row->label, label) == 0 && !row->text, "%s, not %s", row->label, label);
    for (int k = 0; k < n; k++)
        CHECK(row->value[k] == numbers[k] || (isnan(numbers[k]) && isnan(row->value[k])), "%s: %g, not %g", label,
              row->value[k], numbers[k]);
}

static void check_solution(const rig *r, const moray_table *table)
{
    const moray_solution *of = r->run.solution;
    const moray_table_row *row = table->rows;
    double t0, tf;
    CHECK(strcmp(table->title, "Solution") == 0 && table->n_columns == 1 && table->n_rows == 9, "%s of %d rows",
          table->title, table->n_rows);
    check_text(row++, "effort", moray_solution_objective(of), "J");
    check_text(row++, "s[0]", moray_solution_parameters(of)[0], "1/s");
    check_text(row++, "s[1]", moray_solution_parameters(of)[1], NULL);
    for (int p = 0; p < 2; p++) {
        static const char *const names[2][3] = {
            {"initial time of up/hill", "final time of up/hill", "integral q[0] of up/hill"},
            {"initial time of down", "final time of down", "integral q[0] of down"}};
        moray_solution_times(of, p, &t0, &tf);
        check_text(row++, names[p][0], t0, "h");
        check_text(row++, names[p][1], tf, "h");
        check_text(row++, names[p][2], moray_solution_integrals(of, p)[0], p ? NULL : "N^2");
    }
}

static void check_fit(const rig *r, const moray_table *table)
{
    const moray_table_row *row = table[0].rows;
    CHECK(strcmp(table[0].title, "Fit") == 0 && table[0].n_columns == 1 && table[0].n_rows == 5, "%s", table[0].title);
    check_row(row++, "observations", (double[]){11}, 1);
    check_row(row++, "free directions", (double[]){4}, 1);
    check_row(row++, "weighted sum of squares", (double[]){0.625}, 1);
    check_row(row++,
              r->app.known_variance ? "variance of an observation of weight 1, known"
                                    : "variance of an observation of weight 1",
              (double[]){0.0625}, 1);
    CHECK(strcmp(row->label, "not determined by the data") == 0 && strcmp(row->text, "s[1]") == 0, "%s", row->text);
    CHECK(strcmp(table[1].title, "Parameters, with intervals of 95 %") == 0 && table[1].n_columns == 4 &&
              table[1].n_rows == NS,
          "%s", table[1].title);
    check_row(&table[1].rows[0], "s[0]", (double[]){1.25, 0.125, 1, 1.5}, 4);
    check_row(&table[1].rows[1], "s[1]", (double[]){-0.5, NAN, NAN, NAN}, 4);
    CHECK(strcmp(table[1].rows[0].unit, "1/s") == 0 && !table[1].rows[1].unit, "with their units");
}

static void check_solver(const rig *r, const moray_table *table)
{
    const moray_nlp_info *info = moray_solution_info(r->run.solution);
    const moray_nlp_size size = moray_solution_size(r->run.solution);
    int meshes;
    const moray_mesh_record *mesh = moray_solution_history(r->run.solution, &meshes);
    const moray_table_row *row = table->rows;
    CHECK(strcmp(table->title, "Solver") == 0 && table->n_rows == 10, "%s", table->title);
    CHECK(strcmp(row[0].label, "outcome") == 0 && strcmp(row[0].text, "solved") == 0, "%s", row[0].text);
    CHECK(strcmp(row[1].label, "scheme") == 0 && strcmp(row[1].text, "radau7") == 0, "%s", row[1].text);
    check_row(&row[2], "meshes tried", (double[]){meshes}, 1);
    check_row(&row[3], "intervals of the last", (double[]){mesh[meshes - 1].intervals}, 1);
    check_row(&row[4], "variables", (double[]){size.variables}, 1);
    check_row(&row[5], "constraints", (double[]){size.constraints}, 1);
    check_row(&row[6], "iterations", (double[]){info->iterations}, 1);
    CHECK(strcmp(row[7].label, "linear solver") == 0 &&
              strcmp(row[7].text, moray_linear_solver_text(info->linear_solver)) == 0,
          "%s", row[7].text);
    check_row(&row[8], "solver time", &info->seconds, 1);
    check_row(&row[9], "of it in the problem's functions", &info->evaluation_seconds, 1);
}

static void check_meshes(const rig *r, const moray_table *table)
{
    static const char *const columns[] = {"intervals", "nodes", "error", "iterations", "time [s]"};
    int meshes;
    const moray_mesh_record *mesh = moray_solution_history(r->run.solution, &meshes);
    CHECK(strcmp(table->title, "Meshes") == 0 && table->n_columns == 5 && table->n_rows == meshes && meshes > 2,
          "%s: %d", table->title, meshes);
    for (int k = 0; k < 5; k++)
        CHECK(strcmp(table->columns[k], columns[k]) == 0, "%s", columns[k]);
    for (int k = 0; k < meshes; k++)
        check_row(&table->rows[k], moray_nlp_outcome_text(mesh[k].outcome),
                  (double[]){mesh[k].intervals, mesh[k].nodes, mesh[k].error, mesh[k].iterations, mesh[k].seconds}, 5);
}

static void check_certificate(const rig *r, const moray_table *table)
{
    const moray_certificate *c = &r->run.certificate;
    const moray_table_row *row = table->rows;
    CHECK(table->n_rows == 12 && table->n_columns == 2 && strcmp(table->columns[0], "found") == 0 &&
              strcmp(table->columns[1], "allowed") == 0,
          "%d rows", table->n_rows);
    check_row(row++, "optimality and feasibility (KKT)", (double[]){c->kkt, MORAY_LIMIT_KKT}, 2);
    check_row(row++, "gap held by slacks", (double[]){c->gap, MORAY_LIMIT_GAP}, 2);
    check_row(row++, "downward curvature", (double[]){c->curvature, MORAY_LIMIT_CURVATURE}, 2);
    check_row(row++, "error of the dynamics between nodes", (double[]){c->mesh_error, 3e-5}, 2);
    check_row(row++, "violation of limits between nodes", (double[]){c->between_nodes, 100 * 3e-5}, 2);
    check_row(row++, "effects that no node tells", (double[]){c->unseen, MORAY_LIMIT_UNSEEN}, 2);
    check_row(row++, "re-simulation of each interval", (double[]){c->resimulation, 100 * 3e-5}, 2);
    check_row(row++, "re-simulation of whole phases", (double[]){c->composed, NAN}, 2);
    check_row(row++, "derivatives against differences", (double[]){c->derivatives, MORAY_LIMIT_DERIVATIVES}, 2);
    check_row(row++, "share of them that none tells", (double[]){c->untold, NAN}, 2);
    check_row(row++, "the same along directions", (double[]){c->directions, MORAY_LIMIT_DIRECTIONS}, 2);
    check_row(row++, "drift of the Hamiltonian", (double[]){c->hamiltonian, NAN}, 2);
}

static void test_tables(rig *r)
{
    run_tables t;
    for (int pass = 0; pass < 2; pass++) {
        r->run.certificate.pass = pass;
        r->app.known_variance = pass;
        CHECK_OK(moray_run_tables_new(&t, &r->run), "tables");
        CHECK(t.n == 6, "%d tables", t.n);
        check_solution(r, &t.table[0]);
        check_fit(r, &t.table[1]);
        check_solver(r, &t.table[3]);
        check_meshes(r, &t.table[4]);
        check_certificate(r, &t.table[5]);
        CHECK(strcmp(t.table[5].title, pass ? "Certificate: pass" : "Certificate: FAIL") == 0, "%s", t.table[5].title);
        moray_run_tables_free(&t);
        CHECK(!t.rows && t.n == 0, "nothing is left");
    }
    rig bare = *r;
    bare.run.fitted = bare.run.certified = false;
    CHECK_OK(moray_run_tables_new(&t, &bare.run), "without fit and certificate");
    CHECK(t.n == 3 && strcmp(t.table[1].title, "Solver") == 0, "%d tables", t.n);
    moray_run_tables_free(&t);
}

// ---- The summary ---------------------------------------------------------------------------------------------------

static char shown[LONGEST];

// Of --json on standard output, without blanks.
static void show(rig *r)
{
    fflush(stdout);
    const int kept = dup(STDOUT_FILENO);
    if (!freopen(path, "w", stdout))
        return;
    const moray_status status = moray_run_show(&r->run);
    fflush(stdout);
    dup2(kept, STDOUT_FILENO);
    close(kept);
    CHECK_OK(status, "shown");
    FILE *file = fopen(path, "r");
    int n = 0;
    for (int c; (c = fgetc(file)) != EOF && n + 1 < LONGEST;)
        if (c != ' ' && c != '\n' && c != '\t')
            shown[n++] = (char)c;
    shown[n] = 0;
    fclose(file);
}

// With the fewest digits from 15 on that are the number.
static const char *number(double x)
{
    static char text[8][40];
    static int last;
    last = (last + 1) % 8;
    int digits = 15;
    do
        snprintf(text[last], sizeof text[last], "%.*g", digits, x);
    while (strtod(text[last], NULL) != x && ++digits < 18);
    return isfinite(x) ? text[last] : "null";
}

__attribute__((format(printf, 1, 2))) static void has(const char *format, ...)
{
    char wanted[1000];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(wanted, sizeof wanted, format, arguments);
    va_end(arguments);
    CHECK(strstr(shown, wanted), "%s", wanted);
}

static void check_parts(const rig *r)
{
    const double *s = moray_solution_parameters(r->run.solution);
    has("\"scheme\":\"radau7\",\"intervals\":17,\"constants\":{\"mass\":2.5,\"drag\":5,\"grip\":7.5},"
        "\"parameters\":{\"s[0]\":%s,\"s[1]\":%s},\"phases\":[",
        number(s[0]), number(s[1]));
    for (int p = 0; p < 2; p++) {
        double t0, tf;
        moray_solution_times(r->run.solution, p, &t0, &tf);
        has("{\"name\":\"%s\",\"t0\":%s,\"tf\":%s,\"integrals\":[%s]}", p ? "down" : "up/hill", number(t0), number(tf),
            number(moray_solution_integrals(r->run.solution, p)[0]));
    }
    int meshes;
    const moray_mesh_record *mesh = moray_solution_history(r->run.solution, &meshes);
    for (int k = 0; k < meshes; k++)
        has("{\"status\":\"%s\",\"intervals\":%d,\"nodes\":%d,\"nvar\":%d,\"iterations\":%d,\"time_s\":%s,"
            "\"mesh_error\":%s,\"objective\":%s}",
            moray_nlp_outcome_text(mesh[k].outcome), mesh[k].intervals, mesh[k].nodes, mesh[k].variables,
            mesh[k].iterations, number(mesh[k].seconds), number(mesh[k].error), number(mesh[k].objective));
    const moray_nlp_info *info = moray_solution_info(r->run.solution);
    const moray_nlp_size size = moray_solution_size(r->run.solution);
    has("\"solver\":{\"status\":\"solved\",\"iterations\":%d,\"objective\":%s,\"nvar\":%d,\"ncon\":%d,\"nnz_jac\":%d,"
        "\"nnz_hess\":%d,\"time_s\":%s,\"eval_time_s\":%s,",
        info->iterations, number(moray_solution_objective(r->run.solution)), size.variables, size.constraints,
        size.nnz_jac, size.nnz_hess, number(info->seconds), number(info->evaluation_seconds));
}

static void test_summary(rig *r)
{
    r->run.common.json = true;
    r->app.known_variance = false;
    show(r);
    check_parts(r);
    has("\"certificate\":{\"pass\":true,\"kkt\":%s,\"mesh_error\":%s,\"between_nodes\":%s,\"resimulation\":%s,"
        "\"derivatives\":%s,\"directions\":%s,\"hamiltonian\":%s,\"gap\":%s,",
        number(1e-9), number(2e-7), number(3e-6), number(4e-5), number(5e-8), number(6e-8), number(7e-3), number(8e-4));
    has("\"curvature\":0.25,\"composed\":%s,\"untold\":0.5,\"unseen\":0.75,\"mesh_limit\":%s,\"why\":\"ofreasons\"}",
        number(9e-2), number(3e-5));
    has("\"diagnosis\":null");
    has("\"fit\":{\"observations\":11,\"free_directions\":4,\"sum_of_squares\":0.625,\"variance\":0.0625,"
        "\"variance_known\":false,\"parameters\":{\"s[0]\":{\"value\":1.25,\"standard_error\":0.125,\"lower\":1,"
        "\"upper\":1.5},\"s[1]\":{\"value\":-0.5,\"standard_error\":null,\"lower\":null,\"upper\":null}},"
        "\"covariance\":[[0.015625,null],[null,null]],\"undetermined\":[\"s[1]\"]}");
    r->run.fitted = r->run.certified = false;
    show(r);
    has("\"fit\":null");
    has("\"certificate\":{\"pass\":false,\"kkt\":null,\"mesh_error\":null,");
    r->run.fitted = r->run.certified = true;
}

// Of each parameter what is its own, and of each mesh, the first of which was not solved.
static void test_own(rig *r)
{
    int meshes;
    moray_mesh_record *mesh = (moray_mesh_record *)(uintptr_t)moray_solution_history(r->run.solution, &meshes);
    const moray_nlp_outcome outcome = mesh[0].outcome;
    run_tables t;
    mesh[0].outcome = MORAY_NLP_INFEASIBLE;
    error[1] = 0.25;
    CHECK_OK(moray_run_tables_new(&t, &r->run), "tables");
    check_row(&t.table[2].rows[1], "s[1]", (double[]){-0.5, 0.25, -3, 2}, 4);
    check_meshes(r, &t.table[4]);
    moray_run_tables_free(&t);
    r->run.fit.ns = r->run.fit.undetermined = 0;
    CHECK_OK(moray_run_tables_new(&t, &r->run), "tables");
    CHECK(strcmp(t.table[1].rows[4].text, "none") == 0 && strcmp(t.table[2].title, "Solver") == 0, "%s, then %s",
          t.table[1].rows[4].text, t.table[2].title);
    moray_run_tables_free(&t);
    r->run.fit.ns = NS, r->run.fit.undetermined = 1;
    show(r);
    check_parts(r);
    has("\"s[1]\":{\"value\":-0.5,\"standard_error\":0.25,\"lower\":-3,\"upper\":2}");
    error[1] = INFINITY;
    mesh[0].outcome = outcome;
}

static void test_printed(rig *r)
{
    r->run.common.json = false;
    show(r);
    CHECK(strncmp(shown, "hillSolution", 12) == 0 || strncmp(shown, "hill", 4) == 0, "%.20s", shown);
    CHECK(strstr(shown, "Certificate:pass") && strstr(shown, "Parameters,withintervalsof95%"), "all its tables");
}

static void test_lines(const rig *r)
{
    char text[300], want[300];
    const moray_nlp_info *info = moray_solution_info(r->run.solution);
    const moray_nlp_size size = moray_solution_size(r->run.solution);
    moray_certificate_line(&r->run.certificate, text, sizeof text);
    CHECK(strcmp(text, "Certificate: pass (KKT 1.0e-09, mesh error 2.0e-07, its limit 3e-05, between nodes 3.0e-06, "
                       "re-simulation 4.0e-05, derivatives 5.0e-08)") == 0,
          "%s", text);
    moray_solver_line(r->run.solution, "radau7", 17, text, sizeof text);
    snprintf(want, sizeof want, "radau7, 17 intervals: solved in %d iterations, %.2f s (%d variables, %d constraints)",
             info->iterations, info->seconds, size.variables, size.constraints);
    CHECK(strncmp(text, want, strlen(want)) == 0, "%s, not %s", text, want);
}

// A name that is none of a file becomes one; without a folder it stands in the working directory.
static void test_kept(const rig *r)
{
    const moray_common common = moray_common_default();
    char kept[MORAY_PATH_SIZE];
    CHECK_OK(moray_iterate_keep(&common, "/tmp/moray a/b_c-d.9%", r->run.solution, kept), "kept");
    CHECK(strcmp(kept, "-tmp-moray-a-b_c-d.9-.iterate") == 0 && access(kept, R_OK) == 0, "%s", kept);
    unlink(kept);
    const moray_status status = moray_interruption(r->run.solution, kept);
    char says[5000];
    snprintf(says, sizeof says, "interrupted after %d iterations; to go on: --continue %s",
             moray_solution_info(r->run.solution)->iterations, kept);
    CHECK(status.code == MORAY_INTERRUPTED && strcmp(status.text, says) == 0, "%s", status.text);
    for (int k = 0; k < 4; k++)
        CHECK(moray_failed(moray_check_starts(k & 1 ? "a" : "", k & 2 ? "b" : "")) == (k == 3), "only one of both");
}

// Of observations that are in the objective, and of none that events alone see.
static void test_fitted(rig *r)
{
    for (int apart = 0; apart < 2; apart++) {
        phases[1].observed.events_only = apart;
        r->run.fitted = false;
        CHECK_OK(moray_run_fit(&r->run), "looked for");
        CHECK(r->run.fitted == !apart, "intervals of %s", apart ? "nothing" : "what is fitted");
        if (r->run.fitted)
            moray_fit_free(&r->run.fit);
    }
    phases[1].observed.events_only = false;
}

int main(void)
{
    rig r;
    close(mkstemp(path));
    rig_new(&r, 3);
    test_fitted(&r);
    complete(&r);
    test_tables(&r);
    test_summary(&r);
    test_own(&r);
    test_printed(&r);
    test_lines(&r);
    test_kept(&r);
    rig_free(&r);
    unlink(path);
    return tap_done();
}
