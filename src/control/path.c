// SPDX-License-Identifier: MIT
#include "moray/angle.h"
#include "moray/control/path.h"

#include <stdlib.h>
#include <tgmath.h>

// ---- Legs and arcs -------------------------------------------------------------------------------------------------

typedef struct waypoints {
    const double (*at)[2];
    int n;
} waypoints;

static moray_status check(const waypoints *through, double radius)
{
    if (!(radius > 0 && isfinite(radius)))
        return moray_error(MORAY_INPUT, "radius_m = %g: must be above 0", radius);
    for (int k = 0; k < through->n; k++) {
        const double x = through->at[k][0], y = through->at[k][1];
        if (!isfinite(x) || !isfinite(y))
            return moray_error(MORAY_INPUT, "path: waypoint %d is (%g, %g): must be finite", k + 1, x, y);
        if (k > 0 && hypot(x - through->at[k - 1][0], y - through->at[k - 1][1]) < 1e-9)
            return moray_error(MORAY_INPUT, "path: waypoint %d is where the one before is, (%g, %g)", k + 1, x, y);
    }
    if (through->n < 2)
        return moray_error(MORAY_INPUT, "path: %d waypoint%s: must be at least 2", through->n,
                           through->n == 1 ? "" : "s");
    return moray_ok();
}

static void add_piece(moray_path *path, int leg, double x, double y, double course, double length, double curvature)
{
    if (length <= 0)
        return;
    path->piece[path->n++] = (moray_path_piece){leg, path->length, x, y, course, length, curvature, 0};
    path->length += length;
}

static double course_between(const double *from, const double *to)
{
    return atan2(to[1] - from[1], to[0] - from[0]);
}

// The turn at waypoint k > 0, to the left, and what it takes of the legs on either side.
static double turn_at(const waypoints *through, int k, double radius, double *taken)
{
    double turn = 0;
    if (k < through->n - 1)
        turn = remainder(course_between(through->at[k], through->at[k + 1]) -
                             course_between(through->at[k - 1], through->at[k]),
                         2 * M_PI);
    *taken = radius * tan(fabs(turn) / 2);
    return turn;
}

static moray_status lay(moray_path *path, const waypoints *through, double radius)
{
    double before = 0, taken, course = course_between(through->at[0], through->at[1]);
    for (int k = 0; k + 1 < through->n; k++) {
        const double *from = through->at[k], *to = through->at[k + 1];
        const double leg = hypot(to[0] - from[0], to[1] - from[1]);
        const double c = cos(course), s = sin(course), turn = turn_at(through, k + 1, radius, &taken);
        if (before + taken > leg * (1 + 1e-12))
            return moray_error(MORAY_INPUT,
                               "path: leg %d is %.4g m long, too short for arcs of radius %.4g m that turn by %.4g deg "
                               "at its end",
                               k + 1, leg, radius, turn / MORAY_DEGREE);
        add_piece(path, k + 1, from[0] + before * c, from[1] + before * s, course, leg - before - taken, 0);
        if (turn != 0)
            add_piece(path, k + 1, to[0] - taken * c, to[1] - taken * s, course, radius * fabs(turn),
                      turn > 0 ? 1 / radius : -1 / radius);
        before = taken;
        course += turn; // without jumps by a whole turn
    }
    return moray_ok();
}

moray_status moray_path_through(moray_path *path, const double (*waypoint)[2], int n, double radius)
{
    const waypoints through = {waypoint, n};
    *path = (moray_path){.radius = radius};
    MORAY_TRY(check(&through, radius));
    path->piece = calloc(2 * (size_t)n, sizeof *path->piece);
    if (!path->piece)
        return moray_error(MORAY_MEMORY, "no memory for a path of %d waypoints", n);
    const moray_status status = lay(path, &through, radius);
    if (moray_failed(status))
        moray_path_free(path);
    return status;
}

void moray_path_free(moray_path *path)
{
    free(path->piece);
    *path = (moray_path){0};
}

// ---- Eased corners -------------------------------------------------------------------------------------------------

