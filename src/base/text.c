// SPDX-License-Identifier: MIT
#include "base/text.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { longest_line = 100000 };

const char *moray_path_tail(const char *path)
{
    enum { shown = 100 };
    const size_t length = strlen(path);
    return length > shown ? path + length - shown : path;
}

moray_status moray_text_error(const moray_text *text, int line, moray_status status)
{
    return moray_error(status.code, "%s:%d: %s", moray_path_tail(text->path), line, status.text);
}

static moray_status no_memory(const moray_text *text)
{
    return moray_error(MORAY_MEMORY, "%s: no memory to read it", moray_path_tail(text->path));
}

// The bytes of the file and a 0 behind them.
static moray_status read_block(moray_text *text, FILE *file, size_t *size)
{
    size_t room = 0, got;
    *size = 0;
    do {
        if (*size + 1 >= room) {
            room = 2 * room + 4096;
            char *larger = realloc(text->block, room);
            if (!larger)
                return no_memory(text);
            text->block = larger;
        }
        got = fread(text->block + *size, 1, room - *size - 1, file);
        *size += got;
    } while (got > 0);
    text->block[*size] = 0;
    return moray_ok();
}

static char *end_of_line(char *at, const char *end)
{
    while (at < end && *at != '\n' && *at != '\r')
        at++;
    return at;
}

static moray_status add_line(moray_text *text, char *start, const char *end, int *room)
{
    const moray_status long_line = moray_error(MORAY_INPUT, "longer than %d bytes", (int)longest_line),
                       no_text = moray_error(MORAY_INPUT, "a NUL byte: this is no text in one byte a character");
    if (text->n == *room) {
        char **larger = realloc(text->line, (size_t)(2 * *room + 64) * sizeof *larger);
        if (!larger)
            return no_memory(text);
        text->line = larger;
        *room = 2 * *room + 64;
    }
    text->line[text->n++] = start;
    if (end - start > longest_line)
        return moray_text_error(text, text->n, long_line);
    return memchr(start, 0, (size_t)(end - start)) ? moray_text_error(text, text->n, no_text) : moray_ok();
}

static moray_status cut_lines(moray_text *text, size_t size)
{
    char *at = text->block, *end = at + size;
    int room = 0;
    if (size >= 3 && memcmp(at, "\xEF\xBB\xBF", 3) == 0)
        at += 3;
    while (at < end) {
        char *stop = end_of_line(at, end), *next = stop + (stop[0] == '\r' && stop[1] == '\n') + 1;
        MORAY_TRY(add_line(text, at, stop, &room));
        *stop = 0;
        at = next;
    }
    return moray_ok();
}

moray_status moray_text_read(moray_text *text, const char *path, const char *what)
{
    *text = (moray_text){.path = path};
    FILE *file = fopen(path, "r");
    size_t size;
    if (!file)
        return moray_error(MORAY_IO, "%s %s: cannot be opened: %s", what, moray_path_tail(path), strerror(errno));
    moray_status status = read_block(text, file, &size);
    if (!moray_failed(status) && ferror(file))
        status = moray_error(MORAY_IO, "%s %s: cannot be read: %s", what, moray_path_tail(path), strerror(errno));
    fclose(file);
    return moray_failed(status) ? status : cut_lines(text, size);
}

void moray_text_free(moray_text *text)
{
    free(text->block);
    free(text->line);
    *text = (moray_text){0};
}

char *moray_text_next(moray_text *text)
{
    while (text->at < text->n) {
        char *line = text->line[text->at++];
        const char first = line[strspn(line, " \t")];
        if (first && first != '#')
            return line;
    }
    return NULL;
}
