// SPDX-License-Identifier: MIT
//
// Two short logs of a robot of three links on gaits that differ, from instruments that are off, for the tests of
// identification.
#ifndef TESTS_SWUM_LOGS_H
#define TESTS_SWUM_LOGS_H

#include "tap.h"

#include <string.h>

#include "snake/identify/identify.h"

enum { SWUM_LOGS = 2, SWUM_ROWS = 33 };
static const double swum_step = 0.125, swum_from = 2; // [s]

static inline moray_robot swum_robot(void)
{
    moray_robot robot = moray_robot_paper();
    robot.links = 3;
    return robot;
}

static inline moray_swim_log_noise swum_noise(void)
{
    return (moray_swim_log_noise){.position = 0.003,
                                  .heading = 0.01,
                                  .torque = 0.02,
                                  .heading_bias = 0.07,
                                  .camera = {0.3, -0.2},
                                  .camera_rotation = 0.4};
}

static inline void swum_logs(moray_model model, moray_swim_log_noise noise, moray_swim_log log[SWUM_LOGS])
{
    const moray_robot robot = swum_robot();
    moray_swimmer *swimmer;
    CHECK_OK(moray_swimmer_new(&swimmer, &robot, model), "swimmer");
    moray_swimmer_set_current(swimmer, 0.06, -0.04);
    for (int k = 0; k < SWUM_LOGS; k++) {
        const double size = model == MORAY_CONTROL_ORIENTED ? 0.1 : 1;
        const moray_gait gait = {.amplitude = size * (k ? 0.5 : 0.7),
                                 .omega = k ? 3.1 : 2.2,
                                 .delta = k ? 1.2 : 0.8,
                                 .offset = size * (k ? -0.05 : 0.1)};
        noise.seed = 5 + (unsigned long)k;
        CHECK_OK(moray_swim_log_swim(&log[k], swimmer, &gait, k ? -0.4 : 1.1, swum_from,
                                     swum_from + (SWUM_ROWS - 1) * swum_step, swum_step, &noise),
                 "log");
        snprintf(log[k].name, sizeof log[k].name, "log_%d", k + 1);
    }
    moray_swimmer_free(swimmer);
}

static inline void swum_free(moray_swim_log log[SWUM_LOGS])
{
    for (int k = 0; k < SWUM_LOGS; k++)
        moray_swim_log_free(&log[k]);
}

// A spec of unknowns by name, which begin where the logs were swum, with room on either side.
typedef struct swum_spec {
    moray_identify_spec spec;
    int unknown[MORAY_MOST_UNKNOWNS];
    double lower[MORAY_MOST_UNKNOWNS], upper[MORAY_MOST_UNKNOWNS];
} swum_spec;

static inline void swum_choose(swum_spec *s, moray_model model, const char *const *names, int n)
{
    const moray_swim_log_noise noise = swum_noise();
    *s = (swum_spec){.spec = {.model = model,
                              .start = {.robot = swum_robot(),
                                        .current = {0.06, -0.04},
                                        .heading_bias = noise.heading_bias,
                                        .camera = {noise.camera[0], noise.camera[1]},
                                        .camera_rotation = noise.camera_rotation},
                              .n = n,
                              .sigma = {0.003, 0.004, 0.01, 0.02},
                              .step = 0.05,
                              .max_iterations = 40}};
    for (int k = 0; k < n; k++) {
        s->unknown[k] = moray_unknown_named(names[k]);
        const double value = *moray_unknown_at(s->unknown[k], &s->spec.start);
        const bool offset = moray_unknown_table[s->unknown[k]].offset;
        s->lower[k] = offset ? value - 0.25 : value / 2;
        s->upper[k] = offset ? value + 0.375 : value * 1.7;
    }
    s->spec.unknown = s->unknown;
    s->spec.lower = s->lower;
    s->spec.upper = s->upper;
}

#endif
