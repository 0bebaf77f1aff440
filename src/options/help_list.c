// SPDX-License-Identifier: MIT
#include "options/options.h"

#include <stdlib.h>
#include <string.h>

// The first names of the choices, by blanks, of what takes a value.
static void print_values(FILE *file, const moray_option *row)
{
    if (row->type == MORAY_OPTION_BOOL)
        fputs("yes no", file);
    for (int i = 0; row->type == MORAY_OPTION_CHOICE && row->choices[i]; i++)
        fprintf(file, "%s%.*s", i > 0 ? " " : "", (int)strcspn(row->choices[i], "|"), row->choices[i]);
}

static void list_flag(FILE *file, const moray_option *row, const void *settings)
{
    char text[MORAY_TEXT_SIZE];
    const bool bare = row->type == MORAY_OPTION_BOOL;
    moray_option_text(row, settings, text);
    fprintf(file, "flag\t%s\t%s\t", row->flag, bare ? "" : moray_option_argument(row));
    if (!bare)
        print_values(file, row);
    fprintf(file, "\t%s\n", text);
}

static void list_key(FILE *file, const moray_option *row, const void *settings)
{
    char text[MORAY_TEXT_SIZE];
    moray_option_text(row, settings, text);
    fprintf(file, "key\t%s\t%s\t%s\t", row->section, row->key, moray_option_argument(row));
    print_values(file, row);
    if (row->flag)
        fprintf(file, "\tas --%s\n", row->flag);
    else
        fprintf(file, "\t%s\n", text);
}

moray_status moray_app_help_list(const moray_program *program, const void *settings, FILE *file)
{
    moray_options options;
    MORAY_TRY(moray_options_new(&options, program));
    fprintf(file, "program\t%s\t%s\n", program->name, program->summary);
    for (int i = 0; program->words && i < program->words->n; i++)
        fprintf(file, "word\t%s\t%s\n", program->words->word[i].name, program->words->word[i].help);
    if (program->words)
        fprintf(file, "word\t%s\tall of these\n", program->words->all);
    for (int i = 0; i < options.n; i++)
        if (options.row[i].flag)
            list_flag(file, &options.row[i], settings);
    for (const moray_fixed_flag *one = moray_fixed_flags; one->flag; one++)
        fprintf(file, "flag\t%s\t%s\t\t%s\n", one->flag, one->argument ? one->argument : "", one->help);
    for (int i = 0; i < options.n; i++)
        if (options.row[i].key)
            list_key(file, &options.row[i], settings);
    for (const char *const *note = moray_help_notes; *note; note++)
        fprintf(file, "note\t%s\n", *note);
    free(options.own);
    if (fflush(file) || ferror(file))
        return moray_error(MORAY_IO, "the list of options cannot be written");
    return moray_ok();
}
