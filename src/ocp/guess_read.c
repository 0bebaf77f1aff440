// SPDX-License-Identifier: MIT
//
// Guesses from comma-separated values with a line of names.
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "ocp/samples.h"

struct table {
    const char *path;
    int columns, rows, room;
    char **name; // without units
    double *values;
};

static void table_free(struct table *t)
{
    for (int j = 0; t->name && j < t->columns; j++)
        free(t->name[j]);
    free(t->name);
    free(t->values);
}

// ---- Reading ----

// Cuts the first field off *rest, unquoted in place; NULL at the end of the line.
static char *next_field(char **rest)
{
    char *field = *rest, *to = field;
    if (!field)
        return NULL;
    bool quoted = false;
    char *from = field;
    for (; *from && *from != '\n' && *from != '\r' && (quoted || *from != ','); from++) {
        if (*from == '"' && quoted && from[1] == '"')
            *to++ = *from++;
        else if (*from == '"')
            quoted = !quoted;
        else
            *to++ = *from;
    }
    *rest = *from == ',' ? from + 1 : NULL;
    *to = 0;
    return field;
}

// "v [m/s]" is v; but "x[2]" is itself.
static void cut_unit(char *name)
{
    char *unit = strstr(name, " [");
    if (unit)
        *unit = 0;
}

static moray_status read_names(struct table *t, char *line)
{
    int commas = 0;
    for (const char *c = line; *c; c++)
        commas += *c == ',';
    t->name = calloc((size_t)commas + 1, sizeof *t->name);
    for (char *field; t->name && (field = next_field(&line));) {
        cut_unit(field);
        t->name[t->columns] = strdup(field);
        if (!t->name[t->columns++])
            return moray_error(MORAY_MEMORY, "no memory for %s", t->path);
    }
    return t->name ? moray_ok() : moray_error(MORAY_MEMORY, "no memory for %s", t->path);
}

static moray_status read_row(struct table *t, char *line, int number)
{
    if (t->rows == t->room) {
        const int room = 2 * t->room + 64;
        double *larger = realloc(t->values, (size_t)room * t->columns * sizeof *larger);
        if (!larger)
            return moray_error(MORAY_MEMORY, "no memory for %s", t->path);
        t->values = larger;
        t->room = room;
    }
    double *row = t->values + (size_t)t->rows * t->columns;
    for (int j = 0; j < t->columns; j++) {
        char *field = next_field(&line), *end = field;
        if (!field)
            return moray_error(MORAY_INPUT, "%s, line %d: %d fields, the first line has %d", t->path, number, j,
                               t->columns);
        row[j] = *field ? strtod(field, &end) : NAN;
        if (*end)
            return moray_error(MORAY_INPUT, "%s, line %d: %s = %.40s: not a number", t->path, number, t->name[j],
                               field);
    }
    t->rows++;
    return moray_ok();
}

static moray_status read_table(struct table *t)
{
    FILE *file = fopen(t->path, "r");
    if (!file)
        return moray_error(MORAY_IO, "%s: %s", t->path, strerror(errno));
    char *line = NULL;
    size_t size = 0;
    moray_status status = moray_ok();
    for (int number = 1; !moray_failed(status) && getline(&line, &size, file) >= 0; number++)
        if (line[strspn(line, " \t\r\n")])
            status = t->name ? read_row(t, line, number) : read_names(t, line);
    if (!moray_failed(status) && ferror(file))
        status = moray_error(MORAY_IO, "%s: %s", t->path, strerror(errno));
    free(line);
    fclose(file);
    if (!moray_failed(status) && t->rows == 0)
        return moray_error(MORAY_INPUT, "%s: needs a line of names and one of numbers", t->path);
    return status;
}

// ---- Matching ----

static int find_column(const struct table *t, const char *name)
{
    for (int j = 0; j < t->columns; j++)
        if (strcmp(t->name[j], name) == 0)
            return j;
    return -1;
}

