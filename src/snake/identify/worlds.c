// SPDX-License-Identifier: MIT
//
// Worlds that an identification leaves possible, as a file of comma-separated values: a name and any unknowns.
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/csv.h"
#include "moray/app/results.h"
#include "snake/identify/identify.h"

static const double half_width = 1.959964; // of 95 % of the normal distribution
static const double widest = 0.5;          // of a scale: as far as a direction that is open is gone

int moray_identify_worlds(const moray_identify *v, const moray_estimate *at, const moray_information *info,
                          double inflation, int most, moray_unknowns *world)
{
    const int n = v->spec.n;
    int worlds = 0, used = 0;
    world[worlds++] = moray_identify_world_of(v, at->value);
    for (int k = 0; k < n; k++)
        used += !info->held[k];
    for (int k = used - 1; k >= 0 && worlds + 2 <= most; k--) { // the least known direction first
        const double error = info->value[k] > 0 ? inflation * half_width / sqrt(info->value[k]) : INFINITY;
        for (int side = -1; side <= 1; side += 2) {
            double value[MORAY_MOST_UNKNOWNS];
            for (int i = 0; i < n; i++) {
                value[i] = at->value[i] + side * fmin(error, widest) * info->vector[k * n + i] * v->scale[i];
                value[i] = fmax(v->lower[i], fmin(v->upper[i], value[i]));
            }
            world[worlds++] = moray_identify_world_of(v, value);
        }
    }
    return worlds;
}

// ---- Files ---------------------------------------------------------------------------------------------------------

void moray_worlds_write(const moray_unknowns *world, int n, const int *unknown, int unknowns, FILE *file)
{
    fputs("name", file);
    for (int k = 0; k < unknowns; k++)
        fprintf(file, ",%s [%s]", moray_unknown_name(unknown[k]), moray_unknown_unit(unknown[k]));
    fputs("\n", file);
    for (int i = 0; i < n; i++) {
        moray_unknowns one = world[i];
        char number[32];
        if (i == 0)
            fputs("identified", file);
        else
            fprintf(file, "axis_%d%c", (i + 1) / 2, i % 2 ? '-' : '+');
        for (int k = 0; k < unknowns; k++)
            fprintf(file, ",%s", moray_number_text(*moray_unknown_at(unknown[k], &one), number));
        fputs("\n", file);
    }
}

// The unknown of a column, behind whose name a unit may stand.
static int unknown_of(const char *column)
{
    char name[80];
    snprintf(name, sizeof name, "%.*s", (int)strcspn(column, " ["), column);
    return moray_unknown_named(name);
}

static moray_status read_rows(const moray_csv *csv, const moray_unknowns *base, int most, moray_unknowns *world,
                              moray_world_name *name, int *n)
{
    const int named = moray_csv_find(csv, "name");
    if (csv->rows > most)
        return moray_csv_error(csv, most, moray_error(MORAY_INPUT, "more than %d scenarios", most));
    for (int j = 0; j < csv->columns; j++)
        if (j != named && unknown_of(csv->name[j]) < 0)
            return moray_csv_error(csv, -1,
                                   moray_error(MORAY_INPUT,
                                               "column %.60s: must be name or what can be identified (c_t, "
                                               "c_n, ..., current_x, current_y)",
                                               csv->name[j]));
    for (*n = 0; *n < csv->rows; ++*n) {
        world[*n] = *base;
        snprintf(name[*n].text, sizeof name->text, "row %d", *n + 1);
        for (int j = 0; j < csv->columns; j++) {
            if (j == named)
                snprintf(name[*n].text, sizeof name->text, "%s", csv->field[*n * csv->columns + j]);
            else
                MORAY_TRY(moray_csv_number(csv, *n, j, moray_unknown_at(unknown_of(csv->name[j]), &world[*n])));
        }
        const moray_status status = moray_robot_check(&world[*n].robot);
        if (moray_failed(status))
            return moray_csv_error(csv, *n, status);
    }
    return moray_ok();
}

moray_status moray_worlds_read(const char *path, const moray_unknowns *base, int most, moray_unknowns *world,
                               moray_world_name *name, int *n)
{
    moray_csv csv;
    *n = 0;
    moray_status status = moray_csv_read(&csv, path, "scenarios");
    if (!moray_failed(status))
        status = read_rows(&csv, base, most, world, name, n);
    moray_csv_free(&csv);
    return status;
}
