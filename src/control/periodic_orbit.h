// SPDX-License-Identifier: MIT
#ifndef SRC_CONTROL_PERIODIC_ORBIT_H
#define SRC_CONTROL_PERIODIC_ORBIT_H

#include "control/orbit_system.h"
#include "linear/klu.h"

struct moray_periodic_orbit {
    orbit_system system;
    sparse_lu *lu;
    double *scale;            // [nx]
    double *z;                // [unknowns], the orbit
    double *F, *step, *trial; // [unknowns], Newton's; step serves the adjoint solves too
    double *ell, *integral;   // [points] basis of the scheme
    double *x;                // [nx] between the nodes
    double *slope;            // [outputs][inputs] of the plant there
    bool found;
    bool factored; // slopes and factors are those of the orbit
    bool usable;   // there are factors, of a point not far from it
};

// Slopes and factors at the orbit, where Newton's method has left those of a step before. Error: MORAY_NUMERIC,
// MORAY_MEMORY; MORAY_INPUT without an orbit.
moray_status moray_periodic_orbit_factor(moray_periodic_orbit *orbit);

// The interval of time t; the scheme's basis there into `integral`.
int moray_periodic_orbit_locate(moray_periodic_orbit *orbit, double t);

// Output `row` of the plant integrated from the interval's start to where moray_periodic_orbit_locate was asked for.
double moray_periodic_orbit_part(const moray_periodic_orbit *orbit, int interval, int row);

#endif
