// SPDX-License-Identifier: MIT
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

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
        int used = 0;
        if (sscanf(at, " %lf , %lf %n", &x, &y, &used) != 2 || used == 0)
            return moray_error(MORAY_INPUT, "path: '%.60s': must be waypoints X,Y X,Y ... in m", at);
        MORAY_TRY(add_waypoint(points, x, y));
        at += used;
    }
    return moray_ok();
}

static moray_status read_lines(waypoints *points, FILE *file, const char *name)
{
    char line[256], extra;
    if (!fgets(line, sizeof line, file) || strncmp(line, "x_m,y_m", 7) != 0)
        return moray_error(MORAY_INPUT, "%.120s:1: the first line must name the columns: x_m,y_m", name);
    for (int number = 2; fgets(line, sizeof line, file); number++) {
        double x, y;
        if (line[strspn(line, " \t\r\n")] == 0)
            continue;
        if (sscanf(line, " %lf , %lf %c", &x, &y, &extra) != 2)
            return moray_error(MORAY_INPUT, "%.120s:%d: must be two numbers, x_m,y_m", name, number);
        MORAY_TRY(add_waypoint(points, x, y));
    }
    return ferror(file) ? moray_error(MORAY_IO, "path %.120s: cannot be read: %s", name, strerror(errno)) : moray_ok();
}

static moray_status read_waypoints(waypoints *points, const char *text)
{
    if (strchr("+-.0123456789 ", *text))
        return read_list(points, text);
    FILE *file = fopen(text, "r");
    if (!file)
        return moray_error(MORAY_IO, "path %.120s: neither waypoints X,Y ... nor a file that can be opened: %s", text,
                           strerror(errno));
    const moray_status status = read_lines(points, file, text);
    fclose(file);
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
