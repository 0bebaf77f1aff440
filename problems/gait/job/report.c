// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "job.h"

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
    char text[GAIT_TEXT];
    moray_solver_line(at->solution, job->common.scheme, job->common.intervals, text, GAIT_TEXT);
    if (at == &job->ladder)
        printf("%s together, %s", job->over, text);
    else
        printf("%s model, %s", moray_model_name(at->model), text);
    printf("; %d of %d starts end here, none better\n", at->agreeing, at->starts);
    moray_certificate_line(&at->certificate, text, GAIT_TEXT);
    printf("    %s\n", text);
}

static void print(const void *found, const moray_report *report)
{
    const gait_job *job = found;
    const stage *at[GAIT_STAGES];
    const int n = gait_job_stages(job, at);
    char text[GAIT_TEXT] = "";
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

// ---- Everything ----------------------------------------------------------------------------------------------------

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
                                 .words = moray_ladder_words(),
                                 .tables = t.table,
                                 .n_tables = tables};
    const moray_status status = moray_app_show(&job->common, &(moray_results){.name = job->name,
                                                                              .found = job,
                                                                              .summary = gait_job_summary,
                                                                              .print = print,
                                                                              .write = write,
                                                                              .draw = gait_job_draw,
                                                                              .report = &report});
    moray_swim_scene_free(&page.scene);
    return status;
}
