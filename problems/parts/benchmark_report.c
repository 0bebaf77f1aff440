// SPDX-License-Identifier: MIT
#include <stdlib.h>
#include <string.h>

#include "benchmark.h"

static const char *const piece_keys[PIECES] = {"setup_s",   "function_s", "jacobian_s",
                                               "hessian_s", "ipopt_s",    "linear_solver_s"};

// ---- JSON ----------------------------------------------------------------------------------------------------------

static void json_cost(moray_json *json, const cost *c)
{
    moray_json_bool(json, "solved", c->solved);
    moray_json_number(json, "objective", c->objective);
    moray_json_number(json, "iterations", c->iterations);
    moray_json_number(json, "nvar", c->size.variables);
    moray_json_number(json, "ncon", c->size.constraints);
    moray_json_number(json, "nnz_jac", c->size.nnz_jac);
    moray_json_number(json, "nnz_hess", c->size.nnz_hess);
    for (int k = 0; k < PIECES; k++)
        moray_json_number(json, piece_keys[k], c->piece[k]);
    moray_json_number(json, "evaluation_s", cost_evaluation(c));
    moray_json_number(json, "total_s", c->total);
    moray_json_number(json, "wall_s", c->wall);
    moray_json_number(json, "total_over_floor", cost_over_floor(c));
}

static void json_growth(moray_json *json, const growth *g)
{
    double exponent[EXPONENTS];
    growth_exponents(g, exponent);
    moray_json_open(json, NULL);
    moray_json_text(json, "problem", g->name);
    moray_json_text(json, "over", g->over);
    moray_json_open(json, "exponents");
    for (int i = 0; i < EXPONENTS; i++)
        moray_json_number(json, exponent_names[i], exponent[i]);
    moray_json_close(json);
    moray_json_open_list(json, "points");
    for (int k = 0; k < g->n; k++) {
        moray_json_open(json, NULL);
        moray_json_number(json, g->over, g->size[k]);
        json_cost(json, &g->cost[k]);
        moray_json_close(json);
    }
    moray_json_close(json);
    moray_json_close(json);
}

static void json_simulation(moray_json *json, const simulated *s)
{
    static const char *const models[] = {"control", "complex"};
    moray_json_open_list(json, "simulation");
    for (int k = 0; k < s->n; k++)
        for (int model = 0; model < 2; model++) {
            moray_json_open(json, NULL);
            moray_json_text(json, "model", models[model]);
            moray_json_number(json, "links", s->links[k]);
            moray_json_number(json, "simulated_s_per_s", s->rate[model][k]);
            moray_json_close(json);
        }
    moray_json_close(json);
}

static moray_status print_json(const benchmark *run)
{
    moray_json *json = moray_json_new();
    moray_json_text(json, "problem", "benchmark");
    moray_json_text(json, "version", moray_version());
    moray_json_text(json, "clock", "processor time, medians");
    moray_json_number(json, "repeats", run->repeats);
    moray_json_open_list(json, "problems");
    for (int k = 0; k < run->n_cases; k++) {
        moray_json_open(json, NULL);
        moray_json_text(json, "name", run->cases[k].name);
        json_cost(json, &run->cases[k].cost);
        moray_json_close(json);
    }
    moray_json_close(json);
    moray_json_open_list(json, "growth");
    for (int k = 0; k < run->n_growths; k++)
        json_growth(json, &run->growths[k]);
    moray_json_close(json);
    json_simulation(json, &run->simulation);
    moray_status status = moray_json_write(json, stdout);
    moray_json_free(json);
    return status;
}

// ---- Tables --------------------------------------------------------------------------------------------------------

struct sheet {
    moray_table_row rows[MOST_CASES];
    char labels[MOST_CASES][80];
    int n;
};

static void add(struct sheet *sheet, const char *label, const double value[MORAY_TABLE_COLUMNS])
{
    snprintf(sheet->labels[sheet->n], sizeof sheet->labels[0], "%s", label);
    sheet->rows[sheet->n] = (moray_table_row){.label = sheet->labels[sheet->n]};
    memcpy(sheet->rows[sheet->n].value, value, sizeof sheet->rows[0].value);
    sheet->n++;
}

static void print(const struct sheet *sheet, const char *title, const char *const columns[MORAY_TABLE_COLUMNS])
{
    moray_table table = {.title = title, .rows = sheet->rows, .n_rows = sheet->n};
    while (table.n_columns < MORAY_TABLE_COLUMNS && columns[table.n_columns]) {
        table.columns[table.n_columns] = columns[table.n_columns];
        table.n_columns++;
    }
    moray_table_print(&table, stdout);
    printf("\n");
}

