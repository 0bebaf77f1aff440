// SPDX-License-Identifier: MIT
#define _GNU_SOURCE // sched_setaffinity
#include "tap.h"

#include <sched.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <stdint.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

#include "moray/parallel.h"

enum { tasks = 37 };

struct result {
    int task;
    pid_t by;
    double value[5];
};

static void work(int task, void *result, void *self)
{
    struct result *r = result;
    r->task = task;
    r->by = getpid();
    for (int i = 0; i < 5; i++)
        r->value[i] = *(double *)self * sin(task + i);
    usleep(1000);
}

static void die(int task, void *result, void *self)
{
    *(int *)result = task + 1;
    if (getpid() != *(pid_t *)self)
        abort();
    usleep(100000);
}

static bool all_there(const struct result *r, int n)
{
    for (int k = 0; k < n; k++)
        for (int i = 0; i < 5; i++)
            if (r[k].task != k || r[k].value[i] != 3 * sin(k + i))
                return false;
    return true;
}

static int processes(const struct result *r)
{
    int n = 0;
    for (int k = 0; k < tasks; k++) {
        bool seen = false;
        for (int j = 0; j < k; j++)
            seen = seen || r[j].by == r[k].by;
        n += !seen;
    }
    return n;
}

// Each task once, and no other: counted in what the processes share.
static void count(int task, void *result, void *self)
{
    atomic_int *counts = self;
    *(int *)result = 10 * task;
    atomic_fetch_add(&counts[task < 0 || task > tasks ? tasks + 1 : task], 1);
}

