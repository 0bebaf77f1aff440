// SPDX-License-Identifier: MIT
#include "options/options.h"

static const char *const linear_solvers[] = {"moray", "mumps", "ma57", NULL}; // by moray_linear_solver

static const moray_option shell_rows[] = {
    MORAY_ROW(TEXT, moray_common, scheme, "solver", "scheme", .flag = "scheme", .argument = "NAME",
              .help = "collocation scheme: hermite-simpson, trapezoid, or lobatto, radau or gauss followed by its "
                      "number of stages; or one for each phase, with commas"),
    MORAY_ROW(INT, moray_common, intervals, "solver", "intervals", .flag = "intervals", .argument = "K", .min = 1,
              .max = 100000, .help = "number of collocation intervals"),
    MORAY_ROW(REAL, moray_common, tol, "solver", "tol", .flag = "tol", .max = 1, .open = true,
              .help = "tolerance of the solver"),
    MORAY_ROW(CHOICE, moray_common, linear_solver, "solver", "linear_solver", .choices = linear_solvers,
              .help = "factorisation inside Ipopt: our own, MUMPS, or an MA57 in libhsl.so"),
    MORAY_ROW(IPOPT, moray_common, ipopt, "ipopt", "ipopt.KEY", .argument = "VALUE",
              .help = "any option of Ipopt by its name, after all that is set otherwise; in INI files KEY = VALUE"),
    {.flag = "json",
     .type = MORAY_OPTION_BOOL,
     MORAY_AT(moray_common, json),
     .help = "print one JSON object instead of tables"},
    {.flag = "out",
     .argument = "DIR",
     .type = MORAY_OPTION_TEXT,
     MORAY_AT(moray_common, out),
     .help = "write summary, trajectory, figures and report into this directory"},
    {.flag = "config", .argument = "FILE", .type = MORAY_OPTION_INI, .help = "INI file with any of the keys below"},
    {.flag = "quiet", .type = MORAY_OPTION_BOOL, MORAY_AT(moray_common, quiet), .help = "show no progress"},
};

const moray_option_table moray_common_table = {.rows = shell_rows, .n = sizeof shell_rows / sizeof *shell_rows};

moray_common moray_common_default(void)
{
    return (moray_common){.scheme = "hermite-simpson", .intervals = 40, .tol = 1e-8};
}
