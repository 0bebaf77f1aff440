// SPDX-License-Identifier: MIT
#include "options/options.h"

static const char *const linear_solvers[] = {"moray", "mumps", "ma57", NULL}; // by moray_linear_solver

static const moray_option shell_rows[] = {
    {.section = "solver",
     .key = "scheme",
     .flag = "scheme",
     .argument = "NAME",
     .type = MORAY_OPTION_TEXT,
     MORAY_AT(moray_common, scheme),
     .help =
         "collocation scheme: hermite-simpson, trapezoid, or lobatto, radau or gauss followed by its number of stages"},
    {.section = "solver",
     .key = "intervals",
     .flag = "intervals",
     .argument = "K",
     .type = MORAY_OPTION_INT,
     MORAY_AT(moray_common, intervals),
     .min = 1,
     .max = 100000,
     .help = "number of collocation intervals"},
    {.section = "solver",
     .key = "tol",
     .flag = "tol",
     .type = MORAY_OPTION_REAL,
     MORAY_AT(moray_common, tol),
     .max = 1,
     .open = true,
     .help = "tolerance of the solver"},
    {.section = "solver",
     .key = "linear_solver",
     .type = MORAY_OPTION_CHOICE,
     MORAY_AT(moray_common, linear_solver),
     .choices = linear_solvers,
     .help = "factorisation inside Ipopt: our own, MUMPS, or an MA57 in libhsl.so"},
    {.section = "ipopt",
     .key = "ipopt.KEY",
     .argument = "VALUE",
     .type = MORAY_OPTION_IPOPT,
     MORAY_AT(moray_common, ipopt),
     .help = "any option of Ipopt by its name, after all that is set otherwise; in INI files KEY = VALUE"},
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
