// SPDX-License-Identifier: MIT
//
// A whole program around one optimal-control problem; and the pieces of its results that other programs show too.
#ifndef MORAY_APP_RUN_H
#define MORAY_APP_RUN_H

#include "moray/export.h"
#include "moray/app/program.h"
#include "moray/ocp.h"

MORAY_BEGIN

// A number of the problem that --set KEY=VALUE changes before the functions are called; both limits 0: any.
typedef struct moray_app_constant {
    const char *key, *unit, *help; // unit NULL: none; "deg" and "deg/s" arrive as rad and rad/s
    double *value;                 // its default, then what the user gave: let `data` of the spec lead to it
    double min, max;
} moray_app_constant;

// Units, for the results alone. Each list is as long as what it belongs to; NULL: none.
typedef struct moray_app_units {
    const char *const *x, *const *u, *const *q;
} moray_app_units;

// Everything is borrowed. All but `spec` may be left out.
typedef struct moray_app {
    const moray_ocp_spec *spec;
    const char *summary;                    // what the program does, for --help
    const moray_settings *settings;         // the options' defaults; NULL: moray_settings_default()
    const moray_guess *guess;               // NULL: from the bounds
    const char *objective, *objective_unit; // what is minimised
    const char *time_unit, *const *s_units; // s_units[ns]
    const moray_app_units *units;           // [phases]
    const moray_app_constant *constants;    // at most MORAY_APP_CONSTANTS
    int n_constants;
    bool known_variance; // weights of observations are 1 / variance, not only ratios (moray_fit_new)
} moray_app;

enum { MORAY_APP_CONSTANTS = 32 };

// Reads the options, solves, certifies by re-simulation, prints a table or (--json) one JSON object on standard output,
// and leaves with --out summary.json, trajectory.csv, figures of states and controls over time, report.html, and
// solution.moray, from which --continue FILE goes on, and from which --guess FILE starts on the mesh of the options (as
// from a trajectory.csv, which has no multipliers). A problem with observations has a table of its parameters with
// intervals of 95 %, in the summary as "fit"; with --out residuals.csv (for each channel NAME, "NAME predicted" and
// "NAME residual", observed less predicted) and figures of data and prediction.
// Ctrl-C ends the solve at the next iteration and leaves the best iterate in a file, from which --continue FILE starts,
// on the mesh it has unless --scheme or --intervals name another; a second Ctrl-C ends at once. What the solver left is
// shown and written in any case: solved (exit code 0, or 3 where the certificate failed), not solved (1) or interrupted
// (130); the codes are those of moray_exit. A problem that cannot be stated ends with a line on standard error and 2.
MORAY_API int moray_app_run(const moray_app *app, int argc, char **argv);

// ---- Pieces of results ---------------------------------------------------------------------------------------------

// The blocks "solver" (to be closed by the caller, who may add to it) and "certificate" of a summary. A NULL
// certificate was not made: it did not pass, and its numbers are null.
MORAY_API void moray_solver_to_json(moray_json *json, const moray_solution *solution);
MORAY_API void moray_certificate_to_json(moray_json *json, const moray_certificate *certificate);

// One line each, into text[size]: "hermite-simpson, 20 intervals: solved in 11 iterations, 0.05 s (...)" and
// "Certificate: pass (KKT 1e-10, ...)".
MORAY_API void moray_solver_line(const moray_solution *solution, const char *scheme, int intervals, char *text,
                                 size_t size);
MORAY_API void moray_certificate_line(const moray_certificate *certificate, char *text, size_t size);

// Figures mesh.svg, the error of every interval beside the tolerance, of a solution that is solved, and
// convergence.svg, what the solver told of its iterations. time_unit may be NULL. Error: MORAY_MEMORY, those of
// moray_output_figure.
MORAY_API moray_status moray_solution_draw(const moray_solution *solution, double tolerance, const char *time_unit,
                                           moray_output *output);

// ---- Interruption --------------------------------------------------------------------------------------------------

// From now on the first SIGINT or SIGTERM only makes moray_interrupted true; the next one acts as it did before.
// Nothing changes for one that is ignored. The end brings back the earlier handlers.
MORAY_API void moray_interrupt_begin(void);
MORAY_API void moray_interrupt_end(void);
MORAY_API bool moray_interrupted(void);

// The row of --continue FILE; field: char[MORAY_PATH_SIZE] of the settings.
#define MORAY_CONTINUE(settings, field)                                                                                \
    {                                                                                                                  \
        .flag = "continue", .argument = "FILE", .type = MORAY_OPTION_TEXT, MORAY_AT(settings, field),                  \
        .help = "go on from the solution in this file (solution.moray of --out, or what Ctrl-C left)"                  \
    }

// The row of --guess FILE, likewise.
#define MORAY_GUESS(settings, field)                                                                                   \
    {                                                                                                                  \
        .flag = "guess", .argument = "FILE", .type = MORAY_OPTION_TEXT, MORAY_AT(settings, field),                     \
        .help = "start from the solution in this file (solution.moray of --out, or a trajectory.csv) on a new mesh"    \
    }

// The row of --solution FILE, for the solution without the other files of --out.
#define MORAY_LEAVE(settings, field)                                                                                   \
    {                                                                                                                  \
        .flag = "solution", .argument = "FILE", .type = MORAY_OPTION_TEXT, MORAY_AT(settings, field),                  \
        .help = "leave the solution in this file, as --out DIR leaves it in DIR/solution.moray"                        \
    }

// Of --continue and --guess, at most one. Error: MORAY_INPUT.
MORAY_API moray_status moray_check_starts(const char *from_file, const char *guess_file);

// Leaves a solution in the file solution.moray of --out. Error: MORAY_IO.
MORAY_API moray_status moray_solution_leave(const moray_solution *solution, moray_output *output);

// Writes what an interrupted solver left to NAME.iterate, beside the other files of --out (which the caller commits) or
// else in the working directory, and its path to path. Error: MORAY_IO, MORAY_INPUT (path too long).
MORAY_API moray_status moray_iterate_keep(const moray_common *common, const char *name, const moray_solution *solution,
                                          char path[MORAY_PATH_SIZE]);

// "interrupted after 12 iterations; to go on: --continue NAME.iterate" as an error, MORAY_INTERRUPTED.
MORAY_API moray_status moray_interruption(const moray_solution *solution, const char *path);

MORAY_END

#endif
