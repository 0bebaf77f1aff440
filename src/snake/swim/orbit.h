// SPDX-License-Identifier: MIT
#ifndef SRC_SNAKE_SWIM_ORBIT_H
#define SRC_SNAKE_SWIM_ORBIT_H

#include "linear/klu.h"
#include "snake/swim/orbit_system.h"

// Where the largest joint effort was sampled.
typedef struct orbit_peak {
    double time, effort; // |u|
    int joint;
    bool negative; // u < 0
} orbit_peak;

struct moray_orbit {
    orbit_system system;
    sparse_lu *lu;
    double *z;                // [unknowns], the orbit
    double *F, *step, *trial; // [unknowns], Newton's; step serves the adjoint solves too
    moray_swimmer *swimmer;   // shows the orbit as simulations do
    double *x, *dx, *u, *phi; // the swimmer's state and rates, efforts; phi, v_phi, ubar of the gait
    double *ell, *integral;   // [points] basis of the scheme
    double *slope;            // [outputs][ORBIT_INPUTS] of the plant between the nodes
    moray_gait gait;
    bool found;
    bool factored; // slopes and factors are those of the orbit
    orbit_peak peak;
};

// Slopes and factors at the orbit, where Newton's method has left those of the step before. Error: MORAY_NUMERIC,
// MORAY_MEMORY; MORAY_INPUT without an orbit.
moray_status moray_orbit_factor(moray_orbit *orbit);

// The interval of time t; the scheme's basis there into `integral`.
int moray_orbit_locate(moray_orbit *orbit, double t);

// Component `row` of the plant's output integrated from the interval's start to where moray_orbit_locate was asked for.
double moray_orbit_integral(const moray_orbit *orbit, int interval, int row);

// The orbit's state there.
void moray_orbit_state(const moray_orbit *orbit, int interval, double x[ORBIT_STATES]);

// The swimmer on the orbit at time t; points into the orbit. Energy counts from t = 0 when it is called for ascending
// times.
moray_status moray_orbit_sample(moray_orbit *orbit, double t, moray_swim_sample *sample);

// Means over the period and peaks over samples of every degree; sets orbit->peak. Error: MORAY_NUMERIC.
moray_status moray_orbit_measure(moray_orbit *orbit, moray_steady *steady);

#endif
