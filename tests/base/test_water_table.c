// SPDX-License-Identifier: MIT
//
// Currents over place and time: the table against the field that it was made of, and what is refused.
#include "water_table.h"

#include <string.h>
#include <unistd.h>

static char path[] = "/tmp/moray_water_XXXXXX";

// ---- Values and slopes ---------------------------------------------------------------------------------------------

static void slopes_of_cubic(double x, double y, double t, double d[2][MORAY_WATER_SLOPES])
{
    const double of[2][MORAY_WATER_SLOPES] = {
        {-0.003 * y * y + 0.001 * t, 0.02 - 0.006 * y * x, 0.001 * x, 0, -0.006 * y, -0.006 * x, 0.001, 0, 0},
        {0.008 * x + 0.0015 * x * x, -0.002 * t * t, -0.004 * t * y, 0.008 + 0.003 * x, 0, 0, 0, -0.004 * t,
         -0.004 * y}};
    memcpy(d, of, sizeof of);
}

// By each of the three functions, into what holds other numbers before.
static void test_point(const moray_water *water, const double at[3])
{
    double V[2] = {NAN, NAN}, W[2], d[2][MORAY_WATER_SLOPES], want[2][MORAY_WATER_SLOPES], worst = 0, slopes = 0;
    water_cubic(at[0], at[1], at[2], W);
    moray_water_at(water, at[0], at[1], at[2], V);
    worst = tap_worse(worst, fmax(fabs(V[0] - W[0]), fabs(V[1] - W[1])));
    V[0] = V[1] = 7;
    memset(d, 0xff, sizeof d);
    moray_water_slopes(water, at[0], at[1], at[2], V, d);
    worst = tap_worse(worst, fmax(fabs(V[0] - W[0]), fabs(V[1] - W[1])));
    slopes_of_cubic(at[0], at[1], at[2], want);
    for (int k = 0; k < 2 * MORAY_WATER_SLOPES; k++)
        slopes = tap_worse(slopes, fabs(d[k % 2][k / 2] - want[k % 2][k / 2]));
    for (int a = 0; a < 3; a++) {
        const double step = 1e-30;
        moray_num Z[2] = {5, 5};
        moray_water_at_complex(water, moray_complex(at[0], a == 0 ? step : 0), moray_complex(at[1], a == 1 ? step : 0),
                               moray_complex(at[2], a == 2 ? step : 0), Z);
        for (int c = 0; c < 2; c++) {
            worst = tap_worse(worst, fabs(creal(Z[c]) - W[c]));
            slopes = tap_worse(slopes, fabs(cimag(Z[c]) / step - want[c][a]));
        }
    }
    CHECK(worst < 1e-13 && slopes < 1e-11, "at (%g, %g) and %g values differ by %.1e, slopes by %.1e", at[0], at[1],
          at[2], worst, slopes);
}

static void test_cubic(void)
{
    moray_water *water = water_table(path, water_cubic, 6);
    for (int k = 0; k < 50; k++)
        test_point(water,
                   (double[]){-3 + 7.5 * fmod(0.618 * k, 1), -2 + 4 * fmod(0.414 * k, 1), 3.5 * fmod(0.732 * k, 1)});
    moray_water_free(water);
}