static void test_counts(void)
{
    atomic_int *counts = mmap(NULL, 4096, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    for (int jobs = 1; jobs <= 3; jobs += 2) {
        int results[tasks];
        memset(counts, 0, 4096);
        CHECK_OK(moray_parallel(tasks, sizeof *results, results, count, counts, jobs), "counted");
        for (int k = 0; k < tasks + 2; k++)
            CHECK(counts[k] == (k < tasks), "%d jobs: task %d was done %d times", jobs, k, counts[k]);
    }
    munmap(counts, 4096);
}

static void test_processors(void)
{
    cpu_set_t all, one;
    CHECK(sched_getaffinity(0, sizeof all, &all) == 0 && moray_processors() == CPU_COUNT(&all), "%d processors",
          moray_processors());
    int first = 0;
    while (!CPU_ISSET(first, &all))
        first++;
    CPU_ZERO(&one);
    CPU_SET(first, &one);
    CHECK(sched_setaffinity(0, sizeof one, &one) == 0 && moray_processors() == 1, "of which one may be used: %d",
          moray_processors());
    sched_setaffinity(0, sizeof all, &all);
}

// Two tasks of two processes, of which the helper dies once both have begun.
struct pair {
    atomic_int begun, own;
    pid_t parent;
};

static void die_beside(int task, void *result, void *self)
{
    struct pair *pair = self;
    *(int *)result = task;
    atomic_fetch_add(&pair->begun, 1);
    if (getpid() != pair->parent)
        _exit(1);
    pair->own = task;
    while (pair->begun < 2)
        usleep(200);
}

static void test_name(void)
{
    struct pair *pair = mmap(NULL, sizeof *pair, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    int marks[2];
    char said[100];
    pair->parent = getpid();
    const moray_status status = moray_parallel(2, sizeof *marks, marks, die_beside, pair, 2);
    snprintf(said, sizeof said, "the process of task %d of 2 died", pair->own == 0 ? 2 : 1);
    CHECK(status.code == MORAY_NUMERIC && strcmp(status.text, said) == 0, "%s", status.text);
    CHECK(marks[0] == 0 && marks[1] == 1, "what it had written is there: %d, %d", marks[0], marks[1]);
    munmap(pair, sizeof *pair);
}

static void add_to(int task, void *result, void *self)
{
    (void)self;
    *(int *)result += 100 * task;
    usleep(20000);
}

static void ignore(int signal)
{
    (void)signal;
}

// Results begin as they are given, whether children's ends are told or not and signals come while they are waited for.
static void test_begun(void)
{
    const struct itimerval often = {{0, 1000}, {0, 1000}}, never = {{0, 0}, {0, 0}};
    for (int k = 0; k < 3; k++) {
        int results[5];
        for (int i = 0; i < 5; i++)
            results[i] = i + 1;
        sigaction(SIGCHLD, &(struct sigaction){.sa_handler = k == 1 ? SIG_IGN : SIG_DFL}, NULL);
        sigaction(SIGALRM, &(struct sigaction){.sa_handler = ignore}, NULL);
        setitimer(ITIMER_REAL, k == 2 ? &often : &never, NULL);
        CHECK_OK(moray_parallel(5, sizeof *results, results, add_to, NULL, 2), "added");
        setitimer(ITIMER_REAL, &never, NULL);
        for (int i = 0; i < 5; i++)
            CHECK(results[i] == i + 1 + 100 * i, "result %d is %d", i, results[i]);
        CHECK(waitpid(-1, NULL, WNOHANG) < 0, "no process is left");
    }
    sigaction(SIGCHLD, &(struct sigaction){.sa_handler = SIG_DFL}, NULL);
}

static int shared_blocks(void)
{
    char line[500];
    int n = 0;
    FILE *maps = fopen("/proc/self/maps", "r");
    while (maps && fgets(line, sizeof line, maps))
        n += strstr(line, "/dev/zero") != NULL;
    if (maps)
        fclose(maps);
    return n;
}

// What the processes share is given back.
static void test_shared(void)
{
    const int before = shared_blocks();
    for (int k = 0; k < 3; k++) {
        int results[5] = {0};
        CHECK_OK(moray_parallel(5, sizeof *results, results, add_to, NULL, 2), "added");
    }
    CHECK(shared_blocks() == before, "%d blocks more", shared_blocks() - before);
}

// ---- In the background ---------------------------------------------------------------------------------------------

struct meeting {
    atomic_int here, there;
    pid_t parent;
};

// Ends when the other process has come here too.
static void meet(int task, void *result, void *self)
{
    struct meeting *m = self;
    m->there = getpid() != m->parent;
    for (int k = 0; k < 5000 && !m->here; k++)
        usleep(1000);
    *(int *)result += task + 100 * m->here;
}

static void quit(int task, void *result, void *self)
{
    (void)self;
    *(int *)result = task + 7;
    _exit(0);
}

static void double_all(int task, void *result, void *self)
{
    const int *n = self;
    for (int k = 0; k < *n; k++)
        ((double *)result)[k] = 2 * ((double *)result)[k] + task;
    *(int *)self = 0; // here alone
}

static void test_background(void)
{
    struct meeting *m = mmap(NULL, sizeof *m, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    const int blocks = shared_blocks();
    moray_background *one, *other;
    int met = 5, left = 3, n = 400;
    double values[400], doubled[400];
    m->parent = getpid();
    for (int k = 0; k < n; k++)
        values[k] = k + 0.5;
    CHECK_OK(moray_background_begin(&one, sizeof met, &met, meet, m), "begun");
    CHECK_OK(moray_background_begin(&other, sizeof values, values, double_all, &n), "another beside it");
    m->here = 1;
    CHECK_OK(moray_background_end(one, &met), "ended");
    CHECK(m->there == 1 && met == 105, "while this process went on: %d, %d", m->there, met);
    CHECK_OK(moray_background_end(other, doubled), "and the other");
    bool all = true;
    for (int k = 0; k < 400; k++)
        all = all && doubled[k] == 2 * k + 1;
    CHECK(all && values[1] == 1.5 && n == 400, "whose results are there, and nothing else");
    CHECK_OK(moray_background_begin(&one, sizeof left, &left, quit, NULL), "begun");
    const moray_status status = moray_background_end(one, &left);
    CHECK(status.code == MORAY_NUMERIC && strcmp(status.text, "the process of a task in the background died") == 0,
          "a process that ends on its own: %s", status.text);
    CHECK(left == 7, "what it had written is there: %d", left);
    CHECK(waitpid(-1, NULL, WNOHANG) < 0 && shared_blocks() == blocks, "no process and no memory is left");
    munmap(m, sizeof *m);
}

// Where no process can be had.
static void test_alone(void)
{
    const pid_t child = fork();
    if (child == 0) {
        const struct rlimit none = {0, 0};
        moray_background *one;
        int n = 2;
        double values[2] = {1, 2};
        const bool bound = setgid(65534) == 0 && setuid(65534) == 0; // root has no limit
        const bool limited = setrlimit(RLIMIT_NPROC, &none) == 0 && bound;
        bool good = !moray_failed(moray_background_begin(&one, sizeof values, values, double_all, &n));
        good = good && (n == 0 || !limited) && !moray_failed(moray_background_end(one, values));
        _exit(good && values[0] == 2 && values[1] == 4 ? 0 : 1);
    }
    int state = -1;
    waitpid(child, &state, 0);
    CHECK(WIFEXITED(state) && WEXITSTATUS(state) == 0, "without another process the task is done here");
}

static void test_no_memory(void)
{
    moray_background *one = (moray_background *)&one;
    int n = 0;
    double value = 0;
    const moray_status status = moray_background_begin(&one, SIZE_MAX / 4, &value, double_all, &n);
    CHECK(status.code == MORAY_MEMORY && !one && strstr(status.text, "no memory for a task of"), "%s", status.text);
}

int main(void)
{
    test_shared();
    test_background();
    test_alone();
    test_no_memory();
    test_begun();
    test_counts();
    test_processors();
    test_name();
    double factor = 3;
    pid_t self = getpid();
    for (int jobs = 0; jobs <= 4; jobs++) {
        struct result r[tasks];
        memset(r, -1, sizeof r);
        CHECK_OK(moray_parallel(tasks, sizeof *r, r, work, &factor, jobs), "tasks");
        CHECK(all_there(r, tasks), "%d jobs: every result, bit for bit", jobs);
        if (jobs > 0)
            CHECK(processes(r) <= jobs && (jobs < 2 || processes(r) > 1), "%d jobs: %d processes", jobs, processes(r));
    }
    struct result one;
    CHECK_OK(moray_parallel(0, sizeof one, &one, work, &factor, 4), "no task at all");
    CHECK_OK(moray_parallel(1, sizeof one, &one, work, &factor, 4), "one task");
    CHECK(one.by == self && all_there(&one, 1), "one task stays in this process");
    CHECK(moray_processors() >= 1, "%d processors", moray_processors());
    int marks[8];
    const moray_status status = moray_parallel(8, sizeof *marks, marks, die, &self, 3);
    CHECK(status.code == MORAY_NUMERIC, "a process that dies is an error: %s", status.text);
    return tap_done();
}
