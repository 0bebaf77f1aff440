// SPDX-License-Identifier: MIT
#include "benchmark.h"

static const double still_water[2] = {0, 0};

static moray_status begin(void *self)
{
    gait_case *c = self;
    moray_test_rig rig;
    moray_steady steady;
    c->robot = moray_robot_paper();
    c->robot.links = c->links;
    moray_gait paper = moray_gait_paper(&c->robot);
    c->gait = moray_gait_map(&c->robot, &paper, MORAY_CONTROL_ORIENTED, c->model);
    MORAY_TRY(moray_test_rig_new(&rig, &c->robot, still_water, 0));
    const moray_swim_setup setup = moray_test_rig_setup(&rig, c->model);
    moray_status status = moray_swim_steady(&setup, &c->gait, 0, &steady, &c->orbit, 101);
    c->power = steady.power;
    c->speed = steady.speed;
    moray_test_rig_free(&rig);
    return status;
}

static void end(void *self)
{
    gait_case *c = self;
    moray_swim_track_free(&c->orbit);
}

// The limits of max_speed; power and speed are those of the paper's gait.
static moray_gait_problem_spec spec_of(const gait_case *c)
{
    const double offset = c->model == MORAY_CONTROL_ORIENTED ? 0.02 : 10 * DEG;
    const bool fastest = c->goal == MORAY_GAIT_FASTEST;
    return (moray_gait_problem_spec){.robot = c->robot,
                                     .model = c->model,
                                     .goal = c->goal,
                                     .joints = c->joints,
                                     .limits = {.theta_max = moray_between(1 * DEG, 20 * DEG),
                                                .omega = moray_between(30 * DEG, 360 * DEG),
                                                .delta = moray_gait_usual_delta(&c->robot),
                                                .offset = moray_between(-offset, offset),
                                                .power = fastest ? c->power : MORAY_INFINITY,
                                                .joint_rate = MORAY_INFINITY,
                                                .joint_effort = MORAY_INFINITY,
                                                .course_speed = fastest ? 0 : c->speed}};
}

static moray_status solve(void *self, moray_linear_solver linear, bool timed, moray_solution **solution)
{
    gait_case *c = self;
    const moray_gait_problem_spec spec = spec_of(c);
    moray_settings settings = benchmark_settings(c->scheme, c->intervals, linear, timed);
    settings.barrier = c->barrier > 0 ? c->barrier : settings.barrier;
    MORAY_TRY(moray_gait_problem_new(&c->problem, &spec));
    return moray_gait_problem_solve(c->problem, &settings, &c->gait, &c->orbit, solution);
}

static void forget(void *self)
{
    gait_case *c = self;
    moray_gait_problem_free(c->problem);
    c->problem = NULL;
}

subject gait_case_subject(gait_case *c)
{
    return (subject){begin, solve, forget, end, c};
}
