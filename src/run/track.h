// SPDX-License-Identifier: MIT
//
// Inside the application layer: values over time of all phases of a run, one below the other, as a CSV file has them.
#ifndef SRC_RUN_TRACK_H
#define SRC_RUN_TRACK_H

#include "run/run.h"

// A column: its name, and its unit or "".
struct track_column {
    char name[MORAY_ENTRY_SIZE], unit[MORAY_ENTRY_SIZE];
};

struct track;

// What the entries of a phase are. fill writes them and the time of phase p, whose rows are NaN so far; false when out
// of memory.
struct track_form {
    int (*entries)(const moray_phase_spec *phase);
    void (*describe)(const app_run *run, int p, int i, struct track_column *column);
    int (*rows)(const app_run *run, int p);
    bool (*fill)(struct track *t, int p);
    moray_status (*draw)(const struct track *t, int p); // figures of a phase; NULL: none
};

// Entries of the same name and unit share a column, which is NaN in phases that have none. Column 0 is the phase's
// number, 1 the time.
struct track {
    const app_run *run;
    const struct track_form *form;
    int rows, columns;
    int *first;  // [phases + 1] row
    int **place; // [phases][entries] column
    struct track_column *column;
    double *values; // [rows][columns]
};

// Error: MORAY_MEMORY. Free with moray_track_free, after an error too.
moray_status moray_track_new(struct track *t, const app_run *run, const struct track_form *form);
void moray_track_free(struct track *t);

// To a file of --out; without the phase's number where there is only one. Error: MORAY_IO, MORAY_MEMORY.
moray_status moray_track_write(const struct track *t, const char *name);

// All of it, and its figures; one that cannot be drawn is only remarked upon. Error: MORAY_IO, MORAY_MEMORY.
moray_status moray_track_write_new(const app_run *run, const struct track_form *form, const char *name);

#endif
