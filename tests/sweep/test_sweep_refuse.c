// SPDX-License-Identifier: MIT
//
// What a sweep refuses and what it leaves alone: grids that are none, files of others, journals that are damaged, and
// points that close their pipes, talk without end, or are killed by somebody else.
#define _GNU_SOURCE // mkdtemp
#include "tap.h"

#include <signal.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "moray/app/sweep.h"

static moray_status twice(const moray_sweep_point *point, FILE *summary, void *self)
{
    (void)self;
    fprintf(summary, "{\"twice\": %.17g}\n", 2 * point->value[0]);
    return moray_ok();
}

static const double rising[] = {1, 2, 3, 4};
static const moray_sweep_axis good = {.key = "x", .value = rising, .n = 4};

static moray_sweep_spec spec_of(const char *file, const moray_sweep_axis *axis)
{
    return (moray_sweep_spec){.file = file, .axis = axis, .axes = 1, .solve = twice, .jobs = 2, .quiet = true};
}

static void refused(const moray_sweep_spec *spec, const char *text)
{
    moray_sweep_result result;
    const moray_status status = moray_sweep(spec, &result);
    CHECK(status.code == MORAY_INPUT && strstr(status.text, text), "refused: %s", status.text);
}

static void test_grids(void)
{
    const double twofold[] = {1, 1}, turning[] = {1, 3, 2}, nan[] = {1, NAN}, inf[] = {INFINITY},
                 falling[] = {3, 1, -4};
    static const char *const words[] = {"a", "b", "a"}, *const blank[] = {"a", ""};
    const struct {
        moray_sweep_axis axis;
        const char *text;
    } wrong[] = {{{.key = "x", .value = twofold, .n = 2}, "1 follows 1"},
                 {{.key = "x", .value = turning, .n = 3}, "2 follows 3"},
                 {{.key = "x", .value = nan, .n = 2}, "must be finite"},
                 {{.key = "x", .value = inf, .n = 1}, "must be finite"},
                 {{.key = "x", .value = rising, .n = 0}, "no values"},
                 {{.key = "x", .n = 3}, "no values"},
                 {{.key = "", .value = rising, .n = 2}, "no key"},
                 {{.value = rising, .n = 2}, "no key"},
                 {{.key = "x", .word = words, .n = 3}, "a is there twice"},
                 {{.key = "x", .word = blank, .n = 2}, "is empty"}};
    for (unsigned k = 0; k < sizeof wrong / sizeof *wrong; k++) {
        const moray_sweep_spec spec = spec_of("grid.nc", &wrong[k].axis);
        refused(&spec, wrong[k].text);
    }
    CHECK(access("grid.nc", F_OK) != 0 && access("grid.nc.journal", F_OK) != 0, "and no file is made");
    const moray_sweep_axis turned = {.key = "x", .value = falling, .n = 3},
                           single = {.key = "x", .value = rising, .n = 1};
    moray_sweep_spec spec = spec_of("falling.nc", &turned);
    moray_sweep_result result;
    double *value = NULL;
    long n = 0;
    CHECK_OK(moray_sweep(&spec, &result), "a falling axis");
    CHECK_OK(moray_sweep_numbers("falling.nc", "twice", &value, &n), "its numbers");
    CHECK(n == 3 && value && value[0] == 6 && value[2] == -8, "are in its order");
    free(value);
    spec = spec_of("single.nc", &single);
    CHECK_OK(moray_sweep(&spec, &result), "a single point");
    CHECK(result.solved == 1, "is solved");
    spec.axes = 0;
    refused(&spec, "nothing is varied");
    spec.axes = 1;
    spec.solve = NULL;
    refused(&spec, "without a function");
}

static moray_status alike(const moray_sweep_point *point, FILE *summary, void *self)
{
    (void)point, (void)self;
    fprintf(summary, "{\"c+1\": 1, \"c-1\": 2, \"c 1\": 3, \"c_1\": 4, \"c\": {\"1\": 5}}\n");
    return moray_ok();
}

