// SPDX-License-Identifier: MIT
//
// Swimmers as the scene of a report and as outlines along a path, from tracks of given numbers at unequal times.
#include "tap.h"

#include <string.h>

#include "moray/snake/scene.h"

enum { LINKS = 3, JOINTS = LINKS - 1, STATES = 2 * LINKS + 4, SAMPLES = 3 };

static const double given_t[SAMPLES] = {1, 1.5, 2.27}, given_u[SAMPLES][JOINTS] = {{50, -60}, {1, -2}, {0.5, -3.25}},
                    given_V[SAMPLES][2] = {{0.1, -0.2}, {0.3, 0.05}, {-0.15, 0.3}};

static moray_swimmer *make(moray_model model)
{
    moray_robot robot = moray_robot_paper();
    robot.links = LINKS;
    moray_swimmer *swimmer;
    CHECK_OK(moray_swimmer_new(&swimmer, &robot, model), "swimmer");
    return swimmer;
}

static void given_state(int k, double *x)
{
    for (int i = 0; i < STATES; i++)
        x[i] = 0.3 * sin(1.7 * i + 2.9 * k) + 0.05 * k;
}

// Samples at the given times, or at others.
static moray_swim_track make_track(const moray_swimmer *swimmer, const double t[SAMPLES])
{
    moray_swim_track track;
    CHECK_OK(moray_swim_track_new(&track, swimmer, SAMPLES), "track");
    for (int k = 0; k < SAMPLES; k++) {
        double x[STATES];
        given_state(k, x);
        const moray_swim_sample sample = {
            .t = t[k], .x = x, .u = given_u[k], .current = {given_V[k][0], given_V[k][1]}};
        CHECK(moray_swim_track_add(&sample, &track), "sample %d", k);
    }
    return track;
}

// On the chords between the samples, and at the first or last one outside them.
static double between(const double t[SAMPLES], double at, const double value[SAMPLES])
{
    if (at <= t[0])
        return value[0];
    if (at >= t[2])
        return value[2];
    const int k = at < t[1] ? 0 : 1;
    return value[k] + (value[k + 1] - value[k]) / (t[k + 1] - t[k]) * (at - t[k]);
}

// A frame as the state, efforts and current at its time have it.
static double frame_error(const moray_scene *scene, int body, int frame, moray_swimmer *swimmer,
                          const double t[SAMPLES], const double aside[2])
{
    const moray_scene_body *shown = &scene->bodies[body];
    double x[STATES], rows[SAMPLES][STATES], V[2], links[3][LINKS], along[LINKS], across[LINKS], worst = 0;
    for (int k = 0; k < SAMPLES; k++)
        given_state(k, rows[k]);
    for (int i = 0; i < STATES; i++)
        x[i] = between(t, scene->t[frame], (double[]){rows[0][i], rows[1][i], rows[2][i]});
    for (int i = 0; i < 2; i++)
        V[i] = between(t, scene->t[frame], (double[]){given_V[0][i], given_V[1][i], given_V[2][i]});
    for (int i = 0; i < JOINTS; i++)
        worst = tap_worse(worst,
                          fabs(shown->effort[frame * JOINTS + i] -
                               between(t, scene->t[frame], (double[]){given_u[0][i], given_u[1][i], given_u[2][i]})));
    moray_swimmer_links(swimmer, x, links[0], links[1], links[2]);
    moray_swimmer_set_current(swimmer, V[0], V[1]);
    const bool drag = moray_swimmer_water_forces(swimmer, x, NULL, along, across);
    CHECK(drag == (shown->force != NULL), "drag on links where it is known");
    for (int i = 0; i < LINKS; i++) {
        const double *at = shown->at + 3 * (frame * LINKS + i), c = cos(links[2][i]), s = sin(links[2][i]);
        worst = tap_worse(worst, fabs(at[0] - links[0][i] - aside[0]));
        worst = tap_worse(worst, fabs(at[1] - links[1][i] - aside[1]));
        worst = tap_worse(worst, fabs(at[2] - links[2][i]));
        if (!drag)
            continue;
        const double *force = shown->force + 2 * (frame * LINKS + i);
        worst = tap_worse(worst, fabs(c * force[0] + s * force[1] - along[i]));
        worst = tap_worse(worst, fabs(c * force[1] - s * force[0] - across[i]));
    }
    return worst;
}

