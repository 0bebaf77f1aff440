// SPDX-License-Identifier: MIT
//
// Without mpirun, one process a job, each for one point. With it, every rank has one such process, the first one too,
// and ranks speak in texts: "task POINT START ROUND START_ROUND", the line of a record, "home".
#include "sweep/sweep.h"

#include <errno.h>
#include <math.h>
#include <poll.h>
#include <stdlib.h>
#include <string.h>

#include "moray/parallel.h"

moray_status moray_crew_new(struct crew *crew, const struct grid *grid)
{
    const struct ranks ranks = moray_ranks_begin();
    const int jobs = grid->spec->jobs < 1 ? moray_processors() : grid->spec->jobs;
    *crew =
        (struct crew){.grid = grid, .ranks = ranks.size, .rank = ranks.rank, .n_workers = ranks.size > 1 ? 1 : jobs};
    crew->worker = calloc((size_t)crew->n_workers, sizeof *crew->worker);
    crew->poll = calloc(2 * (size_t)crew->n_workers, sizeof *crew->poll);
    crew->busy = calloc((size_t)crew->ranks, sizeof *crew->busy);
    if (crew->worker && crew->poll && crew->busy)
        return moray_ok();
    moray_crew_free(crew);
    return moray_error(MORAY_MEMORY, "no memory for %d processes", jobs);
}

void moray_crew_free(struct crew *crew)
{
    for (int k = 0; crew->worker && k < crew->n_workers; k++)
        moray_worker_kill(&crew->worker[k]);
    for (int k = 1; crew->rank == 0 && k < crew->ranks; k++)
        moray_ranks_send(k, "home");
    free(crew->worker);
    free(crew->poll);
    free(crew->busy);
    *crew = (struct crew){0};
}

static struct worker *idle_worker(const struct crew *crew)
{
    for (int k = 0; k < crew->n_workers; k++)
        if (crew->worker[k].pid == 0)
            return &crew->worker[k];
    return NULL;
}

static int idle_rank(const struct crew *crew)
{
    for (int k = 1; k < crew->ranks; k++)
        if (!crew->busy[k])
            return k;
    return 0;
}

bool moray_crew_idle(const struct crew *crew)
{
    return idle_rank(crew) > 0 || idle_worker(crew);
}

moray_status moray_crew_begin(struct crew *crew, const struct task *task)
{
    const int rank = idle_rank(crew);
    if (rank == 0)
        return moray_worker_begin(idle_worker(crew), crew->grid, task);
    char text[120];
    snprintf(text, sizeof text, "task %ld %ld %d %d", task->point, task->start, task->round, task->start_round);
    moray_ranks_send(rank, text);
    crew->busy[rank] = true;
    return moray_ok();
}

static moray_status answer_of_rank(struct crew *crew, struct record *record, bool *found)
{
    int from;
    char *text = crew->ranks > 1 ? moray_ranks_receive(&from) : NULL;
    if (!text)
        return moray_ok();
    crew->busy[from] = false;
    const moray_status status = moray_record_read(text, record);
    free(text);
    *found = !moray_failed(status);
    return status;
}

static moray_status answer_of_worker(struct crew *crew, struct record *record, bool *found)
{
    for (int k = 0; k < crew->n_workers && !*found; k++) {
        if (crew->worker[k].pid == 0)
            continue;
        MORAY_TRY(moray_worker_read(&crew->worker[k], found));
        if (*found)
            return moray_worker_record(&crew->worker[k], crew->grid, record);
    }
    return moray_ok();
}

// Until a process says something or is late, or `seconds` are over.
static void sleep_until_heard(struct crew *crew, double seconds)
{
    nfds_t n = 0;
    for (int k = 0; k < crew->n_workers; k++) {
        const struct worker *worker = &crew->worker[k];
        if (worker->pid == 0)
            continue;
        for (int i = 0; i < 2; i++)
            crew->poll[n++] = (struct pollfd){worker->pipe[i], POLLIN, 0};
        seconds = fmin(seconds, worker->deadline - moray_clock());
    }
    // Messages of ranks wake nobody: they are asked for often, and at little cost.
    const double most = crew->ranks > 1 ? 1e-3 : seconds;
    poll(crew->poll, n, (int)ceil(1000 * fmax(0, fmin(seconds, most))));
}

moray_status moray_crew_wait(struct crew *crew, double seconds, struct record *record, bool *found)
{
    const double until = moray_clock() + seconds;
    for (*found = false;;) {
        MORAY_TRY(answer_of_worker(crew, record, found));
        if (!*found)
            MORAY_TRY(answer_of_rank(crew, record, found));
        const double left = until - moray_clock();
        if (*found || left <= 0)
            return moray_ok();
        sleep_until_heard(crew, left);
    }
}

static moray_status wait_for_worker(struct crew *crew, struct record *record, bool *found)
{
    sleep_until_heard(crew, 1);
    return answer_of_worker(crew, record, found);
}

static moray_status serve_one(struct crew *crew, const struct task *task)
{
    struct record record = {0};
    bool found = false;
    MORAY_TRY(moray_worker_begin(&crew->worker[0], crew->grid, task));
    while (!found)
        MORAY_TRY(wait_for_worker(crew, &record, &found));
    char *line = moray_record_line(&record);
    if (line)
        moray_ranks_send(0, line);
    free(line);
    moray_record_free(&record);
    return line ? moray_ok() : moray_error(MORAY_MEMORY, "no memory for a record");
}

moray_status moray_crew_serve(struct crew *crew)
{
    for (;;) {
        int from;
        struct task task;
        char *text = moray_ranks_receive(&from);
        if (!text) {
            poll(NULL, 0, 1);
            continue;
        }
        const bool home = strcmp(text, "home") == 0;
        const int read = sscanf(text, "task %ld %ld %d %d", &task.point, &task.start, &task.round, &task.start_round);
        free(text);
        if (home)
            return moray_ok();
        if (read == 4)
            MORAY_TRY(serve_one(crew, &task));
    }
}
