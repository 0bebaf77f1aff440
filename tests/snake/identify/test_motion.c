// SPDX-License-Identifier: MIT
//
// The motion of the joints: gaits found to the last parameter, least squares by its own conditions, and when splines
// are taken in their place.
#include "degree.h"
#include "tap.h"

#include <string.h>

#include "snake/identify/motion.h"

enum { ROWS = 150, JOINTS = 4, MOST_JOINTS = 6, PARAMETERS = 6 };
static const char *const no_gait = "log made: the joints follow no gait (25)";

static int line[ROWS];
static double times[ROWS], angles[ROWS * MOST_JOINTS];

// Parameters in the order amplitude, omega, delta, offset, taper, phase at the first row.
static double wave(const double p[PARAMETERS], int joints, int i, double t)
{
    const double place = joints > 1 ? -1 + 2.0 * i / (joints - 1) : 0;
    return p[0] * (1 + p[4] * place) * sin(p[1] * t + i * p[2] + p[5]) + p[3];
}

static moray_swim_log log_of(const double p[PARAMETERS], int joints, double from, double step)
{
    const moray_swim_log log = {.name = "made", .n = ROWS, .joints = joints, .line = line, .t = times, .phi = angles};
    for (int k = 0; k < ROWS; k++) {
        line[k] = 2 * k + 3;
        times[k] = from + k * step;
        for (int i = 0; i < joints; i++)
            angles[k * joints + i] = wave(p, joints, i, k * step);
    }
    return log;
}

// ---- Gaits ---------------------------------------------------------------------------------------------------------

static void check_gait(const double p[PARAMETERS], int joints, double from, double step, bool gaps)
{
    moray_swim_log log = log_of(p, joints, from, step);
    struct motion m;
    for (int k = 0; k < ROWS * joints && gaps; k++)
        if (k % 7 == 3 || k % 11 == 0)
            angles[k] = NAN;
    CHECK_OK(moray_motion_new(&m, &log, MORAY_LOGGED_GAIT), "a gait");
    CHECK_NEAR(m.gait.amplitude, p[0], 1e-9, "amplitude");
    CHECK_NEAR(m.gait.omega, p[1], 1e-9, "omega");
    CHECK_NEAR(remainder(m.gait.delta - p[2], 2 * M_PI), 0, 1e-9, "delta");
    CHECK_NEAR(m.gait.offset, p[3], 1e-9, "offset");
    CHECK_NEAR(m.gait.taper, p[4], 1e-8, "taper");
    CHECK_NEAR(remainder(p[1] * (from + m.shift) - p[5], 2 * M_PI), 0, 1e-7, "phase at the first row");
    CHECK(m.rms < 1e-9 && m.on_gait && m.joints == joints && !m.joint, "and nothing left: %.1e", m.rms);
    moray_motion_free(&m);
}

// Of waves forward and back, that grow or shrink along the body, slow and fast.
static void test_gaits(void)
{
    const double length = (ROWS - 1) * 0.05;
    check_gait((const double[]){0.4, 2, 0.7, 0.05, 0.3, 0.4}, 4, 0, 0.05, false);
    check_gait((const double[]){0.4, 2, 0.7, 0.05, 0.3, 0.4}, 4, 31.7, 0.05, true);
    check_gait((const double[]){0.2, 3.3, -0.9, -0.3, -0.6, 2.8}, 3, -5, 0.05, true);
    check_gait((const double[]){1.1, 1.4, 2.1, 0.2, 0, -2}, 2, 3, 0.05, false);
    check_gait((const double[]){0.3, 5 / length, 0.5, 0.1, 0.1, 1}, 3, 2, 0.05, false);
    check_gait((const double[]){0.3, 0.95 * M_PI / 0.15, 0.5, 0.1, 0.1, 1}, 3, 2, 0.05, false);
    check_gait((const double[]){0.25, 7, 1.2, -0.4, -0.4, 1}, 3, 100, 0.03, true);
    check_gait((const double[]){0.3, 2, 2.8, 0.1, 0.2, 1}, 6, 0, 0.05, true);
    check_gait((const double[]){0.3, 2, -2.5, 0.1, -0.8, -1}, 6, 0, 0.05, false);
}

static double squares(const double p[PARAMETERS], const moray_swim_log *log, int *used)
{
    double sum = 0;
    *used = 0;
    for (int k = 0; k < log->n * log->joints; k++)
        if (!isnan(log->phi[k])) {
            const double r = log->phi[k] - wave(p, log->joints, k % log->joints, log->t[k / log->joints] - log->t[0]);
            sum += r * r;
            ++*used;
        }
    return sum;
}

