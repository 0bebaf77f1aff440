// SPDX-License-Identifier: MIT
#ifndef PARTS_HEADING_HELMS_H
#define PARTS_HEADING_HELMS_H

#include "heading_job.h"

// What a pilot steers for.
typedef struct heading_aim {
    const moray_reference *reference;
    double lead;
    const moray_heading_plan *plan;
    double scale; // of the plan's offsets
} heading_aim;

// All that a helm may need, for one trial on one model.
typedef struct heading_helmsman {
    heading_aim aim;
    moray_plan plan;
    moray_pilot pilot;
    moray_heading_replanner replanner;
    moray_recede *recede;
    moray_helm helm;
} heading_helmsman;

// The helm of a trial on a model, in h->helm; h must stay where it is, and h->recede be freed. Error: that of
// moray_recede_new.
moray_status heading_set_helm(const heading_job *job, const heading_trial *trial, moray_model model,
                              heading_helmsman *h);

#endif
