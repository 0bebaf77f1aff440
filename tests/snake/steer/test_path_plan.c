// SPDX-License-Identifier: MIT
//
// The problem of following a path, plans that do, and guidance towards one.
#include "degree.h"
#include "tap.h"

#include <string.h>

#include "moray/snake/trial.h"
#include "moray/snake/path.h"
#include "moray/snake/closed_loop.h"
#include "snake/steer/problems.h"

// ---- The problem ---------------------------------------------------------------------------------------------------

static moray_path_spec spec_of(const moray_path *path, int links)
{
    moray_path_spec spec = {.robot = moray_robot_paper(),
                            .current = {0.05, 0.1},
                            .limits = {.theta_max = moray_between(1 * DEG, 20 * DEG),
                                       .omega = moray_fixed(120 * DEG),
                                       .delta = moray_fixed(40 * DEG),
                                       .offset = 0.015,
                                       .offset_rate = 0.01,
                                       .offset_acceleration = MORAY_INFINITY,
                                       .power = MORAY_INFINITY},
                            .weight = {1, 0.01, 0.01},
                            .path = path,
                            .tube = MORAY_INFINITY,
                            .reach = 2,
                            .start = {0.1, -0.1, 0.4},
                            .speed = 0.25};
    spec.robot.links = links;
    return spec;
}

static void test_derivatives(moray_model model, bool averaged, int links, double duration, double tube)
{
    moray_path path;
    moray_steering_problem problem;
    moray_ocp_derivative_report report;
    CHECK_OK(moray_path_read(&path, "0,0 2,0 2,4 6,4", 1.9), "a path");
    moray_path_spec spec = spec_of(&path, links);
    spec.model = model;
    spec.averaged = averaged;
    spec.duration = duration;
    spec.tube = tube;
    if (model == MORAY_FIRST_PRINCIPLES) {
        spec.limits.offset = 5 * DEG;
        spec.limits.offset_rate = 3 * DEG;
    }
    CHECK_OK(moray_path_problem_new(&problem, &spec), "problem");
    CHECK_OK(moray_ocp_check_derivatives(moray_steering_ocp(problem.steering), &report), "check");
    CHECK(report.jacobian_error < 1e-7 && report.hessian_error < 1e-5, "%d links, model %d: %s (%.1e); %s (%.1e)",
          links, model, report.jacobian, report.jacobian_error, report.hessian, report.hessian_error);
    moray_steering_problem_free(&problem);
    moray_path_free(&path);
}

// Line of sight without a plan: towards what lies a lookahead on, and against the current by the integral of what is
// off.
static void test_line_of_sight(void)
{
    moray_path path;
    CHECK_OK(moray_path_read(&path, "0,0 10,0", 0.5), "a straight path");
    moray_guidance guidance = {
        .path = &path, .lookahead = 2, .ahead = 0.5, .gain = 0.1, .period = 0.25, .along = 1, .integral = 3};
    moray_swim_sample sample = {.pose = {.p_x = 4, .p_y = 0.7}};
    double target = moray_guidance_target(&sample, &guidance);
    CHECK_NEAR(target, -atan(1.0 / 2), 1e-12, "0.7 m off and 0.1 of 3 m");
    CHECK_NEAR(guidance.along, 4, 1e-9, "where it is on the path");
    CHECK_NEAR(guidance.integral, 3 + 0.25 * 2 * 0.7 / (1 + 4), 1e-12, "and what is summed up");
    sample.pose.p_y = -0.7;
    guidance.integral = 0;
    target = moray_guidance_target(&sample, &guidance);
    CHECK_NEAR(target, atan(0.7 / 2), 1e-12, "from the other side");
    moray_path_seeker seeker = {&path, 9};
    CHECK(moray_path_seek(&(moray_swim_sample){.pose = {.p_x = 9.5}}, &seeker), "before the end");
    CHECK(!moray_path_seek(&(moray_swim_sample){.pose = {.p_x = 10.1}}, &seeker), "behind it");
    moray_path_free(&path);
}

static void test_refusals(void)
{
    moray_path path;
    moray_steering_problem problem;
    CHECK_OK(moray_path_read(&path, "0,0 3,0", 1), "a path");
    moray_path_spec good = spec_of(&path, 5), bad[5] = {good, good, good, good, good};
    bad[0].tube = 0;
    bad[1].reach = 0;
    bad[2].limits.offset = MORAY_INFINITY;
    bad[3].along = 3;
    bad[4].speed = 0;
    const char *const words[] = {"tube_m", "reach_m", "offset", "nothing to follow", "speed along"};
    for (int k = 0; k < 5; k++) {
        const moray_status status = moray_path_problem_new(&problem, &bad[k]);
        CHECK(status.code == MORAY_INPUT && strstr(status.text, words[k]), "%s", status.text);
        CHECK(!problem.steering && !problem.task, "nothing is left");
    }
    moray_path_free(&path);
}

// ---- Plans ---------------------------------------------------------------------------------------------------------

