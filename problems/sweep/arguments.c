// SPDX-License-Identifier: MIT
#include "sweep/arguments.h"

#include <argp.h>
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "moray/app/options.h"
#include "moray/app/program.h"
#include "moray/number.h"

enum {
    KEY_GRID = 0x100,
    KEY_LIST,
    KEY_RANDOM,
    KEY_RANGE,
    KEY_SEED,
    KEY_FILE,
    KEY_OUT,
    KEY_JOBS,
    KEY_TIME,
    KEY_MEMORY,
    KEY_SILENT,
    KEY_OBJECTIVE,
    KEY_SHOW,
    KEY_KEEP,
    KEY_MIRROR,
    KEY_PAGE,
    KEY_POINTS,
    KEY_REPEATS,
    KEY_COLD,
    KEY_QUANTILES,
    KEY_QUIET,
    KEY_JSON,
    KEY_VERSION
};

static const struct argp_option options[] = {
    {"grid", KEY_GRID, "KEY=LOW:HIGH:COUNT|V,V,...", 0,
     "values of a key of the program, numbers or words; again for every further axis", 1},
    {"list", KEY_LIST, "[KEY=]FILES", 0,
     "files as values of a key (robot, where none is named); a pattern, quoted, or several names behind it", 1},
    {"random", KEY_RANDOM, "COUNT", 0, "draws of the keys of --range, besides all grids", 1},
    {"range", KEY_RANGE, "KEY=LOW:HIGH", 0, "a key drawn evenly; again for every further one", 1},
    {"seed", KEY_SEED, "NUMBER", 0, "of the draws [1]", 1},
    {"file", KEY_FILE, "FILE", 0, "results, NetCDF-4 [PROGRAM.nc]; an unfinished one is gone on with", 2},
    {"out", KEY_OUT, "DIR", 0, "figures and a report", 2},
    {"show", KEY_SHOW, "NUMBER", 0,
     "a number of the program's summary to list and draw, as gain.speed_percent_at_equal_power; of a pattern as "
     "ladder.*.power_W the least and the most; again for further ones",
     2},
    {"mirror", KEY_MIRROR, "KEY", 0, "compare the numbers shown between opposite values of this key", 2},
    {"quantiles", KEY_QUANTILES, NULL, 0,
     "medians and 90th percentiles over all points of the numbers shown, and of their differences to the first", 2},
    {"keep", KEY_KEEP, "NUMBER", 0, "the file has only these numbers, or patterns of them; again for further ones", 2},
    {"page", KEY_PAGE, "FILE", 0, "an HTML page that shows the grid as it fills", 2},
    {"jobs", KEY_JOBS, "N", 0, "processes [one a processor]; with mpirun or srun, one a rank instead", 3},
    {"time", KEY_TIME, "SECONDS", 0, "most for one point [no limit]", 3},
    {"memory", KEY_MEMORY, "MB", 0, "most for one point [no limit]", 3},
    {"silent", KEY_SILENT, "SECONDS", 0,
     "silence after which a rank is taken for dead, where mpirun --enable-recovery lets the others live [30]", 3},
    {"objective", KEY_OBJECTIVE, "NUMBER", 0,
     "number that tells the better of two solutions, the lower one [the solver's objective]", 3},
    {"repeats", KEY_REPEATS, "N", 0, "measurements of each for measure, of which the quickest counts [1]", 3},
    {"points", KEY_POINTS, "N", 0, "most points of no cost for measure [10000]", 3},
    {"cold", KEY_COLD, NULL, 0, "every point from its own start, not from a solved neighbour", 3},
    {"quiet", KEY_QUIET, NULL, 0, "no progress", 4},
    {"json", KEY_JSON, NULL, 0, "what came of it as one JSON object", 4},
    {"version", KEY_VERSION, NULL, 0, "print the version", 4},
    {0}};

static moray_status number(const char *flag, const char *text, double low, double high, double *value)
{
    if (!moray_number_read(text, value) || !(*value >= low && *value <= high))
        return moray_error(MORAY_INPUT, "--%s %.60s: must be a number within %g:%g", flag, text, low, high);
    return moray_ok();
}

static moray_status whole(const char *flag, const char *text, double high, double *value)
{
    MORAY_TRY(number(flag, text, 1, high, value));
    return *value == floor(*value) ? moray_ok()
                                   : moray_error(MORAY_INPUT, "--%s %.60s: must be a whole number", flag, text);
}

static moray_status add_name(const char *flag, const char **list, int *n, const char *name)
{
    if (*n == SWEEP_MOST_SHOWN)
        return moray_error(MORAY_INPUT, "--%s: at most %d times", flag, SWEEP_MOST_SHOWN);
    list[(*n)++] = name;
    return moray_ok();
}

typedef struct reading {
    sweep_arguments *a;
    bool listing; // names that follow belong to the list
    moray_status status;
} reading;

static moray_status take_name(reading *r, const char *name)
{
    if (r->listing)
        return sweep_add_files(r->a, name);
    if (r->a->program)
        return moray_error(MORAY_INPUT,
                           "unexpected argument %.60s; what the program itself is to be given stands "
                           "behind --",
                           name);
    r->a->program = sweepable_find(name);
    return r->a->program ? moray_ok() : moray_error(MORAY_INPUT, "no program %.60s to sweep; --help lists them", name);
}

