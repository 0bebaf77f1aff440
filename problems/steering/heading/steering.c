// SPDX-License-Identifier: MIT
#include "heading.h"

#include <string.h>

static const double look_every = 0.1;     // for a new command [s]
static const double command_change = DEG; // that calls for a new plan

// ---- Laws ----------------------------------------------------------------------------------------------------------

// phi_0 = k (theta_ref - theta), or of theta_ref ahead of its time; a plan, blindly, and with k (theta_plan - theta);
// plans made anew from the measured state, without knowing the reference ahead too.
enum { FEEDBACK, FEEDBACK_AHEAD, PLAN, BOTH, RECEDING, RECEDING_UNKNOWING };
enum { GAIN, LEAD, NUMBERS };
enum { RMS, FINAL, LARGEST, POWER, SCORES }; // as of moray_heading_score

static const steer_number numbers[NUMBERS] = {
    [GAIN] = {"gain_m_rad", "gain, cm/deg", 100 * DEG, .logarithmic = true, .lower = 0.002, .upper = 2},
    [LEAD] = {"lead_s", "ahead, s", 1, .upper = 8},
};

static double reference_ahead(const moray_swim_sample *sample, void *self)
{
    const steer_steersman *h = self;
    double rate;
    return moray_reference_at(&((const heading_job *)h->job)->reference, sample->t + h->trial->number[LEAD], &rate);
}

static moray_status set_feedback(steer_steersman *h)
{
    steer_set_feedback(h, h->trial->number[GAIN], reference_ahead, NULL, h);
    return moray_ok();
}

static moray_status set_receding(steer_steersman *h)
{
    const moray_straight_motion *straight = &h->job->straight[h->trial->gait][h->trial->plan];
    const bool preview = h->trial->law->preview;
    moray_heading_replanner *replanner = &h->own.heading;
    *replanner = (moray_heading_replanner){.spec = heading_spec((const heading_job *)h->job, h->trial->plan, false),
                                           .horizon = h->job->look_ahead_periods * 2 * M_PI / straight->gait.omega,
                                           .preview = preview,
                                           .tolerance = command_change};
    replanner->spec.max_error = MORAY_INFINITY;
    memcpy(replanner->spec.undulation, straight->undulation, sizeof straight->undulation);
    return steer_set_receding(h, "radau3", moray_heading_replan(replanner), &replanner->spec.limits,
                              preview ? 0 : look_every, NULL);
}

static const steer_law laws[] = {
    [FEEDBACK] = {"feedback", .set = set_feedback, .tuned = 1 << GAIN, .start = {0.12, 0}, .curve = 1},
    [FEEDBACK_AHEAD] = {"feedback", .preview = true, .set = set_feedback, .tuned = 1 << GAIN | 1 << LEAD,
                        .start = {0.12, 2.5}, .curve = 2},
    [PLAN] = {"plan", STEER_PLANNED, .preview = true, .start = {NAN, 0}, .curve = 3},
    [BOTH] = {"plan and feedback", STEER_PLANNED, .preview = true, .set = steer_set_both, .tuned = 1 << GAIN,
              .start = {0.12, 0}},
    [RECEDING] = {"receding", STEER_RECEDING, .preview = true, .set = set_receding, .start = {NAN, 0}},
    [RECEDING_UNKNOWING] = {"receding", STEER_RECEDING, .set = set_receding, .start = {NAN, 0}},
};

static void choose_trials(steer_job *job)
{
    const moray_model any = MORAY_CONTROL_ORIENTED;
    const int found = 1 + (int)job->snake.model;
    const bool given = steer_gait_given(job);
    if (!given)
        steer_add(job, "feedback, paper's gait", &laws[FEEDBACK], 0, any);
    steer_add(job, given ? "feedback" : "feedback, gait found", &laws[FEEDBACK], found, any);
    steer_add(job, given ? "feedback ahead" : "feedback ahead, gait found", &laws[FEEDBACK_AHEAD], found, any);
    steer_add_plans(job, &laws[PLAN], &laws[BOTH]);
    steer_add_receding(job, &laws[RECEDING]);
    if (job->receding)
        steer_add(job, "receding, nothing known ahead", &laws[RECEDING_UNKNOWING], found, any);
}

// ---- Swimming ------------------------------------------------------------------------------------------------------

static void start(steer_steersman *h, moray_swim_closed_loop_spec *spec)
{
    const heading_job *job = (const heading_job *)h->job;
    double rate;
    spec->heading = moray_reference_at(&job->reference, 0, &rate);
    spec->duration = job->horizon;
}

