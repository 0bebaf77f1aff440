// SPDX-License-Identifier: MIT
#ifndef PROBLEMS_STEERING_HEADING_HEADING_H
#define PROBLEMS_STEERING_HEADING_HEADING_H

#include "steering/steer.h"

typedef struct heading_job {
    steer_job steer;
    char reference_text[MORAY_PATH_SIZE];
    double horizon; // [s]; NaN: by the reference
    double weight_power, max_error;
    int gait_evaluations;
    // found along the way
    moray_reference reference;
    // by the search for the gait of the first-principles plan
    int gaits_tried;
    double first_objective, best_objective; // on its coarse mesh
} heading_job;

// ---- Fig. 8 --------------------------------------------------------------------------------------------------------

// Whether the reference is the manoeuvre of Sec. V-C.
bool heading_is_fig8(const heading_job *job);

// Sets gait, reference, and the horizon unless it is given. Error: those of moray_straight_motion_find and
// moray_swim_closed_loop_run.
moray_status heading_fig8_prepare(heading_job *job);

// The offset that a plan found beside the paper's [m or rad]: the paper's while it turns, there and, but for the sign,
// back; means found there, back and straight on, without 3 s behind and before every edge; root of the mean square of
// the difference over the whole horizon.
enum { FIG8_PAPER, FIG8_THERE, FIG8_BACK, FIG8_STRAIGHT, FIG8_RMS, FIG8_VALUES };
void heading_fig8_compare(const heading_job *job, moray_model model, double match[FIG8_VALUES]);

// manoeuvre.svg: the offsets found in place of the paper's.
moray_status heading_fig8_draw(const heading_job *job);

// ---- Plans ---------------------------------------------------------------------------------------------------------

// Plans: first the averaged and the control-oriented one, last the first-principles one. Error: MORAY_NOT_SOLVED saying
// what limits the robot, MORAY_INTERRUPTED, and those of moray_heading_plan_make.
moray_status heading_plan_first(heading_job *job);
moray_status heading_plan_last(heading_job *job);

moray_heading_spec heading_spec(const heading_job *job, moray_model model, bool averaged);

// Of a solve on the averaged plant or the full one, whose undulation has that period.
moray_settings heading_settings(heading_job *job, bool averaged, double period);

// The gait whose first-principles plan has the least objective on a coarse mesh, within the limits of gait and
// straight-ahead power, from `start` on; its plan must be freed even after an error. Error: those of moray_search;
// MORAY_NOT_SOLVED when no gait gets by with the power.
moray_status heading_search_gait(heading_job *job, const moray_gait *start, moray_steering_plan *best);

// What keeps the robot from following more closely, in one paragraph.
void heading_explain(const steer_job *job, char *text, size_t size);

extern const steer_program heading_steering;

#endif
