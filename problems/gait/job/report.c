// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "job.h"

// ---- In words ------------------------------------------------------------------------------------------------------

enum { text_size = GAIT_TEXT };

static double percent(double value, double reference)
{
    const double change = 100 * (value / reference - 1);
    return fabs(change) < 0.005 ? 0 : change; // no -0.00
}

const char *gait_job_kind(const gait_job *job, const stage *at)
{
    if (at == &job->ladder)
        return "gait optimised for the ladder";
    return at->model == MORAY_CONTROL_ORIENTED ? "control-oriented optimum" : "first-principles optimum";
}

static bool beyond(const gait_job *job, double omega)
{
    const double rounding = 1e-3;
    return omega > job->omega[1] * (1 + rounding) || omega < job->omega[0] * (1 - rounding);
}

void gait_job_say_beyond(const gait_job *job, double omega, char *text, size_t size)
{
    if (beyond(job, omega))
        moray_text_add(text, size, " (at omega = %.4g deg/s, beyond the %.4g to %.4g allowed)", omega / DEG,
                       job->omega[0] / DEG, job->omega[1] / DEG);
}

void gait_job_verdict(const gait_job *job, const stage *at, char *text, size_t size)
{
    int further = 0;
    moray_ladder_verdict(at->ladder, at->found_on, text, size);
    for (int k = 0; k < MORAY_RUNGS; k++)
        further += beyond(job, at->ladder[k].omega);
    if (further > 0)
        moray_text_add(text, size, "; equal power takes an omega beyond the %.4g to %.4g deg/s allowed on %d of them",
                       job->omega[0] / DEG, job->omega[1] / DEG, further);
}

// "at the paper gait's power there (0.2646 W) it is 4.03 % faster" and "at its speed ... it needs 7.65 % less power",
// the first with "than the paper's gait" behind it.
static void say_gain(const gait_job *job, const moray_gait_gain *gain, bool speed, bool first, char *text)
{
    const moray_steady *there = &job->paper.steady[MORAY_FIRST_PRINCIPLES];
    const char *whose = first ? "the paper gait's" : "its", *than = first ? " than the paper's gait" : "";
    const double faster = gain->speed_percent_at_equal_power, more = gain->power_percent_at_equal_speed;
    if (speed)
        moray_text_add(text, text_size, "at %s power%s (%.4f W) it is %.2f %% %s%s", whose, first ? " there" : "",
                       there->power, fabs(faster), faster < 0 ? "slower" : "faster", than);
    else
        moray_text_add(text, text_size, "at %s speed%s (%.4f m/s) it needs %.2f %% %s power%s", whose,
                       first ? " there" : "", there->speed, fabs(more), more < 0 ? "less" : "more", than);
    gait_job_say_beyond(job, speed ? gain->omega_at_equal_power : gain->omega_at_equal_speed, text, text_size);
}

// The gain on the first-principles model, first that which the goal is about, and beside it what the model of the stage
// predicts.
static void judge(const gait_job *job, const stage *at, char *text)
{
    const bool fastest = job->goal == MORAY_GAIT_FASTEST;
    const double faster = at->gain.speed_percent_at_equal_power, less = -at->gain.power_percent_at_equal_speed;
    const double gain = fastest ? faster : less, other = fastest ? less : faster;
    const moray_steady *here = &job->paper.steady[at->model];
    if (isnan(gain)) {
        moray_text_add(text, text_size, "no comparison at equal %s on the first-principles model: %.250s",
                       fastest ? "power" : "speed", fastest ? at->gain.why_no_speed.text : at->gain.why_no_power.text);
        return;
    }
    moray_text_add(text, text_size, "%s on the first-principles model: ",
                   gain < -0.05  ? "LOSES"
                   : gain > 0.05 ? "wins"
                                 : "neither wins nor loses");
    say_gain(job, &at->gain, fastest, true, text);
    if (!isnan(other)) {
        moray_text_add(text, text_size, ", ");
        say_gain(job, &at->gain, !fastest, false, text);
    }
    moray_text_add(text, text_size, ". The %s model itself predicted %+.2f %% speed for %+.2f %% power",
                   moray_model_name(at->model), percent(at->prediction.speed, here->speed),
                   percent(at->prediction.power, here->power));
}

