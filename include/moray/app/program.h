// SPDX-License-Identifier: MIT
//
// What every program shares: start, end, exit code.
#ifndef MORAY_APP_PROGRAM_H
#define MORAY_APP_PROGRAM_H

#include "moray/app/options.h"
#include "moray/app/results.h"

// ---- Start and end of a program ------------------------------------------------------------------------------------

typedef enum {
    MORAY_EXIT_SOLVED = 0, // and certified
    MORAY_EXIT_NOT_SOLVED = 1,
    MORAY_EXIT_USAGE = 2, // bad usage or input, or an output that cannot be written
    MORAY_EXIT_CERTIFICATE = 3,
    MORAY_EXIT_INTERRUPTED = 130
} moray_exit;

moray_exit moray_exit_of(moray_code code);

// Parses, answers --help and --version on standard output, opens --out. False when the program is to end at once with
// *exit_code: then nothing is left to free and any error stands on standard error in one line.
bool moray_app_start(const moray_program *program, int argc, char **argv, void *settings, int *exit_code);

// Ends what moray_app_start began: a failed status becomes one line on standard error, an --out without commit leaves
// nothing. Returns the exit code of the status.
int moray_app_end(const moray_program *program, void *settings, moray_status status);

#endif
