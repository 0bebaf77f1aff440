// SPDX-License-Identifier: MIT
//
// Medians, 90th percentiles and paired differences of the trials.
#include "sea.h"

#include <stdio.h>
#include <stdlib.h>

#include "moray/number.h"

static const struct scale {
    const char *key[SEA_SCORES], *json[SEA_SCORES];
    double unit[SEA_SCORES];
} scales[2] = {{{"RMS, deg", "largest, deg", "power, W"}, {"rms_deg", "largest_deg", "power_W"}, {DEG, DEG, 1}},
               {{"RMS, cm", "time, s", "cost"}, {"rms_m", "time_s", "cost"}, {0.01, 1, 1}}};

// What laws are compared by: the heading error, or the cost of a path.
int sea_judged_by(const sea_job *job)
{
    return job->task == SEA_HEADING ? 0 : 2;
}

const char *sea_judged_name(const sea_job *job)
{
    return scales[job->task].key[sea_judged_by(job)];
}

double sea_quantile(const sea_job *job, int law, int other, int which, double share)
{
    static double values[SEA_MOST_SEEDS];
    for (int k = 0; k < job->seeds; k++) {
        const sea_score *of = &job->score[k * SEA_LAWS];
        values[k] = of[law].value[which] - (other < 0 ? 0 : of[other].value[which]);
    }
    return moray_quantile(values, job->seeds, share) / scales[job->task].unit[which];
}

static double wins(const sea_job *job, int law, int other)
{
    int n = 0;
    for (int k = 0; k < job->seeds; k++) {
        const sea_score *of = &job->score[k * SEA_LAWS];
        n += of[law].value[sea_judged_by(job)] < of[other].value[sea_judged_by(job)];
    }
    return 100.0 * n / job->seeds;
}

static int failures(const sea_job *job, int law)
{
    int n = 0;
    for (int k = 0; k < job->seeds; k++)
        n += job->score[k * SEA_LAWS + law].failures;
    return n;
}

// The rival of the least cost in training: chosen before anything is scored.
static int best_rival(const sea_job *job, const sea_law *laws, int n)
{
    int best = 0;
    for (int law = 1; law < n; law++)
        if (laws[law].tuned && !laws[law].collocated && laws[law].knows != SEA_BEFOREHAND &&
            job->tuned_cost[law] < job->tuned_cost[best])
            best = law;
    return best;
}

enum { MEDIAN, HIGH, SECOND_MEDIAN, SECOND_HIGH, DIFFERENCE, DIFFERENCE_HIGH, WINS, FAILED, COLUMNS };

static void fill(const sea_job *job, const sea_law *laws, int n, moray_table_row *rows, char label[][64])
{
    const int best = best_rival(job, laws, n), by = sea_judged_by(job), second = job->task == SEA_HEADING ? 1 : 0;
    for (int law = 0; law < n; law++) {
        snprintf(label[law], sizeof *label, "%s (told: %s)", laws[law].name, laws[law].told);
        rows[law] = (moray_table_row){.label = label[law]};
        double *value = rows[law].value;
        value[MEDIAN] = sea_quantile(job, law, -1, by, 0.5);
        value[HIGH] = sea_quantile(job, law, -1, by, 0.9);
        value[SECOND_MEDIAN] = sea_quantile(job, law, -1, second, 0.5);
        value[SECOND_HIGH] = sea_quantile(job, law, -1, second, 0.9);
        value[DIFFERENCE] = law == best ? NAN : sea_quantile(job, law, best, by, 0.5);
        value[DIFFERENCE_HIGH] = law == best ? NAN : sea_quantile(job, law, best, by, 0.9);
        value[WINS] = law == best ? NAN : wins(job, law, best);
        value[FAILED] = laws[law].tuned ? NAN : (double)failures(job, law);
    }
}

static void fill_tuning(const sea_job *job, const sea_law *laws, int n, moray_table_row *rows, int *used)
{
    *used = 0;
    for (int law = 0; law < n; law++) {
        if (!laws[law].tuned)
            continue;
        moray_table_row *row = &rows[(*used)++];
        *row = (moray_table_row){.label = laws[law].name};
        for (int k = 0; k < SEA_NUMBERS; k++)
            row->value[k] = laws[law].tuned & 1u << k ? job->number[law][k] : NAN;
        row->value[SEA_NUMBERS] = job->tuned_cost[law];
        row->value[SEA_NUMBERS + 1] = job->tuned_by[law];
    }
}

