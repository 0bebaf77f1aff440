// SPDX-License-Identifier: MIT
#include <stdio.h>
#include <string.h>

#include "moray/parallel.h"
#include "sensitivity.h"

// ---- What moves ----------------------------------------------------------------------------------------------------

const char *const sensitivity_names[SLOPES] = {"speed", "power", "theta_max", "omega", "delta", "phi_0", "taper"};

const char *sensitivity_unit(const gait_job *job, int quantity)
{
    static const char *const units[SLOPES] = {"m/s", "W", "deg", "deg/s", "deg", "deg", "1"};
    return quantity == SLOPE_OFFSET && job->snake.model == MORAY_CONTROL_ORIENTED ? "cm" : units[quantity];
}

void sensitivity_values(const gait_job *job, const moray_gait *gait, double speed, double power, double value[SLOPES])
{
    const moray_model model = job->snake.model;
    value[SLOPE_SPEED] = speed;
    value[SLOPE_POWER] = power;
    value[SLOPE_THETA_MAX] =
        moray_theta_max_from_amplitude(&job->snake.robot, model, gait->amplitude, gait->delta) / DEG;
    value[SLOPE_OMEGA] = gait->omega / DEG;
    value[SLOPE_DELTA] = gait->delta / DEG;
    value[SLOPE_OFFSET] = gait->offset * (model == MORAY_CONTROL_ORIENTED ? 100 : 1 / DEG);
    value[SLOPE_TAPER] = gait->taper;
}

static void prediction_values(const gait_job *job, const moray_gait_prediction *prediction, double value[SLOPES])
{
    sensitivity_values(job, &prediction->gait, prediction->course_speed, prediction->power, value);
}

// The prediction that the slopes make at a step.
static moray_gait_prediction prediction_at(const moray_gait_prediction *prediction, const moray_gait_slope *slope,
                                           double step)
{
    moray_gait_prediction there = *prediction;
    double s[MORAY_GAIT_PARAMETERS], d[MORAY_GAIT_PARAMETERS];
    moray_gait_to_parameters(&prediction->gait, s);
    moray_gait_to_parameters(&slope->gait, d);
    for (int i = 0; i < MORAY_GAIT_PARAMETERS; i++)
        s[i] += step * d[i];
    there.gait = moray_gait_from_parameters(s);
    there.course_speed += step * slope->course_speed;
    there.power += step * slope->power;
    return there;
}

// ---- One parameter -------------------------------------------------------------------------------------------------

enum { SIDES = 4 };
static const double side_steps[SIDES] = {-2, -1, 1, 2};

struct displaced {
    variant moved[SIDES];
    moray_gait_problem *problem[SIDES];
};

static moray_status displace(const sensitivity *run, const sensitivity_parameter *parameter, const sensitivity_row *row,
                             struct displaced *to)
{
    for (int k = 0; k < SIDES; k++) {
        sensitivity_displace(parameter, &run->job, side_steps[k] * row->step, &to->moved[k]);
        const gait_job *job = &to->moved[k].job;
        MORAY_TRY(gait_job_problem(job, &to->moved[k].at, job->goal, job->snake.current, &to->problem[k]));
    }
    return moray_ok();
}

// theta_max depends on the link length too, so that all is differenced along the slopes.
static void fill_slopes(const sensitivity *run, const struct displaced *at, const moray_gait_slope *slope,
                        sensitivity_row *row)
{
    static const double stencil[SIDES] = {1 / 12.0, -8 / 12.0, 8 / 12.0, -1 / 12.0};
    memset(row->slope, 0, sizeof row->slope);
    for (int k = 0; k < SIDES; k++) {
        double value[SLOPES];
        const moray_gait_prediction there =
            prediction_at(&last_stage(&run->job)->prediction, slope, side_steps[k] * row->step);
        prediction_values(&at->moved[k].job, &there, value);
        for (int i = 0; i < SLOPES; i++)
            row->slope[i] += stencil[k] * value[i] / row->step;
    }
}

moray_status sensitivity_solve(sensitivity *run, const moray_gait_problem *problem, const moray_solution *from,
                               moray_solution **solution)
{
    const double tight = 1e-10;
    moray_settings settings = gait_job_settings(&run->job);
    const moray_guess guess = moray_guess_from_solution(from);
    settings.intervals = 0;
    settings.max_refinements = 0;
    settings.tolerance = fmin(settings.tolerance, tight);
    MORAY_TRY(moray_solve(moray_gait_problem_ocp(problem), &settings, &guess, solution));
    return moray_interrupted() ? moray_error(MORAY_INTERRUPTED, "interrupted; nothing is written") : moray_ok();
}

