// SPDX-License-Identifier: MIT
//
// Without mpirun, one process a job, each for one point. With it, every rank has one such process, the first one too,
// and ranks speak in texts: "task POINT START ROUND START_ROUND", the line of a record, "alive", "home", and "leave",
// which is "home" where a rank is lost, for whom nobody is to wait at the end. The first one misses those who are
// silent; the others go where it is silent far longer than that, for it may be writing a large file.
#include "sweep/sweep.h"

#include <math.h>
#include <poll.h>
#include <stdlib.h>
#include <string.h>

#include "moray/parallel.h"

moray_status moray_crew_new(struct crew *crew, const struct grid *grid)
{
    const struct ranks ranks = moray_ranks_begin();
    const int jobs = grid->spec->jobs < 1 ? moray_processors() : grid->spec->jobs;
    // With many to serve, the first one solves nothing itself: to begin a process takes it longer the more it knows.
    enum { many = 16 };
    const int own = ranks.size == 1 ? jobs : ranks.rank == 0 && ranks.size > many ? 0 : 1;
    *crew = (struct crew){.grid = grid, .ranks = ranks.size, .rank = ranks.rank, .n_workers = own};
    crew->worker = calloc((size_t)crew->n_workers + 1, sizeof *crew->worker);
    crew->poll = calloc(3 * (size_t)crew->n_workers + 1, sizeof *crew->poll);
    crew->other = calloc((size_t)crew->ranks, sizeof *crew->other);
    crew->orphan = calloc((size_t)crew->ranks, sizeof *crew->orphan);
    for (int k = 0; crew->other && k < crew->ranks; k++)
        crew->other[k].heard = moray_clock();
    if (crew->worker && crew->poll && crew->other && crew->orphan)
        return moray_ok();
    moray_crew_free(crew);
    return moray_error(MORAY_MEMORY, "no memory for %d processes", jobs);
}

void moray_crew_free(struct crew *crew)
{
    for (int k = 0; crew->worker && k < crew->n_workers; k++)
        moray_worker_kill(&crew->worker[k]);
    for (int k = 1; crew->other && crew->rank == 0 && k < crew->ranks; k++)
        if (!crew->other[k].lost)
            moray_ranks_send(k, crew->lost ? "leave" : "home");
    if (crew->leaves || crew->lost)
        moray_ranks_leave();
    free(crew->worker);
    free(crew->poll);
    free(crew->other);
    free(crew->orphan);
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
        if (!crew->other[k].busy && !crew->other[k].lost)
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
    crew->other[rank].busy = true;
    crew->other[rank].task = *task;
    return moray_ok();
}

double moray_crew_silence(const struct crew *crew)
{
    const double asked = crew->grid->spec->silent_seconds;
    return asked > 0 ? asked : 30;
}

void moray_crew_show_life(struct crew *crew)
{
    const double now = moray_clock();
    if (crew->ranks == 1 || now - crew->shown < fmin(2, moray_crew_silence(crew) / 5))
        return;
    crew->shown = now;
    if (crew->rank > 0)
        moray_ranks_send(0, "alive");
    for (int k = 1; crew->rank == 0 && k < crew->ranks; k++)
        if (!crew->other[k].lost)
            moray_ranks_send(k, "alive");
}

// One who is silent for too long may have died with its machine, and what it had in hand is for another.
static void miss_ranks(struct crew *crew)
{
    const double now = moray_clock(), most = moray_crew_silence(crew);
    for (int k = 1; k < crew->ranks; k++) {
        struct other *other = &crew->other[k];
        if (other->lost || now - other->heard < most)
            continue;
        other->lost = true;
        crew->lost++;
        if (other->busy && !other->given_away)
            crew->orphan[crew->orphans++] = other->task;
        other->given_away = other->busy;
    }
}

// A lost one that is heard again was slow only: it works on, but a point that was given away is another's.
static moray_status hear(struct crew *crew, int from, const char *text, struct record *record, bool *found)
{
    struct other *other = &crew->other[from];
    other->heard = moray_clock();
    crew->lost -= other->lost;
    other->lost = false;
    if (strcmp(text, "alive") == 0)
        return moray_ok();
    const bool given_away = other->given_away;
    other->busy = other->given_away = false;
    if (given_away)
        return moray_ok();
    const moray_status status = moray_record_read(text, record);
    *found = !moray_failed(status);
    return status;
}

static moray_status answer_of_rank(struct crew *crew, struct record *record, bool *found)
{
    int from;
    char *text = NULL;
    moray_status status = moray_ok();
    while (crew->ranks > 1 && !*found && !moray_failed(status) && (text = moray_ranks_receive(&from))) {
        status = hear(crew, from, text, record, found);
        free(text);
    }
    if (crew->ranks > 1 && !text) // nothing more to be heard
        miss_ranks(crew);
    return status;
}

static moray_status begin_orphans(struct crew *crew)
{
    while (crew->orphans > 0 && moray_crew_idle(crew)) {
        crew->orphans--;
        MORAY_TRY(moray_crew_begin(crew, &crew->orphan[crew->orphans]));
    }
    return moray_ok();
}

moray_status moray_crew_answer_of_worker(struct crew *crew, struct record *record, bool *found)
{
    enum { most_killed = 2 };
    for (int k = 0; k < crew->n_workers && !*found; k++) {
        struct worker *worker = &crew->worker[k];
        if (worker->pid == 0)
            continue;
        MORAY_TRY(moray_worker_read(worker, found));
        const bool again = *found && moray_worker_was_killed(worker) && worker->killed < most_killed;
        *found = *found && !again;
        if (again)
            MORAY_TRY(moray_worker_again(worker, crew->grid));
        else if (*found)
            return moray_worker_record(worker, crew->grid, record);
    }
    return moray_ok();
}

void moray_crew_sleep(struct crew *crew, double seconds)
{
    nfds_t n = 0;
    for (int k = 0; k < crew->n_workers; k++) {
        const struct worker *worker = &crew->worker[k];
        if (worker->pid == 0)
            continue;
        crew->poll[n++] = (struct pollfd){worker->ends, POLLIN, 0};
        for (int i = 0; i < 2; i++)
            crew->poll[n++] = (struct pollfd){worker->pipe[i], POLLIN, 0};
        seconds = fmin(seconds, worker->deadline - moray_clock());
        if (worker->ends < 0)
            seconds = fmin(seconds, 1e-3); // the end of a process wakes nobody then
    }
    // Messages of ranks wake nobody: they are asked for often, and at little cost.
    const double most = crew->ranks > 1 ? 1e-3 : seconds;
    poll(crew->poll, n, (int)ceil(1000 * fmax(0, fmin(seconds, most))));
}

moray_status moray_crew_wait(struct crew *crew, double seconds, struct record *record, bool *found)
{
    const double until = moray_clock() + seconds;
    for (*found = false;;) {
        moray_crew_show_life(crew);
        MORAY_TRY(moray_crew_answer_of_worker(crew, record, found));
        if (!*found)
            MORAY_TRY(answer_of_rank(crew, record, found));
        MORAY_TRY(begin_orphans(crew)); // before whoever is free gets something new
        const double left = until - moray_clock();
        if (*found || left <= 0)
            return moray_ok();
        moray_crew_sleep(crew, left);
    }
}
