// SPDX-License-Identifier: MIT
//
// Simulated voyages: a swimmer under a helm from a straight cruise on, recorded and judged.
#ifndef MORAY_VOYAGE_H
#define MORAY_VOYAGE_H

#include "moray/heading.h"
#include "moray/helm.h"

typedef struct moray_voyage_plan {
    const moray_robot *robot;
    const moray_cruise *cruise; // model and gait; where it starts
    double heading;             // mean, at the start [rad]
    double current[2];          // [m/s]
    const moray_helm *helm;     // NULL: nobody steers
    double duration;            // [s]
    int intervals;              // recorded, of equal length
    double tolerance;           // of the simulation, relative and absolute
} moray_voyage_plan;

typedef struct moray_voyage {
    moray_swimmer *swimmer; // for drawing the states of the track
    moray_swim_track track; // intervals + 1 samples, x at p = 0 first
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

#endif
