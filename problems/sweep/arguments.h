// SPDX-License-Identifier: MIT
//
// The command line of the program sweep.
#ifndef PROBLEMS_SWEEP_ARGUMENTS_H
#define PROBLEMS_SWEEP_ARGUMENTS_H

#include "moray/app/sweep.h"
#include "sweep/programs.h"

enum { SWEEP_MOST_SHOWN = 16 };

typedef struct sweep_arguments {
    const sweepable *program;
    int rest_n; // the program's own arguments
    char **rest;
    moray_sweep_axis axis[MORAY_SWEEP_AXES];
    moray_sweep_range range[MORAY_SWEEP_RANGES];
    int axes, ranges;
    long draws;
    uint64_t seed;
    const char *file, *out; // out: NULL for none
    char **owned;           // [n_owned]: texts to be freed
    int n_owned;
    const char *objective;              // NULL: the program's
    const char *show[SWEEP_MOST_SHOWN]; // numbers, or patterns of them, to be told and drawn
    const char *keep[SWEEP_MOST_SHOWN]; // patterns of the numbers that the file is to have
    const char *mirror, *page;          // key whose opposite values are compared; file; NULL: none
    long most;                          // points that measure goes up to
    int repeats;                        // of its measurements
    int shown, kept, jobs;
    double point_seconds, point_megabytes, silent_seconds;
    bool cold, quantiles, quiet, json;
} sweep_arguments;

// Reads argv with argp; answers --help and --version. False: the program is to end with *exit_code, what is to be said
// has been said. Everything in *found is freed by sweep_arguments_free.
bool sweep_arguments_read(int argc, char **argv, sweep_arguments *found, int *exit_code);
void sweep_arguments_free(sweep_arguments *arguments);

// Parts of it, of "KEY=VALUES" each; files: to the last axis, which is a list. A copy is freed with the arguments.
// Error: MORAY_INPUT, MORAY_MEMORY.
moray_status sweep_add_grid(sweep_arguments *a, const char *argument);
moray_status sweep_add_list(sweep_arguments *a, const char *argument);
moray_status sweep_add_files(sweep_arguments *a, const char *pattern);
moray_status sweep_add_range(sweep_arguments *a, const char *argument);
moray_status sweep_copy_of(sweep_arguments *a, const char *text, char **copy);

// What is left to be said once all is read: the file, the objective, and that the keys go together. Error: MORAY_INPUT,
// MORAY_MEMORY.
moray_status sweep_complete(sweep_arguments *a);

#endif
