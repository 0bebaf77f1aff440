// SPDX-License-Identifier: MIT
//
// The line of a record, its journal, what a sweep is told by, and what stands beside its file: each as it stands there.
#define _GNU_SOURCE // mkdtemp
#include "tap.h"

#include <math.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "moray/app/options.h"
#include "sweep/sweep.h"

static char reason_text[] = "too \"far\"", found_text[] = "{\"x\":[1,2]}";
static const struct record sample = {.task = {.point = 12, .start = 7, .round = 3, .start_round = 2},
                                     .code = MORAY_NOT_SOLVED,
                                     .seconds = 0.25,
                                     .reason = reason_text,
                                     .found = found_text};

static bool same_task(const struct task *a, const struct task *b)
{
    return a->point == b->point && a->start == b->start && a->round == b->round && a->start_round == b->start_round;
}

static void test_line(void)
{
    char *line = moray_record_line(&sample), wanted[300];
    snprintf(wanted, sizeof wanted,
             "{\"point\":12,\"round\":3,\"start\":7,\"start_round\":2,\"code\":%d,\"seconds\":0.25,"
             "\"reason\":\"too \\\"far\\\"\",\"found\":{\"x\":[1,2]}}",
             MORAY_NOT_SOLVED);
    CHECK(line && strcmp(line, wanted) == 0, "the line: %s", line);
    struct record back;
    struct task task;
    CHECK_OK(moray_record_read(line, &back), "read again");
    CHECK(same_task(&back.task, &sample.task) && back.code == sample.code && back.seconds == 0.25 &&
              strcmp(back.reason, reason_text) == 0 && strcmp(back.found, found_text) == 0 && back.read,
          "it is the same");
    CHECK(moray_record_task(line, &task) && same_task(&task, &sample.task), "and so is its task alone");
    CHECK(!moray_record_task("{\"point\":12,\"round\":3,\"start\":7}", &task), "of which no part may be missing");
    moray_record_free(&back);
    CHECK(!back.reason && !back.found && !back.read, "freed");
    free(line);
}

// Each of the numbers within its bounds, on them and beyond.
static void test_bounds(void)
{
    static const char *const keys[] = {"point", "round", "start", "start_round", "code", "seconds"};
    static const struct {
        int key;
        const char *value;
        bool good;
    } cases[] = {{0, "0", true},     {0, "-1", false},   {0, "1.5", false},  {0, "1e15", true},   {0, "2e15", false},
                 {1, "0", true},     {1, "-1", false},   {1, "1e9", true},   {1, "2e9", false},   {2, "-1", true},
                 {2, "-2", false},   {2, "1e15", true},  {2, "2e15", false}, {3, "-1", false},    {3, "1e9", true},
                 {3, "2e9", false},  {4, "-1", false},   {4, "0", true},     {4, "\"0\"", false}, {5, "0", true},
                 {5, "-0.1", false}, {5, "null", false}, {4, "0.5", false},  {0, "\"3\"", false}};
    for (unsigned k = 0; k < sizeof cases / sizeof *cases; k++) {
        char text[300] = "{";
        struct record record;
        for (int i = 0; i < 6; i++)
            snprintf(text + strlen(text), sizeof text - strlen(text), "\"%s\":%s,", keys[i],
                     i == cases[k].key ? cases[k].value : "0");
        strcat(text, "\"reason\":\"r\"}");
        const moray_status status = moray_record_read(text, &record);
        CHECK(status.code == (cases[k].good ? MORAY_OK : MORAY_INPUT), "%s of %s", keys[cases[k].key], cases[k].value);
        CHECK(cases[k].good || strncmp(status.text, "no record of a sweep: {\"point\":", 30) == 0, "%s", status.text);
        CHECK(cases[k].good == (record.reason != NULL), "filled or not");
        moray_record_free(&record);
    }
    char last[200];
    for (int more = 0; more < 2; more++) {
        struct record record;
        snprintf(last, sizeof last,
                 "{\"point\":0,\"round\":0,\"start\":0,\"start_round\":0,\"code\":%d,\"seconds\":1,\"reason\":\"\"}",
                 MORAY_INTERRUPTED + more);
        CHECK((moray_record_read(last, &record).code == MORAY_OK) == !more, "the last code is the last");
        moray_record_free(&record);
    }
}

static void add(struct journal *journal, long point, int round, long start, double seconds)
{
    CHECK_OK(moray_journal_add(journal, &(const struct record){.task = {point, start, round, 0}, .seconds = seconds}),
             "an entry");
}

