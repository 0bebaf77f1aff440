// SPDX-License-Identifier: MIT
//
// Studies of the joint amplitudes and of the errata: against series in Bessel functions, Fourier coefficients of
// motion simulated here, and the speeds of the independent implementation.
#include "paper_desk.h"
#include "paper/mapping.h"

// ---- Fig. 6 --------------------------------------------------------------------------------------------------------

// With x at the middle of the two sines, sin(theta sin y) = 2 sum_k J_{2k+1}(theta) sin((2k+1) y) makes of (29)
// 4 l sum_k J_{2k+1}(theta) cos((2k+1) delta/2) sin((2k+1) x).
static double series_29(double l, double theta_max, double delta, double x)
{
    double sum = 0;
    for (int k = 0; k < 10; k++)
        sum += jn(2 * k + 1, theta_max) * cos((2 * k + 1) * delta / 2) * sin((2 * k + 1) * x);
    return 4 * l * sum;
}

static void check_distance(double theta_max, double delta)
{
    const double l = 0.07, amplitude = 2 * l * cos(delta / 2);
    double error = 0, largest[2] = {0}, peak = 0;
    for (int k = 0; k <= 20000; k++) {
        const double x = 2 * M_PI * k / 20000, exact = series_29(l, theta_max, delta, x);
        double phi[DISTANCES];
        joint_distance(l, theta_max, delta, x - delta / 2, phi);
        error = tap_worse(error, fabs(phi[DISTANCE_29] - exact));
        error = tap_worse(error, fabs(phi[DISTANCE_30] - theta_max * amplitude * sin(x)));
        error = tap_worse(error, fabs(phi[DISTANCE_31] - sin(theta_max) * amplitude * sin(x)));
        largest[0] = fmax(largest[0], fabs(theta_max * amplitude * sin(x) - exact));
        largest[1] = fmax(largest[1], fabs(sin(theta_max) * amplitude * sin(x) - exact));
        peak = fmax(peak, fabs(exact));
    }
    const distance_errors e = distance_errors_of(l, theta_max, delta);
    CHECK_NEAR(error, 0, 1e-14, "(29), (30), (31) against their series [m]");
    CHECK_NEAR(e.exact_amplitude, peak, 1e-9, "amplitude of (29) [m]");
    CHECK_NEAR(e.curve[DISTANCE_30] / largest[0], 1, 1e-3, "largest error of (30)");
    CHECK_NEAR(e.curve[DISTANCE_31] / largest[1], 1, 1e-3, "largest error of (31)");
    CHECK_NEAR(e.amplitude[DISTANCE_30], theta_max * amplitude - peak, 1e-9, "(30) errs in the amplitude");
    CHECK_NEAR(e.amplitude[DISTANCE_31], sin(theta_max) * amplitude - peak, 1e-9, "(31) errs in the amplitude");
    // theta^3/6 cos(delta/2) (1 - cos^2(delta/2)) against theta^3/6 cos^3(delta/2)
    CHECK((fabs(e.amplitude[DISTANCE_31]) < fabs(e.amplitude[DISTANCE_30])) == (delta < M_PI / 2),
          "(31) is better than (30) just where delta < 90 deg: %g", delta / DEG);
}

// ---- Propositions 1 and 2 ------------------------------------------------------------------------------------------

enum { SAMPLES = 64, SETTLED = 10 };

// Fourier amplitude of joint `joint` in one period of a simulation from rest, SETTLED periods after the start.
static double simulated_amplitude(int N, moray_model model, const moray_gait *gait, int joint)
{
    moray_robot robot = paper_robot_of(N);
    moray_swimmer *swimmer;
    moray_swim_track track;
    double times[SAMPLES], x[64] = {0}, phi[32], v_phi[32], a = 0, b = 0;
    const double period = 2 * M_PI / gait->omega;
    const moray_gait_change change = {0, *gait};
    const moray_sim_settings settings = moray_sim_settings_default();
    for (int k = 0; k < SAMPLES; k++)
        times[k] = period * (SETTLED + (double)k / SAMPLES);
    CHECK_OK(moray_swimmer_new(&swimmer, &robot, model), "a swimmer");
    CHECK_OK(moray_swim_track_new(&track, swimmer, SAMPLES), "a track");
    const moray_swim_plan plan = {.t1 = times[SAMPLES - 1],
                                  .schedule = &change,
                                  .n_changes = 1,
                                  .times = times,
                                  .n_times = SAMPLES,
                                  .observe = moray_swim_track_add,
                                  .observer = &track};
    CHECK_OK(moray_swim_run(swimmer, &settings, &plan, x, NULL), "swims");
    for (int k = 0; k < SAMPLES; k++) {
        moray_swimmer_joints(swimmer, track.x + k * track.n_states, phi, v_phi);
        a += 2 * phi[joint] * cos(gait->omega * times[k]) / SAMPLES;
        b += 2 * phi[joint] * sin(gait->omega * times[k]) / SAMPLES;
    }
    moray_swim_track_free(&track);
    moray_swimmer_free(swimmer);
    return hypot(a, b);
}

