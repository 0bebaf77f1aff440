// SPDX-License-Identifier: MIT
//
// Closed loops: any plant x' = f(t, x, u) under a sampled controller, simulated and recorded.
#ifndef MORAY_CONTROL_CLOSED_LOOP_H
#define MORAY_CONTROL_CLOSED_LOOP_H

#include "moray/sim.h"

// The plant: dx[nx] at time t, state x[nx] and control u[nu]. False outside its domain, as of a moray_ode.
// Disturbances, and whatever the controller knows nothing of, belong in here.
typedef struct moray_controlled_ode {
    int nx, nu; // at least 1, at least 0
    bool (*rates)(double t, const double *x, const double *u, double *dx, void *self);
    void *self;
} moray_controlled_ode;

// The loop at a time: x[nx], and the u[nu] that is applied from then on, in `measure` the one applied until then. What
// it points to lives until the return.
typedef struct moray_closed_loop_sample {
    double t;
    const double *x, *u;
} moray_closed_loop_sample;

// A sampled controller: what it does until the next measurement is decided at t0 and every `period` after it from what
// is then measured. `control` writes u[nu]; it is asked for any t from the last measurement up to the next, and for t0
// before the first. An error of `measure` ends the run.
typedef struct moray_controller {
    int nu; // as the plant's
    void (*control)(double t, double *u, const void *self);
    moray_status (*measure)(const moray_closed_loop_sample *sample, void *self); // NULL: measures nothing
    double period;                                                               // above 0 where it measures
    void *self;
} moray_controller;

// Times at which the plant jumps, ascending. `change` makes jump k, before anything is measured then.
typedef struct moray_jumps {
    const double *times;
    int n;
    void (*change)(int k, void *self);
    void *self;
} moray_jumps;

typedef struct moray_closed_loop_spec {
    moray_controlled_ode plant;
    const moray_controller *controller; // NULL: u = 0
    moray_jumps jumps;                  // n = 0: none; those not after t0 are made at t0
    double t0, t1;
    const double *times; // of the samples: ascending, within [t0, t1]; may be NULL with n_times 0
    int n_times;
    bool (*observe)(const moray_closed_loop_sample *sample, void *observer); // of the samples; false stops the run
    void *observer;
    moray_sim_settings settings;      // moray_sim_settings_default()
    moray_sim_statistics *statistics; // receives those of the run; may be NULL
} moray_closed_loop_spec;

// Simulates from t0 to t1; x[nx] is start and end state. Jumps, measurements and samples are exact stops; the
// integrator starts anew at every jump and measurement. When the observer stops the run, the status is ok and x the
// state last observed; after an error x is the state last reached. Error: MORAY_INPUT (sizes, times, period, settings),
// MORAY_MEMORY, MORAY_NUMERIC, that of `measure`.
moray_status moray_closed_loop_run(const moray_closed_loop_spec *spec, double *x);

// A recorded motion of n samples; row k of x and u belongs to t[k].
typedef struct moray_closed_loop_record {
    int capacity, n, nx, nu;
    double *t, *x, *u; // capacity times 1, nx, nu
} moray_closed_loop_record;

// An empty record with room for `capacity` samples; free with moray_closed_loop_record_free. Error: MORAY_INPUT for
// sizes below 0, MORAY_MEMORY.
moray_status moray_closed_loop_record_new(moray_closed_loop_record *record, int nx, int nu, int capacity);
void moray_closed_loop_record_free(moray_closed_loop_record *record); // safe on a zeroed record, and twice

// An observer with a moray_closed_loop_record as `observer`, of the plant's sizes: adds the sample; false when the
// record is full.
bool moray_closed_loop_record_add(const moray_closed_loop_sample *sample, void *record);

#endif
