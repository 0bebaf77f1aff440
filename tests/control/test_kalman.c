// SPDX-License-Identifier: MIT
//
// The filter against the linear one worked out by matrices, on a parameter that it finds, round the circle, and what is
// known staying so.
#include "moray/control/kalman.h"

#include "tap.h"

// A mass whose speed is disturbed; its place is measured.
static bool drift(void *self, double time, double *x)
{
    (void)self;
    x[0] += time * x[1];
    return true;
}

static void see_place(void *self, const double *x, double *z)
{
    (void)self;
    z[0] = x[0];
}

static void test_linear(void)
{
    const double start[2] = {1, -2}, variance[2] = {0.5, 2}, noise[2] = {0, 0.3}, error = 0.1;
    double x[2] = {1, -2}, P[3] = {0.5, 0, 2}; // P00, P01, P11
    unsigned long long seed = 5;
    moray_kalman *filter;
    CHECK_OK(moray_kalman_new(&filter, 2, start, variance), "new");
    double worst = 0;
    for (int k = 0; k < 20; k++) {
        const double time = tap_random(&seed, 0.1, 1), z = tap_random(&seed, -3, 3);
        CHECK_OK(moray_kalman_predict(filter, time, drift, NULL, noise), "predicted");
        CHECK_OK(moray_kalman_update(filter, 1, see_place, NULL, &z, &error, 0), "updated");
        x[0] += time * x[1];
        P[0] += 2 * time * P[1] + time * time * P[2];
        P[1] += time * P[2];
        P[2] += noise[1] * time;
        const double S = P[0] + error, K0 = P[0] / S, K1 = P[1] / S, step = z - x[0];
        x[0] += K0 * step;
        x[1] += K1 * step;
        P[2] -= K1 * P[1];
        P[1] -= K0 * P[1];
        P[0] -= K0 * P[0];
        const double *found = moray_kalman_estimate(filter);
        worst = tap_worse(worst, fmax(fabs(found[0] - x[0]), fabs(found[1] - x[1])));
        for (int i = 0; i < 3; i++)
            worst = tap_worse(worst, fabs(moray_kalman_covariance(filter, i == 2, i > 0) - P[i]));
    }
    CHECK_NEAR(worst, 0, 1e-12, "of a linear plant it is the linear filter");
    moray_kalman_free(filter);
}

// x' = -rate x with an unknown rate; and an angle that turns at a known speed.
static bool decay(void *self, double time, double *x)
{
    (void)self;
    x[0] *= exp(-x[1] * time);
    x[2] += 2 * time;
    return true;
}

static void see_both(void *self, const double *x, double *z)
{
    (void)self;
    z[0] = x[0];
    z[1] = x[2];
}

static void test_parameter(void)
{
    const double truth = 0.7, start[3] = {1, 0.2, 0.3}, variance[3] = {0.01, 0.25, 0.04}, noise[3] = {0, 0, 0},
                 error[2] = {1e-6, 1e-4};
    moray_kalman *filter;
    CHECK_OK(moray_kalman_new(&filter, 3, start, variance), "new");
    for (int k = 1; k <= 40; k++) {
        const double z[2] = {1.05 * exp(-truth * 0.1 * k), remainder(2 * 0.1 * k + 0.4, 2 * M_PI)};
        CHECK_OK(moray_kalman_predict(filter, 0.1, decay, NULL, noise), "predicted");
        CHECK_OK(moray_kalman_update(filter, 2, see_both, NULL, z, error, 2), "updated");
    }
    const double *x = moray_kalman_estimate(filter);
    CHECK_NEAR(x[1], truth, 5e-3, "the rate found");
    CHECK_NEAR(x[2], 8.4, 1e-2, "the angle, measured within half a turn");
    CHECK(moray_kalman_covariance(filter, 1, 1) < 1e-4, "and known to be found");
    moray_kalman_free(filter);
}

static void test_known(void)
{
    const double start[2] = {0, 3}, variance[2] = {1, 0}, noise[2] = {0.1, 0}, error = 0.01;
    moray_kalman *filter;
    CHECK_OK(moray_kalman_new(&filter, 2, start, variance), "new");
    for (int k = 0; k < 5; k++) {
        const double z = 100;
        CHECK_OK(moray_kalman_predict(filter, 1, drift, NULL, noise), "predicted");
        CHECK_OK(moray_kalman_update(filter, 1, see_place, NULL, &z, &error, 0), "updated");
    }
    CHECK(moray_kalman_estimate(filter)[1] == 3, "what is known stays so");
    CHECK(moray_kalman_update(filter, 0, see_place, NULL, start, &error, 0).code == MORAY_INPUT, "nothing measured");
    moray_kalman_free(filter);
    CHECK(moray_kalman_new(&filter, 2, start, (double[]){1, -1}).code == MORAY_INPUT, "no variance below zero");
}

int main(void)
{
    test_linear();
    test_parameter();
    test_known();
    return tap_done();
}
