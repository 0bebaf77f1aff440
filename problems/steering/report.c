// SPDX-License-Identifier: MIT
//
// Tables, words and files of a program that steers.
#include "steer.h"

// ---- Tables --------------------------------------------------------------------------------------------------------

void steer_add_table(steer_tables *tables, const moray_table *table)
{
    tables->table[tables->n] = *table;
    tables->table[tables->n].rows = tables->rows[tables->n];
    tables->n++;
}

void steer_gait_table(const steer_job *job, steer_tables *tables, int first)
{
    static const char *const labels[][2] = {{"theta_max, amplitude of (24)", "deg"},
                                            {"omega, frequency", "deg/s"},
                                            {"delta, phase shift", "deg"},
                                            {"a, by (33)", "cm"},
                                            {"alpha, by (27)", "deg"},
                                            {"speed, control-oriented", "m/s"},
                                            {"speed, first-principles", "m/s"},
                                            {"power straight ahead there", "W"}};
    enum { count = sizeof labels / sizeof *labels };
    moray_table_row *rows = tables->rows[tables->n];
    for (int i = 0; i < count; i++)
        rows[i] = (moray_table_row){.label = labels[i][0], .unit = labels[i][1]};
    for (int g = first; g <= 1 + (int)job->snake.model; g++) {
        const moray_straight_motion *control = &job->straight[g][0], *revolute = &job->straight[g][1];
        const moray_gait *gait = &control->gait;
        const double values[count] = {
            moray_theta_max_from_amplitude(&job->snake.robot, MORAY_CONTROL_ORIENTED, gait->amplitude, gait->delta) /
                DEG,
            gait->omega / DEG,
            gait->delta / DEG,
            100 * gait->amplitude,
            revolute->gait.amplitude / DEG,
            control->speed,
            revolute->speed,
            revolute->power};
        for (int i = 0; i < count; i++)
            rows[i].value[g - first] = values[i];
    }
    moray_table table = {.title = "Gait",
                         .columns = {"paper's", "control opt.", "first-pr. opt."},
                         .n_columns = 2 + (int)job->snake.model,
                         .n_rows = count};
    if (first > 0) {
        table.columns[0] = "given";
        table.n_columns = 1;
    }
    steer_add_table(tables, &table);
}

static double cell(const steer_trial *trial, const steer_column *column)
{
    if (column->score == STEER_SPENT)
        return trial->evaluations ? (double)trial->evaluations : NAN;
    const double value = trial->score[column->model][column->score] / column->unit;
    return column->rounded && fabs(value) < 5e-4 ? 0 : value;
}

void steer_score_table(const steer_job *job, steer_tables *tables, int n_columns)
{
    const steer_column *columns = job->program->columns;
    moray_table_row *rows = tables->rows[tables->n];
    moray_table table = {.title = job->program->score_title, .n_columns = n_columns, .n_rows = job->n_trials};
    for (int i = 0; i < n_columns; i++)
        table.columns[i] = columns[i].title;
    for (int k = 0; k < job->n_trials; k++) {
        rows[k] = (moray_table_row){.label = job->trial[k].name};
        for (int i = 0; i < n_columns; i++)
            rows[k].value[i] = cell(&job->trial[k], &columns[i]);
    }
    steer_add_table(tables, &table);
}

// A tuner that ends at 0 ends at what rounding makes of it.
static double tuned(const steer_job *job, const steer_trial *trial, int i)
{
    return fabs(trial->number[i]) < 1e-12 ? 0 : job->number[i].unit * trial->number[i];
}

void steer_tuning_table(const steer_job *job, steer_tables *tables)
{
    const int n = job->program->n_numbers;
    moray_table_row *rows = tables->rows[tables->n];
    moray_table table = {.title = "Tuned on the first-principles model", .n_columns = n + 1};
    for (int i = 0; i < n; i++)
        table.columns[i] = job->number[i].column;
    table.columns[n] = "simulations";
    for (int k = 0; k < job->n_trials; k++) {
        const steer_trial *trial = &job->trial[k];
        if (!trial->law->tuned || !trial->run)
            continue;
        moray_table_row *row = &rows[table.n_rows++];
        *row = (moray_table_row){.label = trial->name};
        for (int i = 0; i < n; i++) // what is known ahead has a lead, if only 0
            row->value[i] = trial->law->tuned & 1u << i || trial->law->preview ? tuned(job, trial, i) : NAN;
        row->value[n] = trial->evaluations;
    }
    steer_add_table(tables, &table);
}

