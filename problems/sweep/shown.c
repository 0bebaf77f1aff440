// SPDX-License-Identifier: MIT
#include "sweep/shown.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static moray_status read_column(shown *s, const char *name)
{
    long n;
    shown_column *column = &s->column[s->n];
    if (!strchr(name, '*')) {
        snprintf(column->title, sizeof column->title, "%.110s", name);
        s->n++;
        return moray_sweep_numbers(s->a->file, name, &column->value, &n);
    }
    snprintf(column[0].title, sizeof column->title, "least %.100s", name);
    snprintf(column[1].title, sizeof column->title, "most %.100s", name);
    s->n += 2;
    return moray_sweep_extremes(s->a->file, name, &column[0].value, &column[1].value, &n);
}

moray_status shown_read(const sweep_arguments *a, shown *s)
{
    moray_status status = moray_ok();
    *s = (shown){.a = a, .draws = a->draws > 0 ? a->draws : 1};
    s->points = s->draws;
    for (int k = 0; k < a->axes; k++)
        s->points *= a->axis[k].n;
    for (int r = 0; r < a->ranges && !moray_failed(status); r++) {
        long n;
        status = moray_sweep_numbers(a->file, a->range[r].key, &s->draw[r], &n);
    }
    for (int k = 0; k < a->shown && !moray_failed(status); k++)
        status = read_column(s, a->show[k]);
    return status;
}

void shown_free(shown *s)
{
    for (int r = 0; r < MORAY_SWEEP_RANGES; r++)
        free(s->draw[r]);
    for (int k = 0; k < s->n; k++)
        free(s->column[k].value);
    *s = (shown){0};
}

// How many points lie between two neighbours of axis k.
static long step_of(const shown *s, int k)
{
    long step = 1;
    for (int other = k + 1; other < s->a->axes; other++)
        step *= s->a->axis[other].n;
    return step;
}

static long place_of(const shown *s, long point, int k)
{
    return point / step_of(s, k) % s->a->axis[k].n;
}

double shown_setting(const shown *s, long point, int k, const char **word)
{
    const moray_sweep_axis *axis = &s->a->axis[k];
    const long i = place_of(s, point, k);
    if (word)
        *word = axis->value ? NULL : axis->word[i];
    return axis->value ? axis->value[i] : NAN;
}

static double drawn(const shown *s, long point, int r)
{
    return s->draw[r][point / (s->points / s->draws)];
}

static void csv_text(const char *text, FILE *file)
{
    putc('"', file);
    for (; *text; text++) {
        if (*text == '"')
            putc('"', file);
        putc(*text, file);
    }
    putc('"', file);
}

static void csv_line(const shown *s, long point, FILE *file)
{
    const char *comma = "";
    for (int r = 0; r < s->a->ranges; r++, comma = ",")
        fprintf(file, "%s%.17g", comma, drawn(s, point, r));
    for (int k = 0; k < s->a->axes; k++, comma = ",") {
        const char *word;
        const double value = shown_setting(s, point, k, &word);
        fputs(comma, file);
        if (word)
            csv_text(word, file);
        else
            fprintf(file, "%.17g", value);
    }
    for (int k = 0; k < s->n; k++)
        if (isfinite(s->column[k].value[point]))
            fprintf(file, ",%.17g", s->column[k].value[point]);
        else
            putc(',', file);
    putc('\n', file);
}

void shown_csv(const shown *s, FILE *file)
{
    const char *comma = "";
    for (int r = 0; r < s->a->ranges; r++, comma = ",")
        fprintf(file, "%s%s", comma, s->a->range[r].key);
    for (int k = 0; k < s->a->axes; k++, comma = ",")
        fprintf(file, "%s%s", comma, s->a->axis[k].key);
    for (int k = 0; k < s->n; k++)
        fprintf(file, ",%s", s->column[k].title);
    putc('\n', file);
    for (long point = 0; point < s->points; point++)
        csv_line(s, point, file);
}

static void table_line(const shown *s, long point, FILE *file)
{
    for (int r = 0; r < s->a->ranges; r++)
        fprintf(file, "%14.5g", drawn(s, point, r));
    for (int k = 0; k < s->a->axes; k++) {
        const char *word;
        const double value = shown_setting(s, point, k, &word);
        if (word)
            fprintf(file, "  %s", word);
        else
            fprintf(file, "%14.5g", value);
    }
    for (int k = 0; k < s->n; k++)
        if (isfinite(s->column[k].value[point]))
            fprintf(file, "%10.4g", s->column[k].value[point]);
        else
            fprintf(file, "%10s", "-");
    putc('\n', file);
}

void shown_table(const shown *s, FILE *file)
{
    enum { longest = 1000 };
    if (s->n == 0 || s->points > longest)
        return;
    for (int k = 0; k < s->n; k++)
        fprintf(file, "(%d) %s\n", k + 1, s->column[k].title);
    putc('\n', file);
    for (int r = 0; r < s->a->ranges; r++)
        fprintf(file, "%14.14s", s->a->range[r].key);
    for (int k = 0; k < s->a->axes; k++)
        fprintf(file, s->a->axis[k].value ? "%14.14s" : "  %s", s->a->axis[k].key);
    for (int k = 0; k < s->n; k++)
        fprintf(file, "%8s%d)", k < 9 ? "(" : "(", k + 1);
    putc('\n', file);
    for (long point = 0; point < s->points; point++)
        table_line(s, point, file);
    putc('\n', file);
}

// The point whose value of axis k is the opposite, -1: there is none.
static long opposite(const shown *s, long point, int k)
{
    const moray_sweep_axis *axis = &s->a->axis[k];
    const long place = place_of(s, point, k);
    for (int i = 0; i < axis->n; i++)
        if (i != place && fabs(axis->value[i] + axis->value[place]) < 1e-9 * (1 + fabs(axis->value[i])))
            return point + (i - place) * step_of(s, k);
    return -1;
}

static void compare(const shown *s, const shown_column *column, int axis, FILE *file)
{
    double most = 0, size = 0;
    long worst = -1, pairs = 0;
    for (long point = 0; point < s->points; point++) {
        const long other = opposite(s, point, axis);
        const double here = column->value[point], there = other < 0 ? NAN : column->value[other];
        size = isfinite(here) ? fmax(size, fabs(here)) : size;
        if (other < point || !isfinite(here) || !isfinite(there))
            continue;
        pairs++;
        if (worst < 0 || fabs(here - there) > most) {
            most = fabs(here - there);
            worst = point;
        }
    }
    fprintf(file, "  %-50s %10.2g of %.4g, %ld pairs", column->title, most, size, pairs);
    for (int k = 0; worst >= 0 && most > 0 && k < s->a->axes; k++)
        if (s->a->axis[k].value)
            fprintf(file, "%s %s %.4g", k ? "," : "; at", s->a->axis[k].key, shown_setting(s, worst, k, NULL));
    putc('\n', file);
}

void shown_mirror(const shown *s, FILE *file)
{
    int axis = -1;
    for (int k = 0; s->a->mirror && k < s->a->axes; k++)
        if (strcmp(s->a->axis[k].key, s->a->mirror) == 0 && s->a->axis[k].value)
            axis = k;
    if (axis < 0)
        return;
    fprintf(file, "Largest difference between points with opposite %s\n", s->a->mirror);
    for (int k = 0; k < s->n; k++)
        compare(s, &s->column[k], axis, file);
    putc('\n', file);
}
