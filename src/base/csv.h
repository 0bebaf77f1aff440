// SPDX-License-Identifier: MIT
//
// The one reader of comma-separated values. Tolerant in form: what text.h takes, blanks around fields, blank lines,
// comments behind # on lines of their own, quotes. Strict in meaning: a line of names, none empty and none twice; as
// many fields in every line; numbers are those of the C locale and finite.
#ifndef SRC_BASE_CSV_H
#define SRC_BASE_CSV_H

#include "base/text.h"

typedef struct moray_csv {
    moray_text text;
    int columns, rows;
    char **name;    // [columns]
    char **field;   // [rows][columns], without blanks and quotes
    int *line;      // [rows], from 1
    int names_line; // from 1
} moray_csv;

// `what` the file is, as in "schedule". Error: those of moray_text_read; MORAY_INPUT naming the line, or that there is
// no line of names and one of values. Free with moray_csv_free in any case. The path must outlive the table.
moray_status moray_csv_read(moray_csv *csv, const char *path, const char *what);
void moray_csv_free(moray_csv *csv);

// The column of that name; -1 where there is none.
int moray_csv_find(const moray_csv *csv, const char *name);

// The column of that name, behind which a unit in brackets may stand, as in "v [m/s]". Error: MORAY_INPUT where there
// is none.
moray_status moray_csv_find_quantity(const moray_csv *csv, const char *name, int *column);

// Error: MORAY_INPUT where a name is empty or stands twice.
moray_status moray_csv_check_names(const moray_csv *csv);

// The columns of n names, which must be those of the table in any order. Error: MORAY_INPUT naming what is missing or
// not known.
moray_status moray_csv_match(const moray_csv *csv, const char *const *names, int n, int *column);

// The number in a row and column. Error: MORAY_INPUT naming the line, the column and the text.
moray_status moray_csv_number(const moray_csv *csv, int row, int column, double *number);

// All rows of these columns: numbers[rows][n].
moray_status moray_csv_numbers(const moray_csv *csv, const int *column, int n, double *numbers);

// An error behind the file's name and the line of the row.
moray_status moray_csv_error(const moray_csv *csv, int row, moray_status status);

#endif
