// SPDX-License-Identifier: MIT
#include "degree.h"
#include "tap.h"

#include <stdlib.h>
#include <string.h>

#include "moray/snake/gait_input.h"

static moray_robot robot;

static moray_gait made(const moray_gait_input *input, moray_model model)
{
    moray_gait gait = {0};
    CHECK_OK(moray_gait_input_make(input, &robot, model, &gait), "a gait");
    return gait;
}

// By hand from (27) and (33), for theta_max = 15 deg, delta = 30 deg.
static void test_amplitudes(void)
{
    const double a = 0.14 * cos(15 * DEG) * sin(15 * DEG), alpha = 2 * sin(15 * DEG) * 15 * DEG;
    const double given[3][3] = {{15 * DEG, NAN, NAN}, {NAN, a, NAN}, {NAN, NAN, alpha}};
    for (int i = 0; i < 3; i++) {
        moray_gait_input input = moray_gait_input_default();
        input.delta = 30 * DEG;
        input.theta_max = given[i][0];
        input.a = given[i][1];
        input.alpha = given[i][2];
        CHECK_NEAR(made(&input, MORAY_CONTROL_ORIENTED).amplitude, a, 1e-15, "a");
        CHECK_NEAR(made(&input, MORAY_FIRST_PRINCIPLES).amplitude, alpha, 1e-15, "alpha");
    }
    const moray_gait_input nothing = moray_gait_input_default();
    CHECK_NEAR(made(&nothing, MORAY_FIRST_PRINCIPLES).amplitude, 2 * sin(20 * DEG) * 20 * DEG, 1e-15, "20 deg unasked");
    CHECK_NEAR(made(&nothing, MORAY_FIRST_PRINCIPLES).omega, 120 * DEG, 1e-15, "120 deg/s unasked");
}

// Erratum E3: opposite signs, the ratio of the amplitudes.
static void test_offsets(void)
{
    moray_gait_input input = moray_gait_input_default();
    input.phi0_m = 0.006;
    const double a = made(&input, MORAY_CONTROL_ORIENTED).amplitude, alpha = 2 * sin(20 * DEG) * 20 * DEG;
    CHECK_NEAR(made(&input, MORAY_CONTROL_ORIENTED).offset, 0.006, 0, "phi0_m on its model");
    CHECK_NEAR(made(&input, MORAY_FIRST_PRINCIPLES).offset, -0.006 * alpha / a, 1e-15, "phi0_m on the other");
    input.phi0 = -0.006 * alpha / a;
    CHECK_NEAR(made(&input, MORAY_CONTROL_ORIENTED).offset, 0.006, 1e-15, "both, in agreement");
    input.phi0_m = NAN;
    CHECK_NEAR(made(&input, MORAY_CONTROL_ORIENTED).offset, 0.006, 1e-15, "phi0_deg on the other");
    input.phi0_m = 0.006 * (1 + 2e-6);
    moray_gait gait;
    CHECK(moray_gait_input_make(&input, &robot, MORAY_CONTROL_ORIENTED, &gait).code == MORAY_INPUT,
          "both, in contradiction");
}

// Waves that run the other way in terms that agree to 1e-6, and in terms that do not, on either side.
static void test_negative(void)
{
    const double a = 0.14 * cos(20 * DEG) * sin(-15 * DEG);
    moray_gait_input input = moray_gait_input_default();
    moray_gait gait;
    input.theta_max = -15 * DEG;
    for (int side = -1; side <= 1; side += 2) {
        input.a = a * (1 + side * 0.9e-6);
        CHECK_NEAR(made(&input, MORAY_CONTROL_ORIENTED).amplitude, a, 1e-15, "the first of two that agree");
        input.a = a * (1 + side * 1.1e-6);
        const moray_status status = moray_gait_input_make(&input, &robot, MORAY_CONTROL_ORIENTED, &gait);
        CHECK(status.code == MORAY_INPUT && strstr(status.text, "contradicts theta_max_deg = -15: give one of them"),
              "two that do not: %s", status.text);
    }
    for (int side = -1; side <= 1; side += 2) {
        input = moray_gait_input_default();
        input.alpha = side * 2 * sin(20 * DEG) * 89 * DEG;
        CHECK_NEAR(made(&input, MORAY_CONTROL_ORIENTED).amplitude, side * 0.14 * cos(20 * DEG) * sin(89 * DEG), 1e-12,
                   "link angles of 89 deg");
        input.alpha = side * 2 * sin(20 * DEG) * 91 * DEG;
        const moray_status status = moray_gait_input_make(&input, &robot, MORAY_CONTROL_ORIENTED, &gait);
        CHECK(status.code == MORAY_INPUT && strstr(status.text, "no link-angle amplitude below 90 deg"),
              "but not of 91: %s", status.text);
    }
}

