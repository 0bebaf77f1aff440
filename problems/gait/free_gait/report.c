// SPDX-License-Identifier: MIT
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "free_gait.h"

enum { TEXT = 1600, COLUMNS = 8, ROWS = 2 + FREE_GAIT_MOTIONS };

static const char *const model_names[] = {"control-oriented", "first-principles"};

// ---- Tables --------------------------------------------------------------------------------------------------------

// What rounding leaves is no difference.
static double percent(const moray_gait_gain *gain)
{
    const double nothing = 5e-4;
    return fabs(gain->speed_percent_at_equal_power) < nothing ? 0 : gain->speed_percent_at_equal_power;
}

static void fill_row(moray_table_row *row, const char *label, const stage *at, const moray_gait_gain *over_best)
{
    const moray_steady *swum = &at->trial.steady[MORAY_FIRST_PRINCIPLES];
    const double values[COLUMNS] = {at->prediction.speed,
                                    at->prediction.power,
                                    swum->speed,
                                    swum->power,
                                    swum->peak_link_angle / DEG,
                                    at->prediction.gait.omega / DEG,
                                    percent(&at->gain),
                                    over_best ? percent(over_best) : NAN};
    *row = (moray_table_row){.label = label};
    memcpy(row->value, values, sizeof values);
}

// The paper's gait as if it had been a stage: its prediction is what it makes.
static stage paper_stage(const free_gait *run)
{
    const moray_model model = run->job.snake.model;
    const moray_gait_trial *paper = &run->job.paper;
    stage at = {.model = model, .trial = *paper};
    at.prediction.gait = paper->gait[model];
    at.prediction.speed = paper->steady[model].speed;
    at.prediction.power = paper->steady[model].power;
    at.gain.speed_percent_at_equal_power = NAN;
    return at;
}

static moray_table motions_table(const free_gait *run, moray_table_row rows[ROWS])
{
    const stage paper = paper_stage(run);
    int n = 0;
    fill_row(&rows[n++], "paper's gait", &paper, NULL);
    fill_row(&rows[n++], "best gait (25) by theta_max", last_stage(&run->job), NULL);
    for (int k = 0; k < run->n; k++)
        fill_row(&rows[n++], run->motion[k].name, &run->motion[k].at, &run->motion[k].over_best);
    return (moray_table){
        .title = "Motions, each freer than the one above it: predicted, and swum on the "
                 "first-principles model (f.-p.)",
        .columns = {"m/s", "W", "f.-p. m/s", "f.-p. W", "f.-p. peak deg", "omega deg/s", "% on paper's", "% on best"},
        .n_columns = COLUMNS,
        .rows = rows,
        .n_rows = n};
}

// Amplitude and phase of the waves in the joints, on the first-principles model: of the harmonics that are there.
struct waves {
    moray_table table;
    moray_table_row *rows; // [joints]
    char labels[COLUMNS][24];
};

static double amplitude(const moray_series *series, int harmonic, int joint)
{
    const double *p = series->at + series->joints * (2 * harmonic - 1) + joint;
    return hypot(p[0], p[series->joints]);
}

static double largest(const moray_series *series, int harmonic)
{
    double most = 0;
    for (int i = 0; i < series->joints; i++)
        most = fmax(most, amplitude(series, harmonic, i));
    return most;
}

static moray_status make_waves(const free_gait *run, struct waves *waves)
{
    const moray_series *series = &freest(run)->series[MORAY_FIRST_PRINCIPLES];
    const int n = run->job.snake.robot.links - 1;
    const double nothing = 1e-5;
    *waves = (struct waves){.rows = calloc((size_t)n, sizeof *waves->rows)};
    if (!waves->rows)
        return moray_error(MORAY_MEMORY, "no memory for a table");
    moray_table *table = &waves->table;
    for (int k = 1; k <= series->harmonics && table->n_columns < COLUMNS; k++) {
        if (largest(series, k) < nothing)
            continue;
        const int at = table->n_columns;
        for (int i = 0; i < n; i++) {
            const double *p = series->at + n * (2 * k - 1) + i;
            waves->rows[i].value[at] = amplitude(series, k, i) / DEG;
            waves->rows[i].value[at + 1] = atan2(p[n], p[0]) / DEG;
        }
        snprintf(waves->labels[at], sizeof waves->labels[at], "%d omega: deg", k);
        snprintf(waves->labels[at + 1], sizeof waves->labels[at + 1], "phase");
        table->columns[at] = waves->labels[at];
        table->columns[at + 1] = waves->labels[at + 1];
        table->n_columns += 2;
    }
    for (int i = 0; i < n; i++)
        waves->rows[i].label = i == 0 ? "joint 1, at the tail" : i == n - 1 ? "last joint, at the head" : "";
    table->title = "Waves in the joints of the free motion, first-principles model: amplitude, phase [deg]";
    table->rows = waves->rows;
    table->n_rows = n;
    return moray_ok();
}

