// SPDX-License-Identifier: MIT
#include "options/options.h"

#include <stdlib.h>
#include <string.h>

#include "base/number.h"

const char *moray_version(void)
{
    return MORAY_VERSION;
}

static moray_status assign(const moray_options *options, const moray_arguments *arguments, void *settings)
{
    for (int i = 0; i < arguments->n; i++) {
        const moray_assignment *item = &arguments->item[i];
        char name[64];
        if (!item->row) {
            moray_word_mark(options->words, item->value, settings);
            continue;
        }
        snprintf(name, sizeof name, "%s%s", item->by_flag ? "--" : "",
                 item->by_flag ? item->row->flag : item->row->key);
        MORAY_TRY(moray_option_read(item->row, name, item->value, settings));
    }
    return moray_ok();
}

// The INI files, of each option for one the last that is given.
static moray_status read_files(const moray_options *options, const moray_arguments *arguments, void *settings)
{
    for (int i = 0; i < arguments->n; i++) {
        const moray_option *row = arguments->item[i].row;
        bool last = row && (row->type == MORAY_OPTION_INI || row->type == MORAY_OPTION_RUN);
        for (int k = i + 1; k < arguments->n; k++)
            last = last && arguments->item[k].row != row;
        if (last)
            MORAY_TRY(moray_ini_read(options, row, arguments->item[i].value, settings));
    }
    return moray_ok();
}

static moray_status finish(const moray_program *program, void *settings)
{
    for (int i = 0; i < program->n_groups; i++)
        if (program->groups[i].table->finish)
            MORAY_TRY(program->groups[i].table->finish((char *)settings + program->groups[i].at));
    return moray_ok();
}

// Finishes the groups, and tells before and after what the settings are.
static moray_status finish_telling(const moray_program *program, const moray_options *options, void *settings,
                                   char **ini)
{
    const moray_common *common = settings;
    size_t size;
    if (!ini || !common->out[0])
        return finish(program, settings);
    bool *given = calloc((size_t)options->n, sizeof *given);
    FILE *file = given ? open_memstream(ini, &size) : NULL;
    moray_status status = moray_error(MORAY_MEMORY, "no memory for the settings");
    if (file) {
        const locale_t before = moray_c_locale_begin();
        moray_options_write(options, settings, file, given);
        status = finish(program, settings);
        moray_options_write_rest(options, settings, file, given);
        moray_c_locale_end(before);
        fclose(file);
    }
    free(given);
    return status;
}

static const moray_option *row_of(const moray_options *options, const moray_idle *idle)
{
    const moray_option *row = moray_option_find(options, idle->key);
    for (int i = 0; i < options->n && !row; i++)
        if (options->row[i].flag && strcmp(options->row[i].flag, idle->key) == 0)
            row = &options->row[i];
    return row;
}

static bool same(const moray_option *row, const char *before, const void *settings)
{
    const char *was = before + row->offset, *is = (const char *)settings + row->offset;
    const bool text = row->type == MORAY_OPTION_TEXT || row->type == MORAY_OPTION_RUN;
    return text ? strcmp(was, is) == 0 : memcmp(was, is, row->size) == 0;
}

// Refuses what the mode chosen leaves idle, unless it is as in `before`, the defaults.
static moray_status refuse_idle(const moray_program *program, const moray_options *options, const char *before,
                                const void *settings)
{
    for (const moray_idle *idle = program->idle; idle && idle->key; idle++) {
        const moray_option *row = row_of(options, idle);
        if (row && !same(row, before, settings) && idle->idle(settings))
            return moray_error(MORAY_INPUT, "%s: %s has no use for it %s", idle->key, program->name, idle->why);
    }
    return moray_ok();
}

// Bytes of the settings that the rows reach to.
static size_t reach_of(const moray_options *options)
{
    size_t reach = 0;
    for (int i = 0; i < options->n; i++)
        if (options->row[i].offset + options->row[i].size > reach)
            reach = options->row[i].offset + options->row[i].size;
    return reach;
}

// The command line is assigned before the files, so that its errors come first, and after them, to override them.
static moray_status fill(const moray_program *program, const moray_options *options, const moray_arguments *arguments,
                         const char *before, void *settings, char **ini)
{
    MORAY_TRY(assign(options, arguments, settings));
    MORAY_TRY(read_files(options, arguments, settings));
    if (options->words)
        MORAY_TRY(moray_words_check(options->words, settings));
    MORAY_TRY(assign(options, arguments, settings));
    MORAY_TRY(refuse_idle(program, options, before, settings));
    return finish_telling(program, options, settings, ini);
}

moray_status moray_app_parse(const moray_program *program, int argc, char **argv, void *settings,
                             moray_request *request)
{
    return moray_options_parse(program, argc, argv, settings, request, NULL);
}

moray_status moray_options_parse(const moray_program *program, int argc, char **argv, void *settings,
                                 moray_request *request, char **ini)
{
    moray_common *common = settings;
    moray_options options;
    moray_arguments arguments;
    MORAY_TRY(moray_options_new(&options, program));
    moray_status status = moray_arguments_read(&arguments, &options, argc, argv);
    *request = arguments.request;
    if (!moray_failed(status) && *request == MORAY_REQUEST_RUN) {
        common->argc = argc;
        common->argv = argv;
        const size_t reach = reach_of(&options);
        char *before = malloc(reach + 1);
        status = before ? moray_ok() : moray_error(MORAY_MEMORY, "no memory for the settings");
        if (before)
            memcpy(before, settings, reach);
        if (!moray_failed(status))
            status = fill(program, &options, &arguments, before, settings, ini);
        free(before);
    }
    free(arguments.item);
    free(options.own);
    return status;
}
