// SPDX-License-Identifier: MIT
#ifndef SRC_OCP_GUESS_SIZES_H
#define SRC_OCP_GUESS_SIZES_H

#include "ocp/solution.h"

bool moray_is_rounding(double value, double size); // whether it may be, of what has that size

// Of a quantity: that of its bounds where it has both, else of its guess; 0 where that says nothing.
double moray_known_size(moray_bounds bounds, double guess);

// Whether a quantity is far smaller than that, yet not what a solver leaves of nothing.
bool moray_is_far_below(double value, double size);

double moray_largest_in_phase(const struct phase_layout *layout, const double *x, int state);

// size[nx + nu] of the states and controls of phase p at x, in whose caches the slopes are; of states that turned out
// far smaller than their boxes, where x is a solution, what they are there.
void moray_size_inputs(const struct transcription *t, int p, const double *x, enum sized_by point, double *size);

// What integral m may come to, by its integrand along the guess where its bounds and its guess tell nothing.
// work[n_in + n_out].
double moray_size_of_integral(const struct transcription *t, int p, int m, double guess, const double *size,
                              double *work);

#endif