static void check_propositions(int N, double theta_max, double delta)
{
    paper_desk desk;
    swum_amplitudes s;
    const moray_robot robot = moray_robot_paper();
    paper_desk_open(&desk, &robot, 0.1, 0.1, 20);
    CHECK_OK(swum_amplitudes_of(&desk.p, N, theta_max * DEG, delta * DEG, &s), "swims");
    moray_gait gait = {.omega = 120 * DEG, .delta = delta * DEG};
    gait.amplitude = 2 * sin(delta * DEG / 2) * theta_max * DEG; // (27)
    CHECK_NEAR(s.joint_angle, gait.amplitude, 1e-4 * gait.amplitude, "Proposition 1, joint angle [rad]");
    CHECK_NEAR(s.joint_angle, simulated_amplitude(N, MORAY_FIRST_PRINCIPLES, &gait, N / 2), 1e-4 * gait.amplitude,
               "joint angle simulated here");
    gait.amplitude = 2 * robot.l * cos(delta * DEG / 2) * sin(theta_max * DEG); // (33)
    CHECK_NEAR(s.joint_coordinate, gait.amplitude, 1e-4 * gait.amplitude, "Proposition 2, joint coordinate [m]");
    CHECK_NEAR(s.joint_coordinate, simulated_amplitude(N, MORAY_CONTROL_ORIENTED, &gait, 0), 1e-4 * gait.amplitude,
               "joint coordinate simulated here");
    // (12) on two neighbouring sines a sin(.) and a sin(. + delta), and on one
    const double inner = 2 * gait.amplitude * cos(delta * DEG / 2) / (4 * robot.l);
    CHECK_NEAR(s.inner_angle, inner, 1e-4 * inner, "(12) inside the body [rad]");
    CHECK_NEAR(s.end_angle, gait.amplitude / (4 * robot.l), 1e-4 * inner, "(12) at the ends [rad]");
    CHECK(s.link_least <= s.link_mean && s.link_mean <= s.link_largest, "least, mean, largest");
    CHECK_NEAR(s.link_mean, theta_max * DEG, 0.025 * theta_max * DEG, "the links swing by theta_max in their mean");
    paper_desk_close(&desk);
}

// ---- Erratum E2 ----------------------------------------------------------------------------------------------------

// Straight motion of Sec. V-B on the control-oriented model: mean v_x of the last five periods of 45 s.
static double straight_speed(paper_reading reading, double theta_max)
{
    const moray_robot robot = moray_robot_paper();
    moray_swimmer *swimmer;
    double x[24] = {0}, half;
    moray_gait_change change = {0, {.omega = 120 * DEG, .delta = 40 * DEG}};
    change.gait.amplitude = 2 * robot.l * cos(20 * DEG) * sin(theta_max * DEG);
    const moray_sim_settings settings = moray_sim_settings_default();
    moray_swim_plan plan = {.t1 = 30, .schedule = &change, .n_changes = 1};
    CHECK_OK(paper_reading_swimmer(&swimmer, &robot, MORAY_CONTROL_ORIENTED, reading), "a swimmer");
    moray_swimmer_set_current(swimmer, 0.1, 0.1);
    CHECK_OK(moray_swim_run(swimmer, &settings, &plan, x, NULL), "30 s");
    half = x[10];
    plan.t0 = 30;
    plan.t1 = 45;
    CHECK_OK(moray_swim_run(swimmer, &settings, &plan, x, NULL), "15 s more");
    moray_swimmer_free(swimmer);
    return (x[10] - half) / 15;
}

static void check_speeds(void)
{
    static const double theta_max[] = {10, 15, 20, 30}, corrected[] = {0.2127, 0.2931, 0.3573, 0.4373};
    static const double literal[] = {0.2304, 0.2718, 0.2933, 0.3124};
    for (int k = 0; k < 4; k++) {
        CHECK_NEAR(straight_speed(PAPER_CORRECTED, theta_max[k]), corrected[k], 0.003 * corrected[k], "L = 2l");
        CHECK_NEAR(straight_speed(PAPER_L_PRINTED, theta_max[k]), literal[k], 0.003 * literal[k], "l as printed");
    }
}

int main(void)
{
    for (int k = 1; k < 8; k++) {
        check_distance(5 * k * DEG, 40 * DEG);
        check_distance(20 * DEG, 20 * k * DEG);
    }
    check_propositions(10, 10, 40);
    check_propositions(10, 30, 40);
    check_propositions(10, 20, 80);
    check_propositions(15, 20, 360. / 14);
    check_speeds();
    return tap_done();
}