// Entries out of order, more than there is room for at first, found by point, round and start.
static void test_journal(void)
{
    struct journal journal;
    struct record record;
    bool found;
    static const char identity[] = "{\"a\":1}";
    CHECK_OK(moray_journal_open(&journal, "some.journal", identity), "a journal");
    CHECK(journal.made && !journal.finished && journal.n_old == 0, "is new");
    add(&journal, 5, 1, 3, 1), add(&journal, 5, 0, 4, 2), add(&journal, 5, 1, 2, 3), add(&journal, 4, 2, -1, 4);
    for (int k = 0; k < 300; k++)
        add(&journal, 1000 - k, 0, -1, 10 + k);
    moray_journal_close(&journal);
    CHECK(journal.fd == -1 && !journal.old, "closed");
    CHECK_OK(moray_journal_open(&journal, "some.journal", identity), "again");
    CHECK(!journal.made && !journal.finished && journal.n_old == 304, "with what was there: %ld", journal.n_old);
    static const struct {
        struct task task;
        double seconds; // 0: is not there
    } wanted[] = {{{5, 3, 1, 0}, 1},      {{5, 4, 0, 0}, 2},   {{5, 2, 1, 0}, 3}, {{4, -1, 2, 0}, 4},
                  {{5, -1, 1, 0}, 0},     {{4, -1, 1, 0}, 0},  {{6, 3, 1, 0}, 0}, {{1000, -1, 0, 0}, 10},
                  {{701, -1, 0, 0}, 309}, {{700, -1, 0, 0}, 0}};
    for (unsigned k = 0; k < sizeof wanted / sizeof *wanted; k++) {
        CHECK_OK(moray_journal_find(&journal, &wanted[k].task, &record, &found), "a search");
        CHECK(found == (wanted[k].seconds > 0) &&
                  (!found || (record.seconds == wanted[k].seconds && same_task(&record.task, &wanted[k].task))),
              "finds point %ld of round %d from %ld", wanted[k].task.point, wanted[k].task.round, wanted[k].task.start);
        if (found)
            moray_record_free(&record);
    }
    CHECK_OK(moray_journal_add(&journal, NULL), "its end");
    moray_journal_close(&journal);
    CHECK_OK(moray_journal_open(&journal, "some.journal", identity), "once more");
    CHECK(journal.finished && journal.n_old == 304, "it is finished");
    moray_journal_close(&journal);
    const moray_status status = moray_journal_open(&journal, "some.journal", "{\"a\":2}");
    CHECK(status.code == MORAY_INPUT &&
              strcmp(status.text, "some.journal is of another sweep (a: 1 there, 2 here): give this one another file, "
                                  "or remove it") == 0,
          "that of another sweep: %s", status.text);
    CHECK(moray_journal_open(&journal, ".", identity).code == MORAY_IO, "a folder is none");
}

// A journal line by line: FNV-1a of the text in eight digits, and the text.
static void test_checksum(void)
{
    struct journal journal;
    char *text = NULL;
    size_t size = 0;
    CHECK_OK(moray_journal_open(&journal, "sum.journal", "a"), "a journal");
    CHECK_OK(moray_journal_add(&journal, NULL), "finished");
    moray_journal_close(&journal);
    FILE *file = fopen("sum.journal", "r");
    CHECK(file && getdelim(&text, &size, 0, file) > 0, "its text");
    // of "a" as in the table of the authors of the sum
    CHECK(text && strncmp(text, "e40c292c a\n", 11) == 0 && strcmp(text + 19, " finished\n") == 0, "two lines");
    if (file)
        fclose(file);
    free(text);
}

static void test_refusals(void)
{
    static const struct {
        const char *there, *asked, *difference;
    } cases[] = {{"{\"a\":1,\"b\":[1,2]}", "{\"a\":1,\"b\":[1,3]}", " (b: [1,2] there, [1,3] here)"},
                 {"{\"a\":1}", "{\"a\":1,\"b\":2}", " (b: not given there, 2 here)"},
                 {"{\"a\":1,\"b\":2,\"c\":3}", "{\"a\":1,\"c\":3}", " (b: 2 there, not given here)"},
                 {"{\"a\":1,\"b\":2}", "{\"a\":3,\"b\":4}", " (a: 1 there, 3 here)"},
                 {"no object", "{\"a\":3}", ""},
                 {"{\"A\":1}", "{\"a\":1}", " (a: not given there, 1 here)"}};
    for (unsigned k = 0; k < sizeof cases / sizeof *cases; k++) {
        char wanted[300];
        snprintf(wanted, sizeof wanted, "f is of another sweep%s: give this one another file, or remove it",
                 cases[k].difference);
        const moray_status status = moray_identity_refuse("f", cases[k].there, cases[k].asked);
        CHECK(status.code == MORAY_INPUT && strcmp(status.text, wanted) == 0, "%s", status.text);
    }
}

