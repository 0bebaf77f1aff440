// SPDX-License-Identifier: MIT
//
// Slopes of a monotone spline against those of the plain one: each as it is, cut, or none where the numbers turn.
#include "tap.h"

#include "base/table.h"

enum { n = 9, stride = 2, rounds = 200 };

// The plain slope between quotients of its own sign, at most three times the smaller of them.
static double expected(double plain, double before, double after, int *cut)
{
    const double side = plain < 0 ? -1 : 1, most = 3 * (side * before < side * after ? side * before : side * after);
    if (most <= 0)
        return 0;
    *cut += side * plain > most;
    return side * plain > most ? side * most : plain;
}

int main(void)
{
    unsigned long long seed = 31;
    int cut = 0, none = 0, kept = 0;
    double worst = 0;
    for (int round = 0; round < rounds; round++) {
        double x[n], y[n * stride] = {0}, work[3 * n], plain[n * stride], monotone[n * stride];
        for (int i = 0; i < n; i++) {
            x[i] = i + tap_random(&seed, 0, 0.8) - 4;
            y[i * stride] = (round % 2 ? 0.9 : -0.9) * i + tap_random(&seed, -1, 1);
        }
        moray_spline_slopes(n, x, y, stride, MORAY_NOT_A_KNOT, work, plain);
        moray_spline_slopes(n, x, y, stride, MORAY_MONOTONE, work, monotone);
        for (int i = 0; i < n; i++) {
            const int low = i > 0 ? i - 1 : 0, high = i < n - 1 ? i : n - 2;
            const double before = (y[(low + 1) * stride] - y[low * stride]) / (x[low + 1] - x[low]);
            const double after = (y[(high + 1) * stride] - y[high * stride]) / (x[high + 1] - x[high]);
            const double want = expected(plain[i * stride], before, after, &cut);
            worst = tap_worse(worst, fabs(monotone[i * stride] - want));
            none += want == 0;
            kept += want == plain[i * stride];
        }
    }
    CHECK(worst < 1e-13, "slopes as they must be, to %.1e", worst);
    CHECK(cut > 20 && none > 20 && kept > 20, "%d were cut, %d none, %d kept", cut, none, kept);
    return tap_done();
}
