// SPDX-License-Identifier: MIT
#define _GNU_SOURCE // memfd_create
#include "nlp/ipopt_log.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

bool moray_ipopt_log_open(struct ipopt_log *log)
{
    *log = (struct ipopt_log){.file = memfd_create("moray-ipopt", MFD_CLOEXEC)};
    if (log->file >= 0)
        snprintf(log->path, sizeof log->path, "/proc/self/fd/%d", log->file);
    return log->file >= 0;
}

void moray_ipopt_log_close(struct ipopt_log *log)
{
    if (log->path[0])
        close(log->file);
    log->path[0] = 0;
}

bool moray_ipopt_log_find(const struct ipopt_log *log, const char *words, char *line, size_t size)
{
    FILE *file = log->path[0] ? fopen(log->path, "r") : NULL;
    bool found = false;
    if (!file)
        return false;
    while (!found && fgets(line, (int)size, file))
        found = strstr(line, words);
    line[strcspn(line, "\n")] = 0;
    fclose(file);
    return found;
}

double moray_ipopt_log_linear_seconds(const struct ipopt_log *log)
{
    char line[200];
    double user, system;
    if (!moray_ipopt_log_find(log, "StdAugSystemSolverMultiSolve", line, sizeof line) || !strchr(line, ':') ||
        sscanf(strchr(line, ':'), ": %lf (sys: %lf", &user, &system) != 2)
        return NAN;
    return user + system;
}
