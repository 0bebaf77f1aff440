// SPDX-License-Identifier: MIT
//
// Paths in the plane: straight legs joined by arcs, the distance along them, and how a vehicle of a given speed makes
// way along them in a current. Lengths in m, courses in rad from the x axis to the left.
#ifndef MORAY_CONTROL_PATH_H
#define MORAY_CONTROL_PATH_H

#include "moray/export.h"
#include "moray/num.h"
#include "moray/status.h"

MORAY_BEGIN

// A straight leg (curvature and sharpness 0), an arc, or half of an eased corner.
typedef struct moray_path_piece {
    int leg;                  // from waypoint `leg` to the next, counted from 1; of an arc the leg before it
    double start;             // distance along the path where it begins [m]
    double x, y, course;      // there [m], [rad]
    double length, curvature; // [m]; where it begins [1/m], positive to the left
    double sharpness;         // by which the curvature grows along it [1/m2]
} moray_path_piece;

typedef struct moray_path {
    int n;
    moray_path_piece *piece; // owned
    double length;           // [m]
    double radius;           // of the arcs, or the least of the eased corners [m]
} moray_path;

// Through n >= 2 waypoints x, y [m]: straight legs joined by arcs of that radius [m] in the corners. Free with
// moray_path_free. Error: MORAY_INPUT, also where a leg is too short for its arcs; MORAY_MEMORY.
MORAY_API moray_status moray_path_through(moray_path *path, const double (*waypoint)[2], int n, double radius);

// The same through waypoints "X,Y X,Y ..." [m], or those of a CSV file of the columns x_m and y_m.
// Error: those, and MORAY_IO.
MORAY_API moray_status moray_path_read(moray_path *path, const char *text, double radius);

// Makes of every arc a corner whose curvature grows from 0 and falls back to it evenly, two clothoids in place of the
// arc between the same ends: nowhere does the curvature jump. Error: MORAY_MEMORY.
MORAY_API moray_status moray_path_ease(moray_path *path);
MORAY_API void moray_path_free(moray_path *path); // safe on a zeroed path, and twice

// The point at a distance along the path, which goes on straight before its start and behind its end. Analytic in
// `along` on every piece, so that problems may call it.
typedef struct moray_path_point {
    moray_num x, y, course; // [m], [m], [rad]
    double curvature;       // [1/m]
} moray_path_point;
#ifndef __cplusplus // which passes complex numbers by value in another way
MORAY_API moray_path_point moray_path_at(const moray_path *path, moray_num along);
#endif

// The point of the path nearest to (x, y) of those near the distance `along`: its distance, and how far to the left of
// the path (x, y) lies [m].
MORAY_API void moray_path_project(const moray_path *path, double x, double y, double *along, double *across);

// ---- In a current --------------------------------------------------------------------------------------------------

// The angle, from the course to the left, at which a vehicle of this speed through the water must head to keep the
// course in the current (all [m/s]); NaN where the current across is no less than its speed [rad].
MORAY_API double moray_crab_angle(double speed, const double current[2], double course);

// The speed over ground that it then makes along the course, below 0 where it is driven astern; NaN as above [m/s].
MORAY_API double moray_course_made_good(double speed, const double current[2], double course);

// Whether such a vehicle makes way along the whole path. Error: MORAY_NOT_SOLVED naming the leg and the numbers where
// it does not.
MORAY_API moray_status moray_path_passable(const moray_path *path, double speed, const double current[2]);

// How long it takes from a distance along the path to its end; NaN where it makes no way [s].
MORAY_API double moray_path_duration(const moray_path *path, double along, double speed, const double current[2]);

MORAY_END

#endif
