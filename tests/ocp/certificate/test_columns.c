// SPDX-License-Identifier: MIT
//
// Differences of columns: beside a kink, which they may straddle, of several inputs, and what steps and rounding tell.
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
        CHECK(fabs(doubt[0] - 8e-11) < 1e-14 && doubt[1] < 1e-14,
              "the doubt is how far the quotient of the larger step is off, 8e-11: %.4e", doubt[0]);
    }
}

// Of a polynomial whose quotients err by as many powers of the step, so many steps make the extrapolate exact, and one
// more shows it.
static void power_of(void *self, const double *in, double *out)
{
    int *of = self; // power, calls
    of[1]++;
    out[0] = pow(in[0] + 0.5, of[0]);
}

static void test_steps(void)
{
    static const moray_bounds above = {0, INFINITY};
    const double at = 0, size = 1;
    double jac, doubt, kink;
    for (int side = 0; side < 2; side++)
        for (int errors = 1; errors <= 2 + side; errors++) {
            int of[] = {side ? errors + 1 : 2 * errors + 1, 0};
            const moray_map map = {.n_in = 1, .n_out = 1, .value = power_of, .self = of};
            CHECK_OK(moray_difference_columns(&map, &at, &size, side ? &above : NULL, &jac, &doubt, &kink),
                     "differences");
            CHECK(of[1] == 1 + (side ? 1 : 2) * (errors + 2), "power %d: %d values", of[0], of[1]);
            CHECK(fabs(jac - of[0] * pow(0.5, of[0] - 1)) <= doubt, "its slope is %.12g +- %.1e", jac, doubt);
        }
}

// ---- Several inputs and outputs ----

enum { SEVERAL = 3 };
static const double joints[SEVERAL] = {0.25, -1, 2},
                    corners[SEVERAL][SEVERAL] = {{0, 0.5, 0}, {0.75, 0, 0}, {0, 0.25, 2}};

// out = sin of what the inputs are weighted to, and corners[output][input] times their distances from joints.
static double inner(const double *in, int i)
{
    return in[0] * (i + 1) - in[1] / (i + 2) + in[2] * (0.5 - 0.3 * i);
}

static void several(void *self, const double *in, double *out)
{
    (void)self;
    for (int i = 0; i < SEVERAL; i++) {
        out[i] = sin(inner(in, i));
        for (int j = 0; j < SEVERAL; j++)
            out[i] += corners[i][j] * fabs(in[j] - joints[j]);
    }
}

static void test_several(void)
{
    static const double size[SEVERAL] = {0.5, 1, 3};
    static const moray_bounds box[SEVERAL] = {{0.2, 0.3}, {-2, 5}, {1.5, 9}};
    const moray_map map = {.n_in = SEVERAL, .n_out = SEVERAL, .value = several};
    double jac[SEVERAL][SEVERAL], doubt[SEVERAL][SEVERAL], kink[SEVERAL][SEVERAL];
    for (int boxed = 0; boxed < 2; boxed++) {
        CHECK_OK(moray_difference_columns(&map, joints, size, boxed ? box : NULL, jac[0], doubt[0], kink[0]),
                 "differences");
        for (int j = 0; j < SEVERAL; j++)
            for (int i = 0; i < SEVERAL; i++) {
                const double weight[] = {i + 1, -1.0 / (i + 2), 0.5 - 0.3 * i};
                const double slope = weight[j] * cos(inner(joints, i));
                CHECK(fabs(jac[j][i] - slope) <= doubt[j][i] && doubt[j][i] < 1e-8,
                      "output %d by input %d: %.10g +- %.1e is %.10g", i, j, jac[j][i], doubt[j][i], slope);
                CHECK(fabs(kink[j][i] - corners[i][j]) <= doubt[j][i], "with a corner of %g", kink[j][i]);
            }
    }
}

// ---- One side that is rough ----

// Behind 0 a line or a swing, ahead of it another, or what has no slope; and beside it a corner.
static void uneven(void *self, const double *in, double *out)
{
    const double *swings = self, x = in[0], swing = swings[x > 0];
    out[0] = (x > 0 ? 1 : 0.5) * x + (swing > 0 ? sin(swing * x) / swing : 0);
    if (swing < 0 && x != 0)
        out[0] += 0.5 * x * cos(M_PI * log(fabs(x) / 0.02) / log(4)); // a quotient turns from one step to the next
    out[1] = fabs(x);
}

