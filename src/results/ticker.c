// SPDX-License-Identifier: MIT
#include "moray/app/results.h"

#include <stdarg.h>
#include <sys/ioctl.h>
#include <unistd.h>

moray_ticker moray_ticker_start(FILE *stream, bool quiet)
{
    return (moray_ticker){.stream = stream, .live = !quiet && isatty(fileno(stream))};
}

// One less than the terminal is wide: a line that wraps cannot be rewritten.
static int room(FILE *stream)
{
    struct winsize size;
    if (ioctl(fileno(stream), TIOCGWINSZ, &size) == 0 && size.ws_col > 1)
        return size.ws_col - 1;
    return 79;
}

void moray_ticker_show(const moray_ticker *ticker, const char *format, ...)
{
    char line[400];
    va_list arguments;
    if (!ticker->live)
        return;
    va_start(arguments, format);
    vsnprintf(line, sizeof line, format, arguments);
    va_end(arguments);
    fprintf(ticker->stream, "\r%.*s\033[K", room(ticker->stream), line);
    fflush(ticker->stream);
}

void moray_ticker_note(const moray_ticker *ticker, const char *format, ...)
{
    va_list arguments;
    if (!ticker->live)
        return;
    fputs("\r\033[K", ticker->stream);
    va_start(arguments, format);
    vfprintf(ticker->stream, format, arguments);
    va_end(arguments);
    fputc('\n', ticker->stream);
}

void moray_ticker_end(const moray_ticker *ticker)
{
    if (!ticker->live)
        return;
    fputs("\r\033[K", ticker->stream);
    fflush(ticker->stream);
}