static void times_row(struct sheet *sheet, const char *label, const cost *c)
{
    double ms[MORAY_TABLE_COLUMNS];
    for (int k = 0; k < PIECES; k++)
        ms[k] = 1000 * c->piece[k];
    ms[PIECES] = c->iterations;
    ms[PIECES + 1] = 1000 * (cost_evaluation(c) + c->piece[IPOPT] + c->piece[LINEAR]) / c->iterations;
    add(sheet, label, ms);
}

static void sizes_row(struct sheet *sheet, const char *label, const cost *c)
{
    add(sheet, label,
        (double[MORAY_TABLE_COLUMNS]){c->iterations, c->size.variables, c->size.constraints, c->size.nnz_jac,
                                      c->size.nnz_hess, c->objective});
}

static void totals_row(struct sheet *sheet, const char *label, const cost *c)
{
    add(sheet, label,
        (double[MORAY_TABLE_COLUMNS]){1000 * c->total, 1000 * c->wall, 1000 * cost_evaluation(c), cost_over_floor(c),
                                      1000 * c->total / c->iterations});
}

static const char *const time_columns[MORAY_TABLE_COLUMNS] = {"set-up",  "function", "Jacobian",
                                                              "Hessian", "Ipopt",    "linear solver"};
static const char *const growth_columns[MORAY_TABLE_COLUMNS] = {
    "set-up", "function", "Jacobian", "Hessian", "Ipopt", "linear solver", "iterations", "an iteration"};
static const char *const size_columns[MORAY_TABLE_COLUMNS] = {"iterations", "variables",    "constraints",
                                                              "nnz(J)",     "nnz(Hessian)", "objective"};
static const char *const total_columns[MORAY_TABLE_COLUMNS] = {"total", "wall", "evaluation", "total/floor",
                                                               "an iteration"};

static void print_cases(const benchmark *run)
{
    struct sheet times = {0}, sizes = {0}, totals = {0};
    for (int k = 0; k < run->n_cases; k++) {
        const cost *c = &run->cases[k].cost;
        char name[80];
        snprintf(name, sizeof name, "%.60s%s", run->cases[k].name, c->solved ? "" : " (NOT SOLVED)");
        sizes_row(&sizes, name, c);
        times_row(&times, name, c);
        totals_row(&totals, name, c);
    }
    if (run->n_cases == 0)
        return;
    print(&sizes, "Programmes", size_columns);
    print(&times, "Processor time [ms]", time_columns);
    print(&totals, "Start to finish [ms]", total_columns);
}

static void print_growth(const growth *g)
{
    struct sheet times = {0};
    double exponent[EXPONENTS];
    char title[120], label[40];
    for (int k = 0; k < g->n; k++) {
        snprintf(label, sizeof label, "%d %s%s", g->size[k], g->over, g->cost[k].solved ? "" : " (NOT SOLVED)");
        times_row(&times, label, &g->cost[k]);
    }
    snprintf(title, sizeof title, "%s over %s: processor time [ms]", g->name, g->over);
    print(&times, title, growth_columns);
    growth_exponents(g, exponent);
    printf("grows with the power");
    for (int i = 0; i < EXPONENTS; i++)
        printf("%s %.2f (%s)", i ? "," : "", exponent[i], exponent_names[i]);
    printf(" of the %s; all but the set-up for one iteration\n\n", g->over);
}

static void print_simulation(const simulated *s)
{
    struct sheet sheet = {0};
    char label[40];
    for (int k = 0; k < s->n; k++) {
        snprintf(label, sizeof label, "%d links", s->links[k]);
        add(&sheet, label, (double[MORAY_TABLE_COLUMNS]){s->rate[0][k], s->rate[1][k]});
    }
    if (s->n > 0)
        print(&sheet, "Simulated seconds in a second of the processor",
              (const char *const[MORAY_TABLE_COLUMNS]){"control-oriented", "first-principles"});
}

moray_status benchmark_report(const benchmark *run)
{
    if (run->common.json)
        return print_json(run);
    print_cases(run);
    for (int k = 0; k < run->n_growths; k++)
        print_growth(&run->growths[k]);
    print_simulation(&run->simulation);
    return moray_ok();
}