bool sensitivity_solved(const moray_solution *solution)
{
    const moray_nlp_outcome outcome = moray_solution_info(solution)->outcome;
    return outcome == MORAY_NLP_SOLVED || outcome == MORAY_NLP_ACCEPTABLE;
}

static moray_status fill_again(sensitivity *run, const struct displaced *at, sensitivity_row *row)
{
    double value[2][SLOPES];
    bool all = true;
    for (int side = 0; side < 2; side++) {
        const int k = 1 + side;
        moray_solution *solution;
        MORAY_TRY(sensitivity_solve(run, at->problem[k], last_stage(&run->job)->solution, &solution));
        const moray_gait_prediction prediction = moray_gait_problem_prediction(at->problem[k], solution);
        prediction_values(&at->moved[k].job, &prediction, value[side]);
        all = all && sensitivity_solved(solution);
        moray_solution_free(solution);
    }
    row->deviation = 0;
    for (int i = 0; i < SLOPES; i++) {
        row->again[i] = all ? (value[1][i] - value[0][i]) / (2 * row->step) : NAN;
        row->deviation =
            fmax(row->deviation, all ? fabs(row->slope[i] - row->again[i]) * row->scale / run->size[i] : INFINITY);
    }
    return moray_ok();
}

// Swims a gait of the job's model on the first-principles one.
static moray_status swim(const gait_job *job, const moray_gait *gait, double value[2])
{
    const moray_model model = MORAY_FIRST_PRINCIPLES;
    moray_test_rig rig;
    moray_steady steady;
    MORAY_TRY(moray_test_rig_new(&rig, &job->snake.robot, job->snake.current, job->snake.course));
    rig.settings.agreement = 1e-9;
    const moray_swim_setup setup = moray_test_rig_setup(&rig, model);
    const moray_gait mapped = moray_gait_map(&job->snake.robot, gait, job->snake.model, model);
    const moray_status status = moray_swim_hold_course(&setup, &mapped, job->snake.course, &steady);
    moray_test_rig_free(&rig);
    value[0] = moray_failed(status) ? NAN : moray_course_speed(&steady, job->snake.course);
    value[1] = moray_failed(status) ? NAN : steady.power;
    return status.code == MORAY_NOT_SOLVED ? moray_ok() : status;
}

static moray_status fill_swum(const sensitivity *run, const struct displaced *at, const moray_gait_slope *slope,
                              sensitivity_row *row)
{
    double value[2][2];
    for (int side = 0; side < 2; side++) {
        const int k = side * (SIDES - 1);
        const moray_gait_prediction there =
            prediction_at(&last_stage(&run->job)->prediction, slope, side_steps[k] * row->step);
        MORAY_TRY(swim(&at->moved[k].job, &there.gait, value[side]));
    }
    for (int i = 0; i < 2; i++)
        row->swum[i] = (value[1][i] - value[0][i]) / (4 * row->step);
    return moray_ok();
}

static bool nothing_moves(const sensitivity *run, const sensitivity_row *row)
{
    bool still = true;
    for (int i = 0; i < SLOPES; i++)
        still = still && fabs(row->slope[i]) * row->scale < 1e-9 * run->size[i];
    return still;
}

static void note(char list[SENSITIVITY_LIST], const char *item)
{
    const size_t used = strlen(list);
    snprintf(list + used, SENSITIVITY_LIST - used, "%s%s", used > 0 ? "; " : "", item);
}

// *reached <- whether anything depends on the parameter.
static moray_status measure(sensitivity *run, moray_sensitivity *slopes, const struct displaced *at, bool limit,
                            sensitivity_row *row, bool *reached)
{
    const stage *best = last_stage(&run->job);
    const moray_ocp *ocp[SIDES];
    for (int k = 0; k < SIDES; k++)
        ocp[k] = moray_gait_problem_ocp(at->problem[k]);
    MORAY_TRY(moray_sensitivity_by(slopes, ocp, row->step));
    const moray_gait_slope slope = moray_gait_problem_slope(best->problem, best->solution, slopes);
    fill_slopes(run, at, &slope, row);
    row->up = moray_sensitivity_change(slopes, 1);
    row->down = moray_sensitivity_change(slopes, -1);
    row->unsteady = row->up.step < 2 * row->step || row->down.step > -2 * row->step;
    *reached = !limit || !nothing_moves(run, row);
    if (!*reached)
        return moray_ok();
    MORAY_TRY(fill_again(run, at, row));
    return fill_swum(run, at, &slope, row);
}