// Where an argument that is a text goes, or NULL.
static const char **text_of(sweep_arguments *a, int key)
{
    return key == KEY_FILE        ? &a->file
           : key == KEY_OUT       ? &a->out
           : key == KEY_OBJECTIVE ? &a->objective
           : key == KEY_MIRROR    ? &a->mirror
           : key == KEY_PAGE      ? &a->page
                                  : NULL;
}

// Of the options that are whole numbers.
static moray_status take_whole(sweep_arguments *a, int key, const char *value)
{
    double x = 0;
    moray_status status = moray_ok();
    switch (key) {
    case KEY_POINTS:
        status = whole("points", value, 1e7, &x);
        a->most = (long)x;
        break;
    case KEY_REPEATS:
        status = whole("repeats", value, 100, &x);
        a->repeats = (int)x;
        break;
    case KEY_RANDOM:
        status = whole("random", value, 1e9, &x);
        a->draws = (long)x;
        break;
    case KEY_SEED:
        status = whole("seed", value, 0x1p53, &x);
        a->seed = (uint64_t)x;
        break;
    default:
        status = whole("jobs", value, 10000, &x);
        a->jobs = (int)x;
    }
    return status;
}

static moray_status take_switch(sweep_arguments *a, int key)
{
    a->cold = a->cold || key == KEY_COLD;
    a->quantiles = a->quantiles || key == KEY_QUANTILES;
    a->quiet = a->quiet || key == KEY_QUIET;
    a->json = a->json || key == KEY_JSON;
    return moray_ok();
}

static moray_status take(reading *r, int key, char *value)
{
    sweep_arguments *a = r->a;
    if (key != ARGP_KEY_ARG)
        r->listing = key == KEY_LIST;
    if (text_of(a, key)) {
        *text_of(a, key) = value;
        return moray_ok();
    }
    switch (key) {
    case ARGP_KEY_ARG:
        return take_name(r, value);
    case KEY_GRID:
        return sweep_add_grid(a, value);
    case KEY_LIST:
        return sweep_add_list(a, value);
    case KEY_RANGE:
        return sweep_add_range(a, value);
    case KEY_SHOW:
        return add_name("show", a->show, &a->shown, value);
    case KEY_KEEP:
        return add_name("keep", a->keep, &a->kept, value);
    case KEY_TIME:
        return number("time", value, 1e-3, 1e9, &a->point_seconds);
    case KEY_MEMORY:
        return number("memory", value, 1, 1e9, &a->point_megabytes);
    case KEY_SILENT:
        return number("silent", value, 0.5, 1e6, &a->silent_seconds);
    case KEY_POINTS:
    case KEY_REPEATS:
    case KEY_RANDOM:
    case KEY_SEED:
    case KEY_JOBS:
        return take_whole(a, key, value);
    default:
        return take_switch(a, key);
    }
}

static error_t parse_one(int key, char *value, struct argp_state *state)
{
    reading *r = state->input;
    if (key == KEY_VERSION) {
        printf("sweep (moray) %s\n", moray_version());
        exit(MORAY_EXIT_SOLVED);
    }
    if (key != ARGP_KEY_ARG && key < KEY_GRID)
        return ARGP_ERR_UNKNOWN;
    if (key > KEY_VERSION)
        return ARGP_ERR_UNKNOWN;
    r->status = take(r, key, value);
    return moray_failed(r->status) ? EINVAL : 0;
}

static char *list_programs(int key, const char *text, void *input)
{
    (void)input;
    return key == ARGP_KEY_HELP_POST_DOC ? sweepables_list() : (char *)(uintptr_t)text;
}

bool sweep_arguments_read(int argc, char **argv, sweep_arguments *found, int *exit_code)
{
    static const struct argp parser = {
        options,
        parse_one,
        "PROGRAM [-- ARGUMENTS OF THE PROGRAM]",
        "Runs a program over all combinations of settings, on all cores or, under mpirun or srun, on many machines.\v",
        NULL,
        list_programs,
        NULL};
    *found = (sweep_arguments){.seed = 1, .most = 10000, .repeats = 1};
    reading r = {.a = found, .status = moray_ok()};
    int own = argc;
    for (int k = 1; k < argc && own == argc; k++)
        if (strcmp(argv[k], "--") == 0)
            own = k;
    found->rest = argv + own + 1;
    found->rest_n = own < argc ? argc - own - 1 : 0;
    argp_err_exit_status = MORAY_EXIT_USAGE; // what argp itself does not understand ends the program there
    const error_t error = argp_parse(&parser, own, argv, ARGP_IN_ORDER, NULL, &r);
    if (!moray_failed(r.status))
        r.status = error ? moray_error(MORAY_MEMORY, "the command line: %s", strerror(error)) : sweep_complete(found);
    if (!moray_failed(r.status))
        return true;
    fprintf(stderr, "sweep: %s\n", r.status.text);
    *exit_code = moray_exit_of(r.status.code);
    sweep_arguments_free(found);
    return false;
}
