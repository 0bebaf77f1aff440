// SPDX-License-Identifier: MIT
//
// Joints that give no more than a largest effort. In a state the efforts are u = A ubar + b, A the inertia that the
// joints feel: what is wanted, cut off, is what the joints give, and has accelerations of its own.
#include "snake/model/torque.h"

#include <math.h>

#include "moray/dense.h"

// What the joints lack to what is wanted; whether one lacks any.
static bool cut(const double *wanted, int n, double limit, double *lacks)
{
    bool beyond = false;
    for (int i = 0; i < n; i++) {
        beyond = beyond || fabs(wanted[i]) > limit;
        lacks[i] = fmin(fmax(wanted[i], -limit), limit) - wanted[i];
    }
    return beyond;
}

bool moray_torque_limited(const torque_limit *limit, moray_efforts_fn *efforts, void *self, double *ubar)
{
    const int n = limit->n;
    double *wanted = limit->room, *lacks = wanted + n, *column = lacks + n, *A = column + n;
    if (!efforts(self, ubar, wanted))
        return false;
    if (!cut(wanted, n, limit->most, lacks))
        return true;
    for (int j = 0; j < n; j++) {
        const double before = ubar[j], step = 1 + fabs(before);
        ubar[j] += step;
        if (!efforts(self, ubar, column))
            return false;
        ubar[j] = before;
        for (int i = 0; i < n; i++)
            A[i * n + j] = (column[i] - wanted[i]) / step;
    }
    if (!moray_dense_solve(n, A, 1, lacks))
        return false;
    for (int i = 0; i < n; i++)
        ubar[i] += lacks[i];
    return true;
}
