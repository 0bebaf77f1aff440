// SPDX-License-Identifier: MIT
//
// Ipopt prints a complaint about an option on standard output, unless the problem has been solved with print level 0.
// So every option is tried on a small problem that has.
#include "nlp/ipopt_user.h"

#include <errno.h>
#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/number.h"
#include "nlp/ipopt_log.h"
#include "nlp/ipopt_options.h"
#include "nlp/mumps_lock.h"

enum kind { refused, integer, number, text };

static Bool no_value(Index n, Number *x, Bool fresh, Number *value, UserDataPtr data)
{
    (void)n, (void)x, (void)fresh, (void)value, (void)data;
    return FALSE;
}

static Bool no_values(Index n, Number *x, Bool fresh, Index m, Number *g, UserDataPtr data)
{
    (void)n, (void)x, (void)fresh, (void)m, (void)g, (void)data;
    return FALSE;
}

static Bool no_matrix(Index n, Number *x, Bool fresh, Index m, Index nnz, Index *row, Index *col, Number *values,
                      UserDataPtr data)
{
    (void)n, (void)x, (void)fresh, (void)m, (void)nnz, (void)row, (void)col, (void)values, (void)data;
    return FALSE;
}

static Bool no_hessian(Index n, Number *x, Bool fresh, Number sigma, Index m, Number *lambda, Bool fresh_lambda,
                       Index nnz, Index *row, Index *col, Number *values, UserDataPtr data)
{
    (void)n, (void)x, (void)fresh, (void)sigma, (void)m, (void)lambda, (void)fresh_lambda, (void)nnz;
    (void)row, (void)col, (void)values, (void)data;
    return FALSE;
}

// A problem on which nothing is printed any more; NULL when out of memory.
static IpoptProblem new_silent(void)
{
    double lower = -1, upper = 1, x = 0, objective;
    IpoptProblem problem = CreateIpoptProblem(1, &lower, &upper, 0, NULL, NULL, 0, 0, 0, no_value, no_values, no_value,
                                              no_matrix, no_hessian);
    if (!problem)
        return NULL;
    AddIpoptIntOption(problem, (char *)"print_level", 0);
    AddIpoptStrOption(problem, (char *)"sb", (char *)"yes");
    AddIpoptStrOption(problem, (char *)"option_file_name", (char *)"");
    IpoptSolve(problem, &x, NULL, &objective, NULL, NULL, NULL, NULL);
    return problem;
}

static bool read_integer(const char *value, int *whole)
{
    char *end;
    errno = 0;
    const long read = strtol(value, &end, 10);
    *whole = (int)read;
    return end != value && *end == 0 && !errno && read >= INT_MIN && read <= INT_MAX;
}

static bool set(IpoptProblem problem, const moray_key_value *option, enum kind kind)
{
    char *key = moray_for_ipopt(option->key);
    int whole;
    double real;
    if (kind == integer)
        return read_integer(option->value, &whole) && AddIpoptIntOption(problem, key, whole);
    if (kind == number)
        return moray_number_read(option->value, &real) && AddIpoptNumOption(problem, key, real);
    return AddIpoptStrOption(problem, key, moray_for_ipopt(option->value));
}

static enum kind kind_of(IpoptProblem silent, const moray_key_value *option)
{
    for (enum kind kind = integer; kind <= text; kind++)
        if (set(silent, option, kind))
            return kind;
    return refused;
}

static moray_status refusal(const moray_key_value *option, const struct ipopt_log *log)
{
    char line[200];
    if (moray_ipopt_log_find(log, "not a valid option", line, sizeof line))
        return moray_error(MORAY_INPUT, "ipopt.%.60s: Ipopt has no such option", option->key);
    return moray_error(MORAY_INPUT, "ipopt.%.60s = %.60s: not a value that this option of Ipopt allows", option->key,
                       *option->value ? option->value : "(empty)");
}

// Options that would let files decide or break the output of the program.
static moray_status check_key(const moray_key_value *option)
{
    static const char *const kept[][2] = {{"option_file_name", "no option file is read"},
                                          {"sb", "the banner is never printed"},
                                          {"linear_solver", "it is a setting of moray's own"},
                                          {"output_file", "print_level writes the log to standard error"}};
    for (unsigned i = 0; i < sizeof kept / sizeof *kept; i++)
        if (strcmp(option->key, kept[i][0]) == 0)
            return moray_error(MORAY_INPUT, "ipopt.%s cannot be set: %s", option->key, kept[i][1]);
    return moray_ok();
}

static moray_status set_alone(IpoptProblem problem, const moray_key_value *option)
{
    struct ipopt_log log;
    IpoptProblem silent = new_silent();
    if (!silent)
        return moray_error(MORAY_MEMORY, "no memory for the options of Ipopt");
    if (moray_ipopt_log_open(&log))
        OpenIpoptOutputFile(silent, log.path, ipopt_error_level);
    const enum kind kind = kind_of(silent, option);
    FreeIpoptProblem(silent); // writes the log
    moray_status status = moray_ok();
    if (kind == refused || !set(problem, option, kind))
        status = refusal(option, &log);
    moray_ipopt_log_close(&log);
    return status;
}

// Solving the small problem makes an instance of MUMPS.
static moray_status set_on(IpoptProblem problem, const moray_key_value *option)
{
    moray_mumps_lock();
    const moray_status status = set_alone(problem, option);
    moray_mumps_unlock();
    return status;
}

moray_status moray_ipopt_set_user(IpoptProblem problem, const moray_nlp_settings *settings)
{
    for (int i = 0; i < settings->n_ipopt; i++) {
        MORAY_TRY(check_key(&settings->ipopt[i]));
        if (strcmp(settings->ipopt[i].key, "print_level") != 0)
            MORAY_TRY(set_on(problem, &settings->ipopt[i]));
    }
    return moray_ok();
}

moray_status moray_ipopt_print_level(const moray_nlp_settings *settings, int *level)
{
    enum { highest = 12 };
    *level = settings->print_level;
    for (int i = 0; i < settings->n_ipopt; i++)
        if (strcmp(settings->ipopt[i].key, "print_level") == 0 && !read_integer(settings->ipopt[i].value, level))
            return moray_error(MORAY_INPUT, "ipopt.print_level = %.60s: must be an integer from 0 to %d",
                               settings->ipopt[i].value, (int)highest);
    if (*level < 0 || *level > highest)
        return moray_error(MORAY_INPUT, "print level %d: must lie between 0 and %d", *level, (int)highest);
    return moray_ok();
}
