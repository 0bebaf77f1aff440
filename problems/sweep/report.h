// SPDX-License-Identifier: MIT
#ifndef PROBLEMS_SWEEP_REPORT_H
#define PROBLEMS_SWEEP_REPORT_H

#include "moray/app/results.h"
#include "sweep/shown.h"

// What came of a sweep: tables, or one JSON object with --json, on standard output; with --out figures, a report and
// the numbers to be shown of every point. Error: MORAY_IO, MORAY_MEMORY, MORAY_INPUT (a number that no point has).
moray_status sweep_report(const sweep_arguments *arguments, const moray_sweep_result *result, int argc, char **argv);

// The folder of --out: the report, summary.json, and, where `s` is not NULL, points.csv and figures of what it shows.
moray_status sweep_write_folder(const char *out, const moray_report *report, const moray_json *json, const shown *s);

#endif
