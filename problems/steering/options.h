// SPDX-License-Identifier: MIT
//
// Rows of a table of options that the programs that steer share; `settings` is the program's, which begins with a
// steer_job named `steer`.
#ifndef PROBLEMS_STEERING_OPTIONS_H
#define PROBLEMS_STEERING_OPTIONS_H

#include "steer.h"

#define STEER_ROW(kind, settings, place, part, name, low, high, in, text)                                              \
    {                                                                                                                  \
        .section = part, .key = name, .type = MORAY_OPTION_##kind, MORAY_AT(settings, place), .min = low, .max = high, \
        .open = MORAY_OPTION_##kind == MORAY_OPTION_LIMIT, .unit = in, .help = text                                    \
    }
#define STEER_TEXT_OPTION(settings, place, name, text)                                                                 \
    {                                                                                                                  \
        .section = "problem", .key = name, .flag = name, .argument = "TEXT", .type = MORAY_OPTION_TEXT,                \
        MORAY_AT(settings, place), .help = text                                                                        \
    }
#define STEER_PAIR(settings, place, name, in, text) STEER_ROW(PAIR, settings, place, "problem", name, 0, 0, in, text)
#define STEER_BOOL(settings, place, part, name, text) STEER_ROW(BOOL, settings, place, part, name, 0, 0, NULL, text)
#define STEER_FLAG(settings, place, name, called, low, high, in, text)                                                 \
    {                                                                                                                  \
        .section = "problem", .key = name, .flag = called, .type = MORAY_OPTION_REAL, MORAY_AT(settings, place),       \
        .min = low, .max = high, .unit = in, .help = text                                                              \
    }
#define STEER_RANGE(settings, place, name, low, high, in, text)                                                        \
    STEER_ROW(RANGE, settings, place, "problem", name, low, high, in, text)
#define STEER_LIMIT(settings, place, name, in, text)                                                                   \
    STEER_ROW(LIMIT, settings, place, "problem", name, 0, INFINITY, in, text)
#define STEER_REAL(settings, place, part, name, low, high, in, text)                                                   \
    STEER_ROW(REAL, settings, place, part, name, low, high, in, text)
#define STEER_INT(settings, place, part, name, low, high, text)                                                        \
    STEER_ROW(INT, settings, place, part, name, low, high, NULL, text)
#define STEER_WEIGHT(settings, place, name, low, text)                                                                 \
    STEER_REAL(settings, place, "problem", name, low, 1e6, NULL, text)

#define STEER_GAIT_OPTIONS(settings)                                                                                   \
    STEER_RANGE(settings, steer.input.theta_max, "theta_max_deg", 0.1, 89, "deg", "link-angle amplitude of (24)"),     \
        STEER_RANGE(settings, steer.input.omega, "omega_deg_s", 1, 3600, "deg/s", "gait frequency"),                   \
        STEER_RANGE(settings, steer.input.delta, "delta_deg", 1, 179, "deg", "phase shift between joints"),            \
        STEER_REAL(settings, steer.input.offset, "problem", "phi0_max_m", 1e-6, 0.5, "m",                              \
                   "largest joint offset of the control-oriented model; of the other in the ratio of amplitudes"),     \
        STEER_REAL(settings, steer.input.offset_rate, "problem", "phi0_rate_m_s", 1e-6, 10, "m/s",                     \
                   "largest rate of the offset, likewise"),                                                            \
        STEER_LIMIT(settings, steer.input.power, "power_W", "W",                                                       \
                    "mean joint power; by default what the paper's gait uses straight ahead in the same model, none "  \
                    "where the gait is given")

#define STEER_MESH_OPTIONS(settings)                                                                                   \
    STEER_INT(settings, steer.intervals_per_period, "solver", "intervals_per_period", 1, 100,                          \
              "of the mesh, an undulation"),                                                                           \
        STEER_INT(settings, steer.refinements, "solver", "refinements", 0, 20,                                         \
                  "finer meshes tried where the first is too coarse")

#define STEER_RECEDING_OPTIONS(settings)                                                                               \
    STEER_BOOL(settings, steer.receding, "receding", "receding", "try receding horizon too"),                          \
        STEER_REAL(settings, steer.replan_periods, "receding", "replan_periods", 0.01, 1000, NULL,                     \
                   "undulations between two plans"),                                                                   \
        STEER_REAL(settings, steer.look_ahead_periods, "receding", "look_ahead_periods", 0.1, 1000, NULL,              \
                   "undulations that a plan looks ahead")

#define STEER_TUNING_OPTION(settings, text)                                                                            \
    STEER_INT(settings, steer.evaluations, "baseline", "evaluations", 1, 10000, text)

#endif
