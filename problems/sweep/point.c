// SPDX-License-Identifier: MIT
#define _GNU_SOURCE // asprintf
#include "sweep/point.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "moray/app/program.h"
#include "moray/app/results.h"

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

static double number(const moray_sweep_point *point, const char *key)
{
    for (int k = 0; k < point->n; k++)
        if (strcmp(point->setting[k].key, key) == 0)
            return point->value[k];
    return 0;
}

static const char *const current_keys[] = {CURRENT_X, CURRENT_Y, CURRENT_SPEED, CURRENT_DEG, NULL};

static void add_current(command *c, const moray_sweep_point *point)
{
    const char *x = setting(point, CURRENT_X), *y = setting(point, CURRENT_Y);
    char text[2][32];
    if (setting(point, CURRENT_SPEED)) {
        const double speed = number(point, CURRENT_SPEED), angle = number(point, CURRENT_DEG);
        // Whole quarters without rounding, so that a current along the course has nothing across it.
        const double quarter = angle / 90, turn = angle * M_PI / 180;
        const bool whole = quarter == floor(quarter);
        const int q = whole ? (int)(quarter - 4 * floor(quarter / 4)) : 0;
        x = moray_number_text(speed * (whole ? (double[]){1, 0, -1, 0}[q] : cos(turn)), text[0]);
        y = moray_number_text(speed * (whole ? (double[]){0, 1, 0, -1}[q] : sin(turn)), text[1]);
    }
    if (x || y)
        add(c, "--current=%s,%s", x ? x : "0", y ? y : "0");
}

static void add_settings(command *c, const moray_sweep_point *point)
{
    for (int k = 0; k < point->n; k++) {
        const char *key = point->setting[k].key;
        bool of_current = false;
        for (int i = 0; current_keys[i]; i++)
            of_current = of_current || strcmp(key, current_keys[i]) == 0;
        if (!of_current)
            add(c, strcmp(key, "robot") == 0 ? "--%s=%s" : "--set=%s=%s", key, point->setting[k].value);
    }
    add_current(c, point);
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
