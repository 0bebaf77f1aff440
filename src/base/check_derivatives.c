// SPDX-License-Identifier: MIT
#include "moray/map.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { levels = 6 };
static const double certain = 1e4; // doubts of a reference that a disagreement is to exceed

// Derivative with respect to in[j] of a vector function of m outputs, by central differences with halved steps and
// Richardson extrapolation; every output keeps the extrapolate whose last two levels agree best.
struct difference {
    const moray_map *map;
    int m;
    void (*evaluate)(const moray_map *map, const double *weight, const double *in, double *out, double *scratch);
    const double *weight;
    double *in, *ahead, *behind, *scratch;
    double *table; // levels x levels for one output at a time: m blocks
};

// doubt: how far the levels disagree, and what rounding of the outputs makes of it.
static void extrapolate(const struct difference *d, int i, double start, double *derivative, double *doubt)
{
    const double *table = d->table + i * levels * levels;
    *doubt = INFINITY;
    *derivative = NAN;
    double step = start;
    for (int level = 1; level < levels; level++)
        for (int k = 1; k <= level; k++) {
            const double *at = table + level * levels + k;
            const double spread = fabs(at[0] - at[-1 - levels]); // at[-1] is nearer
            if (spread <= *doubt && isfinite(spread)) {
                *doubt = spread;
                *derivative = at[0];
                step = ldexp(start, -2 * level);
            }
        }
    *doubt += DBL_EPSILON * (fabs(d->ahead[i]) + fabs(d->behind[i])) / (2 * step);
}

static void richardson(struct difference *d, int j, double *derivative, double *doubt)
{
    const double x = d->in[j], start = 0.02 * (1 + fabs(x));
    for (int level = 0; level < levels; level++) {
        const double step = ldexp(start, -2 * level);
        d->in[j] = x + step;
        d->evaluate(d->map, d->weight, d->in, d->ahead, d->scratch);
        d->in[j] = x - step;
        d->evaluate(d->map, d->weight, d->in, d->behind, d->scratch);
        for (int i = 0; i < d->m; i++) {
            double *row = d->table + (i * levels + level) * levels;
            row[0] = (d->ahead[i] - d->behind[i]) / (2 * step);
            for (int k = 1; k <= level; k++)
                row[k] = row[k - 1] + (row[k - 1] - row[k - 1 - levels]) / (ldexp(1, 4 * k) - 1);
        }
    }
    d->in[j] = x;
    for (int i = 0; i < d->m; i++)
        extrapolate(d, i, start, &derivative[i], &doubt[i]);
}

static void evaluate_value(const moray_map *map, const double *weight, const double *in, double *out, double *scratch)
{
    (void)weight;
    (void)scratch;
    map->value(map->self, in, out);
}

static void evaluate_gradient(const moray_map *map, const double *weight, const double *in, double *out,
                              double *scratch)
{
    map->jacobian(map->self, in, scratch);
    memset(out, 0, (size_t)map->n_in * sizeof *out);
    for (int k = 0; k < map->jac.nnz; k++)
        out[map->jac.col[k]] += weight[map->jac.row[k]] * scratch[k];
}

struct worst {
    double error, given, reference;
    int row, col;
};

// A NaN counts as the worst. Where no reference can be formed, nothing is said of a number.
static void compare(struct worst *worst, double given, double reference, double doubt, int row, int col)
{
    const double error = fabs(given - reference) / (1 + fabs(reference) + certain * doubt);
    if (isnan(reference) && isfinite(given))
        return;
    if (!(error <= worst->error) && !isnan(worst->error))
        *worst = (struct worst){error, given, reference, row, col};
}

// Compares column by column; missing entries are zeros.
static void compare_columns(struct difference *d, const moray_pattern *pattern, const double *values, bool symmetric,
                            double *given, double *reference, double *doubt, struct worst *worst)
{
    for (int j = 0; j < d->map->n_in; j++) {
        richardson(d, j, reference, doubt);
        memset(given, 0, (size_t)d->m * sizeof *given);
        for (int k = 0; k < pattern->nnz; k++) {
            if (pattern->col[k] == j)
                given[pattern->row[k]] += values[k];
            else if (symmetric && pattern->row[k] == j)
                given[pattern->col[k]] += values[k];
        }
        for (int i = 0; i < d->m; i++)
            compare(worst, given[i], reference[i], doubt[i], i, j);
    }
}

static void check_both(struct difference *d, const double *weight, double *values, double *given, double *reference,
                       double *doubt, moray_derivative_report *report)
{
    const moray_map *map = d->map;
    struct worst jac = {0}, hess = {0};
    d->m = map->n_out;
    d->evaluate = evaluate_value;
    map->jacobian(map->self, d->in, values);
    compare_columns(d, &map->jac, values, false, given, reference, doubt, &jac);
    d->m = map->n_in;
    d->evaluate = evaluate_gradient;
    d->weight = weight;
    map->hessian(map->self, d->in, weight, values);
    compare_columns(d, &map->hess, values, true, given, reference, doubt, &hess);
    *report = (moray_derivative_report){
        .jacobian_error = jac.error,
        .jacobian_row = jac.row,
        .jacobian_col = jac.col,
        .jacobian_given = jac.given,
        .jacobian_reference = jac.reference,
        .hessian_error = hess.error,
        .hessian_row = hess.row,
        .hessian_col = hess.col,
        .hessian_given = hess.given,
        .hessian_reference = hess.reference,
    };
}

moray_status moray_check_derivatives(const moray_map *map, const double *in, const double *weight,
                                     moray_derivative_report *report)
{
    const size_t m = (size_t)(map->n_in > map->n_out ? map->n_in : map->n_out);
    const size_t nnz = (size_t)(map->jac.nnz > map->hess.nnz ? map->jac.nnz : map->hess.nnz) + 1;
    double *block = calloc(m * (6 + levels * levels) + 2 * nnz, sizeof *block);
    if (!block)
        return moray_error(MORAY_MEMORY, "no memory to check the derivatives of %d inputs", map->n_in);
    struct difference d = {.map = map, .in = block, .ahead = block + m, .behind = block + 2 * m};
    double *given = block + 3 * m, *reference = block + 4 * m, *doubt = block + 5 * m;
    d.table = block + 6 * m;
    d.scratch = d.table + m * levels * levels;
    memcpy(d.in, in, (size_t)map->n_in * sizeof *in);
    check_both(&d, weight, d.scratch + nnz, given, reference, doubt, report);
    free(block);
    return moray_ok();
}
