// SPDX-License-Identifier: MIT
#ifndef SRC_SNAKE_IDENTIFY_IDENTIFY_H
#define SRC_SNAKE_IDENTIFY_IDENTIFY_H

#include "moray/snake/identify.h"
#include "snake/identify/motion.h"
#include "snake/identify/unknowns.h"

enum { FIRST = MORAY_BODY_STATES };
static const double first_scale = 0.1; // of the first states: rad, m, rad/s and m/s alike

// A measurement that counts.
struct item {
    int row, joint;
    moray_channel_kind kind;
    double observed, sigma;
};

struct run {
    const moray_swim_log *log;
    struct motion motion;
    double sigma[MORAY_CHANNELS];
    int freedom[MORAY_CHANNELS]; // of an estimated sigma; 0: known
    struct item *item;           // [items], row by row
    int items, steps;
    double h;
    double *grid; // [steps + 1][2 FIRST]: body states and their rates, as swum last
    double guess[FIRST];
};

struct moray_identify {
    moray_identify_spec spec;
    int unknown[MORAY_MOST_UNKNOWNS];
    double lower[MORAY_MOST_UNKNOWNS], upper[MORAY_MOST_UNKNOWNS], scale[MORAY_MOST_UNKNOWNS];
    int runs, items, columns; // columns: unknowns, and FIRST of each run
    struct run *run;
    moray_swimmer *swimmer;
    double *x, *dx, *joint;                  // full state, its rates; phi, v_phi, ubar, u
    double *up, *down, *here;                // [most items of a run] predictions
    double *residual, *jacobian;             // [items], [items][n + FIRST]
    double *normal, *gradient, *step, *work; // [columns]^2, [columns], ...
};

// The unknowns of an estimate in the world of the spec.
moray_unknowns moray_identify_world_of(const moray_identify *identify, const double *value);

// Swims run r in a world from the first state, into its grid; reads the items off the grid, into predicted[items].
// False where it cannot be swum.
bool moray_identify_swim(const moray_identify *identify, const struct run *run, const moray_unknowns *world,
                         const double first[FIRST]);
bool moray_identify_read(const moray_identify *identify, const struct run *run, const moray_unknowns *world,
                         double *predicted);

// Residuals over sigma of run r, (predicted - observed) / sigma, and unless NULL their derivatives by unknowns and
// first state over their scales: jacobian[items][n + FIRST].
bool moray_identify_residual(const moray_identify *identify, int r, const moray_estimate *at, double *residual,
                             double *jacobian);

// Weighted normal equations of all runs at an estimate, into normal and gradient; the cost. False where it is not to be
// had.
bool moray_identify_equations(const moray_identify *identify, const moray_estimate *at, double *cost);
bool moray_identify_cost(const moray_identify *identify, const moray_estimate *at, double *cost);

// Whether a component of the first state varies.
bool moray_identify_first_varies(const moray_identify *identify, int state);

#endif
