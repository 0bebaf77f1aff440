// SPDX-License-Identifier: MIT
//
// Gaits on the ladder of models: in speed, at the power of the paper's gait on each. The gaits are by default those
// that were found on the first-principles and on the control-oriented model alone (max_speed, search_gait).
#include <math.h>
#include <stdio.h>

#include "degree.h"
#include "moray/moray.h"
#include "moray/snake.h"

enum { GAITS = 7 }; // as many as a table has columns, with the paper's

typedef struct ladder {
    moray_common common;
    moray_snake_options snake;
    double shape[GAITS][2]; // theta_max, delta [rad]; NaN: none
    int jobs;
    moray_gait gait[1 + GAITS]; // the paper's first
    char name[1 + GAITS][32];
    int n;
    moray_ladder_row row[(1 + GAITS) * MORAY_RUNGS];
} ladder;

#define SHAPE(k)                                                                                                       \
    {                                                                                                                  \
        .section = "gait", .key = "gait_" #k, .type = MORAY_OPTION_PAIR, MORAY_AT(ladder, shape[k - 1]), .min = 0.1,   \
        .max = 179, .unit = "deg", .help = "theta_max,delta of a gait, amplitude of (24) and phase shift"              \
    }

static const moray_option options[] = {
    SHAPE(1), SHAPE(2), SHAPE(3), SHAPE(4), SHAPE(5), SHAPE(6), SHAPE(7), MORAY_JOBS_OPTION(ladder, jobs, "processes"),
};
static const moray_option_group groups[] = {{&moray_snake_option_table, offsetof(ladder, snake)}};
static const char *const without[] = {"model", "scheme", "intervals", "tol", "linear_solver", "ipopt.KEY", NULL};
static const moray_program program = {
    .name = "ladder",
    .summary = "Compares gaits of an underwater snake robot with the paper's on a ladder of models, at equal power.",
    .options = options,
    .n_options = sizeof options / sizeof *options,
    .groups = groups,
    .n_groups = 1,
    .without = without};

static void add_gait(ladder *run, const char *name, const moray_gait *gait)
{
    snprintf(run->name[run->n], sizeof *run->name, "%s", name);
    run->gait[run->n++] = *gait;
}

static moray_status climb(ladder *run)
{
    const moray_robot *robot = &run->snake.robot;
    MORAY_TRY(moray_robot_check_swims(robot));
    const moray_gait as_printed = moray_gait_paper(robot);
    const moray_gait paper = moray_gait_map(robot, &as_printed, MORAY_CONTROL_ORIENTED, MORAY_FIRST_PRINCIPLES);
    add_gait(run, "paper's", &paper);
    for (int k = 0; k < GAITS; k++) {
        const double theta_max = run->shape[k][0], delta = run->shape[k][1];
        const moray_gait gait = {.amplitude =
                                     moray_amplitude_from_theta_max(robot, MORAY_FIRST_PRINCIPLES, theta_max, delta),
                                 .omega = paper.omega,
                                 .delta = delta};
        char name[32];
        if (isnan(theta_max))
            continue;
        snprintf(name, sizeof name, "%.4g, %.4g deg", theta_max / DEG, delta / DEG);
        add_gait(run, name, &gait);
    }
    return moray_ladder_climb(&(moray_ladder_spec){.robot = *robot,
                                                   .current = {run->snake.current[0], run->snake.current[1]},
                                                   .course = run->snake.course,
                                                   .baseline = paper,
                                                   .gait = run->gait,
                                                   .gaits = run->n,
                                                   .settings = moray_swim_settings_default(),
                                                   .jobs = run->jobs},
                              run->row);
}

// ---- Results -------------------------------------------------------------------------------------------------------

enum { TEXT = 4000 };

static const moray_ladder_row *of_gait(const ladder *run, int g)
{
    return run->row + g * MORAY_RUNGS;
}

