// SPDX-License-Identifier: MIT
#include "run/fit.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

const char *moray_entry_name(const char *const *names, const char *letter, int i, char text[MORAY_ENTRY_SIZE])
{
    if (names)
        snprintf(text, MORAY_ENTRY_SIZE, "%s", names[i]);
    else
        snprintf(text, MORAY_ENTRY_SIZE, "%s[%d]", letter, i);
    return text;
}

const char *moray_phase_name(const moray_ocp_spec *spec, int p)
{
    return spec->phase[p].name ? spec->phase[p].name : "phase";
}

// ---- Tables --------------------------------------------------------------------------------------------------------

// "label", or "label of ascent" where there are several phases.
static const char *of_phase(const moray_ocp_spec *spec, const char *label, int p, char text[MORAY_ENTRY_SIZE])
{
    if (spec->phases > 1)
        snprintf(text, MORAY_ENTRY_SIZE, "%.30s of %.40s", label, moray_phase_name(spec, p));
    else
        snprintf(text, MORAY_ENTRY_SIZE, "%s", label);
    return text;
}

// With as many digits as a textbook's.
static void add_row(run_tables *t, int *n, const char *label, double value, const char *unit)
{
    struct run_text *text = &t->texts[*n];
    snprintf(text->label, sizeof text->label, "%s", label);
    snprintf(text->value, sizeof text->value, "%.9g", value);
    t->rows[*n] = (moray_table_row){.label = text->label, .text = text->value, .unit = unit};
    ++*n;
}

static int solution_rows(run_tables *t, const app_run *run)
{
    const moray_app *app = run->app;
    const moray_ocp_spec *spec = app->spec;
    char name[MORAY_ENTRY_SIZE], label[MORAY_ENTRY_SIZE];
    int n = 0;
    add_row(t, &n, app->objective ? app->objective : "objective", moray_solution_objective(run->solution),
            app->objective_unit);
    for (int i = 0; i < spec->ns; i++)
        add_row(t, &n, moray_entry_name(spec->s_names, "s", i, name), moray_solution_parameters(run->solution)[i],
                app->s_units ? app->s_units[i] : NULL);
    for (int p = 0; p < spec->phases; p++) {
        double t0, tf;
        const moray_app_units *units = app->units ? &app->units[p] : NULL;
        moray_solution_times(run->solution, p, &t0, &tf);
        add_row(t, &n, of_phase(spec, "initial time", p, label), t0, app->time_unit);
        add_row(t, &n, of_phase(spec, "final time", p, label), tf, app->time_unit);
        for (int m = 0; m < spec->phase[p].nq; m++)
            add_row(t, &n, of_phase(spec, moray_entry_name(NULL, "integral q", m, name), p, label),
                    moray_solution_integrals(run->solution, p)[m], units && units->q ? units->q[m] : NULL);
    }
    return n;
}

static int count_rows(const moray_ocp_spec *spec)
{
    int n = 1 + spec->ns;
    for (int p = 0; p < spec->phases; p++)
        n += 2 + spec->phase[p].nq;
    return n;
}

static int solver_rows(const app_run *run, moray_table_row *rows)
{
    const moray_nlp_info *info = moray_solution_info(run->solution);
    const moray_nlp_size size = moray_solution_size(run->solution);
    int meshes;
    const moray_mesh_record *mesh = moray_solution_history(run->solution, &meshes);
    const moray_table_row filled[] = {
        {.label = "outcome", .text = moray_nlp_outcome_text(info->outcome)},
        {.label = "scheme", .text = run->common.scheme},
        {.label = "meshes tried", .value = {meshes}},
        {.label = "intervals of the last", .value = {mesh[meshes - 1].intervals}},
        {.label = "variables", .value = {size.variables}},
        {.label = "constraints", .value = {size.constraints}},
        {.label = "iterations", .value = {info->iterations}},
        {.label = "linear solver", .text = moray_linear_solver_text(info->linear_solver)},
        {.label = "solver time", .value = {info->seconds}, .unit = "s"},
        {.label = "of it in the problem's functions", .value = {info->evaluation_seconds}, .unit = "s"}};
    memcpy(rows, filled, sizeof filled);
    return sizeof filled / sizeof *filled;
}

