// SPDX-License-Identifier: MIT
//
// Gaits with series by their closed form, links' amplitudes by the wave itself, power by joints or motors, fins, and
// what of a robot is allowed, in the room of the models.
#include <complex.h>
#include <string.h>

#include "random_robot.h"
#include "snake/model/model.h"

enum { JOINTS = 4, HARMONICS = 2, COEFFICIENTS = JOINTS * (1 + 2 * HARMONICS) };

// ---- References ----------------------------------------------------------------------------------------------------

// Joint i of (25) with a series, and its derivatives: as complex exponentials, of which each is a factor.
static double by_hand(const moray_gait *gait, const double *c, int i, double t, int derivative)
{
    const double place = -1 + 2.0 * i / (JOINTS - 1), w = gait->omega;
    double sum = cimag(cpow(I * w, derivative) * gait->amplitude * (1 + gait->taper * place) *
                       cexp(I * (w * t + i * gait->delta)));
    for (int k = 1; k <= HARMONICS && c; k++) {
        const double p = c[JOINTS * (2 * k - 1) + i], q = c[JOINTS * 2 * k + i];
        sum += cimag(cpow(I * (k * w), derivative) * (p + I * q) * cexp(I * (k * w * t)));
    }
    const double mean[] = {gait->offset, gait->offset_rate, gait->offset_acceleration};
    return sum + mean[derivative] + (derivative == 0 && c ? c[i] : 0);
}

static void test_reference(void)
{
    random_seed seed = 4;
    double worst = 0;
    for (int trial = 0; trial < 20; trial++) {
        double c[COEFFICIENTS], at[3][JOINTS];
        random_vector(&seed, 0.4, COEFFICIENTS, c);
        const moray_series series = {JOINTS, HARMONICS, c};
        const moray_gait gait = {.amplitude = tap_random(&seed, 0.1, 0.5),
                                 .omega = tap_random(&seed, 1, 3),
                                 .delta = tap_random(&seed, -1.5, 1.5),
                                 .offset = tap_random(&seed, -0.2, 0.2),
                                 .offset_rate = tap_random(&seed, -0.2, 0.2),
                                 .offset_acceleration = tap_random(&seed, -0.2, 0.2),
                                 .taper = tap_random(&seed, -0.7, 0.7),
                                 .series = trial % 2 ? &series : NULL};
        const double t = tap_random(&seed, -3, 3);
        moray_gait_reference(&gait, JOINTS, t, at[0], at[1], at[2]);
        for (int d = 0; d < 3; d++)
            for (int i = 0; i < JOINTS; i++)
                worst = tap_worse(worst, fabs(at[d][i] - by_hand(&gait, trial % 2 ? c : NULL, i, t, d)));
    }
    CHECK(worst < 1e-12, "angles, rates and accelerations: %.1e", worst);
    const double c[COEFFICIENTS] = {0};
    const moray_series series = {JOINTS, HARMONICS, c};
    const moray_gait bare = {.amplitude = 0.2}, with = {.amplitude = 0.2, .series = &series};
    CHECK_OK(moray_gait_without_series(&bare, "a test"), "no series");
    const moray_status status = moray_gait_without_series(&with, "a test");
    CHECK(status.code == MORAY_INPUT && strcmp(status.text, "gait with a series of 2 harmonics in 4 joints: a test "
                                                            "takes a gait (25) without a series") == 0,
          "%s", status.text);
}

// To the same model a gait goes as it is; to the other and back it is the same, its offset with the amplitude, the
// other way round.
static void test_mapped(void)
{
    const moray_robot robot = moray_robot_paper();
    const double c[9 * 3] = {0};
    const moray_series series = {9, 1, c};
    const moray_gait gait = {.amplitude = 0.3,
                             .omega = 2,
                             .delta = 0.8,
                             .offset = 0.05,
                             .offset_rate = 0.02,
                             .offset_acceleration = -0.01,
                             .taper = 0.2,
                             .series = &series};
    const moray_gait same = moray_gait_map(&robot, &gait, MORAY_FIRST_PRINCIPLES, MORAY_FIRST_PRINCIPLES);
    CHECK(memcmp(&same, &gait, sizeof gait) == 0, "to its own model as it is");
    const moray_gait to = moray_gait_map(&robot, &gait, MORAY_FIRST_PRINCIPLES, MORAY_CONTROL_ORIENTED);
    const double theta = 0.3 / (2 * sin(0.4)), a = 2 * robot.l * cos(0.4) * sin(theta), ratio = -a / 0.3;
    CHECK_NEAR(to.amplitude, a, 1e-15, "amplitude");
    CHECK_NEAR(to.offset, 0.05 * ratio, 1e-15, "offset");
    CHECK_NEAR(to.offset_rate, 0.02 * ratio, 1e-15, "its rate");
    CHECK_NEAR(to.offset_acceleration, -0.01 * ratio, 1e-15, "its acceleration");
    CHECK(to.omega == 2 && to.delta == 0.8 && to.taper == 0.2 && !to.series, "the rest as it was, without a series");
    const moray_gait back = moray_gait_map(&robot, &to, MORAY_CONTROL_ORIENTED, MORAY_FIRST_PRINCIPLES);
    CHECK_NEAR(back.amplitude, 0.3, 1e-14, "and back");
    CHECK_NEAR(back.offset, 0.05, 1e-14, "with its offset");
    const moray_gait none = {.amplitude = 0, .omega = 1, .delta = 0.5, .offset = 0.1};
    CHECK(moray_gait_map(&robot, &none, MORAY_CONTROL_ORIENTED, MORAY_FIRST_PRINCIPLES).offset == 0,
          "of no amplitude there is no ratio");
}

