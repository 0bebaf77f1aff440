// SPDX-License-Identifier: MIT
//
// Options of a program: one table for the command line, the INI files and --help.
#ifndef MORAY_APP_OPTIONS_H
#define MORAY_APP_OPTIONS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#include "moray/export.h"
#include "moray/key_value.h"
#include "moray/status.h"

MORAY_BEGIN

// ---- Options -------------------------------------------------------------------------------------------------------

typedef enum {
    MORAY_OPTION_INT,    // int
    MORAY_OPTION_REAL,   // double
    MORAY_OPTION_BOOL,   // bool; as a flag it takes no argument and means yes
    MORAY_OPTION_CHOICE, // int or enum: index into `choices`
    MORAY_OPTION_TEXT,   // char[], not empty
    MORAY_OPTION_LIMIT,  // double; "none" is max, so infinite where max is
    MORAY_OPTION_RANGE,  // double[2] from "low:high"; "none" is the end of what is allowed; one number is both ends
    MORAY_OPTION_PAIR,   // double[2] from "x,y"
    MORAY_OPTION_LIST,   // double[] from "x,k*y,...", k times y; what is behind the last one is NaN; in an INI file a
                         // list that ends with a comma goes on in the next line
    MORAY_OPTION_IPOPT,  // moray_ipopt_list: one more of it
    MORAY_OPTION_INI,    // path of an INI file, read before the command line; stored nowhere; a flag alone
    MORAY_OPTION_RUN // char[], the folder of a run of any program (--out); of its run.ini the keys that this program
                     // has too, in the same section, are read before the command line
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
    const char *const *choices; // NULL-terminated; "name|other" can be given as name or as other
    const char *help;
} moray_option;

// .offset and .size of a row: {.key = "tol", MORAY_AT(moray_common, tol), ...}
#define MORAY_AT(settings, field) .offset = offsetof(settings, field), .size = sizeof(((settings *)0)->field)

// A row of a field, of a type without its prefix, with what else it has behind the key:
//   MORAY_ROW(REAL, moray_common, tol, "solver", "tol", .max = 1, .open = true, .help = "tolerance of the solver")
#define MORAY_ROW(kind, settings, field, part, name, ...)                                                              \
    {                                                                                                                  \
        .section = part, .key = name, .type = MORAY_OPTION_##kind, MORAY_AT(settings, field), __VA_ARGS__              \
    }

// The row of --jobs, from 0 on, an int; `text` says what is done side by side.
#define MORAY_JOBS_OPTION(settings, field, text)                                                                       \
    {                                                                                                                  \
        .flag = "jobs", .argument = "N", .type = MORAY_OPTION_INT, MORAY_AT(settings, field), .min = 0, .max = 10000,  \
        .help = text "; 0: one a processor"                                                                            \
    }

enum { MORAY_SCHEME_SIZE = 256, MORAY_PATH_SIZE = 4096 };

// Options of Ipopt that the user names, for moray_settings.ipopt.
enum { MORAY_IPOPT_OPTIONS = 32, MORAY_IPOPT_SIZE = 128 };
typedef struct moray_ipopt_list {
    int n;
    moray_key_value at[MORAY_IPOPT_OPTIONS];          // [n], into text
    char text[MORAY_IPOPT_OPTIONS][MORAY_IPOPT_SIZE]; // key, 0, value
} moray_ipopt_list;

// Settings every program has: the first member of its own settings.
struct moray_output; // moray/app/results.h
typedef struct moray_common {
    char scheme[MORAY_SCHEME_SIZE];
    int intervals;
    double tol;
    int linear_solver;      // a moray_linear_solver
    moray_ipopt_list ipopt; // copies of the settings refer to the texts in these
    bool json, quiet;
    char out[MORAY_PATH_SIZE];   // empty: none
    struct moray_output *output; // of --out, from moray_app_start; NULL without
    char *ini;                   // the settings as an INI file that repeats the run, likewise
    int argc;                    // the command line
    char **argv;
} moray_common;

// Hermite-Simpson on 40 intervals to 1e-8.
MORAY_API moray_common moray_common_default(void);

// A group of rows that several programs share, its offsets from the start of settings of its own, and what is done with
// those when all is read (or NULL); an error of finish is the program's.
typedef struct moray_option_table {
    const moray_option *rows;
    int n;
    moray_status (*finish)(void *settings);
} moray_option_table;

// A table with its place in a program's settings.
typedef struct moray_option_group {
    const moray_option_table *table;
    size_t at;
} moray_option_group;

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

// A key that a mode of the program has no use for: other than its default it is then refused, wherever it was given.
typedef struct moray_idle {
    const char *key; // NULL ends a list
    bool (*idle)(const void *settings);
    const char *why; // behind "has no use for it", as "without a receding horizon"
} moray_idle;

typedef struct moray_program {
    const char *name, *summary;  // summary: what it does, for --help
    const moray_option *options; // its own rows, offsets from the start of its settings
    int n_options;
    const moray_option_group *groups; // further rows; those of moray_common come by themselves
    int n_groups;
    const moray_words *words;   // NULL: no arguments without a flag
    const char *const *without; // flags, or keys, of groups that it has no use for, NULL-terminated; NULL: uses all
    const moray_idle *idle;     // keys that it has no use for in a mode; NULL: uses all
} moray_program;

typedef enum { MORAY_REQUEST_RUN, MORAY_REQUEST_HELP, MORAY_REQUEST_VERSION, MORAY_REQUEST_LIST } moray_request;

// Fills the settings (a struct that begins with moray_common) from INI files, then from the command line, and finishes
// every group. Writes nothing anywhere. With a request other than run the settings are as before.
// Error: MORAY_INPUT or MORAY_IO, naming the key (in a file: file and line), its value and what is allowed;
// MORAY_MEMORY; that of a finish.
MORAY_API moray_status moray_app_parse(const moray_program *program, int argc, char **argv, void *settings,
                                       moray_request *request);

// Writes the --help text, with the settings' present values as defaults. Error: MORAY_MEMORY, MORAY_IO.
MORAY_API moray_status moray_app_help(const moray_program *program, const void *settings, FILE *file);

// The same for programs that read it (manual pages, completion of command lines; --help=list): a line for each thing,
// fields by tabs, the last one is what --help says:
//   program NAME TEXT;  word NAME TEXT;  flag NAME ARGUMENT VALUES TEXT;  key SECTION NAME ARGUMENT VALUES TEXT;  note
//   TEXT
// ARGUMENT is empty where a flag takes none; VALUES are what may be given, by blanks, where those are words.
// Error: MORAY_MEMORY, MORAY_IO.
MORAY_API moray_status moray_app_help_list(const moray_program *program, const void *settings, FILE *file);

// A key of an INI file and what to write after its "=".
typedef struct moray_ini_entry {
    const char *key, *value;
} moray_ini_entry;

// Sets keys of one section of an INI file and keeps all other lines as they are: the line of a key is written anew, a
// key that has none follows the section's last, a section that is not there ends the file, a file that is not there is
// made. A new file takes the old one's place at once, by renaming. Error: MORAY_IO naming the file, MORAY_MEMORY; the
// file is then as before.
MORAY_API moray_status moray_ini_set(const char *path, const char *section, const moray_ini_entry *entries, int n);

MORAY_API const char *moray_version(void);

MORAY_END

#endif
