// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "max_speed.h"

static const char *const model_names[] = {"control-oriented", "first-principles"};

// ---- In words ------------------------------------------------------------------------------------------------------

// What the model that was optimised on says of the gain, at the powers found (equal where the limit is the paper's).
static double promised_percent(const max_speed *run)
{
    return 100 * (run->promise.speed / run->paper.steady[run->common.model].speed - 1);
}

static void verdict(const max_speed *run, char *text, size_t size)
{
    const double gain = run->gain.speed_percent_at_equal_power, promised = promised_percent(run);
    const double power = run->paper.steady[MORAY_FIRST_PRINCIPLES].power;
    if (isnan(gain)) {
        snprintf(text, size, "No verdict at equal power on the first-principles model: %.250s",
                 run->gain.why_no_speed.text);
        return;
    }
    const char *outcome = gain < -0.05  ? "The optimised gait LOSES"
                          : gain > 0.05 ? "The optimised gait wins"
                                        : "The optimised gait neither wins nor loses";
    snprintf(text, size,
             "%s on the first-principles model: at the paper gait's power there (%.4f W) it is %.2f %% %s than the "
             "paper's. (The %s model, on which it was optimised, promises %+.2f %% at %.4f W against %.4f W.)",
             outcome, power, fabs(gain), gain < 0 ? "slower" : "faster", model_names[run->common.model], promised,
             run->promise.power, run->paper.steady[run->common.model].power);
}

// ---- Tables --------------------------------------------------------------------------------------------------------

enum { tables = 3 };

struct tables {
    moray_table table[tables];
    moray_table_row rows[tables][MORAY_TRIAL_ROWS];
};

static void make_tables(const max_speed *run, struct tables *t)
{
    const moray_gait_trial *const trials[] = {&run->paper, &run->best};
    const int rows[tables] = {
        moray_gait_rows(&run->common.robot, trials, 2, t->rows[0]),
        moray_steady_rows(MORAY_CONTROL_ORIENTED, trials, 2, run->common.course, t->rows[1]),
        moray_steady_rows(MORAY_FIRST_PRINCIPLES, trials, 2, run->common.course, t->rows[2]),
    };
    const char *const titles[tables] = {"Gait", "Simulated, control-oriented model",
                                        "Simulated, first-principles model"};
    for (int k = 0; k < tables; k++)
        t->table[k] = (moray_table){.title = titles[k],
                                    .columns = {"paper's", "optimised"},
                                    .n_columns = 2,
                                    .rows = t->rows[k],
                                    .n_rows = rows[k]};
}

static void print_tables(const max_speed *run)
{
    char text[600];
    struct tables t;
    printf(
        "%d links, current (%g, %g) m/s, course %g deg; optimised on the %s model with a mean joint power of at most "
        "%.4g W\n\n",
        run->common.robot.links, run->common.current[0], run->common.current[1], run->common.course / DEG,
        model_names[run->common.model], run->power);
    make_tables(run, &t);
    for (int k = 0; k < tables; k++) {
        moray_table_print(&t.table[k], stdout);
        printf("\n");
    }
    verdict(run, text, sizeof text);
    printf("%s\n", text);
    if (!isnan(run->gain.power_percent_at_equal_speed))
        printf("At the paper gait's speed there it needs %+.2f %% power.\n", run->gain.power_percent_at_equal_speed);
    if (run->starts > 1)
        printf("%d of %d starts ended at this optimum, none at a better one.\n", run->agreeing, run->starts);
    printf("\n");
    moray_solver_line(run->solution, run->common.scheme, run->common.intervals, text, sizeof text);
    printf("%s\n", text);
    moray_certificate_line(&run->certificate, text, sizeof text);
    printf("%s\n", text);
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
    moray_json_number(json, "power_limit_W", run->power);
}

static void json_promise(moray_json *json, const max_speed *run)
{
    const moray_gait_promise *promise = &run->promise;
    moray_json_open(json, "predicted");
    moray_json_number(json, "speed_m_s", promise->speed);
    moray_json_number(json, "course_speed_m_s", promise->course_speed);
    moray_json_number(json, "power_W", promise->power);
    moray_json_number(json, "cost_of_transport_J_m", promise->power / promise->speed);
    moray_json_close(json);
}