// ---- Power ---------------------------------------------------------------------------------------------------------

static void test_power(void)
{
    moray_robot robot = moray_robot_paper();
    robot.links = 4;
    robot.motor = (moray_motor){
        .fitted = true, .forward = 0.8, .backward = 0.3, .friction = 0.2, .smooth_rate = 0.1, .smooth_power = 0.1};
    const double u[] = {0.5, -1, 2}, v[] = {1, 2, -0.5};
    double by_motors = 0;
    for (int i = 0; i < 3; i++)
        by_motors += moray_motor_power(&robot.motor, u[i], v[i]);
    for (int fitted = 0; fitted < 2; fitted++)
        for (int model = 0; model < 2; model++) {
            moray_swimmer *swimmer;
            robot.motor.fitted = fitted;
            CHECK_OK(moray_swimmer_new(&swimmer, &robot, (moray_model)model), "swimmer");
            const bool motors = fitted && model == MORAY_FIRST_PRINCIPLES;
            CHECK_NEAR(moray_swimmer_power(swimmer, u, v), motors ? by_motors : 0.5 - 2 - 1, 1e-14,
                       "power of joints, or of motors");
            moray_swimmer_free(swimmer);
        }
}

// ---- Robots --------------------------------------------------------------------------------------------------------

// A fin of no coefficients is nowhere; of any one it stays where it is.
static void test_fins(void)
{
    for (int which = 0; which < 4; which++) {
        moray_robot robot = moray_robot_paper();
        moray_link link[3];
        robot.links = 3;
        for (int i = 0; i < 3; i++)
            link[i] = moray_robot_link(&robot, i);
        double *const of[] = {&link[1].fin_c_t, &link[1].fin_c_n, &link[1].fin_mu_n};
        link[1].fin_at = -0.03;
        if (which < 3)
            *of[which] = 0.2;
        moray_robot_from_links(&robot, link);
        CHECK((robot.link == NULL) == (which == 3), "fin %d: unequal or not", which);
        CHECK(which == 3 || fabs(moray_robot_link(&robot, 1).fin_at + 0.03) < 1e-15, "its place");
        CHECK(moray_robot_link(&robot, 0).fin_at == 0, "none on others");
    }
}

static void refused(const moray_robot *robot, const char *text)
{
    const moray_status status = moray_robot_check(robot);
    CHECK(status.code == MORAY_INPUT && strcmp(status.text, text) == 0, "\"%s\", expected \"%s\"", status.text, text);
}

static void test_robots(void)
{
    moray_robot robot = moray_robot_paper();
    for (int links = 2; links <= 4; links++) {
        robot.links = links;
        CHECK_OK(moray_robot_check(&robot), "a robot");
        const moray_status status = moray_robot_check_swims(&robot);
        CHECK(status.code == (links == 2 ? MORAY_NOT_SOLVED : MORAY_OK), "%d links: %s", links, status.text);
    }
    robot.links = MORAY_MOST_LINKS;
    CHECK_OK(moray_robot_check(&robot), "of the most links");
    robot = moray_robot_paper();
    struct {
        const char *name;
        double *of;
        bool may_be_zero;
    } fields[] = {{"l", &robot.l, false},
                  {"m", &robot.m, false},
                  {"J", &robot.J, false},
                  {"c_t", &robot.c_t, true},
                  {"mu_n", &robot.mu_n, true},
                  {"lambda_2", &robot.lambda_2, true},
                  {"rot_gain", &robot.rot_gain, true},
                  {"k_d", &robot.k_d, true}};
    for (size_t k = 0; k < sizeof fields / sizeof *fields; k++) {
        static const double values[] = {0, -0.5, NAN, INFINITY};
        const double kept = *fields[k].of;
        for (int v = 0; v < 4; v++) {
            char text[100];
            *fields[k].of = values[v];
            snprintf(text, sizeof text, "%s = %g: must be finite and %s 0", fields[k].name, values[v],
                     fields[k].may_be_zero ? "at least" : "above");
            if (v == 0 && fields[k].may_be_zero)
                CHECK_OK(moray_robot_check(&robot), fields[k].name);
            else
                refused(&robot, text);
        }
        *fields[k].of = kept;
    }
}

static void test_hydrodynamics(void)
{
    moray_robot robot = moray_robot_paper();
    robot.hydro = (moray_hydrodynamics){MORAY_ROTATION_STRIP, .drag = MORAY_DRAG_BOTH};
    robot.hydro.added_mass = MORAY_ADDED_MASS_INVARIANT;
    robot.hydro.frame = MORAY_FRAME_INVARIANT;
    robot.hydro.pieces = 1;
    CHECK_OK(moray_robot_check(&robot), "the last of every choice");
    robot.hydro.pieces = 2;
    refused(&robot, "pieces = 2: with rotation = strip a link is not cut");
    robot.hydro.rotation = MORAY_ROTATION_PAPER;
    robot.hydro.pieces = 1000;
    CHECK_OK(moray_robot_check(&robot), "as many pieces as there may be");
    robot.hydro.pieces = 1001;
    refused(&robot, "pieces = 1001: must be within 0:1000");
    robot.hydro.pieces = -1;
    refused(&robot, "pieces = -1: must be within 0:1000");
    robot.hydro.pieces = 0;
    robot.hydro.drag = (moray_drag)(MORAY_DRAG_BOTH + 1);
    refused(&robot, "drag = 3: must be within 0:2");
}

int main(void)
{
    test_reference();
    test_mapped();
    test_power();
    test_fins();
    test_robots();
    test_hydrodynamics();
    return tap_done();
}
