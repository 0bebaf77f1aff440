// SPDX-License-Identifier: MIT
//
// The numbers of the rivals in a file, so that trials which are run apart, as those of a sweep, tune once.
#include "sea.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

enum { LINE = 6000 };

static bool read_law(sea_job *job, const char *line)
{
    int law, by;
    double v[SEA_NUMBERS], cost;
    if (sscanf(line, "%d %lf %lf %lf %lf %lf %lf %d", &law, &v[0], &v[1], &v[2], &v[3], &v[4], &cost, &by) != 8 ||
        law < 0 || law >= SEA_LAWS)
        return false;
    memcpy(job->number[law], v, sizeof v);
    job->tuned_cost[law] = cost;
    job->tuned_by[law] = by;
    return true;
}

moray_status sea_tuned_read(sea_job *job, bool *found)
{
    static char line[LINE], expected[LINE];
    moray_status status = moray_ok();
    *found = false;
    FILE *file = *job->tuned ? fopen(job->tuned, "r") : NULL;
    if (!file)
        return status;
    sea_signature(job, expected, sizeof expected);
    if (fgets(line, sizeof line, file))
        line[strcspn(line, "\n")] = 0;
    *found = strcmp(line, expected) == 0;
    if (!*found)
        status = moray_error(MORAY_INPUT, "tuned = %.200s: of trials with other settings", job->tuned);
    while (*found && fgets(line, sizeof line, file))
        *found = read_law(job, line);
    if (!*found && !moray_failed(status))
        status = moray_error(MORAY_INPUT, "tuned = %.200s: damaged", job->tuned);
    fclose(file);
    return status;
}

moray_status sea_tuned_write(const sea_job *job)
{
    static char first[LINE];
    char temporary[MORAY_PATH_SIZE + 32];
    const sea_law *laws;
    const int n = sea_laws(job, &laws);
    if (!*job->tuned)
        return moray_ok();
    snprintf(temporary, sizeof temporary, "%s.%d", job->tuned, (int)getpid()); // several may tune at once, alike
    FILE *file = fopen(temporary, "w");
    if (!file)
        return moray_error(MORAY_IO, "tuned = %.200s: cannot be written: %s", job->tuned, strerror(errno));
    sea_signature(job, first, sizeof first);
    fprintf(file, "%s\n", first);
    for (int law = 0; law < n; law++) {
        const double *v = job->number[law];
        if (laws[law].tuned)
            fprintf(file, "%d %.17g %.17g %.17g %.17g %.17g %.17g %d\n", law, v[0], v[1], v[2], v[3], v[4],
                    job->tuned_cost[law], job->tuned_by[law]);
    }
    const bool failed = ferror(file) != 0;
    if (fclose(file) == 0 && !failed && rename(temporary, job->tuned) == 0)
        return moray_ok();
    const int error = errno;
    unlink(temporary);
    return moray_error(MORAY_IO, "tuned = %.200s: cannot be written: %s", job->tuned, strerror(error));
}
