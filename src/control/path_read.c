// SPDX-License-Identifier: MIT
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/csv.h"
#include "base/number.h"
#include "moray/control/path.h"

typedef struct waypoints {
    double (*at)[2];
    int n, room;
} waypoints;

static moray_status add_waypoint(waypoints *points, double x, double y)
{
    if (points->n == points->room) {
        const int room = 2 * points->room + 16;
        double(*larger)[2] = realloc(points->at, (size_t)room * sizeof *larger);
        if (!larger)
            return moray_error(MORAY_MEMORY, "no memory for %d waypoints", room);
        points->at = larger;
        points->room = room;
    }
    points->at[points->n][0] = x;
    points->at[points->n++][1] = y;
    return moray_ok();
}

static moray_status read_list(waypoints *points, const char *text)
{
    for (const char *at = text; *at;) {
        double x, y;
        int used;
        if (sscanf(at, " %lf , %lf %n", &x, &y, &used) != 2)
            return moray_error(MORAY_INPUT, "path: '%.60s': must be waypoints X,Y X,Y ... in m", at);
        MORAY_TRY(add_waypoint(points, x, y));
        at += used;
    }
    return moray_ok();
}

static moray_status read_rows(waypoints *points, const moray_csv *csv)
{
    static const char *const names[] = {"x_m", "y_m"};
    int column[2];
    MORAY_TRY(moray_csv_match(csv, names, 2, column));
    for (int row = 0; row < csv->rows; row++) {
        double x, y;
        MORAY_TRY(moray_csv_number(csv, row, column[0], &x));
        MORAY_TRY(moray_csv_number(csv, row, column[1], &y));
        const moray_status status = add_waypoint(points, x, y);
        if (moray_failed(status))
            return moray_csv_error(csv, row, status);
    }
    return moray_ok();
}

static moray_status read_file(waypoints *points, const char *path)
{
    moray_csv csv;
    if (access(path, R_OK) != 0)
        return moray_error(MORAY_IO, "path %.120s: neither waypoints X,Y ... nor a file that can be opened: %s", path,
                           strerror(errno));
    moray_status status = moray_csv_read(&csv, path, "path");
    if (!moray_failed(status))
        status = read_rows(points, &csv);
    moray_csv_free(&csv);
    return status;
}

static moray_status read_waypoints(waypoints *points, const char *text)
{
    if (access(text, R_OK) == 0 || !strchr("+-.0123456789 ", *text))
        return read_file(points, text);
    const locale_t before = moray_c_locale_begin();
    const moray_status status = read_list(points, text);
    moray_c_locale_end(before);
    return status;
}

moray_status moray_path_read(moray_path *path, const char *text, double radius)
{
    waypoints points = {0};
    *path = (moray_path){0};
    moray_status status = read_waypoints(&points, text);
    if (!moray_failed(status))
        status = moray_path_through(path, (const double(*)[2])points.at, points.n, radius);
    free(points.at);
    return status;
}
