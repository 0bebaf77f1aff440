// SPDX-License-Identifier: MIT
#ifndef PROBLEMS_SIMULATE_SIMULATE_H
#define PROBLEMS_SIMULATE_SIMULATE_H

#include "degree.h"
#include "moray/moray.h"
#include "moray/snake.h"

typedef enum { SIMULATE_EXPLICIT, SIMULATE_TR_BDF2, SIMULATE_PAPER } simulate_integrator;

typedef struct simulate {
    moray_common common;
    moray_snake_options snake;
    moray_gait_input gait;
    char schedule_file[MORAY_PATH_SIZE], water_file[MORAY_PATH_SIZE]; // empty: none
    double duration, output_step, heading, position[2]; // duration NaN: 60 s after the last change of gait
    int periods;
    simulate_integrator integrator;
    double rtol, atol; // NaN: the integrator's own
    char log_file[MORAY_PATH_SIZE];
    double log_from, log_step;
    moray_swim_log_noise noise; // its seed from log_seed
    int log_seed;
} simulate;

// The stretch of time that means are taken over: the last whole periods of the last gait, or all of it.
typedef struct simulate_window {
    double from, to;
    int periods; // 0: not a whole number
} simulate_window;

typedef struct simulate_results {
    const simulate *run;
    moray_sim_settings sim;
    moray_water *water;          // NULL: the current is uniform
    moray_gait_change *schedule; // as far as the simulation goes
    int n_changes;
    double t1;
    moray_swimmer *swimmer; // at the end of the simulation
    moray_swim_track track; // at every output step and at the end
    moray_sim_statistics statistics;
    simulate_window window;
    double v_x, v_y, speed, course_speed, power, cost_of_transport, heading; // means over the window
    double current[2];                                                       // likewise [m/s]
    double peak_effort, peak_link_angle;                                     // in the window
    double peak_load; // of the motors, of what their supply allows, in the window; 0 without
    moray_budget budget;
    double peak_effort_of_run;
    moray_pose end;
    double energy;
} simulate_results;

// Simulates; the run must outlive the results. Error: MORAY_INPUT, MORAY_IO (schedule), MORAY_MEMORY, MORAY_NUMERIC.
moray_status simulate_run(const simulate *run, simulate_results *results);
void simulate_release(simulate_results *results); // safe on zeroed results

// Leaves a log of the first gait, from rest as the run itself. Error: MORAY_INPUT, MORAY_IO, MORAY_MEMORY,
// MORAY_NUMERIC.
moray_status simulate_log(const simulate *run, const simulate_results *results);

// Tables or JSON on standard output, and the files of --out. Error: MORAY_IO, MORAY_MEMORY.
moray_status simulate_report(const simulate_results *results);

// Of simulate_results: trajectory.csv; the figures. Error: MORAY_IO, MORAY_MEMORY; those of moray_output_figure.
moray_status simulate_trajectory(const void *results, moray_output *output);
moray_status simulate_figures(const void *results, moray_output *output);

extern const char *const simulate_integrators[];
const moray_gait *simulate_last_gait(const simulate_results *results);

#endif
