// SPDX-License-Identifier: MIT
//
// The navigator against the averaged plant's own map and against a linear filter, step by step.
#include "averaged_swimmer.h"
#include "degree.h"
#include "tap.h"

#include <string.h>

#include "moray/snake/navigator.h"
#include "moray/snake/trial.h"

static moray_navigator_spec spec_of(void)
{
    moray_navigator_spec spec = {.robot = moray_robot_paper(),
                                 .heading = 0.7,
                                 .position = {3, -2},
                                 .speed = 0.21,
                                 .belief = {1.1, 0.8, {0.06, -0.09}},
                                 .current_doubt = 0.1,
                                 .factor_doubt = 0.2,
                                 .heading_error = 0.5 * DEG,
                                 .position_error = 0.02,
                                 .rate_error = 0.3 * DEG};
    spec.gait = moray_gait_paper(&spec.robot);
    return spec;
}

static moray_navigator *navigator_of(const moray_navigator_spec *spec)
{
    moray_navigator *navigator;
    CHECK_OK(moray_navigator_new(&navigator, spec), "navigator");
    return navigator;
}

// ---- The plant -----------------------------------------------------------------------------------------------------

// What plans start from: velocities over ground in the body's frame.
static void check_state(const moray_navigator *navigator, const double *x, const double current[2], double tolerance)
{
    double state[body], worst = 0;
    const double c = cos(x[MORAY_STATE_THETA]), s = sin(x[MORAY_STATE_THETA]);
    moray_navigator_state(navigator, state);
    for (int i = 0; i <= MORAY_STATE_V_THETA; i++)
        worst = tap_worse(worst, fabs(state[i] - x[i]));
    worst = tap_worse(worst, fabs(state[MORAY_STATE_V_1] - x[MORAY_STATE_V_1] - c * current[0] - s * current[1]));
    worst = tap_worse(worst, fabs(state[MORAY_STATE_V_2] - x[MORAY_STATE_V_2] - c * current[1] + s * current[0]));
    CHECK_NEAR(worst, 0, tolerance, "the state");
}

// Of what is known the filter is the plant: with almost no doubt it swims as the plant does, whatever the time asked
// for, with an offset that moves.
static void test_known(void)
{
    moray_navigator_spec spec = spec_of();
    spec.current_doubt = spec.factor_doubt = 0;
    swimmer s = swimmer_of(&spec, spec.belief);
    moray_navigator *navigator = navigator_of(&spec);
    double x[body] = {0.7, 3, -2, 0, 0.21, 0};
    check_state(navigator, x, spec.belief.current, 1e-12);
    const moray_belief begun = moray_navigator_belief(navigator);
    CHECK_NEAR(begun.amplitude, 1.1, 1e-15, "factor of the thrust");
    CHECK_NEAR(begun.turning, 0.8, 1e-15, "of the turning");
    CHECK(begun.current[0] == 0.06 && begun.current[1] == -0.09, "current");
    CHECK(moray_navigator_doubt(navigator) == 0, "of which there is no doubt");
    static const double until[] = {0.1, 0.35, 0.85, 2.05}, offset[] = {0, 0.004, 0.009, -0.006},
                        rate[] = {0.01, 0.008, -0.01, 0.002};
    double t = 0;
    for (int k = 0; k < 4; k++) {
        s.offset = offset[k];
        s.rate = rate[k];
        swim(&s, until[k] - t, 200, x);
        CHECK_OK(moray_navigator_advance(navigator, until[k], offset[k], rate[k]), "advanced");
        t = until[k];
        // the first state's doubt, spread by the plant's curvature, moves the mean a little
        check_state(navigator, x, spec.belief.current, 2e-3);
    }
    CHECK_OK(moray_navigator_advance(navigator, t, 0.015, 0), "no time later");
    check_state(navigator, x, spec.belief.current, 2e-3);
    moray_navigator_free(navigator);
    moray_map_release(&s.map);
}

// ---- Readings ------------------------------------------------------------------------------------------------------

// Just begun every state stands alone: a reading moves it by the ratio of the variances.
static void test_readings(void)
{
    const moray_navigator_spec spec = spec_of();
    moray_navigator *navigator = navigator_of(&spec);
    double x[body] = {0.7, 3, -2, 0, 0.21, 0};
    const double of_heading = 1e-4 / (1e-4 + pow(0.5 * DEG, 2)), of_place = 1e-4 / (1e-4 + 4e-4),
                 of_rate = 1e-5 / (1e-5 + pow(0.3 * DEG, 2));
    CHECK_OK(moray_navigator_read(navigator, 0.72 + 2 * M_PI, 3.05, -2.03), "read");
    x[MORAY_STATE_THETA] += 0.02 * of_heading;
    x[MORAY_STATE_P_X] += 0.05 * of_place;
    x[MORAY_STATE_P_Y] -= 0.03 * of_place;
    check_state(navigator, x, spec.belief.current, 1e-12);
    CHECK_OK(moray_navigator_read_rate(navigator, 0.04), "a gyro read");
    x[MORAY_STATE_V_THETA] += 0.04 * of_rate;
    check_state(navigator, x, spec.belief.current, 1e-12);
    CHECK_NEAR(moray_navigator_doubt(navigator), 0.1, 1e-12, "the current is not seen");
    moray_navigator_free(navigator);
}

