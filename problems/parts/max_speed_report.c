// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "max_speed.h"

static const char *const model_names[] = {"control-oriented", "first-principles"};

// ---- In words ------------------------------------------------------------------------------------------------------

enum { text_size = 1000 };

static double percent(double value, double reference)
{
    return 100 * (value / reference - 1);
}

// The gain on the first-principles model at equal power, and beside it what the model of the stage promises.
static void verdict(const max_speed *run, const stage *at, char *text)
{
    const double gain = at->gain.speed_percent_at_equal_power;
    const moray_steady *here = &run->paper.steady[at->model], *there = &run->paper.steady[MORAY_FIRST_PRINCIPLES];
    if (isnan(gain)) {
        snprintf(text, text_size, "The %s optimum: no comparison at equal power on the first-principles model: %.250s",
                 model_names[at->model], at->gain.why_no_speed.text);
        return;
    }
    const char *outcome = gain < -0.05 ? "LOSES" : gain > 0.05 ? "wins" : "neither wins nor loses";
    int used = snprintf(text, text_size,
                        "The %s optimum %s on the first-principles model: at the paper gait's power there (%.4f W) it "
                        "is %.2f %% %s than the paper's gait",
                        model_names[at->model], outcome, there->power, fabs(gain), gain < 0 ? "slower" : "faster");
    if (!isnan(at->gain.power_percent_at_equal_speed))
        used += snprintf(text + used, (size_t)(text_size - used), ", at its speed (%.4f m/s) it needs %.2f %% %s power",
                         there->speed, fabs(at->gain.power_percent_at_equal_speed),
                         at->gain.power_percent_at_equal_speed < 0 ? "less" : "more");
    snprintf(text + used, (size_t)(text_size - used),
             ". The %s model itself promised %+.2f %% speed for %+.2f %% power.", model_names[at->model],
             percent(at->promise.speed, here->speed), percent(at->promise.power, here->power));
}

static void solver_line(const max_speed *run, const stage *at, char *text)
{
    const moray_nlp_info *info = moray_solution_info(at->solution);
    const moray_nlp_size n = moray_solution_size(at->solution);
    const moray_certificate *c = &at->certificate;
    snprintf(text, text_size,
             "%s: %s, %d intervals, %d variables, %s in %d iterations, %.2f s (%d of %d starts end here, none better); "
             "certificate: %s (KKT %.1e, mesh error "
             "%.1e, between nodes %.1e, re-simulation %.1e)",
             model_names[at->model], run->common.scheme, run->common.intervals, n.variables,
             moray_nlp_outcome_text(info->outcome), info->iterations, info->seconds, at->agreeing, at->starts,
             c->pass ? "pass" : "FAIL", c->kkt, c->mesh_error, c->between_nodes, c->resimulation);
}

// ---- Tables --------------------------------------------------------------------------------------------------------

enum { tables = 3 };

struct tables {
    moray_table table[tables];
    moray_table_row rows[tables][MORAY_TRIAL_ROWS];
};

static void make_tables(const max_speed *run, struct tables *t)
{
    const moray_gait_trial *const trials[] = {&run->paper, &run->stage[0].trial, &run->stage[1].trial};
    const int columns = 2 + (int)run->common.model;
    const double course = run->common.course;
    const int rows[tables] = {
        moray_gait_rows(&run->common.robot, trials, columns, t->rows[0]),
        moray_steady_rows(MORAY_CONTROL_ORIENTED, trials, columns, course, t->rows[1]),
        moray_steady_rows(MORAY_FIRST_PRINCIPLES, trials, columns, course, t->rows[2]),
    };
    const char *const titles[tables] = {"Gait", "Swum on the control-oriented model",
                                        "Swum on the first-principles model"};
    for (int k = 0; k < tables; k++)
        t->table[k] = (moray_table){.title = titles[k],
                                    .columns = {"paper's", "control opt.", "first-pr. opt."},
                                    .n_columns = columns,
                                    .rows = t->rows[k],
                                    .n_rows = rows[k]};
}

static void print_tables(const max_speed *run)
{
    char text[text_size];
    struct tables t;
    printf("%d links, current (%g, %g) m/s, course %g deg; mean joint power at most", run->common.robot.links,
           run->common.current[0], run->common.current[1], run->common.course / DEG);
    for (int model = 0; model <= (int)run->common.model; model++)
        printf("%s %.4g W (%s model)", model ? " and" : "", run->stage[model].power, model_names[model]);
    printf("\n\n");
    make_tables(run, &t);
    for (int k = 0; k < tables; k++) {
        moray_table_print(&t.table[k], stdout);
        printf("\n");
    }
    for (int model = 0; model <= (int)run->common.model; model++) {
        verdict(run, &run->stage[model], text);
        printf("%s\n\n", text);
    }
    for (int model = 0; model <= (int)run->common.model; model++) {
        solver_line(run, &run->stage[model], text);
        printf("%s\n", text);
    }
}

// ---- JSON ----------------------------------------------------------------------------------------------------------

