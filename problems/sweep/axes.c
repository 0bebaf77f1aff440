// SPDX-License-Identifier: MIT
//
// What is varied, as the command line tells it.
#define _GNU_SOURCE // strdup
#include <glob.h>
#include <stdlib.h>
#include <string.h>

#include "moray/number.h"
#include "sweep/arguments.h"

// A copy that lasts as long as the arguments.
moray_status sweep_copy_of(sweep_arguments *a, const char *text, char **copy)
{
    char **owned = realloc(a->owned, (size_t)(a->n_owned + 1) * sizeof *owned);
    if (owned)
        a->owned = owned;
    *copy = owned ? strdup(text) : NULL;
    if (!*copy)
        return moray_error(MORAY_MEMORY, "no memory for an argument");
    owned[a->n_owned++] = *copy;
    return moray_ok();
}

// KEY=REST, or REST for a key given: both point into text.
static moray_status split(char *text, const char *flag, char *default_key, char **key, char **rest)
{
    char *equals = strchr(text, '=');
    if (equals == text || (!equals && !default_key) || (equals && !equals[1]))
        return moray_error(MORAY_INPUT, "--%s %.60s: must be KEY=VALUES", flag, text);
    *key = equals ? text : default_key;
    *rest = equals ? equals + 1 : text;
    if (equals)
        *equals = 0;
    return moray_ok();
}

static moray_status next_axis(sweep_arguments *a, moray_sweep_axis **axis)
{
    if (a->axes == MORAY_SWEEP_AXES)
        return moray_error(MORAY_INPUT, "more than %d axes", MORAY_SWEEP_AXES);
    *axis = &a->axis[a->axes];
    return moray_ok();
}

moray_status sweep_add_grid(sweep_arguments *a, const char *argument)
{
    moray_sweep_axis *axis = NULL;
    char *text, *key, *rest;
    double *value;
    const char **word;
    MORAY_TRY(next_axis(a, &axis));
    MORAY_TRY(sweep_copy_of(a, argument, &text));
    MORAY_TRY(split(text, "grid", NULL, &key, &rest));
    MORAY_TRY(moray_sweep_values(rest, &value, &word, &axis->n));
    axis->key = key;
    axis->value = value;
    axis->word = word;
    a->axes++;
    return moray_ok();
}

static moray_status add_word(sweep_arguments *a, moray_sweep_axis *axis, const char *name)
{
    char *copy;
    const char **word = realloc((void *)(uintptr_t)axis->word, (size_t)(axis->n + 1) * sizeof *word);
    if (!word)
        return moray_error(MORAY_MEMORY, "no memory for %d names", axis->n + 1);
    axis->word = word;
    MORAY_TRY(sweep_copy_of(a, name, &copy));
    word[axis->n++] = copy;
    return moray_ok();
}

moray_status sweep_add_files(sweep_arguments *a, const char *pattern)
{
    moray_sweep_axis *axis = &a->axis[a->axes - 1];
    glob_t found = {0};
    moray_status status = moray_ok();
    if (glob(pattern, GLOB_NOCHECK, NULL, &found) != 0)
        status = moray_error(MORAY_IO, "%.200s cannot be looked up", pattern);
    for (size_t k = 0; !moray_failed(status) && k < found.gl_pathc; k++)
        status = add_word(a, axis, found.gl_pathv[k]);
    globfree(&found);
    return status;
}

moray_status sweep_add_list(sweep_arguments *a, const char *argument)
{
    static char robot[] = "robot";
    moray_sweep_axis *axis = NULL;
    char *text, *key, *rest;
    MORAY_TRY(next_axis(a, &axis));
    MORAY_TRY(sweep_copy_of(a, argument, &text));
    MORAY_TRY(split(text, "list", robot, &key, &rest));
    *axis = (moray_sweep_axis){.key = key};
    a->axes++;
    return sweep_add_files(a, rest);
}

moray_status sweep_add_range(sweep_arguments *a, const char *argument)
{
    char *text, *key, *rest;
    if (a->ranges == MORAY_SWEEP_RANGES)
        return moray_error(MORAY_INPUT, "more than %d keys to draw", MORAY_SWEEP_RANGES);
    moray_sweep_range *range = &a->range[a->ranges];
    MORAY_TRY(sweep_copy_of(a, argument, &text));
    MORAY_TRY(split(text, "range", NULL, &key, &rest));
    char *high = strchr(rest, ':');
    if (high)
        *high++ = 0;
    if (!moray_number_read(rest, &range->low) || !moray_number_read(high, &range->high))
        return moray_error(MORAY_INPUT, "--range %.100s: must be KEY=LOW:HIGH, both of them finite numbers", argument);
    range->key = key;
    a->ranges++;
    return moray_ok();
}

void sweep_arguments_free(sweep_arguments *a)
{
    for (int k = 0; k < a->axes; k++) {
        free((void *)(uintptr_t)a->axis[k].value);
        free((void *)(uintptr_t)a->axis[k].word);
    }
    for (int k = 0; k < a->n_owned; k++)
        free(a->owned[k]);
    free(a->owned);
    *a = (sweep_arguments){0};
}