// ---- In words ------------------------------------------------------------------------------------------------------

const steer_trial *steer_best_on(const steer_job *job, int gait, unsigned laws, int score)
{
    const steer_trial *best = NULL;
    for (int k = 0; k < job->n_trials; k++) {
        const steer_trial *trial = &job->trial[k];
        const bool wanted = laws & 1u << (trial->law - job->program->laws) && trial->run && !trial->barred;
        if (wanted && (gait < 0 || trial->gait == gait) && (!best || trial->score[1][score] < best->score[1][score]))
            best = trial;
    }
    return best;
}

const steer_trial *steer_best(const steer_job *job, unsigned laws, int score)
{
    return steer_best_on(job, -1, laws, score);
}

const steer_trial *steer_last_trial(const steer_job *job, int law)
{
    for (int k = 0; k < job->n_trials; k++) {
        const steer_trial *trial = &job->trial[k];
        if (trial->law == &job->program->laws[law] && trial->plan == job->snake.model && trial->run)
            return trial;
    }
    return NULL;
}

static void print_receding(const steer_job *job, const steer_trial *trial)
{
    const moray_receding_horizon_record *r = &trial->record[MORAY_FIRST_PRINCIPLES];
    printf(
        "%s: %d plans of %.3g periods, each %.2g s of processor time on average (the longest after the first %.2g s) "
        "and %.1f iterations; %.1f times faster than real time on one core%s%s\n",
        trial->name, r->plans, job->look_ahead_periods, r->seconds / r->plans, r->longest,
        (double)r->iterations / r->plans, job->program->swum(job, trial) / r->seconds,
        r->failures ? "; not solved at first: " : "", r->failures ? r->first_failure : "");
}

static void print_solver(const steer_job *job, int number)
{
    char line[300];
    int meshes;
    const moray_solution *solution = job->plan[number].solution;
    const moray_mesh_record *record = moray_solution_history(solution, &meshes);
    const bool averaged = number == STEER_AVERAGED;
    moray_solver_line(solution, averaged ? STEER_AVERAGED_SCHEME : job->common.scheme, record[meshes - 1].intervals,
                      line, sizeof line);
    printf("%s: ", averaged ? "period-averaged plan" : moray_model_name(number));
    if (job->program->duration)
        printf("%s %.3f s, ", job->program->duration, steer_duration(solution));
    printf("%s\n", line);
    if (averaged)
        return;
    moray_certificate_line(&job->certificate[number], line, sizeof line);
    printf("    %s\n", line);
    if (!job->certificate[number].pass)
        printf("    %s\n", job->certificate[number].why);
}

static void print(const void *found, const moray_report *report)
{
    const steer_job *job = found;
    const steer_program *program = job->program;
    char text[STEER_TEXT];
    char links[MORAY_LINKS_TEXT];
    printf("%s, current (%.6g, %.6g) m/s%s%s, ", moray_snake_links_text(&job->snake.robot, links),
           job->snake.current[0], job->snake.current[1], job->water ? " in the mean of " : "",
           job->water ? job->water_file : "");
    program->headline(job, stdout);
    printf("\n\n");
    moray_tables_print(report->tables, report->n_tables, stdout);
    program->explain(job, text, sizeof text);
    printf("%s\n\n%s\n\n", report->text, text);
    if (program->notes)
        program->notes(job, stdout);
    for (int k = 0; k < job->n_trials; k++)
        if (job->trial[k].law->kind == STEER_RECEDING && job->trial[k].run)
            print_receding(job, &job->trial[k]);
    print_solver(job, STEER_AVERAGED);
    for (int model = 0; model <= (int)job->snake.model; model++)
        print_solver(job, model);
}

// The plans' certificates, one a line, and whether all pass.
static bool certify(const steer_job *job, char *text, size_t size)
{
    char line[STEER_TEXT];
    bool pass = true;
    for (int model = 0; model <= (int)job->snake.model; model++) {
        if (!job->plan[model].solution)
            continue;
        moray_certificate_line(&job->certificate[model], line, sizeof line);
        moray_text_add(text, size, "Plan on the %s model. %s\n", moray_model_name((moray_model)model), line);
        pass = pass && job->certificate[model].pass;
    }
    return pass;
}

