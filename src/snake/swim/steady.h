// SPDX-License-Identifier: MIT
#ifndef SRC_SNAKE_SWIM_STEADY_H
#define SRC_SNAKE_SWIM_STEADY_H

#include "moray/snake/swim.h"

enum { FINEST = 360 };              // samples of a period, at least
static const double TURNING = 1e-3; // heading drift of a turning gait [rad a period]

// moray_swim_steady with at least `min_periods` periods. Root finding over the start heading or the gait passes the
// largest number so far: a function of them that jumps with the number of periods may have no root.
moray_status moray_swim_settle(const moray_swim_setup *setup, const moray_gait *gait, double start_heading,
                               int min_periods, moray_steady *steady, moray_swim_track *orbit, int points);

// Relative changes of speed and power over the last period, and how much these differ from the ones before.
typedef struct steady_changes {
    double speed, power, bend;
} steady_changes;

steady_changes moray_steady_changes(const moray_steady *before, const moray_steady *now, const steady_changes *earlier);

// No change, or nothing but the trend with which the first-principles model turns in a cross current.
bool moray_steady_settled(const steady_changes *now, double agreement);

#endif
