// SPDX-License-Identifier: MIT
#ifndef PROBLEMS_SWEEP_MEASURE_H
#define PROBLEMS_SWEEP_MEASURE_H

#include "sweep/arguments.h"

// What a sweep itself costs, as `sweep measure`: against the plain loop, on two cores, with starts from neighbours, and
// up to a->most points that cost nothing; from these, a million points on a thousand cores on paper. A table, or JSON
// with --json, on standard output; with --out a report. Error: MORAY_IO, MORAY_MEMORY, MORAY_NOT_SOLVED.
moray_status sweep_measure(sweep_arguments *a, int argc, char **argv);

enum { REAL_POINTS = 16, SIZES = 3, NUMBERS = 20, ANSWERS = 1000 };

// One sweep in a process of its own.
typedef struct cost {
    moray_sweep_result result;
    double processor, points, megabytes; // seconds of the process that hands out, of the points'; its largest memory
    double file, journal;                // bytes
} cost;

typedef struct plain_loop {
    double seconds, processor; // on the clock; on the processor, all loops together
} plain_loop;

typedef struct measured {
    plain_loop loop, two_loops;    // one; two at once, each with half of the points
    cost one, two, warm;           // of the same points
    cost answers;                  // as long as one of these, ANSWERS of them, of no cost
    long size[SIZES];              // points of no cost
    cost made[SIZES], read[SIZES]; // and the same files once more, where nothing is left to do
} measured;

moray_status measured_tell(const measured *m, const sweep_arguments *a, int argc, char **argv);

#endif
