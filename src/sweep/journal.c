// SPDX-License-Identifier: MIT
#define _GNU_SOURCE // getline, strdup
#include "sweep/sweep.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
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
    const struct task *a = &((const struct entry *)left)->task, *b = &((const struct entry *)right)->task;
    if (a->point != b->point)
        return a->point < b->point ? -1 : 1;
    if (a->round != b->round)
        return a->round < b->round ? -1 : 1;
    return (a->start > b->start) - (a->start < b->start);
}

static moray_status keep(struct journal *journal, const char *text, long at)
{
    if (journal->n_old == journal->room) {
        const long more = journal->room ? 2 * journal->room : 256;
        struct entry *old = realloc(journal->old, (size_t)more * sizeof *old);
        if (!old)
            return moray_error(MORAY_MEMORY, "no memory for %ld records", more);
        journal->old = old;
        journal->room = more;
    }
    struct entry *entry = &journal->old[journal->n_old];
    *entry = (struct entry){.at = at, .length = (long)strlen(text)};
    journal->n_old += moray_record_task(text, &entry->task);
    return moray_ok();
}

// The first line: of this sweep, of another one, or, where it is the beginning of ours, torn while it was written.
static moray_status check_first(const char *line, ssize_t length, const char *text, const char *path,
                                const char *identity)
{
    if (text)
        return strcmp(text, identity) == 0 ? moray_ok() : moray_identity_refuse(path, text, identity);
    char sum[10];
    snprintf(sum, sizeof sum, "%08x ", checksum(identity, strlen(identity)));
    const size_t n = (size_t)length, head = n < 9 ? n : 9;
    return strncmp(line, sum, head) == 0 && strncmp(line + head, identity, n - head) == 0
               ? moray_ok()
               : moray_error(MORAY_INPUT, "%s is not the journal of a sweep: give the sweep another file, or remove it",
                             path);
}

// Reads what is whole and cuts off a torn end. *empty: not even a first line.
static moray_status read_old(struct journal *journal, const char *path, const char *identity, bool *empty)
{
    char *line = NULL;
    size_t size = 0;
    ssize_t length;
    long whole = 0;
    moray_status status = moray_ok();
    *empty = true;
    while (!moray_failed(status) && (length = getline(&line, &size, journal->file)) > 0) {
        const bool ended = line[length - 1] == '\n';
        const char *text = checked(line, length);
        if (*empty)
            status = check_first(line, length, text, path, identity);
        else if (text && strcmp(text, "finished") == 0)
            journal->finished = true;
        else if (text)
            status = keep(journal, text, whole + (text - line));
        if (!ended)
            break;
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
    *journal =
        (struct journal){.fd = open(path, O_RDWR | O_CREAT | O_CLOEXEC | O_NONBLOCK, 0666), .synced = moray_clock()};
    if (journal->fd < 0)
        return moray_error(MORAY_IO, "%s: %s", path, strerror(errno));
    moray_status status = moray_ok();
    // Of the process alone: the processes of its points, which it may not outlive, do not hold it.
    struct flock lock = {.l_type = F_WRLCK, .l_whence = SEEK_SET};
    struct stat about;
    if (fstat(journal->fd, &about) != 0 || !S_ISREG(about.st_mode))
        status = moray_error(MORAY_INPUT, "%s is not a regular file", path);
    else if (fcntl(journal->fd, F_SETLK, &lock) != 0)
        status = errno == EACCES || errno == EAGAIN
                     ? moray_error(MORAY_INPUT, "%s: another process is working on this sweep", path)
                     : moray_error(MORAY_IO, "%s cannot be locked: %s", path, strerror(errno));
    else if (!(journal->file = fdopen(journal->fd, "r")))
        status = moray_error(MORAY_MEMORY, "no memory to read %s", path);
    else
        status = read_old(journal, path, identity, &journal->made);
    if (!moray_failed(status) && journal->made)
        status = append(journal, identity);
    if (moray_failed(status))
        moray_journal_close(journal);
    return status;
}

void moray_journal_close(struct journal *journal)
{
    free(journal->old);
    if (journal->file)
        fclose(journal->file);
    else if (journal->fd >= 0)
        close(journal->fd);
    *journal = (struct journal){.fd = -1};
}

moray_status moray_journal_find(const struct journal *journal, const struct task *task, struct record *record,
                                bool *found)
{
    const struct entry wanted = {.task = *task};
    const struct entry *entry =
        journal->n_old ? bsearch(&wanted, journal->old, (size_t)journal->n_old, sizeof wanted, by_task) : NULL;
    *found = false;
    if (!entry)
        return moray_ok();
    char *text = calloc((size_t)entry->length + 1, 1);
    if (!text)
        return moray_error(MORAY_MEMORY, "no memory for a record of %ld characters", entry->length);
    moray_status status = moray_ok();
    if (pread(journal->fd, text, (size_t)entry->length, entry->at) != entry->length)
        status = moray_error(MORAY_IO, "the journal cannot be read: %s", strerror(errno));
    else
        status = moray_record_read(text, record);
    free(text);
    *found = !moray_failed(status);
    return status.code == MORAY_INPUT ? moray_ok() : status; // whole, but no record: it is done anew
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