// What the time given cut short, and the plan that there is none of.
// Limits that plans keep, and rivals are not held to.
static void say_motors(const steer_job *job, char *text, size_t size)
{
    const moray_robot *robot = &job->snake.robot;
    if (job->snake.model == MORAY_FIRST_PRINCIPLES &&
        (robot->motor.lines > 0 || (robot->supply.rate > 0 && isfinite(robot->supply.rate))))
        moray_text_add(text, size,
                       " The first-principles plan keeps to what the motors give and how fast they turn; who steers "
                       "otherwise, or by feedback around it, is not held to that.");
}

static void say_missing(const steer_job *job, char *text, size_t size)
{
    const char *before = " Not swum in the time given (--time):";
    if (moray_failed(job->without))
        moray_text_add(text, size, " There is %s.", job->without.text);
    for (int k = 0; k < job->n_trials; k++)
        if (!job->trial[k].run) {
            moray_text_add(text, size, "%s %s", before, job->trial[k].name);
            before = ",";
        }
    moray_text_add(text, size, *before == ',' ? "." : "");
    before = " Tuned for less long than asked for, as the time given ended it:";
    for (int k = 0; k < job->n_trials; k++)
        if (job->trial[k].cut) {
            moray_text_add(text, size, "%s %s", before, job->trial[k].name);
            before = ",";
        }
    moray_text_add(text, size, *before == ',' ? "." : "");
}

// What the names of a program's own stand for, and of plans.
static void list_words(const steer_job *job, moray_meaning words[STEER_WORDS])
{
    static const moray_meaning common[] = {
        {"paper's gait", "the gait of the paper's simulations, not optimised"},
        {"gait found", "that of the first-principles plan"},
        {"control opt., first-pr. opt.", "the gait of the plan on the control-oriented, the first-principles model"},
        {"plan", "the joint offset over time found by collocation on that model, replayed as it is"},
        {"plan + feedback", "the same with tuned feedback around it"},
        {"receding", "planned anew again and again, from the state measured, over the next few periods"},
        {"phi_0", "the joint offset, by which the robot turns"},
        {NULL, NULL}};
    int n = 0;
    for (const moray_meaning *own = job->program->words; own->name && n < STEER_WORDS - 1; own++)
        words[n++] = *own;
    for (const moray_meaning *word = common; word->name && n < STEER_WORDS - 1; word++)
        words[n++] = *word;
    words[n] = (moray_meaning){NULL, NULL};
}

moray_status steer_report(steer_job *job)
{
    steer_tables tables = {0};
    moray_meaning words[STEER_WORDS];
    char text[STEER_TEXT], why[STEER_TEXT], certificates[3 * STEER_TEXT] = "", asked[800];
    moray_swim_scene scene = {0};
    job->program->tables(job, &tables);
    job->program->conclude(job, text, sizeof text);
    say_motors(job, text, sizeof text);
    say_missing(job, text, sizeof text);
    job->program->explain(job, why, sizeof why);
    const bool pass = certify(job, certificates, sizeof certificates);
    char links[MORAY_LINKS_TEXT];
    snprintf(asked, sizeof asked, "A robot of %s in a current of (%g, %g) m/s%s%.60s.",
             moray_snake_links_text(&job->snake.robot, links), job->snake.current[0], job->snake.current[1],
             job->water ? " in the mean, by the table " : "", job->water ? job->water_file : "");
    list_words(job, words);
    scene.scene.title = "The robot swimming";
    scene.scene.text = "Simulated on the first-principles model, every way of steering on the same water.";
    job->scene = &scene;
    const moray_section sections[] = {{.title = "What keeps the robot from doing better", .text = why},
                                      {.title = "Certificate", .text = certificates}};
    const bool all = !moray_failed(job->without);
    const moray_report report = {.title = job->program->title,
                                 .judged = !all   ? "No first-principles plan"
                                           : pass ? "Plans solved and certified"
                                                  : "A plan's certificate failed",
                                 .judgement = pass && all ? MORAY_JUDGED_PASS : MORAY_JUDGED_FAIL,
                                 .text = text,
                                 .asked = asked,
                                 .scene = &scene.scene,
                                 .tables = tables.table,
                                 .n_tables = tables.n,
                                 .sections = sections,
                                 .n_sections = 2,
                                 .words = words};
    const moray_status status = moray_app_show(&job->common, &(moray_results){.name = job->name,
                                                                              .found = job,
                                                                              .summary = steer_summary,
                                                                              .print = print,
                                                                              .write = steer_write,
                                                                              .report = &report});
    moray_swim_scene_free(&scene);
    job->scene = NULL;
    return status;
}
