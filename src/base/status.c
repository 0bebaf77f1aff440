// SPDX-License-Identifier: MIT
#include "moray/status.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "base/text.h"

void moray_cut_at_word(char *text, size_t size)
{
    static const char ending[] = " ...";
    size_t end = size - sizeof ending;
    for (size_t k = end; k > size / 2; k--)
        if (text[k] == ' ') {
            end = k;
            break;
        }
    memcpy(text + end, ending, sizeof ending);
}

moray_status moray_ok(void)
{
    return (moray_status){.code = MORAY_OK, .text = "ok"};
}

// What a text quotes may hold anything; it is one line all the same.
static void flatten(char *text)
{
    const char delete = 0x7f;
    for (; *text; text++)
        if (*text >= '\t' && *text <= '\r')
            *text = ' ';
        else if ((*text > 0 && *text < ' ') || *text == delete)
            *text = '?';
}

moray_status moray_error(moray_code code, const char *format, ...)
{
    moray_status status = {.code = code};
    va_list arguments;
    va_start(arguments, format);
    const int length = vsnprintf(status.text, sizeof status.text, format, arguments);
    va_end(arguments);
    flatten(status.text);
    if (length >= (int)sizeof status.text)
        moray_cut_at_word(status.text, sizeof status.text);
    return status;
}

const char *moray_code_text(moray_code code)
{
    static const char *const texts[] = {
#define MORAY_CODE_TEXT(name, text) text,
        MORAY_CODES(MORAY_CODE_TEXT)
#undef MORAY_CODE_TEXT
    };
    return (unsigned)code < sizeof texts / sizeof *texts ? texts[code] : "unknown code";
}
