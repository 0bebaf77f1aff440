// SPDX-License-Identifier: MIT
//
// Paths to either side: pieces by hand, the mirror image of a path, points well inside its bends, and every text.
#include "degree.h"
#include "tap.h"

#include <string.h>

#include "moray/control/path.h"

// ---- Pieces --------------------------------------------------------------------------------------------------------

static void check_piece(const moray_path_piece *got, moray_path_piece want)
{
    CHECK(got->leg == want.leg, "of leg %d, not %d", got->leg, want.leg);
    CHECK_NEAR(got->start, want.start, 1e-12, "start");
    CHECK_NEAR(got->x, want.x, 1e-12, "x");
    CHECK_NEAR(got->y, want.y, 1e-12, "y");
    CHECK_NEAR(got->course, want.course, 1e-12, "course");
    CHECK_NEAR(got->length, want.length, 1e-12, "length");
    CHECK_NEAR(got->curvature, want.curvature, 1e-12, "curvature");
    CHECK(got->sharpness == want.sharpness, "sharpness %g", got->sharpness);
}

// Up, to the right, to the left by as much.
static void test_pieces(void)
{
    moray_path path;
    const double waypoint[][2] = {{1, 2}, {1, 7}, {6, 7}, {6, 10}};
    CHECK_OK(moray_path_through(&path, waypoint, 4, 2), "a path");
    CHECK(path.n == 5 && path.radius == 2, "leg, arc, leg, arc, leg: %d pieces", path.n);
    check_piece(&path.piece[0], (moray_path_piece){1, 0, 1, 2, 90 * DEG, 3, 0, 0});
    check_piece(&path.piece[1], (moray_path_piece){1, 3, 1, 5, 90 * DEG, M_PI, -0.5, 0});
    check_piece(&path.piece[2], (moray_path_piece){2, 3 + M_PI, 3, 7, 0, 1, 0, 0});
    check_piece(&path.piece[3], (moray_path_piece){2, 4 + M_PI, 4, 7, 0, M_PI, 0.5, 0});
    check_piece(&path.piece[4], (moray_path_piece){3, 4 + 2 * M_PI, 6, 9, 90 * DEG, 1, 0, 0});
    CHECK_NEAR(path.length, 5 + 2 * M_PI, 1e-12, "length");
    moray_path_free(&path);
}

// Two clothoids of a corner to the right: as sharp as each other, one turns as much as the other.
static void test_eased_pieces(void)
{
    moray_path path;
    CHECK_OK(moray_path_through(&path, (const double[][2]){{0, 0}, {8, 0}, {8, -6}}, 3, 2), "a path");
    CHECK_OK(moray_path_ease(&path), "eased");
    CHECK(path.n == 4, "leg, two halves, leg: %d pieces", path.n);
    const moray_path_piece *one = &path.piece[1], *other = &path.piece[2], *leg = &path.piece[3];
    CHECK(one->leg == 1 && other->leg == 1 && leg->leg == 2, "of their legs");
    CHECK_NEAR(one->start, 6, 1e-12, "begins where the arc does");
    CHECK_NEAR(one->x, 6, 1e-12, "at its x");
    CHECK_NEAR(one->y, 0, 1e-12, "and y");
    CHECK(one->curvature == 0 && one->sharpness < 0, "to the right from no curvature");
    CHECK_NEAR(other->curvature, one->sharpness * one->length, 1e-12, "on from where it came to");
    CHECK_NEAR(other->sharpness, -one->sharpness, 1e-12, "back as sharply");
    CHECK_NEAR(other->length, one->length, 1e-12, "as long");
    CHECK_NEAR(one->sharpness * one->length * one->length / 2, -45 * DEG, 1e-12, "half the turn");
    CHECK_NEAR(other->course, -45 * DEG, 1e-12, "in its middle");
    CHECK_NEAR(other->x - other->y, 8, 1e-9, "on the line of symmetry");
    CHECK_NEAR(leg->start, 6 + 2 * one->length, 1e-12, "then the leg");
    CHECK_NEAR(path.length, leg->start + leg->length, 1e-12, "all of it");
    CHECK_NEAR(path.radius, -1 / other->curvature, 1e-12, "the least radius");
    moray_path_free(&path);
}

