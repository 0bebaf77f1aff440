// SPDX-License-Identifier: MIT
//
// A fixed-step classical Runge-Kutta integrator, so that tests of the transcription need no other layer.
#ifndef TESTS_RK4_H
#define TESTS_RK4_H

#include <string.h>

#include "moray/ode.h"

static moray_status rk4_run(const moray_integrator *self, const moray_ode *ode, double t0, double t1, double *x,
                            const double *times, int n_times, moray_ode_observer *observe, void *observer)
{
    (void)times;
    (void)n_times;
    (void)observe;
    (void)observer;
    const int steps = *(const int *)self->self, n = ode->n;
    const double h = (t1 - t0) / steps;
    double k[4][64], y[64];
    for (int step = 0; step < steps; step++) {
        for (int stage = 0; stage < 4; stage++) {
            const double c = stage == 0 ? 0 : stage == 3 ? 1 : 0.5;
            for (int i = 0; i < n; i++)
                y[i] = x[i] + (stage ? c * h * k[stage - 1][i] : 0);
            if (!ode->rhs(t0 + (step + c) * h, y, k[stage], ode->self))
                return moray_error(MORAY_NUMERIC, "right-hand side undefined");
        }
        for (int i = 0; i < n; i++)
            x[i] += h / 6 * (k[0][i] + 2 * k[1][i] + 2 * k[2][i] + k[3][i]);
    }
    return moray_ok();
}

#endif