void gait_job_headline(const gait_job *job, char *text)
{
    const double nothing = 5e-4;
    const stage *at = recommended(job);
    const moray_gait *gait = &at->trial.gait[MORAY_FIRST_PRINCIPLES];
    const double theta_max =
        moray_theta_max_from_amplitude(&job->snake.robot, MORAY_FIRST_PRINCIPLES, gait->amplitude, gait->delta);
    char baseline[64];
    moray_text_add(
        text, text_size,
        "Recommended: the %s, theta_max %.4g deg, delta %.4g deg, omega %.4g deg/s. In speed at the power of "
        "%s it ",
        gait_job_kind(job, at), theta_max / DEG, gait->delta / DEG, gait->omega / DEG,
        gait_job_baseline(job, baseline));
    gait_job_verdict(job, at, text, text_size);
    moray_text_add(text, text_size, ".");
    if (at == &job->ladder && moray_gait_over_gain(at->solution) < nothing)
        moray_text_add(text, text_size, " No gait was found that gains on all of %.100s.", job->over);
}

void gait_job_say_stage(const gait_job *job, const stage *at, char *text)
{
    text[0] = 0;
    moray_text_add(text, text_size, "The %s ", gait_job_kind(job, at));
    gait_job_verdict(job, at, text, text_size);
    moray_text_add(text, text_size, "; ");
    judge(job, at, text);
    moray_text_add(text, text_size, ".");
}

// ---- Tables --------------------------------------------------------------------------------------------------------

enum { tables = 4, columns_most = 1 + GAIT_STAGES };

struct tables {
    moray_table table[tables];
    moray_table_row rows[tables][MORAY_RUNGS];
};
_Static_assert((int)MORAY_RUNGS >= (int)MORAY_TRIAL_ROWS, "room for every table");

static const char *column_of(const gait_job *job, const stage *at)
{
    if (at == &job->ladder)
        return "ladder opt.";
    return at->model == MORAY_CONTROL_ORIENTED ? "control opt." : "first-pr. opt.";
}

// The paper's gait and those found.
static int make_columns(const gait_job *job, const moray_gait_trial *trials[columns_most],
                        const moray_ladder_row *ladders[columns_most], const char *names[columns_most])
{
    const stage *at[GAIT_STAGES];
    const int n = gait_job_stages(job, at);
    trials[0] = &job->paper;
    names[0] = "paper's";
    for (int k = 0; k < n; k++) {
        trials[k + 1] = &at[k]->trial;
        ladders[k] = at[k]->ladder;
        names[k + 1] = column_of(job, at[k]);
    }
    return n + 1;
}

static void make_tables(const gait_job *job, struct tables *t)
{
    const moray_gait_trial *trials[columns_most];
    const moray_ladder_row *ladders[columns_most];
    const char *names[columns_most];
    const int columns = make_columns(job, trials, ladders, names);
    const double course = job->snake.course;
    const int rows[tables] = {
        moray_gait_rows(&job->snake.robot, trials, columns, t->rows[0]),
        moray_steady_rows(&job->snake.robot, MORAY_CONTROL_ORIENTED, trials, columns, course, t->rows[1]),
        moray_steady_rows(&job->snake.robot, MORAY_FIRST_PRINCIPLES, trials, columns, course, t->rows[2]),
        moray_ladder_rows(ladders, columns - 1, t->rows[3]),
    };
    const char *const titles[tables] = {"Gait", "Swum on the control-oriented model",
                                        "Swum on the first-principles model",
                                        "Gain in speed at the power of the paper's gait, on the ladder of models"};
    for (int k = 0; k < tables; k++) {
        const int first = k == tables - 1;
        t->table[k] =
            (moray_table){.title = titles[k], .n_columns = columns - first, .rows = t->rows[k], .n_rows = rows[k]};
        for (int c = 0; c < columns - first; c++)
            t->table[k].columns[c] = names[c + first];
    }
}

// "; WHAT 1 UNIT (control-oriented model) and 2 UNIT (first-principles model)", by model
static void print_demand(const gait_job *job, const char *what, const double by[2], const char *unit)
{
    const char *before = "; ";
    for (int model = 0; model <= (int)job->snake.model; model++) {
        if (job->stage[model].left_out)
            continue;
        printf("%s%s%.4g %s (%s model)", before, what, by[model], unit, moray_model_name((moray_model)model));
        before = " and ";
        what = "";
    }
}

