// SPDX-License-Identifier: MIT
#include "options/options.h"

#include <ctype.h>
#include <errno.h>
#include <ini.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

typedef struct ini_state {
    FILE *file;
    const char *path;
    int line;
    const moray_options *options;
    void *settings;
    int *set_in_line; // of each row; 0: not yet
    moray_status status;
} ini_state;

// The end of a path that is too long for a message.
static const char *tail(const char *path)
{
    enum { shown = 100 };
    const size_t length = strlen(path);
    return length > shown ? path + length - shown : path;
}

// inih's reader. Counts lines for the messages, and takes leading blanks away: inih would join an indented line to the
// one before.
static char *next_line(char *line, int size, void *self)
{
    ini_state *state = self;
    if (moray_failed(state->status) || !fgets(line, size, state->file))
        return NULL;
    state->line++;
    const size_t length = strlen(line);
    if (length == 0 || (line[length - 1] != '\n' && !feof(state->file))) {
        state->status = moray_error(MORAY_INPUT, "%s:%d: longer than %d characters, or not text", tail(state->path),
                                    state->line, size - 2);
        return NULL;
    }
    const size_t blanks = strspn(line, " \t");
    memmove(line, line + blanks, length - blanks + 1);
    return line;
}

static moray_status set_key(ini_state *state, const char *section, const char *key, const char *value)
{
    const moray_option *row = moray_option_find(state->options, key);
    if (!row)
        return moray_option_unknown(state->options, key);
    if (strcmp(section, row->section) != 0)
        return moray_error(MORAY_INPUT, "%s belongs in section [%s], not in [%.60s]", key, row->section, section);
    int *set_in_line = &state->set_in_line[row - state->options->row];
    if (*set_in_line)
        return moray_error(MORAY_INPUT, "%s is given twice, first in line %d", key, *set_in_line);
    *set_in_line = state->line;
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
        state->status = moray_error(status.code, "%s:%d: %s", tail(state->path), state->line, status.text);
    return !moray_failed(status);
}

// inih goes on after a malformed line and returns the first; the reader stops at the first bad key.
static moray_status parse(ini_state *state)
{
    const int bad_line = ini_parse_stream(next_line, state, take_pair, state);
    const bool malformed = bad_line > 0 && (!moray_failed(state->status) || bad_line < state->line);
    if (malformed)
        return moray_error(MORAY_INPUT, "%s:%d: neither [section] nor KEY = VALUE", tail(state->path), bad_line);
    if (moray_failed(state->status))
        return state->status;
    if (bad_line < 0)
        return moray_error(MORAY_MEMORY, "%s: no memory to read it", tail(state->path));
    if (ferror(state->file))
        return moray_error(MORAY_IO, "%s: cannot be read: %s", tail(state->path), strerror(errno));
    return moray_ok();
}

moray_status moray_ini_read(const moray_options *options, const char *flag, const char *path, void *settings)
{
    FILE *file = fopen(path, "r");
    if (!file)
        return moray_error(MORAY_IO, "%s file %s: cannot be opened: %s", flag, tail(path), strerror(errno));
    struct stat about;
    moray_status status = moray_ok();
    ini_state state = {.file = file, .path = path, .options = options, .settings = settings, .status = status};
    state.set_in_line = calloc((size_t)options->n, sizeof *state.set_in_line);
    if (!state.set_in_line)
        status = moray_error(MORAY_MEMORY, "%s: no memory to read it", tail(path));
    else if (fstat(fileno(file), &about) == 0 && S_ISDIR(about.st_mode))
        status = moray_error(MORAY_IO, "%s file %s: is a directory, not an INI file", flag, tail(path));
    else
        status = parse(&state);
    free(state.set_in_line);
    fclose(file);
    return status;
}
