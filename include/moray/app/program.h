// SPDX-License-Identifier: MIT
//
// What every program shares: start, end, exit code.
#ifndef MORAY_APP_PROGRAM_H
#define MORAY_APP_PROGRAM_H

#include "moray/export.h"
#include "moray/app/options.h"
#include "moray/app/results.h"

MORAY_BEGIN

// ---- Start and end of a program ------------------------------------------------------------------------------------

typedef enum {
    MORAY_EXIT_SOLVED = 0, // and certified
    MORAY_EXIT_NOT_SOLVED = 1,
    MORAY_EXIT_USAGE = 2, // bad usage or input, or an output that cannot be written
    MORAY_EXIT_CERTIFICATE = 3,
    MORAY_EXIT_INTERRUPTED = 130
} moray_exit;

MORAY_API moray_exit moray_exit_of(moray_code code);

// Parses, answers --help and --version on standard output, opens --out. False when the program is to end at once with
// *exit_code: then nothing is left to free and any error stands on standard error in one line. From here to the end the
// thread's locale is C: numbers have points whatever the host has set.
MORAY_API bool moray_app_start(const moray_program *program, int argc, char **argv, void *settings, int *exit_code);

// Ends what moray_app_start began: a failed status becomes one line on standard error, an --out without a summary is
// left run.ini and a summary.json with the reason, or where the usage was bad or the run interrupted nothing. Returns
// the exit code of the status; where standard output took not all that was printed, MORAY_EXIT_USAGE with a line that
// says so.
MORAY_API int moray_app_end(const moray_program *program, void *settings, moray_status status);

// The exit code of a run that has solved: where what it found is not certified, `certified` says why not, which becomes
// a line on standard error, with --quiet too.
MORAY_API int moray_app_certified(const moray_program *program, moray_status certified);

// ---- What a program found ------------------------------------------------------------------------------------------

// All but found may be left out; the functions get `found`.
typedef struct moray_results {
    const char *name; // of the program; "problem" and with "version" the first keys of the summary
    const void *found;
    void (*summary)(const void *found, moray_json *json);           // the other keys
    const moray_json *json;                                         // or the whole summary, made along the way
    void (*print)(const void *found, const moray_report *report);   // tables and words, on standard output
    moray_status (*write)(const void *found, moray_output *output); // files besides summary.json and report.html
    moray_status (*draw)(const void *found, moray_output *output);  // figures
    const moray_report *report;                                     // with or without the command line
} moray_results;

// With --out the files, committed, and a line that tells the page where standard error is a terminal, unless --quiet;
// then on standard output the summary (--json) or what `print` does. Error: MORAY_IO, MORAY_MEMORY, those of `write`,
// and what moray_app_drawn leaves of those of `draw`.
MORAY_API moray_status moray_app_show(const moray_common *common, const moray_results *results);

// What to make of the status of a figure: one that cannot be drawn is a line on standard error and no error; only
// MORAY_MEMORY and MORAY_INTERRUPTED stay.
MORAY_API moray_status moray_app_drawn(const moray_common *common, const char *name, moray_status drawn);

MORAY_END

#endif