// What the plans minimise, but for the steering.
static double judge(const steer_trial *trial, const steer_steersman *h, const moray_swim_closed_loop *closed_loop,
                    double *score)
{
    const heading_job *job = (const heading_job *)h->job;
    const moray_heading_score s =
        moray_swim_closed_loop_heading_score(closed_loop, &h->job->straight[trial->gait][h->model], &job->reference);
    score[RMS] = s.rms;
    score[FINAL] = s.final;
    score[LARGEST] = s.largest;
    score[POWER] = s.power;
    return s.rms * s.rms / (100 * DEG * DEG) + job->weight_power * s.power;
}

// ---- Tables --------------------------------------------------------------------------------------------------------

static const steer_score scores[SCORES] = {{"rms_deg", DEG}, {"final_deg", DEG}, {"largest_deg", DEG}, {"power_W", 1}};

static const steer_column score_columns[] = {{"control: RMS", MORAY_CONTROL_ORIENTED, RMS, .unit = DEG},
                                             {"final", MORAY_CONTROL_ORIENTED, FINAL, .unit = DEG, .rounded = true},
                                             {"first-pr.: RMS", MORAY_FIRST_PRINCIPLES, RMS, .unit = DEG},
                                             {"final", MORAY_FIRST_PRINCIPLES, FINAL, .unit = DEG, .rounded = true},
                                             {"largest", MORAY_FIRST_PRINCIPLES, LARGEST, .unit = DEG},
                                             {"power", MORAY_FIRST_PRINCIPLES, POWER, .unit = 1}};

static void fig8_table(const heading_job *job, steer_tables *tables)
{
    static const char *const units[] = {"cm", "deg"};
    const moray_table table = {.title = "Offset that the plans found beside the paper's",
                               .columns = {"paper's", "turning", "back", "straight on", "RMS difference"},
                               .n_columns = FIG8_VALUES,
                               .n_rows = 1 + (int)job->steer.snake.model};
    for (int model = 0; model < table.n_rows; model++) {
        moray_table_row *row = &tables->rows[tables->n][model];
        *row = (moray_table_row){.label = moray_model_name(model), .unit = units[model]};
        heading_fig8_compare(job, (moray_model)model, row->value);
        for (int k = 0; k < FIG8_VALUES; k++)
            row->value[k] /= model == MORAY_CONTROL_ORIENTED ? 0.01 : DEG;
    }
    steer_add_table(tables, &table);
}

static void tables(const steer_job *job, steer_tables *tables)
{
    steer_gait_table(job, tables, steer_gait_given(job)); // the paper's is not swum then
    steer_score_table(job, tables, sizeof score_columns / sizeof *score_columns);
    steer_tuning_table(job, tables);
    if (heading_is_fig8((const heading_job *)job))
        fig8_table((const heading_job *)job, tables);
}

// ---- In words ------------------------------------------------------------------------------------------------------

static void headline(const steer_job *steer, FILE *file)
{
    const heading_job *job = (const heading_job *)steer;
    fprintf(file, "reference %s over %g s", job->reference_text, job->horizon);
}

static void conclude(const steer_job *job, char *text, size_t size)
{
    const steer_trial *optimised = steer_best(job, 1 << PLAN | 1 << BOTH | 1 << RECEDING, RMS);
    const steer_trial *plain = steer_best(job, 1 << FEEDBACK, RMS);
    const steer_trial *ahead = steer_best(job, 1 << FEEDBACK_AHEAD, RMS);
    const double ours = optimised->score[1][RMS] / DEG, theirs = plain->score[1][RMS] / DEG;
    const double cunning = ahead->score[1][RMS] / DEG;
    snprintf(
        text, size,
        "First-principles model, same limits: the best optimised steering (%s) has an RMS heading error of %.3f "
        "deg, the tuned heading feedback (%s) %.3f deg%s. Given the reference ahead of its time, as the plans are, "
        "the tuned feedback comes to %.3f deg: %s.",
        optimised->name, ours, plain->name, theirs, ours < theirs ? "" : ": the optimised one LOSES", cunning,
        ours < cunning ? "still behind" : "ahead of the plans");
}

static void notes(const steer_job *steer, FILE *file)
{
    const heading_job *job = (const heading_job *)steer;
    if (job->gaits_tried > 0)
        fprintf(file,
                "gait of the first-principles plan: %d tried; the objective of the best is %.2f %% below that of the "
                "first\n",
                job->gaits_tried, 100 * (1 - job->best_objective / job->first_objective));
}