// Without feedback, and with that of the first law, P or LOS.
static int fill_multipliers(const sea_job *job, moray_table_row *rows)
{
    static const char *const names[2][2] = {{"nobody steers", "P"}, {"nobody steers", "LOS"}};
    for (int k = 0; k < 2; k++) {
        rows[k] = (moray_table_row){.label = names[job->task][k]};
        sea_multipliers(job, k ? job->number[0] : NULL, rows[k].value);
    }
    return 2;
}

static const char *const estimators[SEA_ESTIMATORS] = {"unscented filter", "moving horizon"};

// Over the draws that there are estimates of; NaN: of none.
static double estimate_quantile(const sea_job *job, int estimator, int which, double share)
{
    static double values[SEA_MOST_SEEDS];
    int n = 0;
    for (int k = 0; k < job->seeds; k++)
        if (job->estimate[k].known)
            values[n++] = job->estimate[k].value[estimator][which];
    return moray_quantile(values, n, share);
}

static void fill_estimates(const sea_job *job, moray_table_row *rows)
{
    const double unit[SEA_ESTIMATED] = {1, 0.01, 0.01};
    for (int k = 0; k < SEA_ESTIMATORS; k++) {
        rows[k] = (moray_table_row){.label = estimators[k]};
        for (int which = 0; which < SEA_ESTIMATED; which++) {
            rows[k].value[2 * which] = estimate_quantile(job, k, which, 0.5) / unit[which];
            rows[k].value[2 * which + 1] = estimate_quantile(job, k, which, 0.9) / unit[which];
        }
    }
}

static void json_estimates(const sea_job *job, moray_json *json)
{
    moray_json_open_list(json, "estimates");
    for (int k = 0; k < SEA_ESTIMATORS; k++) {
        moray_json_open(json, NULL);
        moray_json_text(json, "estimator", estimators[k]);
        moray_json_number(json, "current_error_median_m_s", estimate_quantile(job, k, SEA_CURRENT, 0.5));
        moray_json_number(json, "thrust_error_median", estimate_quantile(job, k, SEA_THRUST, 0.5));
        moray_json_number(json, "turning_error_median", estimate_quantile(job, k, SEA_TURNING, 0.5));
        moray_json_close(json);
    }
    moray_json_close(json);
}

static void summary(const void *found, moray_json *json)
{
    const sea_job *job = found;
    const sea_law *laws;
    const int n = sea_laws(job, &laws), best = best_rival(job, laws, n);
    moray_snake_to_json(json, &job->snake);
    const moray_gait gait[2] = {
        job->gait, moray_gait_map(&job->snake.robot, &job->gait, MORAY_CONTROL_ORIENTED, MORAY_FIRST_PRINCIPLES)};
    moray_gait_to_json(json, "gait", &job->snake.robot, gait);
    moray_json_text(json, "task", job->task == SEA_HEADING ? "heading" : "path");
    moray_json_text(json, "rung", job->rung);
    moray_json_text(json, "planner_current", job->believed_current);
    moray_json_numbers(json, "planner_factors", job->factor, SEA_COEFFICIENTS);
    moray_json_number(json, "seeds", job->seeds);
    moray_json_number(json, "training", job->training);
    moray_json_text(json, "best_rival", laws[best].name);
    moray_json_open_list(json, "laws");
    for (int law = 0; law < n; law++) {
        moray_json_open(json, NULL);
        moray_json_text(json, "name", laws[law].name);
        moray_json_text(json, "told", laws[law].told);
        for (int k = 0; k < SEA_NUMBERS; k++)
            if (laws[law].tuned & 1u << k)
                moray_json_number(json, sea_number_names[job->task][k], job->number[law][k]);
        if (laws[law].tuned)
            moray_json_number(json, "training_cost", job->tuned_cost[law]);
        for (int which = 0; which < SEA_SCORES; which++) {
            moray_json_open(json, scales[job->task].json[which]);
            const double si = job->task == SEA_PATH ? scales[SEA_PATH].unit[which] : 1; // cm only in tables
            moray_json_number(json, "median", sea_quantile(job, law, -1, which, 0.5) * si);
            moray_json_number(json, "percentile_90", sea_quantile(job, law, -1, which, 0.9) * si);
            moray_json_number(json, "median_difference", sea_quantile(job, law, best, which, 0.5) * si);
            moray_json_close(json);
        }
        moray_json_number(json, "wins_percent", wins(job, law, best));
        moray_json_number(json, "plans_failed", failures(job, law));
        moray_json_close(json);
    }
    moray_json_close(json);
    json_estimates(job, json);
}

