// SPDX-License-Identifier: MIT
//
// Text files, tolerant in form: a byte-order mark, lines that end in LF, CR LF or CR, or the last in nothing.
#ifndef SRC_BASE_TEXT_H
#define SRC_BASE_TEXT_H

#include <stddef.h>

#include "moray/status.h"

typedef struct moray_text {
    const char *path; // borrowed
    char *block;      // the lines, each ended by 0
    char **line;      // [n]
    int n;
    int at; // the line that moray_text_next gave last, from 1; 0 before the first
} moray_text;

// Reads a whole file. `what` it is, as in "robot file". Error: MORAY_IO naming the file; MORAY_INPUT naming the line,
// of more than 100000 bytes or with a NUL byte in it; MORAY_MEMORY. Free with moray_text_free in any case.
moray_status moray_text_read(moray_text *text, const char *path, const char *what);
void moray_text_free(moray_text *text);

// The next line that is neither blank nor a comment behind #; NULL after the last.
char *moray_text_next(moray_text *text);

// The end of a path that is too long for a message.
const char *moray_path_tail(const char *path);

// Ends a text that fills text[size], and had more to say, behind its last whole word, with " ...".
void moray_cut_at_word(char *text, size_t size);

// An error of the same code, its text behind "path:line: ".
moray_status moray_text_error(const moray_text *text, int line, moray_status status);

#endif
