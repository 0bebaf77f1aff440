// SPDX-License-Identifier: MIT
//
// Courses in still water and in currents along one axis alone, and whole texts of what steady swimming refuses.
#include "tap.h"

#include <string.h>

#include "moray/snake/trial.h"

static const moray_model model = MORAY_FIRST_PRINCIPLES;

static moray_gait gait_of(void)
{
    const moray_robot robot = moray_robot_paper();
    return (moray_gait){
        .amplitude = moray_amplitude_from_theta_max(&robot, model, 0.3, 0.8), .omega = 1.8, .delta = 0.8};
}

static moray_swim_setup setup_of(moray_swimmer *swimmer, double V_x, double V_y)
{
    return (moray_swim_setup){.swimmer = swimmer, .current = {V_x, V_y}, .settings = moray_swim_settings_default()};
}

// What is told of the course found is what swims from the heading found; but for the heading's drift in a current.
static void test_held(moray_swimmer *swimmer, double V_x, double V_y, double course)
{
    const moray_swim_setup setup = setup_of(swimmer, V_x, V_y);
    const moray_gait gait = gait_of();
    moray_steady held, again;
    CHECK_OK(moray_swim_hold_course(&setup, &gait, course, &held), "held");
    CHECK_NEAR(atan2(held.v_y, held.v_x), course, 1e-6, "along the course");
    CHECK_NEAR(hypot(held.v_x - V_x, held.v_y - V_y), held.speed, 1e-12, "speed through the water");
    CHECK_OK(moray_swim_steady(&setup, &gait, held.start_heading, &again, NULL, 0), "again");
    CHECK_NEAR(again.v_x, held.v_x, 1e-5, "v_x");
    CHECK_NEAR(again.v_y, held.v_y, 1e-5, "v_y");
    CHECK_NEAR(again.heading, held.heading, 1e-3, "heading");
    if (V_x == 0 && V_y == 0)
        CHECK_NEAR(held.heading, course, 1e-9, "in still water it looks where it swims");
}

static void refuse(const moray_swim_setup *setup, const moray_gait *gait, double heading, const char *says)
{
    moray_steady steady;
    const moray_status status = moray_swim_steady(setup, gait, heading, &steady, NULL, 0);
    CHECK(status.code == MORAY_INPUT && strcmp(status.text, says) == 0, "refused: %s", status.text);
}

static void test_refused(moray_swimmer *swimmer)
{
    const moray_swim_setup good = setup_of(swimmer, 0.1, 0.2);
    char says[300];
    for (int k = 0; k < 3; k++) {
        moray_swim_setup bad = good;
        double heading = 0.3;
        const moray_gait gait = gait_of();
        *(k < 2 ? &bad.current[k] : &heading) = NAN;
        snprintf(says, sizeof says, "start heading = %g, current = (%g, %g): must be finite", heading, bad.current[0],
                 bad.current[1]);
        refuse(&bad, &gait, heading, says);
    }
    for (int k = 0; k < 4; k++) {
        moray_gait bad = gait_of();
        double *const of[] = {&bad.amplitude, &bad.delta, &bad.offset, &bad.taper};
        *of[k] = INFINITY;
        snprintf(says, sizeof says, "gait amplitude = %g, delta = %g, offset = %g, taper = %g: must be finite",
                 bad.amplitude, bad.delta, bad.offset, bad.taper);
        refuse(&good, &bad, 0, says);
    }
    static const double omegas[] = {0, -1, INFINITY, NAN}, agreements[] = {0, -1, 1, NAN};
    for (int k = 0; k < 4; k++) {
        moray_gait gait = gait_of();
        moray_swim_setup bad = good;
        gait.omega = omegas[k];
        snprintf(says, sizeof says, "omega = %g: a steady gait needs a finite omega above 0", omegas[k]);
        refuse(&good, &gait, 0, says);
        gait = gait_of();
        bad.settings.agreement = agreements[k];
        snprintf(says, sizeof says, "agreement = %g: must lie between 0 and 1", agreements[k]);
        refuse(&bad, &gait, 0, says);
    }
    moray_swim_setup bad = good;
    bad.settings.max_periods = 2;
    const moray_gait gait = gait_of();
    refuse(&bad, &gait, 0, "max_periods = 2: must be at least 3");
}

// A current against the course, whose parts along and across are told.
static void test_astern(moray_swimmer *swimmer)
{
    const double course = 0.5, V[2] = {-0.4, -0.3};
    const moray_swim_setup setup = setup_of(swimmer, V[0], V[1]);
    const moray_gait gait = gait_of();
    moray_steady steady;
    char says[200];
    snprintf(says, sizeof says, "against a current of %.4g m/s along it and W = %.4g m/s across",
             V[0] * cos(course) + V[1] * sin(course), V[1] * cos(course) - V[0] * sin(course));
    const moray_status status = moray_swim_hold_course(&setup, &gait, course, &steady);
    CHECK(status.code == MORAY_NOT_SOLVED && strstr(status.text, says) &&
              strstr(status.text, "the course of 28.65 deg"),
          "%s", status.text);
}

// A gait that does not move holds no course, whatever the water does.
static void test_no_way(moray_swimmer *swimmer)
{
    const moray_gait gait = {.amplitude = 0, .omega = 1.8, .delta = 0.8};
    const moray_swim_setup setup = setup_of(swimmer, 0, 0);
    moray_steady steady;
    const moray_status status = moray_swim_hold_course(&setup, &gait, 0.4, &steady);
    CHECK(status.code == MORAY_NOT_SOLVED && strcmp(status.text, "the gait makes no way through the water") == 0, "%s",
          status.text);
    CHECK(steady.speed == 0, "%g m/s", steady.speed);
}

int main(void)
{
    const moray_robot robot = moray_robot_paper();
    moray_swimmer *swimmer;
    CHECK_OK(moray_swimmer_new(&swimmer, &robot, model), "swimmer");
    test_held(swimmer, 0, 0, 0.7);
    test_held(swimmer, 0, 0, -2);
    test_held(swimmer, 0.06, 0, 0.4);
    test_held(swimmer, 0, 0.06, -0.3);
    test_held(swimmer, 0.06, 0, -0.4);
    test_astern(swimmer);
    test_no_way(swimmer);
    test_refused(swimmer);
    moray_swimmer_free(swimmer);
    return tap_done();
}
