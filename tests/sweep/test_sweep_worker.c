// SPDX-License-Identifier: MIT
//
// One point in a process of its own: what it is told, what it leaves, and what is made of how it ended.
#define _GNU_SOURCE // mkdtemp
#include "tap.h"

#include <signal.h>
#include <string.h>
#include <sys/resource.h>
#include <time.h>
#include <unistd.h>

#include "moray/parallel.h"
#include "sweep/sweep.h"

typedef struct ending {
    const char *summary, *says; // on standard error
    moray_status status;
    int signal, exit; // 0: none
    bool sleeps;
    const char *reason;
    moray_code code;
    bool killed;
} ending;

static moray_status act(const moray_sweep_point *point, FILE *summary, void *self)
{
    const ending *e = self;
    (void)point;
    fputs(e->summary, summary);
    fflush(summary);
    fputs(e->says, stderr);
    if (e->sleeps)
        sleep(60);
    if (e->signal)
        raise(e->signal);
    if (e->exit)
        _exit(e->exit);
    return e->status;
}

static const moray_sweep_axis axes[] = {{.key = "x", .value = (const double[]){-1, 0, 0.1}, .n = 3},
                                        {.key = "w", .word = (const char *const[]){"l", "r"}, .n = 2}};
static moray_sweep_spec spec = {.file = "own.nc", .axis = axes, .axes = 2};
static struct grid grid;

static void until_ended(struct worker *worker)
{
    bool ended = false;
    while (!ended) {
        CHECK_OK(moray_worker_read(worker, &ended), "is heard");
        nanosleep(&(struct timespec){.tv_nsec = 1000000}, NULL);
    }
}

static void test_endings(void)
{
    const ending endings[] = {
        {"{\"a\": 1}", "chatter\n", {0}, 0, 0, false, "", MORAY_OK, false},
        {"", "chatter\n", {0}, 0, 0, false, "it left no summary", MORAY_NOT_SOLVED, false},
        {"", "chatter\n", moray_error(MORAY_NUMERIC, "bad luck"), 0, 0, false, "bad luck", MORAY_NUMERIC, false},
        {"", "first\nlast line \n\n", {.code = MORAY_INPUT}, 0, 0, false, "last line", MORAY_INPUT, false},
        {"", "one line", {.code = MORAY_INPUT}, 0, 0, false, "one line", MORAY_INPUT, false},
        {"", "", {.code = MORAY_MEMORY}, 0, 0, false, moray_code_text(MORAY_MEMORY), MORAY_MEMORY, false},
        {"", "", {0}, 0, MORAY_INTERRUPTED, false, moray_code_text(MORAY_INTERRUPTED), MORAY_INTERRUPTED, false},
        {"", "", {0}, 0, MORAY_INTERRUPTED + 1, false, moray_code_text(MORAY_NOT_SOLVED), MORAY_NOT_SOLVED, false},
        {"",
         "",
         {0},
         SIGUSR1,
         0,
         false,
         "its process was ended by signal 10 (User defined signal 1)",
         MORAY_NOT_SOLVED,
         false},
        {"", "a\nb\n", {0}, SIGKILL, 0, false, "its process was ended by signal 9 (Killed): b", MORAY_NOT_SOLVED, true},
        {"", "", {0}, SIGTERM, 0, false, "its process was ended by signal 15 (Terminated)", MORAY_NOT_SOLVED, true},
        {"{\"a\": 1}", "", {0}, 0, 0, true, "took longer than 0.2 s", MORAY_NOT_SOLVED, false}};
    for (unsigned k = 0; k < sizeof endings / sizeof *endings; k++) {
        struct worker worker = {0};
        struct record record;
        ending e = endings[k];
        const struct task task = {.point = 3, .start = -1, .round = 2, .start_round = 1};
        spec.solve = act, spec.self = &e;
        spec.point_seconds = e.sleeps ? 0.2 : 0;
        const double begun = moray_clock();
        CHECK_OK(moray_worker_begin(&worker, &grid, &task), "a point");
        until_ended(&worker);
        CHECK(moray_worker_was_killed(&worker) == e.killed && worker.late == e.sleeps, "killed or not: %s", e.reason);
        CHECK_OK(moray_worker_record(&worker, &grid, &record), "its record");
        CHECK(record.code == e.code && strcmp(record.reason, e.reason) == 0, "its reason: %s", record.reason);
        CHECK(!record.found == !*e.summary && (!record.found || strcmp(record.found, "{\"a\":1}") == 0),
              "and what it found");
        CHECK(record.task.point == 3 && record.task.start == -1 && record.task.round == 2 &&
                  record.task.start_round == 1,
              "of its task");
        CHECK(record.seconds > 0 && record.seconds <= moray_clock() - begun && (!e.sleeps || record.seconds > 0.2),
              "in %g s", record.seconds);
        CHECK(worker.pid == 0 && !worker.text[0] && !worker.text[1] && !worker.late, "then it is idle");
        moray_record_free(&record);
    }
    spec.point_seconds = 0;
}

