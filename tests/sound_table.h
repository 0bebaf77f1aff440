// SPDX-License-Identifier: MIT
#ifndef TESTS_SOUND_TABLE_H
#define TESTS_SOUND_TABLE_H

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "options/options.h"
#include "tap.h"

static inline size_t option_size(const moray_option *row)
{
    switch (row->type) {
    case MORAY_OPTION_INT:
    case MORAY_OPTION_CHOICE:
        return sizeof(int);
    case MORAY_OPTION_REAL:
    case MORAY_OPTION_LIMIT:
        return sizeof(double);
    case MORAY_OPTION_BOOL:
        return sizeof(bool);
    case MORAY_OPTION_RANGE:
    case MORAY_OPTION_PAIR:
        return 2 * sizeof(double);
    case MORAY_OPTION_INI:
        return 0;
    case MORAY_OPTION_IPOPT:
        return sizeof(moray_ipopt_list);
    case MORAY_OPTION_LIST:
    case MORAY_OPTION_TEXT:
    case MORAY_OPTION_RUN:
        break;
    }
    return row->size;
}

// Every row is sound: its name is its own, its size fits its type, and its default as --help shows it is allowed and
// means the same.
static inline void check_sound_table(const moray_program *program, const void *settings, size_t bytes)
{
    char *again = calloc(1, bytes);
    moray_options options;
    CHECK_OK(moray_options_new(&options, program), "table");
    for (int i = 0; i < options.n; i++) {
        const moray_option *row = &options.row[i];
        char shown[MORAY_SHOWN_SIZE];
        const char *name = row->key ? row->key : row->flag;
        CHECK(row->size == option_size(row) && row->help && (!row->key == !row->section), "%s is well formed", name);
        for (int j = 0; j < i; j++)
            if ((row->key && options.row[j].key && strcmp(row->key, options.row[j].key) == 0) ||
                (row->flag && options.row[j].flag && strcmp(row->flag, options.row[j].flag) == 0))
                CHECK(false, "%s is there twice", name);
        if (!moray_option_default(row, settings, shown))
            continue;
        memset(again, 0, bytes);
        CHECK_OK(moray_option_read(row, name, shown, again), name);
        const char *was = (const char *)settings + row->offset, *is = again + row->offset;
        const bool reals = row->type == MORAY_OPTION_REAL || row->type == MORAY_OPTION_PAIR;
        CHECK(reals ? fabs(*(const double *)was - *(const double *)is) <= 1e-9 * fabs(*(const double *)was)
              : row->type == MORAY_OPTION_TEXT ? strcmp(was, is) == 0
                                               : row->type == MORAY_OPTION_RANGE || memcmp(was, is, row->size) == 0,
              "%s: the default shown as %s reads back", name, shown);
    }
    free(options.own);
    free(again);
}

#endif
