// SPDX-License-Identifier: MIT
//
// The one file that knows KLU.
#include "linear/klu.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <suitesparse/klu.h>

static const double PIVOT = 0.1; // of its column's largest; KLU's own 0.001 costs orbits six digits
static const double LOOSE_PIVOT = 0.01;
static const double WORN = 1e-6; // reciprocal growth of pivots taken over that asks for new ones

struct sparse_lu {
    int n, nnz;
    int *start, *row; // compressed columns: [n + 1], [nnz]
    int *place;       // [nnz] where the pattern's k-th value goes
    double *values;   // [nnz] by columns
    klu_common common;
    klu_symbolic *symbolic;
    klu_numeric *numeric;
};

static moray_status check_pattern(int n, const moray_pattern *pattern)
{
    for (int k = 0; k < pattern->nnz; k++)
        if (pattern->row[k] < 0 || pattern->row[k] >= n || pattern->col[k] < 0 || pattern->col[k] >= n)
            return moray_error(MORAY_INPUT, "entry %d stands at (%d, %d): outside a matrix of %d rows", k,
                               pattern->row[k], pattern->col[k], n);
    return moray_ok();
}

static void compress(sparse_lu *lu, const moray_pattern *pattern)
{
    for (int k = 0; k < lu->nnz; k++)
        lu->start[pattern->col[k] + 1]++;
    for (int j = 0; j < lu->n; j++)
        lu->start[j + 1] += lu->start[j];
    for (int k = 0; k < lu->nnz; k++) {
        lu->place[k] = lu->start[pattern->col[k]]++;
        lu->row[lu->place[k]] = pattern->row[k];
    }
    memmove(lu->start + 1, lu->start, (size_t)lu->n * sizeof *lu->start); // the filling has moved each to its end
    lu->start[0] = 0;
}

static moray_status status_of(const sparse_lu *lu)
{
    if (lu->common.status == KLU_OUT_OF_MEMORY || lu->common.status == KLU_TOO_LARGE)
        return moray_error(MORAY_MEMORY, "no memory for the factors of a sparse matrix of %d rows", lu->n);
    return moray_error(MORAY_NUMERIC, "a sparse matrix of %d rows is singular: it has rank %d", lu->n,
                       lu->common.numerical_rank);
}

static moray_status analyse(sparse_lu *lu, bool by_columns)
{
    enum { with_amd, with_colamd };
    klu_defaults(&lu->common);
    lu->common.tol = by_columns ? LOOSE_PIVOT : PIVOT;
    lu->common.ordering = by_columns ? with_colamd : with_amd;
    lu->symbolic = klu_analyze(lu->n, lu->start, lu->row, &lu->common);
    if (!lu->symbolic)
        return status_of(lu);
    if (lu->symbolic->structural_rank < lu->n)
        return moray_error(MORAY_INPUT, "a sparse matrix of %d rows is singular whatever its values: it has rank %d",
                           lu->n, lu->symbolic->structural_rank);
    return moray_ok();
}

// Triplets to compressed columns with the place of each triplet kept, so that new values are one scatter.
static moray_status make(sparse_lu **result, int n, const moray_pattern *pattern, bool by_columns)
{
    const size_t rows = (size_t)n, nnz = (size_t)pattern->nnz;
    *result = NULL;
    MORAY_TRY(check_pattern(n, pattern));
    sparse_lu *lu = calloc(1, sizeof *lu);
    if (!lu)
        return moray_error(MORAY_MEMORY, "no memory for a sparse matrix of %d rows", n);
    lu->n = n;
    lu->nnz = pattern->nnz;
    lu->start = calloc(rows + 1 + 2 * nnz, sizeof *lu->start);
    lu->values = calloc(nnz + 1, sizeof *lu->values);
    moray_status status = moray_error(MORAY_MEMORY, "no memory for a sparse matrix of %d rows", n);
    if (lu->start && lu->values) {
        lu->row = lu->start + n + 1;
        lu->place = lu->row + nnz;
        compress(lu, pattern);
        status = analyse(lu, by_columns);
    }
    if (moray_failed(status))
        moray_sparse_lu_free(lu);
    else
        *result = lu;
    return status;
}

moray_status moray_sparse_lu_new(sparse_lu **lu, int n, const moray_pattern *pattern)
{
    return make(lu, n, pattern, false);
}

moray_status moray_sparse_lu_new_by_columns(sparse_lu **lu, int n, const moray_pattern *pattern)
{
    return make(lu, n, pattern, true);
}

void moray_sparse_lu_free(sparse_lu *lu)
{
    if (!lu)
        return;
    klu_free_numeric(&lu->numeric, &lu->common);
    klu_free_symbolic(&lu->symbolic, &lu->common);
    free(lu->start);
    free(lu->values);
    free(lu);
}

// With the pivots of the numeric factors at hand; false when they do not serve for these values.
static bool refactor(sparse_lu *lu)
{
    return lu->numeric && klu_refactor(lu->start, lu->row, lu->values, lu->symbolic, lu->numeric, &lu->common) &&
           klu_rgrowth(lu->start, lu->row, lu->values, lu->symbolic, lu->numeric, &lu->common) &&
           lu->common.rgrowth > WORN;
}

moray_status moray_sparse_lu_factor(sparse_lu *lu, const double *values)
{
    bool finite = true;
    for (int k = 0; k < lu->nnz; k++) {
        lu->values[lu->place[k]] = values[k];
        finite = finite && isfinite(values[k]);
    }
    if (finite && refactor(lu))
        return moray_ok();
    klu_free_numeric(&lu->numeric, &lu->common);
    if (!finite)
        return moray_error(MORAY_NUMERIC, "a sparse matrix of %d rows is not finite", lu->n);
    lu->numeric = klu_factor(lu->start, lu->row, lu->values, lu->symbolic, &lu->common);
    return lu->numeric ? moray_ok() : status_of(lu);
}

moray_status moray_sparse_lu_solve(sparse_lu *lu, int columns, double *B)
{
    if (!lu->numeric)
        return moray_error(MORAY_NUMERIC, "a sparse matrix of %d rows has no factors to solve with", lu->n);
    return klu_solve(lu->symbolic, lu->numeric, lu->n, columns, B, &lu->common) ? moray_ok() : status_of(lu);
}

moray_status moray_sparse_lu_solve_transposed(sparse_lu *lu, int columns, double *B)
{
    if (!lu->numeric)
        return moray_error(MORAY_NUMERIC, "a sparse matrix of %d rows has no factors to solve with", lu->n);
    return klu_tsolve(lu->symbolic, lu->numeric, lu->n, columns, B, &lu->common) ? moray_ok() : status_of(lu);
}

double moray_sparse_lu_condition(sparse_lu *lu)
{
    return lu->numeric && klu_rcond(lu->symbolic, lu->numeric, &lu->common) ? lu->common.rcond : 0;
}
