// SPDX-License-Identifier: MIT
#include "moray/app/options.h"

#include <errno.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static const char blanks[] = " \t\r\n";

typedef struct {
    char **line;
    int n;
} lines;

static void free_lines(lines *text)
{
    for (int i = 0; i < text->n; i++)
        free(text->line[i]);
    free(text->line);
}

// False when out of memory; what was read is to be freed either way.
static bool read_lines(FILE *file, lines *text)
{
    char *line = NULL;
    size_t size = 0;
    bool room = true;
    while (room && getline(&line, &size, file) >= 0) {
        char **grown = realloc(text->line, (size_t)(text->n + 1) * sizeof *grown);
        text->line = grown ? grown : text->line;
        room = grown && (text->line[text->n] = strdup(line));
        text->n += room;
    }
    free(line);
    return room;
}

static bool is_section(const char *line)
{
    return line[strspn(line, blanks)] == '[';
}

static bool is_section_named(const char *line, const char *name)
{
    const char *inside = line + strspn(line, blanks) + 1;
    return strncmp(inside, name, strlen(name)) == 0 && inside[strlen(name)] == ']';
}

// Whether the line is KEY = VALUE or, where inih takes it for the same, KEY : VALUE.
static bool has_key(const char *line, const char *key)
{
    line += strspn(line, blanks);
    if (strncmp(line, key, strlen(key)) != 0)
        return false;
    line += strlen(key);
    line += strspn(line, blanks);
    return *line == '=' || *line == ':';
}

static bool says_something(const char *line)
{
    const char first = line[strspn(line, blanks)];
    return first && first != ';' && first != '#';
}

typedef struct {
    const moray_ini_entry *entry;
    int n;
    int *line; // where each entry stands; -1: nowhere
    int last;  // last line of the section that says something; -1: there is no such section
} places;

static void find_places(const lines *text, const char *section, places *at)
{
    bool inside = false;
    at->last = -1;
    for (int k = 0; k < at->n; k++)
        at->line[k] = -1;
    for (int i = 0; i < text->n; i++) {
        const char *line = text->line[i];
        if (is_section(line))
            inside = is_section_named(line, section);
        if (!inside || !says_something(line))
            continue;
        at->last = i;
        for (int k = 0; k < at->n; k++)
            if (has_key(line, at->entry[k].key))
                at->line[k] = i;
    }
}

static void write_entries(FILE *file, const places *at, int line)
{
    for (int k = 0; k < at->n; k++)
        if (at->line[k] == line)
            fprintf(file, "%s = %s\n", at->entry[k].key, at->entry[k].value);
}

static bool is_replaced(const places *at, int line)
{
    for (int k = 0; k < at->n; k++)
        if (at->line[k] == line)
            return true;
    return false;
}

static void write_lines(FILE *file, const lines *text, const char *section, const places *at)
{
    for (int i = 0; i < text->n; i++) {
        const char *line = text->line[i];
        if (is_replaced(at, i))
            write_entries(file, at, i);
        else
            fprintf(file, "%s%s", line, line[strlen(line) - 1] == '\n' ? "" : "\n");
        if (i == at->last)
            write_entries(file, at, -1);
    }
    if (at->last < 0) {
        fprintf(file, "%s[%s]\n", text->n ? "\n" : "", section);
        write_entries(file, at, -1);
    }
}

static moray_status cannot(const char *path, const char *what)
{
    const size_t length = strlen(path), shown = 100;
    return moray_error(MORAY_IO, "INI file %s: %s: %s", length > shown ? path + length - shown : path, what,
                       strerror(errno));
}

// With the permissions of the file that it is to replace, or of any new file.
static void permit(int handle, const char *path)
{
    struct stat about;
    const mode_t mask = umask(0);
    umask(mask);
    fchmod(handle, stat(path, &about) == 0 ? about.st_mode & 0777 : 0666 & ~mask);
}

static moray_status replace(const char *path, const lines *text, const char *section, const places *at)
{
    char fresh[PATH_MAX];
    snprintf(fresh, sizeof fresh, "%.*s.XXXXXX", (int)sizeof fresh - 8, path);
    const int handle = mkstemp(fresh);
    FILE *file = handle >= 0 ? fdopen(handle, "w") : NULL;
    if (!file) {
        const moray_status status = cannot(path, "cannot be written");
        if (handle >= 0 && close(handle) == 0)
            unlink(fresh);
        return status;
    }
    permit(handle, path);
    write_lines(file, text, section, at);
    const bool written = !ferror(file) && fflush(file) == 0 && fsync(handle) == 0;
    if (fclose(file) == 0 && written && rename(fresh, path) == 0)
        return moray_ok();
    const moray_status status = cannot(path, "cannot be written");
    unlink(fresh);
    return status;
}

// The lines of a file; none of one that is not there.
static moray_status load(const char *path, lines *text)
{
    FILE *file = fopen(path, "r");
    if (!file)
        return errno == ENOENT ? moray_ok() : cannot(path, "cannot be opened");
    const bool room = read_lines(file, text);
    const moray_status status = !room          ? moray_error(MORAY_MEMORY, "no memory for an INI file")
                                : ferror(file) ? cannot(path, "cannot be read")
                                               : moray_ok();
    fclose(file);
    return status;
}

moray_status moray_ini_set(const char *path, const char *section, const moray_ini_entry *entries, int n)
{
    char *target = realpath(path, NULL); // through links; NULL where there is no file yet
    lines text = {0};
    places at = {.entry = entries, .n = n, .line = calloc((size_t)n + 1, sizeof *at.line)};
    moray_status status = at.line ? moray_ok() : moray_error(MORAY_MEMORY, "no memory for an INI file");
    if (!moray_failed(status))
        status = load(target ? target : path, &text);
    if (!moray_failed(status)) {
        find_places(&text, section, &at);
        status = replace(target ? target : path, &text, section, &at);
    }
    free_lines(&text);
    free(at.line);
    free(target);
    return status;
}
