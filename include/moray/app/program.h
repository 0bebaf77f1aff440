// SPDX-License-Identifier: MIT
//
// What every program shares: one table of options for the command line, the INI files and --help; start, end, exit
// code.
#ifndef MORAY_APP_PROGRAM_H
#define MORAY_APP_PROGRAM_H

#include <stddef.h>
#include <stdio.h>

#include "moray/app/results.h"
#include "moray/nlp.h"
#include "moray/snake/model.h"

// ---- Options -------------------------------------------------------------------------------------------------------

typedef enum {
    MORAY_OPTION_INT,    // int
    MORAY_OPTION_REAL,   // double
    MORAY_OPTION_BOOL,   // bool; as a flag it takes no argument and means yes
    MORAY_OPTION_CHOICE, // int or enum: index into `choices`
    MORAY_OPTION_TEXT,   // char[], not empty
    MORAY_OPTION_LIMIT,  // double; "none" is max, so infinite where max is
    MORAY_OPTION_RANGE,  // double[2] from "low:high"; "none" is the end of what is allowed; one number is both ends
    MORAY_OPTION_PAIR    // double[2] from "x,y"
} moray_option_type;

// One row of the table. The default is what stands in the settings before they are parsed; a NaN has none to show.
typedef struct moray_option {
    const char *section, *key;   // in INI files and for --set; both NULL: on the command line only
    const char *flag, *argument; // --flag ARGUMENT; flag NULL: --set only; argument NULL: from the type
    moray_option_type type;
    size_t offset, size;        // of the destination in the settings; write them with MORAY_AT
    double min, max;            // allowed, in `unit`; both 0: any finite number
    bool open;                  // the ends min and max themselves are not allowed
    const char *unit;           // or NULL; "deg" and "deg/s" are stored as rad and rad/s, all others as they stand
    const char *const *choices; // NULL-terminated
    const char *help;
} moray_option;

// .offset and .size of a row: {.key = "tol", MORAY_AT(moray_common, tol), ...}
#define MORAY_AT(settings, field) .offset = offsetof(settings, field), .size = sizeof(((settings *)0)->field)

enum { MORAY_SCHEME_SIZE = 32, MORAY_PATH_SIZE = 4096 };

// Settings every program has: the first member of its own settings.
typedef struct moray_common {
    moray_robot robot;            // before parsing l, m, J, c_t, c_n, mu_n and lambda_1..3 are NaN: from the geometry
    moray_link_geometry geometry; // gives the coefficients of the robot that are not given directly
    moray_model model;
    double current[2]; // V_x, V_y [m/s]
    double course;     // direction of travel over ground [rad]
    char scheme[MORAY_SCHEME_SIZE];
    int intervals;
    double tol;
    moray_linear_solver linear_solver;
    bool json, quiet;
    char robot_file[MORAY_PATH_SIZE], out[MORAY_PATH_SIZE]; // empty: none
    moray_output *output;                                   // of --out, from moray_app_start; NULL without
    int argc;                                               // the command line
    char **argv;
} moray_common;

// The paper's robot in still water, control-oriented model, Hermite-Simpson on 40 intervals to 1e-8.
moray_common moray_common_defaults(void);

// Arguments without a flag, each a word of this list; at least one is to be given.
typedef struct moray_word {
    const char *name, *help;
} moray_word;
typedef struct moray_words {
    const char *noun; // what a word names, as in "unknown study"; in capitals in the usage line
    const moray_word *word;
    int n;
    const char *all; // the word for all of them
    size_t offset;   // of bool[n] in the settings: which are given
} moray_words;

typedef struct moray_program {
    const char *name, *summary;  // summary: what it does, for --help
    const moray_option *options; // its own rows, offsets from the start of its settings
    int n_options;
    const moray_words *words;   // NULL: no arguments without a flag
    const char *const *without; // flags of shared options that it does not have, NULL-terminated; NULL: has all
    bool no_robot; // not about snake robots: no --robot, --model, --links, --current, --course and no INI file
} moray_program;

typedef enum { MORAY_REQUEST_RUN, MORAY_REQUEST_HELP, MORAY_REQUEST_VERSION } moray_request;

// Fills the settings (a struct that begins with moray_common) from the INI file of --robot, then from the command line,
// and makes the robot. Writes nothing anywhere. With a request other than run the settings are as before.
// Error: MORAY_INPUT or MORAY_IO, naming the key (in a file: file and line), its value and what is allowed;
// MORAY_MEMORY.
moray_status moray_app_parse(const moray_program *program, int argc, char **argv, void *settings,
                             moray_request *request);

// Writes the --help text, with the settings' present values as defaults. Error: MORAY_MEMORY, MORAY_IO.
moray_status moray_app_help(const moray_program *program, const void *settings, FILE *file);

// A key of an INI file and what to write after its "=".
typedef struct moray_ini_entry {
    const char *key, *value;
} moray_ini_entry;

// Sets keys of one section of an INI file and keeps all other lines as they are: the line of a key is written anew, a
// key that has none follows the section's last, a section that is not there ends the file, a file that is not there is
// made. A new file takes the old one's place at once, by renaming. Error: MORAY_IO naming the file, MORAY_MEMORY; the
// file is then as before.
moray_status moray_ini_set(const char *path, const char *section, const moray_ini_entry *entries, int n);

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

const char *moray_version(void);

#endif
