// SPDX-License-Identifier: MIT
//
// Paths against closed forms: points, nearest points, files, currents.
#include "degree.h"
#include "tap.h"

#include <string.h>

#include "moray/control/path.h"

// ---- Geometry ------------------------------------------------------------------------------------------------------

// Position by integrating the course, Simpson's rule, from the start on.
static void walk(const moray_path *path, double along, double p[2])
{
    enum { steps = 4000 };
    p[0] = creal(moray_path_at(path, 0).x);
    p[1] = creal(moray_path_at(path, 0).y);
    for (int i = 0; i <= 2 * steps; i++) {
        const double course = creal(moray_path_at(path, along * i / (2 * steps)).course);
        const double weight = (i == 0 || i == 2 * steps ? 1 : i % 2 ? 4 : 2) * along / (6 * steps);
        p[0] += weight * cos(course);
        p[1] += weight * sin(course);
    }
}

static void test_corner(void)
{
    moray_path path;
    CHECK_OK(moray_path_read(&path, "0,0 10,0 10,10", 2), "an L");
    CHECK(path.n == 3, "leg, arc, leg: %d pieces", path.n);
    CHECK_NEAR(path.length, 8 + M_PI + 8, 1e-13, "its length");
    const moray_path_point middle = moray_path_at(&path, 8 + M_PI / 2);
    CHECK_NEAR(creal(middle.x), 8 + sqrt(2), 1e-13, "x in the middle of the arc");
    CHECK_NEAR(creal(middle.y), 2 - sqrt(2), 1e-13, "y there");
    CHECK_NEAR(creal(middle.course), 45 * DEG, 1e-13, "course there");
    CHECK_NEAR(middle.curvature, 0.5, 1e-15, "curvature there");
    const moray_path_point before = moray_path_at(&path, -3), behind = moray_path_at(&path, path.length + 3);
    CHECK_NEAR(creal(before.x), -3, 1e-13, "straight on before the start");
    CHECK_NEAR(creal(behind.y), 13, 1e-12, "and behind the end");
    CHECK_NEAR(creal(behind.x), 10, 1e-12, "on the leg's line");
    CHECK(path.piece[1].leg == 1 && path.piece[2].leg == 2, "legs %d and %d", path.piece[1].leg, path.piece[2].leg);
    moray_path_free(&path);
}

// A path that ends in a corner, its last leg no longer than what the corner takes: straight on from there, eased or
// not.
static void test_corner_last(void)
{
    for (int eased = 0; eased < 2; eased++) {
        moray_path path;
        CHECK_OK(moray_path_through(&path, (const double[][2]){{0, 0}, {5, 0}, {5, 2 - 1e-13}}, 3, 2), "a corner last");
        if (eased)
            CHECK_OK(moray_path_ease(&path), "eased");
        const moray_path_point behind = moray_path_at(&path, path.length + 3);
        CHECK_NEAR(creal(behind.x), 5, 1e-9, "behind the corner on the leg's line");
        CHECK_NEAR(creal(behind.y), 5, 1e-9, "3 m further");
        CHECK_NEAR(creal(behind.course), 90 * DEG, 1e-12, "on its course");
        CHECK(behind.curvature == 0, "and straight");
        moray_path_free(&path);
    }
}

