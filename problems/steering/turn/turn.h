// SPDX-License-Identifier: MIT
#ifndef PROBLEMS_STEERING_TURN_TURN_H
#define PROBLEMS_STEERING_TURN_TURN_H

#include "steering/steer.h"

typedef struct turn_job {
    steer_job steer;
    double angle;        // change of the heading [rad]
    double end[2], band; // [m]; [rad]
    moray_turn_plan averaged, plan[2];
} turn_job;

static inline bool turn_to_position(const turn_job *job)
{
    return !isnan(job->end[0]);
}

// Plans: averaged, control-oriented, and with the first-principles model first-principles. Error: MORAY_NOT_SOLVED
// saying what limits the robot, and those of moray_turn_plan_make.
moray_status turn_make_plans(turn_job *job);

// ---- Laws ----------------------------------------------------------------------------------------------------------

enum { TURN_BANG, TURN_BRAKE, TURN_PLAN, TURN_BOTH, TURN_LAWS };
enum { TURN_HOLD, TURN_BRAKING, TURN_GAIN, TURN_NUMBERS };
extern const steer_law turn_laws[TURN_LAWS];
extern const steer_number turn_numbers[TURN_NUMBERS];

// Of the heading without its undulation: from when on it stays within the band around where it is to be (NaN: it does
// not) [s]; the integral of how far it is outside, or 1 where that is more, over the band [s]; how far off it is over
// the last period [rad]; how near the robot came to the end position [m]; mean joint power [W].
enum { TURN_SETTLED, TURN_WEIGHTED, TURN_FINAL, TURN_MISS, TURN_POWER, TURN_SCORES };

void turn_choose_trials(turn_job *job);
void turn_start(steer_steersman *steersman, moray_closed_loop_spec *spec);
double turn_judge(const steer_trial *trial, const steer_steersman *steersman, const moray_closed_loop *closed_loop,
                  double *score);

// ---- Report: of a steer_program ------------------------------------------------------------------------------------

extern const steer_score turn_scores[TURN_SCORES];
enum { TURN_COLUMNS = 8 };
extern const steer_column turn_columns[TURN_COLUMNS];
void turn_tables(const steer_job *job, steer_tables *tables);
void turn_headline(const steer_job *job, FILE *file);
void turn_conclude(const steer_job *job, char *text, size_t size);
void turn_explain(const steer_job *job, char *text, size_t size);
void turn_json_head(const steer_job *job, moray_json *json);
void turn_json_plan(const steer_job *job, moray_json *json, moray_model model);
bool turn_values(const steer_job *job, const steer_trial *trial, const moray_swim_track *track, double *values);

#endif
