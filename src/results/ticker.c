// SPDX-License-Identifier: MIT
#include "moray/app/results.h"

#include <stdarg.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include "moray/clock.h"

enum { A_MINUTE = 60 };

static _Thread_local double last_line; // where there is no terminal: when one was written

moray_ticker moray_ticker_start(FILE *stream, bool quiet)
{
    const bool terminal = isatty(fileno(stream));
    last_line = moray_clock();
    return (moray_ticker){
        .stream = stream, .live = !quiet && terminal, .plain = !quiet && !terminal, .started = last_line};
}

// One less than the terminal is wide: a line that wraps cannot be rewritten.
static int room(FILE *stream)
{
    struct winsize size;
    if (ioctl(fileno(stream), TIOCGWINSZ, &size) == 0 && size.ws_col > 1)
        return size.ws_col - 1;
    return 79;
}

// A line a minute is enough for a file.
static void show_plain(const moray_ticker *ticker, const char *line)
{
    const double time = moray_clock();
    if (time - last_line < A_MINUTE)
        return;
    last_line = time;
    fprintf(ticker->stream, "%.0f min: %s\n", (time - ticker->started) / A_MINUTE, line);
    fflush(ticker->stream);
}

static void show(const moray_ticker *ticker, const char *line)
{
    if (ticker->live)
        fprintf(ticker->stream, "\r%.*s\033[K", room(ticker->stream), line);
    if (ticker->live)
        fflush(ticker->stream);
    else if (ticker->plain)
        show_plain(ticker, line);
}

void moray_ticker_show(const moray_ticker *ticker, const char *format, ...)
{
    char line[400];
    va_list arguments;
    if (!ticker->live && !ticker->plain)
        return;
    va_start(arguments, format);
    vsnprintf(line, sizeof line, format, arguments);
    va_end(arguments);
    show(ticker, line);
}

void moray_ticker_count(const moray_ticker *ticker, int done, int of, const char *format, ...)
{
    char line[400];
    va_list arguments;
    if (!ticker->live && !ticker->plain)
        return;
    va_start(arguments, format);
    int n = vsnprintf(line, sizeof line, format, arguments);
    va_end(arguments);
    n = n < (int)sizeof line ? n : (int)sizeof line - 1;
    n += snprintf(line + n, sizeof line - (size_t)n, ", %d of %d", done + 1, of);
    if (done > 0 && n < (int)sizeof line) {
        const double left = (moray_clock() - ticker->started) / done * (of - done);
        snprintf(line + n, sizeof line - (size_t)n,
                 left < A_MINUTE ? ", less than a minute left" : ", some %.0f min left", left / A_MINUTE);
    }
    show(ticker, line);
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