// Random polygons of legs long enough for their arcs.
static void test_continuity(void)
{
    unsigned long long seed = 11;
    for (int round = 0; round < 5; round++) {
        moray_path path;
        char text[300] = "";
        double p[2] = {1, -2}, worst = 0, worst_course = 0, worst_step = 0, course = 0;
        for (int k = 0; k < 6; k++) {
            snprintf(text + strlen(text), sizeof text - strlen(text), "%.17g,%.17g ", p[0], p[1]);
            course += tap_random(&seed, -2, 2);
            const double leg = tap_random(&seed, 4, 8);
            p[0] += leg * cos(course);
            p[1] += leg * sin(course);
        }
        CHECK_OK(moray_path_read(&path, text, 1), "a random path");
        for (int k = 1; k < path.n; k++) {
            const double at = path.piece[k].start, step = 1e-9;
            const moray_path_point a = moray_path_at(&path, at - step), b = moray_path_at(&path, at + step);
            worst = tap_worse(worst, hypot(creal(b.x - a.x), creal(b.y - a.y)));
            worst_course = tap_worse(worst_course, fabs(creal(b.course - a.course)));
        }
        for (int k = 0; k < 40; k++) { // complex step along the path
            const double at = tap_random(&seed, -1, path.length + 1), step = 1e-30;
            const moray_path_point here = moray_path_at(&path, moray_complex(at, step));
            worst_step = tap_worse(worst_step, fabs(cimag(here.x) / step - cos(creal(here.course))));
            worst_step = tap_worse(worst_step, fabs(cimag(here.y) / step - sin(creal(here.course))));
            worst_step = tap_worse(worst_step, fabs(cimag(here.course) / step - here.curvature));
        }
        CHECK(worst < 3e-9, "no jump between pieces: %.1e m", worst);
        CHECK(worst_course < 1e-8, "nor of the course: %.1e", worst_course);
        CHECK(worst_step < 1e-13, "derivatives are the course's and the curvature: %.1e", worst_step);
        walk(&path, path.length, p);
        const moray_path_point end = moray_path_at(&path, path.length);
        CHECK(hypot(p[0] - creal(end.x), p[1] - creal(end.y)) < 2e-3, "courses lead to the end");
        moray_path_free(&path);
    }
}

// Corners to both sides, by a right angle and nearly back: clothoids between the ends of the arcs.
static void test_eased(void)
{
    static const char *const texts[] = {"0,0 10,0 10,10 20,10", "0,0 20,0 1,2"};
    for (int round = 0; round < 2; round++) {
        moray_path arcs, path;
        double p[2], kinks = 0, worst = 0;
        CHECK_OK(moray_path_read(&arcs, texts[round], 0.5), "with arcs");
        CHECK_OK(moray_path_read(&path, texts[round], 0.5), "the same");
        CHECK_OK(moray_path_ease(&path), "eased");
        const moray_path_point arrived = moray_path_at(&arcs, arcs.length), end = moray_path_at(&path, path.length);
        CHECK_NEAR(creal(end.x), creal(arrived.x), 1e-12, "the same end");
        CHECK_NEAR(creal(end.y), creal(arrived.y), 1e-12, "the same end");
        CHECK_NEAR(creal(end.course), creal(arrived.course), 1e-12, "and course there");
        walk(&path, path.length, p);
        CHECK(hypot(p[0] - creal(end.x), p[1] - creal(end.y)) < 1e-4, "where the courses lead");
        for (int k = 1; k < path.n; k++) {
            const moray_path_piece *piece = &path.piece[k];
            const moray_path_point a = moray_path_at(&path, piece->start * (1 - 1e-13)),
                                   b = moray_path_at(&path, piece->start);
            kinks = tap_worse(kinks, fabs(a.curvature - b.curvature) + fabs(creal(a.course - b.course)));
            worst = tap_worse(worst, hypot(creal(b.x - a.x), creal(b.y - a.y)));
            const moray_path_point c = moray_path_at(&path, moray_complex(piece->start + piece->length / 3, 1e-30));
            worst = tap_worse(worst, fabs(cimag(c.x) / 1e-30 - cos(creal(c.course))));
            worst = tap_worse(worst, fabs(cimag(c.course) / 1e-30 - c.curvature));
        }
        CHECK(kinks < 1e-8, "neither course nor curvature jumps: %.1e", kinks);
        CHECK(worst < 1e-9, "one way, with its derivatives: %.1e", worst);
        CHECK(path.radius < 0.5 && path.radius > 0.1, "a corner between the same ends is narrower in its middle");
        moray_path_free(&arcs);
        moray_path_free(&path);
    }
}