// Paths that differ only in what no name of the file may have.
static void test_names(void)
{
    static const char *const paths[] = {"c+1", "c-1", "c 1", "c_1", "c.1"};
    moray_sweep_spec spec = spec_of("alike.nc", &good);
    moray_sweep_result result;
    spec.solve = alike;
    CHECK_OK(moray_sweep(&spec, &result), "numbers of like names");
    for (int k = 0; k < 5; k++) {
        double *value = NULL;
        long n = 0;
        CHECK_OK(moray_sweep_numbers("alike.nc", paths[k], &value, &n), paths[k]);
        CHECK(n == 4 && value && value[0] == k + 1 && value[3] == k + 1, "%s is its own", paths[k]);
        free(value);
    }
}

static void write_file(const char *path, const char *text)
{
    FILE *file = fopen(path, "w");
    if (file) {
        fputs(text, file);
        fclose(file);
    }
}

static bool holds(const char *path, const char *text)
{
    char there[200] = "";
    FILE *file = fopen(path, "r");
    if (!file)
        return false;
    there[fread(there, 1, sizeof there - 1, file)] = 0;
    fclose(file);
    return strcmp(there, text) == 0;
}

static void test_files_of_others(void)
{
    moray_sweep_spec spec = spec_of("mine.nc", &good);
    moray_sweep_result result;
    write_file("mine.nc", "my data");
    refused(&spec, "mine.nc.journal");
    CHECK(holds("mine.nc", "my data") && access("mine.nc.journal", F_OK) != 0, "a file of somebody else is left alone");
    spec.file = "notes";
    write_file("notes.journal", "Monday: rain\n");
    refused(&spec, "not the journal of a sweep");
    CHECK(holds("notes.journal", "Monday: rain\n"), "and so are notes with the name of its journal");
    write_file("notes.journal", "Monday");
    refused(&spec, "not the journal of a sweep");
    CHECK(holds("notes.journal", "Monday"), "however short");
    CHECK(mkdir("folder", 0777) == 0, "a folder");
    spec.file = "folder";
    refused(&spec, "not a regular file");
    CHECK(access("folder.journal", F_OK) != 0, "has no journal made for it");

    spec = spec_of("seeds.nc", NULL);
    spec.axes = 0;
    spec.range = &(const moray_sweep_range){"z", 0, 1};
    spec.ranges = 1;
    spec.draws = 3;
    spec.seed = 7;
    CHECK_OK(moray_sweep(&spec, &result), "draws of seed 7");
    spec.seed = 8;
    refused(&spec, "seed: 7 there, 8 here");
    spec.seed = 7;
    spec.draws = 4;
    refused(&spec, "draws: 3 there, 4 here");
    spec.draws = 3;
    spec.configuration = "--model control";
    refused(&spec, "configuration: null there");
}

// Refuses what is not below *self, as it does a key that it has not.
static moray_status accept_below(const moray_sweep_point *point, FILE *summary, void *self)
{
    fprintf(summary, "{}\n");
    return point->value[0] < *(const double *)self ? moray_ok() : moray_error(MORAY_INPUT, "that is too much");
}

// Where every point is refused the sweep is: when there are no more, or after a thousand.
static void test_all_refused(void)
{
    enum { many = 1500 };
    double value[many], least;
    for (int k = 0; k < many; k++)
        value[k] = k;
    moray_sweep_axis axis = {.key = "x", .value = value, .n = 4};
    moray_sweep_spec spec = spec_of("all.nc", &axis);
    moray_sweep_result result;
    spec.solve = accept_below, spec.self = &least;
    least = 0;
    refused(&spec, "every point so far is refused: that is too much");
    CHECK(access("all.nc", F_OK) != 0 && access("all.nc.journal", F_OK) != 0, "and no file is left");
    axis.n = many;
    const moray_status status = moray_sweep(&spec, &result);
    CHECK(status.code == MORAY_INPUT && result.failed == 1000, "of %d points %ld are tried", many, result.failed);
    least = 1;
    axis.n = 4;
    CHECK_OK(moray_sweep(&spec, &result), "one that is accepted makes of the others failures");
    CHECK(result.solved == 1 && result.failed == 3, "%ld solved, %ld failed", result.solved, result.failed);
    remove("all.nc"), remove("all.nc.journal");
    axis.n = many;
    CHECK_OK(moray_sweep(&spec, &result), "however many these are");
    CHECK(result.solved == 1 && result.failed == many - 1, "%ld solved, %ld failed", result.solved, result.failed);
}

