// SPDX-License-Identifier: MIT
#include "degree.h"
#include "tap.h"

#include <string.h>

#include <complex.h>

#include "moray/snake/model.h"

static void test_printed_coefficients(void)
{
    const moray_robot robot = moray_robot_paper();
    CHECK_NEAR(robot.m, 0.6597, 5e-5, "m as printed in Sec. V-A");
    CHECK_NEAR(robot.c_n, 8.4, 1e-12, "c_n");
    CHECK_NEAR(robot.c_t, 0.2639, 5e-5, "c_t");
    CHECK_NEAR(robot.mu_n, 0.3958, 5e-5, "mu_n");
    CHECK_NEAR(robot.lambda_1, 2.2988e-7, 5e-12, "lambda_1");
    CHECK_NEAR(robot.lambda_2, 4.3103e-4, 5e-9, "lambda_2");
    CHECK_NEAR(robot.lambda_3, 2.2629e-5, 5e-10, "lambda_3");
    CHECK_OK(moray_robot_check(&robot), "the paper's robot is accepted");
}

static void test_bad_robots(void)
{
    moray_robot robot = moray_robot_paper();
    robot.links = 1;
    moray_status status = moray_robot_check(&robot);
    CHECK(status.code == MORAY_INPUT && strstr(status.text, "links = 1"), "N = 1: %s", status.text);
    robot.links = MORAY_MOST_LINKS + 1; // for which a few arrays of fixed size are made
    status = moray_robot_check(&robot);
    CHECK(status.code == MORAY_INPUT && strstr(status.text, "links = 1001"), "too many: %s", status.text);
    robot = moray_robot_paper();
    robot.m = -1;
    status = moray_robot_check(&robot);
    CHECK(status.code == MORAY_INPUT && strstr(status.text, "m = -1"), "negative mass: %s", status.text);
    robot = moray_robot_paper();
    robot.c_n = NAN;
    status = moray_robot_check(&robot);
    CHECK(status.code == MORAY_INPUT && strstr(status.text, "c_n"), "NaN drag: %s", status.text);
}

static void test_amplitude_table(void)
{
    // an independent implementation
    const double theta_deg[] = {10, 15, 20, 30}, alpha_deg[] = {6.840, 10.261, 13.681, 20.521};
    const double a_cm[] = {2.284, 3.405, 4.500, 6.578};
    const moray_robot robot = moray_robot_paper();
    for (int i = 0; i < 4; i++) {
        const double theta = theta_deg[i] * DEG, delta = 40 * DEG;
        const double alpha = moray_amplitude_from_theta_max(&robot, MORAY_FIRST_PRINCIPLES, theta, delta);
        const double a = moray_amplitude_from_theta_max(&robot, MORAY_CONTROL_ORIENTED, theta, delta);
        CHECK_NEAR(alpha / DEG, alpha_deg[i], 6e-4, "(27) alpha in deg");
        CHECK_NEAR(a * 100, a_cm[i], 6e-4, "(33) a in cm");
        CHECK_NEAR(moray_theta_max_from_amplitude(&robot, MORAY_FIRST_PRINCIPLES, alpha, delta), theta, 1e-14,
                   "(27) back");
        CHECK_NEAR(moray_theta_max_from_amplitude(&robot, MORAY_CONTROL_ORIENTED, a, delta), theta, 1e-14, "(33) back");
    }
}

static void test_gait(void)
{
    const moray_gait gait = {.amplitude = 0.04, .omega = 2, .delta = 0.7, .offset = 0.01};
    enum { n = 5 };
    double phi[n], dphi[n], ddphi[n], later[n], earlier[n], unused[n];
    const double t = 0.3, h = 1e-4;
    moray_gait_reference(&gait, n, t, phi, dphi, ddphi);
    moray_gait_reference(&gait, n, t + h, later, unused, unused);
    moray_gait_reference(&gait, n, t - h, earlier, unused, unused);
    for (int i = 0; i < n; i++) {
        CHECK_NEAR(phi[i], 0.04 * sin(0.6 + 0.7 * i) + 0.01, 1e-15, "(25)");
        CHECK_NEAR(dphi[i], (later[i] - earlier[i]) / (2 * h), 1e-9, "first derivative of (25)");
        CHECK_NEAR(ddphi[i], (later[i] - 2 * phi[i] + earlier[i]) / (h * h), 1e-7, "second derivative of (25)");
    }
    const moray_robot robot = moray_robot_paper();
    const moray_gait there = moray_gait_map(&robot, &gait, MORAY_CONTROL_ORIENTED, MORAY_FIRST_PRINCIPLES);
    const moray_gait back = moray_gait_map(&robot, &there, MORAY_FIRST_PRINCIPLES, MORAY_CONTROL_ORIENTED);
    CHECK(there.offset < 0, "the offset changes sign between the models (E3): %g", there.offset);
    CHECK_NEAR(there.offset / there.amplitude, -gait.offset / gait.amplitude, 1e-15, "offset in the amplitude's ratio");
    CHECK_NEAR(back.amplitude, gait.amplitude, 1e-15, "mapping and back, amplitude");
    CHECK_NEAR(back.offset, gait.offset, 1e-15, "mapping and back, offset");
}

