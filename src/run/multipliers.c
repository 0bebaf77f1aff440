// SPDX-License-Identifier: MIT
//
// multipliers.csv: of path constraints and of the bounds on states and controls, as densities in time at the nodes.
#include <stdlib.h>

#include "run/track.h"

static int entries(const moray_phase_spec *phase)
{
    return phase->nc + phase->nx + phase->nu;
}

// In units of the objective over those of what is bounded and of time, which are not known of constraints and go
// unsaid.
static void describe(const app_run *run, int p, int i, struct track_column *column)
{
    const moray_phase_spec *phase = &run->app->spec->phase[p];
    const int state = i - phase->nc, control = state - phase->nx;
    char name[MORAY_ENTRY_SIZE];
    if (state < 0)
        moray_entry_name(phase->c_names, "c", i, name);
    else if (control < 0)
        moray_entry_name(phase->x_names, "x", state, name);
    else
        moray_entry_name(phase->u_names, "u", control, name);
    snprintf(column->name, sizeof column->name, "multiplier of %s%.50s", state < 0 ? "" : "bounds of ", name);
    column->unit[0] = 0;
}

static int rows(const app_run *run, int p)
{
    return moray_solution_nodes(run->solution, p, NULL, NULL);
}

static bool fill(struct track *t, int p)
{
    const moray_phase_spec *phase = &t->run->app->spec->phase[p];
    const int nodes = rows(t->run, p), width[] = {phase->nc, phase->nx, phase->nu};
    double *time = calloc((size_t)nodes * (size_t)(1 + entries(phase)), sizeof *time);
    if (!time)
        return false;
    double *const kind[] = {time + nodes, time + nodes * (1 + width[0]), time + nodes * (1 + width[0] + width[1])};
    moray_solution_nodes(t->run->solution, p, time, NULL);
    moray_solution_multipliers(t->run->solution, p, kind[0], kind[1], kind[2]);
    for (int n = 0; n < nodes; n++) {
        double *values = t->values + (size_t)(t->first[p] + n) * t->columns;
        values[1] = time[n];
        for (int k = 0, column = 0; k < 3; k++)
            for (int i = 0; i < width[k]; i++)
                values[t->place[p][column++]] = kind[k][n * width[k] + i];
    }
    free(time);
    return true;
}

moray_status moray_run_write_multipliers(const app_run *run)
{
    static const struct track_form form = {entries, describe, rows, fill, NULL};
    return moray_track_write_new(run, &form, "multipliers.csv");
}