// The least radius of several corners is that of the sharpest; wide ones leave it.
static void test_least_radius(void)
{
    double alone[2];
    for (int k = 0; k < 3; k++) {
        moray_path path;
        const double waypoints[3][5][2] = {
            {{0, 0}, {10, 0}, {18, 3}}, {{0, 0}, {10, 0}, {10, 10}}, {{0, 0}, {10, 0}, {10, 10}, {13, 18}}};
        CHECK_OK(moray_path_through(&path, waypoints[k], k < 2 ? 3 : 4, 1.5), "a path");
        CHECK_OK(moray_path_ease(&path), "eased");
        if (k < 2)
            alone[k] = path.radius;
        else
            CHECK_NEAR(path.radius, fmin(alone[0], alone[1]), 1e-9, "of the sharper corner");
        CHECK(path.radius < 1.5, "narrower than the arc: %g m", path.radius);
        moray_path_free(&path);
    }
    CHECK(fabs(alone[0] - alone[1]) > 0.01, "corners of %g m and %g m", alone[0], alone[1]);
}

// ---- Mirror images -------------------------------------------------------------------------------------------------

static void test_mirror(bool eased)
{
    enum { n = 5 };
    static const double shape[n][2] = {{0, 0}, {6, 1}, {9, 7}, {4, 11}, {-2, 8}};
    unsigned long long seed = 3;
    moray_path path[2];
    double worst = 0;
    for (int side = 0; side < 2; side++) {
        double waypoint[n][2];
        for (int k = 0; k < n; k++) {
            waypoint[k][0] = shape[k][0];
            waypoint[k][1] = side ? -shape[k][1] : shape[k][1];
        }
        CHECK_OK(moray_path_through(&path[side], (const double(*)[2])waypoint, n, 1.2), "a path");
        if (eased)
            CHECK_OK(moray_path_ease(&path[side]), "eased");
    }
    CHECK_NEAR(path[0].length, path[1].length, 1e-12, "as long");
    CHECK_NEAR(path[0].radius, path[1].radius, 1e-12, "as wide");
    for (int k = 0; k < 100; k++) {
        const double along = tap_random(&seed, -2, path[0].length + 2);
        const moray_path_point a = moray_path_at(&path[0], along), b = moray_path_at(&path[1], along);
        worst = tap_worse(worst, hypot(creal(a.x) - creal(b.x), creal(a.y) + creal(b.y)));
        worst = tap_worse(worst, fabs(creal(a.course) + creal(b.course)) + fabs(a.curvature + b.curvature));
        double found[2] = {along + 0.3, along + 0.3}, off[2];
        const double x = creal(a.x) + tap_random(&seed, -0.4, 0.4), y = creal(a.y) + tap_random(&seed, -0.4, 0.4);
        moray_path_project(&path[0], x, y, &found[0], &off[0]);
        moray_path_project(&path[1], x, -y, &found[1], &off[1]);
        worst = tap_worse(worst, fabs(found[0] - found[1]) + fabs(off[0] + off[1]));
    }
    CHECK_NEAR(worst, 0, 1e-8, "points, courses, curvatures, distances, the other way round");
    for (int side = 0; side < 2; side++)
        moray_path_free(&path[side]);
}

// Next to the centre of a bend its nearest point is still found, from far off it and either way along.
static void test_inside(void)
{
    for (int side = -1; side <= 1; side += 2) {
        moray_path path;
        const double waypoint[][2] = {{0, 0}, {20, 0}, {20, side * 20.0}};
        CHECK_OK(moray_path_through(&path, waypoint, 3, 4), "a path");
        for (int k = 0; k < 6; k++) {
            static const double from[] = {9, 14, 17, 19, 23, 26};
            const double angle = 40 * DEG, out = 0.2;
            double along = from[k], across;
            moray_path_project(&path, 16 + out * sin(angle), side * (4 - out * cos(angle)), &along, &across);
            CHECK_NEAR(along, 16 + 4 * angle, 1e-6, "along the bend");
            CHECK_NEAR(across, side * 3.8, 1e-9, "to its inside");
        }
        moray_path_free(&path);
    }
}

