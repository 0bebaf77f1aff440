// SPDX-License-Identifier: MIT
#include "moray/snake/path.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <tgmath.h>
#include <unistd.h>

#include "base/csv.h"
#include "base/number.h"

static const double degree = M_PI / 180;

// ---- Reading -------------------------------------------------------------------------------------------------------

typedef struct waypoints {
    double (*at)[2];
    int n, room;
} waypoints;

static moray_status add_waypoint(waypoints *points, double x, double y)
{
    if (!isfinite(x) || !isfinite(y))
        return moray_error(MORAY_INPUT, "path: waypoint %d is (%g, %g): must be finite", points->n + 1, x, y);
    if (points->n > 0 && hypot(x - points->at[points->n - 1][0], y - points->at[points->n - 1][1]) < 1e-9)
        return moray_error(MORAY_INPUT, "path: waypoint %d is where the one before is, (%g, %g)", points->n + 1, x, y);
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

// ---- Legs and arcs -------------------------------------------------------------------------------------------------

static void add_piece(moray_path *path, int leg, double x, double y, double course, double length, double curvature)
{
    if (length <= 0)
        return;
    path->piece[path->n++] = (moray_path_piece){leg, path->length, x, y, course, length, curvature};
    path->length += length;
}

static double course_between(const double *from, const double *to)
{
    return atan2(to[1] - from[1], to[0] - from[0]);
}

// The turn at waypoint k, to the left, and what it takes of the legs on either side.
static double turn_at(const waypoints *points, int k, double radius, double *taken)
{
    double turn = 0;
    if (k > 0 && k < points->n - 1)
        turn = remainder(course_between(points->at[k], points->at[k + 1]) -
                             course_between(points->at[k - 1], points->at[k]),
                         2 * M_PI);
    *taken = radius * tan(fabs(turn) / 2);
    return turn;
}

static moray_status lay(moray_path *path, const waypoints *points, double radius)
{
    double before = 0, taken, course = course_between(points->at[0], points->at[1]);
    for (int k = 0; k + 1 < points->n; k++) {
        const double *from = points->at[k], *to = points->at[k + 1];
        const double leg = hypot(to[0] - from[0], to[1] - from[1]);
        const double c = cos(course), s = sin(course), turn = turn_at(points, k + 1, radius, &taken);
        if (before + taken > leg * (1 + 1e-12))
            return moray_error(MORAY_INPUT,
                               "path: leg %d is %.4g m long, too short for arcs of radius %.4g m that turn by %.4g deg "
                               "at its end",
                               k + 1, leg, radius, turn / degree);
        add_piece(path, k + 1, from[0] + before * c, from[1] + before * s, course, leg - before - taken, 0);
        if (turn != 0)
            add_piece(path, k + 1, to[0] - taken * c, to[1] - taken * s, course, radius * fabs(turn),
                      turn > 0 ? 1 / radius : -1 / radius);
        before = taken;
        course += turn; // without jumps by a whole turn
    }
    return moray_ok();
}

static moray_status build(moray_path *path, const waypoints *points, double radius)
{
    if (points->n < 2)
        return moray_error(MORAY_INPUT, "path: %d waypoint%s: must be at least 2", points->n,
                           points->n == 1 ? "" : "s");
    path->piece = calloc(2 * (size_t)points->n, sizeof *path->piece);
    if (!path->piece)
        return moray_error(MORAY_MEMORY, "no memory for a path of %d waypoints", points->n);
    return lay(path, points, radius);
}

moray_status moray_path_read(moray_path *path, const char *text, double radius)
{
    waypoints points = {0};
    *path = (moray_path){0};
    if (!(radius > 0 && isfinite(radius)))
        return moray_error(MORAY_INPUT, "radius_m = %g: must be above 0", radius);
    moray_status status = read_waypoints(&points, text);
    if (!moray_failed(status))
        status = build(path, &points, radius);
    free(points.at);
    if (moray_failed(status))
        moray_path_free(path);
    return status;
}

void moray_path_free(moray_path *path)
{
    free(path->piece);
    *path = (moray_path){0};
}

// ---- Points --------------------------------------------------------------------------------------------------------

moray_path_point moray_path_at(const moray_path *path, moray_num along)
{
    const double where = creal(along);
    int k = 0;
    while (k + 1 < path->n && where >= path->piece[k + 1].start)
        k++;
    const moray_path_piece *piece = &path->piece[k];
    const bool outside = where < 0 || where > path->length; // straight on
    const double from = where < 0 ? 0 : outside ? piece->length : 0, kappa = outside ? 0 : piece->curvature;
    const double course = piece->course + piece->curvature * from;
    double x = piece->x, y = piece->y;
    if (from > 0) {
        const double bend = piece->curvature;
        x += bend != 0 ? (sin(course) - sin(piece->course)) / bend : from * cos(course);
        y -= bend != 0 ? (cos(course) - cos(piece->course)) / bend : -from * sin(course);
    }
    const moray_num s = along - piece->start - from, turned = course + kappa * s;
    if (kappa == 0)
        return (moray_path_point){x + s * cos(course), y + s * sin(course), turned, 0};
    return (moray_path_point){x + (sin(turned) - sin(course)) / kappa, y - (cos(turned) - cos(course)) / kappa, turned,
                              kappa};
}

void moray_path_project(const moray_path *path, double x, double y, double *along, double *across)
{
    enum { most = 30 };
    for (int k = 0; k < most; k++) {
        const moray_path_point at = moray_path_at(path, *along);
        const double c = cos(creal(at.course)), s = sin(creal(at.course));
        const double dx = x - creal(at.x), dy = y - creal(at.y), ahead = c * dx + s * dy;
        *across = c * dy - s * dx;
        const double step = ahead / fmax(1 - at.curvature * *across, 0.2);
        *along += fmin(fmax(step, -0.5), 0.5);
        if (fabs(step) < 1e-10)
            break;
    }
}

bool moray_path_seek(const moray_swim_sample *sample, void *self)
{
    moray_path_seeker *seeker = self;
    double across;
    moray_path_project(seeker->path, sample->pose.p_x, sample->pose.p_y, &seeker->along, &across);
    return seeker->along < seeker->path->length;
}

// Ground speed along a course against the current, by crabbing; NaN where there is none.
static double way_made(double speed, const double current[2], double course)
{
    const double along = current[0] * cos(course) + current[1] * sin(course);
    const double side = current[1] * cos(course) - current[0] * sin(course);
    return fabs(side) < speed ? sqrt(speed * speed - side * side) + along : NAN;
}

double moray_path_duration(const moray_path *path, double along, double speed, const double current[2])
{
    enum { steps = 2000 };
    double seconds = 0;
    for (int i = 0; i < steps; i++) {
        const moray_num at = along + (path->length - along) * (i + 0.5) / steps;
        const double way = way_made(speed, current, creal(moray_path_at(path, at).course));
        seconds += way > 0 ? (path->length - along) / steps / way : NAN;
    }
    return seconds;
}

moray_status moray_path_passable(const moray_path *path, double speed, const double current[2])
{
    enum { points = 33 };
    for (int k = 0; k < path->n; k++)
        for (int i = 0; i < points; i++) {
            const moray_path_piece *piece = &path->piece[k];
            const double course = piece->course + piece->curvature * piece->length * i / (points - 1);
            const double side = current[1] * cos(course) - current[0] * sin(course);
            const double against = -current[0] * cos(course) - current[1] * sin(course);
            if (way_made(speed, current, course) > 0)
                continue;
            return moray_error(
                MORAY_NOT_SOLVED,
                "the current is too strong for the path: %s leg %d, %.4g m along the path, its course is "
                "%.4g deg, %.4g m/s run across it and %.4g m/s against it, and the robot swims %.4g m/s",
                piece->curvature != 0 ? "in the corner behind" : "on", piece->leg,
                piece->start + piece->length * i / (points - 1), course / degree, fabs(side), against + 0.0, speed);
        }
    return moray_ok();
}