static FILE *start(char path[32])
{
    strcpy(path, "/tmp/gait_XXXXXX");
    const int handle = mkstemp(path);
    return handle >= 0 ? fdopen(handle, "w") : NULL;
}

// What a line leaves open stays as in the line before; an amplitude given in other terms takes its place.
static void test_inheritance(void)
{
    char path[32];
    FILE *file = start(path);
    moray_gait_change *change = NULL;
    int n = 0;
    moray_gait_input first = moray_gait_input_default();
    first.theta_max = 10 * DEG;
    first.taper = 0.3;
    CHECK(file, "a temporary file");
    if (!file)
        return;
    fputs("t_s,delta_deg,a_m,phi0_m\n10,30,,\n20,,0.03,0.004\n30,20,,", file);
    fclose(file);
    CHECK_OK(moray_gait_schedule_read(path, &first, &robot, MORAY_CONTROL_ORIENTED, &change, &n), "a schedule");
    const double theta = 10 * DEG, wanted[4][4] = {{0, 0.14 * cos(20 * DEG) * sin(theta), 40, 0},
                                                   {10, 0.14 * cos(15 * DEG) * sin(theta), 30, 0},
                                                   {20, 0.03, 30, 0.004},
                                                   {30, 0.03, 20, 0.004}};
    CHECK(n == 4, "%d gaits", n);
    for (int i = 0; i < 4 && i < n; i++) {
        CHECK_NEAR(change[i].t, wanted[i][0], 0, "begins");
        CHECK_NEAR(change[i].gait.amplitude, wanted[i][1], 1e-15, "amplitude");
        CHECK_NEAR(change[i].gait.delta / DEG, wanted[i][2], 1e-12, "delta");
        CHECK_NEAR(change[i].gait.offset, wanted[i][3], 0, "offset");
        CHECK_NEAR(change[i].gait.taper, 0.3, 0, "taper");
    }
    free(change);
    remove(path);
}

// A line at 0 is instead of the gait that was to be the first; others come after that.
static void check_first(const char *text, int gaits, const double *t, const double *omega)
{
    char path[32];
    FILE *file = start(path);
    moray_gait_change *change = NULL;
    int n = 0;
    moray_gait_input first = moray_gait_input_default();
    first.omega = 1.5;
    CHECK(file, "a temporary file");
    if (!file)
        return;
    fputs(text, file);
    fclose(file);
    CHECK_OK(moray_gait_schedule_read(path, &first, &robot, MORAY_FIRST_PRINCIPLES, &change, &n), "a schedule");
    CHECK(n == gaits, "%d gaits, expected %d", n, gaits);
    for (int i = 0; i < n && i < gaits; i++) {
        CHECK_NEAR(change[i].t, t[i], 0, "begins");
        CHECK_NEAR(change[i].gait.omega, omega[i] * (omega[i] == 1.5 ? 1 : DEG), 1e-15, "omega");
    }
    free(change);
    remove(path);
}

static void test_first(void)
{
    check_first("t_s,omega_deg_s\n0,100\n4,110\n9,120\n", 3, (double[]){0, 4, 9}, (double[]){100, 110, 120});
    check_first("t_s,omega_deg_s\n0,100\n", 1, (double[]){0}, (double[]){100});
    check_first("omega_deg_s,t_s\n100,4\n", 2, (double[]){0, 4}, (double[]){1.5, 100});
}

int main(void)
{
    robot = moray_robot_paper();
    test_amplitudes();
    test_offsets();
    test_negative();
    test_inheritance();
    test_first();
    return tap_done();
}
