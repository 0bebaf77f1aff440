// SPDX-License-Identifier: MIT
#include <stdlib.h>
#include <string.h>

#include "free_gait.h"

enum { TEXT = 1600, COLUMNS = 8, ROWS = 2 + FREE_GAIT_MOTIONS };

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

// Gains on the ladder; a table has room for so many motions, the last are left out.
static moray_table ladder_table(const free_gait *run, moray_table_row rows[MORAY_RUNGS])
{
    const moray_ladder_row *ladders[COLUMNS] = {last_stage(&run->job)->ladder};
    const int n = run->n + 1 < COLUMNS ? run->n + 1 : COLUMNS;
    moray_table table = {.title = "Gain in speed at the power of the paper's gait, on the ladder of models",
                         .columns = {"best gait (25)"},
                         .n_columns = n,
                         .rows = rows};
    for (int k = 1; k < n; k++) {
        ladders[k] = run->motion[k - 1].at.ladder;
        table.columns[k] = run->motion[k - 1].name;
    }
    table.n_rows = moray_ladder_rows(ladders, n, rows);
    return table;
}

// ---- In words ------------------------------------------------------------------------------------------------------

static void say_gain(const free_gait *run, const moray_gait_gain *gain, const char *whom, char *text)
{
    const double faster = gain->speed_percent_at_equal_power, more = gain->power_percent_at_equal_speed;
    if (isnan(faster))
        moray_text_add(text, TEXT, "no comparison with %s at its power (%.200s)", whom, gain->why_no_speed.text);
    else
        moray_text_add(text, TEXT, "%.2f %% %s than %s at its power", fabs(faster), faster < 0 ? "SLOWER" : "faster",
                       whom);
    gait_job_say_beyond(&run->job, gain->omega_at_equal_power, text, TEXT);
    if (isnan(more))
        return;
    moray_text_add(text, TEXT, ", %.2f %% %s power at its speed", fabs(more), more < 0 ? "less" : "MORE");
    gait_job_say_beyond(&run->job, gain->omega_at_equal_speed, text, TEXT);
}

// Where a freer motion is no faster than the one before it, that one stands for it.
static void say_vain(const free_gait *run, char *text)
{
    for (int k = 0; k <= FREE_GAIT_HARMONICS; k++) {
        if (!moray_failed(run->vain[k]))
            continue;
        if (k == 0)
            moray_text_add(text, TEXT, "Tapered");
        else
            moray_text_add(text, TEXT, "With %d harmonic%s", k, k > 1 ? "s" : "");
        moray_text_add(text, TEXT, " nothing better was found, and the motion before stands for it: %.200s.\n",
                       run->vain[k].text);
    }
}

static void find_words(const free_gait *run, char *text)
{
    const stage *best = last_stage(&run->job);
    const motion *m = freest(run);
    const double reach = best->trial.steady[best->model].peak_link_angle / DEG;
    moray_text_add(
        text, TEXT,
        "Same limits for all but the first two: |link angle - heading| at most %.4g deg in the %s model, where the "
        "best gait (25) by theta_max reaches %.4g deg",
        run->limit / DEG, moray_model_name(best->model), reach);
    if (isfinite(best->power))
        moray_text_add(text, TEXT, "; %s at most %.4g W there", moray_power_label(&run->job.snake.robot, best->model),
                       best->power);
    moray_text_add(text, TEXT, ".\nThe free motion, %s, on the first-principles model: ", m->name);
    say_gain(run, &m->at.gain, "the paper's gait", text);
    moray_text_add(text, TEXT, "; ");
    say_gain(run, &m->over_best, "the best gait (25)", text);
    moray_text_add(text, TEXT, "; ");
    say_gain(run, &m->over_alike, "the gait (25) within the same limits", text);
    moray_text_add(text, TEXT, ".\nIn speed at the power of the paper's gait the free motion ");
    gait_job_verdict(&run->job, &m->at, text, TEXT);
    moray_text_add(
        text, TEXT, ".\nThe %s model itself predicted %+.2f %% speed on the gait (25) within the same limits.\n",
        moray_model_name(best->model), 100 * (m->at.prediction.speed / run->motion[0].at.prediction.speed - 1));
    say_vain(run, text);
}

// ---- All -----------------------------------------------------------------------------------------------------------

static void print(const void *found, const moray_report *report)
{
    const free_gait *run = found;
    const moray_common *common = &run->job.common;
    char text[TEXT];
    gait_job_print_head(&run->job);
    printf(", %s model\n\n", moray_model_name(run->job.snake.model));
    moray_tables_print(report->tables, report->n_tables, stdout);
    printf("%s\n", report->text);
    for (int k = 0; k < run->n; k++) {
        const motion *m = &run->motion[k];
        moray_solver_line(m->at.solution, common->scheme, common->intervals, text, TEXT);
        printf("%s: %s\n", m->name, text);
        moray_certificate_line(&m->at.certificate, text, TEXT);
        printf("    %s; swum as predicted to %.1e\n", text, free_gait_disagreement(m));
    }
}

static moray_status make_scene(const void *found, moray_swim_scene *scene)
{
    const free_gait *run = found;
    const gait_job *job = &run->job;
    char baseline[64];
    scene->scene.title = "The freest motion swimming";
    scene->scene.text = "All from rest on the same water, simulated, side by side.";
    MORAY_TRY(gait_job_scene_add(job, scene, freest(run)->name, MORAY_COLOUR_BEST, &freest(run)->at.trial, 2,
                                 GAIT_SHOWN_SECONDS));
    MORAY_TRY(gait_job_scene_add(job, scene, "best gait (25)", MORAY_COLOUR_SECOND, &last_stage(job)->trial, 1,
                                 GAIT_SHOWN_SECONDS));
    return gait_job_scene_add(job, scene, gait_job_baseline(job, baseline), MORAY_COLOUR_BASELINE, &job->paper, 0,
                              GAIT_SHOWN_SECONDS);
}

static const gait_job_shown shown = {free_gait_summary, print, free_gait_write, free_gait_draw, make_scene};

moray_status free_gait_report(gait_job *job)
{
    const free_gait *run = (const free_gait *)job;
    struct waves waves;
    char text[TEXT] = "";
    moray_table_row rows[ROWS], gains[MORAY_RUNGS];
    int passed = 0;
    MORAY_TRY(make_waves(run, &waves));
    find_words(run, text);
    for (int k = 0; k < run->n; k++)
        passed += run->motion[k].at.certificate.pass;
    const moray_table tables[] = {motions_table(run, rows), ladder_table(run, gains), waves.table};
    const moray_status status =
        gait_job_publish(job, &shown, passed, run->n,
                         &(moray_report){.title = "free_gait: what the sinusoid leaves on the table",
                                         .text = text,
                                         .tables = tables,
                                         .n_tables = waves.table.n_columns > 0 ? 3 : 2,
                                         .words = moray_ladder_words()});
    free(waves.rows);
    return status;
}