static void check_body(const moray_scene *scene, int body, moray_swimmer *swimmer, const double t[SAMPLES],
                       const double aside[2])
{
    double worst = 0;
    for (int k = 0; k < scene->frames; k++)
        worst = tap_worse(worst, frame_error(scene, body, k, swimmer, t, aside));
    CHECK(worst < 1e-12, "body %d in all frames: %.1e", body, worst);
    CHECK(scene->bodies[body].links == LINKS && !scene->bodies[body].lengths, "links, all of a length");
    CHECK_NEAR(scene->bodies[body].length, 2 * moray_swimmer_robot(swimmer)->l, 1e-15, "the length");
}

// Bodies beyond the first are shown at its times, however long they swim, and four at most.
static void test_bodies(moray_model model)
{
    moray_swimmer *swimmer = make(model);
    const double l = moray_swimmer_robot(swimmer)->l, late[SAMPLES] = {1.2, 1.3, 2}, kept[2] = {0.7, -0.6};
    moray_swim_track track = make_track(swimmer, given_t), other = make_track(swimmer, late), one = track;
    moray_swim_scene made = {0};
    const moray_swim_look look = {.name = "first", .colour = 2, .width = 0.5 * l, .aside = {0.3, -0.2}};
    const moray_swim_look wide = {.name = "other", .colour = 3, .width = 10 * l, .aside = {0, 0.4}};
    moray_swimmer_set_current(swimmer, kept[0], kept[1]);
    one.n = 1;
    CHECK_OK(moray_swim_scene_add(&made, &look, &one, swimmer), "one sample");
    CHECK(made.scene.n_bodies == 0 && made.scene.frames == 0, "is no motion");
    CHECK_OK(moray_swim_scene_add(&made, &look, &track, swimmer), "first body");
    double V[2];
    moray_swimmer_current(swimmer, V);
    CHECK(V[0] == kept[0] && V[1] == kept[1], "the swimmer's own current is left as it was");
    for (int c = 0; c < 2; c++)
        CHECK_NEAR(made.scene.current[c], (given_V[0][c] + given_V[1][c] + given_V[2][c]) / 3, 1e-15, "mean current");
    for (int i = 1; i < 5; i++)
        CHECK_OK(moray_swim_scene_add(&made, &wide, &other, swimmer), "another body");
    CHECK(made.scene.n_bodies == MORAY_SCENE_BODIES, "no more than there is room for");
    CHECK(made.scene.frames == 27, "20 frames a second: %d", made.scene.frames);
    for (int k = 0; k < 27; k++)
        CHECK_NEAR(made.scene.t[k], 1 + 1.27 * k / 26, 1e-14, "time of a frame");
    check_body(&made.scene, 0, swimmer, given_t, look.aside);
    check_body(&made.scene, 1, swimmer, late, wide.aside);
    check_body(&made.scene, 3, swimmer, late, wide.aside);
    CHECK(strcmp(made.scene.effort, model ? "torque, up to 3.25 N m" : "force, up to 3.25 N") == 0,
          "efforts once the start is over: %s", made.scene.effort);
    CHECK(made.body[0].width == 0.5 * l && made.body[1].width == 1.6 * l, "no wider than 1.6 half-lengths");
    CHECK(strcmp(made.body[0].name, "first") == 0 && strcmp(made.body[3].name, "other") == 0, "names");
    CHECK(made.body[0].colour == 2 && made.body[2].colour == 3, "colours");
    moray_swim_scene_free(&made);
    CHECK(made.n_kept == 0 && made.scene.n_bodies == 0, "freed");
    moray_swim_track_free(&track);
    moray_swim_track_free(&other);
    moray_swimmer_free(swimmer);
}

