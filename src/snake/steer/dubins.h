// SPDX-License-Identifier: MIT
#ifndef SRC_SNAKE_STEER_DUBINS_H
#define SRC_SNAKE_STEER_DUBINS_H

#include <stdbool.h>

// Three parts of a way: turning left (1), right (-1) or straight on (0); lengths in radii of the arcs.
typedef struct moray_dubins {
    double turn[3], length[3];
} moray_dubins;

enum { MORAY_DUBINS_KINDS = 6 }; // orders of turns; four with a leg in the middle, two with an arc

// The way of one kind, at most one turn an arc, from (0, 0), heading 0, to (x, y) in radii that turns by `heading`
// [rad]; false where no such way turns by that.
bool moray_dubins_way(int kind, double x, double y, double heading, moray_dubins *path);

// The way of one kind to `end` over ground [m] at a speed through water that moves [m/s]: the first time, of a row of
// them up to `longest`, in which it can be made [s]. False where there is none.
bool moray_dubins_in_current(int kind, const double end[2], double heading, const double current[2], double speed,
                             double radius, double longest, moray_dubins *path, double *seconds);

#endif