static void json_head(moray_json *json, const max_speed *run)
{
    moray_json_text(json, "problem", "max_speed");
    moray_json_text(json, "version", moray_version());
    moray_json_text(json, "model", run->common.model == MORAY_CONTROL_ORIENTED ? "control" : "complex");
    moray_json_open(json, "robot");
    moray_json_number(json, "links", run->common.robot.links);
    moray_json_close(json);
    moray_json_numbers(json, "current_m_s", run->common.current, 2);
    moray_json_number(json, "course_deg", run->common.course / DEG);
    moray_json_text(json, "scheme", run->common.scheme);
    moray_json_number(json, "intervals", run->common.intervals);
}

static void json_promise(moray_json *json, const stage *at)
{
    const moray_gait_promise *promise = &at->promise;
    moray_json_open(json, "predicted");
    moray_json_number(json, "speed_m_s", promise->speed);
    moray_json_number(json, "course_speed_m_s", promise->course_speed);
    moray_json_number(json, "power_W", promise->power);
    moray_json_number(json, "cost_of_transport_J_m", promise->power / promise->speed);
    moray_json_close(json);
}

static void json_gain(moray_json *json, const moray_gait_gain *gain)
{
    moray_json_open(json, "gain");
    moray_json_number(json, "speed_percent_at_equal_power", gain->speed_percent_at_equal_power);
    moray_json_number(json, "power_percent_at_equal_speed", gain->power_percent_at_equal_speed);
    moray_json_close(json);
}

static void json_solver(moray_json *json, const stage *at)
{
    const moray_nlp_info *info = moray_solution_info(at->solution);
    const moray_nlp_size size = moray_solution_size(at->solution);
    const moray_certificate *c = &at->certificate;
    moray_json_open(json, "solver");
    moray_json_text(json, "status", moray_nlp_outcome_text(info->outcome));
    moray_json_number(json, "iterations", info->iterations);
    moray_json_number(json, "objective", moray_solution_objective(at->solution));
    moray_json_number(json, "nvar", size.variables);
    moray_json_number(json, "ncon", size.constraints);
    moray_json_number(json, "nnz_jac", size.nnz_jac);
    moray_json_number(json, "nnz_hess", size.nnz_hess);
    moray_json_number(json, "time_s", info->seconds);
    moray_json_number(json, "eval_time_s", info->evaluation_seconds);
    moray_json_text(json, "linear_solver", "mumps");
    moray_json_number(json, "starts", at->starts);
    moray_json_number(json, "starts_at_optimum", at->agreeing);
    moray_json_close(json);
    moray_json_open(json, "certificate");
    moray_json_bool(json, "pass", c->pass);
    moray_json_number(json, "kkt", c->kkt);
    moray_json_number(json, "mesh_error", c->mesh_error);
    moray_json_number(json, "between_nodes", c->between_nodes);
    moray_json_number(json, "resimulation", c->resimulation);
    moray_json_close(json);
}

static void json_stage(moray_json *json, const max_speed *run, const stage *at)
{
    moray_json_number(json, "power_limit_W", at->power);
    moray_gait_to_json(json, "gait", &run->common.robot, at->trial.gait);
    json_promise(json, at);
    moray_steady_to_json(json, "simulated_control", MORAY_CONTROL_ORIENTED, &at->trial, run->common.course);
    moray_steady_to_json(json, "validated", MORAY_FIRST_PRINCIPLES, &at->trial, run->common.course);
    json_gain(json, &at->gain);
    json_solver(json, at);
}

static moray_json *make_json(const max_speed *run)
{
    moray_json *json = moray_json_new();
    json_head(json, run);
    json_stage(json, run, last_stage(run));
    moray_json_open(json, "baseline");
    moray_gait_to_json(json, "gait", &run->common.robot, run->paper.gait);
    moray_steady_to_json(json, "predicted", MORAY_CONTROL_ORIENTED, &run->paper, run->common.course);
    moray_steady_to_json(json, "validated", MORAY_FIRST_PRINCIPLES, &run->paper, run->common.course);
    moray_json_close(json);
    if (run->common.model == MORAY_FIRST_PRINCIPLES) {
        moray_json_open(json, "control_oriented_optimum");
        json_stage(json, run, &run->stage[MORAY_CONTROL_ORIENTED]);
        moray_json_close(json);
    }
    return json;
}

// ---- Files ---------------------------------------------------------------------------------------------------------

enum { samples = 201 };

