// SPDX-License-Identifier: MIT
//
// Gaits of a robot with motors, a hotel load and a battery: the least whole work per metre over ground in currents
// against a search over gaits by simulation, the line of torque over speed at every time, what a battery lasts.
#include "degree.h"
#include "tap.h"

#include <stdlib.h>

#include "moray/snake/budget.h"
#include "moray/snake/gait_problem.h"
#include "moray/snake/trial.h"

static moray_robot robot_with_motors(void)
{
    moray_robot robot = moray_robot_paper();
    robot.motor = (moray_motor){.fitted = true,
                                .forward = 0.7,
                                .backward = 0.2,
                                .friction = 0.01,
                                .copper = 0.5,
                                .smooth_rate = 5 * DEG,
                                .smooth_power = 5e-3};
    robot.supply = (moray_supply){.constant = 0.3, .battery = 10};
    return robot;
}

static moray_gait_problem_spec spec_of(const moray_robot *robot, double current)
{
    return (moray_gait_problem_spec){.robot = *robot,
                                     .model = MORAY_FIRST_PRINCIPLES,
                                     .goal = MORAY_GAIT_THRIFTIEST,
                                     .current = {current, 0},
                                     .limits = {.theta_max = moray_fixed(20 * DEG),
                                                .omega = moray_between(30 * DEG, 400 * DEG),
                                                .delta = moray_fixed(40 * DEG),
                                                .offset = moray_between(-0.02, 0.02),
                                                .power = MORAY_INFINITY,
                                                .joint_rate = MORAY_INFINITY,
                                                .joint_effort = MORAY_INFINITY}};
}

static moray_gait gait_of(const moray_robot *robot, double omega)
{
    const double delta = 40 * DEG;
    return (moray_gait){.amplitude = moray_amplitude_from_theta_max(robot, MORAY_FIRST_PRINCIPLES, 20 * DEG, delta),
                        .omega = omega,
                        .delta = delta};
}

static moray_gait_prediction optimum(const moray_gait_problem_spec *spec, const moray_test_rig *rig)
{
    const moray_gait start = gait_of(&spec->robot, 90 * DEG);
    const moray_swim_setup setup = moray_test_rig_setup(rig, spec->model);
    moray_settings settings = moray_settings_default();
    moray_gait_problem *problem;
    moray_solution *solution = NULL;
    moray_steady steady;
    moray_swim_track orbit;
    settings.scheme = "lobatto5", settings.intervals = 30, settings.barrier = 1e-4, settings.own_scaling = true;
    CHECK_OK(moray_swim_steady(&setup, &start, 0, &steady, &orbit, 101), "start");
    CHECK_OK(moray_gait_problem_new(&problem, spec), "problem");
    CHECK_OK(moray_gait_problem_solve(problem, &settings, &start, &orbit, &solution), "solved");
    const moray_nlp_outcome end = moray_solution_info(solution)->outcome;
    CHECK(end == MORAY_NLP_SOLVED, "an optimum: %s", moray_nlp_outcome_text(end));
    const moray_gait_prediction found = moray_gait_problem_prediction(problem, solution);
    moray_solution_free(solution);
    moray_gait_problem_free(problem);
    moray_swim_track_free(&orbit);
    return found;
}

// Whole work per metre over ground by simulation from rest.
static double cost(const moray_test_rig *rig, double omega)
{
    const moray_swim_setup setup = moray_test_rig_setup(rig, MORAY_FIRST_PRINCIPLES);
    const moray_robot *robot = moray_swimmer_robot(setup.swimmer);
    const moray_gait gait = gait_of(robot, omega);
    moray_steady steady;
    CHECK_OK(moray_swim_steady(&setup, &gait, 0, &steady, NULL, 0), "steady");
    return moray_budget_of(robot, steady.power, steady.speed, moray_course_speed(&steady, 0)).over_ground;
}

// The least of it over omega by golden section.
static double search(const moray_test_rig *rig, double low, double high, double *least)
{
    const double golden = (sqrt(5) - 1) / 2;
    double one = high - golden * (high - low), other = low + golden * (high - low);
    double at_one = cost(rig, one), at_other = cost(rig, other);
    while (high - low > 0.01 * high) {
        if (at_one < at_other) {
            high = other, other = one, at_other = at_one;
            one = high - golden * (high - low);
            at_one = cost(rig, one);
        } else {
            low = one, one = other, at_one = at_other;
            other = low + golden * (high - low);
            at_other = cost(rig, other);
        }
    }
    *least = fmin(at_one, at_other);
    return (low + high) / 2;
}

