// SPDX-License-Identifier: MIT
#include "options/options.h"

#include <ctype.h>
#include <stdlib.h>

const char *moray_version(void)
{
    return MORAY_VERSION;
}

moray_exit moray_exit_of(moray_code code)
{
    switch (code) {
    case MORAY_OK:
        return MORAY_EXIT_SOLVED;
    case MORAY_INPUT:
    case MORAY_IO:
        return MORAY_EXIT_USAGE;
    case MORAY_INTERRUPTED:
        return MORAY_EXIT_INTERRUPTED;
    case MORAY_MEMORY:
    case MORAY_NUMERIC:
    case MORAY_NOT_SOLVED:
        break;
    }
    return MORAY_EXIT_NOT_SOLVED;
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

// The command line is assigned before the file, to know which file, and after it, to override it.
static moray_status fill(const moray_options *options, const moray_arguments *arguments, void *settings)
{
    moray_common *common = settings;
    MORAY_TRY(assign(options, arguments, settings));
    if (options->words)
        MORAY_TRY(moray_words_check(options->words, settings));
    if (common->robot_file[0])
        MORAY_TRY(moray_ini_read(options, common->robot_file, settings));
    MORAY_TRY(assign(options, arguments, settings));
    return moray_common_make_robot(common);
}

moray_status moray_app_parse(const moray_program *program, int argc, char **argv, void *settings,
                             moray_request *request)
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
        status = fill(&options, &arguments, settings);
    }
    free(arguments.item);
    free(options.row);
    return status;
}

static moray_status answer(const moray_program *program, const void *settings, moray_request request)
{
    if (request == MORAY_REQUEST_HELP)
        return moray_app_help(program, settings, stdout);
    if (printf("%s (moray) %s\n", program->name, moray_version()) < 0 || fflush(stdout))
        return moray_error(MORAY_IO, "the version cannot be written");
    return moray_ok();
}

bool moray_app_start(const moray_program *program, int argc, char **argv, void *settings, int *exit_code)
{
    moray_common *common = settings;
    moray_request request;
    moray_status status = moray_app_parse(program, argc, argv, settings, &request);
    if (!moray_failed(status) && request != MORAY_REQUEST_RUN)
        status = answer(program, settings, request);
    else if (!moray_failed(status) && common->out[0])
        status = moray_output_open(&common->output, common->out);
    if (!moray_failed(status) && request == MORAY_REQUEST_RUN)
        return true;
    *exit_code = moray_app_end(program, settings, status);
    return false;
}

int moray_app_end(const moray_program *program, void *settings, moray_status status)
{
    moray_common *common = settings;
    moray_output_free(common->output);
    common->output = NULL;
    if (moray_failed(status)) {
        for (char *c = status.text; *c; c++)
            if (iscntrl((unsigned char)*c))
                *c = '?';
        fprintf(stderr, "%s: %s\n", program->name, status.text);
    }
    return moray_exit_of(status.code);
}
