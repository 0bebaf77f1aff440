// SPDX-License-Identifier: MIT
//
// The programs as functions: what main is to each of them.
#ifndef PROBLEMS_SWEEP_PROGRAMS_H
#define PROBLEMS_SWEEP_PROGRAMS_H

#include <stdbool.h>

typedef int program_main(int argc, char **argv);

typedef struct sweepable {
    const char *name;
    program_main *main;    // NULL: the sweep itself, which is measured
    const char *objective; // number of its summary that is the lower the better, of two solutions of one problem
    const char *guess;     // option that starts from a solution which --solution left; NULL: it has none
    bool jobs;             // has --jobs, which a sweep sets to 1: its points are the jobs
} sweepable;

extern const sweepable sweepables[]; // ends with a NULL name
const sweepable *sweepable_find(const char *name);
char *sweepables_list(void); // a line of them for --help, to be freed; NULL: no memory

#endif
