// SPDX-License-Identifier: MIT
//
// Simulated voyages: a swimmer under a helm from a straight cruise on, recorded and judged.
#ifndef MORAY_VOYAGE_H
#define MORAY_VOYAGE_H

#include "moray/heading.h"
#include "moray/helm.h"
#include "moray/path.h"

typedef struct moray_voyage_plan {
    const moray_robot *robot;
    const moray_cruise *cruise;   // model and gait; where it starts
    double heading;               // mean, at the start [rad]
    double position[2];           // there [m]
    double current[2];            // [m/s]
    const moray_helm *helm;       // NULL: nobody steers
    double duration;              // [s]
    int intervals;                // recorded, of equal length
    double tolerance;             // of the simulation, relative and absolute
    moray_swim_observer *observe; // of the samples; false ends the voyage; NULL: nobody
    void *observer;
} moray_voyage_plan;

typedef struct moray_voyage {
    moray_swimmer *swimmer; // for drawing the states of the track
    moray_swim_track track; // intervals + 1 samples, or as far as the voyage went
    double *offset;         // phi_0 at each [m or rad]
} moray_voyage;

// Error: those of moray_swim_run. Free with moray_voyage_free.
moray_status moray_voyage_run(moray_voyage *voyage, const moray_voyage_plan *plan);
void moray_voyage_free(moray_voyage *voyage); // safe on a zeroed voyage, and twice

// Of the heading without its undulation, from the reference, which may jump at samples: root of the mean square, the
// last, the largest [rad]; and the mean joint power [W].
typedef struct moray_heading_score {
    double rms, final, largest, power;
} moray_heading_score;
moray_heading_score moray_voyage_heading_score(const moray_voyage *voyage, const moray_cruise *cruise,
                                               const moray_reference *reference);

// Of the distance to the path [m]: root of the mean square; the same, and the largest, from where the robot has come
// further along the path than `reach` from its start; when it passed the end of the path (NaN: it did not) [s]; the
// mean joint power until then [W].
typedef struct moray_path_score {
    double rms, settled_rms, settled_largest, time, power;
} moray_path_score;
moray_path_score moray_voyage_path_score(const moray_voyage *voyage, const moray_path *path, double reach);

#endif
