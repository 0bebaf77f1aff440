// SPDX-License-Identifier: MIT
#include "moray/snake/gait_input.h"

#include <stdlib.h>
#include <string.h>

#include "base/csv.h"
#include "options/options.h"

enum { MOST_COLUMNS = 16 };

// What a line says, on top of the line before.
typedef struct {
    double t;
    moray_gait_input gait;
} line_values;

static const moray_option columns[] = {
    MORAY_ROW(REAL, line_values, t, "gait", "t_s", .max = INFINITY, .unit = "s"),
    MORAY_GAIT_OPTIONS(line_values, gait),
};
_Static_assert(sizeof columns / sizeof *columns <= MOST_COLUMNS, "a column each");
static const moray_options table = {.row = columns, .n = sizeof columns / sizeof *columns};

typedef struct {
    moray_csv csv;
    const moray_option *column[MOST_COLUMNS]; // as the line of names has them
    moray_gait_change *change;
    int n, lines; // gaits; of them, those that came from a line
} schedule;

static moray_status read_names(schedule *s)
{
    for (int j = 0; j < s->csv.columns; j++) {
        const moray_option *column = moray_option_find(&table, s->csv.name[j]);
        if (!column)
            return moray_option_unknown(&table, s->csv.name[j]);
        s->column[j] = column; // no name stands twice, so that there are no more than the table has
    }
    if (moray_csv_find(&s->csv, "t_s") < 0)
        return moray_error(MORAY_INPUT, "a schedule needs a column t_s");
    return moray_ok();
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

static moray_status read_values(const schedule *s, int row, line_values *values)
{
    char **cell = s->csv.field + (size_t)row * (size_t)s->csv.columns;
    values->t = NAN;
    for (int i = 0; i < s->csv.columns; i++)
        if (*cell[i])
            forget_rivals(s->column[i]->key, &values->gait);
    for (int i = 0; i < s->csv.columns; i++)
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

static moray_status read_line(schedule *s, int row, const moray_robot *robot, moray_model model, line_values *values)
{
    moray_gait gait;
    MORAY_TRY(read_values(s, row, values));
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
    moray_status status = read_names(s);
    if (moray_failed(status))
        return moray_csv_error(&s->csv, -1, status);
    for (int row = 0; row < s->csv.rows; row++) {
        status = read_line(s, row, robot, model, &values);
        if (moray_failed(status))
            return moray_csv_error(&s->csv, row, status);
    }
    return moray_ok();
}

moray_status moray_gait_schedule_read(const char *path, const moray_gait_input *first, const moray_robot *robot,
                                      moray_model model, moray_gait_change **changes, int *n)
{
    schedule s = {.n = 0};
    *changes = NULL;
    *n = 0;
    moray_status status = moray_csv_read(&s.csv, path, "schedule");
    if (!moray_failed(status))
        status = read_lines(&s, first, robot, model);
    moray_csv_free(&s.csv);
    if (moray_failed(status)) {
        free(s.change);
        return status;
    }
    *changes = s.change;
    *n = s.n;
    return status;
}
