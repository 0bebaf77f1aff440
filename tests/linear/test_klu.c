// SPDX-License-Identifier: MIT
//
// Sparse factors against dense elimination, eigenvalues against matrices made from known ones.
#include "tap.h"

#include <string.h>

#include "dense.h"
#include "moray/dense.h"
#include "linear/klu.h"

enum { MOST = 40 };

// A random sparse matrix: the diagonal of a random permutation, so that it is regular, and some more entries.
typedef struct sample {
    int n, nnz, row[MOST * MOST], col[MOST * MOST];
    double value[MOST * MOST];
} sample;

static void fill_values(sample *s, unsigned long long *seed)
{
    for (int k = 0; k < s->nnz; k++)
        s->value[k] = tap_random(seed, -1, 1) + (k < s->n ? 3 : 0);
}

static void make_sample(sample *s, int n, unsigned long long *seed)
{
    bool used[MOST][MOST] = {{false}};
    const int shift = (int)tap_random(seed, 0, n);
    s->n = n;
    s->nnz = 0;
    for (int k = 0; k < 5 * n; k++) {
        const int row = k < n ? k : (int)tap_random(seed, 0, n);
        const int col = k < n ? (k + shift) % n : (int)tap_random(seed, 0, n);
        if (used[row][col])
            continue;
        used[row][col] = true;
        s->row[s->nnz] = row;
        s->col[s->nnz++] = col;
    }
    fill_values(s, seed);
}

static moray_pattern pattern_of(sample *s)
{
    return (moray_pattern){s->nnz, s->row, s->col};
}

static double distance(int n, const double *a, const double *b)
{
    double worst = 0;
    for (int k = 0; k < n; k++)
        worst = tap_worse(worst, isnan(a[k]) ? INFINITY : fabs(a[k] - b[k]));
    return worst;
}

// Two right-hand sides with the matrix (or its transpose) against elimination in full.
static double solve_error(sparse_lu *lu, const sample *s, bool transposed, unsigned long long *seed)
{
    const int n = s->n;
    double B[2 * MOST];
    dense A = dense_zero(n, n), X = dense_zero(n, 2), columns = dense_zero(2, n);
    for (int k = 0; k < s->nnz; k++)
        DENSE(A, transposed ? s->col[k] : s->row[k], transposed ? s->row[k] : s->col[k]) = s->value[k];
    for (int k = 0; k < 2 * n; k++)
        B[k] = DENSE(X, k % n, k / n) = tap_random(seed, -1, 1);
    dense_solve(A, X);
    for (int k = 0; k < 2 * n; k++)
        columns.at[k] = DENSE(X, k % n, k / n);
    const moray_status status =
        transposed ? moray_sparse_lu_solve_transposed(lu, 2, B) : moray_sparse_lu_solve(lu, 2, B);
    const double error = moray_failed(status) ? INFINITY : distance(2 * n, B, columns.at);
    dense_free(&A);
    dense_free(&X);
    dense_free(&columns);
    return error;
}

static void test_factors(void)
{
    static sample s;
    unsigned long long seed = 7;
    double worst = 0;
    for (int n = 1; n <= MOST; n += 3) {
        sparse_lu *lu = NULL;
        make_sample(&s, n, &seed);
        const moray_pattern pattern = pattern_of(&s);
        if (moray_failed(moray_sparse_lu_new(&lu, n, &pattern)))
            worst = INFINITY;
        for (int again = 0; again < 3 && lu; again++, fill_values(&s, &seed)) {
            worst = moray_failed(moray_sparse_lu_factor(lu, s.value)) ? INFINITY : worst;
            worst = tap_worse(worst, solve_error(lu, &s, false, &seed));
            worst = tap_worse(worst, solve_error(lu, &s, true, &seed));
        }
        moray_sparse_lu_free(lu);
    }
    CHECK(worst < 1e-12, "sparse factors, new values and transposes as in full elimination: %.1e", worst);
}

