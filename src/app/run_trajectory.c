// SPDX-License-Identifier: MIT
#include "run.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { least_samples = 200, first_column = 2 }; // after the number of the phase and the time

struct column {
    char name[MORAY_ENTRY_SIZE];
    const char *unit;
};

// Samples of all phases, one below the other. A state or control of the same name and unit shares a column, which is
// NaN in phases that have none.
struct track {
    const app_run *run;
    int rows, columns;
    int *first;  // [phases + 1] row
    int **place; // [phases] columns of the states, then of the controls
    struct column *column;
    double *values; // [rows][columns]
};

static int entries(const moray_phase_spec *phase)
{
    return phase->nx + phase->nu;
}

static void describe(const app_run *run, int p, int i, struct column *column)
{
    const moray_phase_spec *phase = &run->app->spec->phase[p];
    const moray_app_units *units = run->app->units ? &run->app->units[p] : NULL;
    const bool state = i < phase->nx;
    const char *const *unit = !units ? NULL : state ? units->x : units->u;
    const int at = state ? i : i - phase->nx;
    moray_entry_name(state ? phase->x_names : phase->u_names, state ? "x" : "u", at, column->name);
    column->unit = unit ? unit[at] : NULL;
}

static bool same_unit(const char *one, const char *other)
{
    return one == other || (one && other && strcmp(one, other) == 0);
}

// ---- Sampling ------------------------------------------------------------------------------------------------------

static int find_column(struct track *t, const struct column *wanted)
{
    for (int j = first_column; j < t->columns; j++)
        if (strcmp(t->column[j].name, wanted->name) == 0 && same_unit(t->column[j].unit, wanted->unit))
            return j;
    t->column[t->columns] = *wanted;
    return t->columns++;
}

static int steps_between(int nodes)
{
    return (least_samples + nodes - 2) / (nodes - 1);
}

// Rows of the phases and columns of their entries. False when out of memory.
static bool lay_out(struct track *t)
{
    const moray_ocp_spec *spec = t->run->app->spec;
    int most = first_column;
    for (int p = 0; p < spec->phases; p++)
        most += entries(&spec->phase[p]);
    t->first = calloc((size_t)spec->phases + 1, sizeof *t->first);
    t->place = calloc((size_t)spec->phases, sizeof *t->place);
    t->column = calloc((size_t)most, sizeof *t->column);
    if (!t->first || !t->place || !t->column)
        return false;
    t->columns = first_column;
    t->column[0] = (struct column){.name = "phase"};
    t->column[1] = (struct column){.name = "t", .unit = t->run->app->time_unit};
    for (int p = 0; p < spec->phases; p++) {
        const int n = entries(&spec->phase[p]), nodes = moray_solution_nodes(t->run->solution, p, NULL, NULL);
        struct column column;
        t->first[p + 1] = t->first[p] + (nodes - 1) * steps_between(nodes) + 1;
        t->place[p] = calloc((size_t)n, sizeof *t->place[p]);
        for (int i = 0; i < n && t->place[p]; i++) {
            describe(t->run, p, i, &column);
            t->place[p][i] = find_column(t, &column);
        }
        if (!t->place[p])
            return false;
    }
    t->rows = t->first[spec->phases];
    t->values = calloc((size_t)t->rows * t->columns, sizeof *t->values);
    return t->values;
}

// Nodes and points between them; x has room for states and controls, time for the nodes.
static void sample_phase(struct track *t, int p, double *time, double *x)
{
    const moray_phase_spec *phase = &t->run->app->spec->phase[p];
    const int nodes = moray_solution_nodes(t->run->solution, p, time, NULL), steps = steps_between(nodes);
    for (int row = t->first[p]; row < t->first[p + 1]; row++) {
        const int k = row - t->first[p], node = k / steps, part = k % steps;
        double *values = t->values + (size_t)row * t->columns;
        for (int j = first_column; j < t->columns; j++)
            values[j] = NAN;
        values[0] = p + 1;
        values[1] = part ? time[node] + (time[node + 1] - time[node]) * part / steps : time[node];
        moray_solution_at(t->run->solution, p, values[1], x, x + phase->nx);
        for (int i = 0; i < entries(phase); i++)
            values[t->place[p][i]] = x[i];
    }
}

static moray_status sample(struct track *t)
{
    const moray_ocp_spec *spec = t->run->app->spec;
    moray_status status = lay_out(t) ? moray_ok() : moray_error(MORAY_MEMORY, "no memory for the trajectory");
    for (int p = 0; p < spec->phases && !moray_failed(status); p++) {
        const int nodes = moray_solution_nodes(t->run->solution, p, NULL, NULL);
        double *time = calloc((size_t)(nodes + entries(&spec->phase[p])), sizeof *time);
        if (time)
            sample_phase(t, p, time, time + nodes);
        else
            status = moray_error(MORAY_MEMORY, "no memory for the trajectory");
        free(time);
    }
    return status;
}

