// SPDX-License-Identifier: MIT
#include "run/track.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>

enum { least_samples = 200 };

static int entries(const moray_phase_spec *phase)
{
    return phase->nx + phase->nu;
}

static void describe(const app_run *run, int p, int i, struct track_column *column)
{
    const moray_phase_spec *phase = &run->app->spec->phase[p];
    const moray_app_units *units = run->app->units ? &run->app->units[p] : NULL;
    const bool state = i < phase->nx;
    const char *const *unit = !units ? NULL : state ? units->x : units->u;
    const int at = state ? i : i - phase->nx;
    moray_entry_name(state ? phase->x_names : phase->u_names, state ? "x" : "u", at, column->name);
    snprintf(column->unit, sizeof column->unit, "%.70s", unit && unit[at] ? unit[at] : "");
}

// ---- Sampling ------------------------------------------------------------------------------------------------------

static int steps_between(int nodes)
{
    return (least_samples + nodes - 2) / (nodes - 1);
}

static int rows(const app_run *run, int p)
{
    const int nodes = moray_solution_nodes(run->solution, p, NULL, NULL);
    return (nodes - 1) * steps_between(nodes) + 1;
}

// Nodes and points between them.
static bool fill(struct track *t, int p)
{
    const moray_phase_spec *phase = &t->run->app->spec->phase[p];
    const int n = entries(phase), nodes = moray_solution_nodes(t->run->solution, p, NULL, NULL);
    const int steps = steps_between(nodes);
    double *time = calloc((size_t)(nodes + n), sizeof *time);
    if (!time)
        return false;
    double *x = time + nodes;
    moray_solution_nodes(t->run->solution, p, time, NULL);
    for (int row = t->first[p]; row < t->first[p + 1]; row++) {
        const int k = row - t->first[p], node = k / steps, part = k % steps;
        double *values = t->values + (size_t)row * t->columns;
        values[1] = part ? time[node] + (time[node + 1] - time[node]) * part / steps : time[node];
        moray_solution_at(t->run->solution, p, values[1], x, x + phase->nx);
        for (int i = 0; i < n; i++)
            values[t->place[p][i]] = x[i];
    }
    free(time);
    return true;
}

// ---- Figures -------------------------------------------------------------------------------------------------------

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
    snprintf(y_label, sizeof y_label, *unit ? "%.50s [%.30s]" : "%.50s", single, unit);
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
            if (!done[j] && strcmp(t->column[place[j]].unit, unit) == 0) {
                curves[n++] = (moray_curve){.label = t->column[place[j]].name,
                                            .x = values + 1,
                                            .y = values + place[j],
                                            .n = t->first[p + 1] - t->first[p],
                                            .stride = t->columns};
                done[j] = j > i;
            }
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
    static const struct track_form form = {entries, describe, rows, fill, draw_phase};
    return moray_track_write_new(run, &form, "trajectory.csv");
}
