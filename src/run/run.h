// SPDX-License-Identifier: MIT
//
// Inside the application layer: one run of moray_app_run.
#ifndef SRC_RUN_RUN_H
#define SRC_RUN_RUN_H

#include "moray/app/run.h"
#include "moray/fit.h"

typedef struct app_run {
    moray_common common;
    double mesh_tol, barrier;
    int refinements, max_iterations, max_variables;
    double max_cpu_seconds;
    bool check, gauss_newton;
    // Of --continue, --guess, --solution; empty: none.
    char from_file[MORAY_PATH_SIZE], guess_file[MORAY_PATH_SIZE], solution_file[MORAY_PATH_SIZE];
    double constant[MORAY_APP_CONSTANTS];
    const moray_app *app;
    const char *name;
    // found along the way
    moray_ocp *ocp;
    moray_solution *solution, *from;
    moray_guess read;           // of --guess
    char kept[MORAY_PATH_SIZE]; // where the best iterate is after an interruption
    bool certified;             // whether there is a certificate at all
    moray_certificate certificate;
    bool fitted; // whether there is
    moray_fit fit;
    moray_ticker ticker;
} app_run;

enum { MORAY_ENTRY_SIZE = 80 };

// "v" or, where nothing is named, "x[2]".
const char *moray_entry_name(const char *const *names, const char *letter, int i, char text[MORAY_ENTRY_SIZE]);
const char *moray_phase_name(const moray_ocp_spec *spec, int p);

// Table or JSON on standard output, and the files of --out. Error: MORAY_IO, MORAY_MEMORY.
moray_status moray_run_show(app_run *run);

// The tables of a run: rows belong to them. Error: MORAY_MEMORY. Free with moray_run_tables_free.
enum { MORAY_RUN_TABLES = 6 };
typedef struct run_tables {
    moray_table table[MORAY_RUN_TABLES];
    int n;
    moray_table_row *rows;
    struct run_text {
        char label[MORAY_ENTRY_SIZE], value[32];
    } * texts;
} run_tables;
moray_status moray_run_tables_new(run_tables *tables, const app_run *run);
void moray_run_tables_free(run_tables *tables);

// trajectory.csv, and figures of states and controls over time for each phase. Error: MORAY_IO, MORAY_MEMORY; a
// missing gnuplot is only remarked upon.
moray_status moray_run_write_trajectory(const app_run *run);

// costates.csv. Error: MORAY_IO, MORAY_MEMORY.
moray_status moray_run_write_costates(const app_run *run);

// multipliers.csv. Error: MORAY_IO, MORAY_MEMORY.
moray_status moray_run_write_multipliers(const app_run *run);

#endif
