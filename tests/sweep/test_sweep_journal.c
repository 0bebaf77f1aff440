// SPDX-License-Identifier: MIT
//
// The journal of a sweep on a disk that takes a part of what it is given, is interrupted, and is full; and how often it
// is brought to the disk. The linker leads disk and clock to the test.
#define _GNU_SOURCE // mkdtemp
#include "tap.h"

#include <errno.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "sweep/sweep.h"

static double now = 100;
static size_t room = (size_t)-1; // bytes that the disk still takes
static bool slow, torn;          // a few bytes at a time, every second time interrupted; what is torn stays
static int sync_error, syncs, writes;
double __wrap_moray_clock(void);
ssize_t __real_write(int fd, const void *from, size_t size);
ssize_t __wrap_write(int fd, const void *from, size_t size);
int __real_ftruncate64(int fd, off_t size);
int __wrap_ftruncate64(int fd, off_t size);
int __wrap_fdatasync(int fd);

double __wrap_moray_clock(void)
{
    return now;
}

ssize_t __wrap_write(int fd, const void *from, size_t size)
{
    errno = EINTR;
    if (slow && ++writes % 2)
        return -1;
    errno = ENOSPC;
    if (room == 0)
        return -1;
    const size_t most = slow && size > 7 ? 7 : size, taken = most < room ? most : room;
    room -= taken;
    return __real_write(fd, from, taken);
}

int __wrap_ftruncate64(int fd, off_t size)
{
    errno = EIO;
    return torn ? -1 : __real_ftruncate64(fd, size);
}

int __wrap_fdatasync(int fd)
{
    (void)fd;
    syncs++;
    errno = sync_error;
    return sync_error ? -1 : 0;
}

static long size_of_file(void)
{
    struct stat about;
    return stat("a.journal", &about) == 0 ? (long)about.st_size : -1;
}

static moray_status add(struct journal *journal, long point)
{
    return moray_journal_add(journal, &(const struct record){.task = {point, -1, 0, 0}, .seconds = 0.5});
}

static bool has(const struct journal *journal, long point)
{
    struct record record = {0};
    bool found = false;
    CHECK_OK(moray_journal_find(journal, &(const struct task){point, -1, 0, 0}, &record, &found), "a search");
    const bool same = found && record.task.point == point && record.seconds == 0.5;
    moray_record_free(&record);
    return same;
}

static void test_slow(void)
{
    struct journal journal;
    slow = true;
    CHECK_OK(moray_journal_open(&journal, "a.journal", "identity"), "a journal");
    CHECK_OK(add(&journal, 3), "a record");
    CHECK_OK(add(&journal, 5), "another");
    slow = false;
    moray_journal_close(&journal);
    CHECK_OK(moray_journal_open(&journal, "a.journal", "identity"), "again");
    CHECK(journal.n_old == 2 && has(&journal, 3) && has(&journal, 5) && !has(&journal, 4), "written in %d parts",
          writes);
    moray_journal_close(&journal);
}

// Wherever the disk is full: nothing, a part, or all but the last byte is written.
static void test_full(void)
{
    struct journal journal;
    const long before = size_of_file();
    CHECK_OK(moray_journal_open(&journal, "a.journal", "identity"), "a journal");
    CHECK_OK(add(&journal, 6), "room for one");
    const long each = size_of_file() - before;
    for (int k = 0; k < 3; k++) {
        room = k == 0 ? 0 : k == 1 ? 20 : (size_t)each - 1;
        const moray_status status = add(&journal, 7);
        CHECK(status.code == MORAY_IO && strcmp(status.text, "the journal cannot be written, what was in it before is "
                                                             "kept: No space left on device") == 0,
              "%s", status.text);
        CHECK(size_of_file() == before + each, "nothing of it is left: %ld", size_of_file());
    }
    torn = true, room = 20;
    const moray_status status = add(&journal, 7);
    CHECK(status.code == MORAY_IO && strcmp(status.text, "the journal cannot be written: No space left on device") == 0,
          "%s", status.text);
    CHECK(size_of_file() == before + each + 20, "a torn line");
    torn = false, room = (size_t)-1;
    moray_journal_close(&journal);
    CHECK_OK(moray_journal_open(&journal, "a.journal", "identity"), "again");
    CHECK(size_of_file() == before + each && journal.n_old == 3 && has(&journal, 6) && !has(&journal, 7),
          "which is cut off");
    moray_journal_close(&journal);
}

// Once a second, whatever is written.
static void test_syncs(void)
{
    static const struct {
        double later;
        int error, syncs;
        const char *told; // NULL: nothing
    } steps[] = {{0.5, 0, 0, NULL},
                 {0.5, 0, 0, NULL},
                 {0.01, 0, 1, NULL},
                 {0.9, EIO, 1, NULL},
                 {0.2, EIO, 2, "the journal cannot be written: Input/output error"},
                 {0.5, EIO, 2, NULL},
                 {0.6, EINVAL, 3, NULL}, // of what is no disk
                 {0.9, 0, 3, NULL}};
    struct journal journal;
    CHECK_OK(moray_journal_open(&journal, "a.journal", "identity"), "a journal");
    syncs = 0;
    for (size_t k = 0; k < sizeof steps / sizeof *steps; k++) {
        now += steps[k].later;
        sync_error = steps[k].error;
        const moray_status status = add(&journal, 10 + (long)k);
        CHECK(steps[k].told ? status.code == MORAY_IO && strcmp(status.text, steps[k].told) == 0
                            : !moray_failed(status),
              "step %zu: %s", k, status.text);
        CHECK(syncs == steps[k].syncs, "brought to the disk %d times", syncs);
    }
    moray_journal_close(&journal);
}

int main(void)
{
    char folder[] = "/tmp/moray-journal-XXXXXX";
    if (!mkdtemp(folder) || chdir(folder) != 0)
        return 1;
    test_slow();
    test_full();
    test_syncs();
    unlink("a.journal");
    CHECK(chdir("/") == 0 && rmdir(folder) == 0, "nothing is left behind");
    return tap_done();
}
