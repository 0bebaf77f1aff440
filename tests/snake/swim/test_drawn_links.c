// SPDX-License-Identifier: MIT
//
// Robots of unequal links as scenes and outlines, tracks that are full or empty; which gaits make way, and which robots
// are none of the ladder's.
#include "random_robot.h"

#include <string.h>

#include "moray/snake/ladder.h"
#include "moray/snake/scene.h"

enum { LINKS = 4, STATES = 2 * LINKS + 4, JOINTS = LINKS - 1, SAMPLES = 3 };

// ---- Unequal links -------------------------------------------------------------------------------------------------

static void add_samples(moray_swim_track *track, double way)
{
    random_seed seed = 4;
    for (int k = 0; k < SAMPLES; k++) {
        double x[STATES], u[JOINTS];
        random_vector(&seed, 1, STATES, x);
        random_vector(&seed, 1, JOINTS, u);
        const moray_swim_sample sample = {.t = 0.5 * k, .x = x, .u = u, .pose = {.p_x = way * k}};
        CHECK(moray_swim_track_add(&sample, track), "sample %d", k);
    }
}

static void check_outline(const moray_swim_track *track, const moray_swimmer *swimmer, const moray_link *link, double l)
{
    double *x, *y, worst = 0, at[3][LINKS];
    int n;
    CHECK_OK(moray_swim_outline(track, swimmer, &x, &y, &n), "outline");
    CHECK(n == 2 * 3 * LINKS, "first and last: %d points", n);
    for (int robot = 0; robot < 2; robot++) {
        moray_swimmer_links(swimmer, track->x + robot * (SAMPLES - 1) * STATES, at[0], at[1], at[2]);
        for (int i = 0; i < LINKS; i++) {
            const double half = l * link[i].l, c = cos(at[2][i]), s = sin(at[2][i]);
            const int p = 3 * (robot * LINKS + i);
            worst = tap_worse(worst, hypot(x[p] - at[0][i] + half * c, y[p] - at[1][i] + half * s));
            worst = tap_worse(worst, hypot(x[p + 1] - at[0][i] - half * c, y[p + 1] - at[1][i] - half * s));
            CHECK(isnan(x[p + 2]) && isnan(y[p + 2]), "a stroke ends");
        }
    }
    CHECK(worst < 1e-13, "each link as long as it is: %.1e", worst);
    free(x);
}

static void test_unequal(void)
{
    random_seed seed = 9;
    moray_link link[LINKS];
    const moray_robot robot = random_unequal_robot(&seed, LINKS, link);
    const moray_swim_look look = {.name = "unequal", .width = 100};
    moray_swim_scene made = {0};
    moray_swim_track track;
    moray_swimmer *swimmer;
    CHECK_OK(moray_swimmer_new(&swimmer, &robot, MORAY_FIRST_PRINCIPLES), "swimmer");
    CHECK_OK(moray_swim_track_new(&track, swimmer, SAMPLES), "track");
    add_samples(&track, 0.1 * robot.l);
    CHECK_OK(moray_swim_scene_add(&made, &look, &track, swimmer), "scene");
    const moray_scene_body *body = &made.body[0];
    for (int i = 0; i < LINKS && body->lengths; i++)
        CHECK_NEAR(body->lengths[i], 2 * robot.l * link[i].l, 1e-14, "the length of a link");
    CHECK(body->lengths && body->links == LINKS && body->length == 2 * robot.l && body->width == 1.6 * robot.l,
          "lengths are told");
    check_outline(&track, swimmer, link, robot.l);
    moray_swim_scene_free(&made);
    moray_swim_track_free(&track);
    moray_swimmer_free(swimmer);
}

// ---- Tracks --------------------------------------------------------------------------------------------------------

static void test_tracks(void)
{
    const moray_robot robot = moray_robot_paper();
    const double x[24] = {0}, u[9] = {0};
    const moray_swim_sample sample = {.x = x, .u = u};
    moray_swimmer *swimmer;
    moray_swim_track track;
    CHECK_OK(moray_swimmer_new(&swimmer, &robot, MORAY_CONTROL_ORIENTED), "swimmer");
    for (int capacity = -1; capacity <= 2; capacity++) {
        CHECK_OK(moray_swim_track_new(&track, swimmer, capacity), "track");
        int taken = 0;
        while (taken < 5 && moray_swim_track_add(&sample, &track))
            taken++;
        CHECK(taken == (capacity < 0 ? 0 : capacity) && track.n == taken, "%d of %d", taken, capacity);
        moray_swim_track_free(&track);
        CHECK(!track.t && !track.pose && track.n == 0, "freed");
    }
    moray_swimmer_free(swimmer);
}

// ---- The ladder ----------------------------------------------------------------------------------------------------

// A fiftieth of half a link a period is no way yet.
static void test_way(void)
{
    moray_robot robot = moray_robot_paper();
    const moray_gait gait = {.omega = M_PI}; // a period of 2 s
    moray_steady steady = {.speed = 0.01 * robot.l};
    const moray_status none = moray_makes_way(&robot, &gait, &steady);
    char says[80];
    snprintf(says, sizeof says, "the gait makes no way: %.2g m/s", steady.speed);
    CHECK(none.code == MORAY_NOT_SOLVED && strcmp(none.text, says) == 0, "%s", none.text);
    steady.speed *= 1 + 1e-12;
    CHECK_OK(moray_makes_way(&robot, &gait, &steady), "a little more is way");
    steady.speed = NAN;
    CHECK(moray_makes_way(&robot, &gait, &steady).code == MORAY_NOT_SOLVED, "what is not known is none");
}

static void test_none_of_the_rungs(void)
{
    const moray_robot paper = moray_robot_paper();
    moray_robot robot = paper;
    robot.hydro.pieces = 0;
    CHECK(moray_rung_of(&robot) == 1, "links in no pieces are whole");
    robot.hydro.pieces = 4;
    CHECK(moray_rung_of(&robot) == 0, "four pieces are on no rung");
    robot = paper, robot.hydro.drag = MORAY_DRAG_BOTH;
    CHECK(moray_rung_of(&robot) == 0, "both drags are not, without strips");
    robot = paper, robot.hydro.added_mass = MORAY_ADDED_MASS_INVARIANT;
    CHECK(moray_rung_of(&robot) == 0, "added mass alone is not");
    robot = paper, robot.hydro.rotation = MORAY_ROTATION_STRIP, robot.hydro.pieces = 2;
    CHECK(moray_rung_of(&robot) == 0, "strips are not, in pieces");
    robot = paper, robot.hydro.rotation = MORAY_ROTATION_STRIP, robot.hydro.drag = MORAY_DRAG_QUADRATIC;
    CHECK(moray_rung_of(&robot) == 0, "nor with quadratic drag");
    robot = paper, robot.hydro.frame = MORAY_FRAME_INVARIANT;
    CHECK(moray_rung_of(&robot) == 1, "the frame is the other model's");
}

int main(void)
{
    test_unequal();
    test_tracks();
    test_way();
    test_none_of_the_rungs();
    return tap_done();
}