static moray_status tell(const moray_sweep_point *point, FILE *summary, void *self)
{
    struct rlimit memory;
    char c;
    (void)self;
    getrlimit(RLIMIT_AS, &memory);
    const bool alone = getpgrp() == getpid() && read(STDIN_FILENO, &c, 1) == 0;
    printf("nothing of this\n");
    fprintf(
        summary, "{\"index\":%ld,\"n\":%d,\"x\":\"%s %s %g\",\"w\":\"%s %s %g\",\"guess\":\"%s\",\"solution\":\"%s\",",
        point->index, point->n, point->setting[0].key, point->setting[0].value, point->value[0], point->setting[1].key,
        point->setting[1].value, point->value[1], point->guess ? point->guess : "none", point->solution);
    fprintf(summary, "\"alone\":%d,\"megabytes\":%g}", alone, (double)memory.rlim_cur / 1048576);
    raise(SIGINT); // which is for the parent to answer
    return moray_ok();
}

static void test_told(void)
{
    static const char *const wanted[] = {"{\"index\":5,\"n\":2,\"x\":\"x 0.1 0.1\",\"w\":\"w r nan\","
                                         "\"guess\":\"own.nc.solutions/4.3\",\"solution\":\"own.nc.solutions/5.2\","
                                         "\"alone\":1,\"megabytes\":3000}",
                                         "{\"index\":0,\"n\":2,\"x\":\"x -1 -1\",\"w\":\"w l nan\",\"guess\":\"none\","
                                         "\"solution\":\"own.nc.solutions/0.2\",\"alone\":1,\"megabytes\":3000}"};
    const struct task tasks[] = {{5, 4, 2, 3}, {0, -1, 2, 3}, {0, 0, 2, 0}};
    spec.solve = tell;
    spec.point_megabytes = 3000;
    for (int k = 0; k < 3 && tap_thorough(); k++) { // sanitizers need all of the address space
        struct worker worker = {0};
        struct record record;
        CHECK_OK(moray_worker_begin(&worker, &grid, &tasks[k]), "a point");
        until_ended(&worker);
        CHECK_OK(moray_worker_record(&worker, &grid, &record), "its record");
        CHECK(record.found && (k < 2 ? strcmp(record.found, wanted[k]) == 0
                                     : strstr(record.found, "\"guess\":\"own.nc.solutions/0.0\"") != NULL),
              "what it is told: %s", record.found);
        moray_record_free(&record);
    }
    spec.point_megabytes = 0;
}

static moray_status talk(const moray_sweep_point *point, FILE *summary, void *self)
{
    (void)point, (void)self;
    fputs("{\"a\":[0", summary);
    for (int k = 1; k < 20000; k++)
        fprintf(summary, ",%d", k);
    fputs("]}", summary);
    for (int k = 0; k < 3000; k++)
        fprintf(stderr, "%d.", k);
    return moray_ok();
}

// All of a long summary, and the end of what it says besides.
static void test_long(void)
{
    struct worker worker = {0};
    struct record record;
    char said[16000] = "";
    int n = 0;
    for (int k = 0; k < 3000; k++)
        n += snprintf(said + n, sizeof said - (size_t)n, "%d.", k);
    spec.solve = talk;
    CHECK_OK(moray_worker_begin(&worker, &grid, &(const struct task){.point = 1, .start = -1}), "a point");
    until_ended(&worker);
    CHECK(worker.length[1] == 4096 && strcmp(worker.text[1], said + n - 4096) == 0, "the last %zu characters",
          worker.length[1]);
    CHECK(worker.length[0] == strlen(worker.text[0]) && strlen(worker.text[0]) > 100000, "and all of its summary");
    CHECK_OK(moray_worker_record(&worker, &grid, &record), "its record");
    CHECK(record.found && strcmp(strrchr(record.found, ','), ",19999]}") == 0, "to its end");
    moray_record_free(&record);
}

static moray_status flood(const moray_sweep_point *point, FILE *summary, void *self)
{
    (void)point;
    for (long k = 0; k < *(const long *)self; k++)
        fputc('1', summary);
    return moray_ok();
}

// Of a summary no more than 16 megabytes: a piece that goes beyond is left out, of which a pipe makes what it likes.
static void test_too_long(void)
{
    const long most = 1L << 24;
    for (long size = most; size <= most + 1; size++) {
        struct worker worker = {0};
        long length = size;
        spec.solve = flood, spec.self = &length;
        CHECK_OK(moray_worker_begin(&worker, &grid, &(const struct task){.point = 1, .start = -1}), "a point");
        until_ended(&worker);
        CHECK(size == most ? worker.length[0] == (size_t)most
                           : worker.length[0] <= (size_t)most && worker.length[0] >= (size_t)(most - (1 << 14)),
              "%ld bytes are kept as %zu", size, worker.length[0]);
        moray_worker_kill(&worker);
    }
}

