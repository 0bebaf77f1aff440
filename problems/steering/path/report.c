// SPDX-License-Identifier: MIT
#include <stdlib.h>

#include "job.h"

static const char *const model_names[] = {"control-oriented", "first-principles"};
enum { text_size = 1200 };

// ---- Tables --------------------------------------------------------------------------------------------------------

enum { tables = 4, most_rows = 16 };

typedef struct report_tables {
    moray_table table[tables];
    moray_table_row rows[tables][most_rows];
} report_tables;

static int gait_rows(const path_job *job, moray_table_row *rows)
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
    const moray_robot *robot = &job->common.robot;
    for (int i = 0; i < count; i++)
        rows[i] = (moray_table_row){.label = labels[i][0], .unit = labels[i][1]};
    for (int g = 0; g <= 1 + (int)job->common.model; g++) {
        const moray_straight_motion *control = &job->straight[g][0], *revolute = &job->straight[g][1];
        const moray_gait *gait = &control->gait;
        const double theta_max =
            moray_theta_max_from_amplitude(robot, MORAY_CONTROL_ORIENTED, gait->amplitude, gait->delta);
        const double values[count] = {theta_max / DEG,
                                      gait->omega / DEG,
                                      gait->delta / DEG,
                                      100 * gait->amplitude,
                                      revolute->gait.amplitude / DEG,
                                      control->speed,
                                      revolute->speed,
                                      revolute->power};
        for (int i = 0; i < count; i++)
            rows[i].value[g] = values[i];
    }
    return count;
}

static int leg_rows(const path_job *job, char (*names)[40], moray_table_row *rows)
{
    int n = 0;
    for (int k = 0; k < job->path.n && n < most_rows; k++) {
        const moray_path_piece *piece = &job->path.piece[k];
        const bool leg = piece->curvature == 0;
        double asked = NAN, planned = NAN;
        if (leg)
            path_crab(job, piece, &asked, &planned);
        snprintf(names[n], sizeof *names, leg ? "leg %d" : "corner behind leg %d", piece->leg);
        rows[n] = (moray_table_row){.label = names[n],
                                    .value = {piece->length, piece->course / DEG, asked / DEG, planned / DEG,
                                              leg ? NAN : path_turning(job, piece) / DEG}};
        n++;
    }
    return n;
}

static int score_rows(const path_job *job, moray_table_row *rows)
{
    for (int k = 0; k < job->n_trials; k++) {
        const path_trial *trial = &job->trial[k];
        const moray_path_score *control = &trial->score[0], *revolute = &trial->score[1];
        rows[k] = (moray_table_row){.label = trial->name,
                                    .value = {100 * control->rms, control->time, 100 * revolute->rms,
                                              100 * revolute->settled_rms, 100 * revolute->settled_largest,
                                              revolute->time, trial->cost[1], revolute->power}};
    }
    return job->n_trials;
}

static int tuning_rows(const path_job *job, moray_table_row *rows)
{
    int n = 0;
    for (int k = 0; k < job->n_trials; k++) {
        const path_trial *trial = &job->trial[k];
        const bool sight = trial->law == PATH_SIGHT;
        if (trial->evaluations > 0)
            rows[n++] =
                (moray_table_row){.label = trial->name,
                                  .value = {100 * trial->gain * DEG, trial->lookahead, sight ? trial->ahead : NAN,
                                            trial->integral ? 100 * trial->integral_gain : NAN, trial->evaluations}};
    }
    return n;
}

static void make_tables(const path_job *job, report_tables *t, char (*leg_names)[40])
{
    t->table[0] = (moray_table){.title = "Gait",
                                .columns = {"paper's", "control opt.", "first-pr. opt."},
                                .n_columns = 2 + (int)job->common.model,
                                .n_rows = gait_rows(job, t->rows[0])};
    t->table[1] = (moray_table){.title = "Path; crab angle: heading less course, asked for by the current and planned",
                                .columns = {"length, m", "course, deg", "crab, deg", "planned", "turning, deg/s"},
                                .n_columns = 5,
                                .n_rows = leg_rows(job, leg_names, t->rows[1])};
    t->table[2] = (moray_table){
        .title = "Cross-track error, cm (settled: without the first way to the path); time to the end, s; cost as in "
                 "the objective; power, W",
        .columns = {"control: RMS", "time", "first-pr.: RMS", "settled", "largest", "time", "cost", "power"},
        .n_columns = 8,
        .n_rows = score_rows(job, t->rows[2])};
    t->table[3] =
        (moray_table){.title = "Tuned on the first-principles model",
                      .columns = {"gain, cm/deg", "lookahead, m", "ahead, m", "integral, cm/s", "simulations"},
                      .n_columns = 5,
                      .n_rows = tuning_rows(job, t->rows[3])};
    for (int k = 0; k < tables; k++)
        t->table[k].rows = t->rows[k];
}

