// SPDX-License-Identifier: MIT
//
// Numbers over all points as a sample, and against the first of them point by point.
#include <math.h>
#include <stdlib.h>

#include "moray/app/results.h"
#include "moray/number.h"
#include "sweep/shown.h"

// Values minus those of `from` (NULL: nothing) where there are both.
static long sample(const shown *s, const double *value, const double *from, double *drawn)
{
    long n = 0;
    for (long k = 0; k < s->points; k++) {
        const double x = value[k] - (from ? from[k] : 0);
        if (isfinite(x))
            drawn[n++] = x;
    }
    return n;
}

static moray_table_row row_of(const shown *s, int k, double *drawn)
{
    moray_table_row row = {.label = s->column[k].title};
    const double *first = s->column[0].value;
    long n = sample(s, s->column[k].value, NULL, drawn), lower = 0;
    row.value[0] = (double)n;
    row.value[1] = moray_quantile(drawn, n, 0.5);
    row.value[2] = moray_quantile(drawn, n, 0.9);
    n = k > 0 ? sample(s, s->column[k].value, first, drawn) : 0;
    row.value[3] = moray_quantile(drawn, n, 0.5);
    row.value[4] = moray_quantile(drawn, n, 0.9);
    for (long i = 0; i < n; i++)
        lower += drawn[i] < 0;
    row.value[5] = n > 0 ? 100 * (double)lower / (double)n : NAN;
    return row;
}

moray_status shown_quantiles(const shown *s, moray_table_row row[2 * SWEEP_MOST_SHOWN], moray_table *table)
{
    double *drawn = calloc((size_t)s->points, sizeof *drawn);
    if (!drawn)
        return moray_error(MORAY_MEMORY, "no memory for %ld points", s->points);
    for (int k = 0; k < s->n; k++)
        row[k] = row_of(s, k, drawn);
    free(drawn);
    *table = (moray_table){
        .title = "Over all points, and minus the first number at the same point",
        .columns = {"points", "median", "90th percentile", "difference, median", "90th percentile", "% lower"},
        .n_columns = 6,
        .rows = row,
        .n_rows = s->n};
    return moray_ok();
}
