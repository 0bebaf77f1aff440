// SPDX-License-Identifier: MIT
//
// What an integrator needs of an ordinary differential equation, and what others need of an integrator.
#ifndef MORAY_ODE_H
#define MORAY_ODE_H

#include "moray/export.h"
#include "moray/status.h"

MORAY_BEGIN

// x' = rhs(t, x), x and dx of n entries. rhs returns false outside its domain.
typedef struct moray_ode {
    int n;
    bool (*rhs)(double t, const double *x, double *dx, void *self);
    void *self;
} moray_ode;

// Called with the state at every requested time, in order; returns false to stop.
typedef bool moray_ode_observer(double t, const double *x, void *self);

// Integrates from t0 to t1 (x[n] is start and end) and shows the state at the n_times ascending times in `times`
// (within [t0, t1]; may be NULL with n_times 0). An implementation is src/sim; src/ocp certifies with any.
typedef struct moray_integrator {
    moray_status (*run)(const struct moray_integrator *self, const moray_ode *ode, double t0, double t1, double *x,
                        const double *times, int n_times, moray_ode_observer *observe, void *observer);
    const void *self;
} moray_integrator;

MORAY_END

#endif
