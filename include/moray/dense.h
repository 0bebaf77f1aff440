// SPDX-License-Identifier: MIT
#ifndef MORAY_DENSE_H
#define MORAY_DENSE_H

#include <stdbool.h>

// Solves A X = B for small dense systems by elimination with row pivoting: A[n][n] and B[n][m] row-major, both
// overwritten, B with X. False when A is singular.
bool moray_dense_solve(int n, double *A, int m, double *B);

#endif
