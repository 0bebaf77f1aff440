// SPDX-License-Identifier: MIT
//
// Controllers tuned from many starts: minimise a cost, as of simulated trials, over a few gains.
#ifndef MORAY_CONTROL_TUNING_H
#define MORAY_CONTROL_TUNING_H

#include <stdbool.h>

#include "moray/export.h"
#include "moray/status.h"

MORAY_BEGIN

enum { MORAY_TUNED_NUMBERS = 8 }; // at most

// On what scale a number is searched: by its own value, by its logarithm, or by asinh(value / unit), which is a
// logarithm of either sign with a zero in it.
typedef enum { MORAY_TUNED_LINEAR, MORAY_TUNED_LOGARITHMIC, MORAY_TUNED_WITH_ZERO } moray_tuned_scale;

typedef struct moray_tuned_number {
    moray_tuned_scale scale;
    double lower, upper; // searched within
    double unit;         // with zero: below which values count as small
} moray_tuned_number;

typedef struct moray_tuning_problem {
    int n; // 1..MORAY_TUNED_NUMBERS
    const moray_tuned_number *number;
    bool (*cost)(void *self, const double *x, double *cost); // false where there is none: infinitely bad
    void *self;
    // Other estimates of the cost, k < confirmations, as of the same trial simulated in other steps: where one of them
    // is above it by 2 %, what would be the best point of a search so far costs as much as that. Where a loop is
    // unstable its cost is as good as random, and the least of many would be a stroke of luck.
    int confirmations;
    bool (*confirm)(void *self, const double *x, int k, double *cost);
} moray_tuning_problem;

typedef struct moray_tuning_settings {
    int starts;                    // 12: local searches, from the best of four times as many points spread over the box
    int evaluations;               // 25: of each of them, per number
    double tolerance;              // 1e-4: relative change of the cost that counts as none
    bool remembers;                // true: no point is tried twice; false: one may cost another time something else
    int jobs;                      // 0: processes, as for moray_parallel
    bool (*go_on)(void *observer); // asked before every evaluation; false ends the tuning; NULL: goes on
    void *observer;
} moray_tuning_settings;

MORAY_API moray_tuning_settings moray_tuning_settings_default(void); // the values in the comments above

typedef struct moray_tuning_info {
    double cost;
    int evaluations; // all together
    int searches;    // local ones
    int agree;       // of these, how many came within 5 % of the cost
} moray_tuning_info;

// The best of all local searches, into x[n]. Searches start from every row of from[n_from][n] too, whose points are
// themselves tried: so that a controller tuned from the optimum of one with fewer numbers is never worse than that. The
// same whatever the jobs. Error: MORAY_INPUT for a scale and its bounds; MORAY_NUMERIC where there is no cost anywhere;
// MORAY_INTERRUPTED, with the best so far in x; those of moray_parallel.
MORAY_API moray_status moray_tune(const moray_tuning_problem *problem, const moray_tuning_settings *settings,
                                  const double *from, int n_from, double *x, moray_tuning_info *info);

MORAY_END

#endif
