// SPDX-License-Identifier: MIT
//
// Maps of functions that know only real numbers, and the continued kinks of num.h, against closed forms.
#include "tap.h"

#include <string.h>

#include "base/numeric_map.h"
#include "moray/map.h"
#include "moray/num.h"

static double entry(const moray_pattern *pattern, const double *values, int row, int col, bool *found)
{
    *found = false;
    for (int k = 0; k < pattern->nnz; k++)
        if (pattern->row[k] == row && pattern->col[k] == col) {
            *found = true;
            return values[k];
        }
    return 0;
}

// out = (x0 x1 + sin 3 x2, x2^2 exp x3, x4, x0 / x3, 1 when x1 > 0 else x4^2)
static void sample(void *self, const double *x, double *out)
{
    ++*(int *)self;
    out[0] = x[0] * x[1] + sin(3 * x[2]);
    out[1] = x[2] * x[2] * exp(x[3]);
    out[2] = x[4];
    out[3] = x[0] / x[3];
    out[4] = x[1] > 0 ? 1 : x[4] * x[4];
}

static const double point[5] = {0.3, -1.2, 0.7, 1.9, 4};

static void test_real(void)
{
    moray_map map;
    int calls = 0;
    bool found;
    double values[32];
    CHECK_OK(moray_map_from_real(&map, 5, 5, sample, &calls, NULL, point), "a map of a real function");
    const double *x = point;
    const double jac[5][5] = {{x[1], x[0], 3 * cos(3 * x[2]), 0, 0},
                              {0, 0, 2 * x[2] * exp(x[3]), x[2] * x[2] * exp(x[3]), 0},
                              {0, 0, 0, 0, 1},
                              {1 / x[3], 0, 0, -x[0] / (x[3] * x[3]), 0},
                              {0, 0, 0, 0, 2 * x[4]}};
    calls = 0;
    map.jacobian(map.self, x, values);
    CHECK(calls == 12, "five columns in three directions of four evaluations: %d", calls);
    for (int i = 0; i < 5; i++)
        for (int j = 0; j < 5; j++) {
            CHECK_RELATIVE(entry(&map.jac, values, i, j, &found), jac[i][j], 1e-10, "Jacobian entry");
            CHECK(found == (jac[i][j] != 0), "pattern knows entry %d, %d", i, j);
        }
    const double w[5] = {2, -0.5, 3, 0.25, 0.6}, e = exp(x[3]);
    const double hess[5][5] = {{0},
                               {w[0], 0},
                               {0, 0, -9 * w[0] * sin(3 * x[2]) + 2 * w[1] * e},
                               {-w[3] / (x[3] * x[3]), 0, 2 * w[1] * x[2] * e,
                                w[1] * x[2] * x[2] * e + 2 * w[3] * x[0] / (x[3] * x[3] * x[3])},
                               {0, 0, 0, 0, 2 * w[4]}};
    map.hessian(map.self, x, w, values);
    for (int i = 0; i < 5; i++)
        for (int j = 0; j <= i; j++) {
            CHECK_RELATIVE(entry(&map.hess, values, i, j, &found), hess[i][j], 2e-7, "Hessian entry");
            CHECK(found == (hess[i][j] != 0), "pattern knows second derivative %d, %d", i, j);
        }
    moray_map_release(&map);
    moray_map_release(&map);
}

// A NaN that a comparison swallows does not hide an input.
static void swallows(void *self, const double *x, double *out)
{
    (void)self;
    out[0] = x[0] > 0.5 ? 2 * x[0] : 0;
    out[1] = fmax(x[1], 0);
}

static void released(void *self)
{
    ++*(int *)self;
}

static void test_swallowed(void)
{
    moray_map map;
    int releases = 0;
    const double x[] = {1, 1}, outside[] = {1, INFINITY};
    double values[4];
    CHECK_OK(moray_map_from_real(&map, 2, 2, swallows, &releases, released, x), "comparisons");
    CHECK(map.jac.nnz == 2 && map.hess.nnz == 0, "both inputs are found, and no curvature: %d, %d", map.jac.nnz,
          map.hess.nnz);
    map.jacobian(map.self, x, values);
    CHECK_NEAR(values[0] + values[1], 3, 1e-9, "their slopes");
    moray_map_release(&map);
    CHECK(releases == 1, "the user's data is released with the map");
    moray_status status = moray_map_from_real(&map, 2, 2, swallows, &releases, released, outside);
    CHECK(status.code == MORAY_INPUT &&
              strcmp(status.text, "output 1 of the function is inf at the probe point; it must be finite and real") ==
                  0,
          "not finite: %s", status.text);
    CHECK(releases == 2, "and released on error");
}

