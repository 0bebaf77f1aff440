// SPDX-License-Identifier: MIT
//
// residuals.csv: what was observed and what is predicted there; figures of both, with the prediction in between.
#include <complex.h>
#include <stdlib.h>

#include "run/fit.h"
#include "run/track.h"

enum { observed, predicted, residual, kinds, curve_points = 401 };

// ---- The file ------------------------------------------------------------------------------------------------------

static int entries(const moray_phase_spec *phase)
{
    return phase->observed.n > 0 ? kinds * phase->observed.ny : 0;
}

static void describe(const app_run *run, int p, int i, struct track_column *column)
{
    static const char *const behind[kinds] = {"", " predicted", " residual"};
    char name[MORAY_ENTRY_SIZE];
    moray_entry_name(run->app->spec->phase[p].observed.names, "y", i / kinds, name);
    snprintf(column->name, sizeof column->name, "%.60s%s", name, behind[i % kinds]);
    column->unit[0] = 0;
}

static int rows(const app_run *run, int p)
{
    const int n = run->app->spec->phase[p].observed.n;
    return n > 0 ? n : 0;
}

static bool fill(struct track *t, int p)
{
    const moray_solution *solution = t->run->solution;
    const moray_observations *given = &t->run->app->spec->phase[p].observed;
    const int n = moray_solution_residuals(solution, NULL);
    moray_residual *all = calloc((size_t)n + 1, sizeof *all);
    if (!all)
        return false;
    moray_solution_residuals(solution, all);
    for (int row = 0; row < rows(t->run, p); row++)
        t->values[(size_t)(t->first[p] + row) * t->columns + 1] = given->time[row];
    for (int k = 0; k < n; k++) {
        if (all[k].phase != p)
            continue;
        double *values = t->values + (size_t)(t->first[p] + all[k].row) * t->columns;
        const int *place = t->place[p] + kinds * all[k].channel;
        values[place[observed]] = all[k].observed;
        values[place[predicted]] = all[k].predicted;
        values[place[residual]] = all[k].observed - all[k].predicted;
    }
    free(all);
    return true;
}

// ---- Figures -------------------------------------------------------------------------------------------------------

// h along a phase.
struct path {
    const app_run *run;
    int p;
    double *t, *y, *in;    // [curve_points], [ny][curve_points], [nx + nu + ns + 1]
    double *now;           // [ny]
    moray_num *num, *seen; // [nx + nu + ns], [ny]
};

static void predict(const struct path *path, int k)
{
    const moray_ocp_spec *spec = path->run->app->spec;
    const moray_phase_spec *phase = &spec->phase[path->p];
    const int nx = phase->nx, nu = phase->nu, ny = phase->observed.ny;
    moray_solution_at(path->run->solution, path->p, path->t[k], path->in, path->in + nx);
    for (int i = 0; i < spec->ns; i++)
        path->in[nx + nu + i] = moray_solution_parameters(path->run->solution)[i];
    path->in[nx + nu + spec->ns] = path->t[k];
    for (int i = 0; i < nx + nu + spec->ns; i++)
        path->num[i] = path->in[i];
    const moray_node at = {path->num, path->num + nx, path->num + nx + nu, path->t[k]};
    if (phase->observed.map)
        phase->observed.map->value(phase->observed.map->self, path->in, path->now);
    else
        phase->observed.observe(&at, path->seen, spec->data);
    for (int j = 0; j < ny; j++)
        path->y[j * curve_points + k] = phase->observed.map ? path->now[j] : creal(path->seen[j]);
}

static moray_status draw_channel(const struct track *t, const struct path *path, int j)
{
    const moray_ocp_spec *spec = t->run->app->spec;
    const double *values = t->values + (size_t)t->first[path->p] * t->columns;
    const int place = t->place[path->p][kinds * j];
    const char *channel = t->column[place].name, *unit = t->run->app->time_unit;
    const moray_curve curves[] = {
        {.label = "predicted", .x = path->t, .y = path->y + (size_t)j * curve_points, .n = curve_points},
        {.label = "observed",
         .x = values + 1,
         .y = values + place,
         .n = rows(t->run, path->p),
         .stride = t->columns,
         .style = MORAY_CURVE_POINTS}};
    char name[60], title[200], x_label[60];
    if (spec->phases > 1)
        snprintf(name, sizeof name, "fit_%d_%d", path->p + 1, j + 1);
    else
        snprintf(name, sizeof name, "fit_%d", j + 1);
    snprintf(title, sizeof title, "%.60s: fit to %.60s%s%.60s", t->run->name, channel, spec->phases > 1 ? " of " : "",
             spec->phases > 1 ? moray_phase_name(spec, path->p) : "");
    snprintf(x_label, sizeof x_label, unit ? "time [%.40s]" : "time", unit);
    return moray_output_figure(
        t->run->common.output,
        &(moray_figure){
            .name = name, .title = title, .x_label = x_label, .y_label = channel, .curves = curves, .n_curves = 2});
}

static moray_status draw_phase(const struct track *t, int p)
{
    const moray_ocp_spec *spec = t->run->app->spec;
    const moray_phase_spec *phase = &spec->phase[p];
    const int ny = phase->observed.ny, inputs = phase->nx + phase->nu + spec->ns + 1;
    if (rows(t->run, p) == 0)
        return moray_ok();
    double *numbers = calloc((size_t)(curve_points * (1 + ny) + inputs + ny), sizeof *numbers);
    moray_num *complex_ones = calloc((size_t)(inputs + ny), sizeof *complex_ones);
    double *in = numbers + curve_points * (1 + ny);
    struct path path = {t->run, p,           numbers,      numbers + curve_points,
                        in,     in + inputs, complex_ones, complex_ones + inputs};
    moray_status status =
        numbers && complex_ones ? moray_ok() : moray_error(MORAY_MEMORY, "no memory for the figures of the fit");
    double t0, tf;
    moray_solution_times(t->run->solution, p, &t0, &tf);
    for (int k = 0; k < curve_points && !moray_failed(status); k++) {
        path.t[k] = t0 + (tf - t0) * k / (curve_points - 1);
        predict(&path, k);
    }
    for (int j = 0; j < ny && !moray_failed(status); j++)
        status = draw_channel(t, &path, j);
    free(numbers);
    free(complex_ones);
    return status;
}

moray_status moray_run_write_residuals(const app_run *run)
{
    static const struct track_form form = {entries, describe, rows, fill, draw_phase};
    return moray_track_write_new(run, &form, "residuals.csv");
}
