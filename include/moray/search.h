// SPDX-License-Identifier: MIT
//
// Local and global search in a few variables: minimise f(x) subject to c(x) <= 0 and lower <= x <= upper. NLopt
// underneath.
#ifndef MORAY_SEARCH_H
#define MORAY_SEARCH_H

#include "moray/export.h"
#include "moray/nlp.h"

MORAY_BEGIN

typedef enum {
    MORAY_SEARCH_SLSQP,  // local, by gradients: sequential quadratic programming
    MORAY_SEARCH_MMA,    // local, by gradients: moving asymptotes
    MORAY_SEARCH_COBYLA, // local: linear models on a simplex
    MORAY_SEARCH_BOBYQA, // local: quadratic model; no constraints c
    MORAY_SEARCH_MLSL,   // global: local searches (SLSQP, or COBYLA without gradients) from clusters of points; c goes
                         // into an augmented Lagrangian
    MORAY_SEARCH_ISRES,  // global: evolution strategy with stochastic ranking
    MORAY_SEARCH_DIRECT  // global: dividing rectangles
} moray_search_method;
MORAY_API const char *moray_search_method_name(moray_search_method method); // "slsqp", ...

typedef struct moray_search_problem {
    int n, m;                    // variables; constraints c
    const double *lower, *upper; // [n]; finite for the global methods, else MORAY_INFINITY for none
    bool gradients;              // evaluate can give them
    void *self;
    // f and c[m] at x[n], and unless NULL both gradient[n] and jacobian[m][n]. False where they are not defined: such a
    // point counts as infinitely bad.
    bool (*evaluate)(void *self, const double *x, double *f, double *c, double *gradient, double *jacobian);
} moray_search_problem;

typedef struct moray_search_progress {
    int evaluations;
    const double *x; // the best so far [n]
    double objective, violation;
} moray_search_progress;
typedef bool moray_search_observer(void *observer, const moray_search_progress *progress); // false stops the search

typedef struct moray_search_settings {
    moray_search_method method;      // MORAY_SEARCH_SLSQP
    double x_tolerance;              // 1e-10: relative change of x that ends a search
    double f_tolerance;              // 1e-12: of f
    double constraint_tolerance;     // 1e-9: violation of c that counts as none
    int max_evaluations;             // 2000; global methods use them all
    double max_seconds;              // 0: no limit
    unsigned long seed;              // 1: the same seed, the same search
    int population;                  // 0: NLopt's choice; of ISRES, and points a round of MLSL
    moray_search_observer *progress; // after every evaluation, unless NULL
    void *observer;
} moray_search_settings;

MORAY_API moray_search_settings moray_search_settings_default(void); // the values in the comments above

typedef enum {
    MORAY_SEARCH_CONVERGED, // to a tolerance, or as far as rounding lets it
    MORAY_SEARCH_EVALUATION_LIMIT,
    MORAY_SEARCH_TIME_LIMIT,
    MORAY_SEARCH_INTERRUPTED,
    MORAY_SEARCH_FAILED
} moray_search_outcome;
MORAY_API const char *moray_search_outcome_text(moray_search_outcome outcome);

typedef struct moray_search_info {
    moray_search_outcome outcome;
    int evaluations;
    double seconds;
    double objective, violation; // at the point found; violation: largest c above 0
} moray_search_info;

// Searches from x (put within its bounds), and leaves the best point evaluated there: of those within the constraint
// tolerance the one with the least f, else the one nearest to it. Returns MORAY_OK whenever NLopt ran and found a point
// where the functions are defined (read info->outcome). Error: MORAY_INPUT naming what is wrong with the problem or the
// settings, MORAY_NUMERIC when the functions were not defined anywhere, MORAY_MEMORY.
MORAY_API moray_status moray_search(const moray_search_problem *problem, const moray_search_settings *settings,
                                    double *x, moray_search_info *info);

MORAY_END

#endif
