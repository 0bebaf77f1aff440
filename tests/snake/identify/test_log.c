// SPDX-License-Identifier: MIT
//
// Logs from files, values that are missing among them, and the gait of a single joint.
#include "tap.h"

#include <string.h>
#include <unistd.h>

#include "snake/identify/motion.h"

enum { ROWS = 60, MISSING = 7 };

static double joint_at(double t)
{
    return 0.1 + 0.3 * sin(2 * t + 0.5);
}

// A robot of one joint that goes along x, from 100 s on; one row has no `gone`.
static void write_log(const char *path, const char *gone)
{
    FILE *file = fopen(path, "w");
    fputs("t,phi_1,p_x,p_y,heading\n", file);
    for (int k = 0; k < ROWS; k++) {
        const double t = 100 + 0.1 * k, value[] = {t, joint_at(t), 0.2 * (t - 100), 1, 0.05 * k};
        static const char *const names[] = {"t", "phi_1", "p_x", "p_y", "heading"};
        for (int j = 0; j < 5; j++) {
            fputs(j ? "," : "", file);
            if (k != MISSING || strcmp(names[j], gone) != 0)
                fprintf(file, "%.17g", value[j]);
        }
        fputs("\n", file);
    }
    fclose(file);
}

static moray_status read_log(moray_swim_log *log, const char *path)
{
    return moray_swim_log_read(log, path, &(moray_swim_log_format){.joints = 1, .torque_constant = NAN});
}

// What the file says is what is read; the one value that it does not say is missing, and noted.
static void test_values(const char *path)
{
    moray_swim_log log;
    double worst = 0;
    write_log(path, "p_x");
    CHECK_OK(read_log(&log, path), "a log with a value missing");
    CHECK(log.n == ROWS && log.joints == 1 && !log.u, "%d rows, no torques", log.n);
    for (int k = 0; k < log.n; k++) {
        const double t = 100 + 0.1 * k, x = k == MISSING ? 0 : log.p_x[k] - 0.2 * (t - 100);
        const double off = fabs(log.t[k] - t) + fabs(log.phi[k] - joint_at(t)) + fabs(x) + fabs(log.p_y[k] - 1) +
                           fabs(log.heading[k] - 0.05 * k);
        worst = isnan(off) ? INFINITY : fmax(worst, off);
    }
    CHECK(worst < 1e-12, "all that was written is read: %.1e", worst);
    CHECK(isnan(log.p_x[MISSING]) && strstr(log.notes, "p_x has no value in 1 of 60 places"), "%s", log.notes);
    moray_swim_log_free(&log);
}

static void test_no_time(const char *path)
{
    moray_swim_log log;
    write_log(path, "t");
    const moray_status status = read_log(&log, path);
    CHECK(status.code == MORAY_INPUT && strstr(status.text, ":9:"), "a row without a time: %s", status.text);
    moray_swim_log_free(&log);
}

// The gait that the joint was moved by; delta and taper, of which one joint shows nothing, are 0.
static void test_one_joint(const char *path)
{
    moray_swim_log log;
    struct motion motion;
    write_log(path, "");
    CHECK_OK(read_log(&log, path), "a whole log");
    CHECK_OK(moray_motion_new(&motion, &log, MORAY_LOGGED_GAIT), "the gait of one joint");
    CHECK_NEAR(motion.gait.amplitude, 0.3, 1e-9, "amplitude [rad]");
    CHECK_NEAR(motion.gait.omega, 2, 1e-9, "omega [rad/s]");
    CHECK_NEAR(motion.gait.offset, 0.1, 1e-9, "offset [rad]");
    CHECK_NEAR(remainder(2 * motion.shift - 0.5, 2 * M_PI), 0, 1e-7, "phase [rad]");
    CHECK(motion.gait.delta == 0 && motion.gait.taper == 0, "delta %g, taper %g", motion.gait.delta, motion.gait.taper);
    moray_motion_free(&motion);
    moray_swim_log_free(&log);
}

int main(void)
{
    char path[] = "/tmp/moray-log-XXXXXX";
    const int handle = mkstemp(path);
    if (!CHECK(handle >= 0 && close(handle) == 0, "a file"))
        return tap_done();
    test_values(path);
    test_no_time(path);
    test_one_joint(path);
    remove(path);
    return tap_done();
}
