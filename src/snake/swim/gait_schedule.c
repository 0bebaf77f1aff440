// SPDX-License-Identifier: MIT
#include "moray/snake/gait_input.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "options/options.h"

enum { MOST_COLUMNS = 16 };

// What a line says, on top of the line before.
typedef struct {
    double t;
    moray_gait_input gait;
} line_values;

static const moray_option columns[] = {
    {.section = "gait",
     .key = "t_s",
     .type = MORAY_OPTION_REAL,
     MORAY_AT(line_values, t),
     .max = INFINITY,
     .unit = "s"},
    MORAY_GAIT_OPTIONS(line_values, gait),
};
static const moray_options table = {.row = (moray_option *)columns, .n = sizeof columns / sizeof *columns};

typedef struct {
    const char *path;
    FILE *file;
    char *line; // getline's
    size_t size;
    int number;                               // of the line
    const moray_option *column[MOST_COLUMNS]; // as the first line names them
    int n_columns;
    moray_gait_change *change;
    int n, lines; // gaits; of them, those that came from a line
} schedule;

static moray_status at_line(const schedule *s, moray_status status)
{
    const size_t length = strlen(s->path), shown = 80;
    const char *tail = length > shown ? s->path + length - shown : s->path;
    return moray_error(status.code, "%s:%d: %s", tail, s->number, status.text);
}

// The next line that counts; false at the end of the file.
static bool next_line(schedule *s)
{
    while (getline(&s->line, &s->size, s->file) >= 0) {
        s->number++;
        if (s->number == 1 && strncmp(s->line, "\xEF\xBB\xBF", 3) == 0) // byte-order mark
            memmove(s->line, s->line + 3, strlen(s->line + 3) + 1);
        const char first = s->line[strspn(s->line, " \t\r\n")];
        if (first && first != '#')
            return true;
    }
    return false;
}

// The next cell without the blanks around it; *rest moves past it, to NULL after the last.
static char *next_cell(char **rest)
{
    static const char blanks[] = " \t\r\n";
    char *cell = *rest, *end = cell + strcspn(cell, ",");
    *rest = *end ? end + 1 : NULL;
    *end = 0;
    cell += strspn(cell, blanks);
    while (*cell && strchr(blanks, cell[strlen(cell) - 1]))
        cell[strlen(cell) - 1] = 0;
    return cell;
}

static moray_status read_names(schedule *s)
{
    char *rest = s->line;
    bool has_time = false;
    while (rest) {
        const char *name = next_cell(&rest);
        const moray_option *column = moray_option_find(&table, name);
        if (!column)
            return moray_option_unknown(&table, name);
        for (int i = 0; i < s->n_columns; i++)
            if (s->column[i] == column)
                return moray_error(MORAY_INPUT, "column %s is named twice", name);
        s->column[s->n_columns++] = column;
        has_time = has_time || column == &columns[0];
    }
    return has_time ? moray_ok() : moray_error(MORAY_INPUT, "a schedule needs a column t_s");
}

static bool is_one_of(const char *key, const char *const *keys)
{
    while (*keys && strcmp(key, *keys) != 0)
        keys++;
    return *keys;
}

// An amplitude or an offset takes the place of what the line before said in other terms.
static void forget_rivals(const char *key, moray_gait_input *gait)
{
    if (is_one_of(key, (const char *const[]){"theta_max_deg", "a_m", "alpha_deg", NULL}))
        gait->theta_max = gait->a = gait->alpha = NAN;
    if (is_one_of(key, (const char *const[]){"phi0_m", "phi0_deg", NULL}))
        gait->phi0_m = gait->phi0 = NAN;
}

static moray_status read_values(const schedule *s, line_values *values)
{
    char *cell[MOST_COLUMNS], *rest = s->line;
    int n = 0;
    for (; rest && n < s->n_columns; n++)
        cell[n] = next_cell(&rest);
    if (rest || n < s->n_columns)
        return moray_error(MORAY_INPUT, "%s values than the %d columns named in the first line",
                           rest ? "more" : "fewer", s->n_columns);
    values->t = NAN;
    for (int i = 0; i < n; i++)
        if (*cell[i])
            forget_rivals(s->column[i]->key, &values->gait);
    for (int i = 0; i < n; i++)
        if (*cell[i])
            MORAY_TRY(moray_option_read(s->column[i], s->column[i]->key, cell[i], values));
    return isnan(values->t) ? moray_error(MORAY_INPUT, "t_s is empty") : moray_ok();
}

static moray_status add(schedule *s, double t, const moray_gait *gait)
{
    if (s->lines > 0 && t <= s->change[s->n - 1].t)
        return moray_error(MORAY_INPUT, "t_s = %.10g: must lie after that of the line before, %.10g", t,
                           s->change[s->n - 1].t);
    if (s->lines == 0 && t == 0)
        s->n = 0; // instead of the gait that was to be the first
    moray_gait_change *grown = realloc(s->change, (size_t)(s->n + 1) * sizeof *grown);
    if (!grown)
        return moray_error(MORAY_MEMORY, "no memory for %d gaits", s->n + 1);
    s->change = grown;
    s->change[s->n++] = (moray_gait_change){t, *gait};
    return moray_ok();
}

static moray_status read_line(schedule *s, const moray_robot *robot, moray_model model, line_values *values)
{
    moray_gait gait;
    MORAY_TRY(read_values(s, values));
    MORAY_TRY(moray_gait_input_make(&values->gait, robot, model, &gait));
    MORAY_TRY(add(s, values->t, &gait));
    s->lines++;
    return moray_ok();
}

static moray_status read_lines(schedule *s, const moray_gait_input *first, const moray_robot *robot, moray_model model)
{
    line_values values = {.gait = *first};
    moray_gait gait;
    MORAY_TRY(moray_gait_input_make(first, robot, model, &gait));
    MORAY_TRY(add(s, 0, &gait));
    if (next_line(s)) {
        const moray_status status = read_names(s);
        if (moray_failed(status))
            return at_line(s, status);
    }
    while (next_line(s)) {
        const moray_status status = read_line(s, robot, model, &values);
        if (moray_failed(status))
            return at_line(s, status);
    }
    if (ferror(s->file))
        return moray_error(MORAY_IO, "schedule %.100s: cannot be read: %s", s->path, strerror(errno));
    if (s->lines == 0)
        return moray_error(MORAY_INPUT, "schedule %.100s: needs a line of names, t_s among them, and a line a gait",
                           s->path);
    return moray_ok();
}

moray_status moray_gait_schedule_read(const char *path, const moray_gait_input *first, const moray_robot *robot,
                                      moray_model model, moray_gait_change **changes, int *n)
{
    schedule s = {.path = path, .file = fopen(path, "r")};
    *changes = NULL;
    *n = 0;
    if (!s.file)
        return moray_error(MORAY_IO, "schedule %.100s: cannot be opened: %s", path, strerror(errno));
    const moray_status status = read_lines(&s, first, robot, model);
    free(s.line);
    fclose(s.file);
    if (moray_failed(status)) {
        free(s.change);
        return status;
    }
    *changes = s.change;
    *n = s.n;
    return status;
}
