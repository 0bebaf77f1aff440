// SPDX-License-Identifier: MIT
//
// The fastest turn: derivatives, ends, and a turn on the averaged plant against bounds by hand.
#include "degree.h"
#include "tap.h"

#include <string.h>

#include "moray/snake/trial.h"
#include "moray/snake/turn.h"
#include "snake/steer/problems.h"

static moray_turn_spec spec_of(moray_model model, bool averaged, int links)
{
    const bool control = model == MORAY_CONTROL_ORIENTED;
    moray_turn_spec spec = {.robot = moray_robot_paper(),
                            .model = model,
                            .averaged = averaged,
                            .current = {0.05, 0.1},
                            .limits = {.theta_max = moray_between(1 * DEG, 20 * DEG),
                                       .omega = moray_fixed(120 * DEG),
                                       .delta = moray_fixed(40 * DEG),
                                       .offset = control ? 0.015 : 4.5 * DEG,
                                       .offset_rate = control ? 0.01 : 3 * DEG,
                                       .offset_acceleration = MORAY_INFINITY,
                                       .power = MORAY_INFINITY},
                            .heading = 90 * DEG,
                            .steering = 1e-3,
                            .shortest = 1,
                            .longest = 60,
                            .undulation = {0.01, -0.03}};
    spec.robot.links = links;
    return spec;
}

static void test_derivatives(moray_model model, bool averaged, int links)
{
    moray_turn_spec spec = spec_of(model, averaged, links);
    moray_steering_problem problem;
    moray_ocp_derivative_report report;
    CHECK_OK(moray_turn_new(&problem, &spec), "problem");
    CHECK_OK(moray_ocp_check_derivatives(moray_steering_ocp(problem.steering), &report), "check");
    CHECK(report.jacobian_error < 1e-8 && report.hessian_error < 1e-5, "%d links, model %d: %s (%.1e); %s (%.1e)",
          links, model, report.jacobian, report.jacobian_error, report.hessian, report.hessian_error);
    moray_steering_problem_free(&problem);
}

static void test_refusals(void)
{
    const moray_turn_spec good = spec_of(MORAY_CONTROL_ORIENTED, false, 5);
    moray_turn_spec bad[4] = {good, good, good, good};
    const char *const words[] = {"heading", "offset", "steering", "time of the turn"};
    bad[0].heading = NAN;
    bad[1].limits.offset = MORAY_INFINITY;
    bad[2].steering = -1;
    bad[3].longest = 1;
    for (int k = 0; k < 4; k++) {
        moray_steering_problem problem;
        const moray_status status = moray_turn_new(&problem, &bad[k]);
        CHECK(status.code == MORAY_INPUT && strstr(status.text, words[k]), "%s", status.text);
        CHECK(!problem.steering && !problem.task, "nothing is left");
    }
}

// Without an iteration a plan is its guess: it turns to the side that is asked, all the way, to either side in the time
// of a steady turn, a way to the full offset and one back, and a second more.
static void test_guess(void)
{
    moray_settings settings = moray_settings_default();
    settings.max_iterations = 0;
    for (int side = -1; side <= 1; side += 2) {
        moray_turn_spec spec = spec_of(MORAY_CONTROL_ORIENTED, true, 10);
        const moray_gait gait = moray_gait_paper(&spec.robot);
        moray_steering_plan plan;
        double t0, t1, x[MORAY_STEERING_STATES];
        spec.heading *= side;
        CHECK_OK(moray_turn_plan_make(&plan, &spec, &settings, &gait, 0.1, NULL, 1), "a guess");
        moray_solution_times(plan.solution, 0, &t0, &t1);
        moray_solution_at(plan.solution, 0, t1, x, NULL);
        CHECK_NEAR(x[MORAY_STATE_THETA], spec.heading, 1 * DEG, "where it turns to");
        const double ramp = spec.limits.offset / spec.limits.offset_rate;
        CHECK_NEAR(t1 - t0, fabs(spec.heading) / 0.1 + 2 * ramp + 1, 1e-9, "in the time that this takes [s]");
        moray_steering_plan_free(&plan);
    }
}

// Turns one way and the other on the averaged plant: mirror images in still water, no faster than the offset can be
// brought to its limit and the robot then turn steadily, at the end as it should be.
static void test_turn(void)
{
    moray_settings settings = moray_settings_default();
    double took[2], rate, t0, x[MORAY_STEERING_STATES], u[1];
    settings.scheme = "radau3";
    settings.intervals = 30;
    settings.tolerance = 1e-7;
    for (int side = 0; side < 2; side++) {
        moray_turn_spec spec = spec_of(MORAY_CONTROL_ORIENTED, true, 10);
        moray_steering_plan plan;
        moray_gait gait = moray_gait_paper(&spec.robot), turning = gait;
        spec.current[0] = spec.current[1] = 0;
        spec.heading *= side ? -1 : 1;
        spec.limits.theta_max = moray_fixed(20 * DEG);
        turning.offset = spec.limits.offset;
        CHECK_OK(moray_turn_rate(&spec.robot, spec.model, &turning, &rate), "sustained turning");
        CHECK_OK(moray_turn_plan_make(&plan, &spec, &settings, &gait, rate, NULL, 1), "plan");
        CHECK(moray_solution_info(plan.solution)->outcome == MORAY_NLP_SOLVED, "solved");
        moray_solution_times(plan.solution, 0, &t0, &took[side]);
        moray_solution_at(plan.solution, 0, took[side], x, u);
        CHECK_NEAR(x[0], spec.heading, 1e-7, "heading at the end");
        CHECK_NEAR(x[3], 0, 1e-7, "turning at the end");
        CHECK_NEAR(x[MORAY_STATE_PHI_0], 0, 1e-7, "offset at the end");
        moray_steering_plan_free(&plan);
    }
    CHECK_RELATIVE(took[0], took[1], 1e-4, "as long to the right as to the left");
    const double steady = 90 * DEG / fabs(rate);
    CHECK(took[0] > 0.9 * steady && took[0] < steady + 2 * 1.5 + 2, "%.2f s, of which %.2f s steady", took[0], steady);
}

