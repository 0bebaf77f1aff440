// SPDX-License-Identifier: MIT
//
// The moving horizon on readings without errors of the averaged plant's own swim: it finds what is true, from a window
// as long as it is told, readings that are lost aside.
#include "averaged_swimmer.h"
#include "degree.h"
#include "tap.h"

#include <string.h>

#include "moray/snake/moving_horizon.h"
#include "moray/snake/trial.h"

enum { n = 41, FALSE_UNTIL = 16 };

typedef struct swum {
    double t[n], offset[n], heading[n], p_x[n], p_y[n];
} swum;

static moray_navigator_spec spec_of(moray_belief believed)
{
    moray_navigator_spec spec = {.robot = moray_robot_paper(),
                                 .speed = 0.22,
                                 .belief = believed,
                                 .current_doubt = 0.1,
                                 .factor_doubt = 0.3,
                                 .heading_error = 0.2 * DEG,
                                 .position_error = 0.005};
    spec.gait = moray_gait_paper(&spec.robot);
    return spec;
}

// Turns one way and the other by offsets that go in straight lines between readings; the first of these are false.
static void swim_along(const moray_navigator_spec *spec, moray_belief truth, swum *log)
{
    swimmer s = swimmer_of(spec, truth);
    double x[body] = {0.4, 1, -2, 0, 0.22, 0};
    for (int k = 0; k < n; k++)
        log->offset[k] = k < 5 ? 0 : k < 25 ? 0.008 * sin(0.35 * (k - 5)) : -0.006 * cos(0.3 * k);
    for (int k = 0; k < n; k++) {
        log->t[k] = 3 + 0.5 * k;
        log->heading[k] = k % 9 == 6 ? NAN : x[MORAY_STATE_THETA] + (k < FALSE_UNTIL ? 0.5 : 0);
        log->p_x[k] = x[MORAY_STATE_P_X] + (k < FALSE_UNTIL ? 3 : 0);
        log->p_y[k] = x[MORAY_STATE_P_Y];
        if (k + 1 == n)
            break;
        s.offset = log->offset[k];
        s.rate = (log->offset[k + 1] - log->offset[k]) / 0.5;
        swim(&s, 0.5, 20, x);
    }
    moray_map_release(&s.map);
}

static moray_status find(const moray_navigator_spec *spec, const swum *at, double window, moray_belief *found,
                         double error[4])
{
    const moray_log log = {n, at->t, at->offset, at->heading, at->p_x, at->p_y};
    moray_settings settings = moray_settings_default();
    settings.scheme = "radau3";
    settings.intervals = 24;
    settings.tolerance = 1e-9;
    return moray_moving_horizon(spec, &log, window, &settings, found, error);
}

static void check_belief(const moray_belief *found, const moray_belief *truth, double tolerance)
{
    CHECK_NEAR(found->amplitude, truth->amplitude, tolerance, "factor of the thrust");
    CHECK_NEAR(found->turning, truth->turning, tolerance, "of the turning");
    CHECK_NEAR(found->current[0], truth->current[0], tolerance, "current along x [m/s]");
    CHECK_NEAR(found->current[1], truth->current[1], tolerance, "current along y [m/s]");
}

int main(void)
{
    const moray_belief truth = {0.9, 1.2, {0.05, -0.08}}, wrong = {1.1, 1, {0, 0}};
    moray_navigator_spec knowing = spec_of(truth), wondering = spec_of(wrong);
    moray_belief found;
    double error[4], again[4];
    static swum at;
    swim_along(&knowing, truth, &at);
    const double window = 0.5 * (n - 1 - FALSE_UNTIL); // from the first reading on that is true
    CHECK_OK(find(&knowing, &at, window, &found, error), "what is true and believed");
    check_belief(&found, &truth, 2e-4);
    CHECK_OK(find(&wondering, &at, window, &found, again), "what is true alone");
    check_belief(&found, &truth, 0.02);
    for (int k = 0; k < 4; k++)
        CHECK(error[k] > 1e-4 && error[k] < 0.1 && fabs(error[k] / again[k] - 1) < 0.3, "known to %.2g", error[k]);
    CHECK_OK(find(&knowing, &at, window + 1.1, &found, NULL), "a reading that is false");
    CHECK(fabs(found.current[0] - truth.current[0]) > 0.02, "misleads: %g m/s", found.current[0]);
    wondering.current_doubt = wondering.factor_doubt = 0;
    CHECK_OK(find(&wondering, &at, window, &found, NULL), "nothing in doubt");
    check_belief(&found, &wrong, 1e-12);
    const moray_status status = find(&knowing, &at, 0.2, &found, NULL);
    CHECK(status.code == MORAY_INPUT &&
              strcmp(status.text, "window = 0.2 s: 1 readings in it, must be at least 2") == 0,
          "%s", status.text);
    CHECK_OK(find(&knowing, &at, 0.5, &found, NULL), "two readings are enough");
    return tap_done();
}
