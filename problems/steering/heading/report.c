// SPDX-License-Identifier: MIT
#include "job.h"

static const char *const model_names[] = {"control-oriented", "first-principles"};
enum { text_size = 1200 };

// ---- Tables --------------------------------------------------------------------------------------------------------

enum { most_tables = 4, most_rows = HEADING_TRIALS + 2 };

typedef struct report_tables {
    int n;
    moray_table table[most_tables];
    moray_table_row rows[most_tables][most_rows];
} report_tables;

// Zero where it is as good as zero, so that tables show no rounding.
static double small(double value)
{
    return fabs(value) < 5e-4 ? 0 : value;
}

static void score_rows(const heading_job *job, moray_table_row *rows)
{
    for (int k = 0; k < job->n_trials; k++) {
        const heading_trial *trial = &job->trial[k];
        const moray_heading_score *control = &trial->score[0], *revolute = &trial->score[1];
        rows[k] = (moray_table_row){.label = trial->name,
                                    .value = {control->rms / DEG, small(control->final / DEG), revolute->rms / DEG,
                                              small(revolute->final / DEG), revolute->largest / DEG, revolute->power}};
    }
}

static int gait_rows(const heading_job *job, moray_table_row *rows)
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
    for (int i = 0; i < count; i++)
        rows[i] = (moray_table_row){.label = labels[i][0], .unit = labels[i][1]};
    const int first = steer_gait_given(&job->input); // the paper's is not swum then
    for (int g = first; g <= 1 + (int)job->common.model; g++) {
        const moray_straight_motion *control = &job->straight[g][0], *revolute = &job->straight[g][1];
        const double values[count] = {moray_theta_max_from_amplitude(&job->common.robot, MORAY_CONTROL_ORIENTED,
                                                                     control->gait.amplitude, control->gait.delta) /
                                          DEG,
                                      control->gait.omega / DEG,
                                      control->gait.delta / DEG,
                                      100 * control->gait.amplitude,
                                      revolute->gait.amplitude / DEG,
                                      control->speed,
                                      revolute->speed,
                                      revolute->power};
        for (int i = 0; i < count; i++)
            rows[i].value[g - first] = values[i];
    }
    return count;
}

static int tuning_rows(const heading_job *job, moray_table_row *rows)
{
    int n = 0;
    for (int k = 0; k < job->n_trials; k++) {
        const heading_trial *trial = &job->trial[k];
        if (trial->evaluations > 0)
            rows[n++] = (moray_table_row){
                .label = trial->name,
                .value = {100 * trial->gain * DEG, trial->preview ? trial->lead : NAN, trial->evaluations}};
    }
    return n;
}

static int fig8_rows(const heading_job *job, moray_table_row *rows)
{
    int model = 0;
    for (; model <= (int)job->common.model; model++) {
        const heading_fig8_match match = heading_fig8_compare(job, (moray_model)model);
        const double unit = model == MORAY_CONTROL_ORIENTED ? 0.01 : DEG;
        rows[model] = (moray_table_row){.label = model_names[model],
                                        .unit = model == MORAY_CONTROL_ORIENTED ? "cm" : "deg",
                                        .value = {match.paper / unit, match.there / unit, match.back / unit,
                                                  match.straight / unit, match.rms / unit}};
    }
    return model;
}

static void make_tables(const heading_job *job, report_tables *t)
{
    score_rows(job, t->rows[1]);
    const bool given = steer_gait_given(&job->input);
    t->table[0] = (moray_table){.title = "Gait",
                                .columns = {given ? "given" : "paper's", "control opt.", "first-pr. opt."},
                                .n_columns = given ? 1 : 2 + (int)job->common.model,
                                .rows = t->rows[0],
                                .n_rows = gait_rows(job, t->rows[0])};
    t->table[1] = (moray_table){.title = "Heading error, without the undulation, deg; power, W",
                                .columns = {"control: RMS", "final", "first-pr.: RMS", "final", "largest", "power"},
                                .n_columns = 6,
                                .rows = t->rows[1],
                                .n_rows = job->n_trials};
    t->table[2] = (moray_table){.title = "Tuned on the first-principles model",
                                .columns = {"gain, cm/deg", "ahead, s", "simulations"},
                                .n_columns = 3,
                                .rows = t->rows[2],
                                .n_rows = tuning_rows(job, t->rows[2])};
    t->n = 3;
    if (heading_is_fig8(job))
        t->table[t->n++] = (moray_table){.title = "Offset that the plans found beside the paper's",
                                         .columns = {"paper's", "turning", "back", "straight on", "RMS difference"},
                                         .n_columns = 5,
                                         .rows = t->rows[3],
                                         .n_rows = fig8_rows(job, t->rows[3])};
}

// ---- In words ------------------------------------------------------------------------------------------------------

// Whether the trial swims on the paper's gait, and that takes more than the power allowed.
static bool beyond_power(const heading_job *job, const heading_trial *trial)
{
    const moray_straight_motion *paper = &job->straight[0][job->common.model];
    return trial->gait == 0 && paper->power > (1 + 1e-6) * heading_spec(job, paper->model, false).limits.power;
}

