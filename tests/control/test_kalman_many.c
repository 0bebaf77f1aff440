// SPDX-License-Identifier: MIT
//
// The filter of four states that all act on one another against the linear one by matrices, with as many values at a
// time as come; and what it refuses, by its whole messages.
#include "moray/control/kalman.h"

#include "tap.h"

#include <string.h>

enum { N = 4, MOST = 3 };

// ---- By matrices ---------------------------------------------------------------------------------------------------

typedef struct plant {
    double A[N][N], H[MOST][N];
    int m;
} plant;

static bool move(void *self, double time, double *x)
{
    const plant *p = self;
    double to[N];
    for (int i = 0; i < N; i++) {
        to[i] = x[i];
        for (int j = 0; j < N; j++)
            to[i] += time * p->A[i][j] * x[j];
    }
    memcpy(x, to, sizeof to);
    return true;
}

static void see(void *self, const double *x, double *z)
{
    const plant *p = self;
    for (int i = 0; i < p->m; i++) {
        z[i] = 0;
        for (int j = 0; j < N; j++)
            z[i] += p->H[i][j] * x[j];
    }
}

typedef struct estimate {
    double x[N], P[N][N];
} estimate;

static void predict(estimate *e, plant *p, double time, const double *noise)
{
    double F[N][N], FP[N][N] = {{0}}, next[N][N] = {{0}};
    for (int i = 0; i < N; i++)
        for (int j = 0; j < N; j++)
            F[i][j] = (i == j) + time * p->A[i][j];
    for (int i = 0; i < N; i++)
        for (int j = 0; j < N; j++)
            for (int k = 0; k < N; k++)
                FP[i][j] += F[i][k] * e->P[k][j];
    for (int i = 0; i < N; i++)
        for (int j = 0; j < N; j++) {
            next[i][j] = i == j ? noise[i] * time : 0;
            for (int k = 0; k < N; k++)
                next[i][j] += FP[i][k] * F[j][k];
        }
    memcpy(e->P, next, sizeof next);
    move(p, time, e->x);
}

// One value after the other, whose errors are independent.
static void update(estimate *e, const plant *p, const double *z, const double *error)
{
    for (int v = 0; v < p->m; v++) {
        double C[N] = {0}, S = error[v], step = z[v];
        for (int j = 0; j < N; j++) {
            for (int k = 0; k < N; k++)
                C[j] += e->P[j][k] * p->H[v][k];
            S += p->H[v][j] * C[j];
            step -= p->H[v][j] * e->x[j];
        }
        for (int j = 0; j < N; j++) {
            e->x[j] += C[j] / S * step;
            for (int k = 0; k < N; k++)
                e->P[j][k] -= C[j] * C[k] / S;
        }
    }
}

static double worst_of(const moray_kalman *filter, const estimate *e)
{
    double worst = 0;
    for (int i = 0; i < N; i++) {
        worst = tap_worse(worst, fabs(moray_kalman_estimate(filter)[i] - e->x[i]));
        for (int j = 0; j < N; j++)
            worst = tap_worse(worst, fabs(moray_kalman_covariance(filter, i, j) - e->P[i][j]));
    }
    return worst;
}

// Three values, two, one, three again: what was seen before has no say.
static void test_linear(void)
{
    unsigned long long seed = 17;
    double variance[N], noise[N], predicted = 0, updated = 0;
    moray_kalman *filter;
    estimate e = {{0}, {{0}}};
    for (int i = 0; i < N; i++) {
        e.x[i] = tap_random(&seed, -2, 2);
        variance[i] = e.P[i][i] = tap_random(&seed, 0.2, 2);
        noise[i] = tap_random(&seed, 0, 0.4);
    }
    CHECK_OK(moray_kalman_new(&filter, N, e.x, variance), "new");
    for (int round = 0; round < 30; round++) {
        plant p = {.m = MOST - round % MOST};
        double z[MOST], error[MOST];
        const double time = tap_random(&seed, 0.1, 0.5);
        for (int k = 0; k < N * N; k++)
            p.A[k / N][k % N] = tap_random(&seed, -0.7, 0.6);
        for (int k = 0; k < MOST * N; k++)
            p.H[k / N][k % N] = tap_random(&seed, -1, 1);
        for (int i = 0; i < MOST; i++) {
            z[i] = tap_random(&seed, -3, 3);
            error[i] = tap_random(&seed, 0.1, 1);
        }
        CHECK_OK(moray_kalman_predict(filter, time, move, &p, noise), "predicted");
        predict(&e, &p, time, noise);
        predicted = tap_worse(predicted, worst_of(filter, &e));
        CHECK_OK(moray_kalman_update(filter, p.m, see, &p, z, error, 0), "updated");
        update(&e, &p, z, error);
        updated = tap_worse(updated, worst_of(filter, &e));
    }
    CHECK(predicted < 1e-11 && updated < 1e-11, "to %.1e and %.1e", predicted, updated);
    moray_kalman_free(filter);
}

