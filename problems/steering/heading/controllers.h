// SPDX-License-Identifier: MIT
#ifndef PROBLEMS_STEERING_HEADING_CONTROLLERS_H
#define PROBLEMS_STEERING_HEADING_CONTROLLERS_H

#include "job.h"

// What a feedback steers for.
typedef struct heading_aim {
    const moray_reference *reference;
    double lead;
    const moray_heading_plan *plan;
    double scale; // of the plan's offsets
} heading_aim;

// All that a controller may need, for one trial on one model.
typedef struct heading_steersman {
    heading_aim aim;
    moray_plan plan;
    moray_feedback feedback;
    moray_heading_replanner replanner;
    moray_receding_horizon *receding;
    moray_controller controller;
} heading_steersman;

// The controller of a trial on a model, in h->controller; h must stay where it is, and h->receding be freed. Error:
// that of moray_receding_horizon_new.
moray_status heading_set_controller(const heading_job *job, const heading_trial *trial, moray_model model,
                                    heading_steersman *h);

#endif