static void test_range(void)
{
    static const double inside[3] = {1, 0.5, 2}, ends[2][3] = {{-3, -2, 0}, {4.5, 2, 3.5}};
    moray_water *moving = water_table(path, water_cubic, 6), *steady = water_table(path, water_cubic, 1);
    double low[3], high[3], middle[3];
    moray_water_range(moving, low, high);
    for (int a = 0; a < 3; a++) {
        CHECK(low[a] == ends[0][a] && high[a] == ends[1][a], "axis %d from %g to %g", a, low[a], high[a]);
        for (int side = 0; side < 2; side++) {
            double at[3] = {inside[0], inside[1], inside[2]};
            at[a] = side ? ends[1][a] + 1e-9 : ends[0][a] - 1e-9;
            CHECK(moray_water_covers(moving, at[0], at[1], at[2]), "as far as rounding goes: %.10g", at[a]);
        }
        for (int side = 0; side < 2; side++)
            for (int beyond = -1; beyond <= 1; beyond += 2) {
                double at[3];
                memcpy(at, inside, sizeof at);
                at[a] = ends[side][a] + (side ? beyond : -beyond) * (beyond > 0 ? 2e-9 : -5e-10);
                CHECK(moray_water_covers(moving, at[0], at[1], at[2]) == (beyond < 0), "%g of axis %d is %s", at[a], a,
                      beyond < 0 ? "covered but for rounding" : "beyond");
            }
    }
    CHECK(!moray_water_covers(moving, NAN, 0, 1) && !moray_water_covers(moving, 0, 0, NAN), "nor is a NaN");
    moray_water_middle(moving, middle);
    for (int a = 0; a < 3; a++)
        CHECK_NEAR(middle[a], ends[0][a] + 0.45 * (ends[1][a] - ends[0][a]), 1e-15, "a little before the middle");
    moray_water_range(steady, low, high);
    CHECK(low[0] == -3 && high[1] == 2 && low[2] == -INFINITY && high[2] == INFINITY, "of one time at all times");
    CHECK(moray_water_covers(steady, 0, 0, -1e9) && !moray_water_covers(steady, 5, 0, 0), "which it covers");
    moray_water_free(moving);
    moray_water_free(steady);
}

// Of one time alone, by each of the functions, whatever time is asked for.
static void test_steady(void)
{
    moray_water *steady = water_table(path, water_cubic, 1);
    double V[2], W[2], own[2], d[2][MORAY_WATER_SLOPES];
    moray_num Z[2];
    water_cubic(0.7, -1.1, 0, own);
    moray_water_at(steady, 0.7, -1.1, 9, V);
    moray_water_slopes(steady, 0.7, -1.1, -8, W, d);
    moray_water_at_complex(steady, 0.7, -1.1, 7, Z);
    for (int c = 0; c < 2; c++) {
        CHECK_NEAR(V[c], own[c], 1e-14, "value");
        CHECK(W[c] == V[c] && creal(Z[c]) == V[c], "by all functions: %g, %g", W[c], creal(Z[c]));
        CHECK(d[c][2] == 0 && d[c][6] == 0 && d[c][7] == 0 && d[c][8] == 0, "which no time changes");
    }
    moray_water_free(steady);
}

// ---- What does not change ------------------------------------------------------------------------------------------

// In last digits neither, which a certificate would take for a slope.
static void test_uniform(void)
{
    moray_water *water = water_table(path, water_uniform, 3);
    double V[2], W[2], d[2][MORAY_WATER_SLOPES], most = 0;
    moray_water_at(water, 0.1, 0.2, 0.3, V);
    moray_water_slopes(water, 1.7, -0.9, 1.1, W, d);
    for (int k = 0; k < 2 * MORAY_WATER_SLOPES; k++)
        most = tap_worse(most, fabs(d[k % 2][k / 2]));
    CHECK(V[0] == W[0] && V[1] == W[1] && most == 0, "a uniform table to the last digit: slopes %g", most);
    moray_water_free(water);
}

// Each component along axes of its own: bit a of a mask says that it changes along axis a.
static int masks[2];

static void along_some(double x, double y, double t, double V[2])
{
    for (int c = 0; c < 2; c++)
        V[c] = 0.1 + (masks[c] & 1 ? sin(x) / 3 : 0) + (masks[c] & 2 ? cos(2 * y) / 7 : 0) +
               (masks[c] & 4 ? exp(-t) / 9 : 0);
}

