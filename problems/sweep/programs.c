// SPDX-License-Identifier: MIT
#include "sweep/programs.h"

#include <string.h>

// meson.build compiles NAME.c once more with main under this name.
#define PROGRAMS(X)                                                                                                    \
    X(classics, NULL, false, false)                                                                                           \
    X(free_gait, NULL, false, true)                                                                                           \
    X(heading_tracking, NULL, false, false)                                                                                   \
    X(ladder, NULL, false, true)                                                                                              \
    X(max_speed, "solver.objective", false, true)                                                                             \
    X(min_energy, "solver.objective", false, true)                                                                            \
    X(min_time_turn, NULL, false, false)                                                                                      \
    X(path_following, NULL, false, false)                                                                                     \
    X(search_gait, NULL, false, true)                                                                                         \
    X(sensitivity, NULL, false, true)                                                                                         \
    X(simulate, NULL, false, false)                                                                                           \
    X(template, "solver.objective", false, false)

#define DECLARE(name, objective, guess, jobs) program_main program_##name;
#define ROW(name, objective, guess, jobs) {#name, program_##name, objective, guess, jobs},
PROGRAMS(DECLARE)
const sweepable sweepables[] = {PROGRAMS(ROW){0}};

const sweepable *sweepable_find(const char *name)
{
    for (const sweepable *one = sweepables; one->name; one++)
        if (strcmp(one->name, name) == 0)
            return one;
    return NULL;
}
