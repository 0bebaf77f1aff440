// SPDX-License-Identifier: MIT
//
// A gait and a law of steering on their way to a robot: what they are, and the files that tell them to a controller.
#ifndef PROBLEMS_EXPORT_EXPORT_H
#define PROBLEMS_EXPORT_EXPORT_H

#include <stdio.h>

#include "degree.h"
#include "moray/moray.h"
#include "moray/snake.h"

typedef enum { EXPORT_NONE, EXPORT_HEADING, EXPORT_PATH, EXPORT_PLAN } export_law;

enum { EXPORT_NAME = 32 };

// As given; NaN (of a law, -1): from the run, or by default.
typedef struct export_job {
    moray_common common;
    moray_snake_options snake;
    moray_gait_input gait;
    char from[MORAY_PATH_SIZE]; // folder of a run; empty: none
    char name[EXPORT_NAME];     // what names in the header begin with
    double rate;                // of the tables [1/s]
    int ramp;                   // periods from the straight body to the gait
    int law;                    // an export_law
    int trial;                  // of the run, counted from 1; 0: its best
    moray_heading_gains gains;
    double lookahead, ahead, sight_integral; // [m], [m], [m/s]
    double look, smoothing;                  // [s]
    double offset, offset_rate;              // limits, of the control-oriented model [m], [m/s]
    char path_text[MORAY_PATH_SIZE], plan_file[MORAY_PATH_SIZE];
    double radius;
} export_job;

// What is exported: revolute joints, angles in rad. Must stay where it is.
typedef struct export_found {
    const export_job *job;
    moray_json_file *run; // summary of the run, or NULL
    moray_gait gait;
    moray_series wave; // the gait and its series, about its own offset
    double *wave_at;   // what the wave and the gait's series refer to, one behind the other
    moray_series own;
    double period, step; // of the gait; of the tables [s]
    double peak_angle, peak_rate, peak_acceleration;
    export_law law;
    moray_straight_motion straight; // of a gait that is steered
    double scale;                   // offsets of the robot per offset of the control-oriented model [rad/m]
    moray_heading_gains gains;      // [m/rad] and so on, as of the control-oriented model
    double lookahead, ahead, sight_integral;
    double offset, offset_rate; // limits [rad], [rad/s]
    moray_path path;
    int n_plan;
    double *plan; // [n_plan][2], every `look` from 0 on: offset, heading without its undulation [rad]
} export_found;

// Error: MORAY_INPUT, MORAY_IO, MORAY_MEMORY, MORAY_NUMERIC. Free in any case.
moray_status export_gather(export_found *found, const export_job *job);
void export_release(export_found *found);

// The part of it that is the law. Error: as above.
moray_status export_gather_law(export_found *found);

// Amplitude of the ramp-in at t, with its first two derivatives: from 0 to 1 within `length`, smooth to the second.
void export_ramp(double t, double length, double ramp[3]);

// A period of the gait (gait.csv) and the way there (ramp.csv). Error: MORAY_IO, MORAY_MEMORY.
moray_status export_tables(const export_found *found, moray_output *output);

// NAME.h. Error: MORAY_IO, MORAY_MEMORY.
moray_status export_header(const export_found *found, moray_output *output);

// NAME.urdf and NAME.xml of MuJoCo. Error: MORAY_IO, MORAY_MEMORY.
moray_status export_robot(const export_found *found, moray_output *output);

// The command line in one line, without what only shows results.
void export_command(const export_job *job, char *text, size_t size);

// Table or JSON on standard output, and the files of --out. Error: MORAY_IO, MORAY_MEMORY.
moray_status export_report(const export_found *found);

extern const moray_program export_program;
export_job export_defaults(void);

#endif
