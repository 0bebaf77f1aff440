// SPDX-License-Identifier: MIT
//
// A command line of constant texts, as main would get it.
#ifndef TESTS_ARGUMENTS_H
#define TESTS_ARGUMENTS_H

#include <stdio.h>

typedef struct {
    char text[10][2048];
    char *argv[11];
    int argc;
} command_line;

// Appends a word, of fewer than 2048 characters.
static inline void command_add(command_line *line, const char *word)
{
    snprintf(line->text[line->argc], sizeof *line->text, "%s", word);
    line->argv[line->argc] = line->text[line->argc];
    line->argc++;
}

// NAME and up to `most` words, which a NULL ends.
static inline void command_set(command_line *line, const char *name, const char *const *words, int most)
{
    *line = (command_line){.argc = 0};
    command_add(line, name);
    for (int i = 0; i < most && words[i]; i++)
        command_add(line, words[i]);
}

#endif
