// SPDX-License-Identifier: MIT
#include "run/track.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { first_column = 2 }; // after the number of the phase and the time

static int find_column(struct track *t, const struct track_column *wanted)
{
    for (int j = first_column; j < t->columns; j++)
        if (strcmp(t->column[j].name, wanted->name) == 0 && strcmp(t->column[j].unit, wanted->unit) == 0)
            return j;
    t->column[t->columns] = *wanted;
    return t->columns++;
}

static bool place_phase(struct track *t, int p)
{
    const int n = t->form->entries(&t->run->app->spec->phase[p]);
    struct track_column column;
    t->first[p + 1] = t->first[p] + t->form->rows(t->run, p);
    t->place[p] = calloc((size_t)n + 1, sizeof *t->place[p]);
    for (int i = 0; i < n && t->place[p]; i++) {
        t->form->describe(t->run, p, i, &column);
        t->place[p][i] = find_column(t, &column);
    }
    return t->place[p];
}

// Rows of the phases and columns of their entries. False when out of memory.
static bool lay_out(struct track *t)
{
    const moray_ocp_spec *spec = t->run->app->spec;
    const char *unit = t->run->app->time_unit;
    int most = first_column;
    for (int p = 0; p < spec->phases; p++)
        most += t->form->entries(&spec->phase[p]);
    t->first = calloc((size_t)spec->phases + 1, sizeof *t->first);
    t->place = calloc((size_t)spec->phases, sizeof *t->place);
    t->column = calloc((size_t)most, sizeof *t->column);
    if (!t->first || !t->place || !t->column)
        return false;
    t->columns = first_column;
    t->column[0] = (struct track_column){.name = "phase"};
    t->column[1] = (struct track_column){.name = "t"};
    snprintf(t->column[1].unit, MORAY_ENTRY_SIZE, "%s", unit ? unit : "");
    for (int p = 0; p < spec->phases; p++)
        if (!place_phase(t, p))
            return false;
    t->rows = t->first[spec->phases];
    t->values = calloc((size_t)t->rows * t->columns, sizeof *t->values);
    return t->values;
}

static bool fill(struct track *t, int p)
{
    for (int row = t->first[p]; row < t->first[p + 1]; row++) {
        double *values = t->values + (size_t)row * t->columns;
        for (int j = first_column; j < t->columns; j++)
            values[j] = NAN;
        values[0] = p + 1;
    }
    return t->form->fill(t, p);
}

moray_status moray_track_new(struct track *t, const app_run *run, const struct track_form *form)
{
    *t = (struct track){.run = run, .form = form};
    bool filled = lay_out(t);
    for (int p = 0; p < run->app->spec->phases && filled; p++)
        filled = fill(t, p);
    return filled ? moray_ok() : moray_error(MORAY_MEMORY, "no memory for the trajectory");
}

void moray_track_free(struct track *t)
{
    for (int p = 0; t->place && p < t->run->app->spec->phases; p++)
        free(t->place[p]);
    free(t->place);
    free(t->first);
    free(t->column);
    free(t->values);
}

moray_status moray_track_write(const struct track *t, const char *name)
{
    FILE *file;
    const int skipped = t->run->app->spec->phases == 1; // the number of the only phase
    moray_column *columns = calloc((size_t)t->columns, sizeof *columns);
    if (!columns)
        return moray_error(MORAY_MEMORY, "no memory for the trajectory");
    for (int j = 0; j < t->columns; j++) {
        const struct track_column *column = &t->column[j];
        columns[j] = (moray_column){column->name, *column->unit ? column->unit : NULL, t->values + j, t->columns};
    }
    moray_status status = moray_output_file(t->run->common.output, name, &file);
    if (!moray_failed(status))
        moray_csv_write(file, columns + skipped, t->columns - skipped, t->rows);
    free(columns);
    return status;
}

moray_status moray_track_write_new(const app_run *run, const struct track_form *form, const char *name)
{
    struct track t;
    moray_status status = moray_track_new(&t, run, form), figure = moray_ok();
    if (!moray_failed(status))
        status = moray_track_write(&t, name);
    for (int p = 0; form->draw && p < run->app->spec->phases && !moray_failed(status) && !moray_failed(figure); p++)
        figure = form->draw(&t, p);
    if (!moray_failed(status))
        status = moray_app_drawn(&run->common, run->name, figure);
    moray_track_free(&t);
    return status;
}
