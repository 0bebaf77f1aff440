// SPDX-License-Identifier: MIT
#ifndef PROBLEMS_STEERING_PATH_JOB_H
#define PROBLEMS_STEERING_PATH_JOB_H

#include "steering/steer.h"

// How the robot is steered in a trial.
typedef enum {
    PATH_SIGHT,   // line of sight, perhaps with integral action
    PATH_PLAN,    // a plan, blindly
    PATH_BOTH,    // a plan, and line of sight towards it
    PATH_RECEDING // plans made anew from the measured state
} path_law;

enum { PATH_TRIALS = 9, PATH_GAITS = 3 }; // gaits: the paper's, those of the two plans

// One way of steering, on both models.
typedef struct path_trial {
    const char *name;
    path_law law;
    bool integral;             // line of sight with integral action
    int gait;                  // swum
    moray_model plan;          // whose plan
    double gain;               // [m/rad of the control-oriented model]
    double lookahead, ahead;   // [m]
    double integral_gain;      // [m/s]
    int evaluations;           // spent on tuning these
    moray_path_score score[2]; // by the model swum on
    double cost[2];            // as in the objective of the plans, the steering aside
    moray_receding_horizon_record record[2];
} path_trial;

typedef struct path_job {
    moray_common common; // model: of the last plan; with fp there is one on the control-oriented model before
    char path_text[MORAY_PATH_SIZE];
    double radius;   // of the corners [m]
    double start[2]; // position [m]
    double heading;  // there; NaN: the course of the path where it begins [rad]
    steer_input input;
    double weight_time, weight_steering;
    double tube, reach; // [m]
    int intervals_per_period, refinements;
    double replan_periods, look_ahead_periods;
    bool receding, find_gait;
    int evaluations;
    // found along the way
    moray_path path;
    moray_straight_motion straight[PATH_GAITS][2]; // by the model swum on
    moray_path_plan averaged, plan[2];
    moray_certificate certificate[2];
    double speed;     // straight ahead through the water, by the model of the last plan made [m/s]
    double turn_rate; // sustained at the limit of the offset, likewise [rad/s]
    path_trial trial[PATH_TRIALS];
    int n_trials;
    moray_ticker ticker;
} path_job;

static inline const moray_path_plan *path_last_plan(const path_job *job)
{
    return &job->plan[job->common.model];
}

// Plans: averaged, control-oriented, and with the first-principles model first-principles. Error: MORAY_NOT_SOLVED
// saying what limits the robot, MORAY_INTERRUPTED, and those of moray_path_plan_make.
moray_status path_make_plans(path_job *job);

// Limits of the model, with the gait that is swum where it is not averaged.
moray_path_spec path_spec(const path_job *job, moray_model model, bool averaged);

// The turning that a corner asks for, at the speed over ground of the robot there [rad/s]; 0 on a leg.
double path_turning(const path_job *job, const moray_path_piece *piece);

// What keeps the robot from following more closely, in one paragraph.
void path_explain(const path_job *job, char *text, size_t size);

// Heading less course that the current asks for on a leg, by the triangle of velocities; and the mean of it over the
// middle of the leg in the last plan [rad].
void path_crab(const path_job *job, const moray_path_piece *leg, double *asked, double *planned);

// Tunes and swims every trial. Error: those of moray_closed_loop_run.
moray_status path_run_trials(path_job *job);

// How many times faster plans are made than the robot swims through them.
double path_real_time(const path_job *job, const path_trial *trial, const moray_receding_horizon_record *record);

// Swims one of them again, to be drawn.
moray_status path_swim(const path_job *job, path_trial *trial, moray_model model, moray_closed_loop *closed_loop);

moray_json *path_json(const path_job *job);

// Table or JSON on standard output, and the files of --out. Error: MORAY_IO, MORAY_MEMORY.
moray_status path_report(path_job *job);

#endif
