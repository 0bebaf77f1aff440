// SPDX-License-Identifier: MIT
//
// Heading tracking in receding horizon: a helm that makes a new plan from the measured state every so often.
#ifndef MORAY_RECEDE_H
#define MORAY_RECEDE_H

#include "moray/heading.h"
#include "moray/helm.h"

typedef struct moray_recede_spec {
    moray_heading_spec heading;   // of the plans; start, undulation and times are set by this
    moray_settings settings;      // of each solve
    const moray_cruise *planned;  // of the plans' model: the gait that all plans keep
    const moray_cruise *measured; // of the swimmer's model
    double scale;                 // of the swimmer's offset to the plans'
    double horizon, interval;     // length of a plan; between two plans [s]
    bool preview; // the reference is known over the horizon; else it is taken to stay as it is at every new plan
} moray_recede_spec;

typedef struct moray_recede moray_recede;

// Error: MORAY_INPUT, MORAY_MEMORY. Free with moray_recede_free.
moray_status moray_recede_new(moray_recede **recede, const moray_recede_spec *spec);
void moray_recede_free(moray_recede *recede);

// Where a solve fails the swimmer goes on with the plan it has.
moray_helm moray_recede_helm(moray_recede *recede);

// Plans made so far, and what they cost.
typedef struct moray_recede_record {
    int plans, failures, iterations;
    double seconds, longest; // of all solves, of the longest after the first
    char first_failure[200];
} moray_recede_record;
const moray_recede_record *moray_recede_record_of(const moray_recede *recede);

#endif
