// SPDX-License-Identifier: MIT
//
// An unscented Kalman filter: mean and covariance carried through a nonlinear plant by points, without derivatives.
#ifndef MORAY_CONTROL_KALMAN_H
#define MORAY_CONTROL_KALMAN_H

#include <stdbool.h>

#include "moray/export.h"
#include "moray/status.h"

MORAY_BEGIN

typedef struct moray_kalman moray_kalman;

// A filter of n states whose estimate is x[n] with these variances[n], at least 0 (0: known, and stays so without
// noise), uncorrelated. Free with moray_kalman_free. Error: MORAY_INPUT, MORAY_MEMORY.
MORAY_API moray_status moray_kalman_new(moray_kalman **filter, int n, const double *x, const double *variance);
MORAY_API void moray_kalman_free(moray_kalman *filter);

MORAY_API const double *moray_kalman_estimate(const moray_kalman *filter); // [n]
MORAY_API double moray_kalman_covariance(const moray_kalman *filter, int i, int j);

// The plant: moves x[n] on by a time. False outside its domain.
typedef bool moray_kalman_move(void *self, double time, double *x);

// Moves the estimate on; noise[n] is the variance that every state gains per unit of time. The 2n points are those of
// third degree, +-sqrt(n) standard deviations along the columns of the covariance's square root. Error: MORAY_NUMERIC,
// the filter is then as before.
MORAY_API moray_status moray_kalman_predict(moray_kalman *filter, double time, moray_kalman_move *move, void *self,
                                            const double *noise);

// What would be measured in x[n].
typedef void moray_kalman_see(void *self, const double *x, double *z);

enum { MORAY_KALMAN_MEASURED = 8 }; // at most at a time

// Takes in z[m] with independent errors of these variances[m], above 0; `angle` has a bit for every one that is an
// angle, compared round the circle. Error: as above.
MORAY_API moray_status moray_kalman_update(moray_kalman *filter, int m, moray_kalman_see *see, void *self,
                                           const double *z, const double *variance, unsigned angle);

MORAY_END

#endif
