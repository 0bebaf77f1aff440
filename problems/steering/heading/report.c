// SPDX-License-Identifier: MIT
#include "heading.h"

// ---- Tables --------------------------------------------------------------------------------------------------------

const steer_score heading_scores[HEADING_SCORES] = {
    {"rms_deg", DEG}, {"final_deg", DEG}, {"largest_deg", DEG}, {"power_W", 1}};

const steer_column heading_columns[] = {{"control: RMS", MORAY_CONTROL_ORIENTED, HEADING_RMS, .unit = DEG},
                                        {"final", MORAY_CONTROL_ORIENTED, HEADING_FINAL, .unit = DEG, .rounded = true},
                                        {"first-pr.: RMS", MORAY_FIRST_PRINCIPLES, HEADING_RMS, .unit = DEG},
                                        {"final", MORAY_FIRST_PRINCIPLES, HEADING_FINAL, .unit = DEG, .rounded = true},
                                        {"largest", MORAY_FIRST_PRINCIPLES, HEADING_LARGEST, .unit = DEG},
                                        {"power", MORAY_FIRST_PRINCIPLES, HEADING_POWER, .unit = 1}};
enum { columns = sizeof heading_columns / sizeof *heading_columns };

static void fig8_table(const heading_job *job, steer_tables *tables)
{
    static const char *const units[] = {"cm", "deg"};
    const moray_table table = {.title = "Offset that the plans found beside the paper's",
                               .columns = {"paper's", "turning", "back", "straight on", "RMS difference"},
                               .n_columns = FIG8_VALUES,
                               .n_rows = 1 + (int)job->steer.common.model};
    for (int model = 0; model < table.n_rows; model++) {
        moray_table_row *row = &tables->rows[tables->n][model];
        *row = (moray_table_row){.label = steer_model_names[model], .unit = units[model]};
        heading_fig8_compare(job, (moray_model)model, row->value);
        for (int k = 0; k < FIG8_VALUES; k++)
            row->value[k] /= model == MORAY_CONTROL_ORIENTED ? 0.01 : DEG;
    }
    steer_add_table(tables, &table);
}

void heading_tables(const steer_job *job, steer_tables *tables)
{
    steer_gait_table(job, tables, steer_gait_given(job)); // the paper's is not swum then
    steer_score_table(job, tables, columns);
    steer_tuning_table(job, tables);
    if (heading_is_fig8((const heading_job *)job))
        fig8_table((const heading_job *)job, tables);
}

// ---- In words ------------------------------------------------------------------------------------------------------

void heading_headline(const steer_job *steer, FILE *file)
{
    const heading_job *job = (const heading_job *)steer;
    fprintf(file, "reference %s over %g s", job->reference_text, job->horizon);
}

void heading_conclude(const steer_job *job, char *text, size_t size)
{
    const steer_trial *optimised =
        steer_best(job, 1 << HEADING_PLAN | 1 << HEADING_BOTH | 1 << HEADING_RECEDING, HEADING_RMS);
    const steer_trial *plain = steer_best(job, 1 << HEADING_FEEDBACK, HEADING_RMS);
    const steer_trial *ahead = steer_best(job, 1 << HEADING_AHEAD, HEADING_RMS);
    const double ours = optimised->score[1][HEADING_RMS] / DEG, theirs = plain->score[1][HEADING_RMS] / DEG;
    const double cunning = ahead->score[1][HEADING_RMS] / DEG;
    snprintf(
        text, size,
        "First-principles model, same limits: the best optimised steering (%s) has an RMS heading error of %.3f "
        "deg, the tuned heading feedback (%s) %.3f deg%s. Given the reference ahead of its time, as the plans are, "
        "the tuned feedback comes to %.3f deg: %s.",
        optimised->name, ours, plain->name, theirs, ours < theirs ? "" : ": the optimised one LOSES", cunning,
        ours < cunning ? "still behind" : "ahead of the plans");
}

void heading_notes(const steer_job *steer, FILE *file)
{
    const heading_job *job = (const heading_job *)steer;
    if (job->gaits_tried > 0)
        fprintf(file,
                "gait of the first-principles plan: %d tried; the objective of the best is %.2f %% below that of the "
                "first\n",
                job->gaits_tried, 100 * (1 - job->best_objective / job->first_objective));
}

double heading_swum(const steer_job *job, const steer_trial *trial)
{
    (void)trial;
    return ((const heading_job *)job)->horizon;
}

// ---- JSON, figures -------------------------------------------------------------------------------------------------

void heading_json_head(const steer_job *steer, moray_json *json)
{
    const heading_job *job = (const heading_job *)steer;
    moray_json_text(json, "reference", job->reference_text);
    moray_json_number(json, "horizon_s", job->horizon);
    moray_json_text(json, "scheme", steer->common.scheme);
}

void heading_json_plan(const steer_job *job, moray_json *json, moray_model model)
{
    steer_json_gait(job, json, 1 + (int)model);
}

static void json_fig8(moray_json *json, const heading_job *job)
{
    static const char *const models[] = {"control", "fp"};
    static const char *const keys[][FIG8_VALUES] = {
        {"paper_m", "turning_m", "back_m", "straight_m", "rms_difference_m"},
        {"paper_deg", "turning_deg", "back_deg", "straight_deg", "rms_difference_deg"}};
    moray_json_open(json, "fig8_offset");
    for (int model = 0; model <= (int)job->steer.common.model; model++) {
        double match[FIG8_VALUES];
        heading_fig8_compare(job, (moray_model)model, match);
        moray_json_open(json, models[model]);
        for (int k = 0; k < FIG8_VALUES; k++)
            moray_json_number(json, keys[model][k], match[k] / (model == MORAY_CONTROL_ORIENTED ? 1 : DEG));
        moray_json_close(json);
    }
    moray_json_close(json);
}

void heading_json_tail(const steer_job *steer, moray_json *json)
{
    const heading_job *job = (const heading_job *)steer;
    char text[STEER_TEXT];
    heading_explain(steer, text, sizeof text);
    if (heading_is_fig8(job))
        json_fig8(json, job);
    moray_json_number(json, "gaits_tried", job->gaits_tried);
    moray_json_open(json, "limits");
    moray_json_number(json, "turn_rate_deg_s", fabs(steer->turn_rate[steer->common.model]) / DEG);
    moray_json_number(json, "reference_rate_deg_s", moray_reference_fastest(&job->reference, 0, job->horizon) / DEG);
    steer_json_saturation(steer, json, steer->common.model);
    moray_json_text(json, "in_words", text);
    moray_json_close(json);
}

bool heading_values(const steer_job *job, const steer_trial *trial, const moray_swim_track *track, double *values)
{
    double rate;
    for (int k = 0; k < track->n; k++) {
        const double t = track->t[k];
        values[k] = (trial ? moray_straight_motion_heading(&job->straight[trial->gait][1], t, track->pose[k].heading)
                           : moray_reference_at(&((const heading_job *)job)->reference, t, &rate)) /
                    DEG;
    }
    return true;
}

moray_status heading_draw(const steer_job *steer)
{
    const heading_job *job = (const heading_job *)steer;
    return heading_is_fig8(job) ? heading_fig8_draw(job) : moray_ok();
}
