// SPDX-License-Identifier: MIT
//
// Gaits freed step by step: each motion may do all that the one before it may, within the same limits.
#ifndef PROBLEMS_GAIT_FREE_GAIT_FREE_GAIT_H
#define PROBLEMS_GAIT_FREE_GAIT_FREE_GAIT_H

#include "gait/job/job.h"

enum { FREE_GAIT_HARMONICS = 8, FREE_GAIT_MOTIONS = 2 + FREE_GAIT_HARMONICS };

// One kind of motion: the gait (25), tapered or not, or a series of so many harmonics.
typedef struct motion {
    char name[32];
    int harmonics;        // 0: a gait
    stage at;             // its prediction.gait has the series; its trial is of its own and the first-principles model
    double *coefficients; // of both models' series
    moray_series series[2];                // by model
    moray_gait_gain over_best, over_alike; // over the best gait (25) and over the first motion
} motion;

typedef struct free_gait {
    gait_job job; // its stages: the best gaits (25) by theta_max
    int harmonics;
    double link_angle; // asked for [rad]; NaN: see below
    double limit;      // of |link angle - heading| [rad]: by default the larger of theta_max_deg and of what the best
                       // gait (25) reaches
    motion motion[FREE_GAIT_MOTIONS];
    int n; // motions found, the last the freest
    moray_status
        vain[FREE_GAIT_HARMONICS + 1]; // by harmonics, 0 for the taper: why there is no motion; ok where there is
} free_gait;

static inline const motion *freest(const free_gait *run)
{
    return &run->motion[run->n - 1];
}

// Largest difference between what a motion's own model predicted and makes when it is swum, in speed [m/s] and power
// [W].
double free_gait_disagreement(const motion *m);

// Joint angles and link angles from the heading of a gait of the job's model over its period, as simulated: columns of
// n_samples in value, time first, then N-1 joints, then N links. Free *value. Error: those of moray_swim_steady.
enum { FREE_GAIT_SAMPLES = 181 };
moray_status free_gait_angles(const free_gait *run, const moray_gait_trial *trial, double **value);

// What moray_results wants of a free_gait.
void free_gait_summary(const void *run, moray_json *json);
moray_status free_gait_write(const void *run, moray_output *output);
moray_status free_gait_draw(const void *run, moray_output *output);

moray_status free_gait_report(gait_job *job);

#endif