// ---- In words ------------------------------------------------------------------------------------------------------

__attribute__((format(printf, 3, 4))) static void say(char *text, int *used, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    *used += vsnprintf(text + *used, (size_t)(TEXT - *used), format, arguments);
    va_end(arguments);
    *used = *used < TEXT ? *used : TEXT - 1;
}

static void say_gain(const moray_gait_gain *gain, const char *whom, char *text, int *used)
{
    const double faster = gain->speed_percent_at_equal_power, more = gain->power_percent_at_equal_speed;
    if (isnan(faster))
        say(text, used, "no comparison with %s at its power (%.200s)", whom, gain->why_no_speed.text);
    else
        say(text, used, "%.2f %% %s than %s at its power", fabs(faster), faster < 0 ? "SLOWER" : "faster", whom);
    if (!isnan(more))
        say(text, used, ", %.2f %% %s power at its speed", fabs(more), more < 0 ? "less" : "MORE");
}

static void find_words(const free_gait *run, char *text)
{
    const stage *best = last_stage(&run->job);
    const motion *m = freest(run);
    const double reach = best->trial.steady[best->model].peak_link_angle / DEG;
    int used = 0;
    say(text, &used,
        "Same limits for all but the first two: |link angle - heading| at most %.4g deg in the %s model, where the "
        "best gait (25) by theta_max reaches %.4g deg",
        run->limit / DEG, model_names[best->model], reach);
    if (isfinite(best->power))
        say(text, &used, "; mean joint power at most %.4g W there", best->power);
    say(text, &used, ".\nThe free motion, %s, on the first-principles model: ", m->name);
    say_gain(&m->at.gain, "the paper's gait", text, &used);
    say(text, &used, "; ");
    say_gain(&m->over_best, "the best gait (25)", text, &used);
    say(text, &used, "; ");
    say_gain(&m->over_alike, "the gait (25) within the same limits", text, &used);
    say(text, &used, ".\nThe %s model itself predicted %+.2f %% speed on the gait (25) within the same limits.\n",
        model_names[best->model], 100 * (m->at.prediction.speed / run->motion[0].at.prediction.speed - 1));
    if (run->vainly > 0)
        say(text, &used, "With %d harmonics nothing better was found from there.\n", run->vainly);
}

// ---- All -----------------------------------------------------------------------------------------------------------

struct findings {
    char text[TEXT];
    moray_table_row rows[ROWS];
    moray_table motions;
    struct waves waves;
};

static void print(const free_gait *run, const struct findings *found)
{
    const moray_common *common = &run->job.common;
    const moray_snake_options *snake = &run->job.snake;
    char text[TEXT];
    printf("%d links, current (%g, %g) m/s, course %g deg, %s model\n\n", snake->robot.links, snake->current[0],
           snake->current[1], snake->course / DEG, model_names[snake->model]);
    moray_table_print(&found->motions, stdout);
    printf("\n");
    if (found->waves.table.n_columns > 0) {
        moray_table_print(&found->waves.table, stdout);
        printf("\n");
    }
    printf("%s\n", found->text);
    for (int k = 0; k < run->n; k++) {
        const motion *m = &run->motion[k];
        moray_solver_line(m->at.solution, common->scheme, common->intervals, text, TEXT);
        printf("%s: %s\n", m->name, text);
        moray_certificate_line(&m->at.certificate, text, TEXT);
        printf("    %s; swum as predicted to %.1e\n", text, free_gait_disagreement(m));
    }
}

static moray_status write_files(const free_gait *run, const struct findings *found, const moray_json *json)
{
    moray_output *output = run->job.common.output;
    FILE *file;
    MORAY_TRY(moray_output_file(output, "summary.json", &file));
    MORAY_TRY(moray_json_write(json, file));
    MORAY_TRY(free_gait_files(run, output));
    const moray_table tables[] = {found->motions, found->waves.table};
    const moray_report report = {.title = run->job.name,
                                 .text = found->text,
                                 .tables = tables,
                                 .n_tables = found->waves.table.n_columns > 0 ? 2 : 1,
                                 .argc = run->job.common.argc,
                                 .argv = run->job.common.argv};
    MORAY_TRY(moray_output_report(output, &report));
    return moray_output_commit(output);
}

moray_status free_gait_report(gait_job *job)
{
    const free_gait *run = (const free_gait *)job;
    struct findings *found = calloc(1, sizeof *found);
    if (!found)
        return moray_error(MORAY_MEMORY, "no memory for a report");
    find_words(run, found->text);
    found->motions = motions_table(run, found->rows);
    moray_status status = make_waves(run, &found->waves);
    moray_json *json = free_gait_json(run);
    if (!moray_failed(status) && job->common.output)
        status = write_files(run, found, json);
    if (!moray_failed(status) && job->common.json)
        status = moray_json_write(json, stdout);
    else if (!moray_failed(status))
        print(run, found);
    moray_json_free(json);
    free(found->waves.rows);
    free(found);
    return status;
}
