// SPDX-License-Identifier: MIT
#ifndef PROBLEMS_SWEEP_REPORT_H
#define PROBLEMS_SWEEP_REPORT_H

#include "sweep/arguments.h"

// What came of a sweep: a table, or one JSON object with --json, on standard output; with --out figures and a report of
// the numbers to be shown, over the first numeric axis, a curve for every value of the next. Error: MORAY_IO,
// MORAY_MEMORY, MORAY_INPUT (a number that no point has).
moray_status sweep_report(const sweep_arguments *arguments, const moray_sweep_result *result, int argc, char **argv);

#endif
