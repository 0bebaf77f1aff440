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
    moray_heading_plan averaged, plan[2];
    // by the search for the gait of the first-principles plan
    int gaits_tried;
    double first_objective, best_objective; // on its coarse mesh
} heading_job;

// ---- Fig. 8 --------------------------------------------------------------------------------------------------------

// Whether the reference is the manoeuvre of Sec. V-C.
bool heading_is_fig8(const heading_job *job);

// Sets gait, reference, and the horizon unless it is given. Error: those of moray_straight_motion_find and
// moray_closed_loop_run.
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
moray_status heading_search_gait(heading_job *job, const moray_gait *start, moray_heading_plan *best);

// What keeps the robot from following more closely, in one paragraph.
void heading_explain(const steer_job *job, char *text, size_t size);

// ---- Laws ----------------------------------------------------------------------------------------------------------

// phi_0 = k (theta_ref - theta), or of theta_ref ahead of its time; a plan, blindly, and with k (theta_plan - theta);
// plans made anew from the measured state, without knowing the reference ahead too.
enum { HEADING_FEEDBACK, HEADING_AHEAD, HEADING_PLAN, HEADING_BOTH, HEADING_RECEDING, HEADING_UNKNOWING, HEADING_LAWS };
enum { HEADING_GAIN, HEADING_LEAD, HEADING_NUMBERS };
extern const steer_law heading_laws[HEADING_LAWS];
extern const steer_number heading_numbers[HEADING_NUMBERS];

// As of moray_heading_score.
enum { HEADING_RMS, HEADING_FINAL, HEADING_LARGEST, HEADING_POWER, HEADING_SCORES };

void heading_choose_trials(steer_job *job);
void heading_start(steer_steersman *steersman, moray_closed_loop_spec *spec);
double heading_judge(const steer_trial *trial, const steer_steersman *steersman, const moray_closed_loop *closed_loop,
                     double *score);

// ---- Report: of a steer_program ------------------------------------------------------------------------------------

extern const steer_score heading_scores[HEADING_SCORES];
extern const steer_column heading_columns[];
void heading_tables(const steer_job *job, steer_tables *tables);
void heading_headline(const steer_job *job, FILE *file);
void heading_conclude(const steer_job *job, char *text, size_t size);
void heading_notes(const steer_job *job, FILE *file);
double heading_swum(const steer_job *job, const steer_trial *trial);
void heading_json_head(const steer_job *job, moray_json *json);
void heading_json_plan(const steer_job *job, moray_json *json, moray_model model);
void heading_json_tail(const steer_job *job, moray_json *json);
bool heading_values(const steer_job *job, const steer_trial *trial, const moray_swim_track *track, double *values);
moray_status heading_draw(const steer_job *job);

#endif
