// SPDX-License-Identifier: MIT
//
// Heading feedback of the field, which plans have to beat.
#ifndef MORAY_SNAKE_HEADING_LAW_H
#define MORAY_SNAKE_HEADING_LAW_H

#include "moray/export.h"
#include "moray/snake/controllers.h"
#include "moray/snake/heading.h"
#include "moray/snake/instruments.h"

MORAY_BEGIN

// phi_0 = proportional (e + integral y + derivative e') + forward r'(t + lead) with e = r(t + lead) - heading, y' = e;
// both as of the control-oriented model. Zeros leave parts out: P, P with preview (lead), P with rate feed-forward,
// PID.
typedef struct moray_heading_gains {
    double proportional; // [m/rad]
    double forward;      // [m s/rad]
    double lead;         // [s]
    double integral;     // [1/s]
    double derivative;   // [s]
} moray_heading_gains;

// Target and feed of a moray_feedback, whose gain is scale x proportional. The integral rests while the offset is at
// its limit and would be driven further; the heading's rate is that of a gyro, or taken from the heading, in either
// case filtered over `smoothing`.
typedef struct moray_heading_law {
    moray_heading_gains gains;
    const moray_reference *reference;
    const moray_feedback *feedback; // the one it serves: undulation, limits, period
    double scale;                   // offsets of the swimmer per offset of the control-oriented model
    double smoothing;               // [s]
    const moray_reading *reading;   // with the rate of a gyro; NULL: there is none
    double integral;                // now: y [rad s]
    double heading, rate;           // filtered [rad], [rad/s]
    bool begun;
} moray_heading_law;

MORAY_API double moray_heading_law_target(const moray_swim_sample *sample, void *law);
MORAY_API double moray_heading_law_feed(const moray_swim_sample *sample, double t, void *law);

MORAY_END

#endif