// With noise: what is left is least, and its mean square is told, of as many values as are free.
static void test_least_squares(void)
{
    const double p[PARAMETERS] = {0.4, 2.3, 0.6, 0.1, -0.2, 0.9};
    moray_swim_log log = log_of(p, JOINTS, 12, 0.05);
    struct motion m;
    int used;
    for (int k = 0; k < ROWS * JOINTS; k++)
        angles[k] = k % 13 == 5 ? NAN : angles[k] + 0.03 * remainder(5e4 * sin(17 * k + 1), 1);
    CHECK_OK(moray_motion_new(&m, &log, MORAY_LOGGED_GAIT), "with noise");
    const double at[PARAMETERS] = {m.gait.amplitude, m.gait.omega, m.gait.delta,
                                   m.gait.offset,    m.gait.taper, m.gait.omega * (m.shift + 12)};
    const double least = squares(at, &log, &used);
    CHECK_RELATIVE(m.rms, sqrt(least / (used - PARAMETERS)), 1e-12, "rms");
    for (int i = 0; i < PARAMETERS; i++) {
        double up[PARAMETERS], down[PARAMETERS];
        memcpy(up, at, sizeof up);
        memcpy(down, at, sizeof down);
        up[i] += 1e-4, down[i] -= 1e-4;
        const double above = squares(up, &log, &used) - least, below = squares(down, &log, &used) - least;
        CHECK(above > 0 && below > 0 && fabs(above - below) < 1e-4 * (above + below),
              "parameter %d at the least: %.3g on either side", i, above);
    }
    char text[160];
    snprintf(text, sizeof text,
             "gait alpha %.4g deg, omega %.5g deg/s, delta %.4g deg, phi_0 %.4g deg, taper %.3g; within %.3g deg",
             at[0] / DEG, at[1] / DEG, at[2] / DEG, at[3] / DEG, at[4], m.rms / DEG);
    CHECK(strcmp(m.text, text) == 0, "%s", m.text);
    moray_motion_free(&m);
}

static void refused(const moray_swim_log *log, moray_logged_joints wanted, moray_code code, const char *text)
{
    struct motion m;
    const moray_status status = moray_motion_new(&m, log, wanted);
    CHECK(status.code == code && strcmp(status.text, text) == 0, "\"%s\", expected \"%s\"", status.text, text);
    moray_motion_free(&m);
}

static void test_no_gait(void)
{
    moray_swim_log log = log_of((const double[]){0, 2, 0, 0, 0, 0}, 2, 0, 0.05);
    refused(&log, MORAY_LOGGED_GAIT, MORAY_NUMERIC, no_gait);
    log = log_of((const double[]){0.3, 2, 0.4, 0, 0, 0}, 1, 0, 0.05);
    for (int k = 0; k < ROWS; k++)
        if (k % 25 != 1) // six values for six parameters
            angles[k] = NAN;
    refused(&log, MORAY_LOGGED_GAIT, MORAY_NUMERIC, no_gait);
    for (int k = 0; k < ROWS; k++)
        angles[k] = NAN;
    refused(&log, MORAY_LOGGED_GAIT, MORAY_NUMERIC, no_gait);
}

// Of what is no wave at all there is none, or one whose amplitude and rate are above nothing.
static void test_noise_alone(void)
{
    int none = 0, found = 0, wrong = 0;
    unsigned long long seed = 3;
    for (int trial = 0; trial < 300; trial++) {
        moray_swim_log log = log_of((const double[PARAMETERS]){0}, 1 + trial % 3, 0, 0.1);
        struct motion m;
        log.n = 8 + trial % 13;
        for (int k = 0; k < log.n * log.joints; k++)
            angles[k] = tap_random(&seed, -0.5, 0.5);
        const moray_status status = moray_motion_fit_gait(&m, &log);
        none += moray_failed(status);
        found += !moray_failed(status);
        wrong += moray_failed(status) ? strcmp(status.text, no_gait) != 0
                                      : !(m.gait.amplitude > 0 && m.gait.omega > 0 && isfinite(m.rms));
    }
    CHECK(wrong == 0 && none > 20 && found > 20, "noise: %d gaits, %d none, %d wrong", found, none, wrong);
}

// ---- Splines -------------------------------------------------------------------------------------------------------

static double swing(int i, double t)
{
    return 0.1 * i + 0.4 * sin(0.9 * t * t / 4 + i);
}

// Joints apart: each by its own spline, told by the first and by the root of the mean of the variances.
static void test_splines(void)
{
    moray_swim_log log = log_of((const double[]){0, 1, 0, 0, 0, 0}, 3, 2, 0.02);
    struct motion m;
    double worst = 0, noise = 0, d[3];
    for (int k = 0; k < ROWS * 3; k++)
        angles[k] = swing(k % 3, times[k / 3]) + 0.002 * (1 + k % 3) * remainder(5e4 * sin(17 * k + 1), 1);
    for (int wanted = 0; wanted < 2; wanted++) {
        CHECK_OK(moray_motion_new(&m, &log, wanted ? MORAY_LOGGED_SPLINE : MORAY_LOGGED_AUTO), "splines");
        CHECK(!m.on_gait && m.joint && m.joints == 3, "no gait: %s", m.text);
        noise = 0;
        for (int i = 0; i < 3 && m.joint; i++) {
            struct smooth alone;
            CHECK_OK(moray_smooth_fit(&alone, ROWS, times, angles + i, 3), "one joint");
            noise += alone.noise * alone.noise / 3;
            for (double t = 2.1; t < 4.9; t += 0.1) {
                double own[3];
                moray_smooth_at(&m.joint[i], t, d);
                moray_smooth_at(&alone, t, own);
                worst = tap_worse(worst, fabs(d[0] - own[0]) + fabs(d[1] - own[1]) + fabs(d[2] - own[2]));
            }
            moray_smooth_free(&alone);
        }
        CHECK(worst == 0, "each joint is its own: %.1e", worst);
        CHECK_RELATIVE(m.rms, sqrt(noise), 1e-12, "rms");
        char text[160];
        snprintf(text, sizeof text, "splines of %d to %.3g s, within %.3g deg", m.joint[0].pieces, m.joint[0].width,
                 sqrt(noise) / DEG);
        CHECK(strcmp(m.text, text) == 0, "%s", m.text);
        moray_motion_free(&m);
    }
}

