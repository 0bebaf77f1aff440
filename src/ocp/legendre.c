// SPDX-License-Identifier: MIT
#include "ocp/legendre.h"

#include <math.h>

// P_n and P_n' at x in (-1, 1), by the three-term recurrence.
static void legendre(int n, double x, double *p, double *dp)
{
    double before = 1, here = n ? x : 1;
    for (int k = 2; k <= n; k++) {
        const double next = ((2 * k - 1) * x * here - (k - 1) * before) / k;
        before = here;
        here = next;
    }
    *p = here;
    *dp = n ? n * (before - x * here) / (1 - x * x) : 0;
}

double moray_legendre_value(int n, double tau)
{
    double p, slope;
    legendre(n, 2 * tau - 1, &p, &slope);
    return p;
}

static double gauss_function(int s, double x, double *slope)
{
    double p;
    legendre(s, x, &p, slope);
    return p;
}

// Inner Lobatto points: zeros of P'_{s-1}; its slope from Legendre's equation.
static double lobatto_function(int s, double x, double *slope)
{
    double p, dp;
    legendre(s - 1, x, &p, &dp);
    *slope = (2 * x * dp - s * (s - 1) * p) / (1 - x * x);
    return dp;
}

// Radau points with the right end: zeros of (P_{s-1} - P_s)/(1 - x); the quotient removes the zero at the end.
static double radau_function(int s, double x, double *slope)
{
    double p, dp, q, dq;
    legendre(s - 1, x, &p, &dp);
    legendre(s, x, &q, &dq);
    *slope = ((dp - dq) * (1 - x) + (p - q)) / ((1 - x) * (1 - x));
    return (p - q) / (1 - x);
}

static void sort(double *node, int count)
{
    for (int i = 1; i < count; i++)
        for (int j = i; j > 0 && node[j] < node[j - 1]; j--) {
            const double larger = node[j - 1];
            node[j - 1] = node[j];
            node[j] = larger;
        }
}

// The `count` zeros of f in (-1, 1) by Newton's method, each freed of those found before (Maehly), ascending on [0, 1]:
// of many it may find one before a smaller one. A step beyond an end goes half of the way there.
static void zeros(double (*f)(int, double, double *), int s, int count, double *node)
{
    for (int i = 0; i < count; i++) {
        double x = -cos(M_PI * (i + 0.75) / (count + 0.5));
        for (int iteration = 0; iteration < 100; iteration++) {
            double slope, found = 0;
            const double value = f(s, x, &slope);
            for (int j = 0; j < i; j++)
                found += 1 / (x - (2 * node[j] - 1));
            const double step = value / (slope - value * found);
            x = fabs(x - step) < 1 ? x - step : (x + copysign(1, x - step)) / 2;
            if (fabs(step) < 1e-16)
                break;
        }
        node[i] = (1 + x) / 2;
    }
    sort(node, count);
}

void moray_legendre_gauss(int s, double *node, double *weight)
{
    zeros(gauss_function, s, s, node);
    for (int i = 0; i < s && weight; i++) {
        double p, dp;
        const double x = 2 * node[i] - 1;
        legendre(s, x, &p, &dp);
        weight[i] = 1 / ((1 - x * x) * dp * dp);
    }
}

void moray_legendre_radau(int s, double *node)
{
    zeros(radau_function, s, s - 1, node);
    node[s - 1] = 1;
}

void moray_legendre_lobatto(int s, double *node)
{
    node[0] = 0;
    zeros(lobatto_function, s, s - 2, node + 1); // the ends are known
    node[s - 1] = 1;
}
