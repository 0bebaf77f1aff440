// SPDX-License-Identifier: MIT
//
// Natural cubic splines through tables, smooth for complex arguments.
#ifndef PROBLEMS_CLASSICS_SPLINE_H
#define PROBLEMS_CLASSICS_SPLINE_H

#include "moray/ocp.h"

enum { SPLINE_MOST_KNOTS = 10 };

// Knots, and the second derivatives at them that each table value alone makes: curvature[k][i] at knot k from value i.
typedef struct spline {
    int n;
    const double *knot; // [n], ascending
    double curvature[SPLINE_MOST_KNOTS][SPLINE_MOST_KNOTS];
} spline;

// The knots stay the caller's.
void spline_new(spline *s, int n, const double *knot);

// weight[n] of the table values in the value at x; cubic to either side of the knots.
void spline_weights(const spline *s, moray_num x, moray_num *weight);

#endif