// Parameters that apply, dealt to processes.
struct deal {
    sensitivity *run;
    moray_sensitivity *slopes;
    const sensitivity_parameter *parameter[SENSITIVITY_ROWS];
    int n;
};

struct outcome {
    sensitivity_row row;
    bool reached;
    moray_status status;
};

static void by_parameter(int task, void *result, void *self)
{
    const double share = 1e-3; // of the scale
    const struct deal *deal = self;
    sensitivity *run = deal->run;
    const sensitivity_parameter *parameter = deal->parameter[task];
    struct outcome *outcome = result;
    struct displaced at = {0};
    *outcome = (struct outcome){0};
    sensitivity_row *row = &outcome->row;
    sensitivity_parameter_describe(parameter, &run->job, last_stage(&run->job)->prediction.course_speed, row);
    row->step = share * row->scale;
    moray_ticker_count(&run->job.ticker, task, deal->n, "%s: by %s", run->job.name, row->name);
    outcome->status = displace(run, parameter, row, &at);
    if (!moray_failed(outcome->status))
        outcome->status =
            measure(run, deal->slopes, &at, sensitivity_parameter_is_limit(parameter), row, &outcome->reached);
    for (int k = 0; k < SIDES; k++)
        moray_gait_problem_free(at.problem[k]);
}

static moray_status take(sensitivity *run, const struct outcome *outcome)
{
    const moray_status *status = &outcome->status;
    if (!moray_failed(*status) && outcome->reached)
        run->row[run->rows++] = outcome->row;
    else if (!moray_failed(*status))
        note(run->unreached, outcome->row.name);
    if (status->code != MORAY_NUMERIC && status->code != MORAY_INPUT)
        return *status;
    char why[sizeof outcome->row.name + sizeof status->text + 3];
    snprintf(why, sizeof why, "%.39s (%s)", outcome->row.name, status->text);
    note(run->left_out, why);
    return moray_ok();
}

static moray_status by_parameters(sensitivity *run, struct deal *deal)
{
    struct outcome outcome[SENSITIVITY_ROWS];
    MORAY_TRY(moray_parallel(deal->n, sizeof *outcome, outcome, by_parameter, deal, run->job.jobs));
    for (int k = 0; k < deal->n; k++)
        MORAY_TRY(take(run, &outcome[k]));
    return moray_ok();
}

// ---- All -----------------------------------------------------------------------------------------------------------

// By what the quantities are measured: themselves, but for those that may be 0.
static void fill_sizes(sensitivity *run)
{
    const stage *best = last_stage(&run->job);
    moray_gait amplitude = {.offset = best->prediction.gait.amplitude};
    double offset[SLOPES];
    prediction_values(&run->job, &best->prediction, run->size);
    sensitivity_values(&run->job, &amplitude, 0, 0, offset);
    run->size[SLOPE_OFFSET] = offset[SLOPE_OFFSET];
    run->size[SLOPE_TAPER] = 1;
}

// Solves more tightly, so that what is active stands out from what is only near.
static moray_status polish(sensitivity *run)
{
    stage *best = &run->job.stage[run->job.snake.model];
    moray_solution *solution;
    MORAY_TRY(sensitivity_solve(run, best->problem, best->solution, &solution));
    if (!sensitivity_solved(solution)) {
        moray_solution_free(solution);
        return moray_ok();
    }
    moray_solution_free(best->solution);
    best->solution = solution;
    best->prediction = moray_gait_problem_prediction(best->problem, solution);
    return gait_job_certify(&run->job, best);
}

static moray_status take_all(sensitivity *run, moray_sensitivity *slopes)
{
    const sensitivity_parameter *parameter;
    struct deal deal = {.run = run, .slopes = slopes};
    note(run->weak, moray_sensitivity_weak(slopes));
    for (int k = 0; (parameter = sensitivity_parameter_at(k)) && deal.n < SENSITIVITY_ROWS; k++)
        if (sensitivity_parameter_applies(parameter, &run->job))
            deal.parameter[deal.n++] = parameter;
        else if (sensitivity_parameter_of_each(parameter, &run->job))
            note(run->left_out, "length_m (the links have lengths of their own)");
    MORAY_TRY(by_parameters(run, &deal));
    return sensitivity_predict(run, slopes);
}

moray_status sensitivity_run(sensitivity *run)
{
    moray_sensitivity *slopes;
    MORAY_TRY(polish(run));
    MORAY_TRY(moray_sensitivity_new(&slopes, last_stage(&run->job)->solution));
    fill_sizes(run);
    const moray_status status = take_all(run, slopes);
    moray_sensitivity_free(slopes);
    return status;
}
