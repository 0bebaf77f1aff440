// SPDX-License-Identifier: MIT
//
// How the fastest gait moves with what it was optimised for: robot, current, limits.
#ifndef PROBLEMS_GAIT_SENSITIVITY_SENSITIVITY_H
#define PROBLEMS_GAIT_SENSITIVITY_SENSITIVITY_H

#include "gait/job/job.h"

// What moves. theta_max, omega, delta in deg and deg/s; phi_0 in cm (control-oriented model) or deg.
enum {
    SLOPE_SPEED, // along the course [m/s]
    SLOPE_POWER, // [W]
    SLOPE_THETA_MAX,
    SLOPE_OMEGA,
    SLOPE_DELTA,
    SLOPE_OFFSET,
    SLOPE_TAPER,
    SLOPES
};
extern const char *const sensitivity_names[SLOPES];
const char *sensitivity_unit(const gait_job *job, int quantity);

// The job and its last stage with a parameter displaced.
typedef struct variant {
    gait_job job;
    stage at;
} variant;

// One parameter, derivatives by it in its own unit.
typedef struct sensitivity_row {
    char name[40];
    const char *unit;
    double value;         // in the unit
    double scale, step;   // [unit] what it is measured by; of the differences
    bool current;         // which is measured by the speed
    double slope[SLOPES]; // from the KKT system
    double again[SLOPES]; // from solving again at both sides; NaN where that fails
    double swum[2];       // first-principles speed and power of the gaits that the slopes predict, by simulation
    double deviation;     // largest |slope - again| scale / size of the quantity
    moray_active_change up, down; // steps in the unit
    bool unsteady;                // the active set changes within the differences
} sensitivity_row;

enum { SENSITIVITY_ROWS = 32, SENSITIVITY_GAITS = 3, SENSITIVITY_LIST = 1000 };

// The gait kept, predicted, and solved again, in another current.
typedef struct sensitivity_forecast {
    bool asked;
    double current[2];
    moray_gait_prediction prediction[SENSITIVITY_GAITS]; // that kept predicts nothing
    moray_gait_trial trial[SENSITIVITY_GAITS];
    moray_active_change change; // step as a share of the way
    bool solved;                // again
    moray_status why;           // there is no prediction
} sensitivity_forecast;

typedef struct sensitivity {
    gait_job job;                     // first, for its options
    double predicted[2];              // current
    double size[SLOPES];              // of what moves
    char weak[SENSITIVITY_LIST];      // constraints that may be active or not
    char unreached[SENSITIVITY_LIST]; // limits that nothing depends on
    char left_out[SENSITIVITY_LIST];  // parameters that cannot be displaced, and why
    sensitivity_row row[SENSITIVITY_ROWS];
    int rows;
    sensitivity_forecast forecast;
} sensitivity;

// ---- Parameters ----------------------------------------------------------------------------------------------------

typedef struct sensitivity_parameter sensitivity_parameter;

// The k-th of all parameters; NULL after the last.
const sensitivity_parameter *sensitivity_parameter_at(int k);

// Whether it is one of all links alike, where the job's have lengths of their own.
bool sensitivity_parameter_of_each(const sensitivity_parameter *parameter, const gait_job *job);

// Whether the job has it: not such a one, not that of the other model, a limit that is not set, or one that is 0.
bool sensitivity_parameter_applies(const sensitivity_parameter *parameter, const gait_job *job);

// Name, unit, value and scale of a row; speed [m/s] is what a current is measured by.
void sensitivity_parameter_describe(const sensitivity_parameter *parameter, const gait_job *job, double speed,
                                    sensitivity_row *row);
bool sensitivity_parameter_is_limit(const sensitivity_parameter *parameter);

// The job's last stage with the parameter moved by a step in its unit; nothing in it is owned.
void sensitivity_displace(const sensitivity_parameter *parameter, const gait_job *job, double step, variant *moved);

// ---- The work ------------------------------------------------------------------------------------------------------

void sensitivity_values(const gait_job *job, const moray_gait *gait, double speed, double power, double value[SLOPES]);

// A solution of a problem like the job's, tightly, from another. Error: those of moray_solve; MORAY_INTERRUPTED.
moray_status sensitivity_solve(sensitivity *run, const moray_gait_problem *problem, const moray_solution *from,
                               moray_solution **solution);
bool sensitivity_solved(const moray_solution *solution);

// All, of the job's last stage, which is solved. Error: as above, and those of moray_sensitivity_new,
// moray_sensitivity_by, moray_gait_problem_new.
moray_status sensitivity_run(sensitivity *run);

// The gait for another current. Error: as above, and those of moray_gait_trial_run.
moray_status sensitivity_predict(sensitivity *run, moray_sensitivity *slopes);

// ---- The report ----------------------------------------------------------------------------------------------------

enum {
    SENSITIVITY_TEXT = 6000,
    SENSITIVITY_LABEL = 80,
    SENSITIVITY_LINES = 3 * SENSITIVITY_ROWS,
    SENSITIVITY_TABLES = 4
};

// What a report consists of.
typedef struct sensitivity_findings {
    char text[SENSITIVITY_TEXT];
    int tables;
    moray_table table[SENSITIVITY_TABLES];
    char title[SENSITIVITY_TABLES][200];
    moray_table_row row[SENSITIVITY_TABLES][SENSITIVITY_LINES];
    char label[SENSITIVITY_TABLES][SENSITIVITY_LINES][SENSITIVITY_LABEL];
} sensitivity_findings;

void sensitivity_tables(const sensitivity *run, sensitivity_findings *found);

// Change of the speed or power as swum on the first-principles model, as a share of what it is there, by the
// parameter's share.
double sensitivity_swum_share(const sensitivity *run, const sensitivity_row *row, int quantity);

// Quantities that may move: the taper only where it is free.
int sensitivity_quantities(const sensitivity *run);

// Table or JSON on standard output, and the files of --out. Error: MORAY_IO, MORAY_MEMORY.
moray_status sensitivity_report(gait_job *job);

#endif
