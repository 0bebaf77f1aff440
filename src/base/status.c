// SPDX-License-Identifier: MIT
#include "moray/status.h"

#include <stdarg.h>
#include <stdio.h>

moray_status moray_ok(void)
{
    return (moray_status){.code = MORAY_OK, .text = "ok"};
}

moray_status moray_error(moray_code code, const char *format, ...)
{
    moray_status status = {.code = code};
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(status.text, sizeof status.text, format, arguments);
    va_end(arguments);
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