// A gait whose offset is phi_0(t) = 0.01 + 0.02 t - 0.03 t^2, at t.
static moray_gait steered_at(double t)
{
    return (moray_gait){.amplitude = 0.04,
                        .omega = 2,
                        .delta = 0.7,
                        .offset = 0.01 + 0.02 * t - 0.03 * t * t,
                        .offset_rate = 0.02 - 0.06 * t,
                        .offset_acceleration = -0.06};
}

static void test_moving_offset(void)
{
    enum { n = 5 };
    double phi[n], dphi[n], ddphi[n], later[n], earlier[n], unused[n], fast[n], slow[n];
    const double t = 0.3, h = 1e-4;
    const moray_gait now = steered_at(t), ahead = steered_at(t + h), behind = steered_at(t - h);
    moray_gait_reference(&now, n, t, phi, dphi, ddphi);
    moray_gait_reference(&ahead, n, t + h, later, fast, unused);
    moray_gait_reference(&behind, n, t - h, earlier, slow, unused);
    for (int i = 0; i < n; i++) {
        CHECK_NEAR(dphi[i], (later[i] - earlier[i]) / (2 * h), 1e-9, "first derivative with a moving offset");
        CHECK_NEAR(ddphi[i], (fast[i] - slow[i]) / (2 * h), 1e-8, "second derivative with a moving offset");
    }
    const moray_robot robot = moray_robot_paper();
    const moray_gait there = moray_gait_map(&robot, &now, MORAY_CONTROL_ORIENTED, MORAY_FIRST_PRINCIPLES);
    CHECK_NEAR(there.offset_rate / there.offset, now.offset_rate / now.offset, 1e-15, "the rate is mapped alike");
    CHECK_NEAR(there.offset_acceleration / there.offset, now.offset_acceleration / now.offset, 1e-13,
               "and the acceleration");
}

// The joints of a tapered wave as phasors of sin(omega t).
static double complex joint_phasor(const moray_gait *gait, int n, int i)
{
    double phi[16], quarter[16], unused[16];
    moray_gait_reference(gait, n, 0, phi, unused, unused);
    moray_gait_reference(gait, n, M_PI / 2 / gait->omega, quarter, unused, unused);
    return quarter[i] + I * phi[i];
}

// What moray/snake.h says of the link angles of a tapered gait: for the revolute joints (1) is solved for angles whose
// amplitudes in the travelling frame are linear along the body, for the prismatic ones (12) is evaluated.
// Phasors of links whose differences (sign 1) or sums (-1) of neighbours are the joints', of all those the wave: of
// phase delta from link to link, of amplitude linear in it.
static void links_of(int N, const double complex *joint, int sign, double delta, double complex *link)
{
    const double complex back = sign * cexp(-I * delta);
    double flip = 1;
    link[0] = 0;
    for (int i = 0; i < N - 1; i++, flip *= sign)
        link[i + 1] = link[i] - flip * joint[i]; // sign^i times the link's
    const double complex common = -(link[0] - 2 * link[1] * back + link[2] * back * back) / ((1 - back) * (1 - back));
    for (int i = 0; i < N; i++) // without second difference
        link[i] += common;
}

static void test_taper(void)
{
    enum { N = 9, n = N - 1 };
    const double tau = -0.4, delta = 0.7;
    const moray_gait gait = {.amplitude = 0.04, .omega = 2, .delta = delta, .taper = tau};
    double complex joint[n], link[N], both[N];
    for (int i = 0; i < n; i++)
        joint[i] = joint_phasor(&gait, n, i);
    links_of(N, joint, 1, delta, link);  // theta_i - theta_{i+1} = phi_i
    links_of(N, joint, -1, delta, both); // l sin theta_i + l sin theta_{i+1} = phi_i
    CHECK_NEAR(cabs(joint[0]), 0.04 * 1.4, 1e-15, "first joint");
    CHECK_NEAR(cabs(joint[n - 1]), 0.04 * 0.6, 1e-15, "last joint");
    moray_robot robot = moray_robot_paper();
    robot.links = N;
    for (int i = 0; i < N; i++) {
        CHECK_NEAR(moray_theta_max_of_link(&robot, MORAY_FIRST_PRINCIPLES, &gait, i + 1), cabs(link[i]), 1e-14,
                   "link angle of revolute joints");
        CHECK_NEAR(sin(moray_theta_max_of_link(&robot, MORAY_CONTROL_ORIENTED, &gait, i + 1)), cabs(both[i]) / robot.l,
                   1e-14, "link angle of prismatic joints");
    }
    CHECK_NEAR(cabs(joint_phasor(&gait, 1, 0)), 0.04, 1e-17, "a single joint is the middle of its body");
    CHECK_NEAR(moray_gait_map(&robot, &gait, MORAY_CONTROL_ORIENTED, MORAY_FIRST_PRINCIPLES).taper, tau, 0,
               "the taper is the same in both models");
}

int main(void)
{
    test_printed_coefficients();
    test_bad_robots();
    test_amplitude_table();
    test_gait();
    test_moving_offset();
    test_taper();
    return tap_done();
}
