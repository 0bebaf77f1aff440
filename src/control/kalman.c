// SPDX-License-Identifier: MIT
#include "moray/control/kalman.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/number.h"
#include "moray/dense.h"

enum { most = MORAY_KALMAN_MEASURED };

struct moray_kalman {
    int n;
    double *x, *P;         // n, n x n
    double *root, *points; // n x n; 2n x n
    double *mean, *next;   // n, n x n
    double memory[];
};

moray_status moray_kalman_new(moray_kalman **result, int n, const double *x, const double *variance)
{
    *result = NULL;
    if (n < 1)
        return moray_error(MORAY_INPUT, "a filter of %d states: must be at least 1", n);
    for (int i = 0; i < n; i++)
        if (!(variance[i] >= 0 && isfinite(x[i])))
            return moray_error(MORAY_INPUT, "state %d of a filter: %g with variance %g: must be finite and at least 0",
                               i, x[i], variance[i]);
    const size_t N = (size_t)n;
    moray_kalman *k = calloc(1, sizeof *k + (2 * N + 5 * N * N) * sizeof *k->memory);
    if (!k)
        return moray_error(MORAY_MEMORY, "no memory for a filter of %d states", n);
    k->n = n;
    k->x = k->memory;
    k->P = k->x + N;
    k->root = k->P + N * N;
    k->points = k->root + N * N;
    k->mean = k->points + 2 * N * N;
    k->next = k->mean + N;
    memcpy(k->x, x, N * sizeof *x);
    for (int i = 0; i < n; i++)
        k->P[i * n + i] = variance[i];
    *result = k;
    return moray_ok();
}

void moray_kalman_free(moray_kalman *filter)
{
    free(filter);
}

const double *moray_kalman_estimate(const moray_kalman *filter)
{
    return filter->x;
}

double moray_kalman_covariance(const moray_kalman *filter, int i, int j)
{
    return filter->P[i * filter->n + j];
}

// Lower triangular root of P, semidefinite to rounding.
static void square_root(moray_kalman *k)
{
    const int n = k->n;
    double *L = k->root;
    memset(L, 0, (size_t)(n * n) * sizeof *L);
    for (int j = 0; j < n; j++) {
        double pivot = k->P[j * n + j];
        for (int c = 0; c < j; c++)
            pivot -= L[j * n + c] * L[j * n + c];
        if (pivot <= 1e-14 * k->P[j * n + j])
            continue;
        L[j * n + j] = sqrt(pivot);
        for (int i = j + 1; i < n; i++) {
            double sum = k->P[i * n + j];
            for (int c = 0; c < j; c++)
                sum -= L[i * n + c] * L[j * n + c];
            L[i * n + j] = sum / L[j * n + j];
        }
    }
}

static void spread(moray_kalman *k)
{
    const int n = k->n;
    const double reach = sqrt(n);
    square_root(k);
    for (int p = 0; p < 2 * n; p++)
        for (int i = 0; i < n; i++)
            k->points[p * n + i] = k->x[i] + (p < n ? reach : -reach) * k->root[i * n + p % n];
}

moray_status moray_kalman_predict(moray_kalman *k, double time, moray_kalman_move *move, void *self,
                                  const double *noise)
{
    const int n = k->n, points = 2 * n;
    spread(k);
    memset(k->mean, 0, (size_t)n * sizeof *k->mean);
    memset(k->next, 0, (size_t)(n * n) * sizeof *k->next);
    for (int p = 0; p < points; p++) {
        double *x = k->points + p * n;
        if (!move(self, time, x) || !moray_all_finite(x, n))
            return moray_error(MORAY_NUMERIC, "the filter's plant cannot be moved on from its point %d", p);
        for (int i = 0; i < n; i++)
            k->mean[i] += x[i] / points;
    }
    for (int p = 0; p < points; p++)
        for (int i = 0; i < n; i++)
            for (int j = 0; j < n; j++)
                k->next[i * n + j] +=
                    (k->points[p * n + i] - k->mean[i]) * (k->points[p * n + j] - k->mean[j]) / points;
    for (int i = 0; i < n; i++)
        k->next[i * n + i] += noise[i] * time;
    memcpy(k->x, k->mean, (size_t)n * sizeof *k->x);
    memcpy(k->P, k->next, (size_t)(n * n) * sizeof *k->P);
    return moray_ok();
}

static double difference(double a, double b, bool angle)
{
    return angle ? remainder(a - b, 2 * M_PI) : a - b;
}

moray_status moray_kalman_update(moray_kalman *k, int m, moray_kalman_see *see, void *self, const double *z,
                                 const double *variance, unsigned angle)
{
    const int n = k->n, points = 2 * n;
    double seen[most], first[most], mean[most] = {0}, S[most * most] = {0}, step[most];
    if (m < 1 || m > most)
        return moray_error(MORAY_INPUT, "%d values measured at a time: must be from 1 to %d", m, most);
    if (m > n)
        return moray_error(MORAY_INPUT, "%d values measured of %d states: no more than there are", m, n);
    spread(k);
    double *C = k->next; // [m][n] covariance of what is seen with the state
    memset(C, 0, (size_t)(n * n) * sizeof *C);
    see(self, k->x, first);
    for (int p = 0; p < points; p++) {
        see(self, k->points + p * n, seen);
        for (int i = 0; i < m; i++)
            mean[i] += difference(seen[i], first[i], angle & 1u << i) / points; // beside the first
    }
    for (int p = 0; p < points; p++) {
        see(self, k->points + p * n, seen);
        for (int i = 0; i < m; i++)
            seen[i] = difference(seen[i], first[i], angle & 1u << i) - mean[i];
        for (int i = 0; i < m; i++) {
            for (int j = 0; j < m; j++)
                S[i * m + j] += seen[i] * seen[j] / points;
            for (int j = 0; j < n; j++)
                C[i * n + j] += seen[i] * (k->points[p * n + j] - k->x[j]) / points;
        }
    }
    for (int i = 0; i < m; i++) {
        S[i * m + i] += variance[i];
        step[i] = difference(z[i], first[i], angle & 1u << i) - mean[i];
    }
    double *K = k->root; // [m][n] the gain, transposed: S K = C
    memcpy(K, C, (size_t)(m * n) * sizeof *K);
    if (!moray_all_finite(S, m * m) || !moray_dense_solve(m, S, n, K) || !moray_all_finite(K, m * n))
        return moray_error(MORAY_NUMERIC, "what is measured tells the filter nothing that is finite");
    for (int j = 0; j < n; j++) {
        for (int i = 0; i < m; i++)
            k->x[j] += K[i * n + j] * step[i];
        for (int c = 0; c <= j; c++) {
            for (int i = 0; i < m; i++)
                k->P[j * n + c] -= K[i * n + j] * C[i * n + c];
            k->P[c * n + j] = k->P[j * n + c];
        }
    }
    return moray_ok();
}