// The optimal orbit over one period: time, states, joint coordinates of (25).
static moray_status write_trajectory(const max_speed *run, moray_output *output)
{
    const bool control = run->common.model == MORAY_CONTROL_ORIENTED;
    const char *const names[2][6] = {{"theta", "p_x", "p_y", "v_theta", "v_t", "v_n"},
                                     {"theta", "p_x", "p_y", "v_theta", "v_x", "v_y"}};
    const char *const units[] = {"rad", "m", "m", "rad/s", "m/s", "m/s"};
    const int joints = run->common.robot.links - 1, full = run->joints == MORAY_JOINTS_ON_GAIT ? 0 : joints;
    const int width = 1 + 6 + joints, states = 6 + 2 * full;
    FILE *file;
    MORAY_TRY(moray_output_file(output, "trajectory.csv", &file));
    double *data = calloc((size_t)(samples * width + states + 3 * joints), sizeof *data);
    moray_column *columns = calloc((size_t)width, sizeof *columns);
    char(*joint_names)[16] = calloc((size_t)joints, sizeof *joint_names);
    moray_status status = data && columns && joint_names ? moray_ok() : moray_error(MORAY_MEMORY, "no memory");
    double t0, tf, *x = data + samples * width, *phi = x + states;
    moray_solution_times(last_stage(run)->solution, 0, &t0, &tf);
    for (int k = 0; k < samples && !moray_failed(status); k++) {
        double *row = data + k * width;
        row[0] = t0 + (tf - t0) * k / (samples - 1);
        moray_solution_at(last_stage(run)->solution, 0, row[0], x, NULL);
        memcpy(row + 1, x + full, 3 * sizeof *row);
        memcpy(row + 4, x + states - 3, 3 * sizeof *row);
        moray_gait_reference(&last_stage(run)->promise.gait, joints, row[0], phi, phi + joints, phi + 2 * joints);
        memcpy(row + 7, phi, (size_t)joints * sizeof *row);
    }
    for (int j = 0; j < width && !moray_failed(status); j++) {
        if (j > 6)
            snprintf(joint_names[j - 7], sizeof *joint_names, "phi_%d", j - 6);
        columns[j] = (moray_column){.name = j == 0   ? "t"
                                            : j <= 6 ? names[!control][j - 1]
                                                     : joint_names[j - 7],
                                    .unit = j == 0    ? "s"
                                            : j <= 6  ? units[j - 1]
                                            : control ? "m"
                                                      : "rad",
                                    .values = data + j,
                                    .stride = width};
    }
    if (!moray_failed(status))
        moray_csv_write(file, columns, width, samples);
    free(joint_names);
    free(columns);
    free(data);
    return status;
}

// Speed along the course from rest, every gait on both models: what the reader wants to see of the proof.
static moray_status draw_start(const max_speed *run, moray_output *output)
{
    enum { points = 301, most = 6 };
    const double horizon = 15;
    const char *const labels[most] = {
        "paper's gait, control-oriented model",      "control optimum, control-oriented model",
        "first-pr. optimum, control-oriented model", "paper's gait, first-principles model",
        "control optimum, first-principles model",   "first-pr. optimum, first-principles model"};
    const int gaits = 2 + (int)run->common.model;
    const moray_gait_trial *const trials[] = {&run->paper, &run->stage[0].trial, &run->stage[1].trial};
    double *data = calloc((most + 1) * points, sizeof *data), *time = data + most * points;
    moray_curve curves[most];
    moray_status status = data ? moray_ok() : moray_error(MORAY_MEMORY, "no memory for a figure");
    int n = 0;
    for (int model = 0; model < 2; model++)
        for (int k = 0; k < gaits && !moray_failed(status); k++, n++) {
            double *speed = data + n * points;
            status = moray_gait_trial_speeds(&run->basin, trials[k], (moray_model)model, horizon, points, time, speed);
            curves[n] = (moray_curve){.label = labels[3 * model + k], .x = time, .y = speed, .n = points};
        }
    const moray_figure figure = {.name = "start",
                                 .title = "From rest: speed along the course, mean over the last period",
                                 .x_label = "time [s]",
                                 .y_label = "speed along the course [m/s]",
                                 .curves = curves,
                                 .n_curves = n};
    if (!moray_failed(status))
        status = moray_output_figure(output, &figure);
    free(data);
    return status;
}

static moray_status write_files(const max_speed *run, const moray_json *json)
{
    moray_output *output = run->common.output;
    char text[text_size];
    struct tables t;
    FILE *file;
    MORAY_TRY(moray_output_file(output, "summary.json", &file));
    MORAY_TRY(moray_json_write(json, file));
    MORAY_TRY(write_trajectory(run, output));
    moray_status figure = draw_start(run, output);
    if (moray_failed(figure) && !run->common.quiet)
        fprintf(stderr, "max_speed: no figure: %s\n", figure.text);
    verdict(run, last_stage(run), text);
    make_tables(run, &t);
    const moray_report report = {.title = "max_speed",
                                 .text = text,
                                 .tables = t.table,
                                 .n_tables = tables,
                                 .argc = run->common.argc,
                                 .argv = run->common.argv};
    MORAY_TRY(moray_output_report(output, &report));
    return moray_output_commit(output);
}

moray_status max_speed_report(max_speed *run)
{
    moray_json *json = make_json(run);
    moray_status status = run->common.output ? write_files(run, json) : moray_ok();
    if (!moray_failed(status) && run->common.json)
        status = moray_json_write(json, stdout);
    else if (!moray_failed(status))
        print_tables(run);
    moray_json_free(json);
    return status;
}