// Where both sides differ for certain, what is told is what each side tells alone, with the larger doubt.
static void test_uneven(void)
{
    static const moray_bounds ahead = {0, INFINITY}, behind = {-INFINITY, 0};
    static double swings[][2] = {{0, 0}, {40, 0}, {0, 40}, {90, 15}, {-1, 0}, {0, -1}};
    const double at = 0, size = 1;
    for (int k = 0; k < 6; k++) {
        const moray_map map = {.n_in = 1, .n_out = 2, .value = uneven, .self = swings[k]};
        double jac[3][2], doubt[3][2], kink[3][2];
        CHECK_OK(moray_difference_columns(&map, &at, &size, NULL, jac[0], doubt[0], kink[0]), "both");
        CHECK_OK(moray_difference_columns(&map, &at, &size, &ahead, jac[1], doubt[1], kink[1]), "ahead");
        CHECK_OK(moray_difference_columns(&map, &at, &size, &behind, jac[2], doubt[2], kink[2]), "behind");
        CHECK_NEAR(kink[0][1], 1, 1e-9, "the corner beside it is seen");
        if (k < 4) {
            CHECK(fabs(jac[0][0] - (jac[1][0] + jac[2][0]) / 2) < 1e-14 &&
                      fabs(kink[0][0] - (jac[1][0] - jac[2][0]) / 2) < 1e-14,
                  "case %d: the mean %g and half the difference %g", k, jac[0][0], kink[0][0]);
            for (int i = 0; i < 2; i++)
                CHECK(doubt[0][i] == fmax(doubt[1][i], doubt[2][i]), "known as well as the worse side: %.1e",
                      doubt[0][i]);
        } else {
            CHECK(kink[0][0] == 0, "case %d: nothing is certain where a side is rough: %g", k, kink[0][0]);
        }
    }
}

// ---- One of two outputs that bends ----

struct beside {
    double line, bow; // of the first output
    int calls;
};

static void one_bends(void *self, const double *in, double *out)
{
    struct beside *beside = self;
    beside->calls++;
    out[0] = beside->line * in[0] + beside->bow * in[0] * in[0];
    out[1] = fabs(in[0]) + in[1];
}

// Whatever the other output does, the corner is seen, and a smooth column behind takes two steps to both sides.
static void test_beside_another(void)
{
    static const double at[2] = {0, 0}, size[2] = {1, 1};
    static const double lines[] = {0, 1, -1, 0, 0}, bows[] = {0, 0, 0, 1e6, -1e6};
    for (int k = 0; k < 5; k++) {
        struct beside self = {lines[k], bows[k], 0};
        moray_map map = {.n_in = 1, .n_out = 2, .value = one_bends, .self = &self};
        double jac[4], doubt[4], kink[4];
        CHECK_OK(moray_difference_columns(&map, at, size, NULL, jac, doubt, kink), "one column");
        const int alone = self.calls;
        map.n_in = 2, self.calls = 0;
        CHECK_OK(moray_difference_columns(&map, at, size, NULL, jac, doubt, kink), "two");
        CHECK(kink[1] == 1 && kink[0] == 0, "beside %g x + %g x^2 the corner is %g", lines[k], bows[k], kink[1]);
        CHECK(fabs(jac[3] - 1) < 1e-12 && kink[3] == 0 && self.calls == alone + 4, "the other input takes %d values",
              self.calls - alone);
    }
}

// ---- Where the functions are asked ----

static const moray_bounds *fence; // of both inputs, or NULL
static const double centre[] = {0.4, -0.7};
static double reach[2];
static int outside;

static void fenced(void *self, const double *in, double *out)
{
    (void)self;
    for (int j = 0; j < 2; j++) {
        reach[j] = fmax(reach[j], fabs(in[j] - centre[j]));
        outside += fence && (in[j] < fence[j].lower || in[j] > fence[j].upper);
    }
    out[0] = exp(in[0]) * sin(in[1]);
}

static void test_room(void)
{
    static const double room[] = {0, 1e-5, 2e-3, 0.3, INFINITY}, size[] = {0.5, 8};
    const moray_map map = {.n_in = 2, .n_out = 1, .value = fenced};
    const double slopes[] = {exp(0.4) * sin(-0.7), exp(0.4) * cos(-0.7)};
    double jac[2], doubt[2], kink[2];
    for (int k = 0; k < 625; k++) {
        const double below[] = {room[k % 5], room[k / 5 % 5]}, above[] = {room[k / 25 % 5], room[k / 125]};
        const moray_bounds box[] = {{centre[0] - below[0], centre[0] + above[0]},
                                    {centre[1] - below[1], centre[1] + above[1]}};
        if (below[0] + above[0] < 1e-3 || below[1] + above[1] < 1e-3)
            continue;
        fence = box, outside = 0;
        CHECK_OK(moray_difference_columns(&map, centre, size, box, jac, doubt, kink), "in a box");
        const double left = fmax(fabs(jac[0] - slopes[0]) - 1.5 * doubt[0], fabs(jac[1] - slopes[1]) - 1.5 * doubt[1]);
        if (outside > 0 || !(left <= 0) || !(fmax(doubt[0], doubt[1]) < 1e-7))
            CHECK(false, "with room below %g %g and above %g %g: asked %d times outside, %g and %g off", below[0],
                  below[1], above[0], above[1], outside, jac[0] - slopes[0], jac[1] - slopes[1]);
    }
    fence = NULL, reach[0] = reach[1] = 0;
    CHECK_OK(moray_difference_columns(&map, centre, size, NULL, jac, doubt, kink), "without");
    CHECK_RELATIVE(reach[1] / reach[0], size[1] / size[0], 1e-9, "steps are as large as what they are of");
}

