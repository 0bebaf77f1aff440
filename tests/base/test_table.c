// SPDX-License-Identifier: MIT
//
// Splines against cubics, which they are exactly, and against functions, to which they converge with the fourth power;
// derivatives by the complex step against the analytic ones; what lies outside.
#include "tap.h"

#include <complex.h>
#include <string.h>
#include <unistd.h>

#include "base/table.h"
#include "moray/num.h"

enum { most = 65 };
static unsigned long long seed = 3;

static double cubic(double x)
{
    return 1 + x * (2 + x * (-0.5 + 0.3 * x));
}

static moray_spline *through(double (*f)(double), int n, double low, double high, moray_table_ends ends,
                             moray_table_outside outside)
{
    double x[most], y[most];
    moray_spline *spline;
    for (int i = 0; i < n; i++) {
        const double part = (double)i / (n - 1);
        x[i] = low + (high - low) * (part + 0.1 * part * (1 - part)); // not even
        y[i] = f(x[i]);
    }
    CHECK_OK(moray_spline_new(&spline, n, x, y, ends, outside), "a spline");
    return spline;
}

static void test_cubic(void)
{
    moray_spline *spline = through(cubic, 7, -1, 2, MORAY_NOT_A_KNOT, MORAY_HOLD);
    double value = 0, first = 0, second = 0, step = 0;
    for (int k = 0; k < 200; k++) {
        double d[2];
        const double x = tap_random(&seed, -1, 2);
        value = tap_worse(value, fabs(moray_spline_real(spline, x, d) - cubic(x)));
        first = tap_worse(first, fabs(d[0] - (2 - x + 0.9 * x * x)));
        second = tap_worse(second, fabs(d[1] - (-1 + 1.8 * x)));
        const double complex z = moray_spline_at(spline, moray_complex(x, 1e-100));
        step = tap_worse(step, fmax(fabs(creal(z) - cubic(x)), fabs(cimag(z) / 1e-100 - d[0])));
    }
    CHECK(value < 1e-13 && first < 1e-12 && second < 1e-11, "a cubic and its derivatives: %.1e, %.1e, %.1e", value,
          first, second);
    CHECK(step < 1e-12, "by complex step: %.1e", step);
    double range[2];
    moray_spline_range(spline, range);
    CHECK(range[0] == -1 && range[1] == 2, "from %g to %g", range[0], range[1]);
    moray_spline_free(spline);
}

static double worst(int n, moray_table_ends ends)
{
    moray_spline *spline = through(sin, n, 0, M_PI, ends, MORAY_HOLD);
    double error = 0;
    for (int k = 0; k < 500; k++) {
        const double x = M_PI * k / 499;
        error = tap_worse(error, fabs(moray_spline_real(spline, x, NULL) - sin(x)));
    }
    moray_spline_free(spline);
    return error;
}

// Natural ends are right for a sine, whose curvature vanishes there.
static void test_order(void)
{
    static const char *const names[] = {"not a knot", "natural"};
    for (int ends = MORAY_NOT_A_KNOT; ends <= MORAY_NATURAL; ends++) {
        const double order = log2(worst(33, ends) / worst(65, ends));
        CHECK(order > 3.6, "order %.2f, at least 4 in the limit: %s", order, names[ends]);
    }
}

static void test_smooth(void)
{
    double jump = 0, x[9], y[9], natural = 0, left[2], right[2];
    moray_spline *spline;
    for (int ends = MORAY_NOT_A_KNOT; ends <= MORAY_NATURAL; ends++) {
        for (int i = 0; i < 9; i++)
            x[i] = i + tap_random(&seed, 0, 0.6), y[i] = tap_random(&seed, -1, 1);
        CHECK_OK(moray_spline_new(&spline, 9, x, y, ends, MORAY_HOLD), "numbers at random");
        for (int i = 1; i < 8; i++) {
            moray_spline_real(spline, nextafter(x[i], 0), left);
            moray_spline_real(spline, x[i], right);
            jump = tap_worse(jump, fmax(fabs(left[0] - right[0]), fabs(left[1] - right[1])));
        }
        moray_spline_real(spline, x[0], left);
        natural = fabs(left[1]);
        moray_spline_free(spline);
    }
    CHECK(jump < 1e-11 && natural < 1e-11, "two derivatives go on at the numbers: %.1e; natural end %.1e", jump,
          natural);
}

