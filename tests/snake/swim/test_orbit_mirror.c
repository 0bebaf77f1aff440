// SPDX-License-Identifier: MIT
//
// A gait whose offset is turned to the other side swims the mirrored orbit half a period later: what is not of a side
// is the same, and what is of a side is opposite. Tracks of as few points as there may be.
#include "degree.h"
#include "tap.h"

#include <string.h>

#include "snake/swim/orbit.h"

enum { LINKS = 5 };

static moray_orbit *orbit_of(moray_model model)
{
    const double speed[] = {0, 1, 2}, torque[] = {0.3, 0.28, 0};
    moray_robot robot = moray_robot_paper();
    robot.links = LINKS;
    if (model == MORAY_FIRST_PRINCIPLES) {
        robot.motor =
            (moray_motor){.fitted = true, .forward = 0.8, .friction = 0.02, .smooth_rate = 0.3, .smooth_power = 0.05};
        CHECK_OK(moray_motor_set_table(&robot.motor, speed, torque, 3), "motors");
    }
    moray_orbit_spec spec = moray_orbit_spec_default(&robot, model);
    spec.steered = false;
    moray_orbit *orbit = NULL;
    CHECK_OK(moray_orbit_new(&orbit, &spec), "orbit");
    return orbit;
}

// The gait that turns to one side, with its offset in parts of the amplitude.
static moray_gait gait_of(moray_model model, double offset)
{
    const double amplitude = model == MORAY_CONTROL_ORIENTED ? 0.045 : 28 * DEG;
    return (moray_gait){
        .amplitude = amplitude, .omega = 130 * DEG, .delta = 50 * DEG, .offset = offset * amplitude, .taper = 0.2};
}

static void check_gradient(const double one[5], const double other[5], double side, const char *what)
{
    double worst = 0, size = 0;
    for (int i = 0; i < 5; i++) {
        const double by = i == ORBIT_OFFSET ? -side : side;
        worst = tap_worse(worst, fabs(one[i] - by * other[i]));
        size = fmax(size, fabs(one[i]));
    }
    CHECK(size > 0 && worst <= 1e-7 * size, "derivatives of %s: off by %.1e of %.1e", what, worst, size);
}

static void check_peak(const orbit_peak *one, const orbit_peak *other, double T, const char *what)
{
    CHECK(one->joint == other->joint && one->line == other->line && one->negative != other->negative,
          "%s: joint %d, line %d, against %d, %d", what, one->joint, one->line, other->joint, other->line);
    CHECK_NEAR(one->size, other->size, 1e-9 * one->size, what);
    CHECK_NEAR(fabs(one->time - other->time), T / 2, 1e-12, "half a period apart");
}

static void test_sides(moray_model model)
{
    moray_orbit_result found[2];
    moray_orbit_gradient gradient[2];
    orbit_peak peak[2], load[2];
    moray_orbit *orbit = orbit_of(model);
    const double T = 2 * M_PI / (130 * DEG);
    for (int k = 0; k < 2; k++) {
        const moray_gait gait = gait_of(model, k ? -0.25 : 0.25);
        CHECK_OK(moray_orbit_solve(orbit, &gait, &found[k]), "found");
        CHECK_OK(moray_orbit_gradients(orbit, &gradient[k]), "its derivatives");
        peak[k] = orbit->peak;
        load[k] = orbit->load;
    }
    const moray_steady *one = &found[0].steady, *other = &found[1].steady;
    CHECK_NEAR(one->power, other->power, 1e-9 * one->power, "power");
    CHECK_NEAR(one->peak_effort, other->peak_effort, 1e-9 * one->peak_effort, "peak effort");
    CHECK_NEAR(one->peak_link_angle, other->peak_link_angle, 1e-9, "peak link angle");
    CHECK_NEAR(one->heading_drift, -other->heading_drift, 1e-9, "turning rate");
    CHECK_NEAR(found[0].peak_load, found[1].peak_load, 1e-9, "peak load");
    CHECK(fabs(one->heading_drift) > 1e-3 && one->turning && other->turning, "turning to either side");
    check_peak(&peak[0], &peak[1], T, "peak effort");
    check_gradient(gradient[0].power, gradient[1].power, 1, "power");
    check_gradient(gradient[0].peak_effort, gradient[1].peak_effort, 1, "peak effort");
    check_gradient(gradient[0].steering, gradient[1].steering, -1, "the turn");
    if (model == MORAY_FIRST_PRINCIPLES) {
        check_peak(&load[0], &load[1], T, "peak load");
        check_gradient(gradient[0].peak_load, gradient[1].peak_load, 1, "peak load");
    } else
        CHECK(found[0].peak_load == 0 && load[0].size == 0, "joints that are not rotary have no motors");
    moray_orbit_free(orbit);
}

