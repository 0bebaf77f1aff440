// SPDX-License-Identifier: MIT
#include "moray/results.h"

#include <stdarg.h>
#include <sys/ioctl.h>
#include <unistd.h>

moray_progress moray_progress_start(FILE *stream, bool quiet)
{
    return (moray_progress){.stream = stream, .live = !quiet && isatty(fileno(stream))};
}

// One less than the terminal is wide: a line that wraps cannot be rewritten.
static int room(FILE *stream)
{
    struct winsize size;
    if (ioctl(fileno(stream), TIOCGWINSZ, &size) == 0 && size.ws_col > 1)
        return size.ws_col - 1;
    return 79;
}

void moray_progress_show(const moray_progress *progress, const char *format, ...)
{
    char line[400];
    va_list arguments;
    if (!progress->live)
        return;
    va_start(arguments, format);
    vsnprintf(line, sizeof line, format, arguments);
    va_end(arguments);
    fprintf(progress->stream, "\r%.*s\033[K", room(progress->stream), line);
    fflush(progress->stream);
}

void moray_progress_end(const moray_progress *progress)
{
    if (!progress->live)
        return;
    fputs("\r\033[K", progress->stream);
    fflush(progress->stream);
}
