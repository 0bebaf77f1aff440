// SPDX-License-Identifier: MIT
#include "moray/app/results.h"

#include <string.h>

static void write_name(FILE *file, const moray_column *column)
{
    const bool quoted = strpbrk(column->name, ",\"\n") || (column->unit && strpbrk(column->unit, ",\"\n"));
    if (quoted)
        fputc('"', file);
    for (const char *c = column->name; *c; c++)
        fputs(*c == '"' ? "\"\"" : (char[]){*c, 0}, file);
    if (column->unit)
        fprintf(file, " [%s]", column->unit);
    if (quoted)
        fputc('"', file);
}

void moray_csv_write(FILE *file, const moray_column *columns, int n_columns, int n_rows)
{
    char text[32];
    for (int j = 0; j < n_columns; j++) {
        write_name(file, &columns[j]);
        fputc(j + 1 < n_columns ? ',' : '\n', file);
    }
    for (int i = 0; i < n_rows; i++)
        for (int j = 0; j < n_columns; j++) {
            const int stride = columns[j].stride ? columns[j].stride : 1;
            fputs(moray_number_text(columns[j].values[(size_t)i * stride], text), file);
            fputc(j + 1 < n_columns ? ',' : '\n', file);
        }
}