// Once begun again it is killed time and again.
static void test_again(void)
{
    struct worker worker = {0};
    struct record record;
    ending e = {.summary = "", .says = "out", .signal = SIGKILL};
    spec.solve = act, spec.self = &e;
    CHECK_OK(moray_worker_begin(&worker, &grid, &(const struct task){.point = 4, .start = -1, .round = 1}), "a point");
    for (int k = 1; k <= 2; k++) {
        until_ended(&worker);
        CHECK_OK(moray_worker_again(&worker, &grid), "again");
        CHECK(worker.killed == k && worker.task.point == 4 && worker.task.round == 1 && worker.pid > 0, "the same");
    }
    until_ended(&worker);
    CHECK_OK(moray_worker_record(&worker, &grid, &record), "its record");
    CHECK(strcmp(record.reason, "its process was ended by signal 9 (Killed), time and again: out") == 0, "%s",
          record.reason);
    moray_record_free(&record);
    e.signal = 0, e.sleeps = true;
    CHECK_OK(moray_worker_begin(&worker, &grid, &(const struct task){.point = 4, .start = -1}), "one that sleeps");
    const pid_t pid = worker.pid;
    moray_worker_kill(&worker);
    CHECK(worker.pid == 0 && kill(pid, 0) != 0, "is killed, and gone");
}

static moray_status die(const moray_sweep_point *point, FILE *summary, void *self)
{
    (void)point, (void)summary, (void)self;
    FILE *file = fopen("deaths", "a");
    fputc('x', file);
    fclose(file);
    raise(SIGKILL);
    return moray_ok();
}

// What is killed each time is tried three times.
static void test_killed(void)
{
    struct crew crew;
    struct record record;
    bool found = false;
    char deaths[9] = "";
    spec.solve = die, spec.jobs = 1;
    CHECK_OK(moray_crew_new(&crew, &grid), "a crew");
    CHECK_OK(moray_crew_begin(&crew, &(const struct task){.point = 1, .start = -1}), "a point");
    CHECK_OK(moray_crew_wait(&crew, 50, &record, &found), "waiting");
    FILE *file = fopen("deaths", "r");
    CHECK(found && file && fgets(deaths, sizeof deaths, file) && strcmp(deaths, "xxx") == 0, "dies: %s", deaths);
    CHECK(found && strstr(record.reason, "time and again"), "time and again");
    if (file)
        fclose(file);
    if (found)
        moray_record_free(&record);
    moray_crew_free(&crew);
}

// Processes of this machine: as many as asked, busy and idle; an idle crew sleeps for its time, one whose point is late
// no longer than that.
static void test_crew(void)
{
    struct crew crew;
    struct record record;
    bool found = false;
    ending e = {.summary = "{}", .says = "", .sleeps = true};
    spec.solve = act, spec.self = &e;
    spec.jobs = 0;
    CHECK_OK(moray_crew_new(&crew, &grid), "a crew");
    CHECK(crew.n_workers == moray_processors() && crew.ranks == 1, "of all processors");
    moray_crew_free(&crew);
    spec.jobs = 2, spec.point_seconds = 0.2;
    CHECK_OK(moray_crew_new(&crew, &grid), "a crew");
    CHECK(crew.n_workers == 2 && moray_crew_silence(&crew) == 30, "of two");
    double begun = moray_clock();
    moray_crew_sleep(&crew, 0.05);
    CHECK(moray_clock() - begun > 0.045 && moray_clock() - begun < 20, "sleeps as long as it is to");
    CHECK_OK(moray_crew_begin(&crew, &(const struct task){.point = 1, .start = -1}), "a point");
    CHECK(moray_crew_idle(&crew), "leaves one idle");
    CHECK_OK(moray_crew_begin(&crew, &(const struct task){.point = 2, .start = -1}), "another");
    CHECK(!moray_crew_idle(&crew), "leaves none");
    begun = moray_clock();
    CHECK_OK(moray_crew_wait(&crew, 0.02, &record, &found), "waiting a little");
    CHECK(!found && moray_clock() - begun >= 0.02, "for nothing");
    CHECK_OK(moray_crew_wait(&crew, 50, &record, &found), "waiting for long");
    CHECK(found && record.task.point == 1 && moray_clock() - begun < 30, "no longer than until one is late");
    moray_record_free(&record);
    CHECK(moray_crew_idle(&crew), "then one is idle");
    moray_crew_free(&crew);
    CHECK(!crew.worker, "the other one is killed");
    spec.silent_seconds = 7;
    CHECK(moray_crew_silence(&(const struct crew){.grid = &grid}) == 7, "a silence that is asked for");
}

int main(void)
{
    setvbuf(stdout, NULL, _IOLBF, 0); // processes that are made here have nothing of it to write
    char folder[] = "/tmp/moray-worker-XXXXXX", command[100];
    if (!mkdtemp(folder) || chdir(folder) != 0)
        return 1;
    alarm(100);
    spec.solve = act;
    CHECK_OK(moray_grid_new(&spec, &grid), "a grid");
    test_endings();
    test_told();
    test_long();
    test_too_long();
    test_again();
    test_killed();
    test_crew();
    snprintf(command, sizeof command, "rm -rf %s", folder);
    CHECK(chdir("/") == 0 && system(command) == 0, "nothing is left behind");
    return tap_done();
}
