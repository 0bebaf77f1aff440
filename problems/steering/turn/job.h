// SPDX-License-Identifier: MIT
#ifndef PROBLEMS_STEERING_TURN_JOB_H
#define PROBLEMS_STEERING_TURN_JOB_H

#include "steering/steer.h"

// How the robot is steered in a trial.
typedef enum {
    TURN_BANG,  // offset at its limit for a while
    TURN_BRAKE, // the same, and then at the other limit for a while
    TURN_PLAN,  // a plan, blindly
    TURN_BOTH   // a plan, and k (theta_plan - theta)
} turn_law;

enum { TURN_TRIALS = 6 };

// Of the heading without its undulation: from when on it stays within the band around where it is to be (NaN: it does
// not) [s]; the integral of how far it is outside, or 1 where that is more, over the band [s]; how far off it is over
// the last period [rad]; how near the robot came to the end position [m]; mean joint power [W].
typedef struct turn_score {
    double settled, unsettled, final, miss, power;
} turn_score;

typedef struct turn_trial {
    const char *name;
    turn_law law;
    moray_model plan;    // whose
    double hold, brake;  // [s]
    double gain;         // [m/rad of the control-oriented model]
    int evaluations;     // spent on tuning these
    turn_score score[2]; // by the model swum on
} turn_trial;

typedef struct turn_job {
    moray_common common; // model: of the last plan; with fp there is one on the control-oriented model before
    double angle;        // change of the heading [rad]
    bool to_position;    // to `end`
    double end[2];       // [m]
    steer_input input;
    double weight_steering, band; // [rad]
    int intervals_per_period, refinements, evaluations;
    // found along the way
    moray_straight_motion straight[2]; // by the model swum on
    moray_turn_plan averaged, plan[2];
    moray_certificate certificate[2];
    double turn_rate[2]; // sustained at the limit of the offset [rad/s], with its sign
    turn_trial trial[TURN_TRIALS];
    int n_trials;
    moray_ticker ticker;
} turn_job;

static inline const moray_turn_plan *turn_last_plan(const turn_job *job)
{
    return &job->plan[job->common.model];
}

double turn_duration(const moray_turn_plan *plan);
moray_steering_limits turn_limits(const turn_job *job, moray_model model);

// Plans: averaged, control-oriented, and with the first-principles model first-principles. Error: MORAY_NOT_SOLVED
// saying what limits the robot, and those of moray_turn_plan_make.
moray_status turn_make_plans(turn_job *job);

// What keeps the robot from turning faster, in one paragraph.
void turn_explain(const turn_job *job, char *text, size_t size);

// Tunes and swims every trial. Error: those of moray_closed_loop_run.
moray_status turn_run_trials(turn_job *job);

// Swims one of them again, to be drawn.
moray_status turn_swim(const turn_job *job, const turn_trial *trial, moray_model model, moray_closed_loop *closed_loop);

// Table or JSON on standard output, and the files of --out. Error: MORAY_IO, MORAY_MEMORY.
moray_status turn_report(turn_job *job);

#endif