static void test_identity(void)
{
    static const char *const words[] = {"l", "r"};
    const moray_sweep_axis axes[] = {{.key = "x", .value = (const double[]){-1, 2.5}, .n = 2},
                                     {.key = "w", .word = words, .n = 2}};
    static const moray_sweep_range ranges[] = {{"z", -3, 4}, {"y", 5, 6}};
    moray_sweep_spec spec = {.axis = axes, .axes = 2, .configuration = "--links 4", .objective = "cost", .warm = true};
    const struct grid grid = {.spec = &spec};
    char wanted[400], *line = moray_identity_line(&grid);
    const int n = snprintf(wanted, sizeof wanted,
                           "{\"version\":\"%s\",\"configuration\":\"--links 4\",\"objective\":\"cost\",\"warm\":true,"
                           "\"x\":[-1,2.5],\"w\":[\"l\",\"r\"]",
                           moray_version());
    CHECK(line && strncmp(line, wanted, (size_t)n) == 0 && strcmp(line + n, "}") == 0, "values and words: %s", line);
    free(line);
    spec.range = ranges, spec.ranges = 2, spec.draws = 9, spec.seed = 41;
    line = moray_identity_line(&grid);
    CHECK(line && strncmp(line, wanted, (size_t)n) == 0 &&
              strcmp(line + n, ",\"z\":[-3,4],\"y\":[5,6],\"draws\":9,\"seed\":41}") == 0,
          "and draws: %s", line);
    free(line);
}

static void touch(const char *path)
{
    FILE *file = fopen(path, "w");
    CHECK(file != NULL, "%s", path);
    if (file)
        fclose(file);
}

static bool is_there(const char *path)
{
    return access(path, F_OK) == 0;
}

static void test_files(void)
{
    moray_sweep_spec spec = {.file = "own.nc"};
    char path[BESIDE_SIZE];
    moray_files_beside(&spec, "journal", path);
    CHECK(strcmp(path, "own.nc.journal") == 0, "beside it: %s", path);
    CHECK_OK(moray_files_check(&spec), "nothing is there");
    CHECK_OK(moray_files_begin(&spec), "nor needed");
    CHECK(!is_there("own.nc.solutions"), "where no point begins with another");
    touch("own.nc");
    moray_status status = moray_files_check(&spec);
    CHECK(status.code == MORAY_INPUT &&
              strcmp(status.text,
                     "own.nc is there and own.nc.journal, from which it would be gone on with, is not: give "
                     "another file, or remove it") == 0,
          "%s", status.text);
    touch("own.nc.journal");
    CHECK_OK(moray_files_check(&spec), "with a journal it is gone on with");
    spec.warm = true;
    CHECK_OK(moray_files_begin(&spec), "a folder for solutions");
    CHECK_OK(moray_files_begin(&spec), "which may be there");
    moray_solution_path(&spec, 17, 2, path, sizeof path);
    CHECK(strcmp(path, "own.nc.solutions/17.2") == 0, "one of them: %s", path);
    touch(path);
    moray_files_remove_solutions(&spec);
    CHECK(!is_there("own.nc.solutions") && is_there("own.nc") && is_there("own.nc.journal"), "they go, and no more");
    CHECK_OK(moray_files_begin(&spec), "a folder for solutions");
    moray_files_remove_all(&spec);
    CHECK(!is_there("own.nc.solutions") && !is_there("own.nc") && !is_there("own.nc.journal"), "all goes");
    spec.file = "nowhere/own.nc";
    status = moray_files_begin(&spec);
    CHECK(status.code == MORAY_IO && strcmp(status.text, "nowhere/own.nc.solutions: No such file or directory") == 0,
          "%s", status.text);
    spec.file = "/dev/null";
    CHECK(moray_files_check(&spec).code == MORAY_INPUT, "no file");
}

int main(void)
{
    char folder[] = "/tmp/moray-record-XXXXXX", command[100];
    if (!mkdtemp(folder) || chdir(folder) != 0)
        return 1;
    test_line();
    test_bounds();
    test_journal();
    test_checksum();
    test_refusals();
    test_identity();
    test_files();
    snprintf(command, sizeof command, "rm -rf %s", folder);
    CHECK(chdir("/") == 0 && system(command) == 0, "nothing is left behind");
    return tap_done();
}
