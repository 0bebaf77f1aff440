// SPDX-License-Identifier: MIT
#include "tap.h"

#include <stdlib.h>
#include <string.h>
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

int main(void)
{
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
