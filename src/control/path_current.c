// SPDX-License-Identifier: MIT
//
// The triangle of velocities: through the water, of the water, over ground.
#include <math.h>

#include "moray/control/path.h"

static double across(const double current[2], double course)
{
    return current[1] * cos(course) - current[0] * sin(course);
}

static double along(const double current[2], double course)
{
    return current[0] * cos(course) + current[1] * sin(course);
}

double moray_crab_angle(double speed, const double current[2], double course)
{
    const double side = across(current, course);
    return fabs(side) < speed ? -asin(side / speed) : NAN;
}

double moray_course_made_good(double speed, const double current[2], double course)
{
    return speed * cos(moray_crab_angle(speed, current, course)) + along(current, course);
}

double moray_path_duration(const moray_path *path, double from, double speed, const double current[2])
{
    enum { steps = 2000 };
    const double step = (path->length - from) / steps;
    double seconds = 0;
    for (int i = 0; i < steps; i++) {
        const double course = creal(moray_path_at(path, from + (i + 0.5) * step).course);
        const double way = moray_course_made_good(speed, current, course);
        seconds += way > 0 ? step / way : NAN;
    }
    return seconds;
}

// Courses that can be made good are those near the current's own: within asin(speed / current).
static moray_status too_strong(const moray_path_piece *piece, double from_start, double course, double speed,
                               const double current[2])
{
    const double degree = M_PI / 180;
    return moray_error(
        MORAY_NOT_SOLVED,
        "the current is too strong for the path: %s leg %d, %.4g m along the path, its course is %.4g "
        "deg, %.4g m/s run across it and %.4g m/s against it, and the speed through the water is %.4g "
        "m/s, which makes good courses within %.3g deg of %.4g deg alone",
        piece->curvature != 0 || piece->sharpness != 0 ? "in the corner behind" : "on", piece->leg,
        piece->start + from_start, course / degree, fabs(across(current, course)), 0.0 - along(current, course), speed,
        asin(fmin(speed / hypot(current[0], current[1]), 1)) / degree, atan2(current[1], current[0]) / degree);
}

moray_status moray_path_passable(const moray_path *path, double speed, const double current[2])
{
    enum { points = 33 };
    for (int k = 0; k < path->n; k++)
        for (int i = 0; i < points; i++) {
            const moray_path_piece *piece = &path->piece[k];
            const double from_start = piece->length * i / (points - 1);
            const double course = piece->course + from_start * (piece->curvature + piece->sharpness * from_start / 2);
            if (moray_course_made_good(speed, current, course) > 0)
                continue;
            return too_strong(piece, from_start, course, speed, current);
        }
    return moray_ok();
}