// ---- In words ------------------------------------------------------------------------------------------------------

// The best on the first-principles model of guidance without a plan, or of the optimised.
static const path_trial *best_trial(const path_job *job, bool sight)
{
    const path_trial *best = NULL;
    for (int k = 0; k < job->n_trials; k++) {
        const path_trial *trial = &job->trial[k];
        if ((trial->law == PATH_SIGHT) == sight && (!best || trial->cost[1] < best->cost[1]))
            best = trial;
    }
    return best;
}

static void verdict(const path_job *job, char *text, size_t size)
{
    const path_trial *ours = best_trial(job, false), *theirs = best_trial(job, true);
    const moray_path_score *a = &ours->score[1], *b = &theirs->score[1];
    snprintf(text, size,
             "First-principles model, same limits: the best optimised steering (%s) takes %.2f s with a settled RMS "
             "cross-track error of %.2f cm, the best tuned guidance (%s) %.2f s and %.2f cm; in what both were to "
             "minimise %.2f against %.2f%s.",
             ours->name, a->time, 100 * a->settled_rms, theirs->name, b->time, 100 * b->settled_rms, ours->cost[1],
             theirs->cost[1], ours->cost[1] < theirs->cost[1] ? "" : ": the optimised one LOSES");
}

static void receding_line(const path_job *job, const path_trial *trial, char *text, size_t size)
{
    const moray_receding_horizon_record *r = &trial->record[MORAY_FIRST_PRINCIPLES];
    snprintf(text, size,
             "%s: %d plans of %.3g periods, each %.2g s of processor time on average (the longest after the first %.2g "
             "s) and %.1f iterations; %.1f times faster than real time on one core%s%s",
             trial->name, r->plans, job->look_ahead_periods, r->seconds / r->plans, r->longest,
             (double)r->iterations / r->plans, path_real_time(job, trial, r),
             r->failures ? "; not solved at first: " : "", r->failures ? r->first_failure : "");
}

static void print_solver(const char *what, const path_job *job, const moray_path_plan *plan)
{
    char line[300];
    int meshes;
    const moray_mesh_record *record = moray_solution_history(plan->solution, &meshes);
    moray_solver_line(plan->solution, job->common.scheme, record[meshes - 1].intervals, line, sizeof line);
    printf("%s: %s\n", what, line);
}

// ---- Standard output -----------------------------------------------------------------------------------------------

static void print_all(const path_job *job, const report_tables *t)
{
    char text[text_size];
    printf("%d links, current (%g, %g) m/s, path %s, radius %g m, from (%g, %g)\n\n", job->common.robot.links,
           job->common.current[0], job->common.current[1], job->path_text, job->radius, job->start[0], job->start[1]);
    for (int k = 0; k < tables; k++) {
        moray_table_print(&t->table[k], stdout);
        printf("\n");
    }
    verdict(job, text, sizeof text);
    printf("%s\n\n", text);
    path_explain(job, text, sizeof text);
    printf("%s\n\n", text);
    for (int k = 0; k < job->n_trials; k++)
        if (job->trial[k].law == PATH_RECEDING) {
            receding_line(job, &job->trial[k], text, sizeof text);
            printf("%s\n", text);
        }
    print_solver("period-averaged plan", job, &job->averaged);
    for (int model = 0; model <= (int)job->common.model; model++) {
        print_solver(model_names[model], job, &job->plan[model]);
        moray_certificate_line(&job->certificate[model], text, sizeof text);
        printf("    %s\n", text);
    }
}

// ---- Figures -------------------------------------------------------------------------------------------------------

enum { shown = 3, path_points = 400 };

// Line of sight without and with integral action, the last plan with feedback.
static void choose_shown(path_job *job, path_trial **trials)
{
    trials[0] = &job->trial[1];
    trials[1] = &job->trial[2];
    for (int k = 0; k < job->n_trials; k++)
        if (job->trial[k].law == PATH_BOTH)
            trials[2] = &job->trial[k];
}

static void fill_over_time(const path_job *job, const moray_closed_loop *closed_loop, double *across, double *offset)
{
    double along = 0;
    for (int k = 0; k < closed_loop->track.n; k++) {
        const moray_pose *pose = &closed_loop->track.pose[k];
        moray_path_project(&job->path, pose->p_x, pose->p_y, &along, &across[k]);
        across[k] *= 100;
        offset[k] = closed_loop->offset[k] / DEG;
    }
}

