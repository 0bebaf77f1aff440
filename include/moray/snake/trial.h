// SPDX-License-Identifier: MIT
//
// A gait swum on both models, and two gaits compared fairly: on the first-principles model, at equal power.
#ifndef MORAY_SNAKE_TRIAL_H
#define MORAY_SNAKE_TRIAL_H

#include "moray/export.h"
#include "moray/ocp.h"
#include "moray/snake/model.h"
#include "moray/app/results.h"
#include "moray/snake/swim.h"

MORAY_BEGIN

// Where and with what gaits are tried; the swimmers are owned, one of each model.
typedef struct moray_test_rig {
    moray_swimmer *swimmer[2]; // by moray_model
    double current[2];         // [m/s]
    double course;             // [rad]
    moray_swim_settings settings;
} moray_test_rig;

// Error: MORAY_INPUT (robot), MORAY_MEMORY. Free with moray_test_rig_free.
MORAY_API moray_status moray_test_rig_new(moray_test_rig *rig, const moray_robot *robot, const double current[2],
                                          double course);
MORAY_API void moray_test_rig_free(moray_test_rig *rig);
MORAY_API moray_swim_setup moray_test_rig_setup(const moray_test_rig *rig, moray_model model);

// One gait, mapped to each model and swum from rest to steady state, holding the course. Where the course cannot be
// held `held` is false with the reason in `why`, and the gait swims straight from a start heading along the course
// instead.
typedef struct moray_gait_trial {
    moray_gait gait[2]; // by moray_model
    moray_steady steady[2];
    bool held[2];
    moray_status why[2];
} moray_gait_trial;

// Tries the gait of `model` on both. Error: MORAY_INPUT (a series); those of moray_swim_steady.
MORAY_API moray_status moray_gait_trial_run(const moray_test_rig *rig, const moray_gait *gait, moray_model model,
                                            moray_gait_trial *trial);

// The part of it of one model, with trial->gait[model] as given, which may have a series. Error: as above.
MORAY_API moray_status moray_gait_trial_swim(const moray_test_rig *rig, moray_model model, moray_gait_trial *trial);

// Speed along the course from rest under the trial's gait on one model, at n times equally spaced over [0, horizon]:
// mean over the period before (from rest on while the first period lasts). time[n], speed[n]. Error: those of
// moray_swim_run.
MORAY_API moray_status moray_gait_trial_speeds(const moray_test_rig *rig, const moray_gait_trial *trial,
                                               moray_model model, double horizon, int n, double *time, double *speed);

// The paper's gait for N links, theta_max 20 deg, omega 120 deg/s, delta = 2 pi/(N-1), 40 deg for its 10 (Assumption 2,
// Sec. V), as a gait of the control-oriented model.
MORAY_API moray_gait moray_gait_paper(const moray_robot *robot);

// Limits of delta that follow the robot, by the paper's gait: 15 to 90 deg for its 10 links, wider for shorter and
// longer robots, not below 1 deg and not near 180 deg, where (33) has no amplitude.
MORAY_API moray_bounds moray_gait_usual_delta(const moray_robot *robot);

// First-principles model: by how much the trial's gait beats the baseline's at the baseline's power (omega rescaled),
// and how much less power it needs at the baseline's speed. NaN where no omega does it, with the reason.
typedef struct moray_gait_gain {
    double speed_percent_at_equal_power, power_percent_at_equal_speed;
    double omega_at_equal_power, omega_at_equal_speed; // [rad/s]
    moray_status why_no_speed, why_no_power;
} moray_gait_gain;
MORAY_API moray_gait_gain moray_gait_gain_over(const moray_test_rig *rig, const moray_gait_trial *trial,
                                               const moray_gait_trial *baseline);

// The blocks of design.md's schema: gait; and speed_m_s to max_link_angle_deg of one model (key validated or
// predicted), with where power is counted and what it all costs where the robot has motors, a constant load or a
// battery.
MORAY_API void moray_gait_to_json(moray_json *json, const char *key, const moray_robot *robot,
                                  const moray_gait gait[2]);
MORAY_API void moray_steady_to_json(moray_json *json, const char *key, const moray_robot *robot, moray_model model,
                                    const moray_gait_trial *trial, double course);

// Rows of a table of trials, in columns: (trial 0, trial 1, ...) of the gait, or of one model's results. Fills
// rows[0..], returns how many (at most MORAY_TRIAL_ROWS).
enum { MORAY_TRIAL_ROWS = 12 };
MORAY_API int moray_gait_rows(const moray_robot *robot, const moray_gait_trial *const *trials, int n,
                              moray_table_row *rows);
MORAY_API int moray_steady_rows(const moray_robot *robot, moray_model model, const moray_gait_trial *const *trials,
                                int n, double course, moray_table_row *rows);

MORAY_END

#endif
