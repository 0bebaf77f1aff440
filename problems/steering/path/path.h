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
    moray_path planned; // the same, its corners as wide as a plan needs them
    double speed;       // straight ahead through the water, by the model of the last plan made [m/s]
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

// What of the path its certificate fails by, where it does, to be added to the reason.
void path_doubt(const steer_job *job, moray_model model, char *text, size_t size);

extern const steer_program path_steering;

#endif
