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

static const double turns[MORAY_DUBINS_KINDS][3] = {{1, 0, 1},  {-1, 0, -1}, {1, 0, -1},
                                                    {-1, 0, 1}, {1, -1, 1},  {-1, 1, -1}};

// A way of each kind is found again from where it ends; with a whole turn more in its heading it is none.
static void test_kinds(void)
{
    unsigned long long seed = 17;
    for (int kind = 0; kind < MORAY_DUBINS_KINDS; kind++) {
        double worst = 0;
        int found = 0, false_ways = 0;
        const bool arcs = turns[kind][1] != 0;
        for (int k = 0; k < 200; k++) {
            moray_dubins made, way;
            double end[3], again[3];
            for (int part = 0; part < 3; part++) {
                made.turn[part] = turns[kind][part];
                made.length[part] = part != 1 ? tap_random(&seed, 0.01, 2 * M_PI - 0.01)
                                    : arcs    ? tap_random(&seed, M_PI + 0.01, 2 * M_PI - 0.01)
                                              : tap_random(&seed, 0.01, 5);
            }
            follow(&made, end);
            for (int side = -1; side <= 1; side += 2)
                false_ways += moray_dubins_way(kind, end[0], end[1], end[2] + side * 6 * M_PI, &way);
            if (!moray_dubins_way(kind, end[0], end[1], end[2], &way))
                continue;
            found++;
            follow(&way, again);
            for (int i = 0; i < 3; i++) {
                worst = tap_worse(worst, fabs(again[i] - end[i]));
                worst = tap_worse(worst, arcs ? 0 : fabs(way.length[i] - made.length[i]));
                worst = tap_worse(worst, fabs(way.turn[i] - turns[kind][i]));
            }
        }
        CHECK(found == 200 || (arcs && found > 150), "kind %d: %d of 200 found again", kind, found);
        CHECK(worst < 1e-6, "to where they end: %.1e", worst);
        CHECK(false_ways == 0, "none turns three times round more");
    }
}

// Whether a way to where the moving water has brought the end can be swum in that time.
static bool in_time(int kind, const double end[2], double heading, const double current[2], double speed, double radius,
                    double t, moray_dubins *path)
{
    return moray_dubins_way(kind, (end[0] - current[0] * t) / radius, (end[1] - current[1] * t) / radius, heading,
                            path) &&
           length_of(path) * radius <= speed * t;
}

// The first of two thousand times.
static void test_current(void)
{
    unsigned long long seed = 23;
    int found = 0, early = 0;
    for (int k = 0; k < 120; k++) {
        const double end[2] = {tap_random(&seed, -6, 6), tap_random(&seed, -6, 6)},
                     current[2] = {tap_random(&seed, -0.2, 0.2), tap_random(&seed, -0.2, 0.2)},
                     heading = tap_random(&seed, -4, 4), speed = tap_random(&seed, 0.3, 0.6),
                     radius = tap_random(&seed, 0.3, 2), longest = tap_random(&seed, 20, 90);
        const int kind = k % MORAY_DUBINS_KINDS;
        moray_dubins path = {{0}, {0}}, want;
        double seconds;
        int first = 1;
        while (first <= 2000 && !in_time(kind, end, heading, current, speed, radius, longest * first / 2000, &want))
            first++;
        const bool there =
            moray_dubins_in_current(kind, end, heading, current, speed, radius, longest, &path, &seconds);
        found += there;
        if (there != (first <= 2000) || (there && (fabs(seconds - longest * first / 2000) > 1e-9 ||
                                                   fabs(length_of(&path) - length_of(&want)) > 1e-9)))
            early++;
    }
    CHECK(found > 20 && early == 0, "%d ways in a current, %d of them at another time", found, early);
}

int main(void)
{
    test_kinds();
    test_current();
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