void gait_job_print_head(const gait_job *job)
{
    const moray_snake_options *snake = &job->snake;
    char links[MORAY_LINKS_TEXT];
    printf("%s, current (%g, %g) m/s, course %g deg", moray_snake_links_text(&snake->robot, links), snake->current[0],
           snake->current[1], snake->course / DEG);
}

static void print_demands(const gait_job *job)
{
    const stage *asked = last_stage(job), *control = &job->stage[MORAY_CONTROL_ORIENTED];
    gait_job_print_head(job);
    if (isfinite(asked->power))
        print_demand(job, job->snake.robot.motor.fitted ? "mean power at most " : "mean joint power at most ",
                     (double[]){control->power, asked->power}, "W");
    if (asked->speed > 0)
        print_demand(job, "speed along the course at least ", (double[]){control->speed, asked->speed}, "m/s");
    printf("\n\n");
}

static void print_left_out(const gait_job *job)
{
    const stage *const all[GAIT_STAGES] = {&job->stage[0], &job->stage[1], &job->ladder};
    char baseline[64];
    for (int model = 0; model < 2; model++)
        if (moray_failed(job->no_paper[model]))
            printf("Left out as a baseline on the %s model: %s: %s\n\n", moray_model_name(model),
                   gait_job_baseline(job, baseline), job->no_paper[model].text);
    for (int k = 0; k < GAIT_STAGES; k++)
        if (all[k]->left_out)
            printf("Left out: the %s: %s\n\n", gait_job_kind(job, all[k]), all[k]->why.text);
}

// What the gait for several gains on each, at the power of the baseline there.
static void print_scenarios(const gait_job *job)
{
    const scenarios *over = &job->scenarios;
    for (int k = 0; k < over->n; k++)
        printf("%s %+.2f %% on %s", k == 0 ? "The gait optimised for the ladder gains, where it was optimised," : ",",
               100 * over->at[k].gain, over->at[k].name);
    printf("\n\n");
}

static void print_solver(const gait_job *job, const stage *at)
{
    char text[text_size];
    moray_solver_line(at->solution, job->common.scheme, job->common.intervals, text, text_size);
    if (at == &job->ladder)
        printf("%s together, %s", job->over, text);
    else
        printf("%s model, %s", moray_model_name(at->model), text);
    printf("; %d of %d starts end here, none better\n", at->agreeing, at->starts);
    moray_certificate_line(&at->certificate, text, text_size);
    printf("    %s\n", text);
}

static void print(const void *found, const moray_report *report)
{
    const gait_job *job = found;
    const stage *at[GAIT_STAGES];
    const int n = gait_job_stages(job, at);
    char text[text_size] = "";
    print_demands(job);
    moray_tables_print(report->tables, report->n_tables, stdout);
    for (int k = 0; k < n; k++) {
        gait_job_say_stage(job, at[k], text);
        printf("%s\n\n", text);
    }
    print_left_out(job);
    if (recommended(job) == &job->ladder)
        print_scenarios(job);
    text[0] = 0;
    gait_job_headline(job, text);
    printf("%s\n\n", text);
    for (int k = 0; k < n; k++)
        print_solver(job, at[k]);
}

// ---- Files ---------------------------------------------------------------------------------------------------------

enum { samples = 201 };

