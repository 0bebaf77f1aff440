// SPDX-License-Identifier: MIT
//
// An optimal gait of the paper's robot, solved from a steady orbit, with its certificate.
#ifndef TESTS_GAIT_OPTIMUM_H
#define TESTS_GAIT_OPTIMUM_H

#include <stdlib.h>

#include "degree.h"
#include "moray/snake/trial.h"
#include "tap.h"

static inline moray_gait_problem_spec default_spec(moray_model model, double power)
{
    return (moray_gait_problem_spec){.robot = moray_robot_paper(),
                                     .model = model,
                                     .limits = {.theta_max = moray_between(1 * DEG, 20 * DEG),
                                                .omega = moray_between(30 * DEG, 360 * DEG),
                                                .delta = moray_between(15 * DEG, 90 * DEG),
                                                .offset = moray_between(-0.02, 0.02),
                                                .power = power,
                                                .joint_rate = MORAY_INFINITY,
                                                .joint_effort = MORAY_INFINITY}};
}

struct outcome {
    moray_gait_prediction prediction;
    moray_certificate certificate;
    int iterations;
};

// Solves from the steady orbit of a gait of the control-oriented model.
static inline struct outcome solve_from(const moray_gait_problem_spec *spec, const moray_gait *start,
                                        const char *scheme, int intervals)
{
    moray_test_rig rig;
    moray_gait_problem *problem;
    moray_solution *solution = NULL;
    moray_steady steady;
    moray_swim_track orbit;
    struct outcome outcome = {0};
    const moray_gait gait = moray_gait_map(&spec->robot, start, MORAY_CONTROL_ORIENTED, spec->model);
    moray_settings settings = moray_settings_default();
    settings.scheme = scheme, settings.intervals = intervals, settings.barrier = 1e-4;
    moray_status status = moray_test_rig_new(&rig, &spec->robot, spec->current, spec->course);
    const moray_swim_setup setup = moray_test_rig_setup(&rig, spec->model);
    if (!moray_failed(status))
        status = moray_swim_hold_course(&setup, &gait, spec->course, &steady);
    if (!moray_failed(status))
        status = moray_swim_steady(&setup, &gait, steady.start_heading, &steady, &orbit, 101);
    if (!moray_failed(status))
        status = moray_gait_problem_new(&problem, spec);
    if (!moray_failed(status))
        status = moray_gait_problem_solve(problem, &settings, &gait, &orbit, &solution);
    if (!CHECK(!moray_failed(status), "%s, %d intervals: %s", scheme, intervals, status.text))
        exit(1);
    const moray_nlp_outcome end = moray_solution_info(solution)->outcome;
    outcome.iterations = moray_solution_info(solution)->iterations;
    CHECK(end == MORAY_NLP_SOLVED, "%s, %d intervals: %s", scheme, intervals, moray_nlp_outcome_text(end));
    outcome.prediction = moray_gait_problem_prediction(problem, solution);
    const moray_integrator integrator = moray_sim_integrator(&rig.settings.sim);
    CHECK_OK(moray_certify(solution, &integrator, &outcome.certificate), "certificate");
    moray_solution_free(solution);
    moray_gait_problem_free(problem);
    moray_swim_track_free(&orbit);
    moray_test_rig_free(&rig);
    return outcome;
}

static inline struct outcome solve(const moray_gait_problem_spec *spec, const char *scheme, int intervals)
{
    const moray_gait paper = moray_gait_paper(&spec->robot);
    return solve_from(spec, &paper, scheme, intervals);
}

#endif