static void track_free(struct track *t)
{
    for (int p = 0; t->place && p < t->run->app->spec->phases; p++)
        free(t->place[p]);
    free(t->place);
    free(t->first);
    free(t->column);
    free(t->values);
}

// ---- Files ---------------------------------------------------------------------------------------------------------

static moray_status write_table(const struct track *t)
{
    FILE *file;
    const int skipped = t->run->app->spec->phases == 1; // the number of the only phase
    moray_column *columns = calloc((size_t)t->columns, sizeof *columns);
    if (!columns)
        return moray_error(MORAY_MEMORY, "no memory for the trajectory");
    for (int j = 0; j < t->columns; j++)
        columns[j] = (moray_column){t->column[j].name, t->column[j].unit, t->values + j, t->columns};
    moray_status status = moray_output_file(t->run->common.output, "trajectory.csv", &file);
    if (!moray_failed(status))
        moray_csv_write(file, columns + skipped, t->columns - skipped, t->rows);
    free(columns);
    return status;
}

// "states", "states_ascent", "states_ascent_2"; what is no letter or digit becomes a dash.
static void figure_name(const struct track *t, const char *kind, int p, int group, char *name, size_t size)
{
    const moray_ocp_spec *spec = t->run->app->spec;
    int used = snprintf(name, size, "%s", kind);
    if (spec->phases > 1)
        used += snprintf(name + used, size - (size_t)used, "_%d_%.40s", p + 1, moray_phase_name(spec, p));
    if (group > 1)
        snprintf(name + used, size - (size_t)used, "_%d", group);
    for (char *c = name; *c; c++)
        if (!isalnum((unsigned char)*c) && *c != '_')
            *c = '-';
}

// Draws the curves of columns place[0..n) over time, of which `group` says how many figures of this kind there were.
static moray_status draw(const struct track *t, const char *kind, int p, int group, const moray_curve *curves, int n,
                         const char *unit)
{
    const moray_ocp_spec *spec = t->run->app->spec;
    char name[100], title[200], x_label[60], y_label[100];
    const char *single = n == 1 ? curves[0].label : kind, *s = t->run->app->time_unit;
    figure_name(t, kind, p, group, name, sizeof name);
    snprintf(title, sizeof title, "%.60s: %s%s%.60s", t->run->name, kind, spec->phases > 1 ? " of " : "",
             spec->phases > 1 ? moray_phase_name(spec, p) : "");
    snprintf(x_label, sizeof x_label, s ? "time [%.40s]" : "time", s);
    snprintf(y_label, sizeof y_label, unit ? "%.50s [%.30s]" : "%.50s", single, unit);
    return moray_output_figure(
        t->run->common.output,
        &(moray_figure){
            .name = name, .title = title, .x_label = x_label, .y_label = y_label, .curves = curves, .n_curves = n});
}

// States (entries from `from` to `to`) or controls of one phase: one figure for each unit. curves, done: room for all.
static moray_status draw_kind(const struct track *t, const char *kind, int p, int from, int to, moray_curve *curves,
                              bool *done)
{
    const double *values = t->values + (size_t)t->first[p] * t->columns;
    const int *place = t->place[p];
    int group = 0;
    for (int i = from; i < to; i++) {
        const char *unit = t->column[place[i]].unit;
        int n = 0;
        for (int j = i; j < to && !done[i]; j++)
            if (!done[j] && same_unit(t->column[place[j]].unit, unit)) {
                curves[n++] = (moray_curve){.label = t->column[place[j]].name,
                                            .x = values + 1,
                                            .y = values + place[j],
                                            .n = t->first[p + 1] - t->first[p],
                                            .stride = t->columns};
                done[j] = j > i;
            }
        done[i] = true;
        if (n > 0)
            MORAY_TRY(draw(t, kind, p, ++group, curves, n, unit));
    }
    return moray_ok();
}

static moray_status draw_phase(const struct track *t, int p)
{
    const moray_phase_spec *phase = &t->run->app->spec->phase[p];
    moray_curve *curves = calloc((size_t)entries(phase), sizeof *curves);
    bool *done = calloc((size_t)entries(phase), sizeof *done);
    moray_status status = curves && done ? moray_ok() : moray_error(MORAY_MEMORY, "no memory for the figures");
    if (!moray_failed(status))
        status = draw_kind(t, "states", p, 0, phase->nx, curves, done);
    if (!moray_failed(status))
        status = draw_kind(t, "controls", p, phase->nx, entries(phase), curves, done);
    free(curves);
    free(done);
    return status;
}

moray_status moray_run_write_trajectory(const app_run *run)
{
    struct track t = {.run = run};
    moray_status status = sample(&t), figure = moray_ok();
    if (!moray_failed(status))
        status = write_table(&t);
    for (int p = 0; p < run->app->spec->phases && !moray_failed(status) && !moray_failed(figure); p++)
        figure = draw_phase(&t, p);
    if (moray_failed(figure) && !run->common.quiet)
        fprintf(stderr, "%s: no figure: %s\n", run->name, figure.text);
    track_free(&t);
    return status;
}
