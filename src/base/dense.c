// SPDX-License-Identifier: MIT
#include "moray/dense.h"

#include <math.h>

static void swap_rows(double *matrix, int width, int one, int other)
{
    for (int j = 0; j < width; j++) {
        const double kept = matrix[one * width + j];
        matrix[one * width + j] = matrix[other * width + j];
        matrix[other * width + j] = kept;
    }
}

static void subtract_row(double *matrix, int width, int from, int row, double factor)
{
    for (int j = 0; j < width; j++)
        matrix[from * width + j] -= factor * matrix[row * width + j];
}

bool moray_dense_solve(int n, double *A, int m, double *B)
{
    for (int k = 0; k < n; k++) {
        int pivot = k;
        for (int i = k + 1; i < n; i++)
            if (fabs(A[i * n + k]) > fabs(A[pivot * n + k]))
                pivot = i;
        if (!(fabs(A[pivot * n + k]) > 0))
            return false;
        swap_rows(A, n, k, pivot);
        swap_rows(B, m, k, pivot);
        for (int i = k + 1; i < n; i++) {
            const double factor = A[i * n + k] / A[k * n + k];
            subtract_row(A, n, i, k, factor);
            subtract_row(B, m, i, k, factor);
        }
    }
    for (int k = n - 1; k >= 0; k--) {
        for (int j = 0; j < m; j++)
            B[k * m + j] /= A[k * n + k];
        for (int i = 0; i < k; i++)
            subtract_row(B, m, i, k, A[i * n + k]);
    }
    return true;
}
