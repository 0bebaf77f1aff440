// SPDX-License-Identifier: MIT
//
// Numbers over all points as a sample, and against the first of them point by point.
#include <math.h>
#include <stdlib.h>

#include "moray/app/results.h"
#include "sweep/shown.h"

static int by_value(const void *left, const void *right)
{
    const double a = *(const double *)left, b = *(const double *)right;
    return (a > b) - (a < b);
}

// Of n sorted values, between the two nearest; NaN where there are none.
static double quantile(const double *sorted, long n, double part)
{
    if (n == 0)
        return NAN;
    const double at = part * (double)(n - 1);
    const long low = (long)at, high = low + 1 < n ? low + 1 : low;
    return sorted[low] + (at - (double)low) * (sorted[high] - sorted[low]);
}

// Values minus those of `from` (NULL: nothing) where there are both, sorted.
static long sample(const shown *s, const double *value, const double *from, double *sorted)
{
    long n = 0;
    for (long k = 0; k < s->points; k++) {
        const double x = value[k] - (from ? from[k] : 0);
        if (isfinite(x))
            sorted[n++] = x;
    }
    qsort(sorted, (size_t)n, sizeof *sorted, by_value);
    return n;
}

static moray_table_row row_of(const shown *s, int k, double *sorted)
{
    moray_table_row row = {.label = s->column[k].title};
    const double *first = s->column[0].value;
    long n = sample(s, s->column[k].value, NULL, sorted), lower = 0;
    row.value[0] = (double)n;
    row.value[1] = quantile(sorted, n, 0.5);
    row.value[2] = quantile(sorted, n, 0.9);
    n = k > 0 ? sample(s, s->column[k].value, first, sorted) : 0;
    row.value[3] = quantile(sorted, n, 0.5);
    row.value[4] = quantile(sorted, n, 0.9);
    for (long i = 0; i < n; i++)
        lower += sorted[i] < 0;
    row.value[5] = n > 0 ? 100 * (double)lower / (double)n : NAN;
    return row;
}

moray_status shown_quantiles(const shown *s, moray_table_row row[2 * SWEEP_MOST_SHOWN], moray_table *table)
{
    double *sorted = calloc((size_t)s->points, sizeof *sorted);
    if (!sorted)
        return moray_error(MORAY_MEMORY, "no memory for %ld points", s->points);
    for (int k = 0; k < s->n; k++)
        row[k] = row_of(s, k, sorted);
    free(sorted);
    *table = (moray_table){
        .title = "Over all points, and minus the first number at the same point",
        .columns = {"points", "median", "90th percentile", "difference, median", "90th percentile", "% lower"},
        .n_columns = 6,
        .rows = row,
        .n_rows = s->n};
    return moray_ok();
}