// Of the journal's lines one is damaged in its middle, and one at its end is torn.
static void test_damage(void)
{
    moray_sweep_spec spec = spec_of("damaged.nc", &good);
    moray_sweep_result result;
    char text[4000] = "";
    CHECK_OK(moray_sweep(&spec, &result), "a sweep");
    FILE *file = fopen("damaged.nc.journal", "r+");
    CHECK(file != NULL, "its journal");
    if (!file)
        return;
    const size_t size = fread(text, 1, sizeof text - 1, file);
    char *second = strchr(text, '\n') + 20;
    fseek(file, second - text, SEEK_SET);
    fputc('#', file);
    fclose(file);
    CHECK(truncate("damaged.nc.journal", (off_t)size - 25) == 0, "damaged in one record, torn in another");
    CHECK_OK(moray_sweep(&spec, &result), "goes on");
    CHECK(result.before >= 2 && result.before < 4 && result.solved == 4, "with the %ld that are whole", result.before);
    CHECK(truncate("damaged.nc.journal", 30) == 0, "cut in its first line");
    CHECK_OK(moray_sweep(&spec, &result), "it begins anew");
    CHECK(result.before == 0 && result.solved == 4, "with none");
}

static moray_status misbehave(const moray_sweep_point *point, FILE *summary, void *self)
{
    const char *folder = self;
    char path[200];
    if (point->value[0] == 1) { // says that it is done, and is not
        fclose(summary);
        fclose(stderr);
        close(STDERR_FILENO);
        sleep(60);
    }
    while (point->value[0] == 2)
        fprintf(stderr, "and so on, and so on, and so on, and so on, and so on, and so on, and so on\n");
    snprintf(path, sizeof path, "%s/%g", folder, point->value[0]);
    if (point->value[0] == 3 && access(path, F_OK) != 0) { // as by somebody from outside, but once only
        write_file(path, "killed");
        raise(SIGKILL);
    }
    return twice(point, summary, NULL);
}

static void test_processes(void)
{
    static char here[] = ".";
    moray_sweep_spec spec = spec_of("bad.nc", &good);
    moray_sweep_result result;
    double *state = NULL;
    long n = 0;
    spec.solve = misbehave;
    spec.self = here;
    spec.point_seconds = 1;
    const time_t begun = time(NULL);
    CHECK_OK(moray_sweep(&spec, &result), "points that misbehave");
    CHECK(time(NULL) - begun < 30, "are ended");
    CHECK_OK(moray_sweep_numbers("bad.nc", "sweep_state", &state, &n), "their states");
    CHECK(state && state[0] == 2, "one that closed its pipes and sleeps is late");
    CHECK(state && state[1] == 2, "one that never stops talking, too");
    CHECK(state && state[2] == 1, "one that somebody killed is solved by the next attempt");
    CHECK(state && state[3] == 1, "the others are as ever");
    free(state);
}

int main(void)
{
    setvbuf(stdout, NULL, _IOLBF, 0); // processes that are made here have nothing of it to write
    char folder[] = "/tmp/moray-refuse-XXXXXX", command[100];
    if (!mkdtemp(folder) || chdir(folder) != 0)
        return 1;
    test_grids();
    test_names();
    test_files_of_others();
    test_all_refused();
    test_damage();
    test_processes();
    snprintf(command, sizeof command, "rm -rf %s", folder);
    CHECK(chdir("/") == 0 && system(command) == 0, "nothing is left behind");
    return tap_done();
}