// [a b; c 0]: with a = 0 the pivots of a != 0 do not serve.
static void test_pivots(void)
{
    int row[] = {0, 0, 1, 1}, col[] = {0, 1, 0, 1};
    const moray_pattern pattern = {4, row, col};
    sparse_lu *lu;
    double B[] = {2, 3};
    CHECK_OK(moray_sparse_lu_new(&lu, 2, &pattern), "order");
    CHECK(moray_sparse_lu_solve(lu, 1, B).code == MORAY_NUMERIC, "nothing to solve with before values are given");
    CHECK(moray_sparse_lu_condition(lu) == 0, "nor anything to measure");
    CHECK_OK(moray_sparse_lu_factor(lu, (double[]){4, 1, 1, 1e-3}), "factor");
    CHECK_OK(moray_sparse_lu_factor(lu, (double[]){0, 1, 1, 0}), "other values that need other pivots");
    CHECK_OK(moray_sparse_lu_solve(lu, 1, B), "solve");
    CHECK(B[0] == 3 && B[1] == 2, "a permutation: %g, %g", B[0], B[1]);
    CHECK_OK(moray_sparse_lu_factor(lu, (double[]){1e-14, 1, 1, 1}), "values for which those would be inaccurate");
    CHECK_OK(moray_sparse_lu_solve(lu, 1, B), "solve");
    CHECK(fabs(B[0] + 1) < 1e-12 && fabs(B[1] - 3) < 1e-12, "accurate all the same: %.15g, %.15g", B[0], B[1]);
    moray_status status = moray_sparse_lu_factor(lu, (double[]){1, 2, 2, 4});
    CHECK(status.code == MORAY_NUMERIC && strstr(status.text, "singular"), "refused: %s", status.text);
    CHECK(moray_sparse_lu_solve_transposed(lu, 1, B).code == MORAY_NUMERIC, "and nothing to solve with");
    status = moray_sparse_lu_factor(lu, (double[]){1, NAN, 2, 4});
    CHECK(status.code == MORAY_NUMERIC && strstr(status.text, "not finite"), "refused: %s", status.text);
    CHECK_OK(moray_sparse_lu_factor(lu, (double[]){1, 0, 0, 1}), "and good values serve again");
    moray_sparse_lu_free(lu);
}

static void test_refusals(void)
{
    int row[] = {0, 0, 1}, col[] = {0, 1, 2};
    sparse_lu *lu;
    moray_status status = moray_sparse_lu_new(&lu, 2, &(moray_pattern){3, row, col});
    CHECK(status.code == MORAY_INPUT && strstr(status.text, "(1, 2)") && !lu, "refused: %s", status.text);
    status = moray_sparse_lu_new(&lu, 2, &(moray_pattern){2, row, col});
    CHECK(status.code == MORAY_INPUT && strstr(status.text, "rank 1") && !lu, "refused: %s", status.text);
    moray_sparse_lu_free(NULL);
}

// A = S diag S^-1 with blocks [a b; -b a] for a +- ib.
static void test_eigenvalues(void)
{
    enum { n = 6 };
    const double block[n][n] = {{0.5, 2, 0, 0, 0, 0},  {-2, 0.5, 0, 0, 0, 0},     {0, 0, -3, 0, 0, 0},
                                {0, 0, 0, 1e-9, 0, 0}, {0, 0, 0, 0, 0.25, -0.25}, {0, 0, 0, 0, 0.25, 0.25}};
    const double complex expected[n] = {-3, 0.5 + 2 * I, 0.5 - 2 * I, 0.25 + 0.25 * I, 0.25 - 0.25 * I, 1e-9};
    unsigned long long seed = 5;
    double complex lambda[n];
    double S[n * n], T[n * n], A[n * n] = {0}, worst = 0;
    for (int k = 0; k < n * n; k++)
        S[k] = T[k] = tap_random(&seed, -1, 1) + (k % (n + 1) == 0 ? 2 : 0);
    for (int i = 0; i < n; i++) // A = (S block)^T, then A = S^-T A, similar to block^T
        for (int j = 0; j < n; j++)
            for (int k = 0; k < n; k++)
                A[j * n + i] += S[i * n + k] * block[k][j];
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++)
            T[i * n + j] = S[j * n + i];
    double product[n * n] = {0}, inverse[n * n] = {0};
    for (int i = 0; i < n; i++)
        inverse[i * n + i] = 1;
    CHECK(moray_dense_solve(n, T, n, inverse), "regular");
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++)
            for (int k = 0; k < n; k++)
                product[i * n + j] += A[i * n + k] * inverse[k * n + j];
    CHECK_OK(moray_eigenvalues(n, product, lambda), "eigenvalues");
    for (int k = 0; k < n; k++)
        worst = tap_worse(worst, cabs(lambda[k] - expected[k]));
    CHECK(worst < 1e-12, "eigenvalues by modulus, conjugates side by side: %.1e", worst);
    product[3] = INFINITY;
    const moray_status status = moray_eigenvalues(n, product, lambda);
    CHECK(status.code == MORAY_NUMERIC && strstr(status.text, "(0, 3)"), "refused: %s", status.text);
}

int main(void)
{
    test_factors();
    test_pivots();
    test_refusals();
    test_eigenvalues();
    return tap_done();
}
