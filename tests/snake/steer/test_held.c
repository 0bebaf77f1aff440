// SPDX-License-Identifier: MIT
//
// While a solver works, the Hessian by what keeps its value is left out, and nothing else of it.
#include "degree.h"
#include "tap.h"

#include <stdlib.h>
#include <string.h>

#include "moray/snake/heading.h"
#include "moray/snake/plant.h"
#include "moray/snake/trial.h"
#include "ocp/solution.h"
#include "snake/steer/problems.h"

static const double unit = 10 * DEG;

// ---- Of a map: the plant and what a task adds to it ----

enum { plant_inputs = 13, task_inputs = 14, theta = 0, alpha = 9, of_task = 10 };

// The task has an input of its own, between two of the plant's.
static void task(void *self, const moray_num *in, moray_num *out)
{
    (void)self;
    out[0] = in[theta] * in[of_task] * in[alpha];
    out[1] = in[of_task] * in[of_task] + in[alpha] * in[task_inputs - 1];
}

static moray_status join(moray_map *map)
{
    const moray_plant_spec spec = {
        .robot = moray_robot_paper(), .joints = MORAY_JOINTS_STEERED, .current = {0.1, -0.05}, .path_angles = true};
    double probe[task_inputs];
    int place[plant_inputs];
    moray_map plant, more;
    for (int k = 0; k < task_inputs; k++)
        probe[k] = 0.3 + 0.1 * k;
    for (int k = 0; k < plant_inputs; k++)
        place[k] = k < of_task ? k : k + 1;
    MORAY_TRY(moray_fp_plant(&plant, &spec));
    MORAY_TRY(moray_map_from_complex(&more, task_inputs, 2, task, NULL, NULL, probe));
    return moray_map_join(map, &plant, place, &more, 8);
}

static void test_map(const bool *held, const char *what)
{
    moray_map map;
    CHECK_OK(join(&map), "joined");
    double in[task_inputs];
    for (int k = 0; k < task_inputs; k++)
        in[k] = 0.1 + 0.07 * k;
    double *weight = calloc((size_t)(map.n_out + 3 * map.hess.nnz), sizeof *weight), *whole = weight + map.n_out;
    double *some = whole + map.hess.nnz, *after = some + map.hess.nnz;
    for (int i = 0; i < map.n_out; i++)
        weight[i] = 1 + 0.3 * i;
    map.hessian(map.self, in, weight, whole);
    map.hold(map.self, held);
    map.hessian(map.self, in, weight, some);
    map.hold(map.self, NULL);
    map.hessian(map.self, in, weight, after);
    int kept = 0, left = 0, free_entries = 0;
    for (int k = 0; k < map.hess.nnz; k++) {
        const bool of_held = held[map.hess.row[k]] || held[map.hess.col[k]];
        free_entries += !of_held;
        kept += !of_held && some[k] == whole[k];
        left += of_held && some[k] == 0 && whole[k] != 0;
    }
    CHECK(kept == free_entries && kept > 0, "%s: %d of %d entries to the last bit", what, kept, free_entries);
    CHECK(left > 5, "%s: %d entries are left out", what, left);
    CHECK(memcmp(after, whole, (size_t)map.hess.nnz * sizeof *whole) == 0, "%s: all are back afterwards", what);
    free(weight);
    moray_map_release(&map);
}

// ---- Of a plan ----

static moray_heading_spec spec_of(moray_model model, const moray_reference *reference, bool gait_free)
{
    const moray_robot robot = moray_robot_paper();
    const moray_gait paper = moray_gait_paper(&robot);
    moray_steering_limits limits = {.theta_max = moray_between(1 * DEG, 20 * DEG),
                                    .omega = gait_free ? moray_between(60 * DEG, 240 * DEG) : moray_fixed(120 * DEG),
                                    .delta = moray_fixed(40 * DEG),
                                    .offset = 0.015,
                                    .offset_rate = 0.01,
                                    .offset_acceleration = MORAY_INFINITY,
                                    .power = MORAY_INFINITY};
    return (moray_heading_spec){.robot = robot,
                                .model = model,
                                .start = {0.1, 0, 0, 0.05, 0.2, 0.02},
                                .limits =
                                    moray_steering_limits_map(&robot, &limits, &paper, MORAY_CONTROL_ORIENTED, model),
                                .weight = {.heading = 1 / (unit * unit), .power = 0.3, .steering = 0.01},
                                .reference = reference,
                                .max_error = MORAY_INFINITY,
                                .t1 = 6};
}

static bool is_fixed(const moray_nlp *nlp, int j)
{
    return nlp->x_lower[j] == nlp->x_upper[j];
}

static void test_plan(moray_model model, bool gait_free)
{
    const moray_reference reference = {.n = 1, .time = (double[]){0}, .heading = (double[]){0.3}};
    const moray_heading_spec spec = spec_of(model, &reference, gait_free);
    moray_settings settings = moray_settings_default();
    moray_steering_problem problem;
    moray_solution *solution;
    settings.max_iterations = 2;
    settings.intervals = 6;
    CHECK_OK(moray_heading_new(&problem, &spec), "problem");
    CHECK_OK(moray_solve(moray_steering_ocp(problem.steering), &settings, NULL, &solution), "begun");
    const moray_nlp *nlp = &solution->transcription->nlp;
    const double *x = solution->iterate.x;
    double *block = calloc((size_t)(nlp->m + 2 * nlp->nnz_hess), sizeof *block), *whole = block + nlp->m,
           *some = whole + nlp->nnz_hess;
    for (int i = 0; i < nlp->m; i++)
        block[i] = cos(i);
    CHECK(nlp->hessian(nlp->self, x, true, 0.7, block, whole), "as it is after a solver has ended");
    nlp->hold(nlp->self, true);
    CHECK(nlp->hessian(nlp->self, x, true, 0.7, block, some), "as a solver has it");
    nlp->hold(nlp->self, false);
    int wrong = 0, left = 0, of_parameters = 0;
    for (int k = 0; k < nlp->nnz_hess; k++) {
        const bool fixed = is_fixed(nlp, nlp->hess_row[k]) || is_fixed(nlp, nlp->hess_col[k]);
        wrong += some[k] != whole[k] && !fixed;
        left += some[k] != whole[k];
        of_parameters += nlp->hess_row[k] == solution->transcription->layout.s + 1 && whole[k] != 0;
    }
    CHECK(wrong == 0, "%d entries by what is free differ", wrong);
    CHECK(of_parameters > 10, "the frequency bends the Lagrangian: %d entries", of_parameters);
    CHECK((left > 10) == (model == MORAY_FIRST_PRINCIPLES), "%d entries by the gait are left out", left);
    free(block);
    moray_solution_free(solution);
    moray_steering_problem_free(&problem);
}

int main(void)
{
    bool held[task_inputs] = {0};
    held[alpha] = true;
    test_map(held, "amplitude");
    held[of_task + 2] = held[task_inputs - 1] = true;
    test_map(held, "amplitude, phase shift and time");
    test_plan(MORAY_FIRST_PRINCIPLES, false);
    test_plan(MORAY_FIRST_PRINCIPLES, true);
    test_plan(MORAY_CONTROL_ORIENTED, false);
    return tap_done();
}
