// SPDX-License-Identifier: MIT
#include "results.h"

#include <math.h>

const char *moray_table_number(double value, char text[32])
{
    if (isnan(value))
        text[0] = 0;
    else if (value == round(value) && fabs(value) < 1e9)
        snprintf(text, 32, "%.0f", value + 0.0); // -0 becomes 0
    else
        snprintf(text, 32, "%.4g", value);
    return text;
}

const char *moray_table_cell(const moray_table_row *row, int j, char text[32])
{
    if (!row->text)
        return moray_table_number(row->value[j], text);
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

static void print_left(FILE *file, const char *text, int to)
{
    fprintf(file, "%s%*s", text ? text : "", to - width(text), "");
}

static void print_right(FILE *file, const char *text, int to)
{
    fprintf(file, "%*s%s", to - width(text), "", text ? text : "");
}

static void print_heads(const moray_table *table, FILE *file, int label, const int *column)
{
    int last = table->n_columns;
    while (last > 0 && !table->columns[last - 1])
        last--;
    if (last == 0)
        return;
    print_left(file, "", label);
    for (int j = 0; j < last; j++) {
        fputs("  ", file);
        print_right(file, table->columns[j], column[j]);
    }
    fputc('\n', file);
}

void moray_table_print(const moray_table *table, FILE *file)
{
    int label = 0, column[MORAY_TABLE_COLUMNS] = {0};
    char text[32];
    for (int j = 0; j < table->n_columns; j++)
        widen(&column[j], table->columns[j]);
    for (int i = 0; i < table->n_rows; i++) {
        widen(&label, table->rows[i].label);
        for (int j = 0; j < table->n_columns; j++)
            widen(&column[j], moray_table_cell(&table->rows[i], j, text));
    }
    if (table->title)
        fprintf(file, "%s\n", table->title);
    print_heads(table, file, label, column);
    for (int i = 0; i < table->n_rows; i++) {
        print_left(file, table->rows[i].label, label);
        for (int j = 0; j < table->n_columns; j++) {
            fputs("  ", file);
            print_right(file, moray_table_cell(&table->rows[i], j, text), column[j]);
        }
        const char *unit = table->rows[i].unit;
        fprintf(file, "%s%s\n", unit ? "  " : "", unit ? unit : "");
    }
}