// A second harmonic, which no gait has, up to where its mean square is a share of the amplitude that is nothing.
static void check_harmonic(double share, bool on_gait)
{
    const double p[PARAMETERS] = {0.4, 4, 0.5, 0.1, 0.2, 0.3};
    moray_swim_log log = log_of(p, 3, 1, 0.025);
    struct motion m;
    for (int k = 0; k < ROWS * 3; k++)
        angles[k] += M_SQRT2 * share * p[0] * sin(2 * p[1] * times[k / 3]);
    CHECK_OK(moray_motion_new(&m, &log, MORAY_LOGGED_AUTO), "a gait with a harmonic");
    CHECK(m.on_gait == on_gait && !m.joint == on_gait, "share %g: %s", share, m.text);
    CHECK(!on_gait || fabs(m.rms / (share * p[0]) - 1) < 0.02, "the gait's own rms: %.3g", m.rms);
    CHECK((strstr(m.text, "gait alpha") != NULL) == on_gait, "as it says: %s", m.text);
    moray_motion_free(&m);
}

// Among noise as large as the splines' own the gait is taken.
static void test_choice(void)
{
    const double p[PARAMETERS] = {0.4, 2, 0.5, 0.1, 0.2, 0.3};
    struct motion m;
    check_harmonic(1.5e-4, true);
    check_harmonic(1.9e-4, true);
    check_harmonic(2.3e-4, false);
    check_harmonic(1e-2, false);
    moray_swim_log log = log_of(p, 3, 1, 0.02);
    for (int k = 0; k < ROWS * 3; k++)
        angles[k] += 0.02 * remainder(5e4 * sin(17 * k + 1), 1);
    CHECK_OK(moray_motion_new(&m, &log, MORAY_LOGGED_AUTO), "a gait with noise");
    CHECK(m.on_gait && m.rms > 1e-3, "among noise: %s", m.text);
    moray_motion_free(&m);
    for (int k = 0; k < ROWS; k++) // where there is none for splines
        if (times[k] > 1.4 && times[k] < 2)
            angles[k * 3 + 1] = NAN;
    CHECK_OK(moray_motion_new(&m, &log, MORAY_LOGGED_AUTO), "a gait with a gap");
    CHECK(m.on_gait && !m.joint, "across a gap: %s", m.text);
    moray_motion_free(&m);
}

// ---- Gaps ----------------------------------------------------------------------------------------------------------

static void check_gap(int joint, int first, int last, const char *text)
{
    moray_swim_log log = log_of((const double[]){0.4, 2, 0.5, 0.1, 0.2, 0.3}, 2, 3, 0.0625);
    struct motion m;
    for (int k = first; k <= last; k++)
        angles[k * 2 + joint] = NAN;
    if (text) {
        refused(&log, MORAY_LOGGED_SPLINE, MORAY_INPUT, text);
        return;
    }
    CHECK_OK(moray_motion_new(&m, &log, MORAY_LOGGED_SPLINE), "no gap that is too wide");
    moray_motion_free(&m);
}

// At both ends and between, exactly as wide as is let and a row wider.
static void test_gaps(void)
{
#define TOLD "; splines need one every 0.25 s (a log of a gait (25) needs none so often: --joints gait)"
    check_gap(1, 20, 22, NULL);
    check_gap(1, 20, 23, "log made, line 51: joint 2 has no value from 4.1875 s to 4.5 s" TOLD);
    check_gap(0, 0, 3, NULL);
    check_gap(0, 0, 4, "log made, line 13: joint 1 has no value from 3 s to 3.3125 s" TOLD);
    check_gap(0, ROWS - 4, ROWS - 1, NULL);
    check_gap(0, ROWS - 5, ROWS - 1, "log made, line 301: joint 1 has no value from 12 s to 12.3125 s" TOLD);
#undef TOLD
}

int main(void)
{
    test_gaits();
    test_least_squares();
    test_no_gait();
    test_noise_alone();
    test_splines();
    test_choice();
    test_gaps();
    return tap_done();
}
