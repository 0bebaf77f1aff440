// SPDX-License-Identifier: MIT
#include "sensitivity.h"

enum { KEPT, PREDICTED, AGAIN };
enum { SIDES = 4 };

// The job's problem with the current a share of the way to the other.
static moray_status on_the_way(const sensitivity *run, double share, moray_gait_problem **problem)
{
    const gait_job *job = &run->job;
    double current[2];
    for (int i = 0; i < 2; i++)
        current[i] = job->snake.current[i] + share * (run->forecast.current[i] - job->snake.current[i]);
    return gait_job_problem(job, last_stage(job), job->goal, current, problem);
}

// Derivatives by the share of the way.
static moray_status take_slopes(sensitivity *run, moray_sensitivity *slopes)
{
    static const double sides[SIDES] = {-2, -1, 1, 2};
    const double *from = run->job.snake.current, *to = run->forecast.current;
    const double way = hypot(to[0] - from[0], to[1] - from[1]);
    const double step = 1e-3 * last_stage(&run->job)->prediction.course_speed / way;
    moray_gait_problem *problem[SIDES] = {NULL};
    const moray_ocp *ocp[SIDES];
    moray_status status = moray_ok();
    for (int k = 0; k < SIDES && !moray_failed(status); k++) {
        status = on_the_way(run, sides[k] * step, &problem[k]);
        ocp[k] = moray_failed(status) ? NULL : moray_gait_problem_ocp(problem[k]);
    }
    if (!moray_failed(status))
        status = moray_sensitivity_by(slopes, ocp, step);
    run->forecast.change = moray_sensitivity_change(slopes, 1);
    for (int k = 0; k < SIDES; k++)
        moray_gait_problem_free(problem[k]);
    return status;
}

// The prediction and, from it, the solution.
static moray_status foresee(sensitivity *run, const moray_sensitivity *slopes, const moray_gait_problem *problem)
{
    sensitivity_forecast *f = &run->forecast;
    moray_solution *predicted, *solution;
    MORAY_TRY(moray_sensitivity_predict(slopes, moray_gait_problem_ocp(problem), 1, &predicted));
    f->prediction[PREDICTED] = moray_gait_problem_prediction(problem, predicted);
    moray_status status = sensitivity_solve(run, problem, predicted, &solution);
    moray_solution_free(predicted);
    MORAY_TRY(status);
    f->solved = sensitivity_solved(solution);
    f->prediction[AGAIN] = moray_gait_problem_prediction(problem, solution);
    moray_solution_free(solution);
    return moray_ok();
}

// Where the robot cannot hold its course in that current the trial says so.
static moray_status swim_all(sensitivity *run)
{
    sensitivity_forecast *f = &run->forecast;
    const gait_job *job = &run->job;
    moray_test_rig rig;
    moray_status status = moray_test_rig_new(&rig, &job->snake.robot, f->current, job->snake.course);
    for (int k = 0; k < SENSITIVITY_GAITS && !moray_failed(status); k++)
        status = moray_gait_trial_run(&rig, &f->prediction[k].gait, job->snake.model, &f->trial[k]);
    moray_test_rig_free(&rig);
    return status;
}

static moray_status predict(sensitivity *run, moray_sensitivity *slopes)
{
    moray_gait_problem *problem = NULL;
    MORAY_TRY(take_slopes(run, slopes));
    moray_status status = on_the_way(run, 1, &problem);
    if (!moray_failed(status))
        status = foresee(run, slopes, problem);
    moray_gait_problem_free(problem);
    return moray_failed(status) ? status : swim_all(run);
}

moray_status sensitivity_predict(sensitivity *run, moray_sensitivity *slopes)
{
    const double *current = run->job.snake.current, further = 0.1;
    sensitivity_forecast *f = &run->forecast;
    const bool given = !isnan(run->predicted[0]);
    f->current[0] = given ? run->predicted[0] : current[0] + further;
    f->current[1] = given ? run->predicted[1] : current[1] + further;
    if (f->current[0] == current[0] && f->current[1] == current[1])
        return moray_ok();
    f->asked = true;
    f->prediction[KEPT] =
        (moray_gait_prediction){.gait = last_stage(&run->job)->prediction.gait, .course_speed = NAN, .power = NAN};
    moray_ticker_show(&run->job.ticker, "%s: another current", run->job.name);
    f->why = predict(run, slopes);
    return f->why.code == MORAY_NUMERIC || f->why.code == MORAY_NOT_SOLVED ? moray_ok() : f->why;
}
