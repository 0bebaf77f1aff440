// SPDX-License-Identifier: MIT
#include "options/options.h"

#include <ini.h>
#include <stdlib.h>
#include <string.h>

#include "base/text.h"

enum { LIST_SIZE = 32768 };

typedef struct ini_state {
    moray_text text;
    const moray_options *options;
    void *settings;
    int *set_in_line;         // of each row; 0: not yet
    const moray_option *open; // the list that goes on in the next line; NULL: none
    bool passing;             // that list is one of another program
    char list[LIST_SIZE];     // of it, so far
    moray_ipopt_list ipopt;   // what this file has set
    bool words_given;         // before it was read
    bool of_a_run;            // of any program: what this one does not have is passed over
    moray_status status;
} ini_state;

// inih's reader. Takes leading blanks away: inih would join an indented line to the one before.
static char *next_line(char *line, int size, void *self)
{
    ini_state *state = self;
    moray_text *text = &state->text;
    if (moray_failed(state->status) || text->at == text->n)
        return NULL;
    const char *from = text->line[text->at++];
    from += strspn(from, " \t");
    state->passing = state->passing && *from != '[';
    const bool more = (state->open || state->passing) && *from && !strchr(";#\r\n", *from);
    const char *key = !more ? "" : state->open ? state->open->key : "passed", *is = more ? "=" : "";
    if (strlen(key) + strlen(is) + strlen(from) >= (size_t)size) {
        state->status =
            moray_text_error(text, text->at, moray_error(MORAY_INPUT, "longer than %d characters", size - 1));
        return NULL;
    }
    snprintf(line, (size_t)size, "%s%s%s", key, is, from);
    return line;
}

static moray_status set_ipopt(ini_state *state, const char *key, const char *value)
{
    char text[2 * MORAY_IPOPT_SIZE];
    snprintf(text, sizeof text, "ipopt.%s=%s", key, value);
    const moray_option *row = moray_option_find_ipopt(state->options, text);
    if (!row)
        return moray_option_unknown(state->options, key);
    if (moray_ipopt_list_has(&state->ipopt, key))
        return moray_error(MORAY_INPUT, "%.60s is given twice", key);
    MORAY_TRY(moray_ipopt_list_set(&state->ipopt, strchr(text, '.') + 1));
    return moray_option_read(row, key, strchr(text, '.') + 1, state->settings);
}

// [run] of a run.ini: whose it is, and what it did unless the command line says so.
static moray_status set_run(ini_state *state, const char *key, const char *value)
{
    const moray_words *words = state->options->words;
    if (strcmp(key, "program") == 0 && strcmp(value, state->options->program) == 0)
        return moray_ok();
    if (strcmp(key, "program") == 0)
        return moray_error(MORAY_INPUT, "program = %.60s: these are settings of that program, not of %s", value,
                           state->options->program);
    if (strcmp(key, "word") != 0 || !words)
        return moray_error(MORAY_INPUT, "unknown key %.60s of [run]", key);
    if (!moray_word_known(words, value))
        return moray_word_unknown(words, value);
    if (!state->words_given)
        moray_word_mark(words, value, state->settings);
    return moray_ok();
}

static bool ends_with_comma(const char *value)
{
    return *value && value[strlen(value) - 1] == ',';
}

// Whether a key of a run is of no use to this program: options of Ipopt are, where it solves.
static bool is_foreign(const ini_state *state, const char *section, const char *key)
{
    if (strcmp(section, "ipopt") == 0)
        return !moray_option_find_ipopt(state->options, "ipopt.key=value");
    const moray_option *own = moray_option_find(state->options, key);
    return !own || strcmp(section, own->section) != 0;
}

// One line of a list; the last one has no comma behind it.
static moray_status set_list(ini_state *state, const moray_option *row, const char *value)
{
    const size_t length = state->open ? strlen(state->list) : 0, added = strlen(value);
    if (length + added >= sizeof state->list)
        return moray_error(MORAY_INPUT, "%s: longer than %zu characters", row->key, sizeof state->list - 1);
    memcpy(state->list + length, value, added + 1);
    state->open = ends_with_comma(value) ? row : NULL;
    return state->open ? moray_ok() : moray_option_read(row, row->key, state->list, state->settings);
}

static moray_status set_key(ini_state *state, const char *section, const char *key, const char *value)
{
    if (state->of_a_run && (state->passing || is_foreign(state, section, key))) {
        state->passing = ends_with_comma(value);
        return moray_ok();
    }
    if (strcmp(section, "ipopt") == 0)
        return set_ipopt(state, key, value);
    if (strcmp(section, "run") == 0)
        return set_run(state, key, value);
    const moray_option *row = moray_option_find(state->options, key);
    if (!row)
        return moray_option_unknown(state->options, key);
    if (strcmp(section, row->section) != 0)
        return moray_error(MORAY_INPUT, "%s belongs in section [%s], not in [%.60s]", key, row->section, section);
    if (state->open)
        return set_list(state, row, value);
    int *set_in_line = &state->set_in_line[row - state->options->row];
    if (*set_in_line)
        return moray_error(MORAY_INPUT, "%s is given twice, first in line %d", key, *set_in_line);
    *set_in_line = state->text.at;
    if (row->type == MORAY_OPTION_LIST)
        return set_list(state, row, value);
    return moray_option_read(row, key, value, state->settings);
}

// inih's handler; 1 is success.
static int take_pair(void *self, const char *section, const char *key, const char *value)
{
    ini_state *state = self;
    if (moray_failed(state->status))
        return 0;
    const moray_status status = set_key(state, section, key, value);
    if (moray_failed(status))
        state->status = moray_text_error(&state->text, state->text.at, status);
    return !moray_failed(status);
}

// inih goes on after a malformed line and returns the first; the reader stops at the first bad key.
static moray_status parse(ini_state *state)
{
    const int bad_line = ini_parse_stream(next_line, state, take_pair, state);
    const bool malformed = bad_line > 0 && (!moray_failed(state->status) || bad_line < state->text.at);
    if (malformed)
        return moray_text_error(&state->text, bad_line, moray_error(MORAY_INPUT, "neither [section] nor KEY = VALUE"));
    if (!moray_failed(state->status) && bad_line < 0)
        return moray_error(MORAY_MEMORY, "%s: no memory to read it", moray_path_tail(state->text.path));
    if (!moray_failed(state->status) && state->open)
        return moray_text_error(&state->text, state->text.at,
                                moray_error(MORAY_INPUT, "%s: a list ends without a comma", state->open->key));
    return state->status;
}

moray_status moray_ini_read(const moray_options *options, const moray_option *from, const char *given, void *settings)
{
    char what[64], path[MORAY_PATH_SIZE + 16];
    const bool of_a_run = from->type == MORAY_OPTION_RUN;
    snprintf(what, sizeof what, "%s file", from->flag);
    snprintf(path, sizeof path, "%s%s", given, of_a_run ? "/run.ini" : "");
    ini_state state = {.options = options, .settings = settings, .of_a_run = of_a_run, .status = moray_ok()};
    state.words_given = options->words && !moray_failed(moray_words_check(options->words, settings));
    state.set_in_line = calloc((size_t)options->n, sizeof *state.set_in_line);
    moray_status status = state.set_in_line
                              ? moray_text_read(&state.text, path, what)
                              : moray_error(MORAY_MEMORY, "%s: no memory to read it", moray_path_tail(path));
    if (!moray_failed(status))
        status = parse(&state);
    moray_text_free(&state.text);
    free(state.set_in_line);
    return status;
}
