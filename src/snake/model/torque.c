// SPDX-License-Identifier: MIT
//
// Joints that give no more than a largest effort. In a state the efforts are u = A ubar + b, A the inertia that the
// joints feel: what is wanted, cut off, is what the joints give, and has accelerations of its own.
#include "snake/model/torque.h"

#include <math.h>

#include "moray/dense.h"

static bool cut(double *u, int n, double limit)
{
    bool beyond = false;
    for (int i = 0; i < n; i++) {
        beyond = beyond || fabs(u[i]) > limit;
        u[i] = fmin(fmax(u[i], -limit), limit);
    }
    return beyond;
}

bool moray_torque_limited(const torque_limit *limit, moray_efforts_fn *efforts, void *self, double *ubar)
{
    const int n = limit->n;
    double *wanted = limit->room, *u = wanted + n, *A = u + n;
    if (!efforts(self, ubar, wanted))
        return false;
    for (int i = 0; i < n; i++)
        u[i] = wanted[i];
    if (!cut(u, n, limit->most))
        return true;
    double *lacks = A + n * n, *column = lacks + n;
    for (int i = 0; i < n; i++)
        lacks[i] = u[i] - wanted[i];
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
