// SPDX-License-Identifier: MIT
#include "heading.h"

#include <string.h>

static const double look_every = 0.1;     // for a new command [s]
static const double command_change = DEG; // that calls for a new plan

// ---- Laws ----------------------------------------------------------------------------------------------------------

// Laws of moray_heading_gains, by what they know and have; a plan, blindly, and with k (theta_plan - theta); plans made
// anew from the measured state, without knowing the reference ahead too.
enum { P, P_FORWARD, PID, P_AHEAD, ALL, PLAN, BOTH, RECEDING, RECEDING_UNKNOWING };
enum { GAIN, FORWARD, LEAD, INTEGRAL, DERIVATIVE, NUMBERS };
enum { RMS, FINAL, LARGEST, POWER, SCORES }; // as of moray_heading_score

static const steer_number numbers[NUMBERS] = {
    [GAIN] = {"gain_m_rad", "gain, cm/deg", 100 * DEG, .searched = {MORAY_TUNED_LOGARITHMIC, 0.002, 20, 0}},
    [FORWARD] = {"forward_m_s_rad", "forward, cm s/deg", 100 * DEG, .searched = {MORAY_TUNED_WITH_ZERO, 0, 20, 0.05}},
    [LEAD] = {"lead_s", "ahead, s", 1, .searched = {MORAY_TUNED_WITH_ZERO, 0, 8, 0.1}},
    [INTEGRAL] = {"integral_1_s", "integral, 1/s", 1, .searched = {MORAY_TUNED_WITH_ZERO, 0, 20, 0.01}},
    [DERIVATIVE] = {"derivative_s", "derivative, s", 1, .searched = {MORAY_TUNED_WITH_ZERO, 0, 5, 0.05}},
};
static const double smoothing = 0.5; // of the heading whose rate the derivative is [s]

static moray_status set_feedback(steer_steersman *h)
{
    const double *number = h->trial->number;
    h->own.law = (moray_heading_law){
        .gains = {number[GAIN], number[FORWARD], number[LEAD], number[INTEGRAL], number[DERIVATIVE]},
        .reference = &((const heading_job *)h->job)->reference,
        .feedback = &h->feedback,
        .scale = steer_offset_ratio(h->job, h->trial->gait, MORAY_CONTROL_ORIENTED, h->model),
        .smoothing = smoothing};
    steer_set_feedback(h, number[GAIN], moray_heading_law_target, moray_heading_law_feed, &h->own.law);
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
    [P] = {"feedback", .set = set_feedback, .tuned = 1 << GAIN, .start = {0.12}, .curve = 1},
    [P_FORWARD] = {"feedback and rate", .set = set_feedback, .tuned = 1 << GAIN | 1 << FORWARD, .start = {0.12, 0.2}},
    [PID] = {"PID", .set = set_feedback, .tuned = 1 << GAIN | 1 << INTEGRAL | 1 << DERIVATIVE,
             .start = {0.12, .0, 0, 0.05, 0.5}},
    [P_AHEAD] = {"feedback", .preview = true, .set = set_feedback, .tuned = 1 << GAIN | 1 << LEAD,
                 .start = {0.12, 0, 2.5}},
    [ALL] = {"PID and rate", .preview = true, .set = set_feedback, .tuned = (1 << NUMBERS) - 1,
             .start = {0.12, 0.2, 2.5, 0.05, 0.5}, .curve = 2},
    [PLAN] = {"plan", STEER_PLANNED, .preview = true, .start = {NAN, NAN, 0, NAN, NAN}, .curve = 3},
    [BOTH] = {"plan and feedback", STEER_PLANNED, .preview = true, .set = steer_set_both, .tuned = 1 << GAIN,
              .start = {0.12, NAN, 0, NAN, NAN}},
    [RECEDING] = {"receding", STEER_RECEDING, .preview = true, .set = set_receding, .start = {NAN, NAN, 0, NAN, NAN}},
    [RECEDING_UNKNOWING] = {"receding", STEER_RECEDING, .set = set_receding, .start = {NAN, NAN, 0, NAN, NAN}},
};

// What feeds the reference's rate forward, where it has none, moves nothing.
static void leave_out_rate(steer_job *job)
{
    const moray_reference *reference = &((const heading_job *)job)->reference;
    if (moray_reference_fastest(reference, 0, INFINITY) > 0)
        return;
    for (int k = 0; k < job->n_trials; k++)
        if (job->trial[k].tuned & 1u << FORWARD) {
            job->trial[k].tuned &= ~(1u << FORWARD);
            job->trial[k].number[FORWARD] = 0;
        }
}