// Two clothoids that take as much of the legs on either side as an arc does.
static void ease(moray_path *path, const moray_path_piece *arc)
{
    const double turn = fabs(arc->curvature * arc->length), side = arc->curvature < 0 ? -1 : 1;
    moray_path_piece unit = {.length = turn, .sharpness = 1 / turn}; // to curvature 1
    const moray_path_point end = moray_path_at(&(moray_path){1, &unit, turn, 1}, turn);
    const double taken = tan(turn / 2) / fabs(arc->curvature);
    const double peak = (creal(end.x) + creal(end.y) * tan(turn / 2)) / taken, length = turn / peak;
    moray_path_piece half = {arc->leg, path->length, arc->x, arc->y, arc->course, length, 0, side * peak / length};
    path->piece[path->n++] = half;
    path->length += length;
    const moray_path_point middle = moray_path_at(path, path->length);
    path->piece[path->n++] =
        (moray_path_piece){arc->leg, path->length, creal(middle.x), creal(middle.y), arc->course + side * turn / 2,
                           length,   side * peak,  -half.sharpness};
    path->length += length;
    path->radius = fmin(path->radius, 1 / peak);
}

moray_status moray_path_ease(moray_path *path)
{
    moray_path eased = {.radius = path->radius, .piece = calloc(2 * (size_t)path->n, sizeof *eased.piece)};
    if (!eased.piece)
        return moray_error(MORAY_MEMORY, "no memory for a path of %d pieces", path->n);
    for (int k = 0; k < path->n; k++) {
        if (path->piece[k].curvature != 0) {
            ease(&eased, &path->piece[k]);
            continue;
        }
        eased.piece[eased.n] = path->piece[k];
        eased.piece[eased.n++].start = eased.length;
        eased.length += path->piece[k].length;
    }
    moray_path_free(path);
    *path = eased;
    return moray_ok();
}

// ---- Points --------------------------------------------------------------------------------------------------------

static moray_num eased_course(const moray_path_piece *piece, moray_num s)
{
    return piece->course + s * (piece->curvature + piece->sharpness * s / 2);
}

// At s behind the start of an eased piece: Fresnel's integrals by Gauss's rule of ten points.
static moray_path_point eased_at(const moray_path_piece *piece, moray_num s)
{
    static const double node[] = {0.1488743389816312, 0.4333953941292472, 0.6794095682990244, 0.8650633666889845,
                                  0.9739065285171717},
                        weight[] = {0.29552422471475287, 0.2692667193099963, 0.21908636251598204, 0.1494513491505806,
                                    0.06667134430868814};
    moray_path_point at = {piece->x, piece->y, eased_course(piece, s), piece->curvature + piece->sharpness * creal(s)};
    for (int k = 0; k < 10; k++) {
        const moray_num course = eased_course(piece, s * (1 + (k % 2 ? node[k / 2] : -node[k / 2])) / 2);
        at.x += s * weight[k / 2] / 2 * cos(course);
        at.y += s * weight[k / 2] / 2 * sin(course);
    }
    return at;
}

// Straight on from a point.
static moray_path_point straight_on(moray_path_point at, moray_num s)
{
    return (moray_path_point){at.x + s * cos(at.course), at.y + s * sin(at.course), at.course, 0};
}

// At s behind the start of a piece.
static moray_path_point point_on(const moray_path_piece *piece, moray_num s)
{
    const double kappa = piece->curvature;
    const moray_path_point start = {piece->x, piece->y, piece->course, kappa};
    if (piece->sharpness != 0)
        return eased_at(piece, s);
    if (kappa == 0)
        return straight_on(start, s);
    const moray_num course = piece->course + kappa * s;
    return (moray_path_point){start.x + (sin(course) - sin(piece->course)) / kappa,
                              start.y - (cos(course) - cos(piece->course)) / kappa, course, kappa};
}

moray_path_point moray_path_at(const moray_path *path, moray_num along)
{
    const double where = creal(along), edge = fmin(fmax(where, 0), path->length);
    int k = 0;
    while (k + 1 < path->n && where >= path->piece[k + 1].start)
        k++;
    const moray_path_piece *piece = &path->piece[k];
    return where == edge ? point_on(piece, along - piece->start)
                         : straight_on(point_on(piece, edge - piece->start), along - edge);
}

void moray_path_project(const moray_path *path, double x, double y, double *along, double *across)
{
    enum { most = 100 };
    const double longest = path->radius / 2; // beyond, the course at the step's start says little of its end
    for (int k = 0; k < most; k++) {
        const moray_path_point at = moray_path_at(path, *along);
        const double c = cos(creal(at.course)), s = sin(creal(at.course));
        const double dx = x - creal(at.x), dy = y - creal(at.y), ahead = c * dx + s * dy;
        *across = c * dy - s * dx;
        const double step = ahead / fmax(1 - at.curvature * *across, 0.2);
        *along += fmin(fmax(step, -longest), longest);
        if (fabs(step) < 1e-10 * path->radius)
            break;
    }
}