// ---- Sizes ---------------------------------------------------------------------------------------------------------

static void see_one(void *self, const double *x, double *z)
{
    z[0] = x[*(const int *)self];
}

// What is known well is still known beside what is hardly known at all, before it or behind.
static void test_sizes(void)
{
    for (int small = 0; small < 3; small++) {
        double x[3] = {0}, variance[3] = {1e20, 1e20, 1e20}, error = 0.01, z = 5;
        moray_kalman *filter;
        variance[small] = 0.04;
        CHECK_OK(moray_kalman_new(&filter, 3, x, variance), "new");
        CHECK_OK(moray_kalman_update(filter, 1, see_one, &small, &z, &error, 0), "updated");
        CHECK_NEAR(moray_kalman_estimate(filter)[small], 4, 1e-12, "four fifths are believed");
        CHECK_NEAR(moray_kalman_covariance(filter, small, small), 0.008, 1e-15, "a fifth is left");
        moray_kalman_free(filter);
    }
}

static bool add(void *self, double time, double *x)
{
    (void)time;
    x[1] += *(const double *)self * x[0];
    return true;
}

// There and back: a part of a huge variance that is added and taken away again.
static void test_back(void)
{
    const double x[2] = {0}, variance[2] = {1e30, 0.04}, none[2] = {0};
    double part = 1e-16;
    moray_kalman *filter;
    CHECK_OK(moray_kalman_new(&filter, 2, x, variance), "new");
    CHECK_OK(moray_kalman_predict(filter, 1, add, &part, none), "predicted");
    CHECK_NEAR(moray_kalman_covariance(filter, 1, 1), 0.05, 1e-15, "more");
    CHECK_NEAR(moray_kalman_covariance(filter, 1, 0) / 1e14, 1, 1e-14, "together");
    part = -part;
    CHECK_OK(moray_kalman_predict(filter, 1, add, &part, none), "and back");
    CHECK_NEAR(moray_kalman_covariance(filter, 1, 1), 0.04, 1e-14, "the small variance");
    moray_kalman_free(filter);
}

// ---- Refusals ------------------------------------------------------------------------------------------------------

static void see_first_twice(void *self, const double *x, double *z)
{
    (void)self;
    z[0] = z[1] = x[0];
}

static bool stop(void *self, double time, double *x)
{
    (void)time, (void)x;
    return (*(int *)self)-- > 0;
}

static void test_refusals(void)
{
    const double x[3] = {4, 5, 6}, variance[3] = {1, 2, 3}, z[2] = {7, 8};
    moray_kalman *filter;
    for (int i = 0; i < 3; i++) {
        char says[120];
        double bad[3] = {1, 2, 3};
        bad[i] = -1;
        moray_status status = moray_kalman_new(&filter, 3, x, bad);
        snprintf(says, sizeof says, "state %d of a filter: %g with variance -1: must be finite and at least 0", i,
                 x[i]);
        CHECK(status.code == MORAY_INPUT && !filter && strcmp(status.text, says) == 0, "%s", status.text);
        CHECK_OK(moray_kalman_new(&filter, 3, x, variance), "new");
        int steps = i + 2;
        status = moray_kalman_predict(filter, 1, stop, &steps, variance);
        snprintf(says, sizeof says, "the filter's plant cannot be moved on from its point %d", i + 2);
        CHECK(status.code == MORAY_NUMERIC && strcmp(status.text, says) == 0, "%s", status.text);
        moray_kalman_free(filter);
    }
    CHECK_OK(moray_kalman_new(&filter, 3, x, variance), "new");
    const char *const nothing = "what is measured tells the filter nothing that is finite";
    static const double errors[][2] = {{0, 0}, {1, INFINITY}, {INFINITY, 1}, {NAN, 1}, {1, NAN}};
    for (int k = 0; k < 5; k++) {
        const moray_status status = moray_kalman_update(filter, 2, see_first_twice, NULL, z, errors[k], 0);
        CHECK(status.code == MORAY_NUMERIC && strcmp(status.text, nothing) == 0, "errors %g and %g: %s", errors[k][0],
              errors[k][1], status.text);
        for (int i = 0; i < 3; i++)
            CHECK(moray_kalman_estimate(filter)[i] == x[i] && moray_kalman_covariance(filter, i, i) == variance[i],
                  "state %d is as it was", i);
    }
    moray_kalman_free(filter);
}

int main(void)
{
    test_linear();
    test_sizes();
    test_back();
    test_refusals();
    return tap_done();
}
