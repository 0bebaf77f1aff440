// SPDX-License-Identifier: MIT
#include "options/options.h"

#include <math.h>
#include <string.h>

#include "moray/angle.h"

void moray_option_bounds(const moray_option *row, double *min, double *max)
{
    const bool any = row->min == 0 && row->max == 0;
    *min = any ? -INFINITY : row->min;
    *max = any ? INFINITY : row->max;
}

double moray_option_scale(const moray_option *row)
{
    return row->unit && strncmp(row->unit, "deg", 3) == 0 ? MORAY_DEGREE : 1;
}

static void show_number(const moray_option *row, const char *noun, char *text, size_t size)
{
    double min, max;
    moray_option_bounds(row, &min, &max);
    const char *space = row->unit ? " " : "", *unit = row->unit ? row->unit : "";
    if (isfinite(min) && isfinite(max))
        snprintf(text, size, row->open ? "a%s above %.10g and below %.10g%s%s" : "a%s from %.10g to %.10g%s%s", noun,
                 min, max, space, unit);
    else if (isfinite(min))
        snprintf(text, size, "a%s %s %.10g%s%s", noun, row->open ? "above" : "of at least", min, space, unit);
    else if (isfinite(max))
        snprintf(text, size, "a%s %s %.10g%s%s", noun, row->open ? "below" : "of at most", max, space, unit);
    else if (row->type == MORAY_OPTION_INT)
        snprintf(text, size, "a%s", noun);
    else
        snprintf(text, size, "a finite number%s%s", row->unit ? " in " : "", unit);
}

// Without its other names.
static int name_length(const char *choice)
{
    return (int)strcspn(choice, "|");
}

static void show_choices(const moray_option *row, char *text, size_t size)
{
    size_t used = 0;
    text[0] = 0;
    for (int i = 0; row->choices[i] && used < size; i++) {
        const char *joint = i == 0 ? "" : row->choices[i + 1] ? ", " : " or ";
        used +=
            (size_t)snprintf(text + used, size - used, "%s%.*s", joint, name_length(row->choices[i]), row->choices[i]);
    }
}

void moray_option_allowed(const moray_option *row, char text[MORAY_SHOWN_SIZE])
{
    char number[MORAY_SHOWN_SIZE / 2];
    show_number(row, row->type == MORAY_OPTION_INT ? "n integer" : " number", number, sizeof number);
    switch (row->type) {
    case MORAY_OPTION_INT:
    case MORAY_OPTION_REAL:
        snprintf(text, MORAY_SHOWN_SIZE, "%s", number);
        return;
    case MORAY_OPTION_BOOL:
        snprintf(text, MORAY_SHOWN_SIZE, "yes or no");
        return;
    case MORAY_OPTION_CHOICE:
        show_choices(row, text, MORAY_SHOWN_SIZE);
        return;
    case MORAY_OPTION_TEXT:
        snprintf(text, MORAY_SHOWN_SIZE, "a text of 1 to %zu bytes", row->size - 1);
        return;
    case MORAY_OPTION_RUN:
        snprintf(text, MORAY_SHOWN_SIZE, "the folder of a run, with a run.ini");
        return;
    case MORAY_OPTION_IPOPT:
    case MORAY_OPTION_INI:
        snprintf(text, MORAY_SHOWN_SIZE, "the path of a file");
        return;
    case MORAY_OPTION_LIMIT:
        snprintf(text, MORAY_SHOWN_SIZE, "none or %s", number);
        return;
    case MORAY_OPTION_RANGE:
        snprintf(text, MORAY_SHOWN_SIZE, "LOW:HIGH or one value, LOW <= HIGH, each none or %s", number);
        return;
    case MORAY_OPTION_PAIR:
        snprintf(text, MORAY_SHOWN_SIZE, "X,Y, each %s", number);
        return;
    case MORAY_OPTION_LIST:
        snprintf(text, MORAY_SHOWN_SIZE, "at most %zu numbers by commas, k*X for k alike, each %s",
                 row->size / sizeof(double), number);
        return;
    }
}

static const char *show_end(double value, double scale, char text[32])
{
    if (isfinite(value))
        snprintf(text, 32, "%.10g", value / scale);
    else
        snprintf(text, 32, "none");
    return text;
}

static bool show_reals(const moray_option *row, const void *at, char text[MORAY_SHOWN_SIZE])
{
    double value[2] = {0, 0};
    char first[32], second[32];
    memcpy(value, at, row->size);
    if (isnan(value[0]) || isnan(value[1]))
        return false;
    show_end(value[0], moray_option_scale(row), first);
    show_end(value[1], moray_option_scale(row), second);
    if (row->type == MORAY_OPTION_REAL || row->type == MORAY_OPTION_LIMIT)
        snprintf(text, MORAY_SHOWN_SIZE, "%s", first);
    else
        snprintf(text, MORAY_SHOWN_SIZE, "%s%c%s", first, row->type == MORAY_OPTION_RANGE ? ':' : ',', second);
    return true;
}

bool moray_option_default(const moray_option *row, const void *settings, char text[MORAY_SHOWN_SIZE])
{
    const char *at = (const char *)settings + row->offset;
    double least, most;
    int whole;
    bool yes;
    moray_option_bounds(row, &least, &most);
    switch (row->type) {
    case MORAY_OPTION_INT:
    case MORAY_OPTION_CHOICE:
        memcpy(&whole, at, sizeof whole);
        if (row->type == MORAY_OPTION_INT && whole < least)
            snprintf(text, MORAY_SHOWN_SIZE, "by the program");
        else if (row->type == MORAY_OPTION_INT)
            snprintf(text, MORAY_SHOWN_SIZE, "%d", whole);
        else if (whole < 0)
            return false;
        else
            snprintf(text, MORAY_SHOWN_SIZE, "%.*s", name_length(row->choices[whole]), row->choices[whole]);
        return true;
    case MORAY_OPTION_BOOL:
        memcpy(&yes, at, sizeof yes);
        snprintf(text, MORAY_SHOWN_SIZE, yes ? "yes" : "no");
        return true;
    case MORAY_OPTION_TEXT:
    case MORAY_OPTION_RUN:
        snprintf(text, MORAY_SHOWN_SIZE, "%s", at);
        return text[0] != 0;
    case MORAY_OPTION_REAL:
    case MORAY_OPTION_LIMIT:
    case MORAY_OPTION_RANGE:
    case MORAY_OPTION_PAIR:
        return show_reals(row, at, text);
    case MORAY_OPTION_LIST:
    case MORAY_OPTION_IPOPT:
    case MORAY_OPTION_INI:
        break;
    }
    return false;
}
