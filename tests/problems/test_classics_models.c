// SPDX-License-Identifier: MIT
//
// What the textbook problems share: splines, and orbits against Cartesian motion in the potential of the oblate Earth.
#include "tap.h"

#include <tgmath.h>

#include "classics/linear.h"
#include "classics/orbit.h"
#include "classics/spline.h"

// ---- Splines ----

static double value_at(const spline *s, const double *y, moray_num x, double *slope)
{
    moray_num weight[SPLINE_MOST_KNOTS], value = 0;
    spline_weights(s, x + moray_complex(0, 1e-30), weight);
    for (int i = 0; i < s->n; i++)
        value += weight[i] * y[i];
    *slope = cimag(value) / 1e-30;
    return creal(value);
}

static void test_splines(void)
{
    const double knot[] = {0, 0.4, 0.5, 1, 1.2, 2}, y[] = {1, -1, 3, 2, 2, 5};
    double line[6], slope, before, after, low, high;
    spline s;
    spline_new(&s, 6, knot);
    for (int k = 0; k < 6; k++) {
        CHECK_NEAR(value_at(&s, y, knot[k], &slope), y[k], 1e-14, "value at a knot");
        line[k] = 3 * knot[k] - 1;
    }
    for (double x = -0.3; x < 2.3; x += 0.37) {
        CHECK_NEAR(value_at(&s, line, x, &slope), 3 * x - 1, 1e-13, "a straight line, beyond the knots too");
        CHECK_NEAR(slope, 3, 1e-13, "its slope");
    }
    for (int k = 1; k < 5; k++) { // second derivatives from differences of the slope
        const double h = 1e-6;
        value_at(&s, y, knot[k] - h, &low), value_at(&s, y, knot[k] - 2 * h, &before);
        value_at(&s, y, knot[k] + h, &high), value_at(&s, y, knot[k] + 2 * h, &after);
        CHECK_NEAR(low, high, 1e-3, "slope goes on through a knot");
        CHECK_NEAR((low - before) / h, (after - high) / h, 1e-2, "curvature goes on through a knot");
    }
    value_at(&s, y, 1e-6, &low), value_at(&s, y, 2e-6, &high);
    CHECK_NEAR((high - low) / 1e-6, 0, 1e-2, "no curvature at the end");
}

// ---- Linear equations ----

static void test_linear(void)
{
    moray_num M[3][3] = {{4, 1, -2}, {1, 5, 0.5}, {-2, 0.5, 6}}, x[] = {1, -2, 3}, b[3] = {0};
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            b[i] += M[i][j] * x[j];
    linear_solve3(M, b);
    for (int i = 0; i < 3; i++)
        CHECK_NEAR(creal(b[i]), creal(x[i]), 1e-14, "solution");
}

// ---- Orbits ----

static const double mu = 1.407645794e16, Re = 20925662.73, J[] = {0, 0, 1082.639e-6, -2.565e-6, -1.608e-6};

static moray_num potential(const moray_num *r)
{
    const moray_num d = sqrt(r[0] * r[0] + r[1] * r[1] + r[2] * r[2]), s = r[2] / d;
    moray_num P[5] = {1, s}, sum = 1;
    for (int k = 2; k <= 4; k++) {
        P[k] = ((2 * k - 1) * s * P[k - 1] - (k - 1) * P[k - 2]) / k;
        sum -= J[k] * pow(Re / d, k) * P[k];
    }
    return mu / d * sum;
}

// Textbook conversion (Walker, Ireland and Owens 1985).
static void cartesian(const double *e, double *x)
{
    const double f = e[1], g = e[2], h = e[3], k = e[4], c = cos(e[5]), s = sin(e[5]);
    const double a2 = h * h - k * k, s2 = 1 + h * h + k * k, r = e[0] / (1 + f * c + g * s), root = sqrt(mu / e[0]);
    x[0] = r / s2 * (c + a2 * c + 2 * h * k * s);
    x[1] = r / s2 * (s - a2 * s + 2 * h * k * c);
    x[2] = 2 * r / s2 * (h * s - k * c);
    x[3] = -root / s2 * (s + a2 * s - 2 * h * k * c + g - 2 * f * h * k + a2 * g);
    x[4] = -root / s2 * (-c + a2 * c + 2 * h * k * s - f + 2 * g * h * k + a2 * f);
    x[5] = 2 * root / s2 * (h * c + k * s + f * h + g * k);
}

// The Cartesian acceleration by complex step in the potential, plus the thrust turned from the orbit's own frame.
static void acceleration(const double *x, const double *thrust, double *a)
{
    const double d = sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]);
    const double n[] = {x[1] * x[5] - x[2] * x[4], x[2] * x[3] - x[0] * x[5], x[0] * x[4] - x[1] * x[3]};
    const double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    for (int i = 0; i < 3; i++) {
        moray_num r[] = {x[0], x[1], x[2]};
        r[i] += moray_complex(0, 1e-20);
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        const double across = (n[j] * x[k] - n[k] * x[j]) / (length * d); // transverse
        a[i] = cimag(potential(r)) / 1e-20 + thrust[0] * x[i] / d + thrust[1] * across + thrust[2] * n[i] / length;
    }
}

// d/dt of the Cartesian state through the elements' rates must be velocity and acceleration.
static void test_orbit(void)
{
    unsigned long long seed = 5;
    for (int trial = 0; trial < 20; trial++) {
        double e[] = {tap_random(&seed, 2e7, 5e7),  tap_random(&seed, -0.4, 0.4), tap_random(&seed, -0.4, 0.4),
                      tap_random(&seed, -0.5, 0.5), tap_random(&seed, -0.5, 0.5), tap_random(&seed, 0, 6)};
        const double thrust[] = {tap_random(&seed, -1, 1), tap_random(&seed, -1, 1), tap_random(&seed, -1, 1)};
        moray_num element[6], rate[6];
        double x[6], a[3], ahead[6], behind[6], worst = 0;
        for (int i = 0; i < 6; i++)
            element[i] = e[i];
        orbit_rates(element, (const moray_num[]){thrust[0], thrust[1], thrust[2]}, rate);
        cartesian(e, x);
        acceleration(x, thrust, a);
        const double step = 1e-2; // seconds
        double there[6], back[6];
        for (int i = 0; i < 6; i++) {
            there[i] = e[i] + step * creal(rate[i]);
            back[i] = e[i] - step * creal(rate[i]);
        }
        cartesian(there, ahead);
        cartesian(back, behind);
        for (int i = 0; i < 3; i++) {
            worst = tap_worse(worst, fabs((ahead[i] - behind[i]) / (2 * step) - x[3 + i]) / 2e4);
            worst = tap_worse(worst, fabs((ahead[3 + i] - behind[3 + i]) / (2 * step) - a[i]) / 10);
        }
        moray_num radial, transverse;
        orbit_velocity(element, &radial, &transverse);
        const double d = sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]), v2 = x[3] * x[3] + x[4] * x[4] + x[5] * x[5];
        const double outward = (x[0] * x[3] + x[1] * x[4] + x[2] * x[5]) / d;
        CHECK(worst < 1e-7, "rates of the elements against Cartesian motion: %.1e", worst);
        CHECK_RELATIVE(creal(radial), outward, 1e-9, "radial velocity");
        CHECK_RELATIVE(creal(transverse), sqrt(v2 - outward * outward), 1e-9, "transverse velocity");
    }
}

int main(void)
{
    test_splines();
    test_linear();
    test_orbit();
    return tap_done();
}