static void json_gain(moray_json *json, const max_speed *run)
{
    moray_json_open(json, "gain");
    moray_json_number(json, "speed_percent_at_equal_power", run->gain.speed_percent_at_equal_power);
    moray_json_number(json, "power_percent_at_equal_speed", run->gain.power_percent_at_equal_speed);
    moray_json_close(json);
}

static void json_solver(moray_json *json, const max_speed *run)
{
    moray_solver_to_json(json, run->solution);
    moray_json_number(json, "starts", run->starts);
    moray_json_number(json, "starts_at_optimum", run->agreeing);
    moray_json_close(json);
    moray_certificate_to_json(json, &run->certificate);
}

static moray_json *make_json(const max_speed *run)
{
    moray_json *json = moray_json_new();
    json_head(json, run);
    moray_gait_to_json(json, "gait", &run->common.robot, run->best.gait);
    json_promise(json, run);
    moray_steady_to_json(json, "simulated_control", MORAY_CONTROL_ORIENTED, &run->best, run->common.course);
    moray_steady_to_json(json, "validated", MORAY_FIRST_PRINCIPLES, &run->best, run->common.course);
    moray_json_open(json, "baseline");
    moray_gait_to_json(json, "gait", &run->common.robot, run->paper.gait);
    moray_steady_to_json(json, "predicted", MORAY_CONTROL_ORIENTED, &run->paper, run->common.course);
    moray_steady_to_json(json, "validated", MORAY_FIRST_PRINCIPLES, &run->paper, run->common.course);
    moray_json_close(json);
    json_gain(json, run);
    json_solver(json, run);
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
    moray_solution_times(run->solution, 0, &t0, &tf);
    for (int k = 0; k < samples && !moray_failed(status); k++) {
        double *row = data + k * width;
        row[0] = t0 + (tf - t0) * k / (samples - 1);
        moray_solution_at(run->solution, 0, row[0], x, NULL);
        memcpy(row + 1, x + full, 3 * sizeof *row);
        memcpy(row + 4, x + states - 3, 3 * sizeof *row);
        moray_gait_reference(&run->promise.gait, joints, row[0], phi, phi + joints, phi + 2 * joints);
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

// Speed along the course from rest, both gaits on both models: what the reader wants to see of the proof.
static moray_status draw_start(const max_speed *run, moray_output *output)
{
    enum { points = 301 };
    const double horizon = 30;
    static double time[points], speed[4][points];
    const char *const labels[] = {"paper's gait, control-oriented", "optimised, control-oriented",
                                  "paper's gait, first-principles", "optimised, first-principles"};
    moray_curve curves[4];
    for (int k = 0; k < 4; k++) {
        const moray_gait_trial *trial = k % 2 ? &run->best : &run->paper;
        MORAY_TRY(moray_gait_trial_speeds(&run->basin, trial, (moray_model)(k / 2), horizon, points, time, speed[k]));
        curves[k] = (moray_curve){.label = labels[k], .x = time, .y = speed[k], .n = points};
    }
    const moray_figure figure = {.name = "start",
                                 .title = "From rest: speed along the course, mean over the last period",
                                 .x_label = "time [s]",
                                 .y_label = "speed along the course [m/s]",
                                 .curves = curves,
                                 .n_curves = 4};
    return moray_output_figure(output, &figure);
}

static moray_status write_files(const max_speed *run, const moray_json *json)
{
    moray_output *output = run->common.output;
    char text[600];
    struct tables t;
    FILE *file;
    MORAY_TRY(moray_output_file(output, "summary.json", &file));
    MORAY_TRY(moray_json_write(json, file));
    MORAY_TRY(write_trajectory(run, output));
    moray_status figure = draw_start(run, output);
    if (moray_failed(figure) && !run->common.quiet)
        fprintf(stderr, "max_speed: no figure: %s\n", figure.text);
    verdict(run, text, sizeof text);
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
