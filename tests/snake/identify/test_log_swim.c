// SPDX-License-Identifier: MIT
//
// Synthetic logs: what the swimmer does, seen late, through a camera, with noise of the size that is told.
#include "swum_logs.h"

enum { LONG = 1501 };
static const double from = 3, step = 0.0625;
static const moray_gait gait = {.amplitude = 0.5, .omega = 2.4, .delta = 0.9, .offset = 0.1};

static moray_status swim(moray_swim_log *log, moray_model model, double to, const moray_swim_log_noise *noise)
{
    const moray_robot robot = swum_robot();
    moray_swimmer *swimmer;
    moray_gait own = gait;
    CHECK_OK(moray_swimmer_new(&swimmer, &robot, model), "swimmer");
    if (model == MORAY_CONTROL_ORIENTED)
        own = moray_gait_map(&robot, &gait, MORAY_FIRST_PRINCIPLES, model);
    const moray_status status = moray_swim_log_swim(log, swimmer, &own, 0.7, from, to, step, noise);
    moray_swimmer_free(swimmer);
    return status;
}

// Joints are those of the gait in either model; only the first-principles one has torques.
static void test_rows(void)
{
    for (int model = 0; model < 2; model++) {
        moray_swim_log log;
        double worst = 0, phi[2], rates[4];
        CHECK_OK(swim(&log, (moray_model)model, from + 8 * step, &(moray_swim_log_noise){0}), "a log");
        CHECK(log.n == 9 && log.joints == 2 && !log.u == (model == MORAY_CONTROL_ORIENTED), "nine rows, of either end");
        for (int k = 0; k < log.n; k++) {
            moray_gait_reference(&gait, 2, from + k * step, phi, rates, rates + 2);
            worst = tap_worse(worst, fabs(log.t[k] - from - k * step) + fabs(log.phi[2 * k] - phi[0]) +
                                         fabs(log.phi[2 * k + 1] - phi[1]) + abs(log.line[k] - k - 2));
        }
        CHECK(worst < 1e-5, "time, joints, which are integrated, and lines: %.1e", worst);
        moray_swim_log_free(&log);
    }
}

// Delays of whole rows: a reading is that of so many rows before; the camera turns and shifts, the compass is off.
static void test_seen(void)
{
    const moray_swim_log_noise seen = {.heading_bias = 0.3,
                                       .camera = {0.5, -0.25},
                                       .camera_rotation = 0.6,
                                       .position_delay = 3 * step,
                                       .heading_delay = 5 * step};
    moray_swim_log clean, log;
    double worst = 0;
    CHECK_OK(swim(&clean, MORAY_FIRST_PRINCIPLES, from + 30 * step, &(moray_swim_log_noise){0}), "clean");
    CHECK_OK(swim(&log, MORAY_FIRST_PRINCIPLES, from + 30 * step, &seen), "seen");
    for (int k = 5; k < log.n; k++) {
        const double x = clean.p_x[k - 3] - 0.5, y = clean.p_y[k - 3] + 0.25, c = cos(0.6), s = sin(0.6);
        const double errors[] = {log.p_x[k] - (c * x - s * y),
                                 log.p_y[k] - (s * x + c * y),
                                 log.heading[k] - clean.heading[k - 5] - 0.3,
                                 log.u[2 * k] - clean.u[2 * k],
                                 log.u[2 * k + 1] - clean.u[2 * k + 1],
                                 log.phi[2 * k] - clean.phi[2 * k]};
        for (int i = 0; i < 6; i++)
            worst = tap_worse(worst, fabs(errors[i]));
    }
    CHECK(worst < 1e-6, "late, turned and off: %.1e", worst);
    CHECK(fabs(clean.p_x[8] - clean.p_x[5]) > 1e-3 && fabs(clean.heading[8] - clean.heading[3]) > 1e-3,
          "which it would not be by chance");
    moray_swim_log_free(&clean);
    moray_swim_log_free(&log);
}

// ---- Noise ---------------------------------------------------------------------------------------------------------

// Of n differences at a stride: as large as told on the whole, and on either side; NAN is passed over.
static void check_scatter(const double *one, const double *other, int n, int stride, double sigma, const char *what)
{
    double sum = 0, square = 0;
    int used = 0;
    for (int k = 0; k < n; k++) {
        const double d = one[k * stride] - other[k * stride];
        if (isnan(d) || fabs(d) > 8 * sigma)
            continue;
        sum += d, square += d * d, used++;
    }
    CHECK(fabs(sqrt(square / used) / sigma - 1) < 0.1 && fabs(sum / used) < 0.1 * sigma,
          "%s: rms %.4g, %.4g told; mean %.1e", what, sqrt(square / used), sigma, sum / used);
}

