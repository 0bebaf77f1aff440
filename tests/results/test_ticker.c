// SPDX-License-Identifier: MIT
//
// Progress on a terminal, one line that is written over; and in a file, a line a minute. The clock is the test's.
#define _GNU_SOURCE
#include "tap.h"

#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include "moray/app/results.h"
#include "moray/clock.h"

static double now = 1000;

double moray_clock(void)
{
    return now;
}

double moray_processor_clock(void)
{
    return now;
}

// ---- A file --------------------------------------------------------------------------------------------------------

static char *text;
static size_t size;

// Whether this is what has been written since the last time.
static bool wrote(FILE *stream, const char *want)
{
    static size_t before;
    fflush(stream);
    const bool same = size - before == strlen(want) && strncmp(text + before, want, strlen(want)) == 0;
    if (!same)
        printf("# got \"%s\"\n", text + before);
    before = size;
    return same;
}

static void test_file(void)
{
    FILE *stream = open_memstream(&text, &size);
    const moray_ticker ticker = moray_ticker_start(stream, false), quiet = moray_ticker_start(stream, true);
    now += 59.9;
    moray_ticker_show(&ticker, "step %d", 1);
    CHECK(wrote(stream, ""), "nothing in the first minute");
    now += 0.2;
    moray_ticker_show(&quiet, "step %d", 1);
    CHECK(wrote(stream, ""), "nothing where all is to be quiet");
    moray_ticker_show(&ticker, "step %d", 2);
    CHECK(wrote(stream, "1 min: step 2\n"), "then a line");
    now += 59.8;
    moray_ticker_count(&ticker, 3, 10, "x");
    CHECK(wrote(stream, ""), "the next a minute later");
    now = 1000 + 600;
    moray_ticker_count(&ticker, 3, 10, "job %c", 'x');
    CHECK(wrote(stream, "10 min: job x, 4 of 10, some 23 min left\n"), "600 s for 3, so 1400 s for 7");
    now = 1000 + 660;
    moray_ticker_count(&ticker, 0, 10, "y");
    CHECK(wrote(stream, "11 min: y, 1 of 10\n"), "nothing is known before the first is done");
    now = 1000 + 720;
    moray_ticker_count(&ticker, 12, 13, "z");
    CHECK(wrote(stream, "12 min: z, 13 of 13, some 1 min left\n"), "a minute");
    now = 1000 + 780;
    moray_ticker_count(&ticker, 14, 15, "z");
    CHECK(wrote(stream, "13 min: z, 15 of 15, less than a minute left\n"), "and less");
    now = 1000 + 840;
    char line[500], want[500];
    memset(line, 'a', sizeof line - 1);
    line[sizeof line - 1] = 0;
    moray_ticker_count(&ticker, 2, 9, "%s", line);
    snprintf(want, sizeof want, "14 min: %.399s\n", line);
    CHECK(wrote(stream, want), "a long one is cut");
    moray_ticker_note(&ticker, "note");
    moray_ticker_end(&ticker);
    now += 100;
    moray_ticker_count(&quiet, 2, 9, "c");
    CHECK(wrote(stream, ""), "no notes, and nothing to clear");
    fclose(stream);
    free(text);
}

// ---- A terminal ----------------------------------------------------------------------------------------------------

static bool shows(int master, FILE *stream, const char *want)
{
    char got[1000] = "";
    fflush(stream);
    const ssize_t n = read(master, got, sizeof got - 1);
    const bool same = n >= 0 ? strcmp(got, want) == 0 : !*want;
    if (!same)
        printf("# got \"%s\"\n", got);
    return same;
}

static void test_terminal(void)
{
    const int master = posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK);
    const bool ready = master >= 0 && grantpt(master) == 0 && unlockpt(master) == 0;
    const int terminal = ready ? open(ptsname(master), O_RDWR | O_NOCTTY) : -1; // not that of this process
    FILE *stream = terminal >= 0 ? fdopen(terminal, "r+") : NULL;
    struct termios raw;
    if (!CHECK(stream && tcgetattr(fileno(stream), &raw) == 0, "a terminal"))
        return;
    cfmakeraw(&raw);
    tcsetattr(fileno(stream), TCSANOW, &raw);
    ioctl(fileno(stream), TIOCSWINSZ, &(struct winsize){.ws_row = 24, .ws_col = 11});
    now = 1000;
    const moray_ticker ticker = moray_ticker_start(stream, false), quiet = moray_ticker_start(stream, true);
    moray_ticker_show(&ticker, "step %d", 1);
    CHECK(shows(master, stream, "\rstep 1\033[K"), "a line");
    moray_ticker_show(&ticker, "0123456789abc");
    CHECK(shows(master, stream, "\r0123456789\033[K"), "cut where it would wrap");
    moray_ticker_count(&ticker, 0, 3, "s");
    CHECK(shows(master, stream, "\rs, 1 of 3\033[K"), "a count");
    moray_ticker_note(&ticker, "note %d", 5);
    CHECK(shows(master, stream, "\r\033[Knote 5\n"), "a note, which stays");
    moray_ticker_end(&ticker);
    CHECK(shows(master, stream, "\r\033[K"), "the end, which clears the line");
    moray_ticker_show(&quiet, "s");
    moray_ticker_count(&quiet, 0, 3, "s");
    moray_ticker_note(&quiet, "s");
    moray_ticker_end(&quiet);
    CHECK(shows(master, stream, ""), "nothing where all is to be quiet");
    ioctl(fileno(stream), TIOCSWINSZ, &(struct winsize){.ws_row = 24, .ws_col = 0});
    char line[101], want[110];
    memset(line, 'b', 100);
    line[100] = 0;
    moray_ticker_show(&ticker, "%s", line);
    snprintf(want, sizeof want, "\r%.79s\033[K", line);
    CHECK(shows(master, stream, want), "80 columns where it does not say how many");
    fclose(stream);
    close(master);
}

int main(void)
{
    test_file();
    test_terminal();
    return tap_done();
}
