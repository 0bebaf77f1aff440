// SPDX-License-Identifier: MIT
//
// A periodic orbit as a square system F(z; p) = 0: the collocation of one period and how it closes.
//
// z = [x of every node, the entries of p = [s, T] that are found, w], F = [defects of every interval; closing].
#ifndef SRC_CONTROL_ORBIT_SYSTEM_H
#define SRC_CONTROL_ORBIT_SYSTEM_H

#include "base/triplets.h"
#include "moray/control/periodic_orbit.h"
#include "moray/scheme.h"

typedef struct orbit_system {
    int nx, ns, nw, n_found, intervals;
    int nodes, unknowns, outputs, inputs; // the latter two of the plant
    const moray_map *plant, *closing;
    moray_scheme scheme;
    int *found;     // [n_found]
    int *column;    // [ns + 1] where a parameter stands in z; -1: it is given
    double *p;      // [ns + 1] of the last z that was evaluated
    double *in;     // [closing inputs] scratch: of the plant, which has fewer, or of the closing conditions
    double *out;    // [nodes][outputs] of the plant
    double *slope;  // [nodes][outputs][inputs], dense
    double *sparse; // [plant.jac.nnz] scratch
    double *closes; // [closing.jac.nnz]
    triplets jacobian;
    double *values; // [jacobian.pattern.nnz]
} orbit_system;

// Error: MORAY_INPUT (spec), MORAY_MEMORY. Free with moray_orbit_system_free, after errors too.
moray_status moray_orbit_system_new(orbit_system *system, const moray_periodic_orbit_spec *spec);
void moray_orbit_system_free(orbit_system *system);

double moray_orbit_period(const orbit_system *system);
double moray_orbit_time(const orbit_system *system, int node);
double moray_orbit_step(const orbit_system *system); // length of an interval

static inline double *orbit_slope_at(const orbit_system *system, int node)
{
    return system->slope + node * system->outputs * system->inputs;
}

// The plant at the nodes of z: `out` and F[unknowns]; false where it is not finite. Then `slope` and `values` there.
bool moray_orbit_residual(orbit_system *system, const double *z, double *F);
void moray_orbit_slopes(orbit_system *system, const double *z);

// d out / d in of the plant, dense, at a state and time.
void moray_orbit_plant_slope(orbit_system *system, const double *x, double t, double *slope);

// Adds to by[ns + 1] by how much weight.F changes with each given parameter, at constant z and phase, times `factor`;
// after moray_orbit_slopes.
void moray_orbit_by_parameters(const orbit_system *system, const double *weight, double factor, double *by);

#endif
