// SPDX-License-Identifier: MIT
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "moray/app/results.h"
#include "snake/identify/log.h"

moray_status moray_swim_log_new(moray_swim_log *log, int n, int joints)
{
    log->n = n;
    log->joints = joints;
    log->line = calloc((size_t)n, sizeof *log->line);
    log->t = calloc((size_t)n * (4 + 2 * (size_t)joints), sizeof *log->t);
    if (!log->line || !log->t)
        return moray_error(MORAY_MEMORY, "no memory for a log of %d rows", n);
    log->phi = log->t + n;
    return moray_ok();
}

void moray_swim_log_free(moray_swim_log *log)
{
    free(log->line);
    free(log->t);
    *log = (moray_swim_log){0};
}

static moray_status write_columns(const moray_swim_log *log, FILE *file)
{
    const int most = 2 * log->joints + 4;
    moray_column *column = calloc((size_t)most, sizeof *column);
    char(*name)[24] = calloc((size_t)most, sizeof *name);
    int n = 0;
    if (column && name) {
        column[n++] = (moray_column){.name = "t", .unit = "s", .values = log->t};
        if (log->p_x)
            column[n++] = (moray_column){.name = "p_x", .unit = "m", .values = log->p_x};
        if (log->p_y)
            column[n++] = (moray_column){.name = "p_y", .unit = "m", .values = log->p_y};
        if (log->heading)
            column[n++] = (moray_column){.name = "heading", .unit = "rad", .values = log->heading};
        for (int i = 0; i < log->joints; i++, n++) {
            snprintf(name[n], sizeof *name, log->reference ? "phi_ref_%d" : "phi_%d", i + 1);
            column[n] = (moray_column){.name = name[n], .unit = "rad", .values = log->phi + i, .stride = log->joints};
        }
        for (int i = 0; i < log->joints && log->u; i++, n++) {
            snprintf(name[n], sizeof *name, "u_%d", i + 1);
            column[n] = (moray_column){.name = name[n], .unit = "N m", .values = log->u + i, .stride = log->joints};
        }
        moray_csv_write(file, column, n, log->n);
    }
    free(column);
    free(name);
    return n > 0 ? moray_ok() : moray_error(MORAY_MEMORY, "no memory to write a log");
}

moray_status moray_swim_log_save(const moray_swim_log *log, const char *path)
{
    char fresh[4200];
    if (snprintf(fresh, sizeof fresh, "%s.new", path) >= (int)sizeof fresh)
        return moray_error(MORAY_INPUT, "log %.100s...: the path is too long", path);
    errno = 0;
    FILE *file = fopen(fresh, "w");
    if (!file)
        return moray_error(MORAY_IO, "log %s: %s", moray_path_tail(path), strerror(errno));
    const moray_status status = write_columns(log, file);
    const bool written = !ferror(file), closed = fclose(file) == 0;
    if (!moray_failed(status) && written && closed && rename(fresh, path) == 0)
        return moray_ok();
    remove(fresh);
    return moray_failed(status) ? status : moray_error(MORAY_IO, "log %s: cannot be written", moray_path_tail(path));
}
