// SPDX-License-Identifier: MIT
//
// Scores of headings and paths, by hand, with errors to either side; and what a closed loop starts from and records.
#include "degree.h"
#include "tap.h"

#include "moray/snake/closed_loop.h"
#include "moray/snake/trial.h"

// Samples a second apart of headings, judged by a reference; without undulation.
static moray_heading_score judge(const double *heading, int n, const moray_reference *reference)
{
    const moray_straight_motion straight = {.gait = {.omega = 2}};
    double t[8], energy[8];
    moray_pose pose[8] = {{0}};
    for (int k = 0; k < n; k++) {
        t[k] = k;
        energy[k] = 0.5 * k * k;
        pose[k].heading = heading[k];
    }
    const moray_swim_closed_loop closed_loop = {.track = {.n = n, .t = t, .energy = energy, .pose = pose}};
    return moray_swim_closed_loop_heading_score(&closed_loop, &straight, reference);
}

// The integral over a second of the square of what goes from a to b.
static double square(double a, double b)
{
    return (a * a + a * b + b * b) / 3;
}

static void test_heading(void)
{
    double zero = 0, jump[] = {2, 2}, to[] = {0.1, -0.6};
    const moray_reference ahead = {.n = 1, .time = &zero, .heading = &zero},
                          jumping = {.n = 2, .time = jump, .heading = to};
    moray_heading_score score = judge((double[]){0.1, -0.5, 0.2, -0.3}, 4, &ahead);
    CHECK_NEAR(score.largest, 0.5, 1e-15, "the largest, to the right");
    CHECK_NEAR(score.final, -0.3, 1e-15, "the last, with its sign");
    CHECK_NEAR(score.rms, sqrt((square(0.1, -0.5) + square(-0.5, 0.2) + square(0.2, -0.3)) / 3), 1e-15,
               "root of the mean square");
    CHECK_NEAR(score.power, 1.5, 1e-15, "power");
    score = judge((double[]){0.1, 0.1, 0.3, -0.5}, 4, &jumping);
    CHECK_NEAR(score.largest, 0.9, 1e-15, "largest just after a jump");
    CHECK_NEAR(score.rms, sqrt((square(0, 0) + square(0, 0.2) + square(0.9, 0.1)) / 3), 1e-15, "across it");
    to[1] = 1.1;
    score = judge((double[]){0.1, 0.1, 0.2, 0.9}, 4, &jumping);
    CHECK_NEAR(score.largest, 0.9, 1e-15, "largest just after a jump to the other side");
    to[1] = -0.6;
    score = judge((double[]){0.1, 0.1, 0.3}, 3, &jumping);
    CHECK_NEAR(score.largest, 0.2, 1e-15, "what comes after the end does not count");
    score = judge((double[]){0.1, 0.1, -0.8, -0.5}, 4, &jumping);
    CHECK_NEAR(score.largest, 0.9, 1e-15, "largest just before a jump");
}

// Along x at 0.5 m/s from 0.25 m on, to the right of the path at the largest.
static void test_path(void)
{
    enum { n = 8 };
    static const double across[n] = {0.9, 0.5, 0.1, -0.4, 0.2, -0.3, 0.1, 5};
    double t[n], energy[n];
    moray_pose pose[n] = {{0}};
    moray_path path;
    CHECK_OK(moray_path_read(&path, "0,0 3,0", 1), "a leg");
    for (int k = 0; k < n; k++) {
        t[k] = 10 + k;
        energy[k] = 2.0 * k * k;
        pose[k].p_x = 0.25 + 0.5 * k;
        pose[k].p_y = across[k];
    }
    const moray_swim_closed_loop closed_loop = {.track = {.n = n, .t = t, .energy = energy, .pose = pose}};
    const moray_path_score score = moray_swim_closed_loop_path_score(&closed_loop, &path, 1);
    CHECK_NEAR(score.time, 15.5, 1e-12, "past the end, half-way between two samples");
    CHECK_NEAR(score.rms, sqrt((0.81 + 0.25 + 0.01 + 0.16 + 0.04 + 0.09 + 0.01) / 7), 1e-14, "all the way");
    CHECK_NEAR(score.settled_rms, sqrt((0.16 + 0.04 + 0.09 + 0.01) / 4), 1e-14, "a metre beyond the start");
    CHECK_NEAR(score.settled_largest, 0.4, 1e-14, "at most, to the right");
    CHECK_NEAR(score.power, 72.0 / 16, 1e-14, "power until the end");
    const moray_swim_closed_loop shorter = {.track = {.n = 6, .t = t, .energy = energy, .pose = pose}};
    const moray_path_score less = moray_swim_closed_loop_path_score(&shorter, &path, 1);
    CHECK(isnan(less.time), "what comes after its samples is not looked at: %g s", less.time);
    CHECK_NEAR(less.rms, sqrt((0.81 + 0.25 + 0.01 + 0.16 + 0.04 + 0.09) / 6), 1e-14, "all its way");
    CHECK_NEAR(less.power, 50.0 / 15, 1e-14, "power until its end");
    moray_path_free(&path);
}

