// SPDX-License-Identifier: MIT
//
// The time that a run is given, of the clock on the wall, and how it is shared out among what the run does.
#ifndef PROBLEMS_STEERING_CLOCK_H
#define PROBLEMS_STEERING_CLOCK_H

#include <stdbool.h>

typedef struct steer_clock {
    double limit; // of the whole run [s]
    double start, until;
} steer_clock;

#define STEER_TIME_OPTION(settings, field)                                                                             \
    MORAY_ROW(REAL, settings, field.limit, "solver", "time_s", .flag = "time", .argument = "SECONDS", .min = 1,        \
              .max = 1e7, .unit = "s",                                                                                 \
              .help = "of the clock on the wall, after which the run ends with the best that it has found")

void steer_clock_start(steer_clock *clock);

// Gives what follows this share of the time left.
void steer_clock_give(steer_clock *clock, double share);

// Gives what follows most of what is left until then, and what comes behind it the rest.
void steer_clock_divide(steer_clock *clock, double until);

// Whether what was given is used up.
bool steer_clock_up(const steer_clock *clock);

#endif
