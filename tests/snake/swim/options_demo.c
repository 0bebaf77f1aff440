// SPDX-License-Identifier: MIT
//
// A program with one option of every type and every kind of result, for test_cli.sh. --set fail=... ends it early.
#include <math.h>
#include <string.h>

#include "degree.h"
#include "moray/app/program.h"
#include "moray/snake/options.h"

typedef struct demo_settings {
    moray_common common;
    moray_snake_options snake;
    double delta[2], power[2], start[2], theta_max;
    int starts, ending;
    bool warm;
    char label[16];
} demo_settings;

static const char *const endings[] = {"well", "unsolved", "interrupted", NULL};
static const moray_option options[] = {
    {.section = "gait",
     .key = "delta",
     .flag = "delta",
     .type = MORAY_OPTION_RANGE,
     MORAY_AT(demo_settings, delta),
     .min = 0,
     .max = 180,
     .unit = "deg",
     .help = "phase shift between joints"},
    {.section = "gait",
     .key = "theta_max",
     .type = MORAY_OPTION_REAL,
     MORAY_AT(demo_settings, theta_max),
     .min = 0,
     .max = 90,
     .open = true,
     .unit = "deg",
     .help = "link angle amplitude"},
    {.section = "gait",
     .key = "power",
     .type = MORAY_OPTION_RANGE,
     MORAY_AT(demo_settings, power),
     .min = 0,
     .max = INFINITY,
     .unit = "W",
     .help = "mean joint power"},
    {.section = "problem",
     .key = "start",
     .type = MORAY_OPTION_PAIR,
     MORAY_AT(demo_settings, start),
     .unit = "m",
     .help = "position at the start"},
    {.section = "solver",
     .key = "starts",
     .type = MORAY_OPTION_INT,
     MORAY_AT(demo_settings, starts),
     .min = 1,
     .max = INFINITY,
     .help = "number of starting points"},
    {.section = "solver",
     .key = "warm",
     .type = MORAY_OPTION_BOOL,
     MORAY_AT(demo_settings, warm),
     .help = "start from the last solution"},
    {.section = "demo",
     .key = "label",
     .type = MORAY_OPTION_TEXT,
     MORAY_AT(demo_settings, label),
     .help = "a word for the summary"},
    {.section = "demo",
     .key = "ending",
     .type = MORAY_OPTION_CHOICE,
     MORAY_AT(demo_settings, ending),
     .choices = endings,
     .help = "how the run ends"},
};
static const moray_option_group groups[] = {{&moray_snake_option_table, offsetof(demo_settings, snake)}};
static const moray_program program = {.name = "options_demo",
                                      .summary = "Shows what it was told.",
                                      .options = options,
                                      .n_options = sizeof options / sizeof *options,
                                      .groups = groups,
                                      .n_groups = 1};

static moray_json *summary(const demo_settings *s)
{
    moray_json *json = moray_json_new();
    moray_json_number(json, "links", s->snake.robot.links);
    moray_json_number(json, "c_n", s->snake.robot.c_n);
    moray_json_number(json, "m", s->snake.robot.m);
    moray_json_numbers(json, "current", s->snake.current, 2);
    moray_json_number(json, "course_deg", s->snake.course / DEG);
    moray_json_text(json, "scheme", s->common.scheme);
    moray_json_number(json, "intervals", s->common.intervals);
    moray_json_number(json, "tol", s->common.tol);
    moray_json_number(json, "model", s->snake.model);
    moray_json_numbers(json, "power", s->power, 2);
    moray_json_bool(json, "warm", s->warm);
    moray_json_text(json, "label", s->label);
    return json;
}

static const moray_status ends[] = {{MORAY_OK, "ok"},
                                    {MORAY_NOT_SOLVED, "the path constraint speed hurts most at t = 3 s"},
                                    {MORAY_INTERRUPTED, "interrupted"}};

static moray_status write_files(const demo_settings *s, const moray_table *table)
{
    static const double t[] = {0, 1, 2, 3}, x[] = {0, 0.1, 0.4, 0.9};
    const moray_column columns[] = {{"t", "s", t, 0}, {"x", "m", x, 0}};
    const moray_curve curves[] = {{.label = "x", .x = t, .y = x, .n = 4}};
    const moray_figure figure = {.name = "position",
                                 .title = "Position",
                                 .x_label = "t [s]",
                                 .y_label = "x [m]",
                                 .curves = curves,
                                 .n_curves = 1};
    FILE *file;
    MORAY_TRY(moray_output_file(s->common.output, "trajectory.csv", &file));
    moray_csv_write(file, columns, 2, 4);
    moray_status drawn = moray_output_figure(s->common.output, &figure);
    if (moray_failed(drawn))
        fprintf(stderr, "%s\n", drawn.text);
    MORAY_TRY(moray_output_report(
        s->common.output,
        &(moray_report){
            .title = "Demo", .tables = table, .n_tables = 1, .argc = s->common.argc, .argv = s->common.argv}));
    MORAY_TRY(ends[s->ending]);
    return moray_output_commit(s->common.output);
}

int main(int argc, char **argv)
{
    demo_settings s = {.common = moray_common_default(),
                       .snake = moray_snake_options_default(),
                       .delta = {20 * DEG, 90 * DEG},
                       .power = {0, INFINITY},
                       .theta_max = 30 * DEG,
                       .starts = 8,
                       .label = "demo"};
    int exit_code;
    if (!moray_app_start(&program, argc, argv, &s, &exit_code))
        return exit_code;
    const moray_table_row rows[] = {{"links", {s.snake.robot.links}, NULL, NULL},
                                    {"delta from", {s.delta[0] / DEG}, "deg", NULL},
                                    {"delta to", {s.delta[1] / DEG}, "deg", NULL},
                                    {"scheme", {0}, NULL, s.common.scheme}};
    const moray_table table = {.title = "Settings", .n_columns = 1, .rows = rows, .n_rows = 4};
    moray_status status = s.common.output ? write_files(&s, &table) : ends[s.ending];
    moray_json *json = summary(&s);
    if (!moray_failed(status) && s.common.json)
        status = moray_json_write(json, stdout);
    else if (!moray_failed(status))
        moray_table_print(&table, stdout);
    moray_json_free(json);
    return moray_app_end(&program, &s, status);
}
