// SPDX-License-Identifier: MIT
//
// Sensors and actuators by hand: what a controller is shown and what becomes of what it commands.
#include "degree.h"
#include "tap.h"

#include <string.h>

#include "moray/snake/instruments.h"

typedef struct listener {
    moray_pose shown;
    double value; // commanded from now on
    int looks;
} listener;

static moray_status listen(const moray_swim_sample *sample, void *self)
{
    listener *l = self;
    l->shown = sample->pose;
    l->looks++;
    if (sample->x || sample->u)
        CHECK(false, "no state is shown");
    return moray_ok();
}

static moray_offset say(double t, const void *self)
{
    (void)t;
    return (moray_offset){.value = ((const listener *)self)->value};
}

static const moray_straight_motion swinging = {.gait = {.omega = 2}, .undulation = {0.1, -0.05}};

static moray_instruments *around(const moray_swim_controller *controller, const moray_sensors *sensors,
                                 const moray_actuators *actuators)
{
    moray_instruments *w;
    CHECK_OK(moray_instruments_new(&w, sensors, actuators, &swinging, 10, controller), "new");
    return w;
}

static double swing(double t)
{
    return 0.1 * cos(2 * t) - 0.05 * sin(2 * t);
}

static void look(const moray_swim_controller *outer, double t)
{
    const moray_swim_sample sample = {.t = t, .pose = {.heading = 0.5 * t + swing(t), .p_x = t, .p_y = -t}};
    moray_status status = outer->measure(&sample, outer->self);
    if (moray_failed(status))
        CHECK_OK(status, "measured");
}

// A reading half a second apart and 0.3 s late: the mean heading is that of then, the undulation that of now.
static void test_late(void)
{
    listener l = {0};
    const moray_swim_controller controller = {say, listen, 0.1, &l};
    const moray_sensors sensors = {.sampling = 0.5, .delay = 0.3};
    moray_instruments *w = around(&controller, &sensors, &(moray_actuators){0});
    const moray_swim_controller outer = moray_instruments_controller(w);
    double worst = 0;
    for (int k = 0; k <= 40; k++) {
        const double t = 0.1 * k, taken = 0.5 * floor(fmax(t - 0.3, 0) / 0.5 + 1e-9);
        look(&outer, t);
        worst = tap_worse(worst, fabs(l.shown.heading - (0.5 * taken + swing(t))));
        worst = tap_worse(worst, fabs(l.shown.p_x - taken) + fabs(l.shown.p_y + taken));
        worst = tap_worse(worst, fabs(moray_instruments_reading(w)->t - taken));
    }
    CHECK_NEAR(worst, 0, 1e-9, "late readings");
    CHECK(l.looks == 41, "at every look");
    moray_instruments_free(w);
}

static void test_noise(void)
{
    enum { n = 4000 };
    const double period = 0.1;
    listener l = {0};
    const moray_swim_controller controller = {say, listen, period, &l};
    const moray_sensors sensors = {
        .heading = 1 * DEG, .joints = 0.5 * DEG, .position = 0.2, .drop_out = 0.25, .seed = 7};
    double sum = 0, squares = 0, places = 0, first = 0, again = 0, weights = 0;
    int fresh = 0;
    for (int i = 1; i < 10; i++)
        weights += i * i / 100.0;
    const double expected = DEG * sqrt(1 + 0.25 * weights);
    for (int run = 0; run < 2; run++) {
        moray_instruments *w = around(&controller, &sensors, &(moray_actuators){0});
        const moray_swim_controller outer = moray_instruments_controller(w);
        for (int k = 0; k < n; k++) {
            const double t = period * k;
            const moray_swim_sample sample = {.t = t, .pose = {.heading = swing(t), .p_x = 3}};
            if (moray_failed(outer.measure(&sample, outer.self)))
                break;
            if (run == 0 && moray_instruments_reading(w)->fresh) {
                const double error = l.shown.heading - swing(t);
                fresh++;
                sum += error;
                squares += error * error;
                places += (l.shown.p_x - 3) * (l.shown.p_x - 3);
            }
        }
        *(run == 0 ? &first : &again) = l.shown.heading;
        moray_instruments_free(w);
    }
    CHECK_NEAR(fresh, 0.75 * n, 150, "readings that arrive");
    CHECK_NEAR(sum / fresh, 0, 0.1 * expected, "mean error of the heading [rad]");
    CHECK_NEAR(sqrt(squares / fresh), expected, 0.05 * expected, "standard deviation, joints included [rad]");
    CHECK_NEAR(sqrt(places / fresh), 0.2, 0.01, "of the place [m]");
    CHECK(first == again, "the same seed has the same errors");
}

