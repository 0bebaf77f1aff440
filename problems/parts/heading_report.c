// SPDX-License-Identifier: MIT
#include <stdlib.h>

#include "heading_job.h"

static const char *const model_names[] = {"control-oriented", "first-principles"};
enum { text_size = 1200 };

// ---- Tables
// -----------------------------------------------------------------------------------------------------------

enum { tables = 3, most_rows = HEADING_TRIALS + 2 };

typedef struct report_tables {
    moray_table table[tables];
    moray_table_row rows[tables][most_rows];
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
    for (int g = 0; g <= 1 + (int)job->common.model; g++) {
        const moray_cruise *control = &job->cruise[g][0], *revolute = &job->cruise[g][1];
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
            rows[i].value[g] = values[i];
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

static void make_tables(const heading_job *job, report_tables *t)
{
    score_rows(job, t->rows[1]);
    t->table[0] = (moray_table){.title = "Gait",
                                .columns = {"paper's", "control opt.", "first-pr. opt."},
                                .n_columns = 2 + (int)job->common.model,
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
}

// ---- In words
// ---------------------------------------------------------------------------------------------------------

// The best of the trials that pass the filter, by RMS on the first-principles model.
static const heading_trial *best_trial(const heading_job *job, bool feedback, bool preview)
{
    const heading_trial *best = NULL;
    for (int k = 0; k < job->n_trials; k++) {
        const heading_trial *trial = &job->trial[k];
        if ((trial->law == HEADING_FEEDBACK) == feedback && trial->preview == preview &&
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
    const moray_recede_record *r = &trial->record[MORAY_FIRST_PRINCIPLES];
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

// ---- Standard output
// --------------------------------------------------------------------------------------------------

static void print_all(const heading_job *job, const report_tables *t)
{
    char text[text_size];
    printf("%d links, current (%g, %g) m/s, reference %s over %g s\n\n", job->common.robot.links,
           job->common.current[0], job->common.current[1], job->reference_text, job->horizon);
    for (int k = 0; k < tables; k++) {
        moray_table_print(&t->table[k], stdout);
        printf("\n");
    }
    verdict(job, text, sizeof text);
    printf("%s\n\n", text);
    heading_explain(job, text, sizeof text);
    printf("%s\n\n", text);
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

// ---- Figures
// ----------------------------------------------------------------------------------------------------------

enum { shown = 3 };

// The tuned feedback, the same ahead of its time, the last plan.
static void choose_shown(heading_job *job, heading_trial **trials)
{
    trials[0] = &job->trial[1];
    trials[1] = &job->trial[2];
    for (int k = 0; k < job->n_trials; k++)
        if (job->trial[k].law == HEADING_PLAN)
            trials[2] = &job->trial[k];
}

static moray_status draw_over_time(const heading_job *job, heading_trial *const *trials, const moray_voyage *voyages)
{
    const int n = voyages->track.n;
    const double *t = voyages->track.t;
    double *data = malloc((size_t)(n * (2 * shown + 1)) * sizeof *data), *reference = data + 2 * shown * n, rate;
    moray_curve heading[shown + 1], offset[shown];
    if (!data)
        return moray_error(MORAY_MEMORY, "no memory for figures");
    for (int k = 0; k < n; k++)
        reference[k] = moray_reference_at(&job->reference, t[k], &rate) / DEG;
    heading[0] = (moray_curve){.label = "reference", .x = t, .y = reference, .n = n};
    for (int i = 0; i < shown; i++) {
        const moray_cruise *cruise = &job->cruise[trials[i]->gait][1];
        double *angle = data + 2 * i * n, *phi = angle + n;
        for (int k = 0; k < n; k++) {
            angle[k] = moray_cruise_heading(cruise, t[k], voyages[i].track.pose[k].heading) / DEG;
            phi[k] = voyages[i].offset[k] / DEG;
        }
        heading[1 + i] = (moray_curve){.label = trials[i]->name, .x = t, .y = angle, .n = n};
        offset[i] = (moray_curve){.label = trials[i]->name, .x = t, .y = phi, .n = n};
    }
    moray_status status = steer_draw(job->common.output, job->common.quiet, "heading_tracking",
                                     &(moray_figure){.name = "heading",
                                                     .title = "Heading without its undulation, first-principles model",
                                                     .x_label = "time [s]",
                                                     .y_label = "heading [deg]",
                                                     .curves = heading,
                                                     .n_curves = 1 + shown});
    if (!moray_failed(status))
        status = steer_draw(job->common.output, job->common.quiet, "heading_tracking",
                            &(moray_figure){.name = "offset",
                                            .title = "Joint offset, first-principles model",
                                            .x_label = "time [s]",
                                            .y_label = "phi_0 [deg]",
                                            .curves = offset,
                                            .n_curves = shown});
    free(data);
    return status;
}

static moray_status draw_shown(heading_job *job, heading_trial *const *trials, const moray_voyage *voyages)
{
    const steer_curve paths[shown] = {
        {trials[0]->name, &voyages[0]}, {trials[1]->name, &voyages[1]}, {trials[2]->name, &voyages[2]}};
    MORAY_TRY(draw_over_time(job, trials, voyages));
    MORAY_TRY(steer_draw_path(&job->common, "heading_tracking", paths, shown, NULL, 0));
    MORAY_TRY(steer_draw_joints(&job->common, "heading_tracking", &voyages[shown - 1]));
    return steer_write_trajectory(&job->common, &voyages[shown - 1]);
}

static moray_status draw(heading_job *job)
{
    heading_trial *trials[shown];
    moray_voyage voyages[shown] = {{0}};
    moray_status status = moray_ok();
    choose_shown(job, trials);
    for (int k = 0; k < shown && !moray_failed(status); k++)
        status = heading_swim(job, trials[k], MORAY_FIRST_PRINCIPLES, &voyages[k]);
    if (!moray_failed(status))
        status = draw_shown(job, trials, voyages);
    for (int k = 0; k < shown; k++)
        moray_voyage_free(&voyages[k]);
    return status;
}

// ---- Files
// ------------------------------------------------------------------------------------------------------------

static moray_status write_files(heading_job *job, const report_tables *t, const moray_json *json)
{
    moray_output *output = job->common.output;
    char text[2 * text_size];
    FILE *file;
    MORAY_TRY(moray_output_file(output, "summary.json", &file));
    MORAY_TRY(moray_json_write(json, file));
    MORAY_TRY(draw(job));
    verdict(job, text, text_size);
    const moray_report report = {.title = "heading_tracking",
                                 .text = text,
                                 .tables = t->table,
                                 .n_tables = tables,
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