// Next to the end of its domain the steps shrink.
static void line_and_root(void *self, const double *x, double *out)
{
    (void)self;
    out[0] = 2 * x[0];
    out[1] = sqrt(x[0]);
}

static void test_domain(void)
{
    moray_map map;
    const double probe = 1;
    CHECK_OK(moray_map_from_real(&map, 1, 2, line_and_root, NULL, NULL, &probe), "a line and a square root");
    for (double x = 1e-2; x > 5e-9; x /= 10) {
        double slope[2];
        map.jacobian(map.self, &x, slope);
        CHECK_NEAR(slope[0], 2, 1e-9, "a line's slope");
        CHECK_NEAR(slope[1] * 2 * sqrt(x), 1, 2e-5, "a root's beside the end of its domain, relative");
    }
    moray_map_release(&map);
}

// ---- What an output is found to depend on, at one point ----

static moray_map look(int n_in, int n_out, moray_real_fn *function, const double *at, const double *size)
{
    moray_map map;
    const struct numeric_probe probe = {.points = at, .size = size, .n = 1};
    CHECK_OK(moray_real_map_new(&map, n_in, n_out, function, NULL, NULL, &probe), "a map by what is at one point");
    return map;
}

// Of no two outputs beside each other have values in common.
static void sides(void *self, const double *x, double *out)
{
    (void)self;
    out[0] = 1;
    out[1] = 2 + x[0];
    out[2] = 3 + (x[0] > 0);
    out[3] = 5 + x[0];
    out[4] = 7 + (x[0] < 0);
    out[5] = 9;
    out[6] = x[0] < 0 ? NAN : 10 + x[0];
    out[7] = 11 - x[0];
    out[8] = x[0] > 0 ? NAN : 12 + x[0];
    out[9] = 13 - x[0];
    out[10] = x[0] > 0 ? INFINITY : 14 + x[0];
}

// What changes, and to a number, on both sides is felt; a jump, or the end of the domain, is no slope.
static void test_sides(void)
{
    static const bool felt[11] = {[1] = true, [3] = true, [7] = true, [9] = true};
    const double at[1] = {0}, size[1] = {1}, none[11] = {0};
    double values[11];
    moray_map map = look(1, 11, sides, at, size);
    for (int i = 0; i < 11; i++) {
        bool found;
        entry(&map.jac, none, i, 0, &found);
        CHECK(found == felt[i], "output %d is %sfound to have a slope", i, felt[i] ? "" : "not ");
    }
    map.jacobian(map.self, at, values);
    CHECK_NEAR(values[0] + values[1] + values[2] + values[3], 0, 1e-9, "the slopes found, two up and two down");
    moray_map_release(&map);
}

static void shifted_sum(void *self, const double *x, double *out)
{
    (void)self;
    out[0] = 1 + x[0] + x[1] + x[0] * x[1] / 4;
}

// An input moves by a part of its size and of where it is, wherever that lies.
static void test_steps(void)
{
    static const double where[][2] = {{0, 0}, {1, 1}, {-1, -1}, {1, 0}, {0, 1}, {-1, 0}, {0, -1}};
    static const double tiny = 1e-30;
    for (size_t k = 0; k < sizeof where / sizeof *where; k++) {
        const double size[] = {where[k][0] != 0 && where[k][1] == 0 ? tiny : 1,
                               where[k][1] != 0 && where[k][0] == 0 ? tiny : 1};
        moray_map map = look(2, 1, shifted_sum, where[k], size);
        CHECK(map.jac.nnz == 2, "at (%g, %g), of sizes (%g, %g), both inputs are felt: %d", where[k][0], where[k][1],
              size[0], size[1], map.jac.nnz);
        CHECK(map.hess.nnz == 1, "and that they bend each other: %d", map.hess.nnz);
        moray_map_release(&map);
    }
}

