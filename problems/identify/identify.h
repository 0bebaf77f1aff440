// SPDX-License-Identifier: MIT
//
// The program identify: logs of a swimming robot to its coefficients.
#ifndef PROBLEMS_IDENTIFY_IDENTIFY_H
#define PROBLEMS_IDENTIFY_IDENTIFY_H

#include "degree.h"
#include "moray/moray.h"
#include "moray/snake.h"

enum { LOGS = MORAY_IDENTIFY_RUNS, MOST_STARTS = 100, LIST_SIZE = 1000 };

// The run of a log that nothing was estimated from: where it starts is fitted to its first part, the rest is predicted.
typedef struct held_out {
    double seconds;             // of the first part
    double rms[MORAY_CHANNELS]; // of observed less predicted in the rest [m, m, rad, N m]; NAN: not measured
    double sigma[MORAY_CHANNELS];
    double measured, predicted; // mean speed over ground in the rest [m/s]; NAN without a position
} held_out;

typedef struct identify {
    moray_common common;
    moray_snake_options snake;
    char logs[MORAY_PATH_SIZE], validate[MORAY_PATH_SIZE];
    char estimate[LIST_SIZE], bounds[LIST_SIZE], columns[LIST_SIZE], units[LIST_SIZE];
    bool reference, rest;
    int joints;                       // a moray_logged_joints
    double torque_constant;           // [N m/A]
    double position, heading, torque; // standard deviations [m, rad, N m]; NAN: as the logs scatter
    int loss;                         // least squares, or Huber's
    double huber, step;
    int starts, jobs, axes; // axes: of scenarios
    bool design;
    int criterion, evaluations;
    double alpha[2], omega[2], delta[2], phi_0[2], rate, duration; // limits of the experiment

    moray_ticker ticker;
    int unknown[MORAY_MOST_UNKNOWNS], n;
    double lower[MORAY_MOST_UNKNOWNS], upper[MORAY_MOST_UNKNOWNS];
    moray_swim_log log[LOGS], held[LOGS];
    int n_logs, n_held;
    moray_identify *fitted;
    moray_estimate at[MOST_STARTS]; // the best first
    int best_starts;                // that came to the best
    moray_unknowns world;
    moray_information info;
    double inflation; // of standard errors: residuals are larger than told
    moray_identify_fit fit;
    held_out validation[LOGS];
    moray_gait next; // the experiment to swim next, and what is known with it
    moray_information after;
} identify;

enum { D_OPTIMAL, E_OPTIMAL };

enum { LOSS_SQUARES, LOSS_HUBER };

// What to estimate, with its bounds, from the texts of the user. Error: MORAY_INPUT.
moray_status identify_choose(identify *run);

// The specification as the options have it.
moray_identify_spec identify_spec(const identify *run);

// Reads, searches, examines, validates. Error: those of the library.
moray_status identify_run(identify *run);
void identify_release(identify *run);

// The k-th held-out log against its prediction.
moray_status identify_validate(const identify *run, int k, held_out *found);

// Tables or JSON on standard output, and the files of --out. Error: MORAY_IO, MORAY_MEMORY.
moray_status identify_report(const identify *run);
void identify_summary(const void *run, moray_json *json);
moray_status identify_write(const void *run, moray_output *output);
moray_status identify_draw(const void *run, moray_output *output);

// Angles are shown in deg: the unit of an unknown, and what it takes to come from SI.
const char *identify_unit(int unknown, double *scale);
double identify_half_width(const identify *run, const moray_information *info, int k); // of the interval of 95 %

// A residual is noise, or the model is too simple.
bool identify_certified(const identify *run);

#endif
