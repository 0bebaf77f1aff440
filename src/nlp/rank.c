// SPDX-License-Identifier: MIT
#include "nlp/rank.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "linear/klu.h"

static const double least_square = 1e-8; // of singular values: rounding enters divided by it
enum { iterations = 8 };

struct augmented {
    const struct selection *selection;
    double *row_scale, *values, *rhs; // [m], [entries], [n + m]
    moray_pattern pattern;
    sparse_lu *lu;
};

static double entry(const struct augmented *a, int k)
{
    const moray_nlp *nlp = a->selection->nlp;
    const bool taken = a->selection->rows[nlp->jac_row[k]] && a->selection->cols[nlp->jac_col[k]];
    return taken ? a->selection->jac[k] : 0;
}

static void normalise_rows(struct augmented *a)
{
    const moray_nlp *nlp = a->selection->nlp;
    for (int k = 0; k < nlp->nnz_jac; k++)
        a->row_scale[nlp->jac_row[k]] = hypot(a->row_scale[nlp->jac_row[k]], entry(a, k));
    for (int i = 0; i < nlp->m; i++)
        a->row_scale[i] = a->row_scale[i] > 0 ? 1 / a->row_scale[i] : 1;
}

static void fill(struct augmented *a)
{
    const moray_nlp *nlp = a->selection->nlp;
    const int n = nlp->n, m = nlp->m;
    for (int k = 0; k < n + m; k++) {
        a->pattern.row[k] = a->pattern.col[k] = k;
        a->values[k] = k < n ? 1 : a->selection->rows[k - n] ? -least_square : -1;
    }
    for (int k = 0; k < nlp->nnz_jac; k++) {
        const int row = nlp->jac_row[k], one = n + m + 2 * k, other = one + 1;
        a->pattern.row[one] = a->pattern.col[other] = n + row;
        a->pattern.col[one] = a->pattern.row[other] = nlp->jac_col[k];
        a->values[one] = a->values[other] = entry(a, k) * a->row_scale[row];
    }
}

// [I J'; J -eps I]: rows of J that depend on others show as pivots of size eps.
static moray_status augmented_new(struct augmented *a, bool normalise)
{
    const moray_nlp *nlp = a->selection->nlp;
    const int n = nlp->n, m = nlp->m, entries = n + m + 2 * nlp->nnz_jac;
    a->row_scale = calloc((size_t)(2 * m + n + entries) + 1, sizeof *a->row_scale);
    if (!a->row_scale)
        return moray_error(MORAY_MEMORY, "no memory to examine %d constraints", m);
    a->rhs = a->row_scale + m;
    a->values = a->rhs + n + m;
    MORAY_TRY(moray_pattern_new(&a->pattern, entries));
    for (int i = 0; i < m; i++)
        a->row_scale[i] = normalise ? 0 : 1;
    if (normalise)
        normalise_rows(a);
    fill(a);
    MORAY_TRY(moray_sparse_lu_new(&a->lu, n + m, &a->pattern));
    return moray_sparse_lu_factor(a->lu, a->values);
}

static void augmented_free(struct augmented *a)
{
    moray_sparse_lu_free(a->lu);
    moray_pattern_free(&a->pattern);
    free(a->row_scale);
}

static double norm_of(const double *v, int n)
{
    double sum = 0;
    for (int i = 0; i < n; i++)
        sum = hypot(sum, v[i]);
    return sum;
}

// y <- r (J J' + r)^-1 y: keeps what J' takes to nothing. Left in rhs: - J' y.
static moray_status filter(struct augmented *a, double *y)
{
    const int n = a->selection->nlp->n, m = a->selection->nlp->m;
    memset(a->rhs, 0, (size_t)n * sizeof *a->rhs);
    for (int i = 0; i < m; i++)
        a->rhs[n + i] = a->selection->rows[i] ? -least_square * y[i] : 0;
    MORAY_TRY(moray_sparse_lu_solve(a->lu, 1, a->rhs));
    memcpy(y, a->rhs + n, (size_t)m * sizeof *y);
    return moray_ok();
}

static moray_status iterate(struct augmented *a, double *weight, double *norm)
{
    const int n = a->selection->nlp->n, m = a->selection->nlp->m;
    for (int k = 0; k < iterations; k++) {
        MORAY_TRY(filter(a, weight));
        const double size = norm_of(weight, m);
        if (!(size > 0) || !isfinite(size))
            return moray_error(MORAY_NUMERIC, "no dependence can be computed");
        for (int i = 0; i < m; i++)
            weight[i] /= size;
        *norm = norm_of(a->rhs, n) / size;
    }
    return moray_ok();
}

// First from a start with a part in everything; then from the row most involved, to what else it takes.
static moray_status find_dependence(struct augmented *a, double *weight, double *norm)
{
    const int m = a->selection->nlp->m;
    int most = 0;
    for (int i = 0; i < m; i++)
        weight[i] = 1 + 0.5 * sin(12.9898 * i);
    MORAY_TRY(iterate(a, weight, norm));
    for (int i = 0; i < m; i++)
        if (fabs(weight[i]) > fabs(weight[most]))
            most = i;
    for (int i = 0; i < m; i++)
        weight[i] = i == most;
    return iterate(a, weight, norm);
}

moray_status moray_nlp_dependent_rows(const struct selection *selection, double *weight, double *norm)
{
    struct augmented a = {.selection = selection};
    moray_status status = augmented_new(&a, true);
    if (!moray_failed(status))
        status = find_dependence(&a, weight, norm);
    augmented_free(&a);
    return status;
}

moray_status moray_nlp_unremovable(const struct selection *selection, double *violation)
{
    struct augmented a = {.selection = selection};
    moray_status status = augmented_new(&a, false);
    if (!moray_failed(status))
        status = filter(&a, violation);
    augmented_free(&a);
    return status;
}