// ---- No value behind or ahead, or none at all; no room ----

static void halved(void *self, const double *in, double *out)
{
    out[0] = pow(in[0], 1.5); // NaN behind 0
    out[1] = fabs(in[0]);
    out[2] = self ? *(double *)self : in[0];
}

static void mirrored(void *self, const double *in, double *out)
{
    halved(self, (double[]){-in[0]}, out);
    const double first = out[0];
    out[0] = out[2], out[2] = first;
}

static void test_nowhere(void)
{
    double none = NAN, jac[3] = {7, 7, 7}, doubt[3], kink[3], at = 0;
    const double size = 1;
    moray_map map = {.n_in = 1, .n_out = 3, .value = halved};
    CHECK_OK(moray_difference_columns(&map, &at, &size, NULL, jac, doubt, kink), "differences");
    CHECK(fabs(jac[1] - 1) < 1e-12 && kink[1] == 0, "no value behind: the slope ahead, %g, and no corner, %g", jac[1],
          kink[1]);
    map.value = mirrored;
    CHECK_OK(moray_difference_columns(&map, &at, &size, NULL, jac, doubt, kink), "differences");
    CHECK(fabs(jac[1] + 1) < 1e-12 && kink[1] == 0 && fabs(jac[2]) < 1e-2 && isfinite(doubt[2]),
          "none ahead: those behind, %g and %g", jac[1], jac[2]);
    map.value = halved, map.self = &none;
    CHECK_OK(moray_difference_columns(&map, &at, &size, NULL, jac, doubt, kink), "differences");
    CHECK(isnan(jac[2]) && isinf(doubt[2]) && kink[2] == 0, "no value anywhere: %g +- %g", jac[2], doubt[2]);
    map.self = NULL, at = 3;
    const moray_bounds fixed = {3, 3};
    CHECK_OK(moray_difference_columns(&map, &at, &size, &fixed, jac, doubt, kink), "differences");
    CHECK(fabs(jac[0] - 1.5 * sqrt(3)) < 1e-9, "what is fixed is differenced as if it were free: %g", jac[0]);
}

// ---- Rounding ----

static int raised_calls;

static void raised(void *self, const double *in, double *out)
{
    raised_calls++;
    out[0] = *(double *)self + in[0];
}

static void test_rounding(void)
{
    const double at = 0, size = 1;
    int off = 0, wild = 0;
    for (int k = 0; k < 400; k++) {
        double constant = (k % 2 ? 1 : -1) * (3000 + 17.123 * k), jac, doubt, kink;
        const moray_map map = {.n_in = 1, .n_out = 1, .value = raised, .self = &constant};
        CHECK_OK(moray_difference_columns(&map, &at, &size, NULL, &jac, &doubt, &kink), "differences");
        off += !(fabs(jac - 1) <= doubt);
        wild += raised_calls != 5 * (k + 1); // two steps to both sides: rounding is no bend
        wild += !(doubt < 1e-8) || kink != 0;
    }
    CHECK(off == 0 && wild == 0, "what rounding may do is in the doubt, %d times not, %d times too much", off, wild);
}

// An exponential beside a large constant, which says how exact a small slope need be.
struct counted {
    double sign, constant, unit;
    int calls;
};

static void counted_value(void *self, const double *in, double *out)
{
    struct counted *counted = self;
    counted->calls++;
    out[0] = counted->sign * (counted->constant + 1e-3 * exp(9 * in[0] / counted->unit));
}

static int calls_for(double sign, double constant, double unit)
{
    const double in = 0.3 * unit;
    struct counted self = {.sign = sign, .constant = constant, .unit = unit};
    const moray_map map = {.n_in = 1, .n_out = 1, .value = counted_value, .self = &self};
    double jac, doubt, kink;
    CHECK_OK(moray_difference_columns(&map, &in, &unit, NULL, &jac, &doubt, &kink), "differences");
    CHECK_NEAR(jac * unit, sign * 9e-3 * exp(9 * 0.3), 1e-9 * (1 + constant), "of an exponential");
    return self.calls;
}

// What is exact enough beside values and slopes is no better with the other sign.
static void test_effort(void)
{
    for (int k = 0; k < 2; k++) {
        const double constant = k ? 1e3 : 0;
        const int calls = calls_for(1, constant, 1), turned = calls_for(-1, constant, 1);
        CHECK(calls == turned, "%d values, with the other sign %d", calls, turned);
        CHECK(calls == calls_for(1, constant, 1024) && calls == calls_for(1, constant, 1 / 1024.), "in any unit");
    }
    CHECK(calls_for(1, 1e3, 1) < calls_for(1, 0, 1), "beside a large value fewer are needed");
}

int main(void)
{
    test_beside();
    test_mean();
    test_smooth();
    test_extrapolates();
    test_steps();
    test_several();
    test_uneven();
    test_beside_another();
    test_room();
    test_nowhere();
    test_rounding();
    test_effort();
    return tap_done();
}