static void test_monotone(double sign)
{
    const double x[] = {0, 1, 2, 3, 4, 5};
    double y[] = {0, 0.1, 0.2, 5, 5.2, 5.2};
    moray_spline *monotone, *plain;
    double fall = 0, plain_fall = 0;
    for (int k = 0; k < 6; k++)
        y[k] *= sign;
    CHECK_OK(moray_spline_new(&monotone, 6, x, y, MORAY_MONOTONE, MORAY_HOLD), "monotone");
    CHECK_OK(moray_spline_new(&plain, 6, x, y, MORAY_NOT_A_KNOT, MORAY_HOLD), "plain");
    for (int k = 0; k < 500; k++) {
        const double here = 0.01 * k, next = here + 0.01;
        fall = fmin(fall, sign * (moray_spline_real(monotone, next, NULL) - moray_spline_real(monotone, here, NULL)));
        plain_fall =
            fmin(plain_fall, sign * (moray_spline_real(plain, next, NULL) - moray_spline_real(plain, here, NULL)));
    }
    CHECK(fall > -1e-14 && plain_fall < -1e-3, "monotone never turns (%.1e), where the spline does (%.1e)", fall,
          plain_fall);
    moray_spline_free(monotone);
    moray_spline_free(plain);
}

static void test_outside(void)
{
    const double slope_high = 2 - 2 + 0.9 * 4, at[] = {-1, 2};
    for (int outside = MORAY_HOLD; outside <= MORAY_NAN; outside++) {
        moray_spline *spline = through(cubic, 5, -1, 2, MORAY_NOT_A_KNOT, outside);
        double d[2];
        const double high = moray_spline_real(spline, 5, d);
        const double complex z = moray_spline_at(spline, moray_complex(5, 1e-100));
        if (outside == MORAY_NAN) {
            CHECK(isnan(high) && isnan(creal(z)) && isnan(moray_spline_real(spline, -1.01, NULL)), "no number beyond");
        } else {
            const double slope = outside == MORAY_LINEAR ? slope_high : 0;
            CHECK_NEAR(high, cubic(2) + 3 * slope, 1e-12, "beyond the range");
            CHECK(fabs(d[0] - slope) < 1e-12 && d[1] == 0, "slope %g beyond, curvature %g", d[0], d[1]);
            CHECK(fabs(creal(z) - high) < 1e-12 && fabs(cimag(z) / 1e-100 - slope) < 1e-12, "by complex step");
        }
        for (int k = 0; k < 2; k++)
            CHECK_NEAR(moray_spline_real(spline, at[k], NULL), cubic(at[k]), 1e-13, "at the end itself");
        CHECK(isnan(moray_spline_real(spline, NAN, NULL)), "NaN gives NaN");
        moray_spline_free(spline);
    }
}

// Beyond an end that is held, only the value there counts, whatever the memory held before.
static void test_held_weights(void)
{
    const double x[] = {0, 1, 3};
    const struct table_axis axis = {3, x, MORAY_HOLD};
    for (int high = 0; high < 2; high++) {
        double complex weight[4] = {7, 7, 7, 7};
        double real[3][4];
        moray_table_complex_weights(&axis, high ? 4 : -1, weight);
        moray_table_weights(&axis, high ? 4 : -1, real);
        for (int k = 0; k < 4; k++) {
            const double expected = k == (high ? 2 : 0);
            CHECK(weight[k] == expected && real[0][k] == expected, "weight %d %s: %g, in real numbers %g", k,
                  high ? "above" : "below", creal(weight[k]), real[0][k]);
        }
    }
}

// ---- Surfaces
// --------------------------------------------------------------------------------------------------------

static double hill(double x, double y)
{
    return cubic(x) * (2 + y * y * (y - 1)) + x * y;
}

