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

// ---- Several values at a time --------------------------------------------------------------------------------------

// Three states; sums of them are measured.
static bool shear(void *self, double time, double *x)
{
    (void)self;
    x[0] += time * x[2];
    x[1] += 0.5 * time * x[0] - 0.3 * time * x[2];
    return true;
}

static double sum_of(const double *x, int i)
{
    return i == 0 ? x[0] + x[1] : i == 1 ? x[2] - 2 * x[0] : 0.5 * x[1] + x[2];
}

static void see_all(void *self, const double *x, double *z)
{
    (void)self;
    for (int i = 0; i < 3; i++)
        z[i] = sum_of(x, i);
}

static void see_one(void *self, const double *x, double *z)
{
    z[0] = sum_of(x, *(const int *)self);
}

// Values whose errors are independent tell a linear filter the same together as one after the other; and turns of an
// angle more or less tell it nothing.
static void test_together(void)
{
    const double start[3] = {1, -2, 0.5}, variance[3] = {0.5, 2, 0.7}, noise[3] = {0.1, 0.2, 0.05};
    const double error[3] = {0.1, 0.3, 0.02};
    unsigned long long seed = 11;
    moray_kalman *filter[2];
    for (int f = 0; f < 2; f++)
        CHECK_OK(moray_kalman_new(&filter[f], 3, start, variance), "new");
    double worst = 0;
    for (int k = 0; k < 10; k++) {
        double z[3], turned[3];
        for (int f = 0; f < 2; f++)
            CHECK_OK(moray_kalman_predict(filter[f], 0.3, shear, NULL, noise), "predicted");
        for (int i = 0; i < 3; i++) {
            z[i] = sum_of(moray_kalman_estimate(filter[1]), i) + tap_random(&seed, -1, 1);
            turned[i] = z[i] + (i == 1 ? 4 * M_PI : 0);
        }
        CHECK_OK(moray_kalman_update(filter[0], 3, see_all, NULL, turned, error, 2), "all at a time");
        for (int i = 0; i < 3; i++)
            CHECK_OK(moray_kalman_update(filter[1], 1, see_one, &i, &z[i], &error[i], 0), "one by one");
        for (int i = 0; i < 3; i++) {
            worst = tap_worse(worst, fabs(moray_kalman_estimate(filter[0])[i] - moray_kalman_estimate(filter[1])[i]));
            for (int j = 0; j < 3; j++) {
                const double together = moray_kalman_covariance(filter[0], i, j);
                worst = tap_worse(worst, fabs(together - moray_kalman_covariance(filter[1], i, j)));
                worst = tap_worse(worst, fabs(together - moray_kalman_covariance(filter[0], j, i)));
            }
        }
    }
    CHECK_NEAR(worst, 0, 1e-12, "to the same");
    for (int f = 0; f < 2; f++)
        moray_kalman_free(filter[f]);
}

// ---- Next to singular ----------------------------------------------------------------------------------------------

static bool add(void *self, double time, double *x)
{
    (void)time;
    x[1] += *(const double *)self * x[0];
    return true;
}

// What is known comes before what is not; a small variance beside a large one is not lost.
static void test_singular(void)
{
    const double start[2] = {3, 0}, none[2] = {0, 0}, error = 0.5;
    double plus = 1, minus = -1;
    moray_kalman *filter;
    CHECK_OK(moray_kalman_new(&filter, 2, start, (double[]){0, 1}), "new");
    CHECK_OK(moray_kalman_predict(filter, 1, add, &plus, none), "predicted");
    CHECK_OK(moray_kalman_update(filter, 1, see_one, &(int){0}, &(double){7.5}, &error, 0), "updated");
    const double *x = moray_kalman_estimate(filter);
    CHECK(x[0] == 3 && moray_kalman_covariance(filter, 0, 0) == 0, "the first state stays known: %g", x[0]);
    CHECK_NEAR(x[1], 3 + 1.5 * 1 / 1.5, 1e-12, "the second one takes all");
    CHECK_NEAR(moray_kalman_covariance(filter, 1, 1), 1 - 1 / 1.5, 1e-12, "and its variance");
    moray_kalman_free(filter);
    CHECK_OK(moray_kalman_new(&filter, 2, start, (double[]){1, 1e-12}), "new");
    CHECK_OK(moray_kalman_predict(filter, 1, add, &plus, none), "predicted");
    CHECK_OK(moray_kalman_predict(filter, 1, add, &minus, none), "and back");
    CHECK_NEAR(moray_kalman_covariance(filter, 1, 1), 1e-12, 1e-14, "the small variance");
    moray_kalman_free(filter);
}

// ---- What is seen is no sum ---------------------------------------------------------------------------------------

static void see_square(void *self, const double *x, double *z)
{
    (void)self;
    z[0] = x[0] * x[0];
}

// Of one state two points, x +- sqrt P: their squares are P larger than that of x in the mean.
static void test_square(void)
{
    const double x = 1.5, P = 0.16, error = 0.3, z = 3.1;
    moray_kalman *filter;
    CHECK_OK(moray_kalman_new(&filter, 1, &x, &P), "new");
    CHECK_OK(moray_kalman_update(filter, 1, see_square, NULL, &z, &error, 0), "updated");
    const double gain = 2 * x * P / (4 * x * x * P + error);
    CHECK_NEAR(moray_kalman_estimate(filter)[0], x + gain * (z - x * x - P), 1e-14, "estimate");
    CHECK_NEAR(moray_kalman_covariance(filter, 0, 0), P - gain * 2 * x * P, 1e-14, "variance");
    moray_kalman_free(filter);
}

