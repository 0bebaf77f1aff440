// SPDX-License-Identifier: MIT
//
// How the fastest gait moves with what it was optimised for: robot, current, limits.
#ifndef PARTS_SENSITIVITY_H
#define PARTS_SENSITIVITY_H

#include "gait_job.h"

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
    double value;              // in the unit
    double scale, step;        // [unit] what it is measured by; of the differences
    double slope[SLOPES];      // from the KKT system
    double again[SLOPES];      // from solving again at both sides; NaN where that fails
    double swum[2];            // first-principles speed and power of the gaits that the slopes promise, by simulation
    double deviation;          // largest |slope - again| scale / size of the quantity
    moray_active_change up, down; // steps in the unit
    bool unsteady;             // the active set changes within the differences
} sensitivity_row;

enum { SENSITIVITY_ROWS = 32, SENSITIVITY_GAITS = 3 };

// The gait kept, predicted, and solved again, in another current.
typedef struct sensitivity_forecast {
    bool asked;
    double current[2];
    moray_gait_promise promise[SENSITIVITY_GAITS]; // that kept promises nothing
    moray_gait_trial trial[SENSITIVITY_GAITS];
    moray_active_change change; // step as a share of the way
    double kkt;                 // error of the prediction as an optimum
    bool solved;                // again
} sensitivity_forecast;

typedef struct sensitivity {
    gait_job job;         // first, for its options
    double predicted[2];  // current
    double size[SLOPES];  // of what moves
    char weak[400];       // constraints that may be active or not
    char unreached[400];  // limits that nothing depends on
    sensitivity_row row[SENSITIVITY_ROWS];
    int rows;
    sensitivity_forecast forecast;
} sensitivity;

// ---- Parameters ----------------------------------------------------------------------------------------------------

typedef struct sensitivity_parameter sensitivity_parameter;

// The k-th of all parameters; NULL after the last.
const sensitivity_parameter *sensitivity_parameter_at(int k);

// Whether the job has it: not that of the other model, a limit that is not set, or one that is 0.
bool sensitivity_parameter_applies(const sensitivity_parameter *parameter, const gait_job *job);

// Name, unit, value and scale of a row; speed [m/s] is what a current is measured by.
void sensitivity_parameter_describe(const sensitivity_parameter *parameter, const gait_job *job, double speed,
                                    sensitivity_row *row);
bool sensitivity_parameter_is_limit(const sensitivity_parameter *parameter);

// The job's last stage with the parameter moved by a step in its unit; nothing in it is owned.
void sensitivity_displace(const sensitivity_parameter *parameter, const gait_job *job, double step, variant *moved);

// ---- The work ------------------------------------------------------------------------------------------------------

void sensitivity_values(const gait_job *job, const moray_gait *gait, double speed, double power, double value[SLOPES]);

// Of the job's last stage, solved and certified. Error: those of moray_sensitivity_new, moray_sensitivity_by,
// moray_gait_problem_new; MORAY_INTERRUPTED.
moray_status sensitivity_run(sensitivity *run);

// The gait for another current. Error: as above, and those of moray_gait_trial_run.
moray_status sensitivity_predict(sensitivity *run, moray_sensitivity *slopes);

moray_status sensitivity_report(gait_job *job);

#endif