// The optimal orbit over one period: time, states, joint coordinates of (25).
moray_status gait_job_trajectory(const gait_job *job, const stage *at, moray_output *output)
{
    const bool control = at->model == MORAY_CONTROL_ORIENTED;
    const char *const names[2][6] = {{"theta", "p_x", "p_y", "v_theta", "v_t", "v_n"},
                                     {"theta", "p_x", "p_y", "v_theta", "v_x", "v_y"}};
    const char *const units[] = {"rad", "m", "m", "rad/s", "m/s", "m/s"};
    const int joints = job->snake.robot.links - 1, full = job->joints == MORAY_JOINTS_ON_GAIT ? 0 : joints;
    const int width = 1 + 6 + joints, states = 6 + 2 * full;
    FILE *file;
    MORAY_TRY(moray_output_file(output, "trajectory.csv", &file));
    double *data = calloc((size_t)(samples * width + states + 3 * joints), sizeof *data);
    moray_column *columns = calloc((size_t)width, sizeof *columns);
    char(*joint_names)[16] = calloc((size_t)joints, sizeof *joint_names);
    moray_status status = data && columns && joint_names ? moray_ok() : moray_error(MORAY_MEMORY, "no memory");
    double t0, tf, *x = data ? data + samples * width : NULL, *phi = data ? x + states : NULL;
    moray_solution_times(at->solution, at->phase, &t0, &tf);
    for (int k = 0; k < samples && !moray_failed(status); k++) {
        double *row = data + k * width;
        row[0] = t0 + (tf - t0) * k / (samples - 1);
        moray_solution_at(at->solution, at->phase, row[0], x, NULL);
        memcpy(row + 1, x + full, 3 * sizeof *row);
        memcpy(row + 4, x + states - 3, 3 * sizeof *row);
        moray_gait_reference(&at->prediction.gait, joints, row[0], phi, phi + joints, phi + 2 * joints);
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
static moray_status draw_start(const void *found, moray_output *output)
{
    const gait_job *job = found;
    enum { points = 301, most = 2 * columns_most };
    const double horizon = 15;
    const moray_gait_trial *trials[columns_most];
    const moray_ladder_row *ladders[columns_most];
    const char *names[columns_most];
    const int gaits = make_columns(job, trials, ladders, names);
    char labels[most][64];
    double *data = calloc((most + 1) * points, sizeof *data), *time = data ? data + most * points : NULL;
    moray_curve curves[most];
    moray_status status = data ? moray_ok() : moray_error(MORAY_MEMORY, "no memory for a figure");
    int n = 0;
    for (int model = 0; model < 2; model++)
        for (int k = 0; k < gaits && !moray_failed(status); k++) {
            double *speed = data + n * points;
            if (isnan(trials[k]->steady[model].speed))
                continue;
            status = moray_gait_trial_speeds(&job->rig, trials[k], (moray_model)model, horizon, points, time, speed);
            snprintf(labels[n], sizeof *labels, "%s, %s model", names[k], moray_model_name((moray_model)model));
            curves[n] = (moray_curve){.label = labels[n], .x = time, .y = speed, .n = points};
            n++;
        }
    const moray_figure figure = {.name = "start",
                                 .title = "From rest: speed along the course, mean over the last period",
                                 .x_label = "time [s]",
                                 .y_label = "speed along the course [m/s]",
                                 .over_time = true,
                                 .curves = curves,
                                 .n_curves = n};
    if (!moray_failed(status))
        status = moray_output_figure(output, &figure);
    free(data);
    return status;
}

// What is seen first of the proof, then of the gait.
static moray_status draw(const void *found, moray_output *output)
{
    MORAY_TRY(draw_start(found, output));
    return gait_job_draw_gait(found, output);
}

static moray_status write(const void *found, moray_output *output)
{
    const gait_job *job = found;
    MORAY_TRY(moray_solution_leave(last_stage(job)->solution, output));
    return gait_job_trajectory(job, recommended(job), output);
}

moray_status gait_job_report(gait_job *job)
{
    struct tables t;
    gait_job_page page;
    char title[100];
    if (job->solution_file[0])
        MORAY_TRY(moray_solution_save(last_stage(job)->solution, job->solution_file));
    make_tables(job, &t);
    MORAY_TRY(gait_job_page_new(job, &page));
    snprintf(title, sizeof title, "%s: %s", job->name,
             job->goal == MORAY_GAIT_FASTEST ? "the fastest gait" : "the gait of least work");
    const moray_report report = {.title = title,
                                 .judged = page.judged,
                                 .judgement = page.pass ? MORAY_JUDGED_PASS : MORAY_JUDGED_FAIL,
                                 .text = page.text,
                                 .asked = page.asked,
                                 .scene = &page.scene.scene,
                                 .sections = page.section,
                                 .n_sections = 1,
                                 .tables = t.table,
                                 .n_tables = tables};
    const moray_status status = moray_app_show(&job->common, &(moray_results){.name = job->name,
                                                                              .found = job,
                                                                              .summary = gait_job_summary,
                                                                              .print = print,
                                                                              .write = write,
                                                                              .draw = draw,
                                                                              .report = &report});
    moray_swim_scene_free(&page.scene);
    return status;
}