static double hinge(double x)
{
    return fmax(x, 0);
}

// Lines through numbers that no binary fraction is, with kinks on one side, on both and at the point.
static void straight(void *self, const double *x, double *out)
{
    (void)self;
    out[0] = x[0] / 3 - x[1] / 7 - 1e3 / 3;
    out[1] = x[0] / 3 + x[1] / 7 + 1e3 / 3;
    out[2] = x[0] / 3 - 1e3 * x[1];
    out[3] = 1e3 * x[0] - x[1] / 3;
    out[4] = x[0] + hinge(x[0] - 1e-3);
    out[5] = x[0] + hinge(-x[0] - 1e-3);
    out[6] = x[0] + hinge(x[0] - 0.02) + hinge(-x[0] - 0.02) + hinge(x[0]);
    out[7] = x[0] + 1e-9 * (1 + x[0]) * x[1]; // whose bend is small, and no rounding
}

static void test_straight(void)
{
    static const double size[] = {1, 1};
    static const double at[][2] = {{0, 0}, {0, 0.3}, {0, -0.3}, {0, 1e3}, {0, -1e3}};
    for (size_t k = 0; k < sizeof at / sizeof *at; k++) {
        moray_map map = look(2, 8, straight, at[k], size);
        CHECK(map.hess.nnz == 1 && map.hess.row[0] == 1 && map.hess.col[0] == 0,
              "at %g: of lines and kinks none bends, of products even a small one: %d", at[k][1], map.hess.nnz);
        moray_map_release(&map);
    }
}

// Every pair of three groups that meet.
static void volume(void *self, const double *x, double *out)
{
    (void)self;
    out[0] = x[0] * x[1] * x[2];
}

static void test_pairs(void)
{
    const double at[] = {0.5, -2, 3}, size[] = {1, 1, 1}, weight = 2;
    double values[3];
    bool found;
    moray_map map = look(3, 1, volume, at, size);
    CHECK(map.hess.nnz == 3, "a product of three bends in three pairs: %d", map.hess.nnz);
    map.hessian(map.self, at, &weight, values);
    CHECK_NEAR(entry(&map.hess, values, 1, 0, &found), weight * at[2], 1e-6, "by the first two");
    CHECK_NEAR(entry(&map.hess, values, 2, 0, &found), weight * at[1], 1e-6, "by the first and last");
    CHECK_NEAR(entry(&map.hess, values, 2, 1, &found), weight * at[0], 1e-6, "by the last two");
    moray_map_release(&map);
}

// A complex function that is not real has no value.
static void imaginary(void *self, const double complex *x, double complex *out)
{
    (void)self;
    out[0] = csqrt(x[0]);
    out[1] = cpow(x[1], 2);
}

static void test_imaginary(void)
{
    moray_map map;
    const double probe[] = {1, 1}, at[] = {-1, -1};
    double out[2];
    CHECK_OK(moray_map_from_complex(&map, 2, 2, imaginary, NULL, NULL, probe), "root and square");
    map.value(map.self, at, out);
    CHECK(isnan(out[0]) && isnan(out[1]), "of negative numbers: %g, %g", out[0], out[1]);
    moray_map_release(&map);
    moray_status status = moray_map_from_complex(&map, 2, 2, imaginary, NULL, NULL, at);
    CHECK(status.code == MORAY_INPUT && strstr(status.text, "must be finite and real"), "%s", status.text);
}

// ---- num.h ----

// A function of two numbers with its partial derivatives by complex step.
static void check_num(moray_num (*f)(moray_num, moray_num), double a, double b, double value, double da, double db,
                      const char *what)
{
    const double h = 1e-50;
    CHECK_NEAR(creal(f(a, b)), value, 2e-15, what);
    CHECK_NEAR(cimag(f(moray_complex(a, h), b)) / h, da, 2e-15, what);
    CHECK_NEAR(cimag(f(a, moray_complex(b, h))) / h, db, 2e-15, what);
    CHECK(isnan(creal(f(NAN, b))) && isnan(creal(f(a, NAN))), "%s: a NaN passes through", what);
}

