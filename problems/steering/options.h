// SPDX-License-Identifier: MIT
//
// Rows of a table of options that the programs that steer share; `settings` is the program's, which begins with a
// steer_job named `steer`.
#ifndef PROBLEMS_STEERING_OPTIONS_H
#define PROBLEMS_STEERING_OPTIONS_H

#include "steer.h"

#define STEER_NUMBER(kind, settings, place, part, name, low, high, in, text)                                           \
    MORAY_ROW(kind, settings, place, part, name, .min = low, .max = high, .unit = in, .help = text)
#define STEER_LIMIT(settings, place, name, in, text)                                                                   \
    MORAY_ROW(LIMIT, settings, place, "problem", name, .max = INFINITY, .open = true, .unit = in, .help = text)
#define STEER_WEIGHT(settings, place, name, low, text)                                                                 \
    STEER_NUMBER(REAL, settings, place, "problem", name, low, 1e6, NULL, text)

#define STEER_OFFSET_OPTIONS(settings, most, fastest)                                                                  \
    STEER_NUMBER(REAL, settings, most, "problem", "phi0_max_m", 1e-6, 0.5, "m",                                        \
                 "largest joint offset of the control-oriented model; of the other in the ratio of amplitudes"),       \
        STEER_NUMBER(REAL, settings, fastest, "problem", "phi0_rate_m_s", 1e-6, 10, "m/s",                             \
                     "largest rate of the offset, likewise")

#define STEER_GAIT_OPTIONS(settings)                                                                                   \
    STEER_NUMBER(RANGE, settings, steer.input.theta_max, "problem", "theta_max_deg", 0.1, 89, "deg",                   \
                 "link-angle amplitude of (24)"),                                                                      \
        STEER_NUMBER(RANGE, settings, steer.input.omega, "problem", "omega_deg_s", 1, 3600, "deg/s",                   \
                     "gait frequency"),                                                                                \
        STEER_NUMBER(RANGE, settings, steer.input.delta, "problem", "delta_deg", 1, 179, "deg",                        \
                     "phase shift between joints"),                                                                    \
        STEER_OFFSET_OPTIONS(settings, steer.input.offset, steer.input.offset_rate),                                   \
        STEER_LIMIT(settings, steer.input.power, "power_W", "W",                                                       \
                    "mean power of the joints, or at the terminals of their motors; by default what the paper's gait " \
                    "uses straight ahead in the same model, none "                                                     \
                    "where the gait is given")

#define STEER_WATER_OPTION(settings)                                                                                   \
    MORAY_ROW(TEXT, settings, steer.water_file, "problem", "water", .flag = "water", .argument = "FILE",               \
              .help = "CSV file of a current over place and time in place of the uniform one: a grid of x_m, y_m, "    \
                      "v_x_m_s, v_y_m_s and, where it changes, t_s")

#define STEER_MESH_OPTIONS(settings)                                                                                   \
    STEER_NUMBER(INT, settings, steer.intervals_per_period, "solver", "intervals_per_period", 1, 100, NULL,            \
                 "of the mesh, an undulation"),                                                                        \
        STEER_NUMBER(INT, settings, steer.refinements, "solver", "refinements", 0, 40, NULL,                           \
                     "finer meshes tried where the first is too coarse"),                                              \
        STEER_TIME_OPTION(settings, steer.clock)

#define STEER_RECEDING_OPTIONS(settings)                                                                               \
    MORAY_ROW(BOOL, settings, steer.receding, "receding", "receding", .help = "try receding horizon too"),             \
        STEER_NUMBER(REAL, settings, steer.replan_periods, "receding", "replan_periods", 0.01, 1000, NULL,             \
                     "undulations between two plans"),                                                                 \
        STEER_NUMBER(REAL, settings, steer.look_ahead_periods, "receding", "look_ahead_periods", 0.1, 1000, NULL,      \
                     "undulations that a plan looks ahead")

#define STEER_TUNING_OPTIONS(settings)                                                                                 \
    STEER_NUMBER(INT, settings, steer.starts, "baseline", "starts", 1, 1000, NULL,                                     \
                 "searches for the numbers of each rival, from the best of four times as many points and from the "    \
                 "rivals that have fewer numbers"),                                                                    \
        STEER_NUMBER(INT, settings, steer.evaluations, "baseline", "evaluations", 1, 10000, NULL,                      \
                     "simulations spent on each search, for every number"),                                            \
        MORAY_JOBS_OPTION(settings, steer.jobs, "processes that tune and try")

// Keys without a use, for a moray_program's `idle`.
bool steer_without_receding(const void *settings);
bool steer_mesh_given(const void *settings);
bool steer_water_given(const void *settings);
bool steer_one_plan(const void *settings); // no gait to be found for the first-principles model

#define STEER_IDLE_RECEDING                                                                                            \
    {"replan_periods", steer_without_receding, "without receding horizon (receding = no)"},                            \
    {                                                                                                                  \
        "look_ahead_periods", steer_without_receding, "without receding horizon (receding = no)"                       \
    }
#define STEER_IDLE_MESH                                                                                                \
    {                                                                                                                  \
        "intervals_per_period", steer_mesh_given, "beside --intervals"                                                 \
    }
#define STEER_IDLE_WATER                                                                                               \
    {                                                                                                                  \
        "current", steer_water_given, "beside --water"                                                                 \
    }
#define STEER_IDLE_GAIT(name)                                                                                          \
    {                                                                                                                  \
        name, steer_one_plan, "where the gait is given or the model is control"                                        \
    }

#endif