static const moray_gait *paper_gait(const moray_robot *robot)
{
    static moray_gait gait;
    gait = moray_gait_paper(robot);
    return &gait;
}

// A straight leg in a cross current, on the averaged plant, from beside it: comes to it, holds the crab angle, takes
// the time of the triangle of velocities.
static void test_crab(void)
{
    const double position[2] = {0, 0.5}, end[2] = {1e-3, 1e-3};
    moray_path path;
    moray_steering_plan plan;
    moray_settings settings = moray_settings_default();
    CHECK_OK(moray_path_read(&path, "0,0 12,0", 1), "a leg");
    moray_path_spec spec = spec_of(&path, 10);
    spec.averaged = true;
    const double *V = spec.current;
    const moray_gait *gait = paper_gait(&spec.robot);
    spec.limits.theta_max =
        moray_fixed(moray_theta_max_from_amplitude(&spec.robot, MORAY_CONTROL_ORIENTED, gait->amplitude, gait->delta));
    spec.limits.omega = moray_fixed(gait->omega);
    spec.limits.delta = moray_fixed(gait->delta);
    settings.scheme = "radau3";
    settings.intervals = 40;
    settings.tolerance = 1e-7;
    CHECK_OK(moray_path_plan_make(&plan, &spec, &settings, gait, position, 0, NULL), "plan");
    CHECK(moray_solution_info(plan.solution)->outcome == MORAY_NLP_SOLVED, "solved");
    double t0, tf, x[MORAY_STEERING_STATES], u[2], along = 8, across;
    moray_solution_times(plan.solution, 0, &t0, &tf);
    for (double t = 0.6 * tf; t < 0.9 * tf; t += 0.1 * tf) {
        moray_solution_at(plan.solution, 0, t, x, u);
        CHECK_NEAR(x[2], 0, 5e-3, "on the leg");
        CHECK_NEAR(x[0], -asin(V[1] / plan.straight.speed), 5e-3, "crabbing");
        moray_path_project(&path, x[1], x[2], &along, &across);
        CHECK_NEAR(u[1], along, 1e-3, "its last control is the distance along the path");
    }
    moray_solution_at(plan.solution, 0, tf, x, u);
    CHECK_NEAR(x[1], 12, end[0], "to the end");
    CHECK_NEAR(x[2], 0, end[1], "of the leg");
    const double closed = moray_path_duration(&path, 0, plan.straight.speed, V);
    CHECK(tf > 0.99 * closed && tf < 1.1 * closed, "%.2f s, of the triangle %.2f s", tf, closed);
    moray_steering_plan_free(&plan);
    const double strong[2] = {0, 0.4};
    memcpy(spec.current, strong, sizeof strong);
    const moray_status status = moray_path_plan_make(&plan, &spec, &settings, gait, position, 0, NULL);
    CHECK(status.code == MORAY_NOT_SOLVED && strstr(status.text, "leg 1"), "%s", status.text);
    moray_path_free(&path);
}

// A plan of given length goes on along the path from where it is, and starts at the time it is made.
static void test_replanning(void)
{
    const double t = 5, horizon = 12;
    moray_path path;
    moray_straight_motion straight;
    moray_settings settings = moray_settings_default();
    moray_solution *solution = NULL;
    const moray_ocp *ocp;
    void *problem = NULL;
    CHECK_OK(moray_path_read(&path, "0,0 12,0", 1), "a leg");
    moray_path_replanner replanner = {.spec = spec_of(&path, 10), .horizon = horizon};
    const moray_gait *gait = paper_gait(&replanner.spec.robot);
    replanner.spec.averaged = true;
    replanner.spec.current[0] = replanner.spec.current[1] = 0;
    replanner.spec.limits.theta_max = moray_fixed(20 * DEG);
    replanner.spec.limits.delta = moray_fixed(gait->delta);
    CHECK_OK(moray_straight_motion_find(&straight, &replanner.spec.robot, MORAY_CONTROL_ORIENTED, gait), "straight");
    replanner.spec.speed = straight.speed;
    const double state[MORAY_STEERING_STATES] = {0, 3, 0, 0, straight.speed};
    const moray_replanner plans = moray_path_replan(&replanner);
    CHECK_OK(plans.make(plans.self, t, state, &problem, &ocp), "made");
    CHECK_NEAR(replanner.spec.along, 3, 1e-9, "where on the path it is");
    settings.scheme = "radau3";
    settings.intervals = 8;
    CHECK_OK(moray_solve(ocp, &settings, NULL, &solution), "solve");
    double t0, tf, x[MORAY_STEERING_STATES], u[2];
    moray_solution_times(solution, 0, &t0, &tf);
    moray_solution_at(solution, 0, tf, x, u);
    CHECK(t0 == t && tf == t + horizon, "from %g s to %g s", t0, tf);
    CHECK_NEAR(x[1], 3 + straight.speed * horizon, 0.02, "as far as it swims");
    CHECK_NEAR(x[2], 0, 1e-6, "on the leg");
    moray_solution_free(solution);
    plans.free(problem);
    moray_path_free(&path);
}

