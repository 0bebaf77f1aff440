// SPDX-License-Identifier: MIT
//
// Small dense matrices and the shape matrices of Sec. III-A by their definition: the slow references of the snake
// tests.
#ifndef TESTS_DENSE_H
#define TESTS_DENSE_H

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

// Row-major matrix of `rows` x `cols`.
typedef struct {
    int rows, cols;
    double *at;
} dense;

static inline dense dense_zero(int rows, int cols)
{
    return (dense){rows, cols, calloc((size_t)(rows * cols), sizeof(double))};
}

static inline void dense_free(dense *m)
{
    free(m->at);
    *m = (dense){0};
}

#define DENSE(m, i, j) ((m).at[(i) * (m).cols + (j)])

// C = op(A) op(B), where op transposes when asked.
static inline dense dense_product(dense a, bool a_transposed, dense b, bool b_transposed)
{
    const int rows = a_transposed ? a.cols : a.rows, inner = a_transposed ? a.rows : a.cols;
    const int cols = b_transposed ? b.rows : b.cols;
    dense c = dense_zero(rows, cols);
    for (int i = 0; i < rows; i++)
        for (int j = 0; j < cols; j++)
            for (int k = 0; k < inner; k++)
                DENSE(c, i, j) +=
                    (a_transposed ? DENSE(a, k, i) : DENSE(a, i, k)) * (b_transposed ? DENSE(b, j, k) : DENSE(b, k, j));
    return c;
}

// y = A x, or A^T x.
static inline void dense_apply(dense a, bool transposed, const double *x, double *y)
{
    for (int i = 0; i < (transposed ? a.cols : a.rows); i++) {
        y[i] = 0;
        for (int k = 0; k < (transposed ? a.rows : a.cols); k++)
            y[i] += (transposed ? DENSE(a, k, i) : DENSE(a, i, k)) * x[k];
    }
}

static inline void dense_swap_rows(dense m, int i, int j)
{
    for (int k = 0; k < m.cols; k++) {
        const double kept = DENSE(m, i, k);
        DENSE(m, i, k) = DENSE(m, j, k);
        DENSE(m, j, k) = kept;
    }
}

// Overwrites B with A^{-1} B by Gaussian elimination with row pivoting; A is destroyed.
static inline void dense_solve(dense a, dense b)
{
    for (int k = 0; k < a.rows; k++) {
        int pivot = k;
        for (int i = k + 1; i < a.rows; i++)
            if (fabs(DENSE(a, i, k)) > fabs(DENSE(a, pivot, k)))
                pivot = i;
        dense_swap_rows(a, k, pivot);
        dense_swap_rows(b, k, pivot);
        for (int i = 0; i < a.rows; i++) {
            const double factor = i == k ? 0 : DENSE(a, i, k) / DENSE(a, k, k);
            for (int j = k; j < a.cols && i != k; j++)
                DENSE(a, i, j) -= factor * DENSE(a, k, j);
            for (int j = 0; j < b.cols && i != k; j++)
                DENSE(b, i, j) -= factor * DENSE(b, k, j);
        }
    }
    for (int k = 0; k < a.rows; k++)
        for (int j = 0; j < b.cols; j++)
            DENSE(b, k, j) /= DENSE(a, k, k);
}

static inline dense dense_identity(int n)
{
    dense m = dense_zero(n, n);
    for (int i = 0; i < n; i++)
        DENSE(m, i, i) = 1;
    return m;
}

// A, D, G = (D D^T)^{-1}, Dbar = D^T G, A Dbar and A D^T for N links.
typedef struct {
    dense A, D, gram, gram_inverse, Dbar, A_Dbar, A_Dt;
} shape_matrices;

static inline shape_matrices shape_matrices_new(int N)
{
    shape_matrices s = {.A = dense_zero(N - 1, N), .D = dense_zero(N - 1, N), .gram_inverse = dense_identity(N - 1)};
    for (int i = 0; i < N - 1; i++) {
        DENSE(s.A, i, i) = DENSE(s.A, i, i + 1) = DENSE(s.D, i, i) = 1;
        DENSE(s.D, i, i + 1) = -1;
    }
    s.gram = dense_product(s.D, false, s.D, true);
    dense gram = dense_product(s.D, false, s.D, true);
    dense_solve(gram, s.gram_inverse);
    dense_free(&gram);
    s.Dbar = dense_product(s.D, true, s.gram_inverse, false);
    s.A_Dbar = dense_product(s.A, false, s.Dbar, false);
    s.A_Dt = dense_product(s.A, false, s.D, true);
    return s;
}

static inline void shape_matrices_free(shape_matrices *s)
{
    dense *all[] = {&s->A, &s->D, &s->gram, &s->gram_inverse, &s->Dbar, &s->A_Dbar, &s->A_Dt};
    for (unsigned i = 0; i < sizeof all / sizeof *all; i++)
        dense_free(all[i]);
}

#endif
