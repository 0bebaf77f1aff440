// SPDX-License-Identifier: MIT
//
// One problem over many settings, on all cores or, started by mpirun or srun, on many machines. In a library of its
// own: link with moray-sweep.
#ifndef MORAY_APP_SWEEP_H
#define MORAY_APP_SWEEP_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "moray/export.h"
#include "moray/key_value.h"
#include "moray/status.h"

MORAY_BEGIN

enum { MORAY_SWEEP_AXES = 16, MORAY_SWEEP_RANGES = 16 };

// What is varied: n values of a key, numbers or words. Points are all combinations; the last axis varies fastest.
typedef struct moray_sweep_axis {
    const char *key;
    const double *value;     // [n], or NULL: words
    const char *const *word; // [n]
    int n;
} moray_sweep_axis;

// A key drawn at random, even between low and high.
typedef struct moray_sweep_range {
    const char *key;
    double low, high;
} moray_sweep_range;

// A number beside every point's setting, the words apart. Every point sees it once.
typedef struct moray_sweep_point {
    long index;
    int n;
    const moray_key_value *setting; // [n]: of every axis and range, numbers to full precision
    const double *value;            // [n]; NaN for words
    const char *guess;              // file with a neighbour's solution to start from; NULL: the default start
    const char *solution;           // file in which to leave this point's own, for neighbours
} moray_sweep_point;

// Solves one point, in a process of its own, and writes one JSON object, whose numbers are what the sweep keeps, to
// `summary`. A failed status marks the point, with its text (or, without one, the last line on standard error), and
// keeps what the summary holds all the same.
typedef moray_status moray_sweep_fn(const moray_sweep_point *point, FILE *summary, void *self);

typedef struct moray_sweep_spec {
    const char *file;             // the results, NetCDF-4; beside it FILE.journal and FILE.solutions while it runs
    const char *title, *command;  // for the file; NULL: none
    const char *configuration;    // what else decides the results: one that differs cannot go on with the file
    const moray_sweep_axis *axis; // [axes]
    int axes;
    const moray_sweep_range *range; // [ranges], drawn `draws` times: one more axis, "draw", the slowest
    int ranges;
    long draws;
    uint64_t seed;
    moray_sweep_fn *solve;
    void *self;
    const char *objective;   // number, by its path in the summary, that tells the better of two solutions: the lower
    bool warm;               // starts from solved neighbours; and once more where a neighbour's branch is better
    int jobs;                // processes without mpirun; < 1: one a processor
    double point_seconds;    // of the clock, for one point; 0: no limit
    double point_megabytes;  // of address space, for one point; 0: no limit
    double silent_seconds;   // with mpirun --enable-recovery: silence by which a rank is lost; 0: 30
    double save_seconds;     // at least so long between two savings of the file; 0: 30
    const char *page;        // an HTML page that shows the grid as it fills, written anew every few seconds; NULL: none
    const char *const *keep; // [keeps]: numbers that the file is to have, patterns as gain.*; none: all
    int keeps;
    bool quiet;
    bool (*stop)(void); // asked between points; true: ends early, and can be gone on with. NULL: never
} moray_sweep_spec;

// What came of it.
typedef struct moray_sweep_result {
    long points, solved, failed; // failed: tried and not solved
    long before;                 // of these, found in the file when it began
    long warm, held;             // points begun from a neighbour; of these, solved so
    long improved;               // points that a neighbour's branch made better
    double seconds, busy;        // on the clock; in the points' processes, on theirs
    double saving;               // spent on the file and the journal
    double handing;              // on the processor, on answers: plan, store and journal; without making processes
    int ranks, jobs, lost;       // lost: ranks that died on the way; what they had in hand others did
} moray_sweep_result;

// Goes on where the file and its journal end, so that what is done is not done again; returns when all points have been
// tried. SIGKILL at any time costs the points in flight. On ranks other than the first it works for the first, then
// returns with *result all zero and `ranks` set. Error: MORAY_INPUT (spec; the file is of another sweep; another
// process works on it), MORAY_IO (a disk that is full among them: what is there stays), MORAY_MEMORY,
// MORAY_INTERRUPTED.
MORAY_API moray_status moray_sweep(const moray_sweep_spec *spec, moray_sweep_result *result);

// The values of "low:high:count" or "v,v,...", numbers or words: points into text, which is changed and must stay.
// *value or *word [*n] is to be freed, the other one is NULL. Error: MORAY_INPUT, MORAY_MEMORY.
MORAY_API moray_status moray_sweep_values(char *text, double **value, const char ***word, int *n);

// The numbers of a result over all points, by its path in the summary, read from the file of a sweep: (*value)[*n], to
// be freed. Error: MORAY_IO, MORAY_INPUT (no such number), MORAY_MEMORY.
MORAY_API moray_status moray_sweep_numbers(const char *file, const char *name, double **value, long *n);

// The least and the most, at every point, of the numbers that a pattern such as ladder.*.gain matches: (*least)[*n] and
// (*most)[*n], to be freed. Error: MORAY_IO, MORAY_INPUT (nothing matches), MORAY_MEMORY.
MORAY_API moray_status moray_sweep_extremes(const char *file, const char *pattern, double **least, double **most,
                                            long *n);

// The rank of this process where mpirun or srun started several, else 0. MPI begins with the first call and ends with
// the process.
MORAY_API int moray_sweep_rank(void);

MORAY_END

#endif
