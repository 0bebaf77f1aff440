// SPDX-License-Identifier: MIT
#include "steer.h"

#include <string.h>

steer_job steer_defaults(void)
{
    steer_job job = {.common = moray_common_default(),
                     .snake = moray_snake_options_default(),
                     .input = {.theta_max = {1 * DEG, 20 * DEG},
                               .omega = {30 * DEG, 360 * DEG},
                               .delta = {15 * DEG, 90 * DEG},
                               .offset = 0.015,
                               .offset_rate = 0.01,
                               .power = NAN},
                     .intervals_per_period = 5,
                     .refinements = 20,
                     .replan_periods = 1,
                     .look_ahead_periods = 6,
                     .starts = 12,
                     .evaluations = 20,
                     .receding = true,
                     .clock = {.limit = 1800}};
    job.snake.model = MORAY_FIRST_PRINCIPLES;
    strcpy(job.common.scheme, "radau5");
    job.common.intervals = 0; // by the period
    return job;
}

moray_status steer_read_water(steer_job *job, const double (*place)[2], int n)
{
    double *mean = job->snake.current;
    if (!job->water_file[0])
        return moray_ok();
    if (job->snake.robot.hydro.drag != MORAY_DRAG_LINEAR &&
        job->snake.robot.hydro.added_mass != MORAY_ADDED_MASS_INVARIANT)
        return moray_error(MORAY_INPUT, "--water: quadratic drag needs added_mass = invariant, else drag = linear");
    MORAY_TRY(moray_water_read(&job->water, job->water_file));
    mean[0] = mean[1] = 0;
    for (int k = 0; k < n; k++) {
        double V[2];
        if (!moray_water_covers(job->water, place[k][0], place[k][1], 0))
            return moray_error(MORAY_INPUT,
                               "--water %.120s: the way leads through (%.4g, %.4g) m, outside of the table",
                               job->water_file, place[k][0], place[k][1]);
        moray_water_at(job->water, place[k][0], place[k][1], 0, V);
        mean[0] += V[0] / n;
        mean[1] += V[1] / n;
    }
    return moray_ok();
}

// ---- Start and end -------------------------------------------------------------------------------------------------

static moray_status work(steer_job *job)
{
    moray_family family;
    int stages;
    MORAY_TRY(moray_robot_check_swims(&job->snake.robot));
    MORAY_TRY(moray_snake_turning(&job->snake));
    MORAY_TRY(moray_scheme_parse(job->common.scheme, &family, &stages));
    return job->program->work(job);
}

static moray_status certified(const steer_job *job)
{
    for (int model = 0; model <= (int)job->snake.model; model += job->snake.model == MORAY_FIRST_PRINCIPLES ? 1 : 2)
        if (!job->certificate[model].pass) {
            char text[300] = "";
            if (job->program->doubt)
                job->program->doubt(job, (moray_model)model, text, sizeof text);
            return moray_error(MORAY_NOT_SOLVED, "certificate of the plan on the %s model failed: %.140s%s",
                               moray_model_name((moray_model)model), job->certificate[model].why, text);
        }
    return moray_ok();
}

int steer_main(const moray_program *own, const steer_program *program, int argc, char **argv, steer_job *job)
{
    static const char *const without[] = {"course", NULL}; // the task says where to
    const moray_option_group snake = {&moray_snake_option_table, offsetof(steer_job, snake)};
    moray_program app = *own;
    int exit_code;
    app.groups = &snake;
    app.n_groups = 1;
    app.without = without;
    job->name = app.name;
    job->program = program;
    memcpy(job->number, program->numbers, (size_t)program->n_numbers * sizeof *job->number);
    if (!moray_app_start(&app, argc, argv, job, &exit_code))
        return exit_code;
    job->ticker = moray_ticker_start(stderr, job->common.quiet);
    steer_clock_start(&job->clock);
    moray_interrupt_begin();
    moray_status status = work(job);
    const moray_status errands = steer_end_errands(job);
    if (!moray_failed(status))
        status = errands;
    moray_interrupt_end();
    moray_ticker_end(&job->ticker);
    if (!moray_failed(status))
        status = steer_report(job);
    if (!moray_failed(status))
        status = job->without;
    exit_code = moray_app_end(&app, job, status);
    if (exit_code == MORAY_EXIT_SOLVED)
        exit_code = moray_app_certified(&app, certified(job));
    for (int k = 0; k < 3; k++)
        moray_steering_plan_free(&job->plan[k]);
    if (program->release)
        program->release(job);
    moray_water_free(job->water);
    return exit_code;
}

// ---- Plans ---------------------------------------------------------------------------------------------------------

static bool show_iteration(void *observer, const moray_progress *at)
{
    const steer_job *job = observer;
    moray_ticker_show(&job->ticker, "%s: iteration %d, objective %.6g, violation %.1e", job->name, at->iteration,
                      at->objective, at->infeasibility);
    return !moray_interrupted() && !steer_clock_up(&job->clock);
}

