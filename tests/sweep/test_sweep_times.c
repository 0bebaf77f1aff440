// SPDX-License-Identifier: MIT
//
// When a sweep saves its file and writes its page, and what it counts. The clock is the test's: half a second a point,
// and a tick whenever it is asked.
#define _GNU_SOURCE // mkdtemp
#include "tap.h"

#include <signal.h>
#include <string.h>
#include <unistd.h>

#include "sweep/sweep.h"

static double now, tick, used;

double moray_clock(void)
{
    return now += tick;
}

double moray_processor_clock(void)
{
    return used += 0.25;
}

enum { points = 12 };
static int asked, stop_at;
static bool saved[points + 2], paged[points + 2]; // after that many answers
static char page[points + 2][200];                // the line that tells how far it is

static void take_page(int k)
{
    char *text = NULL;
    size_t size = 0;
    FILE *file = fopen("own.html", "r");
    paged[k] = file != NULL;
    page[k][0] = 0;
    if (file && getdelim(&text, &size, 0, file) > 0)
        sscanf(strstr(text, "</h1>\n<p>") ? strstr(text, "</h1>\n<p>") + 9 : "", "%199[^<]", page[k]);
    free(text);
    if (file)
        fclose(file);
    unlink("own.html");
}

static void look(int k)
{
    saved[k] = access("own.nc", F_OK) == 0;
    unlink("own.nc");
    take_page(k);
}

static bool stop(void)
{
    look(asked < points ? asked : points + 1);
    asked++;
    now += 0.5;
    return asked >= stop_at;
}

static moray_status solve(const moray_sweep_point *point, FILE *summary, void *self)
{
    (void)self;
    fprintf(summary, "{\"cost\": %g}", point->value[0]);
    return point->index % 4 == 1 ? moray_error(MORAY_NOT_SOLVED, "not this one") : moray_ok();
}

static const double value[points] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11};
static const moray_sweep_axis axis = {.key = "x", .value = value, .n = points};

static moray_sweep_spec spec_of(void)
{
    asked = 0, stop_at = 100, now = 1000, tick = 0, used = 0;
    return (moray_sweep_spec){.file = "own.nc",
                              .axis = &axis,
                              .axes = 1,
                              .solve = solve,
                              .jobs = 1,
                              .quiet = true,
                              .stop = stop,
                              .page = "own.html",
                              .save_seconds = 2.5};
}

static void remove_all(void)
{
    unlink("own.nc"), unlink("own.nc.journal"), unlink("own.html");
}

// The file when more than 2.5 s are over, the page every 2 s; both at the beginning.
static void test_times(void)
{
    const moray_sweep_spec spec = spec_of();
    moray_sweep_result result;
    CHECK_OK(moray_sweep(&spec, &result), "a sweep");
    CHECK(asked == points, "asked %d times whether to stop", asked);
    for (int k = 0; k < points; k++) {
        CHECK(saved[k] == (k % 6 == 0), "after %d answers the file is written or not", k);
        CHECK(paged[k] == (k % 4 == 0), "and the page");
    }
    CHECK(strcmp(page[0], "0 of 12, 0 failed") == 0, "at first: %s", page[0]);
    CHECK(strcmp(page[4], "4 of 12, 1 failed, 2 a second, 4 s left") == 0, "then: %s", page[4]);
    CHECK(strcmp(page[8], "8 of 12, 2 failed, 2 a second, 2 s left") == 0, "and: %s", page[8]);
    look(points);
    CHECK(saved[points] && paged[points] && strcmp(page[points], "12 of 12, 3 failed") == 0, "at the end: %s",
          page[points]);
    CHECK(result.seconds == 6 && result.busy == 6 && result.saving == 0 && result.handing == 3,
          "%g s, of which points took %g, files %g, answers %g", result.seconds, result.busy, result.saving,
          result.handing);
    CHECK(result.points == points && result.solved == 9 && result.failed == 3 && result.before == 0 &&
              result.warm == 0 && result.held == 0 && result.improved == 0 && result.ranks == 1 && result.jobs == 1 &&
              result.lost == 0,
          "%ld solved, %ld failed", result.solved, result.failed);
    remove_all();
}

// Half a minute where no time is given.
static void test_usual(void)
{
    moray_sweep_spec spec = spec_of();
    moray_sweep_result result;
    spec.save_seconds = 0;
    CHECK_OK(moray_sweep(&spec, &result), "a sweep");
    for (int k = 0; k < points; k++)
        CHECK(saved[k] == (k == 0), "after %d answers the file is written or not", k);
    remove_all();
}

static int count(const char *path, const char *word)
{
    char *text = NULL;
    size_t size = 0;
    int n = 0;
    FILE *file = fopen(path, "r");
    if (file && getdelim(&text, &size, 0, file) > 0)
        for (const char *at = text; (at = strstr(at, word)); at++)
            n++;
    free(text);
    if (file)
        fclose(file);
    return n;
}

// Stopped after four answers, ended, and begun once more: nothing is done twice.
static void test_again(void)
{
    moray_sweep_spec spec = spec_of();
    moray_sweep_result result;
    stop_at = 5;
    moray_status status = moray_sweep(&spec, &result);
    CHECK(status.code == MORAY_INTERRUPTED &&
              strcmp(status.text, "interrupted with 4 of 12 attempts made; the same command goes on") == 0,
          "%s", status.text);
    CHECK(result.solved == 3 && result.failed == 1 && result.seconds == 2.5, "%g s", result.seconds);
    CHECK(access("own.nc", F_OK) == 0 && count("own.nc.journal", "finished") == 0, "with its file, not at its end");
    stop_at = 100;
    spec.stop = NULL;
    for (int again = 0; again < 2; again++) {
        tick = again ? 0.125 : 0;
        CHECK_OK(moray_sweep(&spec, &result), "gone on with");
        CHECK(result.before == (again ? points : 4) && result.solved == 9 && result.failed == 3, "%ld of before",
              result.before);
        CHECK(count("own.nc.journal", "finished") == 1, "which has one end");
    }
    CHECK(result.saving == 2 * 0.125 && result.busy == 0 && result.handing == 0, "saved twice, in %g s", result.saving);
    remove_all();
}

static void test_refused(void)
{
    static const char text[] = "file of a sweep: must be a path of at most 4000 characters";
    moray_sweep_spec spec = spec_of();
    moray_sweep_result result;
    static char path[4002];
    memset(path, 'x', 4001);
    const char *const files[] = {NULL, "", path};
    for (int k = 0; k < 3; k++) {
        spec.file = files[k];
        const moray_status status = moray_sweep(&spec, &result);
        CHECK(status.code == MORAY_INPUT && strcmp(status.text, text) == 0, "%s", status.text);
    }
    path[4000] = 0;
    CHECK(moray_sweep(&spec, &result).code == MORAY_IO, "a path that the system does not take");
    struct sigaction now_is;
    CHECK(sigaction(SIGXFSZ, NULL, &now_is) == 0 && now_is.sa_handler == SIG_DFL, "signals are as before");
}

int main(void)
{
    setvbuf(stdout, NULL, _IOLBF, 0); // processes that are made here have nothing of it to write
    char folder[] = "/tmp/moray-times-XXXXXX", command[100];
    if (!mkdtemp(folder) || chdir(folder) != 0)
        return 1;
    alarm(100);
    test_times();
    test_usual();
    test_again();
    test_refused();
    snprintf(command, sizeof command, "rm -rf %s", folder);
    CHECK(chdir("/") == 0 && system(command) == 0, "nothing is left behind");
    return tap_done();
}
