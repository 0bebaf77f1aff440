// SPDX-License-Identifier: MIT
//
// Ways of arcs and legs followed to their end, which shares nothing with how they were found.
#include "tap.h"

#include <math.h>

#include "snake/steer/dubins.h"

static void follow(const moray_dubins *path, double end[3])
{
    double x = 0, y = 0, heading = 0;
    for (int k = 0; k < 3; k++) {
        const double turn = path->turn[k], length = path->length[k], after = heading + turn * length;
        x += turn == 0 ? length * cos(heading) : (sin(after) - sin(heading)) / turn;
        y += turn == 0 ? length * sin(heading) : (cos(heading) - cos(after)) / turn;
        heading = after;
    }
    end[0] = x;
    end[1] = y;
    end[2] = heading;
}

static double length_of(const moray_dubins *path)
{
    return path->length[0] + path->length[1] + path->length[2];
}

// The shortest way of all kinds.
static bool shortest(double x, double y, double heading, moray_dubins *path)
{
    double least = INFINITY;
    for (int kind = 0; kind < MORAY_DUBINS_KINDS; kind++) {
        moray_dubins way;
        if (!moray_dubins_way(kind, x, y, heading, &way) || length_of(&way) >= least)
            continue;
        least = length_of(&way);
        *path = way;
    }
    return isfinite(least);
}

// The least time of all kinds [s].
static double soonest(const double end[2], double heading, const double current[2])
{
    double least = INFINITY;
    for (int kind = 0; kind < MORAY_DUBINS_KINDS; kind++) {
        moray_dubins path;
        double seconds;
        if (moray_dubins_in_current(kind, end, heading, current, 0.25, 1, 100, &path, &seconds))
            least = fmin(least, seconds);
    }
    return least;
}

int main(void)
{
    unsigned long long seed = 5;
    double worst = 0, most = 0;
    int found = 0, n = 2000;
    for (int k = 0; k < n; k++) {
        const double x = tap_random(&seed, -6, 6), y = tap_random(&seed, -6, 6), heading = tap_random(&seed, -4, 4);
        moray_dubins path;
        double end[3];
        if (!shortest(x, y, heading, &path))
            continue;
        follow(&path, end);
        found++;
        worst = tap_worse(worst, fabs(end[0] - x) + fabs(end[1] - y) + fabs(end[2] - heading));
        most = fmax(most, hypot(x, y) - length_of(&path));
    }
    CHECK(found > n / 2, "%d of %d poses have a way", found, n);
    CHECK(worst < 1e-9, "each ends where it is to, heading included: %.1e", worst);
    CHECK(most < 1e-9, "none is shorter than straight on: %.1e", most);

    moray_dubins path;
    CHECK(shortest(0, 2, M_PI, &path) && fabs(length_of(&path) - M_PI) < 1e-9, "half a circle where that does it");
    CHECK(shortest(0, 1, M_PI, &path) && path.turn[1] != 0, "three arcs where the end is too near");
    const double away[2] = {0, 2}, current[2] = {0.1, 0.1}, none[2] = {0, 0}, strong[2] = {0.5, 0};
    const double still = soonest(away, M_PI, none), moved = soonest(away, M_PI, current);
    CHECK(fabs(still - M_PI / 0.25) < 0.06, "in still water the length over the speed: %g s", still);
    CHECK(moved > still && moved < INFINITY, "longer against the current: %g s", moved);
    CHECK(soonest((double[2]){-5, 0}, 0, strong) == INFINITY, "never against one that is too strong");
    return tap_done();
}
