// SPDX-License-Identifier: MIT
#include "options/options.h"

#include <ctype.h>
#include <errno.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>

#include "base/number.h"

static bool allowed(const moray_option *row, double value)
{
    double min, max;
    moray_option_bounds(row, &min, &max);
    return row->open ? value > min && value < max : value >= min && value <= max;
}

static bool only_blanks(const char *text)
{
    while (isspace((unsigned char)*text))
        text++;
    return *text == 0;
}

static bool read_int(const moray_option *row, const char *text, int *value)
{
    char *end;
    errno = 0;
    const long number = strtol(text, &end, 10);
    if (end == text || !only_blanks(end) || errno || number < INT_MIN || number > INT_MAX)
        return false;
    *value = (int)number;
    return allowed(row, (double)number);
}

// A number in the row's unit, stored scaled.
static bool read_real(const moray_option *row, const char *text, double *value)
{
    double number;
    if (!moray_number_read(text, &number) || !allowed(row, number))
        return false;
    *value = number * moray_option_scale(row);
    return true;
}

// One end of a range; which: 0 low, 1 high.
static bool read_end(const moray_option *row, const char *text, int which, double *value)
{
    const char *start = text + strspn(text, " \t");
    if (strncmp(start, "none", 4) != 0 || !only_blanks(start + 4))
        return read_real(row, text, value);
    double bound[2];
    moray_option_bounds(row, &bound[0], &bound[1]);
    *value = bound[which] * moray_option_scale(row);
    return true;
}

static bool read_two(const moray_option *row, const char *text, double *value)
{
    char first[128];
    const bool range = row->type == MORAY_OPTION_RANGE;
    const char *separator = strchr(text, range ? ':' : ',');
    if (!separator)
        return range && read_end(row, text, 0, &value[0]) && read_end(row, text, 1, &value[1]);
    const size_t length = (size_t)(separator - text);
    if (length >= sizeof first)
        return false;
    memcpy(first, text, length);
    first[length] = 0;
    if (!range)
        return read_real(row, first, &value[0]) && read_real(row, separator + 1, &value[1]);
    return read_end(row, first, 0, &value[0]) && read_end(row, separator + 1, 1, &value[1]) && value[0] <= value[1];
}

static bool read_reals(const moray_option *row, const char *text, double *value)
{
    if (row->type == MORAY_OPTION_REAL)
        return read_real(row, text, value);
    if (row->type == MORAY_OPTION_LIMIT)
        return read_end(row, text, 1, value);
    return read_two(row, text, value);
}

// Whether text is one of the names in "name|other".
static bool is_named(const char *names, const char *text)
{
    const size_t length = strlen(text);
    for (const char *name = names; name; name = strchr(name, '|')) {
        name += *name == '|';
        if (strcspn(name, "|") == length && strncmp(name, text, length) == 0)
            return true;
    }
    return false;
}

// Position of text in the NULL-terminated list, or -1.
static int position(const char *const *list, const char *text)
{
    for (int i = 0; list[i]; i++)
        if (is_named(list[i], text))
            return i;
    return -1;
}

static bool read_bool(const char *text, bool *value)
{
    static const char *const words[] = {"no", "yes", "false", "true", "off", "on", "0", "1", NULL};
    const int at = position(words, text);
    *value = at % 2 == 1;
    return at >= 0;
}

static bool read_text(const moray_option *row, const char *text, char *to)
{
    if (*text == 0 || strlen(text) >= row->size)
        return false;
    strcpy(to, text);
    return true;
}

static bool read_value(const moray_option *row, const char *text, char *to)
{
    int whole;
    bool yes;
    double real[2];
    bool good = false;
    switch (row->type) {
    case MORAY_OPTION_INT:
    case MORAY_OPTION_CHOICE:
        if (row->type == MORAY_OPTION_INT)
            good = read_int(row, text, &whole);
        else
            good = (whole = position(row->choices, text)) >= 0;
        if (good)
            memcpy(to, &whole, sizeof whole);
        return good;
    case MORAY_OPTION_BOOL:
        if ((good = read_bool(text, &yes)))
            memcpy(to, &yes, sizeof yes);
        return good;
    case MORAY_OPTION_TEXT:
    case MORAY_OPTION_RUN:
        return read_text(row, text, to);
    case MORAY_OPTION_IPOPT:
    case MORAY_OPTION_INI:
        return *text != 0;
    case MORAY_OPTION_LIST:
        return moray_list_read(row, text, (double *)to);
    case MORAY_OPTION_REAL:
    case MORAY_OPTION_LIMIT:
    case MORAY_OPTION_RANGE:
    case MORAY_OPTION_PAIR:
        if ((good = read_reals(row, text, real)))
            memcpy(to, real, row->size);
        return good;
    }
    return good;
}

moray_status moray_option_read(const moray_option *row, const char *name, const char *text, void *settings)
{
    if (row->type == MORAY_OPTION_IPOPT)
        return moray_ipopt_list_set((moray_ipopt_list *)((char *)settings + row->offset), text);
    if (read_value(row, text, (char *)settings + row->offset))
        return moray_ok();
    char must[MORAY_SHOWN_SIZE];
    moray_option_allowed(row, must);
    return moray_error(MORAY_INPUT, "%s = %.60s: must be %s", name, *text ? text : "(empty)", must);
}
