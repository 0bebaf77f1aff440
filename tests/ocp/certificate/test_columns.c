// SPDX-License-Identifier: MIT
//
// Differences of columns beside a kink, which they may straddle.
#include "tap.h"

#include "ocp/certificate/columns.h"

// out = slope of its side times (in - joint); the cubic of in bends on its own.
struct bent {
    double joint, before, after;
};

static void value(void *self, const double *in, double *out)
{
    const struct bent *bent = self;
    const double beyond = in[0] - bent->joint;
    out[0] = (beyond < 0 ? bent->before : bent->after) * beyond;
    out[1] = in[0] * in[0] * in[0];
}

static void difference(const struct bent *bent, double in, double jac[2], double doubt[2], double kink[2])
{
    static const double size = 1;
    struct bent self = *bent;
    const moray_map map = {.n_in = 1, .n_out = 2, .value = value, .self = &self};
    CHECK_OK(moray_difference_columns(&map, &in, &size, NULL, jac, doubt, kink), "differences");
}

// Where one of the sides holds the input, its slope is among the two that are told, and nothing else is near it.
static void test_beside(void)
{
    const struct bent bent = {0.3, -1, -1.001};
    static const double distance[] = {0, 1e-9, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2};
    for (unsigned k = 0; k < sizeof distance / sizeof *distance; k++)
        for (int side = -1; side <= 1; side += 2) {
            double jac[2], doubt[2], kink[2];
            const double in = bent.joint + side * distance[k], own = in < bent.joint ? bent.before : bent.after;
            difference(&bent, in, jac, doubt, kink);
            CHECK(fmin(fabs(jac[0] + kink[0] - own), fabs(jac[0] - kink[0] - own)) <= 1e-9 + 4 * doubt[0],
                  "%g beside the joint: %.9g +- %.3g", in - bent.joint, jac[0], kink[0]);
            CHECK(doubt[0] < 1e-5, "%g beside it the differences are sure: %.1e", in - bent.joint, doubt[0]);
            CHECK(kink[1] == 0 && fabs(jac[1] - 3 * in * in) < 1e-8, "a cubic has no kink: %.1e", kink[1]);
        }
}

// The mean of both slopes is no derivative.
static void test_mean(void)
{
    const struct bent bent = {0.3, -1, 1};
    double jac[2], doubt[2], kink[2];
    difference(&bent, bent.joint, jac, doubt, kink);
    CHECK_NEAR(jac[0], 0, 1e-9, "mean of the slopes");
    CHECK_NEAR(kink[0], 1, 1e-9, "half their difference");
    CHECK(doubt[0] < 1e-8, "known: %.1e", doubt[0]);
}

static void test_smooth(void)
{
    const struct bent line = {0.3, 2, 2};
    double jac[2], doubt[2], kink[2];
    difference(&line, 0.3, jac, doubt, kink);
    CHECK_NEAR(jac[0], 2, 1e-9, "a line");
    CHECK(kink[0] == 0, "has no kink: %g", kink[0]);
}

// out = in and a little of its power: of two steps the extrapolate is exact, a quotient is not.
struct bow {
    double much;
    int power;
};

static void bowed(void *self, const double *in, double *out)
{
    const struct bow *bow = self;
    out[0] = in[0] + bow->much * pow(in[0], bow->power);
    out[1] = in[0];
}

static void test_extrapolates(void)
{
    static const struct {
        const char *what;
        struct bow bow;
        moray_bounds box;
    } cases[] = {{"a cubic from both sides", {2e-7, 3}, {-1, 1}},
                 {"a parabola from above", {4e-9, 2}, {0, 1}},
                 {"a parabola from below", {4e-9, 2}, {-1, 0}}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        struct bow self = cases[k].bow;
        const moray_map map = {.n_in = 1, .n_out = 2, .value = bowed, .self = &self};
        const double at = 0, size = 1;
        double jac[2], doubt[2], kink[2];
        CHECK_OK(moray_difference_columns(&map, &at, &size, &cases[k].box, jac, doubt, kink), "differences");
        CHECK(fabs(jac[0] - 1) < 1e-14 && fabs(jac[1] - 1) < 1e-14, "%s: its slope is exact, to %.1e", cases[k].what,
              jac[0] - 1);
        CHECK(doubt[0] > 1e-12 && doubt[0] < 1e-9 && doubt[1] < 1e-14, "as far as two steps tell: %.1e", doubt[0]);
    }
}

// An exponential beside a large constant, which says how exact a small slope need be.
struct counted {
    double sign, constant;
    int calls;
};

static void counted_value(void *self, const double *in, double *out)
{
    struct counted *counted = self;
    counted->calls++;
    out[0] = counted->sign * (counted->constant + 1e-3 * exp(9 * in[0]));
}

static int calls_for(double sign, double constant)
{
    static const double in = 0.3, size = 1;
    struct counted self = {.sign = sign, .constant = constant};
    const moray_map map = {.n_in = 1, .n_out = 1, .value = counted_value, .self = &self};
    double jac, doubt, kink;
    CHECK_OK(moray_difference_columns(&map, &in, &size, NULL, &jac, &doubt, &kink), "differences");
    CHECK_NEAR(jac, sign * 9e-3 * exp(9 * in), 1e-9 * (1 + constant), "of an exponential");
    return self.calls;
}

// What is exact enough beside values and slopes is no better with the other sign.
static void test_effort(void)
{
    for (int k = 0; k < 2; k++) {
        const double constant = k ? 1e3 : 0;
        const int calls = calls_for(1, constant), turned = calls_for(-1, constant);
        CHECK(calls == turned, "%d values, with the other sign %d", calls, turned);
    }
    CHECK(calls_for(1, 1e3) < calls_for(1, 0), "beside a large value fewer are needed");
}

int main(void)
{
    test_beside();
    test_mean();
    test_smooth();
    test_extrapolates();
    test_effort();
    return tap_done();
}
