// SPDX-License-Identifier: MIT
#include "options/options.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>

enum { INDENT = 27, LAST_COLUMN = 79 };

// Words from column `column` on, wrapped to start again at `indent`.
static void print_wrapped(FILE *file, const char *text, int column, int indent)
{
    while (*text) {
        const int word = (int)strcspn(text, " ");
        if (column > indent && column + 1 + word > LAST_COLUMN) {
            fprintf(file, "\n%*s", indent, "");
            column = indent;
        } else if (column > indent) {
            fputc(' ', file);
            column++;
        }
        fwrite(text, 1, (size_t)word, file);
        column += word;
        text += word + (text[word] == ' ');
    }
    fputc('\n', file);
}

static void print_entry(FILE *file, const char *name, const char *text)
{
    const int used = fprintf(file, "  %s", name);
    if (used + 2 > INDENT)
        fprintf(file, "\n%*s", INDENT, "");
    else
        fprintf(file, "%*s", INDENT - used, "");
    print_wrapped(file, text, INDENT, INDENT);
}

const char *moray_option_argument(const moray_option *row)
{
    static const char *const by_type[] = {
        [MORAY_OPTION_LIMIT] = "X|none",   [MORAY_OPTION_INT] = "N",       [MORAY_OPTION_REAL] = "X",
        [MORAY_OPTION_BOOL] = "yes|no",    [MORAY_OPTION_CHOICE] = "NAME", [MORAY_OPTION_TEXT] = "TEXT",
        [MORAY_OPTION_RANGE] = "LOW:HIGH", [MORAY_OPTION_PAIR] = "X,Y",    [MORAY_OPTION_INI] = "FILE",
        [MORAY_OPTION_IPOPT] = "VALUE",    [MORAY_OPTION_LIST] = "X,...",  [MORAY_OPTION_RUN] = "DIR",
    };
    return row->argument ? row->argument : by_type[row->type];
}

// "--flag ARGUMENT" or "key=ARGUMENT".
static void write_name(const moray_option *row, bool flag, char *name, size_t size)
{
    const char *argument = moray_option_argument(row);
    if (flag && row->type == MORAY_OPTION_BOOL)
        snprintf(name, size, "--%s", row->flag);
    else
        snprintf(name, size, flag ? "--%s %s" : "%s=%s", flag ? row->flag : row->key, argument);
}

void moray_option_text(const moray_option *row, const void *settings, char text[MORAY_TEXT_SIZE])
{
    char allowed[MORAY_SHOWN_SIZE] = "", given[MORAY_SHOWN_SIZE] = "";
    if (row->type != MORAY_OPTION_TEXT && row->type != MORAY_OPTION_BOOL && row->type != MORAY_OPTION_INI &&
        row->type != MORAY_OPTION_IPOPT && row->type != MORAY_OPTION_RUN)
        moray_option_allowed(row, allowed);
    const bool shown = row->key && moray_option_default(row, settings, given);
    snprintf(text, MORAY_TEXT_SIZE, "%s%s%s%s%s", row->help, *allowed ? "; " : "", allowed, shown ? "; default " : "",
             shown ? given : "");
}

static void print_row(FILE *file, const moray_option *row, bool flag, const void *settings)
{
    char name[80], text[MORAY_TEXT_SIZE];
    moray_option_text(row, settings, text);
    write_name(row, flag, name, sizeof name);
    print_entry(file, name, text);
}

const moray_fixed_flag moray_fixed_flags[] = {
    {"set", "KEY=VALUE", "set any key of the lists below; may be repeated"},
    {"help", NULL, "show this text"},
    {"version", NULL, "show the version"},
    {0},
};
const char *const moray_help_notes[] = {
    "The INI file overrides the defaults, the command line overrides both.",
    "Exit status: 0 solved and certified, 1 not solved, 2 bad usage or input, 3 certificate failed, 130 interrupted.",
    NULL,
};

static void print_flags(FILE *file, const moray_options *options, const void *settings)
{
    fputs("\nOptions:\n", file);
    for (int i = 0; i < options->n; i++)
        if (options->row[i].flag)
            print_row(file, &options->row[i], true, settings);
    for (const moray_fixed_flag *one = moray_fixed_flags; one->flag; one++) {
        char name[40];
        snprintf(name, sizeof name, "--%s%s%s", one->flag, one->argument ? " " : "",
                 one->argument ? one->argument : "");
        print_entry(file, name, one->help);
    }
}

static bool is_first_of_section(const moray_options *options, int at)
{
    for (int i = 0; i < at; i++)
        if (options->row[i].key && strcmp(options->row[i].section, options->row[at].section) == 0)
            return false;
    return true;
}

static void print_section(FILE *file, const moray_options *options, const void *settings, const char *section)
{
    char name[80], text[80];
    fprintf(file, "\nKeys for --set, in INI files under [%s]:\n", section);
    for (int i = 0; i < options->n; i++) {
        const moray_option *row = &options->row[i];
        if (!row->key || strcmp(row->section, section) != 0)
            continue;
        write_name(row, false, name, sizeof name);
        snprintf(text, sizeof text, "as --%s", row->flag ? row->flag : "");
        if (row->flag)
            print_entry(file, name, text);
        else
            print_row(file, row, false, settings);
    }
}

static void print_noun(FILE *file, const char *noun)
{
    for (; *noun; noun++)
        fputc(toupper((unsigned char)*noun), file);
}

static void print_words(FILE *file, const moray_words *words)
{
    fputc('\n', file);
    print_noun(file, words->noun);
    fputs(" is one or more of:\n", file);
    for (int i = 0; i < words->n; i++)
        print_entry(file, words->word[i].name, words->word[i].help);
    print_entry(file, words->all, "all of these");
}

moray_status moray_app_help(const moray_program *program, const void *settings, FILE *file)
{
    moray_options options;
    MORAY_TRY(moray_options_new(&options, program));
    fprintf(file, "Usage: %s [OPTION]...%s", program->name, program->words ? " " : "\n");
    if (program->words) {
        print_noun(file, program->words->noun);
        fputs("...\n", file);
    }
    print_wrapped(file, program->summary, 0, 0);
    if (program->words)
        print_words(file, program->words);
    print_flags(file, &options, settings);
    for (int i = 0; i < options.n; i++)
        if (options.row[i].key && is_first_of_section(&options, i))
            print_section(file, &options, settings, options.row[i].section);
    fputc('\n', file);
    for (const char *const *note = moray_help_notes; *note; note++)
        print_wrapped(file, *note, 0, 0);
    free(options.own);
    if (fflush(file) || ferror(file))
        return moray_error(MORAY_IO, "the help text cannot be written");
    return moray_ok();
}