static moray_status draw_over_time(const path_job *job, path_trial *const *trials,
                                   const moray_closed_loop *closed_loops)
{
    moray_curve across[shown], offset[shown];
    int most = 0;
    for (int i = 0; i < shown; i++)
        most = closed_loops[i].track.n > most ? closed_loops[i].track.n : most;
    double *data = malloc((size_t)(most * 2 * shown) * sizeof *data);
    if (!data)
        return moray_error(MORAY_MEMORY, "no memory for figures");
    for (int i = 0; i < shown; i++) {
        double *values = data + 2 * i * most;
        const moray_swim_track *track = &closed_loops[i].track;
        fill_over_time(job, &closed_loops[i], values, values + most);
        across[i] = (moray_curve){.label = trials[i]->name, .x = track->t, .y = values, .n = track->n};
        offset[i] = (moray_curve){.label = trials[i]->name, .x = track->t, .y = values + most, .n = track->n};
    }
    moray_status status = steer_draw(job->common.output, job->common.quiet, "path_following",
                                     &(moray_figure){.name = "across",
                                                     .title = "Cross-track error, first-principles model",
                                                     .x_label = "time [s]",
                                                     .y_label = "to the left of the path [cm]",
                                                     .curves = across,
                                                     .n_curves = shown});
    if (!moray_failed(status))
        status = steer_draw(job->common.output, job->common.quiet, "path_following",
                            &(moray_figure){.name = "offset",
                                            .title = "Joint offset, first-principles model",
                                            .x_label = "time [s]",
                                            .y_label = "phi_0 [deg]",
                                            .curves = offset,
                                            .n_curves = shown});
    free(data);
    return status;
}

static moray_status draw_shown(path_job *job, path_trial *const *trials, const moray_closed_loop *closed_loops)
{
    const steer_curve curves[shown] = {
        {trials[0]->name, &closed_loops[0]}, {trials[1]->name, &closed_loops[1]}, {trials[2]->name, &closed_loops[2]}};
    double x[path_points], y[path_points];
    for (int k = 0; k < path_points; k++) {
        const moray_path_point at = moray_path_at(&job->path, job->path.length * k / (path_points - 1));
        x[k] = creal(at.x);
        y[k] = creal(at.y);
    }
    const moray_curve path = {.label = "path", .x = x, .y = y, .n = path_points};
    MORAY_TRY(draw_over_time(job, trials, closed_loops));
    MORAY_TRY(steer_draw_path(&job->common, "path_following", curves, shown, &path, 1));
    MORAY_TRY(steer_draw_joints(&job->common, "path_following", &closed_loops[shown - 1]));
    return steer_write_trajectory(&job->common, &closed_loops[shown - 1]);
}

static moray_status draw(path_job *job)
{
    path_trial *trials[shown];
    moray_closed_loop closed_loops[shown] = {{0}};
    moray_status status = moray_ok();
    choose_shown(job, trials);
    for (int k = 0; k < shown && !moray_failed(status); k++)
        status = path_swim(job, trials[k], MORAY_FIRST_PRINCIPLES, &closed_loops[k]);
    if (!moray_failed(status))
        status = draw_shown(job, trials, closed_loops);
    for (int k = 0; k < shown; k++)
        moray_closed_loop_free(&closed_loops[k]);
    return status;
}

// ---- Files ---------------------------------------------------------------------------------------------------------

static moray_status write_files(path_job *job, const report_tables *t, const moray_json *json)
{
    moray_output *output = job->common.output;
    char text[text_size];
    FILE *file;
    MORAY_TRY(moray_output_file(output, "summary.json", &file));
    MORAY_TRY(moray_json_write(json, file));
    MORAY_TRY(draw(job));
    verdict(job, text, text_size);
    const moray_report report = {.title = "path_following",
                                 .text = text,
                                 .tables = t->table,
                                 .n_tables = tables,
                                 .argc = job->common.argc,
                                 .argv = job->common.argv};
    MORAY_TRY(moray_output_report(output, &report));
    return moray_output_commit(output);
}

moray_status path_report(path_job *job)
{
    report_tables t;
    char leg_names[most_rows][40];
    make_tables(job, &t, leg_names);
    moray_json *json = path_json(job);
    moray_status status = job->common.output ? write_files(job, &t, json) : moray_ok();
    if (!moray_failed(status) && job->common.json)
        status = moray_json_write(json, stdout);
    else if (!moray_failed(status))
        print_all(job, &t);
    moray_json_free(json);
    return status;
}