static void say(const ladder *run, char *text)
{
    for (int g = 1; g < run->n; g++) {
        moray_text_add(text, TEXT, "%s: ", run->name[g]);
        moray_ladder_verdict(of_gait(run, g), 0, text, TEXT);
        moray_text_add(text, TEXT, ".\n");
    }
}

static void summarise(const void *found, moray_json *json)
{
    const ladder *run = found;
    moray_snake_to_json(json, &run->snake);
    moray_json_open_list(json, "gaits");
    for (int g = 0; g < run->n; g++) {
        char verdict[TEXT] = "";
        moray_ladder_verdict(of_gait(run, g), 0, verdict, sizeof verdict);
        moray_json_open(json, NULL);
        moray_json_text(json, "name", run->name[g]);
        moray_ladder_to_json(json, of_gait(run, g));
        moray_json_text(json, "verdict", verdict);
        moray_json_close(json);
    }
    moray_json_close(json);
}

static void print(const void *found, const moray_report *report)
{
    (void)found;
    moray_tables_print(report->tables, report->n_tables, stdout);
    printf("%s", report->text);
}

static moray_status draw(const void *found, moray_output *output)
{
    const ladder *run = found;
    const moray_ladder_row *ladders[GAITS];
    const char *names[GAITS];
    for (int g = 1; g < run->n; g++) {
        ladders[g - 1] = of_gait(run, g);
        names[g - 1] = run->name[g];
    }
    return moray_ladder_draw(output, ladders, names, NULL, run->n - 1);
}

// Of the paper's gait what it makes, of the others what they gain.
static moray_status report(ladder *run)
{
    moray_table_row gains[MORAY_RUNGS], paper[MORAY_RUNGS];
    const moray_ladder_row *ladders[GAITS] = {NULL};
    char text[TEXT] = "";
    moray_table tables[2] = {
        {.title = "The paper's gait (theta_max, delta = 20 deg, 2 pi/(N-1)) on the ladder of models",
         .columns = {"speed, m/s", "power, W"},
         .n_columns = 2,
         .rows = paper,
         .n_rows = MORAY_RUNGS},
        {.title = "Gain in speed at its power, by theta_max and delta", .n_columns = run->n - 1}};
    for (int k = 0; k < MORAY_RUNGS; k++)
        paper[k] = (moray_table_row){.label = run->row[k].model, .value = {run->row[k].speed, run->row[k].power}};
    for (int g = 1; g < run->n; g++) {
        ladders[g - 1] = of_gait(run, g);
        tables[1].columns[g - 1] = run->name[g];
    }
    tables[1].rows = gains;
    tables[1].n_rows = moray_ladder_rows(ladders, run->n - 1, gains);
    say(run, text);
    const moray_report page = {.title = "ladder: gaits on the ladder of models",
                               .text = text,
                               .tables = tables,
                               .n_tables = run->n > 1 ? 2 : 1,
                               .words = moray_ladder_words()};
    return moray_app_show(
        &run->common,
        &(moray_results){
            .name = "ladder", .found = run, .summary = summarise, .print = print, .draw = draw, .report = &page});
}

int main(int argc, char **argv)
{
    static ladder run; // large
    run = (ladder){.common = moray_common_default(),
                   .snake = moray_snake_options_default(),
                   .shape = {{20 * DEG, 51.3 * DEG},
                             {20 * DEG, 86.6 * DEG},
                             {31.35 * DEG, 50.65 * DEG},
                             {28.97 * DEG, 85.06 * DEG},
                             {20 * DEG, 34.9 * DEG},
                             {NAN, NAN},
                             {NAN, NAN}}};
    run.snake.model = MORAY_FIRST_PRINCIPLES;
    int exit_code;
    if (!moray_app_start(&program, argc, argv, &run, &exit_code))
        return exit_code;
    moray_status status = climb(&run);
    if (!moray_failed(status))
        status = report(&run);
    return moray_app_end(&program, &run, status);
}
