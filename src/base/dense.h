// SPDX-License-Identifier: MIT
#ifndef SRC_BASE_DENSE_H
#define SRC_BASE_DENSE_H

#include <math.h>

// Who looks along dense directions. Each has its own, so that what happens to cancel along one's is seen by the others.
enum { MORAY_DENSE_PATTERN, MORAY_DENSE_COLUMNS, MORAY_DENSE_UNSEEN = 8, MORAY_DENSE_BENDS };

// Entry j of a direction that no symmetry of a function is likely to know: of size 0.5 to 1.5 and either sign.
static inline double moray_dense_entry(int j, int which)
{
    const double part = fmod(0.7548776662466927 * (j + 1) * (which + 1), 1);
    const double side = fmod(0.5698402909980532 * (j + 1) * (which + 1), 1) < 0.5 ? -1 : 1;
    return side * (0.5 + part);
}

#endif