static void test_some(void)
{
    static const int of[MORAY_WATER_SLOPES] = {1, 2, 4, 1, 3, 2, 5, 6, 4}; // what a derivative needs to change along
    for (masks[0] = 0; masks[0] < 8; masks[0]++) {
        masks[1] = 7 - masks[0];
        moray_water *water = water_table(path, along_some, 4);
        double V[2], W[2], d[2][MORAY_WATER_SLOPES];
        moray_num Z[2];
        moray_water_slopes(water, 0.3, -0.6, 0.9, V, d);
        for (int c = 0; c < 2; c++) {
            for (int i = 0; i < MORAY_WATER_SLOPES; i++)
                CHECK((masks[c] & of[i]) == of[i] || d[c][i] == 0, "axes %d: component %d has no derivative %d: %g",
                      masks[c], c, i, d[c][i]);
            for (int a = 0; a < 3; a++)
                CHECK(!(masks[c] & 1 << a) || fabs(d[c][a]) > 1e-3, "but changes along axis %d", a);
            const double at[3] = {masks[c] & 1 ? 0.3 : 2.9, masks[c] & 2 ? -0.6 : 1.7, masks[c] & 4 ? 0.9 : 1.3};
            moray_water_at(water, at[0], at[1], at[2], W);
            moray_water_at_complex(water, at[0], at[1], at[2], Z);
            CHECK(W[c] == V[c] && creal(Z[c]) == V[c], "and is the same elsewhere on the others: %g, %g", W[c], V[c]);
        }
        moray_water_free(water);
    }
}

// ---- What is refused -----------------------------------------------------------------------------------------------

#define STILL "x_m,y_m,v_x_m_s,v_y_m_s\n"
#define MOVING "y_m,t_s,x_m,v_x_m_s,v_y_m_s\n"

// says: behind the file's path.
static void refuse(const char *text, const char *before, const char *says)
{
    char whole[300];
    moray_water *water;
    FILE *file = fopen(path, "w");
    fputs(text, file);
    fclose(file);
    const moray_status status = moray_water_read(&water, path);
    snprintf(whole, sizeof whole, "%s%s%s", before, path, says);
    CHECK(status.code == MORAY_INPUT && !water && strcmp(status.text, whole) == 0, "%s, not %s", status.text, whole);
}

static void test_refusals(void)
{
    refuse(STILL "0,0,0,0\n0,1,0,0\n1,0,0,0\n", "water ", ": 3 points, where a grid of 2 x 2 x 1 has more");
    refuse(STILL "0,0,0,0\n0,1,0,0\n2,7,0,0\n2,7,0,0\n2,0,0,0\n1,1,1,1\n2,2,2,2\n3,3,3,3\n5,5,5,5\n", "water ",
           ": 9 points, where a grid of 5 x 6 x 1 has more");
    refuse(STILL "0,3,0,0\n0,4,0,0\n1,3,0,0\n1,3,0,0\n", "", ":5: the point (1, 3) stands twice");
    refuse(STILL "0,3,0,0\n0,4,0,0\n1,3,0,0\n1,3,0,0\n1,4,0,0\n", "", ":5: the point (1, 3) stands twice");
    refuse(STILL "0,0,0,0\n0,1,0,0\n", "water ", ": x_m must have two places or more");
    refuse(STILL "0,1,0,0\n2,1,0,0\n", "water ", ": y_m must have two places or more");
    refuse("x_m,y_m,v_x_m_s\n0,0,0\n", "", ":1: no column v_y_m_s: the columns must be x_m,y_m,v_x_m_s,v_y_m_s");
    refuse(MOVING "0,0,0,fast,0\n", "", ":2: v_x_m_s = fast: not a finite number");
    refuse(MOVING "2,0,5,1,1\n2,0,6,1,1\n3,0,5,1,1\n3,0,6,1,1\n2,1,5,1,1\n2,1,6,1,1\n3,1,5,1,1\n3,1,5,1,1\n", "",
           ":9: the point (5, 3) stands twice");
    moray_water *water;
    const moray_status status = moray_water_read(&water, "/nowhere/water.csv");
    CHECK(status.code == MORAY_IO && !water, "no file: %s", status.text);
    moray_water_free(NULL);
}

int main(void)
{
    close(mkstemp(path));
    test_cubic();
    test_range();
    test_steady();
    test_uniform();
    test_some();
    test_refusals();
    unlink(path);
    return tap_done();
}
