// SPDX-License-Identifier: MIT
//
// Inside the application layer: what a run with observations says of its parameters and data.
#ifndef SRC_RUN_FIT_H
#define SRC_RUN_FIT_H

#include "run/run.h"

enum { MORAY_FIT_ROWS = 5, MORAY_FIT_TABLES = 2 };

bool moray_run_observes(const moray_ocp_spec *spec);

// Confidence of the parameters, into run->fit and run->fitted; nothing where nothing is observed or solved. Error:
// MORAY_MEMORY.
moray_status moray_run_fit(app_run *run);

// Into table[MORAY_FIT_TABLES], rows[MORAY_FIT_ROWS + ns], texts[ns]. Returns how many tables.
int moray_run_fit_tables(const app_run *run, moray_table *table, moray_table_row *rows, struct run_text *texts);

// The object "fit", null where the problem is not solved; nothing where nothing is observed.
void moray_run_fit_to_json(moray_json *json, const app_run *run);

// residuals.csv, and a figure of every channel of every phase. Error: MORAY_IO, MORAY_MEMORY.
moray_status moray_run_write_residuals(const app_run *run);

#endif