static double test_best_speed(double current)
{
    const moray_robot robot = robot_with_motors();
    const moray_gait_problem_spec spec = spec_of(&robot, current);
    moray_test_rig rig;
    double least;
    CHECK_OK(moray_test_rig_new(&rig, &robot, spec.current, 0), "rig");
    const moray_gait_prediction found = optimum(&spec, &rig);
    const double predicted = moray_budget_of(&robot, found.power, found.speed, found.course_speed).over_ground;
    const double omega = search(&rig, 30 * DEG, 250 * DEG, &least);
    CHECK(fabs(found.gait.omega / omega - 1) < 0.015 && fabs(predicted / least - 1) < 5e-4,
          "current %g m/s: omega %.2f deg/s, %.4f J/m; by simulation %.2f deg/s, %.4f J/m", current,
          found.gait.omega / DEG, predicted, omega / DEG, least);
    moray_test_rig_free(&rig);
    return found.gait.omega;
}

// Limits that bind hold in the motion that is swum.
static void test_line(void)
{
    moray_robot robot = robot_with_motors();
    moray_gait_problem_spec spec = spec_of(&robot, 0);
    moray_test_rig rig;
    const double speed[] = {0, 100 * DEG}, torque[] = {0.5, 0};
    CHECK_OK(moray_motor_set_table(&spec.robot.motor, speed, torque, 2), "line");
    spec.goal = MORAY_GAIT_FASTEST;
    CHECK_OK(moray_test_rig_new(&rig, &spec.robot, spec.current, 0), "rig");
    const moray_gait_prediction found = optimum(&spec, &rig);
    const moray_swim_setup setup = moray_test_rig_setup(&rig, spec.model);
    moray_steady steady;
    moray_swim_track orbit;
    double load = 0, phi[20];
    CHECK_OK(moray_swim_steady(&setup, &found.gait, 0, &steady, &orbit, 361), "swum");
    for (int k = 0; k < orbit.n; k++) {
        moray_swimmer_joints(setup.swimmer, orbit.x + k * orbit.n_states, phi, phi + orbit.n_joints);
        for (int i = 0; i < orbit.n_joints; i++)
            load = fmax(load,
                        moray_motor_load(&spec.robot.motor, orbit.u[k * orbit.n_joints + i], phi[orbit.n_joints + i]));
    }
    CHECK_NEAR(load, 1, 2e-3, "the fastest gait takes all that the motors give, and no more");
    CHECK(fabs(steady.power / found.power - 1) < 1e-3, "power at the terminals: %.5f W swum, %.5f W predicted",
          steady.power, found.power);
    moray_swim_track_free(&orbit);
    spec.robot.supply.rate = found.gait.amplitude * found.gait.omega / 2;
    const moray_gait_prediction slower = optimum(&spec, &rig);
    CHECK_NEAR(slower.gait.amplitude * slower.gait.omega / spec.robot.supply.rate, 1, 1e-6, "half the rate binds");
    moray_test_rig_free(&rig);
}

static void test_budget(void)
{
    const moray_robot robot = robot_with_motors(), bare = moray_robot_paper();
    const moray_budget budget = moray_budget_of(&robot, 0.7, 0.2, 0.1);
    CHECK_NEAR(budget.whole, 1, 1e-15, "with the constant load");
    CHECK_NEAR(budget.through_water, 5, 1e-14, "per metre through the water");
    CHECK_NEAR(budget.over_ground, 10, 1e-14, "and over ground");
    CHECK_NEAR(budget.endurance, 10, 1e-14, "10 Wh");
    CHECK_NEAR(budget.range, 3600, 1e-11, "at 0.1 m/s");
    const moray_budget adrift = moray_budget_of(&robot, 0.7, 0.2, NAN), still = moray_budget_of(&robot, 0.7, 0, 0);
    CHECK(isnan(adrift.over_ground) && isnan(adrift.range) && adrift.through_water == budget.through_water,
          "a course that is not held costs nothing that is known: %g J/m", adrift.over_ground);
    CHECK(isinf(still.over_ground) && still.range == 0, "no way: %g J/m", still.over_ground);
    CHECK(moray_budget_tells(&robot) && !moray_budget_tells(&bare), "where there is more to tell");
}

int main(void)
{
    test_budget();
    test_line();
    const double still = test_best_speed(0), against = test_best_speed(-0.08);
    CHECK(against > 1.05 * still, "against the current the best gait is a faster one: %.1f and %.1f deg/s",
          against / DEG, still / DEG);
    if (tap_thorough())
        CHECK(test_best_speed(0.02) < 0.95 * still, "and with it a slower one");
    return tap_done();
}