static double swum(const steer_job *job, const steer_trial *trial)
{
    (void)trial;
    return ((const heading_job *)job)->horizon;
}

// ---- JSON, figures -------------------------------------------------------------------------------------------------

static void json_head(const steer_job *steer, moray_json *json)
{
    const heading_job *job = (const heading_job *)steer;
    moray_json_text(json, "reference", job->reference_text);
    moray_json_number(json, "horizon_s", job->horizon);
    moray_json_text(json, "scheme", steer->common.scheme);
}

static void json_plan(const steer_job *job, moray_json *json, moray_model model)
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
    for (int model = 0; model <= (int)job->steer.snake.model; model++) {
        double match[FIG8_VALUES];
        heading_fig8_compare(job, (moray_model)model, match);
        moray_json_open(json, models[model]);
        for (int k = 0; k < FIG8_VALUES; k++)
            moray_json_number(json, keys[model][k], match[k] / (model == MORAY_CONTROL_ORIENTED ? 1 : DEG));
        moray_json_close(json);
    }
    moray_json_close(json);
}

static void json_tail(const steer_job *steer, moray_json *json)
{
    const heading_job *job = (const heading_job *)steer;
    char text[STEER_TEXT];
    heading_explain(steer, text, sizeof text);
    if (heading_is_fig8(job))
        json_fig8(json, job);
    moray_json_number(json, "gaits_tried", job->gaits_tried);
    moray_json_open(json, "limits");
    moray_json_number(json, "turn_rate_deg_s", fabs(steer->turn_rate[steer->snake.model]) / DEG);
    moray_json_number(json, "reference_rate_deg_s", moray_reference_fastest(&job->reference, 0, job->horizon) / DEG);
    steer_json_saturation(steer, json, steer->snake.model);
    moray_json_text(json, "in_words", text);
    moray_json_close(json);
}

static bool values(const steer_job *job, const steer_trial *trial, const moray_swim_track *track, double *values)
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

static moray_status draw(const steer_job *steer)
{
    const heading_job *job = (const heading_job *)steer;
    return heading_is_fig8(job) ? heading_fig8_draw(job) : moray_ok();
}

// ---- The program ---------------------------------------------------------------------------------------------------

// Who swims on the paper's gait where that takes more than the power allowed is no rival.
static void bar_trials(steer_job *job)
{
    const moray_model model = job->snake.model;
    const bool beyond = job->straight[0][model].power > (1 + 1e-6) * steer_limits(job, model).power;
    for (int k = 0; k < job->n_trials; k++)
        job->trial[k].barred = job->trial[k].gait == 0 && beyond;
}

static moray_status work(steer_job *steer)
{
    heading_job *job = (heading_job *)steer;
    if (heading_is_fig8(job))
        MORAY_TRY(heading_fig8_prepare(job));
    else
        MORAY_TRY(moray_reference_read(&job->reference, job->reference_text));
    if (isnan(job->horizon))
        job->horizon = 100;
    choose_trials(steer);
    MORAY_TRY(heading_plan_first(job));
    bar_trials(steer);
    MORAY_TRY(steer_run_trials(steer));
    if (steer->snake.model == MORAY_CONTROL_ORIENTED)
        return moray_ok();
    MORAY_TRY(heading_plan_last(job));
    return steer_run_trials(steer);
}

static void release(steer_job *steer)
{
    moray_reference_free(&((heading_job *)steer)->reference);
}

const steer_program heading_steering = {
    .work = work,
    .release = release,
    .laws = laws,
    .numbers = numbers,
    .n_numbers = NUMBERS,
    .x_tolerance = 3e-3,
    .f_tolerance = 3e-4,
    .rough_per_second = 10,
    .start = start,
    .judge = judge,
    .scores = scores,
    .n_scores = SCORES,
    .score_title = "Heading error, without the undulation, deg; power, W",
    .columns = score_columns,
    .tables = tables,
    .headline = headline,
    .conclude = conclude,
    .explain = heading_explain,
    .notes = notes,
    .swum = swum,
    .tells_preview = true,
    .json_head = json_head,
    .json_plan = json_plan,
    .json_tail = json_tail,
    .over_time = {.name = "heading",
                  .title = "Heading without its undulation, first-principles model",
                  .y_label = "heading [deg]"},
    .values = values,
    .draw = draw,
};