// The best of the trials that pass the filter and keep the limits, by RMS on the first-principles model.
static const heading_trial *best_trial(const heading_job *job, bool feedback, bool preview)
{
    const heading_trial *best = NULL;
    for (int k = 0; k < job->n_trials; k++) {
        const heading_trial *trial = &job->trial[k];
        if ((trial->law == HEADING_FEEDBACK) == feedback && trial->preview == preview && !beyond_power(job, trial) &&
            (!best || trial->score[1].rms < best->score[1].rms))
            best = trial;
    }
    return best;
}

static void verdict(const heading_job *job, char *text, size_t size)
{
    const heading_trial *optimised = best_trial(job, false, true), *plain = best_trial(job, true, false);
    const heading_trial *ahead = best_trial(job, true, true);
    const double ours = optimised->score[1].rms / DEG, theirs = plain->score[1].rms / DEG;
    const double cunning = ahead->score[1].rms / DEG;
    snprintf(
        text, size,
        "First-principles model, same limits: the best optimised steering (%s) has an RMS heading error of %.3f "
        "deg, the tuned heading feedback (%s) %.3f deg%s. Given the reference ahead of its time, as the plans are, "
        "the tuned feedback comes to %.3f deg: %s.",
        optimised->name, ours, plain->name, theirs, ours < theirs ? "" : ": the optimised one LOSES", cunning,
        ours < cunning ? "still behind" : "ahead of the plans");
}

static void receding_line(const heading_job *job, const heading_trial *trial, char *text, size_t size)
{
    const moray_receding_horizon_record *r = &trial->record[MORAY_FIRST_PRINCIPLES];
    snprintf(
        text, size,
        "%s: %d plans of %.3g periods, each %.2g s of processor time on average (the longest after the first %.2g s) "
        "and %.1f iterations; %.1f times faster than real time on one core%s%s",
        trial->name, r->plans, job->look_ahead_periods, r->seconds / r->plans, r->longest,
        (double)r->iterations / r->plans, job->horizon / r->seconds, r->failures ? "; not solved at first: " : "",
        r->failures ? r->first_failure : "");
}

static void solver_line(const char *what, const char *scheme, const moray_heading_plan *plan, char *text, size_t size)
{
    char line[300];
    int meshes;
    const moray_mesh_record *record = moray_solution_history(plan->solution, &meshes);
    moray_solver_line(plan->solution, scheme, record[meshes - 1].intervals, line, sizeof line);
    snprintf(text, size, "%s: %s", what, line);
}

// ---- Standard output -----------------------------------------------------------------------------------------------

static void print_all(const heading_job *job, const report_tables *t)
{
    char text[text_size];
    printf("%d links, current (%g, %g) m/s, reference %s over %g s\n\n", job->common.robot.links,
           job->common.current[0], job->common.current[1], job->reference_text, job->horizon);
    for (int k = 0; k < t->n; k++) {
        moray_table_print(&t->table[k], stdout);
        printf("\n");
    }
    verdict(job, text, sizeof text);
    printf("%s\n\n", text);
    heading_explain(job, text, sizeof text);
    printf("%s\n\n", text);
    if (job->gaits_tried > 0)
        printf("gait of the first-principles plan: %d tried; the objective of the best is %.2f %% below that of the "
               "first\n",
               job->gaits_tried, 100 * (1 - job->best_objective / job->first_objective));
    for (int k = 0; k < job->n_trials; k++)
        if (job->trial[k].law == HEADING_RECEDING) {
            receding_line(job, &job->trial[k], text, sizeof text);
            printf("%s\n", text);
        }
    solver_line("period-averaged plan", HEADING_AVERAGED_SCHEME, &job->averaged, text, sizeof text);
    printf("%s\n", text);
    for (int model = 0; model <= (int)job->common.model; model++) {
        solver_line(model_names[model], job->common.scheme, &job->plan[model], text, sizeof text);
        printf("%s\n", text);
        moray_certificate_line(&job->certificate[model], text, sizeof text);
        printf("    %s\n", text);
    }
}

// ---- Files ---------------------------------------------------------------------------------------------------------

static moray_status write_files(heading_job *job, const report_tables *t, const moray_json *json)
{
    moray_output *output = job->common.output;
    char text[2 * text_size];
    FILE *file;
    MORAY_TRY(moray_output_file(output, "summary.json", &file));
    MORAY_TRY(moray_json_write(json, file));
    MORAY_TRY(heading_draw(job));
    verdict(job, text, text_size);
    const moray_report report = {.title = "heading_tracking",
                                 .text = text,
                                 .tables = t->table,
                                 .n_tables = t->n,
                                 .argc = job->common.argc,
                                 .argv = job->common.argv};
    MORAY_TRY(moray_output_report(output, &report));
    return moray_output_commit(output);
}

moray_status heading_report(heading_job *job)
{
    report_tables t;
    make_tables(job, &t);
    moray_json *json = heading_json(job);
    moray_status status = job->common.output ? write_files(job, &t, json) : moray_ok();
    if (!moray_failed(status) && job->common.json)
        status = moray_json_write(json, stdout);
    else if (!moray_failed(status))
        print_all(job, &t);
    moray_json_free(json);
    return status;
}
