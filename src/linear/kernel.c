// SPDX-License-Identifier: MIT
#include "linear/parts.h"

void moray_ldl_kernel_update(int rows, int columns, int depth, const double *L, int ldl, const double *W, int ldw,
                             double *C, int ldc)
{
    for (int j = 0; j < columns; j++)
        for (int k = 0; k < depth; k++) {
            const double w = W[j + (size_t)k * (size_t)ldw];
            const double *l = L + (size_t)k * (size_t)ldl;
            double *c = C + (size_t)j * (size_t)ldc;
            for (int i = j; i < rows; i++)
                c[i] -= l[i] * w;
        }
}

void moray_ldl_kernel_subtract(int rows, int columns, const double *L, int ldl, const double *x, double *y)
{
    for (int k = 0; k < columns; k++)
        for (int i = 0; i < rows; i++)
            y[i] -= L[i + (size_t)k * (size_t)ldl] * x[k];
}

void moray_ldl_kernel_subtract_transposed(int rows, int columns, const double *L, int ldl, const double *y, double *x)
{
    for (int k = 0; k < columns; k++) {
        double sum = 0;
        for (int i = 0; i < rows; i++)
            sum += L[i + (size_t)k * (size_t)ldl] * y[i];
        x[k] -= sum;
    }
}
