// SPDX-License-Identifier: MIT
//
// Cubic pieces in Hermite's form: a function is weights times (value, slope) at the left and the right of a piece.
#ifndef SRC_BASE_TABLE_H
#define SRC_BASE_TABLE_H

#include <complex.h>

#include "moray/table.h"

// An axis: ascending numbers, and what is beyond them.
struct table_axis {
    int n;
    const double *x;
    moray_table_outside outside;
};

// Weights of value left, slope left, value right, slope right of the piece; returns the piece. weight[order][4] for the
// value and its first and second derivative.
int moray_table_weights(const struct table_axis *axis, double x, double weight[3][4]);
int moray_table_complex_weights(const struct table_axis *axis, double complex x, double complex weight[4]);

// Slopes of the spline through y at x; y and slope have the stride. work[3 n].
void moray_spline_slopes(int n, const double *x, const double *y, int stride, moray_table_ends ends, double *work,
                         double *slope);

// Error: MORAY_INPUT naming what does not ascend or is not finite. `what` is the axis.
moray_status moray_check_axis(const char *what, int n, const double *x, moray_table_ends ends,
                              moray_table_outside outside);

#endif