// ---- Many waypoints ------------------------------------------------------------------------------------------------

enum { MANY = 40 };

// Of a staircase, read from a list, from a file with its columns the other way round, and given.
static void test_many(void)
{
    const char *const name = "test_path_sides.csv";
    double waypoint[MANY][2];
    char list[4000] = "", rows[4000] = "y_m,x_m\n";
    moray_path path[3];
    for (int k = 0; k < MANY; k++) {
        waypoint[k][0] = -1.5 + 3 * (k / 2);
        waypoint[k][1] = 0.25 + 2 * ((k + 1) / 2);
        snprintf(list + strlen(list), sizeof list - strlen(list), "%s%g , %g", k ? " " : "", waypoint[k][0],
                 waypoint[k][1]);
        snprintf(rows + strlen(rows), sizeof rows - strlen(rows), "%g,%g\n", waypoint[k][1], waypoint[k][0]);
    }
    FILE *file = fopen(name, "w");
    CHECK(file && fputs(rows, file) >= 0 && fclose(file) == 0, "%s is written", name);
    CHECK_OK(moray_path_read(&path[0], list, 0.5), "a list");
    CHECK_OK(moray_path_read(&path[1], name, 0.5), "a file");
    CHECK_OK(moray_path_through(&path[2], (const double(*)[2])waypoint, MANY, 0.5), "waypoints");
    remove(name);
    CHECK(path[2].n == 2 * MANY - 3, "legs and the arcs between them: %d", path[2].n);
    CHECK_NEAR(path[2].length, 20 * 2 + 19 * 3 - (MANY - 2) * (1 - M_PI / 4), 1e-9, "length");
    for (int k = 0; k < 2; k++) {
        CHECK(path[k].n == path[2].n &&
                  memcmp(path[k].piece, path[2].piece, (size_t)path[2].n * sizeof *path[2].piece) == 0,
              "the same path");
    }
    for (int k = 0; k < 3; k++)
        moray_path_free(&path[k]);
}

// A list begins with a digit, a sign, a point or a blank; all else is the name of a file.
static void test_lists(void)
{
    static const char *const lists[] = {"+1,2 3,4", "-1,2 3,4", ".5,2 3,4", " 7,8 9,10", "3,0 0,4"};
    for (int k = 0; k < 5; k++) {
        moray_path path;
        CHECK_OK(moray_path_read(&path, lists[k], 1), lists[k]);
        CHECK(path.n == 1, "one leg");
        moray_path_free(&path);
    }
    moray_path path;
    moray_status status = moray_path_read(&path, "x1,2 3,4", 1);
    CHECK(status.code == MORAY_IO && strncmp(status.text, "path x1,2 3,4: neither waypoints", 32) == 0, "%s",
          status.text);
    status = moray_path_read(&path, "1,2 3;4", 1);
    CHECK(status.code == MORAY_INPUT && strcmp(status.text, "path: '3;4': must be waypoints X,Y X,Y ... in m") == 0,
          "%s", status.text);
}

// ---- Texts ---------------------------------------------------------------------------------------------------------

static void refuse(const double (*waypoint)[2], int n, double radius, const char *says)
{
    moray_path path;
    const moray_status status = moray_path_through(&path, waypoint, n, radius);
    CHECK(status.code == MORAY_INPUT && strcmp(status.text, says) == 0, "%s", status.text);
    CHECK(!path.piece && path.n == 0 && path.length == 0, "nothing is left");
}

