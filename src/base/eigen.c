// SPDX-License-Identifier: MIT
//
// The one file that knows LAPACK.
#include "moray/dense.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// Fortran: the lengths of the two texts follow at the end.
void dgeev_(const char *want_left, const char *want_right, const int *n, double *A, const int *lda, double *real,
            double *imaginary, double *left, const int *ldl, double *right, const int *ldr, double *work,
            const int *lwork, int *info, size_t left_length, size_t right_length);

void dsyev_(const char *want, const char *triangle, const int *n, double *A, const int *lda, double *value,
            double *work, const int *lwork, int *info, size_t want_length, size_t triangle_length);

static moray_status check_entries(int n, const double *A)
{
    for (int k = 0; k < n * n; k++)
        if (!isfinite(A[k]))
            return moray_error(MORAY_NUMERIC, "eigenvalues: entry (%d, %d) of the matrix is %g", k / n, k % n, A[k]);
    return moray_ok();
}

// Descending in modulus; of conjugates the one above the real axis first.
static int by_modulus(const void *one, const void *other)
{
    const double complex a = *(const double complex *)one, b = *(const double complex *)other;
    if (cabs(a) != cabs(b))
        return cabs(a) > cabs(b) ? -1 : 1;
    return (cimag(a) < cimag(b)) - (cimag(a) > cimag(b));
}

moray_status moray_eigenvalues(int n, const double *A, double complex *lambda)
{
    const int entries = n * n, lwork = 8 * n, one = 1;
    int info = 0;
    MORAY_TRY(check_entries(n, A));
    double *copy = malloc(((size_t)entries + 2 * (size_t)n + (size_t)lwork) * sizeof *copy);
    if (!copy)
        return moray_error(MORAY_MEMORY, "no memory for the eigenvalues of a matrix of %d rows", n);
    double *real = copy + entries, *imaginary = real + n, *work = imaginary + n;
    memcpy(copy, A, (size_t)entries * sizeof *copy); // read by columns it is the transpose: the same eigenvalues
    dgeev_("N", "N", &n, copy, &n, real, imaginary, NULL, &one, NULL, &one, work, &lwork, &info, 1, 1);
    for (int k = 0; k < n; k++)
        lambda[k] = moray_complex(real[k], imaginary[k]);
    free(copy);
    if (info != 0)
        return moray_error(MORAY_NUMERIC, "eigenvalues: LAPACK's dgeev returns %d for a matrix of %d rows", info, n);
    qsort(lambda, (size_t)n, sizeof *lambda, by_modulus);
    return moray_ok();
}

moray_status moray_symmetric_eigen(int n, const double *A, double *value, double *vector)
{
    const int entries = n * n, lwork = 34 * n;
    int info = 0;
    MORAY_TRY(check_entries(n, A));
    double *copy = malloc(((size_t)entries + (size_t)lwork + (size_t)n) * sizeof *copy);
    if (!copy)
        return moray_error(MORAY_MEMORY, "no memory for the eigenvalues of a matrix of %d rows", n);
    double *ascending = copy + entries + lwork;
    memcpy(copy, A, (size_t)entries * sizeof *copy);
    dsyev_("V", "U", &n, copy, &n, ascending, copy + entries, &lwork, &info, 1, 1);
    for (int k = 0; k < n; k++) {
        value[k] = ascending[n - 1 - k];
        memcpy(vector + k * n, copy + (n - 1 - k) * n, (size_t)n * sizeof *vector);
    }
    free(copy);
    if (info != 0)
        return moray_error(MORAY_NUMERIC, "eigenvalues: LAPACK's dsyev returns %d for a matrix of %d rows", info, n);
    return moray_ok();
}
