// SPDX-License-Identifier: MIT
//
// A swimmer in closed loop as an equation to simulate: its state, then the work of its joints, or at the terminals of
// their motors, as one more.
#ifndef SRC_SNAKE_SWIM_CLOSED_LOOP_PLANT_H
#define SRC_SNAKE_SWIM_CLOSED_LOOP_PLANT_H

#include "moray/snake/swim.h"

// A uniform current that turns.
typedef struct swim_current {
    double start, V[2]; // at that time
    double turning;     // [rad/s]; 0: the swimmer's current is left alone
} swim_current;

typedef struct swim_plant {
    moray_swimmer *swimmer;   // the caller's
    moray_gait gait;          // followed now
    const moray_water *water; // NULL: the swimmer's own current
    swim_current current;
    int n_states, n_joints;
    double *x;                           // n_states + 1: room for a start or end state
    double *ubar, *u, *phi, *v_phi, *dx; // scratch
} swim_plant;

// Error: MORAY_MEMORY.
moray_status moray_swim_plant_new(swim_plant *plant, moray_swimmer *swimmer, const moray_gait *gait);
void moray_swim_plant_free(swim_plant *plant);

// Gives the swimmer the current that the water has at its centre of mass.
void moray_swim_stir(moray_swimmer *swimmer, const moray_water *water, double t, const double *x);

// The swimmer's current from t0 on; gives the swimmer the one of t.
swim_current moray_swim_current(const moray_swimmer *swimmer, const moray_swim_plan *plan);
void moray_swim_turn(moray_swimmer *swimmer, const swim_current *current, double t);

// Error: MORAY_INPUT where the swimmer has left the table of the water (NULL: none).
moray_status moray_swim_afloat(const moray_water *water, const moray_swim_sample *sample);

// n_states + 1 states; `self` is the plant.
moray_ode moray_swim_plant_ode(swim_plant *plant);

// Makes the gait's offset the one of u: phi_0 and its first two derivatives.
enum { SWIM_CONTROLS = 3 };
void moray_swim_plant_steer(swim_plant *plant, const double u[SWIM_CONTROLS]);

// The sample of the state x[n_states + 1]; points into x and the plant.
moray_swim_sample moray_swim_plant_sample(swim_plant *plant, double t, const double *x);

#endif
