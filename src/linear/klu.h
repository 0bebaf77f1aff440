// SPDX-License-Identifier: MIT
//
// Sparse LU factors of square matrices of one pattern: ordered once, factored for every set of values, solved with the
// matrix or its transpose.
#ifndef SRC_LINEAR_KLU_H
#define SRC_LINEAR_KLU_H

#include "moray/map.h"

typedef struct sparse_lu sparse_lu;

// Orders an n x n matrix; the pattern is copied. Error: MORAY_INPUT for an entry outside the matrix, or a pattern that
// no values can make regular; MORAY_MEMORY.
moray_status moray_sparse_lu_new(sparse_lu **lu, int n, const moray_pattern *pattern);

// The same for a matrix whose diagonal means nothing: columns are ordered for little fill whatever the rows, and pivots
// may be smaller. Solutions deserve a look at their residual.
moray_status moray_sparse_lu_new_by_columns(sparse_lu **lu, int n, const moray_pattern *pattern);
void moray_sparse_lu_free(sparse_lu *lu);

// Factors the matrix of values[nnz], in the pattern's order: with the pivots of the time before while these stay good.
// Error: MORAY_NUMERIC when the matrix is singular or not finite, MORAY_MEMORY; then there is nothing to solve with.
moray_status moray_sparse_lu_factor(sparse_lu *lu, const double *values);

// Solves A X = B, or A^T X = B, for right-hand sides B[columns][n]; X takes their place. Error: MORAY_NUMERIC without
// factors.
moray_status moray_sparse_lu_solve(sparse_lu *lu, int columns, double *B);
moray_status moray_sparse_lu_solve_transposed(sparse_lu *lu, int columns, double *B);

// A cheap estimate of the reciprocal condition number of the factored matrix; 0 without factors.
double moray_sparse_lu_condition(sparse_lu *lu);

#endif