// One row a mesh, the newest last.
static int mesh_rows(const app_run *run, moray_table_row *rows)
{
    int meshes;
    const moray_mesh_record *mesh = moray_solution_history(run->solution, &meshes);
    for (int k = 0; k < meshes; k++)
        rows[k] = (moray_table_row){
            .label = moray_nlp_outcome_text(mesh[k].outcome),
            .value = {mesh[k].intervals, mesh[k].nodes, mesh[k].error, mesh[k].iterations, mesh[k].seconds}};
    return meshes;
}

enum { CERTIFICATE_ROWS = 12 };

static int certificate_rows(const app_run *run, moray_table_row *rows)
{
    const moray_certificate *c = &run->certificate;
    const double loose = 100 * run->mesh_tol;
    const moray_table_row filled[] = {
        {.label = "optimality and feasibility (KKT)", .value = {c->kkt, MORAY_LIMIT_KKT}},
        {.label = "gap held by slacks", .value = {c->gap, MORAY_LIMIT_GAP}},
        {.label = "downward curvature", .value = {c->curvature, MORAY_LIMIT_CURVATURE}},
        {.label = "error of the dynamics between nodes", .value = {c->mesh_error, run->mesh_tol}},
        {.label = "violation of limits between nodes", .value = {c->between_nodes, loose}},
        {.label = "effects that no node tells", .value = {c->unseen, MORAY_LIMIT_UNSEEN}},
        {.label = "re-simulation of each interval", .value = {c->resimulation, loose}},
        {.label = "re-simulation of whole phases", .value = {c->composed, NAN}},
        {.label = "derivatives against differences", .value = {c->derivatives, MORAY_LIMIT_DERIVATIVES}},
        {.label = "share of them that none tells", .value = {c->untold, NAN}},
        {.label = "the same along directions", .value = {c->directions, MORAY_LIMIT_DIRECTIONS}},
        {.label = "drift of the Hamiltonian", .value = {c->hamiltonian, NAN}}};
    _Static_assert(sizeof filled / sizeof *filled == CERTIFICATE_ROWS, "room for them");
    memcpy(rows, filled, sizeof filled);
    return CERTIFICATE_ROWS;
}

moray_status moray_run_tables_new(run_tables *t, const app_run *run)
{
    enum { solver_room = 10 };
    const int solution_room = count_rows(run->app->spec), ns = run->app->spec->ns, fit_room = MORAY_FIT_ROWS + ns;
    int meshes;
    moray_solution_history(run->solution, &meshes);
    const size_t room = (size_t)(solution_room + fit_room + solver_room + meshes + CERTIFICATE_ROWS);
    *t = (run_tables){.rows = calloc(room, sizeof *t->rows),
                      .texts = calloc((size_t)(solution_room + ns), sizeof *t->texts)};
    if (!t->rows || !t->texts) {
        moray_run_tables_free(t);
        return moray_error(MORAY_MEMORY, "no memory for %d rows of results", solution_room);
    }
    moray_table_row *rows = t->rows;
    int n = solution_rows(t, run);
    t->table[t->n++] = (moray_table){.title = "Solution", .n_columns = 1, .rows = rows, .n_rows = n};
    rows += n;
    if (run->fitted)
        t->n += moray_run_fit_tables(run, t->table + t->n, rows, t->texts + solution_room);
    rows += fit_room;
    n = solver_rows(run, rows);
    t->table[t->n++] = (moray_table){.title = "Solver", .n_columns = 1, .rows = rows, .n_rows = n};
    rows += n;
    n = mesh_rows(run, rows);
    if (meshes > 1)
        t->table[t->n++] = (moray_table){.title = "Meshes",
                                         .columns = {"intervals", "nodes", "error", "iterations", "time [s]"},
                                         .n_columns = 5,
                                         .rows = rows,
                                         .n_rows = n};
    rows += n;
    if (run->certified)
        t->table[t->n++] = (moray_table){.title = run->certificate.pass ? "Certificate: pass" : "Certificate: FAIL",
                                         .columns = {"found", "allowed"},
                                         .n_columns = 2,
                                         .rows = rows,
                                         .n_rows = certificate_rows(run, rows)};
    return moray_ok();
}

void moray_run_tables_free(run_tables *t)
{
    free(t->rows);
    free(t->texts);
    *t = (run_tables){0};
}

// ---- JSON ----------------------------------------------------------------------------------------------------------