// Two samples are a motion; what is told of efforts is of the first robot, its second half.
static void test_two_samples(void)
{
    moray_swimmer *swimmer = make(MORAY_CONTROL_ORIENTED);
    moray_swim_track track = make_track(swimmer, given_t), two = track;
    const moray_swim_look look = {.name = "two", .width = 0.01, .aside = {-0.1, 0.2}};
    const double values[] = {4, -2};
    moray_swim_scene made = {0};
    two.n = 2;
    CHECK_OK(moray_swim_scene_add(&made, &look, &two, swimmer), "two samples");
    CHECK_OK(moray_swim_scene_tell(&made, "told", "m", &two, values), "and a number");
    CHECK(made.scene.n_bodies == 1 && made.scene.n_channels == 1 && made.scene.frames == 11, "%d frames",
          made.scene.frames);
    check_body(&made.scene, 0, swimmer, given_t, look.aside);
    for (int k = 0; k < 11; k++)
        CHECK_NEAR(made.channel[0].values[k], 4 - 0.6 * k, 1e-12, "the number");
    for (int c = 0; c < 2; c++)
        CHECK_NEAR(made.scene.current[c], (given_V[0][c] + given_V[1][c]) / 2, 1e-15, "mean current");
    for (int i = 0; i < 2 * JOINTS; i++)
        two.u[i] *= 3;
    CHECK_OK(moray_swim_scene_add(&made, &look, &two, swimmer), "another that pushes harder");
    CHECK(strcmp(made.scene.effort, "force, up to 31 N") == 0, "efforts of the first: %s", made.scene.effort);
    moray_swim_scene_free(&made);
    moray_swim_track_free(&track);
    moray_swimmer_free(swimmer);
}

static void test_numbers(void)
{
    moray_swimmer *swimmer = make(MORAY_CONTROL_ORIENTED);
    const double hours[SAMPLES] = {0, 10, 100}, values[SAMPLES] = {3, -1, 5};
    moray_swim_track track = make_track(swimmer, hours), one = track;
    moray_swim_scene made = {0};
    one.n = 1;
    CHECK_OK(moray_swim_scene_tell(&made, "none", "", &one, values), "one sample");
    for (int i = 0; i < 5; i++)
        CHECK_OK(moray_swim_scene_tell(&made, i ? "more" : "depth", "m", &track, values), "told");
    CHECK(made.scene.n_channels == MORAY_SCENE_CHANNELS, "four numbers at most");
    CHECK(made.scene.frames == 1200 && made.scene.t[1199] == 100, "no more than 1200 frames");
    double worst = 0;
    for (int k = 0; k < 1200; k++)
        worst = tap_worse(worst, fabs(made.channel[0].values[k] - between(hours, made.scene.t[k], values)));
    CHECK(worst < 1e-12, "numbers over time: %.1e", worst);
    CHECK(strcmp(made.channel[0].name, "depth") == 0 && strcmp(made.channel[3].name, "more") == 0, "names");
    double x[] = {1, 2, 4}, y[] = {-3, 5, 7};
    CHECK_OK(moray_swim_scene_ask(&made, x, y, 3), "path");
    x[1] = y[1] = 0;
    CHECK(made.scene.n_asked == 3 && made.scene.asked_x[1] == 2 && made.scene.asked_y[1] == 5 &&
              made.scene.asked_x[2] == 4 && made.scene.asked_y[0] == -3,
          "is copied");
    moray_swim_scene_free(&made);
    moray_swim_track_free(&track);
    moray_swimmer_free(swimmer);
}