moray_settings steer_settings(steer_job *job, bool averaged, int intervals, double mesh_tolerance, double barrier)
{
    moray_settings settings = moray_settings_default();
    settings.scheme = averaged ? STEER_AVERAGED_SCHEME : job->common.scheme;
    settings.intervals = !averaged && job->common.intervals > 0 ? job->common.intervals : intervals;
    settings.tolerance = job->common.tol;
    settings.linear_solver = job->common.linear_solver;
    settings.ipopt = job->common.ipopt.at;
    settings.n_ipopt = job->common.ipopt.n;
    settings.mesh_tolerance = mesh_tolerance;
    settings.max_refinements = averaged ? 0 : job->refinements;
    settings.barrier = averaged ? 0.1 : barrier;
    settings.progress = show_iteration;
    settings.observer = job;
    return settings;
}

bool steer_solved(const moray_solution *solution)
{
    const moray_nlp_outcome outcome = moray_solution_info(solution)->outcome;
    bool solved = outcome == MORAY_NLP_SOLVED;
    int meshes;
    const moray_mesh_record *record = moray_solution_history(solution, &meshes);
    for (int k = 0; outcome == MORAY_NLP_INTERRUPTED && !moray_interrupted() && k < meshes; k++)
        solved = solved || record[k].outcome == MORAY_NLP_SOLVED;
    return solved;
}

moray_status steer_not_solved(const moray_solution *solution)
{
    const moray_nlp_info *info = moray_solution_info(solution);
    const moray_status failure = moray_solution_failure(solution);
    if (info->outcome != MORAY_NLP_INTERRUPTED)
        return failure;
    if (moray_interrupted())
        return moray_error(MORAY_INTERRUPTED, "interrupted after %d iterations; nothing is written", info->iterations);
    return moray_error(MORAY_NOT_SOLVED, "not solved in the time given (--time): %s", failure.text);
}

bool steer_alike(const steer_job *job, moray_model model, const moray_steering_plan *from)
{
    const double *rate = job->turn_rate, most = log(2);
    return !from || fabs(log(fabs(rate[from->straight.model] / rate[model]))) < most;
}

moray_status steer_do_without(steer_job *job, moray_status reason)
{
    if (reason.code != MORAY_NOT_SOLVED || job->snake.model == MORAY_CONTROL_ORIENTED ||
        !job->plan[MORAY_CONTROL_ORIENTED].solution || !steer_solved(job->plan[MORAY_CONTROL_ORIENTED].solution))
        return reason;
    job->without = moray_error(MORAY_NOT_SOLVED, "no first-principles plan: %s", reason.text);
    job->snake.model = MORAY_CONTROL_ORIENTED;
    moray_steering_plan_free(&job->plan[MORAY_FIRST_PRINCIPLES]);
    job->plan[MORAY_FIRST_PRINCIPLES] = (moray_steering_plan){0};
    job->certified[MORAY_FIRST_PRINCIPLES] = NULL;
    return moray_ok();
}

double steer_duration(const moray_solution *solution)
{
    double t0, tf;
    moray_solution_times(solution, 0, &t0, &tf);
    return tf;
}

steer_saturation steer_saturation_of(const steer_job *job, moray_model model)
{
    enum { points = 4000 };
    const double at_limit = 0.999;
    const moray_solution *solution = job->plan[model].solution;
    const moray_steering_limits limits = steer_limits(job, model);
    steer_saturation share = {0, 0};
    double t0, t1;
    moray_solution_times(solution, 0, &t0, &t1);
    for (int k = 0; k < points; k++) {
        const moray_offset offset = moray_steering_offset(solution, t0 + (t1 - t0) * (k + 0.5) / points);
        share.offset += (fabs(offset.value) > at_limit * limits.offset) / (double)points;
        share.rate += (fabs(offset.rate) > at_limit * limits.offset_rate) / (double)points;
    }
    return share;
}

// ---- Words ---------------------------------------------------------------------------------------------------------

void steer_say_limit(const steer_job *job, char *text, size_t size)
{
    const moray_steering_limits limits = steer_limits(job, job->snake.model);
    const bool control = job->snake.model == MORAY_CONTROL_ORIENTED;
    *text = 0;
    moray_text_add(text, size, "With |phi_0| at its limit of %.3g %s the robot turns",
                   control ? 100 * limits.offset : limits.offset / DEG, control ? "cm" : "deg");
}

void steer_say_saturation(const steer_job *job, char *text, size_t size)
{
    const steer_saturation share = steer_saturation_of(job, job->snake.model);
    moray_text_add(text, size, "he plan has the offset at its limit for %.0f %% of the time, and its rate for %.0f %%.",
                   100 * share.offset, 100 * share.rate);
}
