// SPDX-License-Identifier: MIT
//
// Derivative-free minimisation of a smooth function of few variables within bounds, on NLopt: for small fits.
#ifndef MORAY_SEARCH_H
#define MORAY_SEARCH_H

#include "moray/status.h"

// Writes the value at x[n], which must be finite. Returns false to give the search up.
typedef bool moray_search_fn(const double *x, double *value, void *self);

enum { MORAY_SEARCH_VARIABLES = 32 };

typedef struct moray_search_spec {
    int n; // from 2 to MORAY_SEARCH_VARIABLES
    moray_search_fn *function;
    void *self;
    const double *lower, *upper; // n each, finite, lower < upper
    const double *step;          // first step in each variable, at most half of upper - lower; sets its scale too
    double tolerance;            // ends when x is known to this part of the steps; below 1
    int max_evaluations;
} moray_search_spec;

typedef struct moray_search_end {
    double value;
    int evaluations;
    bool at_bound; // some variable ended at a bound, within the tolerance
} moray_search_end;

// Minimises from x[n] within the bounds; x is the best found. BOBYQA: quadratic models of the function in a region of
// trust. Error: MORAY_INPUT naming what is wrong with the spec or x; MORAY_INTERRUPTED when the function gave up;
// MORAY_NOT_SOLVED after max_evaluations, with x and *end what was reached; MORAY_NUMERIC for a value that is not
// finite; MORAY_MEMORY.
moray_status moray_search(const moray_search_spec *spec, double *x, moray_search_end *end);

#endif