// The frames of a gait are where the simulation is at their times.
static void test_gait(moray_model model)
{
    moray_robot robot = moray_robot_paper();
    robot.links = LINKS;
    moray_test_rig rig;
    CHECK_OK(moray_test_rig_new(&rig, &robot, (double[]){0.1, -0.05}, 0), "rig");
    moray_gait_trial trial = {0};
    trial.gait[model] = (moray_gait){.amplitude = model ? 0.3 : 0.03, .omega = 2, .delta = 0.7};
    trial.steady[model].start_heading = 0.4;
    moray_swim_scene made = {0};
    const moray_swim_look look = {.name = "gait", .width = 0.01};
    CHECK_OK(moray_swim_scene_gait(&made, &look, &rig, &trial, model, 0.5), "scene");
    CHECK(made.scene.frames == 11 && made.scene.n_bodies == 1, "%d frames", made.scene.frames);
    moray_swimmer *swimmer = rig.swimmer[model];
    const moray_gait_change change = {0, trial.gait[model]};
    double worst = 0;
    for (int k = 1; k < 11; k++) {
        double x[STATES + 1] = {0}, links[3][LINKS];
        const moray_swim_plan plan = {.t1 = 0.05 * k, .schedule = &change, .n_changes = 1};
        moray_swimmer_set_current(swimmer, 0.1, -0.05);
        moray_swimmer_rest(swimmer, 0.4, 0, 0, x);
        CHECK_OK(moray_swim_run(swimmer, &rig.settings.sim, &plan, x, NULL), "run");
        moray_swimmer_links(swimmer, x, links[0], links[1], links[2]);
        for (int i = 0; i < 3 * LINKS; i++)
            worst = tap_worse(worst, fabs(made.body[0].at[3 * LINKS * k + i] - links[i % 3][i / 3]));
    }
    CHECK(worst < 1e-8, "as simulated: %.1e", worst);
    moray_swim_scene_free(&made);
    moray_test_rig_free(&rig);
}

// ---- Outlines ------------------------------------------------------------------------------------------------------

// As many robots as one and a half lengths of path give, two to twelve, at equal intervals of samples.
static void check_outlines(double lengths, int robots)
{
    enum { points = 34 };
    moray_swimmer *swimmer = make(MORAY_FIRST_PRINCIPLES);
    const double l = moray_swimmer_robot(swimmer)->l, way = lengths * 2 * LINKS * l / (points - 1);
    moray_swim_track track;
    CHECK_OK(moray_swim_track_new(&track, swimmer, points), "track");
    for (int k = 0; k < points; k++) {
        double x[STATES], u[JOINTS] = {0};
        given_state(k, x);
        const int side = k % 2; // there and back across the way
        const moray_swim_sample sample = {.x = x, .u = u, .pose = {.p_x = -0.6 * way * k, .p_y = 0.8 * way * side}};
        CHECK(moray_swim_track_add(&sample, &track), "sample");
    }
    double *x, *y, worst = 0;
    int n;
    CHECK_OK(moray_swim_outline(&track, swimmer, &x, &y, &n), "outline");
    CHECK(n == 3 * LINKS * robots, "%g lengths: %d points, %d robots", lengths, n, robots);
    for (int r = 0; r < robots && n == 3 * LINKS * robots; r++) {
        const int k = (points - 1) * r / (robots - 1);
        double links[3][LINKS];
        moray_swimmer_links(swimmer, track.x + k * STATES, links[0], links[1], links[2]);
        for (int i = 0; i < 2 * LINKS; i++) {
            const int at = 3 * (LINKS * r + i / 2) + i % 2;
            const double along = i % 2 ? l : -l;
            worst = tap_worse(worst, fabs(x[at] - links[0][i / 2] - along * cos(links[2][i / 2])));
            worst = tap_worse(worst, fabs(y[at] - links[1][i / 2] - along * sin(links[2][i / 2])));
        }
    }
    CHECK(worst < 1e-12, "links from end to end: %.1e", worst);
    free(x);
    moray_swim_track_free(&track);
    moray_swimmer_free(swimmer);
}

int main(void)
{
    for (int model = 0; model < 2; model++) {
        test_bodies((moray_model)model);
        test_gait((moray_model)model);
    }
    test_two_samples();
    test_numbers();
    check_outlines(1, 2);
    check_outlines(4.6, 3);
    check_outlines(6.1, 4);
    check_outlines(17.9, 11);
    check_outlines(40, 12);
    return tap_done();
}