// The peaks are the largest of what samples show at every degree.
static void test_peaks(moray_model model)
{
    moray_orbit *orbit = orbit_of(model);
    const moray_gait gait = gait_of(model, -0.25);
    moray_orbit_result found;
    moray_swim_track track;
    double effort = 0, load = 0, angle = 0, heading = 0, phi[3 * (LINKS - 1)];
    CHECK_OK(moray_orbit_solve(orbit, &gait, &found), "found");
    CHECK_OK(moray_orbit_track(orbit, 361, &track), "track");
    for (int k = 0; k <= 360; k++) {
        moray_gait_reference(&gait, LINKS - 1, track.t[k], phi, phi + LINKS - 1, phi + 2 * (LINKS - 1));
        for (int i = 0; i < LINKS - 1; i++) {
            const double u = track.u[k * (LINKS - 1) + i];
            effort = tap_worse(effort, fabs(u));
            load = tap_worse(load, moray_motor_load(&orbit->spec.robot.motor, u, phi[LINKS - 1 + i]));
        }
        angle = tap_worse(angle, track.pose[k].link_angle);
        if (k > 0)
            heading += (track.pose[k].heading + track.pose[k - 1].heading) / 720;
    }
    CHECK_NEAR(found.steady.peak_effort, effort, 1e-12, "peak effort");
    CHECK_NEAR(found.steady.peak_link_angle, angle, 1e-12, "peak link angle");
    CHECK_NEAR(found.steady.heading, heading, 1e-12, "mean heading");
    CHECK_NEAR(found.peak_load, model == MORAY_FIRST_PRINCIPLES ? load : 0, 1e-12, "peak load");
    moray_swim_track_free(&track);
    moray_orbit_free(orbit);
}

static void test_tracks(void)
{
    moray_orbit *orbit = orbit_of(MORAY_CONTROL_ORIENTED);
    const moray_gait gait = gait_of(MORAY_CONTROL_ORIENTED, 0.1);
    moray_orbit_result found;
    moray_swim_track track;
    CHECK_OK(moray_orbit_solve(orbit, &gait, &found), "found");
    CHECK_OK(moray_orbit_track(orbit, 2, &track), "of two points");
    CHECK(track.n == 2 && track.t[0] == 0, "from 0");
    CHECK_NEAR(track.t[1], 2 * M_PI / gait.omega, 1e-12, "over the period");
    CHECK_NEAR((track.pose[1].p_x - track.pose[0].p_x) / track.t[1], found.steady.v_x, 1e-12, "as the mean velocity");
    CHECK_NEAR((track.pose[1].heading - track.pose[0].heading) / track.t[1], found.steady.heading_drift, 1e-12,
               "and the rate of turn");
    moray_swim_track_free(&track);
    for (int points = 1; points >= -1; points -= 2) {
        char says[80];
        const moray_status status = moray_orbit_track(orbit, points, &track);
        snprintf(says, sizeof says, "points = %d: an orbit has at least 2", points);
        CHECK(status.code == MORAY_INPUT && strcmp(status.text, says) == 0 && !track.t, "%s", status.text);
    }
    moray_orbit_free(orbit);
}

int main(void)
{
    for (int model = 0; model < 2; model++) {
        test_sides((moray_model)model);
        test_peaks((moray_model)model);
    }
    test_tracks();
    return tap_done();
}