// ---- Scores --------------------------------------------------------------------------------------------------------

// Beside a leg of 10 m at 0.25 m/s, a sample a second: 0.3 m off on the first 2 m, 0.1 m thereafter.
static void test_score(void)
{
    enum { n = 60 };
    double t[n], energy[n];
    moray_pose pose[n] = {{0}};
    const moray_swim_closed_loop closed_loop = {.track = {.n = n, .t = t, .energy = energy, .pose = pose}};
    moray_path path;
    CHECK_OK(moray_path_read(&path, "0,0 10,0", 1), "a leg");
    for (int k = 0; k < n; k++) {
        t[k] = k;
        energy[k] = 0.2 * k;
        pose[k].p_x = 0.25 * k - 0.1;
        pose[k].p_y = k < 8 ? 0.3 : -0.1;
    }
    const moray_path_score score = moray_swim_closed_loop_path_score(&closed_loop, &path, 2);
    CHECK_NEAR(score.time, 10.1 / 0.25, 1e-12, "past the end, between two samples");
    CHECK_NEAR(score.power, 0.2, 1e-14, "power");
    CHECK_NEAR(score.settled_rms, 0.1, 1e-14, "settled");
    CHECK_NEAR(score.settled_largest, 0.1, 1e-14, "at most");
    CHECK_NEAR(score.rms, sqrt((8 * 0.09 + 34 * 0.01) / 42), 1e-14, "all the way");
    moray_path_seeker seeker = {&path, 0};
    for (int k = 0; k < 42; k++) {
        const moray_swim_sample sample = {.t = t[k], .pose = pose[k]};
        const bool on = moray_path_seek(&sample, &seeker);
        if (on != (k < 41))
            CHECK(false, "sample %d: %s", k, on ? "goes on" : "ends");
    }
    CHECK_NEAR(seeker.along, 0.25 * 41 - 0.1, 1e-9, "where it was last");
    const moray_path_score short_of = moray_swim_closed_loop_path_score(
        &(moray_swim_closed_loop){.track = {.n = 30, .t = t, .energy = energy, .pose = pose}}, &path, 2);
    CHECK(isnan(short_of.time), "no time where the end is not reached");
    moray_path_free(&path);
}

// The last sample's time, as a multiple of the interval, may come out beyond the end by rounding.
static void test_last_sample(void)
{
    const moray_robot robot = moray_robot_paper();
    moray_straight_motion straight;
    moray_swim_closed_loop closed_loop;
    int n = 3;
    const double duration = 0.295627;
    while (n < 5000 && !(duration * n / n > duration))
        n++;
    CHECK(n < 5000, "%d intervals of %.6g s come out longer", n, duration);
    CHECK_OK(moray_straight_motion_find(&straight, &robot, MORAY_CONTROL_ORIENTED, paper_gait(&robot)), "straight");
    const moray_swim_closed_loop_spec plan = {
        .robot = &robot, .straight = &straight, .duration = duration, .intervals = n, .tolerance = 1e-6};
    CHECK_OK(moray_swim_closed_loop_run(&closed_loop, &plan), "a closed_loop of so many");
    moray_swim_closed_loop_free(&closed_loop);
}

// ---- Guidance ------------------------------------------------------------------------------------------------------

// A point that moves on the heading it is given at constant speed in a current: without integral action it stays off by
// lookahead times the tangent of the crab angle, with it it comes to the path.
static double drift(double gain, double lookahead)
{
    moray_path path;
    const double speed = 0.25, current = 0.1, period = 0.1;
    if (moray_failed(moray_path_read(&path, "0,0 100,0", 1)))
        return NAN;
    moray_guidance guidance = {.path = &path, .lookahead = lookahead, .gain = gain, .period = period};
    moray_swim_sample sample = {.pose = {.p_y = 1}};
    for (int k = 0; k < 6000; k++) {
        const double heading = moray_guidance_target(&sample, &guidance);
        sample.t += period;
        sample.pose.p_x += period * speed * cos(heading);
        sample.pose.p_y += period * (speed * sin(heading) + current);
    }
    moray_path_free(&path);
    return sample.pose.p_y;
}

static void test_guidance(void)
{
    CHECK_NEAR(drift(0, 1.4), 1.4 * tan(asin(0.1 / 0.25)), 1e-6, "line of sight stays off by this");
    CHECK_NEAR(drift(0.1, 1.4), 0, 1e-6, "integral action takes it away");
}

int main(void)
{
    for (int links = 3; links <= 10; links += 7) {
        test_derivatives(MORAY_CONTROL_ORIENTED, false, links, 0, 0.3);
        test_derivatives(MORAY_CONTROL_ORIENTED, true, links, 20, MORAY_INFINITY);
        test_derivatives(MORAY_FIRST_PRINCIPLES, false, links, 20, 0.3);
    }
    test_line_of_sight();
    test_refusals();
    test_crab();
    test_replanning();
    test_score();
    test_last_sample();
    test_guidance();
    return tap_done();
}