// On the gait of the last plan all that feedback can be given; on the paper's, where another was found, the plainest.
static void choose_trials(steer_job *job)
{
    const moray_model any = MORAY_CONTROL_ORIENTED;
    const int found = 1 + (int)job->snake.model;
    if (!steer_gait_given(job))
        steer_add(job, "P, paper's gait", &laws[P], 0, any);
    steer_trial *p = steer_add(job, "P", &laws[P], found, any);
    steer_trial *rate = steer_add(job, "P, rate fed forward", &laws[P_FORWARD], found, any);
    steer_trial *pid = steer_add(job, "PID", &laws[PID], found, any);
    steer_trial *ahead = steer_add(job, "P ahead", &laws[P_AHEAD], found, any);
    steer_trial *all = steer_add(job, "PID ahead, rate fed forward", &laws[ALL], found, any);
    rate->subset[0] = pid->subset[0] = ahead->subset[0] = p;
    all->subset[0] = rate;
    all->subset[1] = pid;
    all->subset[2] = ahead;
    steer_add_plans(job, &laws[PLAN], &laws[BOTH]);
    steer_add_receding(job, &laws[RECEDING]);
    if (job->receding)
        steer_add(job, "receding, nothing known ahead", &laws[RECEDING_UNKNOWING], found, any);
    leave_out_rate(job);
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

static const steer_trial *trial_of(const steer_job *job, int law)
{
    return steer_best(job, 1u << law, RMS);
}

static void say_errors(const steer_job *job, const char *before, const int *of, int n, char *text, size_t size)
{
    moray_text_add(text, size, "%s", before);
    for (int k = 0; k < n; k++) {
        const steer_trial *trial = trial_of(job, of[k]);
        if (trial)
            moray_text_add(text, size, "%s%s %.4g", k ? ", " : " ", trial->name, trial->score[1][RMS] / DEG);
    }
}

// Rivals beside the plan of the same gait, each group with who knows as much.
static void conclude(const steer_job *job, char *text, size_t size)
{
    static const int ahead[] = {P_AHEAD, ALL}, now[] = {P, P_FORWARD, PID}, planner[] = {BOTH, RECEDING},
                     unknowing[] = {RECEDING_UNKNOWING};
    const steer_trial *best = steer_best(job, 1 << P_AHEAD | 1 << ALL, RMS), *plan = trial_of(job, BOTH);
    const double ratio = plan && best ? plan->score[1][RMS] / best->score[1][RMS] : NAN;
    *text = 0;
    moray_text_add(
        text, size,
        "First-principles model, same limits, RMS heading error in deg. Told the reference ahead of its time:");
    say_errors(job, "", planner, 2, text, size);
    say_errors(job, "; tuned feedback:", ahead, 2, text, size);
    say_errors(job, ". Told no more than the reference and its rate now, tuned feedback:", now, 3, text, size);
    if (trial_of(job, RECEDING_UNKNOWING))
        say_errors(job, ";", unknowing, 1, text, size);
    moray_text_add(text, size, ".");
    if (isnan(ratio))
        return;
    moray_text_add(text, size, " Plan with feedback against the best rival who knows as much: %.3g times its error%s.",
                   ratio, ratio < 1 ? "" : ": the plan LOSES");
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

// Without the first-principles plan.
static void choose_again(steer_job *job)
{
    const steer_job before = *job;
    job->n_trials = 0;
    choose_trials(job);
    bar_trials(job);
    steer_keep_trials(job, before.trial, before.n_trials);
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
    const moray_gait paper = moray_gait_paper(&steer->snake.robot);
    choose_trials(steer);
    MORAY_TRY(steer_straight_motions(steer, 0, &paper, MORAY_CONTROL_ORIENTED));
    bar_trials(steer);
    MORAY_TRY(steer_begin_trials(steer));
    MORAY_TRY(heading_plan_first(job));
    if (steer->snake.model == MORAY_CONTROL_ORIENTED)
        return steer_run_trials(steer);
    MORAY_TRY(steer_begin_trials(steer));
    const moray_status last = heading_plan_last(job);
    if (moray_failed(last)) {
        MORAY_TRY(steer_end_errands(steer));
        MORAY_TRY(steer_do_without(steer, last));
        choose_again(steer);
    }
    return steer_run_trials(steer);
}

static void release(steer_job *steer)
{
    moray_reference_free(&((heading_job *)steer)->reference);
}

static const moray_meaning words[] = {
    {"P", "joint offset in proportion to the heading error"},
    {"PID", "with its integral and its rate"},
    {"rate fed forward", "with the rate that the reference has"},
    {"ahead", "told the reference some time ahead, as plans are"},
    {NULL, NULL},
};

const steer_program heading_steering = {
    .work = work,
    .release = release,
    .laws = laws,
    .numbers = numbers,
    .n_numbers = NUMBERS,
    .rough_per_second = 10,
    .start = start,
    .judge = judge,
    .scores = scores,
    .n_scores = SCORES,
    .title = "heading_tracking: a heading followed in a current",
    .words = words,
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
