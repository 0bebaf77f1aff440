// SPDX-License-Identifier: MIT
//
// A periodic orbit as a square system F(z; gait) = 0: the collocation of one period and how it closes.
//
// z = [x of every node, steering]; steering is the offset phi_0 where the heading returns, else the turn a period.
// F = [defects of every interval; p(0) = 0; heading, rate of turn and velocity through the water return, turned;
//      displacement across the course = 0].
#ifndef SRC_SNAKE_SWIM_ORBIT_SYSTEM_H
#define SRC_SNAKE_SWIM_ORBIT_SYSTEM_H

#include "base/triplets.h"
#include "moray/snake/orbit.h"
#include "moray/scheme.h"

enum { ORBIT_STATES = 6, ORBIT_PARAMETERS = 5, ORBIT_INPUTS = ORBIT_STATES + ORBIT_PARAMETERS + 1 };
enum { ORBIT_OMEGA = 1, ORBIT_OFFSET = 3 };                                               // of the parameters
enum { ORBIT_TIME = ORBIT_INPUTS - 1, ORBIT_OFFSET_INPUT = ORBIT_STATES + ORBIT_OFFSET }; // of the plant's input

typedef struct orbit_system {
    moray_orbit_spec spec; // without the scheme's name
    moray_map plant;       // with joint efforts
    moray_scheme scheme;
    int nodes, unknowns, outputs, power; // power: the output of that name
    double parameters[ORBIT_PARAMETERS]; // of the gait; a steered orbit has its offset in z
    double *out;                         // [nodes][outputs] of the plant
    double *slope;                       // [nodes][outputs][ORBIT_INPUTS], dense
    double *slope_values;                // [plant.jac.nnz]
    triplets jacobian;
    double *values; // [jacobian.pattern.nnz]
} orbit_system;

// Error: MORAY_INPUT (spec), MORAY_MEMORY. The system must not move. Free with moray_orbit_system_free, after errors
// too.
moray_status moray_orbit_system_new(orbit_system *system, const moray_orbit_spec *spec);
void moray_orbit_system_free(orbit_system *system);

double moray_orbit_period(const orbit_system *system);
double moray_orbit_time(const orbit_system *system, int node);
double moray_orbit_step(const orbit_system *system); // length of an interval
void moray_orbit_input(const orbit_system *system, const double *z, const double *x, double t, double in[ORBIT_INPUTS]);

// The plant at the nodes of z: `out` and F[unknowns]; false where it is not finite. Then `slope` and `values` there.
bool moray_orbit_residual(orbit_system *system, const double *z, double *F);
void moray_orbit_slopes(orbit_system *system, const double *z);

// d out / d in of the plant, dense, at any input.
void moray_orbit_plant_slope(orbit_system *system, const double *in, double *slope);

// By how much weight.F changes with each parameter, at constant z and phase, after moray_orbit_slopes.
void moray_orbit_by_parameters(const orbit_system *system, const double *weight, double by[ORBIT_PARAMETERS]);

// The same of output `row` of the plant at an input of time t and the given slope.
void moray_orbit_output_by_parameters(const orbit_system *system, const double *slope, int row, double t,
                                      double by[ORBIT_PARAMETERS]);

#endif
