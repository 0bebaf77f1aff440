// SPDX-License-Identifier: MIT
#include "spline.h"

#include <complex.h>

// Second derivatives y'' of the spline through y: with h_k = x_(k+1) - x_k,
//   h_(k-1) y''_(k-1) + 2 (h_(k-1) + h_k) y''_k + h_k y''_(k+1) = 6 ((y_(k+1) - y_k) / h_k - (y_k - y_(k-1)) / h_(k-1))
static void curvatures(int n, const double *x, const double *y, double *second)
{
    double diagonal[SPLINE_MOST_KNOTS], right[SPLINE_MOST_KNOTS];
    second[0] = second[n - 1] = 0;
    for (int k = 1; k < n - 1; k++) {
        const double before = x[k] - x[k - 1], after = x[k + 1] - x[k];
        const double factor = k > 1 ? before / diagonal[k - 1] : 0;
        diagonal[k] = 2 * (before + after) - factor * before;
        right[k] = 6 * ((y[k + 1] - y[k]) / after - (y[k] - y[k - 1]) / before) - (k > 1 ? factor * right[k - 1] : 0);
    }
    for (int k = n - 2; k > 0; k--)
        second[k] = (right[k] - (x[k + 1] - x[k]) * second[k + 1]) / diagonal[k];
}

void spline_new(spline *s, int n, const double *knot)
{
    *s = (spline){.n = n, .knot = knot};
    for (int i = 0; i < n; i++) {
        double y[SPLINE_MOST_KNOTS] = {0}, second[SPLINE_MOST_KNOTS];
        y[i] = 1;
        curvatures(n, knot, y, second);
        for (int k = 0; k < n; k++)
            s->curvature[k][i] = second[k];
    }
}

void spline_weights(const spline *s, moray_num x, moray_num *weight)
{
    int k = 0;
    while (k < s->n - 2 && creal(x) > s->knot[k + 1])
        k++;
    const double h = s->knot[k + 1] - s->knot[k];
    const moray_num b = (x - s->knot[k]) / h, a = 1 - b;
    const moray_num low = (a * a * a - a) * h * h / 6, high = (b * b * b - b) * h * h / 6;
    for (int i = 0; i < s->n; i++)
        weight[i] = low * s->curvature[k][i] + high * s->curvature[k + 1][i];
    weight[k] += a;
    weight[k + 1] += b;
}