// The rate of the mean heading without that of the undulation, with an error of its own.
static void test_gyro(void)
{
    enum { n = 4000, v_theta = 21, states = 24 };
    const double turning = 0.3, error = 2 * DEG;
    listener l = {0};
    const moray_swim_controller controller = {say, listen, 0.1, &l};
    double sum = 0, squares = 0;
    moray_instruments *w =
        around(&controller, &(moray_sensors){.gyro = true, .rate = error, .seed = 5}, &(moray_actuators){0});
    const moray_swim_controller outer = moray_instruments_controller(w);
    for (int k = 0; k < n; k++) {
        const double t = 0.1 * k;
        double x[states] = {[v_theta] = turning - 0.2 * sin(2 * t) - 0.1 * cos(2 * t)}; // of swing
        const moray_swim_sample sample = {.t = t, .x = x};
        if (moray_failed(outer.measure(&sample, outer.self)))
            break;
        const double off = moray_instruments_reading(w)->rate - turning;
        sum += off / n;
        squares += off * off / n;
    }
    CHECK_NEAR(sum, 0, 0.05 * error, "mean error of the rate [rad/s]");
    CHECK_NEAR(sqrt(squares), error, 0.05 * error, "its standard deviation [rad/s]");
    moray_instruments_free(w);
    w = around(&controller, &(moray_sensors){0}, &(moray_actuators){0});
    const moray_swim_controller without = moray_instruments_controller(w);
    look(&without, 0);
    CHECK(isnan(moray_instruments_reading(w)->rate), "no rate without a gyro");
    moray_instruments_free(w);
}

static void test_actuators(void)
{
    listener l = {.value = 0};
    const moray_swim_controller controller = {say, listen, 0.1, &l};
    moray_instruments *w = around(&controller, &(moray_sensors){0}, &(moray_actuators){.dead_time = 0.3, .rate = 0.5});
    const moray_swim_controller outer = moray_instruments_controller(w);
    look(&outer, 0);
    l.value = 0.1; // from 0.1 s on
    for (int k = 1; k <= 4; k++)
        look(&outer, 0.1 * k);
    CHECK_NEAR(outer.offset(0.4, outer.self).value, 0, 1e-12, "nothing moves within the dead time");
    CHECK_NEAR(outer.offset(0.45, outer.self).value, 0.025, 1e-12, "then at the rate of the actuator");
    CHECK_NEAR(outer.offset(0.45, outer.self).rate, 0.5, 1e-12, "which is told");
    for (int k = 5; k <= 8; k++)
        look(&outer, 0.1 * k);
    CHECK_NEAR(outer.offset(0.8, outer.self).value, 0.1, 1e-12, "to what was commanded");
    moray_instruments_free(w);
}

static void refuse(const moray_sensors *sensors, const moray_actuators *actuators,
                   const moray_swim_controller *controller, const char *says)
{
    char taken;
    moray_instruments *w = (void *)&taken;
    const moray_status status = moray_instruments_new(&w, sensors, actuators, &swinging, 10, controller);
    CHECK(status.code == MORAY_INPUT && strstr(status.text, says), "not '%s': %s", says, status.text);
    CHECK(!w, "and nothing is left");
}

// Each number that is none, by its name and value, with all others as they should be.
static void test_numbers_refused(const moray_swim_controller *controller)
{
    static const struct {
        moray_sensors sensors;
        moray_actuators actuators;
        const char *says;
    } bad[] = {{.sensors.heading = -1, .says = "heading noise = -1"},
               {.sensors.joints = -2, .says = "joint noise = -2"},
               {.sensors.position = -3, .says = "position noise = -3"},
               {.sensors.rate = -4, .says = "noise of the heading's rate = -4"},
               {.sensors.sampling = -5, .says = "sampling of the sensors = -5"},
               {.sensors.delay = -6, .says = "delay of the sensors = -6"},
               {.actuators.dead_time = -7, .says = "dead time = -7"},
               {.actuators.rate = INFINITY, .says = "rate of the actuators = inf"},
               {.actuators.torque = NAN, .says = "torque of the actuators = nan"},
               {.sensors.drop_out = 1, .says = "drop-outs = 1"},
               {.sensors.drop_out = -0.1, .says = "drop-outs = -0.1"},
               {.sensors.delay = 1e4, .says = "delay = 10000 s, dead time = 0 s"},
               {.actuators.dead_time = 1e4, .says = "delay = 0 s, dead time = 10000 s"}};
    for (unsigned k = 0; k < sizeof bad / sizeof *bad; k++)
        refuse(&bad[k].sensors, &bad[k].actuators, controller, bad[k].says);
}

static void test_refusals(void)
{
    listener l = {0};
    const moray_swim_controller controller = {say, listen, 0.1, &l}, blind = {say, NULL, 0.1, &l},
                                standing = {say, listen, 0, &l};
    test_numbers_refused(&controller);
    refuse(&(moray_sensors){0}, &(moray_actuators){0}, &blind, "a controller that measures");
    refuse(&(moray_sensors){0}, &(moray_actuators){0}, &standing, "a controller that measures");
}

int main(void)
{
    test_late();
    test_noise();
    test_gyro();
    test_actuators();
    test_refusals();
    return tap_done();
}
