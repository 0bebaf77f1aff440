// SPDX-License-Identifier: MIT
#ifndef PROBLEMS_STEERING_PATH_PATH_H
#define PROBLEMS_STEERING_PATH_PATH_H

#include "steering/steer.h"

typedef struct path_job {
    steer_job steer;
    char path_text[MORAY_PATH_SIZE];
    double radius;   // of the corners [m]
    double start[2]; // position [m]
    double heading;  // there; NaN: the course of the path where it begins [rad]
    double weight_time;
    double tube, reach; // [m]
    bool find_gait;
    // found along the way
    moray_path path;
    moray_path_plan averaged, plan[2];
    double speed; // straight ahead through the water, by the model of the last plan made [m/s]
} path_job;

// Plans: averaged, control-oriented, and with the first-principles model first-principles. Error: MORAY_NOT_SOLVED
// saying what limits the robot, MORAY_INTERRUPTED, and those of moray_path_plan_make.
moray_status path_make_plans(path_job *job);

moray_path_spec path_spec(const path_job *job, moray_model model, bool averaged);

// The turning that a corner asks for, at the speed over ground of the robot there [rad/s]; 0 on a leg.
double path_turning(const path_job *job, const moray_path_piece *piece);

// Heading less course that the current asks for on a leg, by the triangle of velocities; and the mean of it over the
// middle of the leg in the last plan [rad].
void path_crab(const path_job *job, const moray_path_piece *leg, double *asked, double *planned);

// What keeps the robot from following more closely, in one paragraph.
void path_explain(const steer_job *job, char *text, size_t size);

// ---- Laws ----------------------------------------------------------------------------------------------------------

enum { PATH_LOS, PATH_ILOS, PATH_PLAN, PATH_BOTH, PATH_RECEDING, PATH_LAWS };
enum { PATH_GAIN, PATH_LOOKAHEAD, PATH_AHEAD, PATH_INTEGRAL, PATH_NUMBERS };
extern const steer_law path_laws[PATH_LAWS];
extern const steer_number path_numbers[PATH_NUMBERS];

// As of moray_path_score; and as in the objective of the plans, the steering aside.
enum { PATH_RMS, PATH_SETTLED_RMS, PATH_SETTLED_LARGEST, PATH_TIME, PATH_POWER, PATH_COST, PATH_SCORES };

void path_choose_trials(steer_job *job);
void path_start(steer_steersman *steersman, moray_closed_loop_spec *spec);
double path_judge(const steer_trial *trial, const steer_steersman *steersman, const moray_closed_loop *closed_loop,
                  double *score);
double path_swum(const steer_job *job, const steer_trial *trial);

// ---- Report: of a steer_program ------------------------------------------------------------------------------------

extern const steer_score path_scores[PATH_SCORES];
extern const steer_column path_columns[];
void path_tables(const steer_job *job, steer_tables *tables);
void path_headline(const steer_job *job, FILE *file);
void path_conclude(const steer_job *job, char *text, size_t size);
void path_json_head(const steer_job *job, moray_json *json);
void path_json_plan(const steer_job *job, moray_json *json, moray_model model);
void path_json_tail(const steer_job *job, moray_json *json);
bool path_values(const steer_job *job, const steer_trial *trial, const moray_swim_track *track, double *values);
void path_points(const steer_job *job, double x[STEER_POINTS], double y[STEER_POINTS]);

#endif