static void see_squares(void *self, const double *x, double *z)
{
    (void)self;
    z[0] = x[0] * x[0];
    z[1] = x[1] * x[1];
}

// Of two states four points, x +- sqrt(2 P) along each: squares vary by 4 x^2 P + P^2, and together by -P0 P1.
static void test_squares(void)
{
    const double x[2] = {1.5, -0.8}, P[2] = {0.16, 0.3}, error[2] = {0.3, 0.1}, z[2] = {3.1, 0.2};
    moray_kalman *filter;
    CHECK_OK(moray_kalman_new(&filter, 2, x, P), "new");
    CHECK_OK(moray_kalman_update(filter, 2, see_squares, NULL, z, error, 0), "updated");
    double S[2], C[2], step[2];
    for (int i = 0; i < 2; i++) {
        S[i] = 4 * x[i] * x[i] * P[i] + P[i] * P[i] + error[i];
        C[i] = 2 * x[i] * P[i];
        step[i] = z[i] - x[i] * x[i] - P[i];
    }
    const double beside = -P[0] * P[1], det = S[0] * S[1] - beside * beside;
    for (int i = 0; i < 2; i++) {
        const int j = 1 - i;
        const double own = C[i] * S[j] / det, other = -C[i] * beside / det; // the gains
        CHECK_NEAR(moray_kalman_estimate(filter)[i], x[i] + own * step[i] + other * step[j], 1e-13, "estimate");
        CHECK_NEAR(moray_kalman_covariance(filter, i, i), P[i] - own * C[i], 1e-13, "variance");
        CHECK_NEAR(moray_kalman_covariance(filter, i, j), -other * C[j], 1e-13, "covariance");
    }
    moray_kalman_free(filter);
}

// ---- Refusals ------------------------------------------------------------------------------------------------------

static bool blow(void *self, double time, double *x)
{
    (void)time;
    const int place = *(const int *)self;
    if (place >= 0)
        x[place] = INFINITY;
    return place >= 0;
}

static void see_nothing(void *self, const double *x, double *z)
{
    (void)self, (void)x;
    z[0] = NAN;
}

enum { MANY = MORAY_KALMAN_MEASURED + 1 };

static void see_many(void *self, const double *x, double *z)
{
    for (int i = 0; i < *(const int *)self; i++)
        z[i] = x[i];
}

static void test_many(void)
{
    double zero[MANY] = {0}, one[MANY], worst = 0;
    for (int i = 0; i < MANY; i++)
        one[i] = 1;
    moray_kalman *filter;
    CHECK_OK(moray_kalman_new(&filter, MANY, zero, one), "new");
    CHECK_OK(moray_kalman_update(filter, MANY - 1, see_many, &(int){MANY - 1}, one, one, 0), "as many as there may be");
    for (int i = 0; i < MANY; i++)
        worst = tap_worse(worst, fabs(moray_kalman_estimate(filter)[i] - (i < MANY - 1 ? 0.5 : 0)));
    CHECK_NEAR(worst, 0, 1e-14, "each is believed by half");
    CHECK(moray_kalman_update(filter, MANY, see_many, &(int){MANY - 1}, one, one, 0).code == MORAY_INPUT, "no more");
    moray_kalman_free(filter);
}

static void test_refusals(void)
{
    const double start[2] = {1, 2}, variance[2] = {1, 1}, error[3] = {1, 1, 1}, z[3] = {0};
    moray_kalman *filter;
    CHECK(moray_kalman_new(&filter, 0, start, variance).code == MORAY_INPUT && !filter, "a filter of nothing");
    CHECK(moray_kalman_new(&filter, 2, (double[]){0, INFINITY}, variance).code == MORAY_INPUT && !filter,
          "a state that is not finite");
    CHECK(moray_kalman_new(&filter, 2, start, (double[]){NAN, 1}).code == MORAY_INPUT, "a variance that is no number");
    CHECK_OK(moray_kalman_new(&filter, 2, start, variance), "new");
    for (int place = -1; place < 2; place++)
        CHECK(moray_kalman_predict(filter, 1, blow, &place, variance).code == MORAY_NUMERIC, "no way on, by %d", place);
    CHECK(moray_kalman_update(filter, 1, see_nothing, NULL, z, error, 0).code == MORAY_NUMERIC, "nothing is seen");
    CHECK(moray_kalman_update(filter, 3, see_all, NULL, z, error, 0).code == MORAY_INPUT, "more values than states");
    const double *x = moray_kalman_estimate(filter);
    CHECK(x[0] == 1 && x[1] == 2 && moray_kalman_covariance(filter, 0, 0) == 1 &&
              moray_kalman_covariance(filter, 1, 0) == 0,
          "and the filter is as it was");
    moray_kalman_free(filter);
}

int main(void)
{
    test_linear();
    test_parameter();
    test_known();
    test_together();
    test_singular();
    test_square();
    test_squares();
    test_many();
    test_refusals();
    return tap_done();
}
