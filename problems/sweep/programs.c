// SPDX-License-Identifier: MIT
#define _GNU_SOURCE // open_memstream
#include "sweep/programs.h"

#include <stdio.h>
#include <string.h>

// meson.build compiles NAME.c once more with main under this name.
#define PROGRAMS(X)                                                                                                    \
    X(classics, NULL, NULL, false)                                                                                     \
    X(free_gait, NULL, NULL, true)                                                                                     \
    X(heading_tracking, NULL, NULL, false)                                                                             \
    X(ladder, NULL, NULL, true)                                                                                        \
    X(max_speed, "solver.objective", "continue", true)                                                                 \
    X(min_energy, "solver.objective", "continue", true)                                                                \
    X(min_time_turn, NULL, NULL, false)                                                                                \
    X(path_following, NULL, NULL, false)                                                                               \
    X(sea_trials, NULL, NULL, true)                                                                                    \
    X(search_gait, NULL, NULL, true)                                                                                   \
    X(sensitivity, NULL, NULL, true)                                                                                   \
    X(simulate, NULL, NULL, false)                                                                                     \
    X(template, "solver.objective", "guess", false)

#define DECLARE(name, objective, guess, jobs) program_main program_##name;
#define ROW(name, objective, guess, jobs) {#name, program_##name, objective, guess, jobs},
PROGRAMS(DECLARE)
const sweepable sweepables[] = {PROGRAMS(ROW){.name = "measure"}, {0}};

const sweepable *sweepable_find(const char *name)
{
    for (const sweepable *one = sweepables; one->name; one++)
        if (strcmp(one->name, name) == 0)
            return one;
    return NULL;
}

char *sweepables_list(void)
{
    char *list = NULL;
    size_t size;
    FILE *file = open_memstream(&list, &size);
    if (!file)
        return NULL;
    fprintf(file, "Programs:");
    for (const sweepable *one = sweepables; one->name; one++)
        fprintf(file, " %s", one->name);
    fprintf(file, "\n");
    fclose(file);
    return list;
}
