// SPDX-License-Identifier: MIT
//
// Small dense systems and eigenvalues against what they must satisfy, and what is refused.
#include "tap.h"

#include <complex.h>
#include <string.h>

#include "moray/dense.h"

enum { n = 6, m = 2 };
static unsigned long long seed = 11;

static void fill(double *at, int count)
{
    for (int k = 0; k < count; k++)
        at[k] = tap_random(&seed, -1, 1);
}

// Rows that must change places among them.
static void test_solve(void)
{
    double A[n * n], B[n * m], X[n * m], copy[n * n], worst = 0;
    for (int k = 0; k < 20; k++) {
        fill(A, n * n);
        fill(B, n * m);
        A[0] = A[n + 1] = 0;
        memcpy(copy, A, sizeof A);
        memcpy(X, B, sizeof B);
        CHECK(moray_dense_solve(n, copy, m, X), "regular");
        for (int i = 0; i < n; i++)
            for (int j = 0; j < m; j++) {
                double sum = -B[i * m + j];
                for (int l = 0; l < n; l++)
                    sum += A[i * n + l] * X[l * m + j];
                worst = tap_worse(worst, fabs(sum));
            }
    }
    CHECK(worst < 1e-11, "A X = B to %.1e", worst);
    double singular[] = {1, 2, 2, 4}, right[] = {1, 1}, nan[] = {NAN, 2, 2, 4};
    CHECK(!moray_dense_solve(2, singular, 1, right), "a singular one is told");
    CHECK(!moray_dense_solve(2, nan, 1, right), "so is a NaN");
}

// The largest of a column in modulus is divided by, wherever it stands and of whatever sign: any other leaves of the
// solution what is beyond the digits of a tiny one.
static void test_pivots(void)
{
    static const double columns[][3] = {{1e-18, -1, -0.5}, {-1, 1e-18, 1e-18}, {1e-18, -0.5, -1}, {-1e-18, 1e-18, 1},
                                        {1e-18, 0.5, -1},  {1, -1e-18, 1e-18}, {-0.5, 1e-18, -1}, {1e-18, 1e-18, -1}};
    static const double rest[3][2] = {{0.3, 0.7}, {0.9, -0.4}, {-0.6, 0.8}}, want[3] = {0.7, -1.1, 0.4};
    for (size_t k = 0; k < sizeof columns / sizeof *columns; k++) {
        double A[9], B[3];
        for (int i = 0; i < 3; i++) {
            const double row[3] = {columns[k][i], rest[i][0], rest[i][1]};
            memcpy(A + 3 * i, row, sizeof row);
            B[i] = row[0] * want[0] + row[1] * want[1] + row[2] * want[2];
        }
        CHECK(moray_dense_solve(3, A, 1, B), "column %zu", k);
        for (int i = 0; i < 3; i++)
            CHECK_NEAR(B[i], want[i], 1e-14, "by the largest of the column");
    }
}

static void test_symmetric(void)
{
    double A[n * n], value[n], vector[n * n], worst = 0;
    for (int i = 0; i < n; i++)
        for (int j = 0; j <= i; j++)
            A[i * n + j] = A[j * n + i] = tap_random(&seed, -1, 1);
    CHECK_OK(moray_symmetric_eigen(n, A, value, vector), "symmetric");
    for (int k = 0; k < n; k++) {
        CHECK(k == 0 || value[k] <= value[k - 1], "the largest first: %g", value[k]);
        for (int i = 0; i < n; i++) {
            double off = -value[k] * vector[k * n + i], dot = i == k ? -1 : 0;
            for (int j = 0; j < n; j++) {
                off += A[i * n + j] * vector[k * n + j];
                dot += vector[i * n + j] * vector[k * n + j];
            }
            worst = tap_worse(worst, fmax(fabs(off), fabs(dot)));
        }
    }
    CHECK(worst < 1e-13, "directions of length 1 that are only stretched: %.1e", worst);
    A[1 * n + 4] = NAN;
    const moray_status status = moray_symmetric_eigen(n, A, value, vector);
    CHECK(status.code == MORAY_NUMERIC && strstr(status.text, "entry (1, 4)"), "%s", status.text);
}

// Of a block that turns and grows, and of numbers on the diagonal.
static void test_general(void)
{
    const double A[] = {3, -4, 0, 0, 4, 3, 0, 0, 0, 0, -7, 0, 0, 0, 0, 0.5};
    const double complex want[] = {-7, moray_complex(3, 4), moray_complex(3, -4), 0.5};
    double complex lambda[4];
    CHECK_OK(moray_eigenvalues(4, A, lambda), "eigenvalues");
    for (int k = 0; k < 4; k++)
        CHECK(cabs(lambda[k] - want[k]) < 1e-13, "%g%+gi", creal(lambda[k]), cimag(lambda[k]));
    const double bad[] = {1, 2, INFINITY, 4};
    const moray_status status = moray_eigenvalues(2, bad, lambda);
    CHECK(status.code == MORAY_NUMERIC && strstr(status.text, "entry (1, 0)"), "%s", status.text);
}

int main(void)
{
    test_solve();
    test_pivots();
    test_symmetric();
    test_general();
    return tap_done();
}