// The current's variance drifts by half of the doubt in five minutes; a place read after a while tells of the current.
static void test_doubt(void)
{
    moray_navigator_spec spec = spec_of();
    moray_navigator *navigator = navigator_of(&spec);
    CHECK_OK(moray_navigator_advance(navigator, 3, 0, 0), "advanced");
    CHECK_NEAR(moray_navigator_doubt(navigator), 0.1 * sqrt(1 + 3.0 / 1200), 1e-9, "grown in 3 s");
    double state[body];
    moray_navigator_state(navigator, state);
    const moray_belief before = moray_navigator_belief(navigator);
    CHECK_OK(moray_navigator_read(navigator, state[0], state[1] + 0.3, state[2]), "read further along x");
    const moray_belief after = moray_navigator_belief(navigator);
    const double moved = after.current[0] - before.current[0];
    CHECK(moved > 0.05 && moved < 0.1, "a current that took it there: %g m/s", moved);
    CHECK_NEAR(after.current[1], before.current[1], 0.02, "along x alone");
    const double doubt = moray_navigator_doubt(navigator);
    CHECK(doubt > 0.002 && doubt < 0.03, "which it now knows: %g m/s", doubt);
    moray_navigator_free(navigator);
}

// What is in doubt of the current after places read for 20 s straight ahead.
static double doubt_after(double heading, double factor_doubt)
{
    moray_navigator_spec spec = spec_of();
    double state[body];
    spec.heading = heading;
    spec.factor_doubt = factor_doubt;
    moray_navigator *navigator = navigator_of(&spec);
    for (int k = 1; k <= 20; k++) {
        CHECK_OK(moray_navigator_advance(navigator, k, 0, 0), "advanced");
        moray_navigator_state(navigator, state);
        CHECK_OK(moray_navigator_read(navigator, state[0], state[1], state[2]), "read");
    }
    const double doubt = moray_navigator_doubt(navigator);
    moray_navigator_free(navigator);
    return doubt;
}

// A doubt of the thrust is one of the current along the heading, whichever way that is: the larger one is told.
static void test_larger_doubt(void)
{
    for (int across = 0; across < 2; across++) {
        const double known = doubt_after(across * 90 * DEG, 0), unknown = doubt_after(across * 90 * DEG, 0.5);
        CHECK(unknown > 1.5 * known, "a thrust in doubt: %.3g m/s beside %.3g m/s", unknown, known);
    }
}

// ---- Beliefs -------------------------------------------------------------------------------------------------------

// Factors are found again from what the plant comes to with them, to either side.
static void test_belief(double offset)
{
    const moray_navigator_spec spec = spec_of();
    const moray_belief truth = {0.8, 1.3, {0, 0}};
    swimmer s = swimmer_of(&spec, truth);
    double x[body] = {[MORAY_STATE_V_1] = 0.3};
    swim(&s, 80, 800, x);
    const double speed = hypot(x[MORAY_STATE_V_1], x[MORAY_STATE_V_2]);
    s.offset = offset;
    swim(&s, 80, 800, x);
    const double rate = x[MORAY_STATE_V_THETA];
    moray_belief found;
    CHECK_OK(moray_belief_find(&found, &spec.robot, &spec.gait, speed, offset, rate), "belief");
    CHECK_NEAR(found.amplitude, 0.8, 1e-4, "factor of the thrust");
    CHECK_NEAR(found.turning, 1.3, 1e-3, "of the turning");
    CHECK(found.current[0] == 0 && found.current[1] == 0, "no current");
    for (int k = 0; k < 4; k++) { // beyond what factors up to 3 do, and below what a third does
        char says[200];
        const double v = k == 0 ? 5 * speed : k == 1 ? 0.05 * speed : speed;
        const double turn = k == 2 ? 5 * rate : k == 3 ? 0.1 * rate : rate;
        const moray_status status = moray_belief_find(&found, &spec.robot, &spec.gait, v, offset, turn);
        snprintf(says, sizeof says, "no factors of the averaged plant give %g m/s and %g rad/s", v, turn);
        CHECK(status.code == MORAY_NOT_SOLVED && strcmp(status.text, says) == 0, "%s", status.text);
    }
    moray_map_release(&s.map);
}

// ---- Refusals ------------------------------------------------------------------------------------------------------

static void test_refused(void)
{
    for (int k = 0; k < 6; k++) {
        moray_navigator_spec spec = spec_of();
        moray_navigator *navigator = NULL;
        char says[200];
        double *const fields[] = {&spec.heading_error, &spec.position_error, &spec.rate_error, &spec.current_doubt,
                                  &spec.factor_doubt};
        if (k < 5)
            *fields[k] = k < 2 ? 0 : -1;
        else
            spec.rate_error = spec.current_doubt = spec.factor_doubt = 0;
        const moray_status status = moray_navigator_new(&navigator, &spec);
        snprintf(says, sizeof says, "errors of the readings, %g rad and %g m: must be above 0, doubts at least 0",
                 spec.heading_error, spec.position_error);
        if (k < 5)
            CHECK(status.code == MORAY_INPUT && strcmp(status.text, says) == 0 && !navigator, "%s", status.text);
        else
            CHECK_OK(status, "nothing but the readings in doubt");
        moray_navigator_free(navigator);
    }
}

int main(void)
{
    test_known();
    test_readings();
    test_doubt();
    test_larger_doubt();
    test_belief(0.007);
    test_belief(-0.009);
    test_refused();
    return tap_done();
}
