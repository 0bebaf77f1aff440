// SPDX-License-Identifier: MIT
//
// The shortest way from pose to pose in moving water: arcs of one radius and legs (Dubins, 1957), as a guess.
#include "snake/steer/dubins.h"

#include <math.h>
#include <string.h>

static double around(double angle)
{
    const double turn = fmod(angle, 2 * M_PI);
    return turn < 0 ? turn + 2 * M_PI : turn;
}

// The two arcs and the leg between them, in radii; false where there are none.
static bool arc_leg_arc(double x, double y, double heading, double first, double last, double length[3])
{
    // Centres of the circles, and the leg that touches both: on the same sides of it or on opposite ones.
    const double dx = x - last * sin(heading), dy = y + last * cos(heading) - first, apart = hypot(dx, dy);
    const bool crossed = first != last;
    if (crossed && apart < 2)
        return false;
    length[1] = crossed ? sqrt(apart * apart - 4) : apart;
    const double course = atan2(dy, dx) + (crossed ? first * atan2(2, length[1]) : 0);
    length[0] = around(first * course);
    length[2] = around(last * (heading - course));
    return true;
}

// Three arcs, the middle one the other way and longer than half a circle; those that begin to the right in a mirror.
static bool three_arcs(double x, double y, double heading, double first, double length[3])
{
    const double h = first * heading, dx = x - sin(h), dy = first * y + cos(h) - 1, apart = hypot(dx, dy);
    if (apart > 4)
        return false;
    for (int side = -1; side <= 1; side += 2) {
        const double to_middle = atan2(dy, dx) + side * acos(apart / 4); // from the first centre
        const double back = atan2(2 * sin(to_middle) - dy, 2 * cos(to_middle) - dx), quarter = M_PI / 2;
        length[0] = around(to_middle + quarter);
        length[1] = around(to_middle - back);
        length[2] = around(h - back - quarter);
        if (length[1] >= M_PI)
            return true;
    }
    return false;
}

static bool turns_by(const double turn[3], const double length[3], double heading)
{
    double sum = 0;
    for (int k = 0; k < 3; k++)
        sum += turn[k] * length[k];
    return fabs(sum - heading) < 1e-6;
}

bool moray_dubins_way(int kind, double x, double y, double heading, moray_dubins *path)
{
    static const double turns[MORAY_DUBINS_KINDS][3] = {{1, 0, 1},  {-1, 0, -1}, {1, 0, -1},
                                                        {-1, 0, 1}, {1, -1, 1},  {-1, 1, -1}};
    const double *turn = turns[kind];
    double length[3];
    const bool exists = turn[1] == 0 ? arc_leg_arc(x, y, heading, turn[0], turn[2], length)
                                     : three_arcs(x, y, heading, turn[0], length);
    if (!exists || !turns_by(turn, length, heading))
        return false;
    memcpy(path->turn, turn, sizeof path->turn);
    memcpy(path->length, length, sizeof path->length);
    return true;
}

static double length_of(const moray_dubins *path)
{
    return path->length[0] + path->length[1] + path->length[2];
}

bool moray_dubins_in_current(int kind, const double end[2], double heading, const double current[2], double speed,
                             double radius, double longest, moray_dubins *path, double *seconds)
{
    enum { steps = 2000 };
    for (int k = 1; k <= steps; k++) {
        const double t = longest * k / steps;
        if (moray_dubins_way(kind, (end[0] - current[0] * t) / radius, (end[1] - current[1] * t) / radius, heading,
                             path) &&
            length_of(path) * radius <= speed * t) {
            *seconds = t;
            return true;
        }
    }
    return false;
}
