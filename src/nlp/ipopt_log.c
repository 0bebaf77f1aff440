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
    line[0] = 0; // of a log in which nothing stands
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

void moray_ipopt_logs_open(IpoptProblem problem, int print_level, bool timing, struct ipopt_logs *logs)
{
    if (print_level > 0)
        OpenIpoptOutputFile(problem, (char *)"stderr", print_level);
    if (moray_ipopt_log_open(&logs->errors))
        OpenIpoptOutputFile(problem, logs->errors.path, ipopt_error_level);
    if (timing && moray_ipopt_log_open(&logs->timing) &&
        OpenIpoptOutputFile(problem, logs->timing.path, ipopt_timing_level))
        AddIpoptStrOption(problem, (char *)"print_timing_statistics", (char *)"yes");
}

void moray_ipopt_logs_close(struct ipopt_logs *logs)
{
    moray_ipopt_log_close(&logs->errors);
    moray_ipopt_log_close(&logs->timing);
}

bool moray_ipopt_log_lacked_memory(const struct ipopt_log *errors)
{
    static const char *const told[] = {"INFO(1) =-13", "INFO(1) = -13", "Error=-7 ", "Error=-13 "};
    char line[200];
    for (unsigned i = 0; i < sizeof told / sizeof *told; i++)
        if (moray_ipopt_log_find(errors, told[i], line, sizeof line))
            return true;
    return false;
}