static moray_num absolute(moray_num a, moray_num b)
{
    return moray_abs(a) + 0 * b;
}
static moray_num sign(moray_num a, moray_num b)
{
    return moray_sign(a) * b;
}
static moray_num clamp(moray_num a, moray_num b)
{
    return moray_clamp(a, -1, b);
}

static moray_num square(moray_num a, moray_num b)
{
    return moray_pow(a, 2) + 0 * b;
}
static moray_num cube(moray_num a, moray_num b)
{
    return moray_pow(a, 3) + 0 * b;
}
static moray_num root_cubed(moray_num a, moray_num b)
{
    return moray_pow(a, 1.5) + 0 * b;
}

// Quick and full forms against the complex functions, on either side of where one takes the other's place.
static void test_quick(void)
{
    static const struct {
        moray_num (*quick)(moray_num);
        double complex (*full)(double complex);
        const char *name;
    } pair[] = {
        {moray_sin, csin, "sin"}, {moray_cos, ccos, "cos"}, {moray_exp, cexp, "exp"}, {moray_sqrt, csqrt, "sqrt"}};
    static const double imaginary[] = {0, 1e-50, -3e-50, 0.99e-9, 1.01e-9, 1e-6, 0.3, -2};
    for (unsigned k = 0; k < sizeof pair / sizeof *pair; k++)
        for (int i = 0; i < 40; i++)
            for (unsigned j = 0; j < sizeof imaginary / sizeof *imaginary; j++) {
                const moray_num z = moray_complex(0.013 + 0.37 * i, imaginary[j]);
                const double complex found = pair[k].quick(z), told = pair[k].full(z);
                const double part = imaginary[j] != 0 ? fabs(cimag(found) - cimag(told)) / fabs(imaginary[j]) : 0;
                CHECK(fabs(creal(found) - creal(told)) <= 4e-16 * cabs(told) && part <= 1e-15 * (1 + cabs(told)),
                      "%s of %g + %g i: %g + %g i, not %g + %g i", pair[k].name, creal(z), cimag(z), creal(found),
                      cimag(found), creal(told), cimag(told));
            }
    CHECK(cimag(moray_sqrt(moray_complex(-2, 0))) != 0, "the root of a negative number shows");
    CHECK(isnan(creal(moray_sin(NAN))) && isnan(creal(moray_cos(NAN))) && isnan(creal(moray_exp(NAN))) &&
              isnan(creal(moray_sqrt(NAN))),
          "a NaN passes through");
}

static void test_num(void)
{
    test_quick();
    check_num(square, -1.5, 0, 2.25, -3, 0, "square of a negative number");
    check_num(square, 0, 0, 0, 0, 0, "square of 0");
    check_num(cube, -1.5, 0, -3.375, 6.75, 0, "cube of a negative number");
    check_num(root_cubed, 4, 0, 8, 3, 0, "power 3/2");
    CHECK(isnan(creal(moray_pow(-4, 1.5))), "no power 3/2 of a negative number");
    check_num(absolute, -2, 1, 2, -1, 0, "abs of a negative number");
    check_num(absolute, 3, 1, 3, 1, 0, "abs of a positive number");
    check_num(sign, -3, 2, -2, 0, -1, "sign");
    check_num(moray_max, 1, 2, 2, 0, 1, "max");
    check_num(moray_max, 3, 2, 3, 1, 0, "max the other way");
    check_num(moray_min, 1, 2, 1, 1, 0, "min");
    check_num(moray_min, 3, 2, 2, 0, 1, "min the other way");
    check_num(clamp, 0.5, 2, 0.5, 1, 0, "clamp inside");
    check_num(clamp, 5, 2, 2, 0, 1, "clamp above");
    check_num(moray_hypot, 3, -4, 5, 0.6, -0.8, "hypot");
    for (int i = 0; i < 8; i++) {
        const double angle = -3 + 0.83 * i, r = 1.7, y = r * sin(angle), x = r * cos(angle);
        check_num(moray_atan2, y, x, angle, x / (r * r), -y / (r * r), "atan2");
    }
}

int main(void)
{
    test_real();
    test_swallowed();
    test_domain();
    test_sides();
    test_steps();
    test_straight();
    test_pairs();
    test_imaginary();
    test_num();
    return tap_done();
}
