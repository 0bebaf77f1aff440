// SPDX-License-Identifier: MIT
//
// The numbers to be shown, over all points, and where each point stands.
#ifndef PROBLEMS_SWEEP_SHOWN_H
#define PROBLEMS_SWEEP_SHOWN_H

#include <stdio.h>

#include "moray/app/results.h"
#include "sweep/arguments.h"

typedef struct shown_column {
    char title[120];
    double *value; // [points]
} shown_column;

// Of every --show one column; of a pattern two, the least and the most of the numbers that it matches.
typedef struct shown {
    const sweep_arguments *a;
    long points, draws;               // draws: 1 without any
    double *draw[MORAY_SWEEP_RANGES]; // [draws]: of every range
    shown_column column[2 * SWEEP_MOST_SHOWN];
    int n;
} shown;

// Reads them from the file of the sweep; freed by shown_free, whatever came of it. Error: MORAY_INPUT (a number that no
// point has), MORAY_IO, MORAY_MEMORY.
moray_status shown_read(const sweep_arguments *a, shown *s);
void shown_free(shown *s);

// Value of axis k at a point, NaN for words; `word`, where not NULL, is what stands for it.
double shown_setting(const shown *s, long point, int k, const char **word);

// points.csv: a line for each point, of its settings and the numbers.
void shown_csv(const shown *s, FILE *file);

// A table of the same, where there are not too many points for one.
void shown_table(const shown *s, FILE *file);

// For each number the largest difference between points whose values of `key` are opposite and equal elsewise. Nothing
// where --mirror is not given.
void shown_mirror(const shown *s, FILE *file);

// Median and 90th percentile of every number, alone and minus the first one, as a table of these rows. Error:
// MORAY_MEMORY.
moray_status shown_quantiles(const shown *s, moray_table_row row[2 * SWEEP_MOST_SHOWN], moray_table *table);

#endif