static void print(const void *found, const moray_report *report)
{
    (void)found;
    moray_tables_print(report->tables, report->n_tables, stdout);
    printf("%s\n", report->text);
}

static moray_status write_nothing(const void *found, moray_output *output)
{
    (void)found, (void)output;
    return moray_ok();
}

static const moray_meaning words[] = {
    {"P, PID", "joint offset in proportion to the heading error; with its integral and its rate"},
    {"rate fed forward, and rate", "with the rate that the reference has"},
    {"ahead", "told the reference some time ahead, as planners are"},
    {"LOS, ILOS",
     "line of sight: steering for a point of the path some way ahead; with an integral against the current"},
    {"by collocation", "its numbers from one optimal-control problem over all training draws, not by trials"},
    {"receding", "planned anew again and again from what is measured: told the draw's robot and current, believing in "
                 "those of the options, or estimating them as it swims"},
    {"plan", "made beforehand: of the robot believed, or one for all robots of the training (robust)"},
    {"90th", "of a hundred draws ninety do better"},
    {"wins", "share of the draws in which it does better than the best rival"},
    {NULL, NULL},
};

moray_status sea_report(const sea_job *job)
{
    const sea_law *laws;
    const int n = sea_laws(job, &laws), best = best_rival(job, laws, n), by = sea_judged_by(job);
    const int second = job->task == SEA_HEADING ? 1 : 0;
    moray_table_row rows[4][SEA_LAWS];
    char label[SEA_LAWS][64], text[1600] = "";
    int tuned;
    fill(job, laws, n, rows[0], label);
    fill_tuning(job, laws, n, rows[1], &tuned);
    fill_estimates(job, rows[3]);
    const struct scale *scale = &scales[job->task];
    const moray_table tables[] = {
        {.title = "Trials: median and 90th percentile; differences to the best rival of the training, draw by draw",
         .columns = {scale->key[by], "90th", scale->key[second], "90th", "less rival's", "90th", "wins, %",
                     "failed plans"},
         .n_columns = COLUMNS,
         .rows = rows[0],
         .n_rows = n},
        {.title = "Tuned on draws of their own",
         .columns = {sea_number_names[job->task][0], sea_number_names[job->task][1], sea_number_names[job->task][2],
                     sea_number_names[job->task][3], sea_number_names[job->task][4], "cost", "settings"},
         .n_columns = SEA_NUMBERS + 2,
         .rows = rows[1],
         .n_rows = tuned},
        {.title = "Stroboscopic map of the robot believed, straight on in still water: largest multipliers",
         .columns = {"largest", "second"},
         .n_columns = 2,
         .rows = rows[2],
         .n_rows = fill_multipliers(job, rows[2])},
        {.title =
             "Estimates from one record of every draw, under the first law: median and 90th percentile of how far off",
         .columns = {"current, m/s", "90th", "thrust, %", "90th", "turning, %", "90th"},
         .n_columns = 6,
         .rows = rows[3],
         .n_rows = SEA_ESTIMATORS}};
    moray_text_add(text, sizeof text,
                   "%d draws on %s (rung %s), none of which tuned anybody; all on the paper's gait behind the same "
                   "instruments. Rivals are told nothing of robot and current. The best rival by its training is %s.",
                   job->seeds, moray_model_name(job->snake.model), job->rung, laws[best].name);
    for (int law = 0; law < n; law++)
        if (!laws[law].tuned || laws[law].collocated || laws[law].knows == SEA_BEFOREHAND)
            moray_text_add(text, sizeof text, "\n%s wins %.0f %% of the draws, median difference %+.3g.",
                           laws[law].name, wins(job, law, best), sea_quantile(job, law, best, by, 0.5));
    if (job->seeds < job->wanted)
        moray_text_add(text, sizeof text, "\nThe time given ended before %d more draws.", job->wanted - job->seeds);
    const moray_report report = {.title = "sea_trials: steering without foreknowledge",
                                 .text = text,
                                 .tables = tables,
                                 .n_tables = 4,
                                 .words = words};
    return moray_app_show(&job->common, &(moray_results){.name = "sea_trials",
                                                         .found = job,
                                                         .summary = summary,
                                                         .print = print,
                                                         .write = write_nothing,
                                                         .draw = sea_draw_figures,
                                                         .report = &report});
}
