// SPDX-License-Identifier: MIT
#define _GNU_SOURCE // asprintf
#include "sweep/point.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "moray/app/program.h"

typedef struct command {
    char **argv; // ends with NULL
    int argc;
    bool no_memory;
} command;

static void add(command *c, const char *format, const char *first, const char *second)
{
    char *text;
    char **argv = realloc(c->argv, (size_t)(c->argc + 2) * sizeof *argv);
    if (argv)
        c->argv = argv;
    if (!argv || asprintf(&text, format, first, second) < 0) {
        c->no_memory = true;
        return;
    }
    c->argv[c->argc++] = text;
    c->argv[c->argc] = NULL;
}

static const char *setting(const moray_sweep_point *point, const char *key)
{
    for (int k = 0; k < point->n; k++)
        if (strcmp(point->setting[k].key, key) == 0)
            return point->setting[k].value;
    return NULL;
}

static void add_settings(command *c, const moray_sweep_point *point)
{
    const char *x = setting(point, "current_x"), *y = setting(point, "current_y");
    for (int k = 0; k < point->n; k++) {
        const char *key = point->setting[k].key, *value = point->setting[k].value;
        if (strcmp(key, "robot") == 0)
            add(c, "--%s=%s", key, value);
        else if (strcmp(key, "current_x") != 0 && strcmp(key, "current_y") != 0)
            add(c, "--set=%s=%s", key, value);
    }
    if (x || y)
        add(c, "--current=%s,%s", x ? x : "0", y ? y : "0");
}

// Exit codes of the programs; why, each says on standard error.
static moray_status status_of(int exit_code)
{
    static const moray_code codes[] = {[MORAY_EXIT_SOLVED] = MORAY_OK,
                                       [MORAY_EXIT_NOT_SOLVED] = MORAY_NOT_SOLVED,
                                       [MORAY_EXIT_USAGE] = MORAY_INPUT,
                                       [MORAY_EXIT_CERTIFICATE] = MORAY_NUMERIC};
    moray_status status = moray_ok();
    status.code = exit_code >= 0 && exit_code <= MORAY_EXIT_CERTIFICATE ? codes[exit_code] : MORAY_INTERRUPTED;
    status.text[0] = 0;
    return status;
}

moray_status sweep_run_program(const moray_sweep_point *point, FILE *summary, void *self)
{
    const sweep_arguments *a = self;
    command c = {0};
    add(&c, "%s%s", a->program->name, "");
    for (int k = 0; k < a->rest_n; k++)
        add(&c, "%s%s", a->rest[k], "");
    add_settings(&c, point);
    add(&c, "--%s%s", "json", "");
    add(&c, "--%s%s", "quiet", "");
    if (a->program->jobs)
        add(&c, "--%s=%s", "jobs", "1");
    if (a->program->guess && !a->cold)
        add(&c, "--%s=%s", "solution", point->solution);
    if (a->program->guess && point->guess)
        add(&c, "--%s=%s", a->program->guess, point->guess);
    if (c.no_memory || dup2(fileno(summary), STDOUT_FILENO) < 0)
        return moray_error(MORAY_MEMORY, "no memory for a command line");
    return status_of(a->program->main(c.argc, c.argv)); // this process ends: nothing here needs to be freed
}
