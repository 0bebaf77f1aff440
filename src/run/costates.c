// SPDX-License-Identifier: MIT
//
// costates.csv: dJ/dx(t) at the nodes.
#include <stdlib.h>
#include <string.h>

#include "run/track.h"

static int entries(const moray_phase_spec *phase)
{
    return phase->nx;
}

// The objective's unit over the state's.
static void describe(const app_run *run, int p, int i, struct track_column *column)
{
    const moray_app *app = run->app;
    const char *above = app->objective_unit ? app->objective_unit : "";
    const char *const *units = app->units ? app->units[p].x : NULL, *below = units && units[i] ? units[i] : "";
    const bool compound = strpbrk(below, " /*");
    char name[MORAY_ENTRY_SIZE];
    moray_entry_name(app->spec->phase[p].x_names, "x", i, name);
    snprintf(column->name, sizeof column->name, "costate of %.60s", name);
    if (*below)
        snprintf(column->unit, sizeof column->unit, compound ? "%.30s/(%.40s)" : "%.30s/%.40s", *above ? above : "1",
                 below);
    else
        snprintf(column->unit, sizeof column->unit, "%.70s", above);
}

static int rows(const app_run *run, int p)
{
    return moray_solution_nodes(run->solution, p, NULL, NULL);
}

static bool fill(struct track *t, int p)
{
    const int nx = entries(&t->run->app->spec->phase[p]), nodes = rows(t->run, p);
    double *time = calloc((size_t)nodes * (size_t)(1 + nx), sizeof *time);
    if (!time)
        return false;
    double *costate = time + nodes;
    moray_solution_nodes(t->run->solution, p, time, costate);
    for (int n = 0; n < nodes; n++) {
        double *values = t->values + (size_t)(t->first[p] + n) * t->columns;
        values[1] = time[n];
        for (int i = 0; i < nx; i++)
            values[t->place[p][i]] = costate[n * nx + i];
    }
    free(time);
    return true;
}

moray_status moray_run_write_costates(const app_run *run)
{
    static const struct track_form form = {entries, describe, rows, fill, NULL};
    return moray_track_write_new(run, &form, "costates.csv");
}
