// SPDX-License-Identifier: MIT
//
// The settings of a run as an INI file that repeats it.
#include "options/options.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/number.h"

enum { MOST = 4200 }; // bytes of a value: a path, at most

// Where the quotient, rounded, is not read back as the value, no double beside it is, which is farther off.
void moray_option_show_exactly(const moray_option *row, double value, char text[32])
{
    const double scale = moray_option_scale(row), shown = value / scale;
    if (!isfinite(value)) {
        strcpy(text, "none");
        return;
    }
    for (int digits = 15; digits <= 17; digits++) {
        snprintf(text, 32, "%.*g", digits, shown);
        if (strtod(text, NULL) * scale == value)
            return;
    }
}

static void show_reals(const moray_option *row, const void *at, char text[MOST])
{
    double value[2] = {0, 0};
    char one[32], other[32];
    memcpy(value, at, row->size < sizeof value ? row->size : sizeof value);
    moray_option_show_exactly(row, value[0], one);
    moray_option_show_exactly(row, value[1], other);
    if (row->type == MORAY_OPTION_REAL || row->type == MORAY_OPTION_LIMIT)
        snprintf(text, MOST, "%s", one);
    else
        snprintf(text, MOST, "%s%c%s", one, row->type == MORAY_OPTION_RANGE ? ':' : ',', other);
}

// Whether the text, read as an INI file's value, gives what is there; inih ends a line at 200 bytes and a value at "
// ;".
static bool repeats(const moray_option *row, const char *text, const void *at)
{
    moray_option moved = *row;
    char *copy = calloc(1, row->size);
    moved.offset = 0;
    const bool plain = !strpbrk(text, ";#\n\r\"") && strlen(text) + strlen(row->key) < 190 && *text != ' ' &&
                       (!*text || text[strlen(text) - 1] != ' ');
    const bool words = row->type == MORAY_OPTION_TEXT || row->type == MORAY_OPTION_RUN;
    const bool same = copy && plain && !moray_failed(moray_option_read(&moved, row->key, text, copy)) &&
                      (words ? strcmp(copy, at) == 0 : memcmp(copy, at, row->size) == 0);
    free(copy);
    return same;
}

// The present value; false where there is none that could be given.
static bool show(const moray_option *row, const void *settings, char text[MOST])
{
    const char *at = (const char *)settings + row->offset;
    char shown[MORAY_SHOWN_SIZE];
    switch (row->type) {
    case MORAY_OPTION_REAL:
    case MORAY_OPTION_LIMIT:
    case MORAY_OPTION_RANGE:
    case MORAY_OPTION_PAIR:
        show_reals(row, at, text);
        break;
    case MORAY_OPTION_TEXT:
    case MORAY_OPTION_RUN:
        snprintf(text, MOST, "%s", at);
        break;
    default:
        if (!moray_option_default(row, settings, shown))
            return false;
        snprintf(text, MOST, "%s", shown);
    }
    return repeats(row, text, at);
}

static void write_ipopt(FILE *file, const moray_ipopt_list *list)
{
    if (list->n)
        fputs("\n[ipopt]\n", file);
    for (int i = 0; i < list->n; i++)
        fprintf(file, "%s = %s\n", list->at[i].key, list->at[i].value);
}

// Whether an earlier row is of the same section.
static bool begun(const moray_options *options, int i)
{
    for (int k = 0; k < i; k++)
        if (options->row[k].section && strcmp(options->row[k].section, options->row[i].section) == 0)
            return true;
    return false;
}

static bool has_key(const moray_option *row)
{
    return row->section && row->key && row->type != MORAY_OPTION_IPOPT && row->type != MORAY_OPTION_INI;
}

static void write_section(FILE *file, const moray_options *options, int first, const void *settings, bool *given)
{
    char text[MOST];
    fprintf(file, "\n[%s]\n", options->row[first].section);
    for (int i = first; i < options->n; i++) {
        const moray_option *row = &options->row[i];
        if (!has_key(row) || strcmp(row->section, options->row[first].section) != 0)
            continue;
        const double *list = (const double *)((const char *)settings + row->offset);
        const bool listed = row->type == MORAY_OPTION_LIST;
        given[i] = listed ? moray_list_length(list, 1) > 0 : show(row, settings, text);
        if (given[i] && listed)
            moray_list_write(row, list, file);
        else if (given[i])
            fprintf(file, "%s = %s\n", row->key, text);
        else
            fprintf(file, "; %s: not given\n", row->key);
    }
}

void moray_options_write(const moray_options *options, const void *settings, FILE *file, bool *given)
{
    const bool *marked = options->words ? (const bool *)((const char *)settings + options->words->offset) : NULL;
    fprintf(file, "; The settings of a run; --config with this file repeats it.\n[run]\nprogram = %s\n",
            options->program);
    for (int i = 0; marked && i < options->words->n; i++)
        if (marked[i])
            fprintf(file, "word = %s\n", options->words->word[i].name);
    for (int i = 0; i < options->n; i++)
        if (has_key(&options->row[i]) && !begun(options, i))
            write_section(file, options, i, settings, given);
    for (int i = 0; i < options->n; i++)
        if (options->row[i].type == MORAY_OPTION_IPOPT)
            write_ipopt(file, (const moray_ipopt_list *)((const char *)settings + options->row[i].offset));
}

void moray_options_write_rest(const moray_options *options, const void *settings, FILE *file, const bool *given)
{
    char text[MOST];
    bool headed = false;
    for (int i = 0; i < options->n; i++) {
        const moray_option *row = &options->row[i];
        if (!has_key(row) || given[i] || !show(row, settings, text))
            continue;
        if (!headed)
            fputs("\n; What follows from these:\n", file);
        headed = true;
        fprintf(file, ";   %s = %s\n", row->key, text);
    }
}
