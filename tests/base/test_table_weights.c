// SPDX-License-Identifier: MIT
//
// Weights of a table's values and slopes: on a cubic polynomial they give it and its derivatives, whatever the knots.
#include "tap.h"

#include "base/table.h"
#include "moray/num.h"

static const double knots[] = {-2, -1.25, 0.5, 3, 3.5};
enum { count = sizeof knots / sizeof *knots };

// 2 - 3 x + x^2 / 4 + 5 x^3 and its derivatives.
static double complex cubic(double complex x, int derivative)
{
    return derivative == 0   ? 2 - 3 * x + x * x / 4 + 5 * x * x * x
           : derivative == 1 ? -3 + x / 2 + 15 * x * x
                             : 0.5 + 30 * x;
}

static void corners(int piece, double corner[4])
{
    for (int k = 0; k < 4; k++)
        corner[k] = creal(cubic(knots[piece + k / 2], k % 2));
}

static double weighted(const double weight[4], int piece)
{
    double corner[4], sum = 0;
    corners(piece, corner);
    for (int k = 0; k < 4; k++)
        sum += weight[k] * corner[k];
    return sum;
}

static double complex weighted_complex(const double complex weight[4], int piece)
{
    double corner[4];
    double complex sum = 0;
    corners(piece, corner);
    for (int k = 0; k < 4; k++)
        sum += weight[k] * corner[k];
    return sum;
}

static void test_within(const struct table_axis *axis)
{
    static const struct {
        double x;
        int piece;
    } points[] = {{-2, 0}, {-1.5, 0}, {-1.25, 1}, {0.25, 1}, {0.5, 2}, {1, 2}, {2.75, 2}, {3, 3}, {3.125, 3}, {3.5, 3}};
    for (unsigned k = 0; k < sizeof points / sizeof *points; k++) {
        const double x = points[k].x;
        double weight[3][4];
        double complex beside[4];
        CHECK(moray_table_weights(axis, x, weight) == points[k].piece, "the piece of %g", x);
        for (int d = 0; d < 3; d++)
            CHECK_NEAR(weighted(weight[d], points[k].piece), creal(cubic(x, d)), 1e-11, "a cubic and its derivatives");
        const double complex off = moray_complex(x, 0.375);
        CHECK(moray_table_complex_weights(axis, off, beside) == points[k].piece, "and off the real axis");
        CHECK_NEAR(cabs(weighted_complex(beside, points[k].piece) - cubic(off, 0)), 0, 1e-11, "the cubic there");
    }
}

// Beyond an end the value there, and the line through it where that is asked for.
static void test_beyond(const struct table_axis *axis)
{
    for (int side = 0; side < 2; side++) {
        const int end = side ? count - 1 : 0, piece = side ? count - 2 : 0;
        const double way = side ? 1.75 : -0.625, x = knots[end] + way;
        const double slope = axis->outside == MORAY_LINEAR ? creal(cubic(knots[end], 1)) : 0;
        const double value = creal(cubic(knots[end], 0));
        double weight[3][4];
        double complex beside[4];
        CHECK(moray_table_weights(axis, x, weight) == piece, "the outermost piece");
        CHECK_NEAR(weighted(weight[0], piece), value + slope * way, 1e-11, "value beyond the end");
        CHECK_NEAR(weighted(weight[1], piece), slope, 0, "slope beyond the end");
        CHECK_NEAR(weighted(weight[2], piece), 0, 0, "no bend beyond the end");
        CHECK(moray_table_complex_weights(axis, moray_complex(x, -0.5), beside) == piece, "and off the real axis");
        CHECK_NEAR(cabs(weighted_complex(beside, piece) - value - slope * moray_complex(way, -0.5)), 0, 1e-11,
                   "value beyond the end off the real axis");
    }
}

static void check_none(const struct table_axis *axis, double x)
{
    double weight[3][4];
    double complex beside[4];
    moray_table_weights(axis, x, weight);
    moray_table_complex_weights(axis, moray_complex(x, 0), beside);
    for (int k = 0; k < 12; k++)
        CHECK(isnan(weight[k / 4][k % 4]), "weight %d at %g is no number", k, x);
    for (int k = 0; k < 4; k++)
        CHECK(isnan(creal(beside[k])) && isnan(cimag(beside[k])), "complex weight %d at %g is no number", k, x);
}

int main(void)
{
    struct table_axis axis = {.x = knots, .n = count};
    axis.outside = MORAY_LINEAR;
    test_within(&axis);
    test_beyond(&axis);
    check_none(&axis, NAN);
    axis.outside = MORAY_NAN;
    test_within(&axis);
    check_none(&axis, -2.25);
    check_none(&axis, 3.75);
    axis.outside = MORAY_HOLD;
    test_within(&axis);
    test_beyond(&axis);
    check_none(&axis, NAN);
    return tap_done();
}
