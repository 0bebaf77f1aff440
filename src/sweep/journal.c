// SPDX-License-Identifier: MIT
#define _GNU_SOURCE // getline, strdup
#include "sweep/sweep.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

// FNV-1a
static uint32_t checksum(const char *text, size_t length)
{
    uint32_t sum = 2166136261u;
    for (size_t k = 0; k < length; k++)
        sum = (sum ^ (unsigned char)text[k]) * 16777619u;
    return sum;
}

// The line behind a checksum that fits, or NULL.
static char *checked(char *line, ssize_t length)
{
    unsigned sum;
    int used = 0;
    if (length < 10 || line[length - 1] != '\n' || sscanf(line, "%8x %n", &sum, &used) < 1 || used != 9)
        return NULL;
    line[--length] = 0;
    return checksum(line + used, (size_t)(length - used)) == sum ? line + used : NULL;
}

static int by_task(const void *left, const void *right)
{
    const struct task *a = &((const struct record *)left)->task, *b = &((const struct record *)right)->task;
    if (a->point != b->point)
        return a->point < b->point ? -1 : 1;
    if (a->round != b->round)
        return a->round < b->round ? -1 : 1;
    return (a->start > b->start) - (a->start < b->start);
}

static moray_status keep(struct journal *journal, const char *line, long *room)
{
    if (journal->n_old == *room) {
        const long more = *room ? 2 * *room : 256;
        struct record *old = realloc(journal->old, (size_t)more * sizeof *old);
        if (!old)
            return moray_error(MORAY_MEMORY, "no memory for %ld records", more);
        journal->old = old;
        *room = more;
    }
    MORAY_TRY(moray_record_read(line, &journal->old[journal->n_old]));
    journal->n_old++;
    return moray_ok();
}

// Reads what is whole and cuts off the rest. *empty: not even a first line.
static moray_status read_old(struct journal *journal, const char *path, const char *identity, bool *empty)
{
    char *line = NULL;
    size_t size = 0;
    ssize_t length;
    long room = 0, whole = 0;
    moray_status status = moray_ok();
    *empty = true;
    while (!moray_failed(status) && (length = getline(&line, &size, journal->file)) > 0) {
        const char *text = checked(line, length);
        if (!text)
            break;
        if (*empty && strcmp(text, identity) != 0)
            status = moray_error(MORAY_INPUT,
                                 "%s is of another sweep, which asked for something else: give this one another file, "
                                 "or remove it",
                                 path);
        else if (!*empty && strcmp(text, "finished") == 0)
            journal->finished = true;
        else if (!*empty)
            status = keep(journal, text, &room);
        *empty = false;
        whole += length;
    }
    free(line);
    if (!moray_failed(status) && ftruncate(journal->fd, whole) != 0)
        status = moray_error(MORAY_IO, "%s: %s", path, strerror(errno));
    if (journal->n_old > 0)
        qsort(journal->old, (size_t)journal->n_old, sizeof *journal->old, by_task);
    return status;
}

static moray_status append(struct journal *journal, const char *text)
{
    const size_t length = strlen(text) + 10;
    char *line = malloc(length + 1);
    if (!line)
        return moray_error(MORAY_MEMORY, "no memory for a line of the journal");
    snprintf(line, length + 1, "%08x %s\n", checksum(text, strlen(text)), text);
    const off_t before = lseek(journal->fd, 0, SEEK_END);
    size_t done = 0;
    ssize_t n = 0;
    while (done < length && ((n = write(journal->fd, line + done, length - done)) > 0 || errno == EINTR))
        done += n > 0 ? (size_t)n : 0;
    free(line);
    if (done == length)
        return moray_ok();
    const int error = errno;
    if (ftruncate(journal->fd, before) != 0) // a torn line would end the journal all the same
        return moray_error(MORAY_IO, "the journal cannot be written: %s", strerror(error));
    return moray_error(MORAY_IO, "the journal cannot be written, what was in it before is kept: %s", strerror(error));
}

moray_status moray_journal_open(struct journal *journal, const char *path, const char *identity)
{
    *journal = (struct journal){.fd = open(path, O_RDWR | O_CREAT | O_CLOEXEC, 0666), .synced = moray_clock()};
    if (journal->fd < 0)
        return moray_error(MORAY_IO, "%s: %s", path, strerror(errno));
    bool empty = true;
    moray_status status = moray_ok();
    // Of the process alone: the processes of its points, which it may not outlive, do not hold it.
    struct flock lock = {.l_type = F_WRLCK, .l_whence = SEEK_SET};
    if (fcntl(journal->fd, F_SETLK, &lock) != 0)
        status = errno == EACCES || errno == EAGAIN
                     ? moray_error(MORAY_INPUT, "%s: another process is working on this sweep", path)
                     : moray_error(MORAY_IO, "%s cannot be locked: %s", path, strerror(errno));
    else if (!(journal->file = fdopen(journal->fd, "r")))
        status = moray_error(MORAY_MEMORY, "no memory to read %s", path);
    else
        status = read_old(journal, path, identity, &empty);
    if (!moray_failed(status) && empty)
        status = append(journal, identity);
    if (moray_failed(status))
        moray_journal_close(journal);
    return status;
}

void moray_journal_close(struct journal *journal)
{
    for (long k = 0; k < journal->n_old; k++)
        moray_record_free(&journal->old[k]);
    free(journal->old);
    if (journal->file)
        fclose(journal->file);
    else if (journal->fd >= 0)
        close(journal->fd);
    *journal = (struct journal){.fd = -1};
}

const struct record *moray_journal_find(const struct journal *journal, const struct task *task)
{
    const struct record wanted = {.task = *task};
    return journal->n_old ? bsearch(&wanted, journal->old, (size_t)journal->n_old, sizeof wanted, by_task) : NULL;
}

moray_status moray_journal_add(struct journal *journal, const struct record *record)
{
    char *text = record ? moray_record_line(record) : NULL;
    if (record && !text)
        return moray_error(MORAY_MEMORY, "no memory for a record");
    moray_status status = append(journal, record ? text : "finished");
    free(text);
    // Only a machine that stops loses what is not on the disk yet; once a second is enough for that.
    if (!moray_failed(status) && moray_clock() - journal->synced > 1) {
        journal->synced = moray_clock();
        if (fdatasync(journal->fd) != 0 && errno != EINVAL)
            status = moray_error(MORAY_IO, "the journal cannot be written: %s", strerror(errno));
    }
    return status;
}