static void test_projection(void)
{
    unsigned long long seed = 5;
    moray_path path;
    double worst = 0;
    CHECK_OK(moray_path_read(&path, "0,0 6,1 9,7 2,9", 1.5), "a path");
    for (int k = 0; k < 200; k++) {
        const double along = tap_random(&seed, -1, path.length + 1), across = tap_random(&seed, -0.8, 0.8);
        const moray_path_point at = moray_path_at(&path, along);
        const double course = creal(at.course);
        double found = along + tap_random(&seed, -0.4, 0.4), side;
        moray_path_project(&path, creal(at.x) - across * sin(course), creal(at.y) + across * cos(course), &found,
                           &side);
        worst = tap_worse(worst, fmax(fabs(found - along), fabs(side - across)));
    }
    CHECK(worst < 1e-8, "points beside the path are found again: %.1e m", worst);
    moray_path_free(&path);
}

// In any unit: a path of kilometres, and one of millimetres, is the same path.
static void test_units(void)
{
    static const double shape[][2] = {{0, 0}, {6, 1}, {9, 7}, {2, 9}}, units[] = {1, 1e3, 1e-3};
    double along[3], across[3], length[3];
    for (int k = 0; k < 3; k++) {
        double waypoint[4][2];
        moray_path path;
        for (int i = 0; i < 8; i++)
            waypoint[i / 2][i % 2] = units[k] * shape[i / 2][i % 2];
        CHECK_OK(moray_path_through(&path, (const double(*)[2])waypoint, 4, 1.5 * units[k]), "waypoints");
        along[k] = 0;
        moray_path_project(&path, 8.2 * units[k], 7.6 * units[k], &along[k], &across[k]);
        length[k] = path.length;
        moray_path_free(&path);
    }
    for (int k = 1; k < 3; k++) {
        CHECK_NEAR(length[k] / units[k], length[0], 1e-12, "length");
        CHECK_NEAR(along[k] / units[k], along[0], 1e-9, "nearest point, from far away");
        CHECK_NEAR(across[k] / units[k], across[0], 1e-9, "distance to it");
    }
}

// ---- Reading -------------------------------------------------------------------------------------------------------

static void check_refused(const char *text, double radius, moray_code code, const char *words)
{
    moray_path path;
    const moray_status status = moray_path_read(&path, text, radius);
    CHECK(status.code == code && strstr(status.text, words), "'%s': %s", text, status.text);
    CHECK(path.piece == NULL && path.n == 0, "nothing is left");
}

static void write_file(const char *name, const char *text)
{
    FILE *file = fopen(name, "w");
    if (file) {
        fputs(text, file);
        fclose(file);
    }
}

static void test_reading(void)
{
    const char *name = "test_path.csv";
    moray_path path;
    check_refused("0,0", 1, MORAY_INPUT, "must be at least 2");
    check_refused("0,0 1;2", 1, MORAY_INPUT, "1;2");
    check_refused("0,0 0,0 1,1", 1, MORAY_INPUT, "waypoint 2");
    check_refused("0,0 nan,1", 1, MORAY_INPUT, "nan");
    check_refused("0,0 5,0 5,1 0,1", 1, MORAY_INPUT, "leg 2 is 1 m long");
    check_refused("0,0 5,0 0,0", 1, MORAY_INPUT, "leg 1");
    check_refused("0,0 5,0", 0, MORAY_INPUT, "radius_m");
    check_refused("nowhere.csv", 1, MORAY_IO, "nowhere.csv");
    write_file(name, "x_m,y_m\n0,0\n3,4\n\n");
    CHECK_OK(moray_path_read(&path, name, 1), "a file");
    CHECK_NEAR(path.length, 5, 1e-14, "3, 4, 5");
    moray_path_free(&path);
    write_file(name, "x,y\n0,0\n3,4\n");
    check_refused(name, 1, MORAY_INPUT, ":1:");
    write_file(name, "x_m,y_m\n0,0\n3\n");
    check_refused(name, 1, MORAY_INPUT, ":3:");
    remove(name);
}

// ---- Currents ------------------------------------------------------------------------------------------------------

