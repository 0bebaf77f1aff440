// SPDX-License-Identifier: MIT
//
// Slopes m of the cubic spline, with widths h and quotients d of the pieces (de Boor, A Practical Guide to Splines,
// IV):
//   h_i m_(i-1) + 2 (h_(i-1) + h_i) m_i + h_(i-1) m_(i+1) = 3 (h_i d_(i-1) + h_(i-1) d_i)
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/table.h"

struct moray_spline {
    struct table_axis axis;
    double *x, *y, *slope; // one block
};

// ---- Slopes ----

static double width_at(const double *x, int i)
{
    return x[i + 1] - x[i];
}

static double quotient(const double *x, const double *y, int stride, int i)
{
    return (y[(i + 1) * stride] - y[i * stride]) / width_at(x, i);
}

// The equation at an end: of the pieces `near` it and `far`.
static void end_row(moray_table_ends ends, double near, double far, double d_near, double d_far, double row[3])
{
    if (ends == MORAY_NATURAL) {
        row[0] = 2, row[1] = 1, row[2] = 3 * d_near;
        return;
    }
    row[0] = far, row[1] = near + far;
    row[2] = ((3 * near + 2 * far) * far * d_near + near * near * d_far) / (near + far);
}

static void few_slopes(int n, const double *x, const double *y, int stride, double *slope)
{
    const double d = quotient(x, y, stride, 0);
    const double bend = n == 3 ? (quotient(x, y, stride, 1) - d) / (x[2] - x[0]) : 0;
    for (int i = 0; i < n; i++)
        slope[i * stride] = d + bend * (2 * x[i] - x[0] - x[1]);
}

// Thomas's elimination; every pivot is positive, see the sums of the rows.
static void solve_slopes(int n, const double *x, const double *y, int stride, moray_table_ends ends, double *work,
                         double *slope)
{
    double *above = work, *right = work + n, first[3], last[3];
    end_row(ends, width_at(x, 0), width_at(x, 1), quotient(x, y, stride, 0), quotient(x, y, stride, 1), first);
    end_row(ends, width_at(x, n - 2), width_at(x, n - 3), quotient(x, y, stride, n - 2), quotient(x, y, stride, n - 3),
            last);
    above[0] = first[1] / first[0];
    right[0] = first[2] / first[0];
    for (int i = 1; i < n; i++) {
        const bool end = i == n - 1;
        const double before = width_at(x, i - 1), after = end ? 0 : width_at(x, i);
        const double below = end ? last[1] : after, diagonal = end ? last[0] : 2 * (before + after);
        const double wanted =
            end ? last[2] : 3 * (after * quotient(x, y, stride, i - 1) + before * quotient(x, y, stride, i));
        const double pivot = diagonal - below * above[i - 1];
        above[i] = before / pivot;
        right[i] = (wanted - below * right[i - 1]) / pivot;
    }
    slope[(n - 1) * stride] = right[n - 1];
    for (int i = n - 2; i >= 0; i--)
        slope[i * stride] = right[i] - above[i] * slope[(i + 1) * stride];
}

// Slopes of at most three times the smaller quotient beside, and none where the numbers turn, keep their order.
static void keep_order(int n, const double *x, const double *y, int stride, double *slope)
{
    for (int i = 0; i < n; i++) {
        const double before = quotient(x, y, stride, i > 0 ? i - 1 : 0);
        const double after = quotient(x, y, stride, i < n - 1 ? i : n - 2);
        double *m = &slope[i * stride];
        if (before * after <= 0 || *m * after <= 0)
            *m = 0;
        else
            *m = copysign(fmin(fabs(*m), 3 * fmin(fabs(before), fabs(after))), *m);
    }
}

void moray_spline_slopes(int n, const double *x, const double *y, int stride, moray_table_ends ends, double *work,
                         double *slope)
{
    if (n == 2 || (n == 3 && ends != MORAY_NATURAL))
        few_slopes(n, x, y, stride, slope);
    else
        solve_slopes(n, x, y, stride, ends, work, slope);
    if (ends == MORAY_MONOTONE)
        keep_order(n, x, y, stride, slope);
}

// ---- Splines ----

moray_status moray_check_axis(const char *what, int n, const double *x, moray_table_ends ends,
                              moray_table_outside outside)
{
    if (n < 2)
        return moray_error(MORAY_INPUT, "%s: %d numbers, at least 2 are needed", what, n);
    if ((int)ends < 0 || ends > MORAY_MONOTONE || (int)outside < 0 || outside > MORAY_NAN)
        return moray_error(MORAY_INPUT, "%s: ends %d and outside %d must be of their lists", what, (int)ends,
                           (int)outside);
    for (int i = 0; i < n; i++)
        if (!isfinite(x[i]) || (i > 0 && !(x[i] > x[i - 1])))
            return moray_error(MORAY_INPUT, "%s[%d] = %g: must be finite and ascend", what, i, x[i]);
    return moray_ok();
}

moray_status moray_spline_new(moray_spline **result, int n, const double *x, const double *y, moray_table_ends ends,
                              moray_table_outside outside)
{
    *result = NULL;
    MORAY_TRY(moray_check_axis("x", n, x, ends, outside));
    for (int i = 0; i < n; i++)
        if (!isfinite(y[i]))
            return moray_error(MORAY_INPUT, "y[%d] = %g: must be finite", i, y[i]);
    moray_spline *spline = calloc(1, sizeof *spline);
    double *block = calloc(5 * (size_t)n, sizeof *block);
    if (!spline || !block) {
        free(spline);
        free(block);
        return moray_error(MORAY_MEMORY, "no memory for a spline of %d numbers", n);
    }
    *spline = (struct moray_spline){{n, block, outside}, block, block + n, block + 2 * n};
    memcpy(spline->x, x, (size_t)n * sizeof *x);
    memcpy(spline->y, y, (size_t)n * sizeof *y);
    moray_spline_slopes(n, x, y, 1, ends, block + 3 * n, spline->slope);
    *result = spline;
    return moray_ok();
}

void moray_spline_free(moray_spline *spline)
{
    if (!spline)
        return;
    free(spline->x);
    free(spline);
}

void moray_spline_range(const moray_spline *spline, double range[2])
{
    range[0] = spline->x[0];
    range[1] = spline->x[spline->axis.n - 1];
}

double moray_spline_real(const moray_spline *spline, double x, double *d)
{
    double w[3][4], value[3];
    const int i = moray_table_weights(&spline->axis, x, w);
    const double *y = spline->y + i, *m = spline->slope + i;
    for (int k = 0; k < 3; k++)
        value[k] = w[k][0] * y[0] + w[k][1] * m[0] + w[k][2] * y[1] + w[k][3] * m[1];
    if (d)
        d[0] = value[1], d[1] = value[2];
    return value[0];
}

double complex moray_spline_at(const moray_spline *spline, double complex x)
{
    double complex w[4];
    const int i = moray_table_complex_weights(&spline->axis, x, w);
    const double *y = spline->y + i, *m = spline->slope + i;
    return w[0] * y[0] + w[1] * m[0] + w[2] * y[1] + w[3] * m[1];
}
