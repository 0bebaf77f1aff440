// SPDX-License-Identifier: MIT
#include "options/options.h"

#include <argp.h>
#include <errno.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>

// argp keys: beyond the characters, which are short options. A row's is KEY_ROWS + its index.
enum { KEY_SET = 0x100, KEY_HELP, KEY_VERSION, KEY_ROWS };

typedef struct reading {
    const moray_options *options;
    const struct argp_option *flag; // ends with a zeroed one
    moray_arguments *arguments;
    int taken; // argv index of the first argument not yet understood
    moray_status status;
} reading;

static void add_assignment(reading *r, const moray_option *row, bool by_flag, const char *value)
{
    r->arguments->item[r->arguments->n++] = (moray_assignment){.row = row, .by_flag = by_flag, .value = value};
}

static moray_status take_set(reading *r, const char *text)
{
    char key[64];
    const char *equals = strchr(text, '=');
    if (!equals || equals == text)
        return moray_error(MORAY_INPUT, "--set %.60s: must be KEY=VALUE", *text ? text : "(empty)");
    const moray_option *row = moray_option_find_ipopt(r->options, text);
    if (row) {
        add_assignment(r, row, false, strchr(text, '.') + 1); // KEY=VALUE
        return moray_ok();
    }
    snprintf(key, sizeof key, "%.*s", (int)(equals - text), text);
    row = moray_option_find(r->options, key);
    if (!row)
        return moray_option_unknown(r->options, key);
    add_assignment(r, row, false, equals + 1);
    return moray_ok();
}

// The flags that `name` is or begins: their number, and the last of them.
static int find_flags(const struct argp_option *flag, const char *name, const struct argp_option **match)
{
    int n = 0;
    for (; flag->name; flag++) {
        if (strncmp(flag->name, name, strlen(name)) != 0)
            continue;
        *match = flag;
        if (strcmp(flag->name, name) == 0)
            return 1;
        n++;
    }
    return n;
}

static moray_status unknown_flag(const moray_options *options, const struct argp_option *flag, const char *argument)
{
    const char *nearest = NULL, *name = argument + strlen("--");
    int least = INT_MAX;
    MORAY_TRY(moray_option_unused(options, argument));
    for (; flag->name; flag++) {
        const int distance = moray_edit_distance(name, flag->name);
        if (distance < least) {
            least = distance;
            nearest = flag->name;
        }
    }
    if (moray_is_near(least, name))
        return moray_error(MORAY_INPUT, "unknown option --%s; did you mean --%s?", name, nearest);
    return moray_error(MORAY_INPUT, "unknown option --%s; --help lists the options", name);
}

static moray_status missing_value(const reading *r, const struct argp_option *flag)
{
    char must[MORAY_SHOWN_SIZE] = "KEY=VALUE";
    if (flag->key >= KEY_ROWS)
        moray_option_allowed(&r->options->row[flag->key - KEY_ROWS], must);
    return moray_error(MORAY_INPUT, "--%s has no value: must be %s", flag->name, must);
}

// Says what getopt did not like about an argument.
static moray_status bad_option(const reading *r, const char *argument)
{
    char name[64];
    const struct argp_option *match = NULL;
    if (strncmp(argument, "--", 2) != 0)
        return moray_error(MORAY_INPUT, "unknown option %.60s; --help lists the options", argument);
    snprintf(name, sizeof name, "%.*s", (int)strcspn(argument, "="), argument);
    const int n = find_flags(r->flag, name + 2, &match);
    if (n == 0)
        return unknown_flag(r->options, r->flag, name);
    if (n > 1)
        return moray_error(MORAY_INPUT, "option %s is ambiguous; --help lists the options", name);
    if (match->arg)
        return missing_value(r, match);
    return moray_error(MORAY_INPUT, "--%s takes no value", match->name);
}

static moray_status take_word(reading *r, const char *text)
{
    const moray_words *words = r->options->words;
    if (!words)
        return moray_error(MORAY_INPUT, "unexpected argument %.60s; options begin with --", *text ? text : "(empty)");
    if (!moray_word_known(words, text))
        return moray_word_unknown(words, text);
    add_assignment(r, NULL, false, text);
    return moray_ok();
}

static moray_status take_argument(reading *r, int key, const char *value)
{
    switch (key) {
    case ARGP_KEY_ARG:
        return take_word(r, value);
    case KEY_SET:
        return take_set(r, value);
    case KEY_HELP:
        if (value && strcmp(value, "list") != 0)
            return moray_error(MORAY_INPUT, "--help = %.60s: must be nothing or list", *value ? value : "(empty)");
        r->arguments->request = value ? MORAY_REQUEST_LIST : MORAY_REQUEST_HELP;
        return moray_ok();
    case KEY_VERSION:
        r->arguments->request = MORAY_REQUEST_VERSION;
        return moray_ok();
    default:
        add_assignment(r, &r->options->row[key - KEY_ROWS], true, value ? value : "yes");
        return moray_ok();
    }
}

// argp's callback.
static error_t take(int key, char *value, struct argp_state *state)
{
    reading *r = state->input;
    if (key == ARGP_KEY_ERROR && !moray_failed(r->status))
        r->status = bad_option(r, state->argv[r->taken]);
    if (key != ARGP_KEY_ARG && (key < KEY_SET || key >= KEY_ROWS + r->options->n))
        return ARGP_ERR_UNKNOWN;
    r->status = take_argument(r, key, value);
    r->taken = state->next;
    return moray_failed(r->status) ? EINVAL : 0;
}

// NULL when out of memory.
static struct argp_option *flags_of(const moray_options *options)
{
    struct argp_option *flag = calloc((size_t)options->n + 4, sizeof *flag);
    int n = 0;
    if (!flag)
        return NULL;
    for (int i = 0; i < options->n; i++)
        if (options->row[i].flag)
            flag[n++] = (struct argp_option){.name = options->row[i].flag,
                                             .key = KEY_ROWS + i,
                                             .arg = options->row[i].type == MORAY_OPTION_BOOL ? NULL : "VALUE"};
    flag[n++] = (struct argp_option){.name = "set", .key = KEY_SET, .arg = "KEY=VALUE"};
    flag[n++] = (struct argp_option){.name = "help", .key = KEY_HELP, .arg = "FORM", .flags = OPTION_ARG_OPTIONAL};
    flag[n++] = (struct argp_option){.name = "version", .key = KEY_VERSION};
    return flag;
}

moray_status moray_arguments_read(moray_arguments *arguments, const moray_options *options, int argc, char **argv)
{
    struct argp_option *flag = flags_of(options);
    *arguments = (moray_arguments){.request = MORAY_REQUEST_RUN};
    arguments->item = calloc((size_t)argc + 1, sizeof *arguments->item);
    reading r = {.options = options, .flag = flag, .arguments = arguments, .taken = 1, .status = moray_ok()};
    const struct argp argp = {.options = flag, .parser = take};
    error_t failed = ENOMEM;
    if (flag && arguments->item)
        failed = argp_parse(&argp, argc, argv, ARGP_NO_ERRS | ARGP_NO_HELP | ARGP_IN_ORDER, NULL, &r);
    free(flag);
    return failed == ENOMEM ? moray_error(MORAY_MEMORY, "no memory for the arguments") : r.status;
}
