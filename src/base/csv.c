// SPDX-License-Identifier: MIT
#include "base/csv.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/number.h"

static const char blanks[] = " \t";

moray_status moray_csv_error(const moray_csv *csv, int row, moray_status status)
{
    return moray_text_error(&csv->text, row < 0 ? csv->names_line : csv->line[row], status);
}

// ---- Fields --------------------------------------------------------------------------------------------------------

// Cuts a quoted field off, `at` at its quote: "" is a quote within. NULL where the quotes do not close it.
static char *cut_quoted(char *at, char **rest)
{
    char *field = at, *to = at;
    for (at++; *at && (*at != '"' || at[1] == '"'); at++) {
        at += *at == '"';
        *to++ = *at;
    }
    if (*at != '"')
        return NULL;
    at += 1 + strspn(at + 1, blanks);
    if (*at && *at != ',')
        return NULL;
    *rest = *at ? at + 1 : NULL;
    *to = 0;
    return field;
}

// Cuts the first field off *rest, which becomes NULL behind the last. NULL where quotes are out of place.
static char *cut_field(char **rest)
{
    char *field = *rest + strspn(*rest, blanks);
    if (*field == '"')
        return cut_quoted(field, rest);
    char *end = field + strcspn(field, ",");
    *rest = *end ? end + 1 : NULL;
    *end = 0;
    while (end > field && strchr(blanks, end[-1]))
        *--end = 0;
    return strchr(field, '"') ? NULL : field;
}

// The fields of a line, of which the first `most` are kept. Error: MORAY_INPUT about quotes.
static moray_status cut_line(char *line, char **field, int most, int *n)
{
    *n = 0;
    for (char *rest = line; rest; ++*n) {
        char *cut = cut_field(&rest);
        if (!cut)
            return moray_error(MORAY_INPUT, "field %d: quotes must surround the whole field", *n + 1);
        if (*n < most)
            field[*n] = cut;
    }
    return moray_ok();
}

static int count_commas(const char *line)
{
    int commas = 0;
    for (; *line; line++)
        commas += *line == ',';
    return commas;
}

// ---- Lines ---------------------------------------------------------------------------------------------------------

moray_status moray_csv_check_names(const moray_csv *csv)
{
    for (int j = 0; j < csv->columns; j++) {
        if (!*csv->name[j])
            return moray_csv_error(csv, -1, moray_error(MORAY_INPUT, "column %d has no name", j + 1));
        if (moray_csv_find(csv, csv->name[j]) < j)
            return moray_csv_error(csv, -1, moray_error(MORAY_INPUT, "column %.60s is named twice", csv->name[j]));
    }
    return moray_ok();
}

static moray_status read_names(moray_csv *csv, char *line)
{
    csv->names_line = csv->text.at;
    const int most = count_commas(line) + 1;
    csv->name = calloc((size_t)most, sizeof *csv->name);
    csv->line = calloc((size_t)csv->text.n, sizeof *csv->line);
    if (!csv->name || !csv->line)
        return moray_error(MORAY_MEMORY, "%s: no memory to read it", moray_path_tail(csv->text.path));
    moray_status status = cut_line(line, csv->name, most, &csv->columns);
    if (moray_failed(status))
        return moray_csv_error(csv, -1, status);
    csv->field = calloc((size_t)csv->text.n * (size_t)csv->columns, sizeof *csv->field);
    if (!csv->field)
        return moray_error(MORAY_MEMORY, "%s: no memory to read it", moray_path_tail(csv->text.path));
    return moray_csv_check_names(csv);
}

static moray_status read_row(moray_csv *csv, char *line)
{
    const int row = csv->rows;
    int n;
    csv->line[row] = csv->text.at;
    moray_status status = cut_line(line, csv->field + (size_t)row * (size_t)csv->columns, csv->columns, &n);
    if (!moray_failed(status) && n != csv->columns)
        status = moray_error(MORAY_INPUT, "%d field%s, but line %d names %d columns", n, n == 1 ? "" : "s",
                             csv->names_line, csv->columns);
    csv->rows++;
    return moray_failed(status) ? moray_csv_error(csv, row, status) : moray_ok();
}

moray_status moray_csv_read(moray_csv *csv, const char *path, const char *what)
{
    *csv = (moray_csv){0};
    MORAY_TRY(moray_text_read(&csv->text, path, what));
    char *line = moray_text_next(&csv->text);
    if (line)
        MORAY_TRY(read_names(csv, line));
    while (line && (line = moray_text_next(&csv->text)))
        MORAY_TRY(read_row(csv, line));
    if (csv->rows == 0)
        return moray_error(MORAY_INPUT, "%s %s: needs a line of names and a line of values", what,
                           moray_path_tail(path));
    return moray_ok();
}

void moray_csv_free(moray_csv *csv)
{
    moray_text_free(&csv->text);
    free(csv->name);
    free(csv->field);
    free(csv->line);
    *csv = (moray_csv){0};
}

// ---- Columns -------------------------------------------------------------------------------------------------------

int moray_csv_find(const moray_csv *csv, const char *name)
{
    for (int j = 0; j < csv->columns; j++)
        if (strcmp(csv->name[j], name) == 0)
            return j;
    return -1;
}

moray_status moray_csv_find_quantity(const moray_csv *csv, const char *name, int *column)
{
    const size_t length = strlen(name);
    for (*column = 0; *column < csv->columns; ++*column) {
        const char *has = csv->name[*column];
        if (strncmp(has, name, length) == 0 && (has[length] == 0 || strncmp(has + length, " [", 2) == 0))
            return moray_ok();
    }
    return moray_csv_error(csv, -1, moray_error(MORAY_INPUT, "no column %.60s", name));
}

static void list_names(const char *const *names, int n, char *text, size_t size)
{
    size_t used = 0;
    text[0] = 0;
    for (int i = 0; i < n && used < size; i++)
        used += (size_t)snprintf(text + used, size - used, "%s%s", i ? "," : "", names[i]);
}

moray_status moray_csv_match(const moray_csv *csv, const char *const *names, int n, int *column)
{
    char list[100];
    list_names(names, n, list, sizeof list);
    for (int i = 0; i < n; i++)
        if ((column[i] = moray_csv_find(csv, names[i])) < 0)
            return moray_csv_error(csv, -1,
                                   moray_error(MORAY_INPUT, "no column %s: the columns must be %s", names[i], list));
    for (int j = 0; j < csv->columns; j++) {
        int i = 0;
        while (i < n && column[i] != j)
            i++;
        if (i == n)
            return moray_csv_error(
                csv, -1, moray_error(MORAY_INPUT, "unknown column %.60s: the columns must be %s", csv->name[j], list));
    }
    return moray_ok();
}

moray_status moray_csv_number(const moray_csv *csv, int row, int column, double *number)
{
    const char *text = csv->field[(size_t)row * (size_t)csv->columns + (size_t)column];
    if (moray_number_read(text, number))
        return moray_ok();
    return moray_csv_error(
        csv, row,
        moray_error(MORAY_INPUT, "%.60s = %.60s: not a finite number", csv->name[column], *text ? text : "(empty)"));
}

moray_status moray_csv_numbers(const moray_csv *csv, const int *column, int n, double *numbers)
{
    for (int row = 0; row < csv->rows; row++)
        for (int i = 0; i < n; i++)
            MORAY_TRY(moray_csv_number(csv, row, column[i], &numbers[row * n + i]));
    return moray_ok();
}