// Half a degree: no longer than it takes to bring the offset up and back, on a plant where no floor under the time is
// needed.
static void test_small_turn(void)
{
    moray_settings settings = moray_settings_default();
    moray_turn_spec spec = spec_of(MORAY_CONTROL_ORIENTED, true, 10);
    moray_gait gait = moray_gait_paper(&spec.robot);
    moray_steering_plan plan;
    double rate, t0, took;
    spec.limits.theta_max = moray_fixed(20 * DEG);
    spec.heading = 0.5 * DEG;
    settings.scheme = "radau3";
    settings.intervals = 30;
    gait.offset = spec.limits.offset;
    CHECK_OK(moray_turn_rate(&spec.robot, spec.model, &gait, &rate), "turn rate");
    gait.offset = 0;
    CHECK_OK(moray_turn_plan_make(&plan, &spec, &settings, &gait, rate, NULL, 1), "plan");
    CHECK(moray_solution_info(plan.solution)->outcome == MORAY_NLP_SOLVED, "solved");
    moray_solution_times(plan.solution, 0, &t0, &took);
    const double outline = spec.heading / fabs(rate) + 2 * spec.limits.offset / spec.limits.offset_rate + 1;
    CHECK(took < 0.45 * outline, "half a degree in %.3g s, where an outline of full offset takes %.3g s", took,
          outline);
    moray_steering_plan_free(&plan);
}

// Ends beside the start, nearer than the robot's circle is wide, in a current: three arcs lead there. Ends where the
// shortest outline misleads: it takes less time than the robot can.
static void test_poses(void)
{
    static const struct {
        double end[2], heading, current[2]; // [m], [deg], [m/s]
    } poses[] = {{{5, 0}, 0, {0.1, -0.1}},   {{0, 2}, 180, {0.05, 0.1}}, {{0, 0.5}, -180, {0.05, 0.1}},
                 {{-1, 0}, 0, {0.05, 0.1}},  {{3, 1}, 90, {0.05, 0.1}},  {{1, 0}, -90, {0.05, 0.1}},
                 {{2, -2}, 30, {0.05, 0.1}}, {{5, 0}, 30, {0.05, 0.1}}};
    for (int k = 0; k < (int)(sizeof poses / sizeof *poses); k++) {
        moray_turn_spec spec = spec_of(MORAY_CONTROL_ORIENTED, true, 10);
        moray_gait gait = moray_gait_paper(&spec.robot);
        moray_settings settings = moray_settings_default();
        moray_steering_plan plan;
        double rate, t0, t1, x[MORAY_STEERING_STATES];
        spec.limits.theta_max = moray_fixed(20 * DEG);
        spec.heading = poses[k].heading * DEG;
        memcpy(spec.current, poses[k].current, sizeof spec.current);
        spec.to_position = true;
        memcpy(spec.position, poses[k].end, sizeof spec.position);
        settings.scheme = "radau3";
        settings.intervals = 30;
        gait.offset = spec.limits.offset;
        CHECK_OK(moray_turn_rate(&spec.robot, spec.model, &gait, &rate), "turn rate");
        gait.offset = 0;
        CHECK_OK(moray_turn_plan_make(&plan, &spec, &settings, &gait, rate, NULL, 1), "plan");
        moray_solution_times(plan.solution, 0, &t0, &t1);
        moray_solution_at(plan.solution, 0, t1, x, NULL);
        CHECK(moray_solution_info(plan.solution)->outcome == MORAY_NLP_SOLVED &&
                  hypot(x[MORAY_STATE_P_X] - poses[k].end[0], x[MORAY_STATE_P_Y] - poses[k].end[1]) < 1e-6,
              "(%g, %g) m and %g deg in %.3g s", poses[k].end[0], poses[k].end[1], poses[k].heading, t1);
        moray_steering_plan_free(&plan);
    }
}

int main(void)
{
    for (int links = 3; links <= 10; links += 7) {
        test_derivatives(MORAY_CONTROL_ORIENTED, false, links);
        test_derivatives(MORAY_CONTROL_ORIENTED, true, links);
        test_derivatives(MORAY_FIRST_PRINCIPLES, false, links);
    }
    test_refusals();
    test_guess();
    test_turn();
    test_small_turn();
    test_poses();
    return tap_done();
}
