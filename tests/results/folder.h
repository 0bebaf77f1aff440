// SPDX-License-Identifier: MIT
//
// A folder of a test's own, in which outputs appear. Included once by a test.
#ifndef TESTS_RESULTS_FOLDER_H
#define TESTS_RESULTS_FOLDER_H

#include "tap.h"

#include <dirent.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "moray/app/results.h"

static char root[] = "/tmp/moray-output-XXXXXX";

// root/name, in memory that lives until the fourth next call.
static const char *in_root(const char *name)
{
    static char path[4][300];
    static int next;
    next = (next + 1) % 4;
    snprintf(path[next], sizeof path[next], "%s/%s", root, name);
    return path[next];
}

static inline void put(const char *name, const char *text)
{
    FILE *file = fopen(in_root(name), "w");
    fputs(text, file);
    fclose(file);
}

// In place of gnuplot a script of ours, which keeps what it is told in the file "told".
static inline void stand_in(void)
{
    char path[2000];
    put("gnuplot", "#!/bin/sh\ncat > told\nprintf '<svg >\\n</svg>\\n'\n");
    chmod(in_root("gnuplot"), 0755);
    snprintf(path, sizeof path, "%s:%s", root, getenv("PATH"));
    setenv("PATH", path, 1);
}

// The whole file, "" when there is none; free it.
static inline char *content(const char *name)
{
    char *text = NULL;
    size_t size = 0;
    FILE *file = fopen(in_root(name), "r");
    if (!file || getdelim(&text, &size, 0, file) < 0) {
        free(text);
        text = strdup("");
    }
    if (file)
        fclose(file);
    return text;
}

static inline bool holds(const char *name, const char *text)
{
    char *got = content(name);
    const bool same = strcmp(got, text) == 0;
    free(got);
    return same;
}

// Entries of a directory, hidden ones too; -1 when there is no such directory.
static inline int entries(const char *name)
{
    DIR *directory = opendir(in_root(name));
    int n = directory ? -2 : -1; // . and ..
    for (; directory && readdir(directory); n++)
        ;
    if (directory)
        closedir(directory);
    return n;
}

// Files that this process has open.
static inline int handles(void)
{
    DIR *directory = opendir("/proc/self/fd");
    int n = 0;
    for (; directory && readdir(directory); n++)
        ;
    if (directory)
        closedir(directory);
    return n;
}

static inline moray_output *open_in(const char *name)
{
    moray_output *output = NULL;
    CHECK_OK(moray_output_open(&output, in_root(name)), "open");
    return output;
}

static inline FILE *start(moray_output *output, const char *name)
{
    FILE *file = NULL;
    CHECK_OK(moray_output_file(output, name, &file), name);
    return file;
}

static inline bool enter(void)
{
    return mkdtemp(root) && chdir(root) == 0;
}

static inline void leave(void)
{
    char remove[64];
    snprintf(remove, sizeof remove, "rm -r %s", root);
    CHECK(system(remove) == 0, "clean up");
}

#endif
