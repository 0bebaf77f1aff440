// SPDX-License-Identifier: MIT
//
// Splines through two, three and four numbers against the polynomials that they are, and what is refused of splines and
// surfaces.
#include "tap.h"

#include <string.h>

#include "base/table.h"

static const double at[4] = {-1.5, 0.5, 1.25, 4};

static double poly(const double *c, double x, double *slope)
{
    *slope = c[1] + x * (2 * c[2] + 3 * c[3] * x);
    return c[0] + x * (c[1] + x * (c[2] + x * c[3]));
}

// Through n numbers a polynomial of degree n - 1, at any of the first places.
static void test_polynomials(void)
{
    for (int first = 0; first < 3; first++)
        for (int n = 2; n <= 4 - first; n++) {
            const double c[4] = {0.7, -1.3, n > 2 ? 0.4 : 0, n > 3 ? -0.2 : 0}, *x = at + first;
            double y[4], slope, worst = 0;
            moray_spline *spline;
            for (int i = 0; i < n; i++)
                y[i] = poly(c, x[i], &slope);
            CHECK_OK(moray_spline_new(&spline, n, x, y, MORAY_NOT_A_KNOT, MORAY_HOLD), "a spline");
            for (int k = 0; k <= 20; k++) {
                const double where = x[0] + (x[n - 1] - x[0]) * k / 20;
                double d[2];
                worst = tap_worse(worst, fabs(moray_spline_real(spline, where, d) - poly(c, where, &slope)));
                worst = tap_worse(worst, fabs(d[0] - slope));
            }
            CHECK(worst < 1e-13, "through %d numbers from %g: %.1e", n, x[0], worst);
            moray_spline_free(spline);
        }
}

// A natural spline through three numbers: no curvature at the ends, one that goes on in the middle.
static void test_natural(void)
{
    const double y[3] = {2, -1, 3};
    double d[2], left[2];
    moray_spline *spline;
    CHECK_OK(moray_spline_new(&spline, 3, at, y, MORAY_NATURAL, MORAY_HOLD), "a natural spline");
    moray_spline_real(spline, at[0], d);
    CHECK_NEAR(d[1], 0, 1e-13, "no curvature at the first");
    moray_spline_real(spline, at[2], d);
    CHECK_NEAR(d[1], 0, 1e-13, "nor at the last");
    moray_spline_real(spline, nextafter(at[1], -9), left);
    moray_spline_real(spline, at[1], d);
    CHECK_NEAR(d[0], left[0], 1e-13, "its slope goes on");
    CHECK_NEAR(d[1], left[1], 1e-12, "and its curvature");
    const double before = (y[1] - y[0]) / (at[1] - at[0]), after = (y[2] - y[1]) / (at[2] - at[1]);
    CHECK_NEAR(d[1], 3 * (after - before) / (at[2] - at[0]), 1e-12, "which is that of three moments");
    for (int i = 0; i < 3; i++)
        CHECK_NEAR(moray_spline_real(spline, at[i], NULL), y[i], 1e-15, "through its numbers");
    moray_spline_free(spline);
}

// ---- What is refused -----------------------------------------------------------------------------------------------

static void refuse(int n, const double *x, const double *y, int ends, int outside, const char *says)
{
    moray_spline *spline;
    const moray_status status =
        moray_spline_new(&spline, n, x, y, (moray_table_ends)ends, (moray_table_outside)outside);
    CHECK(status.code == MORAY_INPUT && !spline && strcmp(status.text, says) == 0, "%s, not %s", status.text, says);
}

static void test_refused(void)
{
    static const double flat[4] = {1, 1, 1, 1};
    char said[100];
    static const int lists[][2] = {{-1, MORAY_HOLD}, {MORAY_MONOTONE + 1, MORAY_HOLD}, {0, -1}, {0, MORAY_NAN + 1}};
    for (int k = 0; k < 4; k++) {
        snprintf(said, sizeof said, "x: ends %d and outside %d must be of their lists", lists[k][0], lists[k][1]);
        refuse(4, at, flat, lists[k][0], lists[k][1], said);
    }
    refuse(1, at, flat, 0, 0, "x: 1 numbers, at least 2 are needed");
    for (int i = 0; i < 4; i++)
        for (int kind = 0; kind < 3; kind++) {
            static const double bad[3] = {NAN, INFINITY, -INFINITY};
            double x[4], y[4] = {1, 2, 3, 4};
            memcpy(x, at, sizeof x);
            x[i] = bad[kind];
            snprintf(said, sizeof said, "x[%d] = %g: must be finite and ascend", i, bad[kind]);
            refuse(4, x, flat, 0, 0, said);
            y[i] = bad[kind];
            snprintf(said, sizeof said, "y[%d] = %g: must be finite", i, bad[kind]);
            refuse(4, at, y, 0, 0, said);
        }
    refuse(4, (double[]){0, 1, 1, 2}, flat, 0, 0, "x[2] = 1: must be finite and ascend");
    refuse(4, (double[]){0, 1, 2, 1.5}, flat, 0, 0, "x[3] = 1.5: must be finite and ascend");
}

static void test_refused_surface(void)
{
    moray_surface *surface;
    double z[12];
    for (int bad = 0; bad < 12; bad++) {
        char said[100];
        for (int k = 0; k < 12; k++)
            z[k] = k;
        z[bad] = INFINITY;
        const moray_status status = moray_surface_new(&surface, 3, at, 4, at, z, MORAY_NATURAL, MORAY_HOLD);
        snprintf(said, sizeof said, "z[%d][%d] = inf: must be finite", bad / 4, bad % 4);
        CHECK(status.code == MORAY_INPUT && !surface && strcmp(status.text, said) == 0, "%s", status.text);
    }
    moray_status status = moray_surface_new(&surface, 1, at, 4, at, z, MORAY_NATURAL, MORAY_HOLD);
    CHECK(strcmp(status.text, "x: 1 numbers, at least 2 are needed") == 0, "%s", status.text);
    status = moray_surface_new(&surface, 4, at, 1, at, z, MORAY_NATURAL, MORAY_HOLD);
    CHECK(strcmp(status.text, "y: 1 numbers, at least 2 are needed") == 0, "%s", status.text);
    moray_spline_free(NULL);
    moray_surface_free(NULL);
}

int main(void)
{
    test_polynomials();
    test_natural();
    test_refused();
    test_refused_surface();
    return tap_done();
}