// The triangle of velocities: heading into the current by the crab angle, by the law of sines.
static double triangle(double speed, const double current[2], double course)
{
    const double from = atan2(current[1], current[0]) - course,
                 crab = asin(hypot(current[0], current[1]) * sin(from) / speed);
    return speed * cos(crab) + hypot(current[0], current[1]) * cos(from);
}

static void test_crab(void)
{
    const double speed = 0.25, current[2] = {0.1, -0.15}, course = 0.7;
    const double heading = course + moray_crab_angle(speed, current, course);
    const double v[2] = {speed * cos(heading) + current[0], speed * sin(heading) + current[1]};
    CHECK_NEAR(atan2(v[1], v[0]), course, 1e-14, "over ground along the course");
    CHECK_NEAR(hypot(v[0], v[1]), moray_course_made_good(speed, current, course), 1e-14, "at the speed made good");
    CHECK(isnan(moray_crab_angle(0.1, current, 0)) && isnan(moray_course_made_good(0.1, current, 0)),
          "no heading against too strong a current");
    for (int side = -1; side < 2; side += 2)
        CHECK(isnan(moray_crab_angle(0.25, (double[]){0.1, side * 0.25}, 0)) &&
                  isnan(moray_course_made_good(0.25, (double[]){0.1, side * 0.25}, 0)),
              "nor where all speed goes across, %d", side);
}

static void test_currents(void)
{
    const double speed = 0.25, current[2] = {0.1, -0.15}, still[2] = {0, 0};
    const double across[2] = {0, 0.26}, against[2] = {-0.26, 0}, with[2] = {0.5, 0};
    moray_path path;
    CHECK_OK(moray_path_read(&path, "0,0 6,8", 1), "one leg");
    CHECK_NEAR(moray_path_duration(&path, 4, speed, current), 6 / triangle(speed, current, atan2(8, 6)), 1e-10,
               "duration of a leg");
    moray_path_free(&path);
    CHECK_OK(moray_path_read(&path, "0,0 10,0 10,10", 2), "an L");
    CHECK_NEAR(moray_path_duration(&path, 0, speed, still), path.length / speed, 1e-10, "still water");
    enum { steps = 1000 };
    double seconds = 8 / triangle(speed, current, 0) + 8 / triangle(speed, current, M_PI / 2);
    for (int k = 0; k <= 2 * steps; k++) {
        const double weight = (k == 0 || k == 2 * steps ? 1 : k % 2 ? 4 : 2) * M_PI / (6 * steps);
        seconds += weight / triangle(speed, current, M_PI / 2 * k / (2 * steps));
    }
    CHECK_NEAR(moray_path_duration(&path, 0, speed, current), seconds, 1e-4, "legs and arc");
    CHECK_OK(moray_path_passable(&path, speed, current), "passable");
    CHECK_OK(moray_path_passable(&path, 0.53, with), "a strong one from behind, to be crossed later");
    moray_status status = moray_path_passable(&path, speed, across);
    CHECK(status.code == MORAY_NOT_SOLVED && strstr(status.text, "on leg 1") && strstr(status.text, "0.26") &&
              strstr(status.text, "0.25"),
          "across: %s", status.text);
    CHECK(isnan(moray_path_duration(&path, 0, speed, across)), "no duration");
    status = moray_path_passable(&path, speed, against);
    CHECK(status.code == MORAY_NOT_SOLVED && strstr(status.text, "on leg 1"), "against: %s", status.text);
    status = moray_path_passable(&path, speed, with);
    CHECK(status.code == MORAY_NOT_SOLVED && strstr(status.text, "in the corner behind leg 1"), "%s", status.text);
    CHECK(strstr(status.text, "within 30 deg of 0 deg"), "twice as fast as it swims, from behind: asin(1/2)");
    moray_path_free(&path);
}

int main(void)
{
    test_corner();
    test_corner_last();
    test_continuity();
    test_eased();
    test_projection();
    test_units();
    test_reading();
    test_crab();
    test_currents();
    return tap_done();
}
