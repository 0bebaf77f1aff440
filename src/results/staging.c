// SPDX-License-Identifier: MIT
//
// The folder inside an output directory where files stand until they are put in place. Who uses one holds a lock on it,
// which ends with the process however that ends: a folder without one is what a killed run has left, and goes.
#include "results/staging.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <unistd.h>

static const char prefix[] = ".moray-";

// Locked, or -1: another holds it, or there is none.
static int lock(const char *path)
{
    const int held = open(path, O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
    if (held < 0 || flock(held, LOCK_EX | LOCK_NB) == 0)
        return held;
    close(held);
    return -1;
}

// Another run may clear it away before it is locked. Where the file system knows no locks, nobody does.
int moray_staging_new(char *path, int *held)
{
    enum { tries = 10 };
    char *end = path + strlen(path) - 6;
    for (int k = 0; k < tries; k++) {
        memcpy(end, "XXXXXX", 6);
        if (!mkdtemp(path))
            return errno;
        *held = lock(path);
        if (access(path, F_OK) == 0)
            return 0;
        if (*held >= 0)
            close(*held);
    }
    return EAGAIN;
}

void moray_staging_end(const char *path, int held)
{
    rmdir(path);
    if (held >= 0)
        close(held);
}

// An earlier file that a run killed while it put its own in place had set aside goes back; what that run wrote goes.
static void clear_file(const char *directory, const char *path, const char *name)
{
    char from[PATH_MAX], to[PATH_MAX];
    if (snprintf(from, sizeof from, "%s/%s", path, name) >= (int)sizeof from)
        return;
    if (strncmp(name, "old.", 4) != 0)
        unlink(from);
    else if (snprintf(to, sizeof to, "%s/%s", directory, name + 4) < (int)sizeof to)
        rename(from, to);
}

static void clear_folder(const char *directory, const char *path)
{
    DIR *folder = opendir(path);
    if (!folder)
        return;
    for (struct dirent *entry; (entry = readdir(folder));)
        if (strncmp(entry->d_name, "old.", 4) == 0 || strncmp(entry->d_name, "new.", 4) == 0)
            clear_file(directory, path, entry->d_name);
    closedir(folder);
}

void moray_staging_clear(const char *directory)
{
    char path[PATH_MAX];
    DIR *folder = opendir(directory);
    if (!folder)
        return;
    for (struct dirent *entry; (entry = readdir(folder));) {
        if (strncmp(entry->d_name, prefix, sizeof prefix - 1) != 0 ||
            snprintf(path, sizeof path, "%s/%s", directory, entry->d_name) >= (int)sizeof path)
            continue;
        const int held = lock(path);
        if (held < 0)
            continue;
        clear_folder(directory, path);
        moray_staging_end(path, held);
    }
    closedir(folder);
}