static void test_surface(void)
{
    double x[6], y[5], z[30], error = 0, step = 0;
    moray_surface *surface;
    for (int i = 0; i < 6; i++)
        x[i] = i * (1 + 0.1 * i) - 1;
    for (int j = 0; j < 5; j++)
        y[j] = j * (1 + 0.2 * j);
    for (int k = 0; k < 30; k++)
        z[k] = hill(x[k / 5], y[k % 5]);
    CHECK_OK(moray_surface_new(&surface, 6, x, 5, y, z, MORAY_NOT_A_KNOT, MORAY_LINEAR), "a surface");
    for (int k = 0; k < 200; k++) {
        const double a = tap_random(&seed, x[0], x[5]), b = tap_random(&seed, y[0], y[4]);
        const double A = cubic(a), A1 = 2 - a + 0.9 * a * a, A2 = -1 + 1.8 * a;
        const double B = 2 + b * b * (b - 1), B1 = 3 * b * b - 2 * b, B2 = 6 * b - 2;
        const double exact[] = {A1 * B + b, A * B1 + a, A2 * B, A1 * B1 + 1, A * B2}, size = 1 + fabs(hill(a, b));
        double d[5];
        error = tap_worse(error, fabs(moray_surface_real(surface, a, b, d) - hill(a, b)) / size);
        for (int i = 0; i < 5; i++)
            error = tap_worse(error, fabs(d[i] - exact[i]) / (size + fabs(exact[i])));
        step =
            tap_worse(step, fabs(cimag(moray_surface_at(surface, moray_complex(a, 1e-100), b)) / 1e-100 - d[0]) / size);
        step =
            tap_worse(step, fabs(cimag(moray_surface_at(surface, a, moray_complex(b, 1e-100))) / 1e-100 - d[1]) / size);
    }
    CHECK(error < 1e-12 && step < 1e-12, "a product of cubics, two derivatives: %.1e; complex step: %.1e", error, step);
    double d[5];
    moray_surface_real(surface, x[5], 1, d);
    CHECK_NEAR(moray_surface_real(surface, x[5] + 2, 1, NULL), hill(x[5], 1) + 2 * d[0], 1e-9, "straight on");
    moray_surface_free(surface);
    CHECK(moray_surface_new(&surface, 6, x, 5, y, z, MORAY_MONOTONE, MORAY_HOLD).code == MORAY_INPUT,
          "no monotone surface");
}

// ---- Files
// -----------------------------------------------------------------------------------------------------------

static moray_status from_file(const char *text, bool surface, double *value)
{
    char path[] = "/tmp/moray_table_XXXXXX";
    const int descriptor = mkstemp(path);
    moray_spline *spline = NULL;
    moray_surface *over = NULL;
    CHECK(write(descriptor, text, strlen(text)) == (ssize_t)strlen(text), "file");
    close(descriptor);
    const moray_status status = surface ? moray_surface_read(&over, path, "x", "y", "z", MORAY_NATURAL, MORAY_HOLD)
                                        : moray_spline_read(&spline, path, "x", "y", MORAY_NOT_A_KNOT, MORAY_HOLD);
    if (!moray_failed(status))
        *value = surface ? moray_surface_real(over, 0.5, 1.5, NULL) : moray_spline_real(spline, 0.5, NULL);
    moray_spline_free(spline);
    moray_surface_free(over);
    unlink(path);
    return status;
}

static void test_files(void)
{
    static const struct {
        const char *text, *told;
        bool surface;
        double value;
    } cases[] = {{"y,x [m]\n0,0\n1,1\n4,2\n", NULL, false, 0.25},
                 {"x,y\n0,0\n0,1\n", ":3:", false, 0},
                 {"x,y\n0,0\n1,nan\n", ":3:", false, 0},
                 {"x,z\n0,0\n1,1\n", "no column y", false, 0},
                 {"x,y\n0,0\n", "at least 2", false, 0},
                 {"x,y,z\n1,2,3\n0,1,0\n0,2,1\n1,1,2\n", NULL, true, 1.5},
                 {"x,y,z\n1,2,3\n0,1,0\n0,2,1\n", "do not fill", true, 0},
                 {"x,y,z\n1,2,3\n0,1,0\n0,2,1\n1,2,2\n", "stands twice", true, 0}};
    for (unsigned k = 0; k < sizeof cases / sizeof *cases; k++) {
        double value = 0;
        const moray_status status = from_file(cases[k].text, cases[k].surface, &value);
        if (cases[k].told)
            CHECK(status.code == MORAY_INPUT && strstr(status.text, cases[k].told), "told: %s", status.text);
        else
            CHECK(!moray_failed(status) && fabs(value - cases[k].value) < 1e-14, "read: %g %s", value, status.text);
    }
}

int main(void)
{
    test_cubic();
    test_order();
    test_smooth();
    test_monotone(1);
    test_monotone(-1);
    test_outside();
    test_held_weights();
    test_surface();
    test_files();
    return tap_done();
}
