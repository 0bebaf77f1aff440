// SPDX-License-Identifier: MIT
#include "results/results.h"

#include <math.h>
#include <stdarg.h>
#include <string.h>

#include "base/number.h"
#include "base/text.h"

// A value as tables show it: whole numbers in full, others with four significant digits, NaN as "".
static const char *table_number(double value, char text[32])
{
    const locale_t before = moray_c_locale_begin();
    if (isnan(value))
        text[0] = 0;
    else if (value == round(value) && fabs(value) < 1e9)
        snprintf(text, 32, "%.0f", value + 0.0); // -0 becomes 0
    else
        snprintf(text, 32, "%.4g", value);
    moray_c_locale_end(before);
    return text;
}

const char *moray_table_cell(const moray_table_row *row, int j, char text[32])
{
    if (!row->text)
        return table_number(row->value[j], text);
    return j == 0 ? row->text : "";
}

// Characters of UTF-8, counted by their first bytes.
static int width(const char *text)
{
    int n = 0;
    for (; text && *text; text++)
        n += ((unsigned char)*text & 0xC0) != 0x80;
    return n;
}

static void widen(int *to, const char *text)
{
    const int own = width(text);
    *to = own > *to ? own : *to;
}

// Prints a text in a column, and before it the blanks that earlier columns left; returns those that it leaves itself.
static int print_cell(FILE *file, int blanks, const char *text, int to, bool right)
{
    const int own = to - width(text);
    if (width(text) == 0)
        return blanks + own;
    fprintf(file, "%*s%s", blanks + (right ? own : 0), "", text);
    return right ? 0 : own;
}

static void print_line(FILE *file, const char *label, int label_width, const char *const *cell, const int *column,
                       int n, const char *unit)
{
    int blanks = print_cell(file, 0, label, label_width, false);
    for (int j = 0; j < n; j++)
        blanks = print_cell(file, blanks + 2, cell[j], column[j], true);
    print_cell(file, blanks + 2, unit, 0, false);
    fputc('\n', file);
}

void moray_table_print(const moray_table *table, FILE *file)
{
    int label = 0, column[MORAY_TABLE_COLUMNS] = {0};
    char text[MORAY_TABLE_COLUMNS][32];
    const char *cell[MORAY_TABLE_COLUMNS];
    bool headed = false;
    for (int j = 0; j < table->n_columns; j++) {
        headed = headed || table->columns[j];
        widen(&column[j], table->columns[j]);
        for (int i = 0; i < table->n_rows; i++)
            widen(&column[j], moray_table_cell(&table->rows[i], j, text[j]));
    }
    for (int i = 0; i < table->n_rows; i++)
        widen(&label, table->rows[i].label);
    if (table->title)
        fprintf(file, "%s\n", table->title);
    if (headed)
        print_line(file, NULL, label, table->columns, column, table->n_columns, NULL);
    for (int i = 0; i < table->n_rows; i++) {
        for (int j = 0; j < table->n_columns; j++)
            cell[j] = moray_table_cell(&table->rows[i], j, text[j]);
        print_line(file, table->rows[i].label, label, cell, column, table->n_columns, table->rows[i].unit);
    }
}

void moray_tables_print(const moray_table *tables, int n, FILE *file)
{
    for (int k = 0; k < n; k++) {
        moray_table_print(&tables[k], file);
        fputc('\n', file);
    }
}

void moray_text_add(char *text, size_t size, const char *format, ...)
{
    const size_t used = strlen(text);
    va_list arguments;
    va_start(arguments, format);
    const int length = vsnprintf(text + used, size - used, format, arguments);
    va_end(arguments);
    if (length >= (int)(size - used))
        moray_cut_at_word(text, size);
}
