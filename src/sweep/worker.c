// SPDX-License-Identifier: MIT
//
// The process of a point, seen from outside.
#define _GNU_SOURCE // pipe2
#include "sweep/sweep.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/pidfd.h>
#include <sys/wait.h>
#include <unistd.h>

static void close_pair(const int pair[2])
{
    close(pair[0]);
    close(pair[1]);
}

moray_status moray_worker_begin(struct worker *worker, const struct grid *grid, const struct task *task)
{
    int summary[2], errors[2];
    if (pipe2(summary, O_CLOEXEC) != 0)
        return moray_error(MORAY_IO, "no pipe for a point: %s", strerror(errno));
    if (pipe2(errors, O_CLOEXEC) != 0) {
        close_pair(summary);
        return moray_error(MORAY_IO, "no pipe for a point: %s", strerror(errno));
    }
    fflush(NULL);
    const pid_t parent = getpid(), pid = fork();
    if (pid == 0)
        moray_child_run(grid, task, summary, errors, parent);
    close(summary[1]);
    close(errors[1]);
    if (pid < 0) {
        close(summary[0]);
        close(errors[0]);
        return moray_error(MORAY_IO, "no process for a point: %s", strerror(errno));
    }
    setpgid(pid, pid); // whoever is first
    const double now = moray_clock(), limit = grid->spec->point_seconds;
    *worker = (struct worker){.pid = pid,
                              .ends = pidfd_open(pid, 0),
                              .task = *task,
                              .pipe = {summary[0], errors[0]},
                              .begun = now,
                              .deadline = limit > 0 ? now + limit : INFINITY};
    for (int k = 0; k < 2; k++)
        fcntl(worker->pipe[k], F_SETFL, O_NONBLOCK);
    return moray_ok();
}

// Keeps the first megabytes of the summary and the last kilobytes of the rest.
static moray_status keep(struct worker *worker, int which, const char *piece, size_t n)
{
    enum { most_summary = 1 << 24, most_errors = 1 << 12 };
    size_t kept = worker->length[which];
    if (which == 0 && kept + n > most_summary)
        return moray_ok();
    char *text = realloc(worker->text[which], kept + n + 1);
    if (!text)
        return moray_error(MORAY_MEMORY, "no memory for what a point says");
    worker->text[which] = text;
    memcpy(text + kept, piece, n);
    kept += n;
    if (which == 1 && kept > most_errors) {
        memmove(text, text + kept - most_errors, most_errors);
        kept = most_errors;
    }
    text[kept] = 0;
    worker->length[which] = kept;
    return moray_ok();
}

// Reads what is there, but no more than a piece of it at a time: a point that never stops talking is late all the same.
// A pipe at its end is closed, so that nobody waits for it.
static moray_status drain(struct worker *worker, int which)
{
    enum { most_reads = 64 };
    char piece[1 << 14];
    for (int k = 0; worker->pipe[which] >= 0 && k < most_reads; k++) {
        const ssize_t n = read(worker->pipe[which], piece, sizeof piece);
        if (n == 0) {
            close(worker->pipe[which]);
            worker->pipe[which] = -1;
        } else if (n > 0) {
            MORAY_TRY(keep(worker, which, piece, (size_t)n));
        } else if (errno != EINTR) {
            return moray_ok();
        }
    }
    return moray_ok();
}

static moray_status drain_both(struct worker *worker)
{
    MORAY_TRY(drain(worker, 0));
    return drain(worker, 1);
}

moray_status moray_worker_read(struct worker *worker, bool *ended)
{
    MORAY_TRY(drain_both(worker));
    if (moray_clock() > worker->deadline) {
        worker->late = true;
        kill(-worker->pid, SIGKILL);
    }
    int wait_status;
    *ended = waitpid(worker->pid, &wait_status, worker->late ? 0 : WNOHANG) == worker->pid;
    if (!*ended)
        return moray_ok();
    worker->wait_status = wait_status;
    kill(-worker->pid, SIGKILL); // what it started and left
    return drain_both(worker);
}

bool moray_worker_was_killed(const struct worker *worker)
{
    return !worker->late && WIFSIGNALED(worker->wait_status) &&
           (WTERMSIG(worker->wait_status) == SIGKILL || WTERMSIG(worker->wait_status) == SIGTERM);
}

// Back to idle.
static void clear(struct worker *worker)
{
    if (worker->ends >= 0)
        close(worker->ends);
    for (int k = 0; k < 2; k++) {
        if (worker->pipe[k] >= 0)
            close(worker->pipe[k]);
        free(worker->text[k]);
    }
    *worker = (struct worker){0};
}

moray_status moray_worker_again(struct worker *worker, const struct grid *grid)
{
    const struct task task = worker->task;
    const int killed = worker->killed + 1;
    clear(worker);
    MORAY_TRY(moray_worker_begin(worker, grid, &task));
    worker->killed = killed;
    return moray_ok();
}

// The text of the status, else the last line that is not empty.
static const char *said(char *text, size_t length)
{
    char *at = text ? memchr(text, REASON_MARK, length) : NULL;
    if (at)
        return at + 1;
    while (length > 0 && (unsigned char)text[length - 1] <= ' ')
        text[--length] = 0;
    const char *line = text ? strrchr(text, '\n') : NULL;
    return line ? line + 1 : text ? text : "";
}

static void judge(struct worker *worker, const struct grid *grid, struct record *record, char *reason, size_t size)
{
    const int wait_status = worker->wait_status;
    const char *text = said(worker->text[1], worker->length[1]);
    record->code = MORAY_NOT_SOLVED;
    if (worker->late)
        snprintf(reason, size, "took longer than %g s", grid->spec->point_seconds);
    else if (WIFSIGNALED(wait_status))
        snprintf(reason, size, "its process was ended by signal %d (%s)%s%s%.200s", WTERMSIG(wait_status),
                 strsignal(WTERMSIG(wait_status)), worker->killed ? ", time and again" : "", *text ? ": " : "", text);
    else if (WEXITSTATUS(wait_status) <= MORAY_INTERRUPTED)
        record->code = (moray_code)WEXITSTATUS(wait_status);
    if (!*reason && record->code != MORAY_OK)
        snprintf(reason, size, "%s", *text ? text : moray_code_text(record->code));
}

moray_status moray_worker_record(struct worker *worker, const struct grid *grid, struct record *record)
{
    char reason[400] = "";
    *record = (struct record){.task = worker->task, .seconds = moray_clock() - worker->begun};
    judge(worker, grid, record, reason, sizeof reason);
    record->reason = strdup(reason);
    moray_status status = record->reason ? moray_json_on_one_line(worker->text[0], &record->found, &record->read)
                                         : moray_error(MORAY_MEMORY, "no memory for a record");
    if (!moray_failed(status) && !record->found && record->code == MORAY_OK) {
        record->code = MORAY_NOT_SOLVED;
        free(record->reason);
        record->reason = strdup("it left no summary");
    }
    clear(worker);
    return status;
}

void moray_worker_kill(struct worker *worker)
{
    if (worker->pid == 0)
        return;
    kill(-worker->pid, SIGKILL);
    waitpid(worker->pid, NULL, 0);
    clear(worker);
}
