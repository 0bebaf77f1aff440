// SPDX-License-Identifier: MIT
#define _GNU_SOURCE // sched_getaffinity
#include "moray/parallel.h"

#include <errno.h>
#include <sched.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

// What the processes share: whose turn it is, and behind it, for every task, whether it is done, and the results.
typedef struct {
    atomic_int next;
    unsigned char *done;
    char *results;
} table;

typedef struct {
    int n;
    size_t size;
    moray_task_fn *task;
    void *self;
} work;

int moray_processors(void)
{
    cpu_set_t set;
    if (sched_getaffinity(0, sizeof set, &set) == 0)
        return CPU_COUNT(&set);
    const long n = sysconf(_SC_NPROCESSORS_ONLN);
    return n > 0 ? (int)n : 1;
}

static void work_on(table *shared, const work *w)
{
    int k;
    while ((k = atomic_fetch_add(&shared->next, 1)) < w->n) {
        w->task(k, shared->results + (size_t)k * w->size, w->self);
        shared->done[k] = 1;
    }
}

// A child ends without what a normal exit does: buffers and handlers are the parent's.
static pid_t begin_helper(table *shared, const work *w)
{
    const pid_t pid = fork();
    if (pid == 0) {
        work_on(shared, w);
        _exit(0);
    }
    return pid;
}

static void wait_for(pid_t pid)
{
    while (waitpid(pid, NULL, 0) < 0 && errno == EINTR)
        continue;
}

static moray_status all_done(const table *shared, int n)
{
    for (int k = 0; k < n; k++)
        if (!shared->done[k])
            return moray_error(MORAY_NUMERIC, "the process of task %d of %d died", k + 1, n);
    return moray_ok();
}

static moray_status share_out(table *shared, const work *w, pid_t *helper, int helpers)
{
    int begun = 0;
    while (begun < helpers && (helper[begun] = begin_helper(shared, w)) > 0)
        begun++;
    work_on(shared, w);
    for (int k = 0; k < begun; k++)
        wait_for(helper[k]);
    return all_done(shared, w->n);
}

static moray_status alone(const work *w, char *results)
{
    for (int k = 0; k < w->n; k++)
        w->task(k, results + (size_t)k * w->size, w->self);
    return moray_ok();
}

moray_status moray_parallel(int n, size_t size, void *results, moray_task_fn *task, void *self, int jobs)
{
    const work w = {n, size, task, self};
    const int wanted = jobs < 1 ? moray_processors() : jobs, helpers = (wanted < n ? wanted : n) - 1;
    if (helpers < 1)
        return alone(&w, results);
    const size_t head = sizeof(table) + ((size_t)n + 63) / 64 * 64, bytes = head + (size_t)n * size;
    pid_t *helper = calloc((size_t)helpers, sizeof *helper);
    table *shared = helper ? mmap(NULL, bytes, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0) : MAP_FAILED;
    if (shared == MAP_FAILED) {
        free(helper);
        return alone(&w, results);
    }
    shared->done = (unsigned char *)(shared + 1);
    shared->results = (char *)shared + head;
    memcpy(shared->results, results, (size_t)n * size);
    const moray_status status = share_out(shared, &w, helper, helpers);
    memcpy(results, shared->results, (size_t)n * size);
    munmap(shared, bytes);
    free(helper);
    return status;
}

// ---- In the background ---------------------------------------------------------------------------------------------

// In memory that both processes share.
struct moray_background {
    pid_t pid; // below 0: there is none, and it is done
    size_t size, bytes;
    bool done;
    max_align_t result[];
};

moray_status moray_background_begin(moray_background **background, size_t size, const void *result, moray_task_fn *task,
                                    void *self)
{
    const size_t bytes = sizeof(moray_background) + size;
    moray_background *begun = mmap(NULL, bytes, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    *background = NULL;
    if (begun == MAP_FAILED)
        return moray_error(MORAY_MEMORY, "no memory for a task of %zu bytes", size);
    begun->size = size;
    begun->bytes = bytes;
    memcpy(begun->result, result, size);
    *background = begun;
    const pid_t pid = fork();
    if (pid != 0)
        begun->pid = pid;
    if (pid > 0)
        return moray_ok();
    task(0, begun->result, self);
    begun->done = true;
    if (pid == 0)
        _exit(0);
    return moray_ok();
}

moray_status moray_background_end(moray_background *background, void *result)
{
    if (background->pid > 0)
        wait_for(background->pid);
    const bool done = background->done;
    memcpy(result, background->result, background->size);
    munmap(background, background->bytes);
    return done ? moray_ok() : moray_error(MORAY_NUMERIC, "the process of a task in the background died");
}
