// SPDX-License-Identifier: MIT
//
// A way through water that is not uniform: at each of its places the gait of least whole work per metre over ground in
// the current that the robot meets there and then, as though it swam in that current for good. That is the same
// approximation as the water's own (src/snake/README.md): what changes within a few strokes is left out. Where the
// current changes with time, a second has a price: what it costs on the rest of the way to be there later.
#ifndef PROBLEMS_GAIT_WAY_WAY_H
#define PROBLEMS_GAIT_WAY_WAY_H

#include "gait/job/job.h"

enum { WAY_PLACES = 60 };

// The middle of an equal share of the way.
typedef struct way_place {
    double along, x, y, course; // [m], [rad]
    double t, left, current[2]; // when the robot is there, and at the end of the share; what it meets [s], [m/s]
    double price;               // of a second, beside the constant power, as the water changes behind [W]
    stage at;
    moray_steady swum; // simulated from rest in that current; power NaN: cannot be
} way_place;

// What the whole way takes; NaN where the robot does not come through.
typedef struct way_total {
    double time, work; // [s], [J] of joints or motors and all else
} way_total;

typedef struct way_job {
    gait_job job;
    char water_file[MORAY_PATH_SIZE], way_text[MORAY_PATH_SIZE]; // empty: one current for good
    int places;
    moray_water *water;
    moray_path path;
    way_place place[WAY_PLACES], again[WAY_PLACES]; // again: room
    way_total own, one, paper; // on a gait for each place, on the best of these all the way, on the paper's
    int best;                  // place of that one
} way_job;

static inline bool way_given(const way_job *run)
{
    return run->water_file[0] || run->way_text[0];
}

// What gait_job_main does of a job that has a way. Error: MORAY_INPUT, also where the way leaves the table; those of
// moray_water_read, moray_path_read and gait_job_optimise.
moray_status way_work(gait_job *job);
moray_status way_certified(const gait_job *job);
moray_status way_report(gait_job *job);
void way_release(gait_job *job);

#endif
