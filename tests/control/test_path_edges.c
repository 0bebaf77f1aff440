// SPDX-License-Identifier: MIT
//
// Paths at their edges: where pieces meet, legs that are just long enough, points next to a bend's centre, and currents
// that just stop a vehicle.
#define _GNU_SOURCE // uselocale
#include "degree.h"
#include "tap.h"

#include <locale.h>
#include <string.h>

#include "moray/control/path.h"

// Where a piece begins it counts, with its curvature; before it the one before.
static void test_joints(bool eased)
{
    moray_path path;
    CHECK_OK(moray_path_read(&path, "0,0 10,1 12,9 3,12", 1.5), "a path");
    if (eased)
        CHECK_OK(moray_path_ease(&path), "eased");
    for (int k = 0; k < path.n; k++) {
        const moray_path_piece *piece = &path.piece[k];
        const moray_path_point at = moray_path_at(&path, piece->start);
        CHECK(creal(at.x) == piece->x && creal(at.y) == piece->y && creal(at.course) == piece->course &&
                  at.curvature == piece->curvature,
              "piece %d begins in (%g, %g), with curvature %g", k, creal(at.x), creal(at.y), at.curvature);
        if (k == 0)
            continue;
        const moray_path_piece *last = piece - 1;
        const moray_path_point before = moray_path_at(&path, nextafter(piece->start, 0));
        CHECK_NEAR(before.curvature, last->curvature + last->sharpness * last->length, 1e-9, "curvature before it");
        CHECK_NEAR(creal(before.x), piece->x, 1e-9, "in the same place");
        CHECK_NEAR(creal(before.y), piece->y, 1e-9, "in y too");
    }
    const moray_path_point end = moray_path_at(&path, path.length), beyond = moray_path_at(&path, path.length + 2);
    CHECK_NEAR(creal(beyond.x), creal(end.x) + 2 * cos(creal(end.course)), 1e-12, "straight on behind the end");
    CHECK_NEAR(creal(beyond.y), creal(end.y) + 2 * sin(creal(end.course)), 1e-12, "in y too");
    moray_path_free(&path);
}

// Two right angles take all of the leg between them, but for rounding.
static void test_just(void)
{
    static const double excess[] = {-1e-9, 0, 2.3e-16, 1e-13, 1e-10, 1e-9};
    for (int k = 0; k < 6; k++) {
        moray_path path;
        const double waypoint[][2] = {{0, 0}, {9, 0}, {9, 4}, {0, 4}};
        const moray_status status = moray_path_through(&path, waypoint, 4, 2 * (1 + excess[k]));
        CHECK(moray_failed(status) == (excess[k] > 1e-12), "more than the leg by %g: %s", excess[k], status.text);
        CHECK(moray_failed(status) || excess[k] == 0 || path.n == (excess[k] < 0 ? 5 : 4), "%d pieces", path.n);
        for (int i = 0; i < path.n; i++)
            CHECK(path.piece[i].length > 0, "piece %d is %g m long", i, path.piece[i].length);
        moray_path_free(&path);
    }
}

// A small bend from next to its centre, where each step covers a part of what is left.
static void test_small(void)
{
    const double radius = 1e-3;
    moray_path path;
    const double waypoint[][2] = {{0, 0}, {0.02, 0}, {0.02, 0.02}};
    CHECK_OK(moray_path_through(&path, waypoint, 3, radius), "a path");
    for (int k = 1; k < 9; k++) {
        const double angle = 10 * k * DEG, out = 0.1 * radius;
        double along = path.piece[1].start + 0.5 * radius, across;
        moray_path_project(&path, 0.019 + out * sin(angle), radius - out * cos(angle), &along, &across);
        CHECK_NEAR(along, 0.019 + radius * angle, 1e-11, "along the bend");
        CHECK_NEAR(across, 0.9 * radius, 1e-14, "to its inside");
    }
    moray_path_free(&path);
}

// Exactly against a current as fast as the vehicle there is no way.
static void test_no_way(void)
{
    static const double against[2] = {-1, 0}, aside[2] = {0, 1};
    moray_path path;
    CHECK(moray_course_made_good(1, against, 0) == 0, "no way");
    CHECK_OK(moray_path_read(&path, "0,0 10,0", 1), "a leg");
    CHECK(moray_path_passable(&path, 1, against).code == MORAY_NOT_SOLVED, "is not passable");
    CHECK(isnan(moray_path_duration(&path, 0, 1, against)), "in no time");
    CHECK(isnan(moray_crab_angle(1, aside, 0)) && isnan(moray_crab_angle(1, aside, 180 * DEG)), "nor by any heading");
    CHECK_OK(moray_path_passable(&path, 1.001, against), "faster it is");
    CHECK_RELATIVE(moray_path_duration(&path, 4, 1.5, against), 12, 1e-9, "6 m at 0.5 m/s");
    moray_path_free(&path);
}

// Only the path's own courses count.
static void test_own_courses(void)
{
    static const double current[2] = {-0.3, 0.3};
    moray_path path;
    CHECK_OK(moray_path_read(&path, "0,0 0,10 -1,20", 2), "to the north");
    CHECK_OK(moray_path_passable(&path, 0.35, current), "with the current");
    moray_path_free(&path);
    CHECK_OK(moray_path_read(&path, "0,0 10,0", 2), "to the east");
    CHECK(moray_failed(moray_path_passable(&path, 0.35, current)), "against it");
    moray_path_free(&path);
    // Courses within asin(5/8) of the current, 38.7 deg, are made good: a bend to 38 deg ends before.
    const double turn = 38 * DEG, waypoint[][2] = {{0, 0}, {10, 0}, {10 + 10 * cos(turn), 10 * sin(turn)}};
    CHECK_OK(moray_path_through(&path, waypoint, 3, 4), "a bend");
    CHECK_OK(moray_path_passable(&path, 0.25, (double[]){0.4, 0}), "as far as it turns");
    moray_path_free(&path);
    const locale_t before = uselocale((locale_t)0);
    CHECK_OK(moray_path_read(&path, "0,0 10,0", 2), "a list");
    CHECK(uselocale((locale_t)0) == before, "leaves the locale");
    moray_path_free(&path);
}

// In an eased corner the course told is the path's where it is told to be.
static void test_eased_course(void)
{
    moray_path path;
    double along = NAN, course = NAN;
    CHECK_OK(moray_path_read(&path, "0,0 10,0 10,10", 4), "a path");
    CHECK_OK(moray_path_ease(&path), "eased");
    const moray_status status = moray_path_passable(&path, 0.3, (double[]){0.4, -0.1});
    const char *const where = strstr(status.text, "in the corner behind leg 1, ");
    CHECK(where && sscanf(where, "in the corner behind leg 1, %lf m along the path, its course is %lf deg", &along,
                          &course) == 2,
          "%s", status.text);
    CHECK(along > path.piece[1].start + 0.5 && along < path.piece[3].start - 0.5, "well in the corner: %g m", along);
    CHECK_NEAR(course, creal(moray_path_at(&path, along).course) / DEG, 0.02, "its course");
    moray_path_free(&path);
}

int main(void)
{
    test_joints(false);
    test_joints(true);
    test_just();
    test_small();
    test_no_way();
    test_own_courses();
    test_eased_course();
    return tap_done();
}
