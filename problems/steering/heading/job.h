// SPDX-License-Identifier: MIT
#ifndef PROBLEMS_STEERING_HEADING_JOB_H
#define PROBLEMS_STEERING_HEADING_JOB_H

#include "steering/steer.h"

// How the robot is steered in a trial.
typedef enum {
    HEADING_FEEDBACK, // phi_0 = k (theta_ref - theta), perhaps of theta_ref ahead of its time
    HEADING_PLAN,     // a plan, blindly
    HEADING_BOTH,     // a plan, and k (theta_plan - theta)
    HEADING_RECEDING  // plans made anew from the measured state
} heading_law;

enum { HEADING_TRIALS = 10, HEADING_GAITS = 3 }; // gaits: the paper's, those of the two plans

// One way of steering, on both models.
typedef struct heading_trial {
    const char *name;
    heading_law law;
    int gait;          // swum
    moray_model plan;  // whose plan
    bool preview;      // the reference is known ahead
    double gain, lead; // [m/rad of the control-oriented model], [s]
    int evaluations;   // spent on tuning these
    bool run;
    moray_heading_score score[2]; // by the model swum on
    moray_receding_horizon_record record[2];
} heading_trial;

typedef struct heading_job {
    moray_common common; // model: of the last plan; with fp there is one on the control-oriented model before
    char reference_text[MORAY_PATH_SIZE];
    double horizon; // [s]; NaN: by the reference
    steer_input input;
    double weight_power, weight_steering;
    double max_error;
    int intervals_per_period, refinements;
    double replan_periods, look_ahead_periods;
    bool receding;
    int gait_evaluations, evaluations;
    // found along the way
    moray_reference reference;
    moray_straight_motion straight[HEADING_GAITS][2]; // by the model swum on
    moray_heading_plan averaged, plan[2];
    moray_certificate certificate[2];
    double turn_rate; // sustained at the limit of the offset, by the model of the last plan [rad/s]
    heading_trial trial[HEADING_TRIALS];
    int n_trials;
    // by the search for the gait of the first-principles plan
    int gaits_tried;
    double first_objective, best_objective; // on its coarse mesh
    moray_ticker ticker;
} heading_job;

static inline const moray_heading_plan *heading_last_plan(const heading_job *job)
{
    return &job->plan[job->common.model];
}

#define HEADING_AVERAGED_SCHEME "radau3"

// Plans: first the averaged and the control-oriented one, last the first-principles one. Error: MORAY_NOT_SOLVED saying
// what limits the robot, MORAY_INTERRUPTED, and those of moray_heading_plan_make.
moray_status heading_plan_first(heading_job *job);
moray_status heading_plan_last(heading_job *job);

// ---- Fig. 8 --------------------------------------------------------------------------------------------------------

// Whether the reference is the manoeuvre of Sec. V-C.
bool heading_is_fig8(const heading_job *job);

// Sets gait, reference, and the horizon unless it is given. Error: those of moray_straight_motion_find and
// moray_closed_loop_run.
moray_status heading_fig8_prepare(heading_job *job);

// The paper's offset at t [m or rad].
double heading_fig8_offset(const heading_job *job, moray_model model, double t);

// The offset that a plan found beside the paper's [m or rad].
typedef struct heading_fig8_match {
    double paper;                 // while it turns, there and, but for the sign, back
    double there, back, straight; // means found, without 3 s behind and before every edge
    double rms;                   // of the difference, over the whole horizon
} heading_fig8_match;
heading_fig8_match heading_fig8_compare(const heading_job *job, moray_model model);

// ---- Plans ---------------------------------------------------------------------------------------------------------

// Limits of the model, with the gait that is swum where `gait` is not NULL.
moray_heading_spec heading_spec(const heading_job *job, moray_model model, bool averaged);

// Of a solve on the averaged plant or the full one, whose undulation has that period.
moray_settings heading_settings(heading_job *job, bool averaged, double period);

// The gait whose first-principles plan has the least objective on a coarse mesh, within the limits of gait and
// straight-ahead power, from `start` on; its plan must be freed even after an error. Error: those of moray_search;
// MORAY_NOT_SOLVED when no gait gets by with the power.
moray_status heading_search_gait(heading_job *job, const moray_gait *start, moray_heading_plan *best);

// What keeps the robot from following more closely, in one paragraph.
void heading_explain(const heading_job *job, char *text, size_t size);

void heading_choose_trials(heading_job *job);

// Tunes and swims every trial not yet run whose gait and plan are known. Error: those of moray_closed_loop_run.
moray_status heading_run_trials(heading_job *job);

// Swims one of them again, to be drawn.
moray_status heading_swim(const heading_job *job, heading_trial *trial, moray_model model,
                          moray_closed_loop *closed_loop);

// Figures and trajectory.csv. Error: MORAY_IO, MORAY_MEMORY, those of moray_closed_loop_run.
moray_status heading_draw(heading_job *job);

moray_json *heading_json(const heading_job *job);

// Table or JSON on standard output, and the files of --out. Error: MORAY_IO, MORAY_MEMORY.
moray_status heading_report(heading_job *job);

#endif
