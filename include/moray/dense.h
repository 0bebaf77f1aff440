// SPDX-License-Identifier: MIT
#ifndef MORAY_DENSE_H
#define MORAY_DENSE_H

#include <stdbool.h>

#include "moray/export.h"
#include "moray/num.h"
#include "moray/status.h"

MORAY_BEGIN

// Solves A X = B for small dense systems by elimination with row pivoting: A[n][n] and B[n][m] row-major, both
// overwritten, B with X. False when A is singular.
MORAY_API bool moray_dense_solve(int n, double *A, int m, double *B);

// Eigenvalues lambda[n] of the real matrix A[n][n], the largest in modulus first, conjugates side by side. Error:
// MORAY_NUMERIC when A is not finite or LAPACK fails; MORAY_MEMORY.
MORAY_API moray_status moray_eigenvalues(int n, const double *A, moray_num *lambda);

// Of a symmetric one, the largest first: value[n], and in row k of vector[n][n] the direction of value[k], of length 1.
// Errors likewise.
MORAY_API moray_status moray_symmetric_eigen(int n, const double *A, double *value, double *vector);

MORAY_END

#endif