// A sample that lies on the end of the path has reached it; one that begins beyond has not come past.
static void test_ends(void)
{
    double t[3] = {0, 1, 2}, energy[3] = {0, 1, 2};
    moray_pose pose[3] = {{.p_x = 1}, {.p_x = 2}, {.p_x = 3}};
    moray_path path;
    CHECK_OK(moray_path_read(&path, "0,0 2,0", 1), "a leg");
    const moray_swim_closed_loop closed_loop = {.track = {.n = 3, .t = t, .energy = energy, .pose = pose}};
    CHECK_NEAR(moray_swim_closed_loop_path_score(&closed_loop, &path, 0.5).time, 1, 1e-12, "at the end itself");
    pose[0].p_x = 2.5;
    pose[1].p_x = 2.75;
    CHECK_NEAR(moray_swim_closed_loop_path_score(&closed_loop, &path, 0.5).time, 1 - 0.75 / 0.25, 1e-9,
               "begun beyond the end, by the way of the first second");
    moray_path_free(&path);
}

// ---- A closed loop -------------------------------------------------------------------------------------------------

static moray_offset rising(double t, const void *self)
{
    (void)self;
    return (moray_offset){.value = 0.02 + 0.01 * t, .rate = 0.01};
}

static bool see(const moray_swim_sample *sample, void *self)
{
    ++*(int *)self;
    return sample->t < 0.5;
}

// Starts where it is told, offset and all, in the water's current or the one that is told.
static void test_start(moray_model model, const moray_swim_on_gait *how)
{
    const moray_robot robot = moray_robot_paper();
    const moray_gait paper = moray_gait_paper(&robot);
    const moray_gait gait = moray_gait_map(&robot, &paper, MORAY_CONTROL_ORIENTED, model);
    const moray_swim_controller controller = {.offset = rising};
    moray_straight_motion straight;
    moray_swim_closed_loop closed_loop;
    int seen = 0;
    CHECK_OK(moray_straight_motion_find(&straight, &robot, model, &gait), "straight");
    const moray_swim_closed_loop_spec spec = {.robot = &robot,
                                              .straight = &straight,
                                              .heading = 0.7,
                                              .position = {3, -2},
                                              .current = {0.1, 0.05},
                                              .controller = &controller,
                                              .duration = 1,
                                              .intervals = 8,
                                              .tolerance = 1e-6,
                                              .on_gait = how,
                                              .observe = see,
                                              .observer = &seen};
    CHECK_OK(moray_swim_closed_loop_run(&closed_loop, &spec), "closed loop");
    const moray_swim_track *track = &closed_loop.track;
    CHECK(track->n == 5 && seen == 5, "ends with who observes it: %d samples, %d seen", track->n, seen);
    double worst = 0, phi[18], v[18];
    for (int k = 0; k < track->n; k++) {
        worst = tap_worse(worst, fabs(track->t[k] - 0.125 * k));
        worst = tap_worse(worst, fabs(closed_loop.offset[k] - 0.02 - 0.01 * track->t[k]));
    }
    CHECK_NEAR(worst, 0, 1e-12, "times and offsets");
    CHECK_NEAR(track->pose[0].p_x, 3, 1e-12, "place along x");
    CHECK_NEAR(track->pose[0].p_y, -2, 1e-12, "along y");
    CHECK_NEAR(moray_straight_motion_heading(&straight, 0, track->pose[0].heading), 0.7, 0.01, "heading");
    moray_swimmer_joints(closed_loop.swimmer, track->x, phi, v);
    double mean = 0, rate = 0;
    for (int j = 0; j < robot.links - 1; j++) { // beside what the gait has there
        mean += (phi[j] - gait.amplitude * sin(j * gait.delta)) / (robot.links - 1);
        rate += (v[j] - gait.amplitude * gait.omega * cos(j * gait.delta)) / (robot.links - 1);
    }
    CHECK_NEAR(mean, 0.02, 1e-12, "joints begin with the offset");
    CHECK_NEAR(rate, 0.01, 1e-12, "and its rate");
    moray_swim_closed_loop_free(&closed_loop);
}

int main(void)
{
    const moray_swim_on_gait how = {.steps = 24};
    test_heading();
    test_path();
    test_ends();
    test_start(MORAY_CONTROL_ORIENTED, NULL);
    test_start(MORAY_CONTROL_ORIENTED, &how);
    test_start(MORAY_FIRST_PRINCIPLES, &how);
    return tap_done();
}