// Shares of what is missing and far out; these are 20 standard deviations off, as many to either side.
static void check_faults(const double *one, const double *other, double sigma, const moray_swim_log_noise *noise,
                         const char *what)
{
    int missing = 0, side[2] = {0};
    for (int k = 0; k < LONG; k++) {
        const double d = (one[k] - other[k]) / sigma;
        missing += isnan(d);
        if (fabs(d) > 8) {
            CHECK(fabs(fabs(d) - 20) < 5, "%s: %.3g sigma off", what, d);
            side[d > 0]++;
        }
    }
    const double share = (double)missing / LONG, far = (side[0] + side[1]) / (1 - noise->missing) / LONG;
    CHECK(fabs(share / noise->missing - 1) < 0.3, "%s: a share of %.3f is missing", what, share);
    CHECK(fabs(far / noise->outliers - 1) < 0.3, "%s: a share of %.3f is far out", what, far);
    CHECK(side[0] > side[1] / 2 && side[1] > side[0] / 2, "%s: %d to one side, %d to the other", what, side[0],
          side[1]);
}

static void test_noise(void)
{
    const moray_swim_log_noise noise = {
        .position = 0.02, .heading = 0.05, .joints = 0.01, .torque = 0.3, .outliers = 0.1, .missing = 0.06, .seed = 3};
    moray_swim_log_noise other = noise;
    moray_swim_log clean, log, again;
    const double to = from + (LONG - 1) * step;
    CHECK_OK(swim(&clean, MORAY_FIRST_PRINCIPLES, to, &(moray_swim_log_noise){0}), "clean");
    CHECK_OK(swim(&log, MORAY_FIRST_PRINCIPLES, to, &noise), "noisy");
    check_scatter(log.p_x, clean.p_x, LONG, 1, noise.position, "p_x");
    check_scatter(log.p_y, clean.p_y, LONG, 1, noise.position, "p_y");
    check_scatter(log.heading, clean.heading, LONG, 1, noise.heading, "heading");
    for (int i = 0; i < 2; i++) {
        check_scatter(log.phi + i, clean.phi + i, LONG, 2, noise.joints, "phi");
        check_scatter(log.u + i, clean.u + i, LONG, 2, noise.torque, "u");
    }
    check_faults(log.p_x, clean.p_x, noise.position, &noise, "p_x");
    check_faults(log.p_y, clean.p_y, noise.position, &noise, "p_y");
    check_faults(log.heading, clean.heading, noise.heading, &noise, "heading");
    other.seed = 4;
    for (int seed = 3; seed < 5; seed++) {
        CHECK_OK(swim(&again, MORAY_FIRST_PRINCIPLES, to, seed == 3 ? &noise : &other), "again");
        CHECK((memcmp(again.u, log.u, LONG * 2 * sizeof *log.u) == 0) == (seed == 3), "the same by the same seed");
        moray_swim_log_free(&again);
    }
    moray_swim_log_free(&clean);
    moray_swim_log_free(&log);
}

// ---- Refusals ------------------------------------------------------------------------------------------------------

static void refused(double begin, double end, double every, double position_delay, double heading_delay,
                    const char *text)
{
    const moray_robot robot = swum_robot();
    const moray_swim_log_noise noise = {.position_delay = position_delay, .heading_delay = heading_delay};
    moray_swimmer *swimmer;
    moray_swim_log log;
    CHECK_OK(moray_swimmer_new(&swimmer, &robot, MORAY_FIRST_PRINCIPLES), "swimmer");
    const moray_status status = moray_swim_log_swim(&log, swimmer, &gait, 0, begin, end, every, &noise);
    CHECK(text ? status.code == MORAY_INPUT && strcmp(status.text, text) == 0 : !moray_failed(status),
          "\"%s\", expected \"%s\"", status.text, text ? text : "");
    CHECK(text || log.n == (int)round((end - begin) / every) + 1, "%d rows", log.n);
    moray_swim_log_free(&log);
    moray_swimmer_free(swimmer);
}

static void test_refusals(void)
{
    refused(0, 0.3, 0.1, 0, 0, NULL); // the quotient is a little below 3
    refused(0.5, 1, 0.125, 0.5, 0.25, NULL);
    refused(0.5, 1, 0.125, 0.25, 0.5, NULL);
    refused(1, 2, 0, 0, 0, "a log from 1 s to 2 s every 0 s: must be at most a million rows after 0");
    refused(2, 2, 0.1, 0, 0, "a log from 2 s to 2 s every 0.1 s: must be at most a million rows after 0");
    refused(-1, 2, 0.1, 0, 0, "a log from -1 s to 2 s every 0.1 s: must be at most a million rows after 0");
    refused(1, 12, 1e-5, 0, 0, "a log from 1 s to 12 s every 1e-05 s: must be at most a million rows after 0");
    refused(1, 2, 0.1, 1.5, 0, "a delay of 1.5 s: must be 0 to 1 s, where the log begins");
    refused(1, 2, 0.1, 0.5, 1.25, "a delay of 1.25 s: must be 0 to 1 s, where the log begins");
    refused(1, 2, 0.1, 0.5, -0.25, "a delay of 0.5 s: must be 0 to 1 s, where the log begins");
    refused(1, 2, 0.1, -0.25, 0.5, "a delay of 0.5 s: must be 0 to 1 s, where the log begins");
}

int main(void)
{
    test_rows();
    test_seen();
    test_noise();
    test_refusals();
    return tap_done();
}