static void test_refused(void)
{
    const double good[][2] = {{0, 0}, {5, 0}, {5, 9}}, endless[][2] = {{0, 0}, {1, 2}, {3, INFINITY}, {4, 4}},
                 undefined[][2] = {{NAN, 1}, {1, 2}}, again[][2] = {{0, 0}, {2, 3}, {2, 3 + 5e-10}, {9, 9}},
                 back[][2] = {{0, 0}, {9, 0}, {9, -1}, {0, -1}};
    moray_path least;
    CHECK_OK(moray_path_through(&least, (const double[][2]){{0, 0}, {1e-9, 0}}, 2, 1), "just apart");
    CHECK(least.n == 1 && least.length == 1e-9, "a leg of %g m", least.length);
    moray_path_free(&least);
    refuse(good, 3, 0, "radius_m = 0: must be above 0");
    refuse(good, 3, INFINITY, "radius_m = inf: must be above 0");
    refuse(good, 1, 1, "path: 1 waypoint: must be at least 2");
    refuse(good, 0, 1, "path: 0 waypoints: must be at least 2");
    refuse(endless, 4, 1, "path: waypoint 3 is (3, inf): must be finite");
    refuse(undefined, 2, 1, "path: waypoint 1 is (nan, 1): must be finite");
    refuse(again, 4, 1, "path: waypoint 3 is where the one before is, (2, 3)");
    refuse(good, 3, 6, "path: leg 1 is 5 m long, too short for arcs of radius 6 m that turn by 90 deg at its end");
    refuse(back, 4, 0.8, "path: leg 2 is 1 m long, too short for arcs of radius 0.8 m that turn by -90 deg at its end");
}

static void impassable(double speed, const double current[2], const char *says)
{
    moray_path path;
    CHECK_OK(moray_path_read(&path, "0,0 10,0 10,10 0,10", 2), "a path");
    const moray_status status = moray_path_passable(&path, speed, current);
    CHECK(status.code == MORAY_NOT_SOLVED && strcmp(status.text, says) == 0, "%s", status.text);
    CHECK(isnan(moray_path_duration(&path, 0, speed, current)), "no duration");
    moray_path_free(&path);
}

// From either side, and against: what runs across has no sign, what runs against it has.
static void test_currents(void)
{
    impassable(0.25, (double[]){0.1, -0.3},
               "the current is too strong for the path: on leg 1, 0 m along the path, its course is 0 deg, 0.3 m/s run "
               "across it and -0.1 m/s against it, and the speed through the water is 0.25 m/s, which makes good "
               "courses within 52.2 deg of -71.57 deg alone");
    impassable(0.25, (double[]){-0.3, 0},
               "the current is too strong for the path: on leg 1, 0 m along the path, its course is 0 deg, 0 m/s run "
               "across it and 0.3 m/s against it, and the speed through the water is 0.25 m/s, which makes good "
               "courses within 56.4 deg of 180 deg alone");
    moray_path path;
    CHECK_OK(moray_path_read(&path, "0,0 10,0 10,10 0,10", 2), "a path");
    const moray_status status = moray_path_passable(&path, 0.25, (double[]){0.4, 0});
    // the first of 33 points of the arc, each 90/32 deg on, from which the course is more than asin(5/8) off the
    // current
    const double turn = ceil(asin(0.625) / (90 * DEG / 32)) * 90 / 32;
    char says[120];
    snprintf(says, sizeof says, "in the corner behind leg 1, %.4g m along the path, its course is %.4g deg, %.4g m/s",
             8 + 2 * turn * DEG, turn, 0.4 * sin(turn * DEG));
    CHECK(strstr(status.text, says), "%s: %s", says, status.text);
    CHECK(moray_failed(moray_path_passable(&path, 0.25, (double[]){0.24, 0.1})), "the last leg leads against it");
    CHECK_OK(moray_path_passable(&path, 0.25, (double[]){0.12, 0.1}), "weaker it does not stop anybody");
    moray_path_free(&path);
}

int main(void)
{
    test_pieces();
    test_eased_pieces();
    test_least_radius();
    test_mirror(false);
    test_mirror(true);
    test_inside();
    test_many();
    test_lists();
    test_refused();
    test_currents();
    return tap_done();
}
