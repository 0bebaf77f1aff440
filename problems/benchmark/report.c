// SPDX-License-Identifier: MIT
#include <stdlib.h>
#include <string.h>

#include "benchmark.h"

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

static void print_sheet(const struct sheet *sheet, const char *title, const char *const columns[MORAY_TABLE_COLUMNS])
{
    moray_table table = {.title = title, .rows = sheet->rows, .n_rows = sheet->n};
    while (table.n_columns < MORAY_TABLE_COLUMNS && columns[table.n_columns]) {
        table.columns[table.n_columns] = columns[table.n_columns];
        table.n_columns++;
    }
    moray_tables_print(&table, 1, stdout);
}

static void times_row(struct sheet *sheet, const char *label, const cost *c)
{
    double ms[MORAY_TABLE_COLUMNS] = {0};
    for (int k = 0; k < PIECES; k++)
        ms[k] = 1000 * c->piece[k];
    add(sheet, label, ms);
}

static void growth_row(struct sheet *sheet, const char *label, const cost *c)
{
    const double solving = cost_evaluation(c) + c->piece[IPOPT] + c->piece[LINEAR];
    add(sheet, label,
        (double[MORAY_TABLE_COLUMNS]){1000 * c->piece[SETUP], 1000 * cost_evaluation(c), 1000 * c->piece[IPOPT],
                                      1000 * c->piece[LINEAR], c->iterations, 1000 * solving / c->iterations,
                                      c->memory / (1 << 20)});
}

static void sizes_row(struct sheet *sheet, const char *label, const cost *c)
{
    add(sheet, label,
        (double[MORAY_TABLE_COLUMNS]){c->iterations, c->size.variables, c->size.constraints, c->size.nnz_jac,
                                      c->size.nnz_hess, c->objective});
}

static void totals_row(struct sheet *sheet, const char *label, const machine *rates, const cost *c)
{
    double term[FLOOR_TERMS];
    const double floor = cost_floor(rates, c, term);
    add(sheet, label,
        (double[MORAY_TABLE_COLUMNS]){1000 * c->total, 1000 * c->wall, 1000 * c->total / c->iterations,
                                      1000 * term[FLOOR_FACTORS], 1000 * term[FLOOR_STREAM], 1000 * term[FLOOR_CALLS],
                                      c->total / floor});
}

static void solvers_row(struct sheet *sheet, const char *label, const named_cost *c)
{
    add(sheet, label,
        (double[MORAY_TABLE_COLUMNS]){c->cost.iterations, c->mumps.iterations, 1000 * c->cost.total,
                                      1000 * c->mumps.total, total_over_ours(c), linear_over_ours(c),
                                      c->cost.objective - c->mumps.objective});
}

static const char *const solver_columns[MORAY_TABLE_COLUMNS] = {
    "iterations", "with MUMPS", "total [ms]", "with MUMPS", "ratio", "linear solver's", "objectives differ"};
static const char *const time_columns[MORAY_TABLE_COLUMNS] = {"set-up",  "function", "Jacobian",
                                                              "Hessian", "Ipopt",    "linear solver"};
static const char *const growth_columns[MORAY_TABLE_COLUMNS] = {
    "set-up", "evaluation", "Ipopt", "linear solver", "iterations", "an iteration", "memory [MiB]"};
static const char *const exponent_columns[MORAY_TABLE_COLUMNS] = {"set-up", "evaluation", "Ipopt, linear solver",
                                                                  "iteration", "memory"};
static const char *const size_columns[MORAY_TABLE_COLUMNS] = {"iterations", "variables",    "constraints",
                                                              "nnz(J)",     "nnz(Hessian)", "objective"};
static const char *const total_columns[MORAY_TABLE_COLUMNS] = {
    "total", "wall", "an iteration", "floor: factors", "streaming", "functions", "total/floor"};

static void print_cases(const benchmark *run)
{
    struct sheet times = {0}, sizes = {0}, totals = {0}, solvers = {0};
    for (int k = 0; k < run->n_cases; k++) {
        const cost *c = &run->cases[k].cost;
        char name[80];
        snprintf(name, sizeof name, "%.60s%s", run->cases[k].name, c->solved ? "" : " (NOT SOLVED)");
        sizes_row(&sizes, name, c);
        times_row(&times, name, c);
        totals_row(&totals, name, &run->machine, c);
        solvers_row(&solvers, name, &run->cases[k]);
    }
    if (run->n_cases == 0)
        return;
    print_sheet(&sizes, "Programmes", size_columns);
    print_sheet(&times, "Processor time [ms]", time_columns);
    print_sheet(&totals, "Start to finish [ms]", total_columns);
    print_sheet(&solvers, "Beside MUMPS, ratios of its time to that above", solver_columns);
}

static void print_growth(const growth *g)
{
    struct sheet times = {0};
    char title[120], label[40];
    for (int k = 0; k < g->n; k++) {
        snprintf(label, sizeof label, "%d %s%s", g->size[k], g->over, g->cost[k].solved ? "" : " (NOT SOLVED)");
        growth_row(&times, label, &g->cost[k]);
    }
    snprintf(title, sizeof title, "%s over %s: processor time [ms]", g->name, g->over);
    print_sheet(&times, title, growth_columns);
}

static void print_exponents(const benchmark *run)
{
    struct sheet powers = {0};
    for (int k = 0; k < run->n_growths; k++) {
        double exponent[MORAY_TABLE_COLUMNS];
        char label[80];
        growth_exponents(&run->growths[k], exponent);
        snprintf(label, sizeof label, "%.60s, %s", run->growths[k].name, run->growths[k].over);
        add(&powers, label, exponent);
    }
    if (powers.n > 0)
        print_sheet(&powers, "Powers with which set-up, one iteration and its parts, and peak memory grow",
                    exponent_columns);
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
        print_sheet(&sheet, "Simulated seconds in a second of the processor",
                    (const char *const[MORAY_TABLE_COLUMNS]){moray_model_name(0), moray_model_name(1)});
}

static void print(const void *found, const moray_report *report)
{
    (void)report;
    const benchmark *run = found;
    print_cases(run);
    for (int k = 0; k < run->n_growths; k++)
        print_growth(&run->growths[k]);
    print_exponents(run);
    print_simulation(&run->simulation);
}

moray_status benchmark_report(const benchmark *run)
{
    return moray_app_show(
        &run->common,
        &(moray_results){
            .name = "benchmark", .found = run, .summary = benchmark_summary, .print = print, .draw = benchmark_draw});
}
