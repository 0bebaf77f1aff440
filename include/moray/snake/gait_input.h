// SPDX-License-Identifier: MIT
//
// Gaits and schedules of gaits as users write them: options, INI keys, columns of a file.
#ifndef MORAY_SNAKE_GAIT_INPUT_H
#define MORAY_SNAKE_GAIT_INPUT_H

#include <math.h>

#include "moray/export.h"
#include "moray/app/options.h"
#include "moray/snake/swim.h"

MORAY_BEGIN

// A gait by whichever parameters were given; NaN stands for one that was not. SI units, angles in rad.
typedef struct moray_gait_input {
    double theta_max;    // amplitude of (24)
    double a, alpha;     // amplitude of (25) in the control-oriented [m] and in the first-principles model
    double omega, delta; // always given
    double phi0_m, phi0; // offset of (25), likewise
    double taper;        // always given
} moray_gait_input;

// omega 120 deg/s, delta 40 deg (Sec. V), no taper; amplitude and offset not given.
MORAY_API moray_gait_input moray_gait_input_default(void);

// Rows of a table of options for the moray_gait_input at `field` of the settings.
#define MORAY_GAIT_OPTION(settings, place, name, low, high, in, text)                                                  \
    MORAY_ROW(REAL, settings, place, "gait", name, .min = low, .max = high, .unit = in, .help = text)
#define MORAY_GAIT_OPTIONS(settings, field)                                                                            \
    MORAY_GAIT_OPTION(settings, field.theta_max, "theta_max_deg", 0, 89, "deg",                                        \
                      "link-angle amplitude of (24); 20 unless an amplitude is given"),                                \
        MORAY_GAIT_OPTION(settings, field.a, "a_m", 0, INFINITY, "m",                                                  \
                          "instead of theta_max: joint amplitude of the control-oriented model"),                      \
        MORAY_GAIT_OPTION(settings, field.alpha, "alpha_deg", 0, 180, "deg",                                           \
                          "instead of theta_max: joint amplitude of the first-principles model"),                      \
        MORAY_GAIT_OPTION(settings, field.omega, "omega_deg_s", 0, 3600, "deg/s", "gait frequency"),                   \
        MORAY_GAIT_OPTION(settings, field.delta, "delta_deg", -180, 180, "deg",                                        \
                          "phase shift between joints; the robot swims astern where it is negative"),                  \
        MORAY_GAIT_OPTION(settings, field.phi0_m, "phi0_m", -1, 1, "m",                                                \
                          "joint offset of the control-oriented model; 0 unless an offset is given"),                  \
        MORAY_GAIT_OPTION(settings, field.phi0, "phi0_deg", -90, 90, "deg",                                            \
                          "instead of phi0_m: joint offset of the first-principles model, of opposite sign"),          \
        MORAY_GAIT_OPTION(                                                                                             \
            settings, field.taper, "taper", -1, 1, NULL,                                                               \
            "eel-like motion: change of the joint amplitude from mid-body to the head, as a part of it; "              \
            "the opposite to the tail")

// The gait for the model, theta_max 20 deg and no offset where nothing else is given; what is given for the other model
// is mapped. Error: MORAY_INPUT when two amplitudes or two offsets contradict each other (by more than 1e-6), or when
// one has no counterpart in the model.
MORAY_API moray_status moray_gait_input_make(const moray_gait_input *input, const moray_robot *robot, moray_model model,
                                             moray_gait *gait);

// Reads a schedule for the model: `first` from t = 0 on, then one gait a line of a file of comma-separated values. The
// file's first line names the columns: t_s and any of the keys above, in any order. A gait keeps from the one before
// what its line leaves open: columns that are not there, and empty cells. Blank lines and lines that begin with # do
// not count. free(*changes). Error: MORAY_IO; MORAY_INPUT naming file, line and what is wrong; MORAY_MEMORY.
MORAY_API moray_status moray_gait_schedule_read(const char *path, const moray_gait_input *first,
                                                const moray_robot *robot, moray_model model,
                                                moray_gait_change **changes, int *n);

MORAY_END

#endif