static void json_meshes(moray_json *json, const moray_solution *solution)
{
    int meshes;
    const moray_mesh_record *mesh = moray_solution_history(solution, &meshes);
    moray_json_open_list(json, "meshes");
    for (int k = 0; k < meshes; k++) {
        moray_json_open(json, NULL);
        moray_json_text(json, "status", moray_nlp_outcome_text(mesh[k].outcome));
        moray_json_members(json, MORAY_MEMBERS({"intervals", mesh[k].intervals}, {"nodes", mesh[k].nodes},
                                               {"nvar", mesh[k].variables}, {"iterations", mesh[k].iterations},
                                               {"time_s", mesh[k].seconds}, {"mesh_error", mesh[k].error},
                                               {"objective", mesh[k].objective}));
        moray_json_close(json);
    }
    moray_json_close(json);
}

static void json_phase(moray_json *json, const app_run *run, int p)
{
    double t0, tf;
    moray_solution_times(run->solution, p, &t0, &tf);
    moray_json_open(json, NULL);
    moray_json_text(json, "name", moray_phase_name(run->app->spec, p));
    moray_json_number(json, "t0", t0);
    moray_json_number(json, "tf", tf);
    moray_json_numbers(json, "integrals", moray_solution_integrals(run->solution, p), run->app->spec->phase[p].nq);
    moray_json_close(json);
}

static void summarise(const void *found, moray_json *json)
{
    const app_run *run = found;
    const moray_ocp_spec *spec = run->app->spec;
    const bool solved = moray_solution_info(run->solution)->outcome == MORAY_NLP_SOLVED;
    char name[MORAY_ENTRY_SIZE];
    moray_json_text(json, "scheme", run->common.scheme);
    moray_json_number(json, "intervals", run->common.intervals);
    moray_json_open(json, "constants");
    for (int i = 0; i < run->app->n_constants; i++)
        moray_json_number(json, run->app->constants[i].key, run->constant[i]);
    moray_json_close(json);
    moray_json_open(json, "parameters");
    for (int i = 0; i < spec->ns; i++)
        moray_json_number(json, moray_entry_name(spec->s_names, "s", i, name),
                          moray_solution_parameters(run->solution)[i]);
    moray_json_close(json);
    moray_json_open_list(json, "phases");
    for (int p = 0; p < spec->phases; p++)
        json_phase(json, run, p);
    moray_json_close(json);
    moray_solver_to_json(json, run->solution);
    moray_json_close(json);
    json_meshes(json, run->solution);
    moray_certificate_to_json(json, run->certified ? &run->certificate : NULL);
    moray_json_text(json, "diagnosis", solved ? NULL : moray_solution_diagnosis(run->solution));
    moray_run_fit_to_json(json, run);
}

// ---- Everything ----------------------------------------------------------------------------------------------------

static moray_status write(const void *found, moray_output *output)
{
    const app_run *run = found;
    MORAY_TRY(moray_run_write_trajectory(run));
    if (moray_run_observes(run->app->spec))
        MORAY_TRY(moray_run_write_residuals(run));
    if (moray_solution_info(run->solution)->outcome != MORAY_NLP_INTERRUPTED) // else it is in the file of the iterate
        MORAY_TRY(moray_solution_leave(run->solution, output));
    MORAY_TRY(moray_run_write_costates(run));
    return moray_run_write_multipliers(run);
}

static moray_status draw(const void *found, moray_output *output)
{
    const app_run *run = found;
    return moray_solution_draw(run->solution, run->mesh_tol, run->app->time_unit, output);
}

static void print(const void *found, const moray_report *report)
{
    (void)found;
    printf("%s\n\n", report->title);
    moray_tables_print(report->tables, report->n_tables, stdout);
    printf("%s", report->text);
}

moray_status moray_run_show(app_run *run)
{
    run_tables tables;
    if (moray_solution_info(run->solution)->outcome == MORAY_NLP_INTERRUPTED)
        MORAY_TRY(moray_iterate_keep(&run->common, run->name, run->solution, run->kept));
    MORAY_TRY(moray_run_tables_new(&tables, run));
    const moray_report report = {.title = run->name,
                                 .text = moray_solution_diagnosis(run->solution),
                                 .tables = tables.table,
                                 .n_tables = tables.n};
    const moray_status status = moray_app_show(&run->common, &(moray_results){.name = run->name,
                                                                              .found = run,
                                                                              .summary = summarise,
                                                                              .print = print,
                                                                              .write = write,
                                                                              .draw = draw,
                                                                              .report = &report});
    moray_run_tables_free(&tables);
    return status;
}
