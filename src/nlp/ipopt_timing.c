// SPDX-License-Identifier: MIT
#include "nlp/ipopt_timing.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

bool moray_ipopt_timing_open(struct ipopt_timing *timing)
{
    strcpy(timing->path, "/tmp/moray-ipopt-XXXXXX");
    const int file = mkstemp(timing->path);
    if (file < 0)
        timing->path[0] = 0;
    else
        close(file);
    return file >= 0;
}

double moray_ipopt_timing_close(struct ipopt_timing *timing)
{
    char line[200];
    double user, system, seconds = NAN;
    FILE *file = timing->path[0] ? fopen(timing->path, "r") : NULL;
    if (!file)
        return NAN;
    while (fgets(line, sizeof line, file)) {
        const char *colon = strstr(line, "StdAugSystemSolverMultiSolve") ? strchr(line, ':') : NULL;
        if (colon && sscanf(colon, ": %lf (sys: %lf", &user, &system) == 2)
            seconds = user + system;
    }
    fclose(file);
    unlink(timing->path);
    return seconds;
}