// Columns of the time, states and controls of a phase in place[1 + nx + nu].
static moray_status match_phase(const struct table *t, const moray_ocp *ocp, int p, int *place)
{
    const struct phase *phase = &ocp->phase[p];
    char name[120] = "t";
    for (int i = 0; i < 1 + phase->nx + phase->nu; i++) {
        const bool state = i - 1 < phase->nx;
        const int entry = state ? i - 1 : i - 1 - phase->nx;
        const char *const *names = state ? phase->x_names : phase->u_names;
        if (i > 0 && names)
            snprintf(name, sizeof name, "%s", names[entry]);
        else if (i > 0)
            snprintf(name, sizeof name, "%s[%d]", state ? "x" : "u", entry);
        place[i] = find_column(t, name);
        if (place[i] < 0)
            return moray_error(MORAY_INPUT, "%s: no column %s, which phase %s needs", t->path, name, phase->name);
    }
    return moray_ok();
}

static bool belongs(const struct table *t, int column, int row, int p)
{
    return column < 0 || t->values[(size_t)row * t->columns + column] == p + 1;
}

static void copy_phase(const struct table *t, const struct phase *phase, int p, int column, const int *place,
                       struct samples *samples)
{
    int k = 0;
    for (int row = 0; row < t->rows; row++) {
        const double *values = t->values + (size_t)row * t->columns;
        if (!belongs(t, column, row, p))
            continue;
        samples->time[k] = values[place[0]];
        for (int i = 0; i < phase->nx; i++)
            samples->x[k * phase->nx + i] = values[place[1 + i]];
        for (int i = 0; i < phase->nu; i++)
            samples->u[k * phase->nu + i] = values[place[1 + phase->nx + i]];
        k++;
    }
}

static moray_status fill_phases(const struct table *t, const moray_ocp *ocp, int column, const int *rows,
                                moray_guess *guess)
{
    int widest = 0;
    for (int p = 0; p < ocp->phases; p++)
        widest = ocp->phase[p].nx + ocp->phase[p].nu > widest ? ocp->phase[p].nx + ocp->phase[p].nu : widest;
    struct samples *samples = calloc((size_t)ocp->phases, sizeof *samples);
    int *place = calloc((size_t)widest + 1, sizeof *place);
    moray_status status = moray_error(MORAY_MEMORY, "no memory for %s", t->path);
    if (samples && place)
        status = moray_guess_allocate(guess, ocp, rows, false, samples, NULL);
    for (int p = 0; p < ocp->phases && !moray_failed(status); p++) {
        status = match_phase(t, ocp, p, place);
        if (!moray_failed(status))
            copy_phase(t, &ocp->phase[p], p, column, place, &samples[p]);
    }
    free(samples);
    free(place);
    return status;
}

static moray_status fill_guess_from(const struct table *t, const moray_ocp *ocp, moray_guess *guess)
{
    const int column = ocp->phases > 1 ? find_column(t, "phase") : -1;
    if (ocp->phases > 1 && column < 0)
        return moray_error(MORAY_INPUT, "%s: no column phase, which a problem of %d phases needs", t->path,
                           ocp->phases);
    int *rows = calloc((size_t)ocp->phases, sizeof *rows);
    moray_status status = rows ? moray_ok() : moray_error(MORAY_MEMORY, "no memory for %s", t->path);
    for (int p = 0; p < ocp->phases && !moray_failed(status); p++) {
        for (int row = 0; row < t->rows; row++)
            rows[p] += belongs(t, column, row, p);
        if (rows[p] == 0)
            status = moray_error(MORAY_INPUT, "%s: no line of phase %d, %s", t->path, p + 1, ocp->phase[p].name);
    }
    if (!moray_failed(status))
        status = fill_phases(t, ocp, column, rows, guess);
    free(rows);
    return status;
}

moray_status moray_guess_read(moray_guess *guess, const moray_ocp *ocp, const char *path)
{
    struct table t = {.path = path};
    *guess = (moray_guess){0};
    moray_status status = read_table(&t);
    if (!moray_failed(status))
        status = fill_guess_from(&t, ocp, guess);
    if (moray_failed(status))
        moray_guess_free(guess);
    table_free(&t);
    return status;
}
