// SPDX-License-Identifier: MIT
#include <stdlib.h>

#include "job.h"

static const char *const model_names[] = {"control-oriented", "first-principles"};
enum { text_size = 1200 };

// ---- Table, words --------------------------------------------------------------------------------------------------

static moray_table make_table(const turn_job *job, moray_table_row *rows)
{
    for (int k = 0; k < job->n_trials; k++) {
        const turn_trial *trial = &job->trial[k];
        const turn_score *control = &trial->score[0], *revolute = &trial->score[1];
        rows[k] = (moray_table_row){.label = trial->name,
                                    .value = {control->settled, control->final / DEG, revolute->settled,
                                              revolute->unsettled, revolute->final / DEG, revolute->power,
                                              trial->evaluations ? (double)trial->evaluations : NAN, revolute->miss}};
    }
    return (moray_table){
        .title = "Time until the heading stays in the band, s; the same, weighted by the error within "
                 "it; final error, deg; power, W; nearest to the end position, m",
        .columns = {"control: time", "error", "first-pr.: time", "weighted", "error", "power", "tuned by", "nearest"},
        .n_columns = job->to_position ? 8 : 7,
        .rows = rows,
        .n_rows = job->n_trials};
}

static bool planned(const turn_trial *trial)
{
    return trial->law == TURN_PLAN || trial->law == TURN_BOTH;
}

static const turn_trial *best_trial(const turn_job *job, bool plan)
{
    const turn_trial *best = NULL;
    for (int k = 0; k < job->n_trials; k++) {
        const turn_trial *trial = &job->trial[k];
        if (planned(trial) == plan && (!best || trial->score[1].unsettled < best->score[1].unsettled))
            best = trial;
    }
    return best;
}

static void verdict(const turn_job *job, char *text, size_t size)
{
    const turn_trial *ours = best_trial(job, true), *theirs = best_trial(job, false);
    const turn_score *a = &ours->score[1], *b = &theirs->score[1];
    const double plan = turn_duration(turn_last_plan(job));
    if (job->to_position)
        snprintf(
            text, size,
            "First-principles model: %s comes within %.3g cm of the end position; the plan takes %.2f s. Bang-bang "
            "steering, tuned for the heading alone, passes at %.3g m.",
            ours->name, 100 * a->miss, plan, b->miss);
    else
        snprintf(
            text, size,
            "First-principles model, same limits: the best optimised turn (%s) is within %.3g deg of its heading "
            "after %.2f s, of the tuned bang-bang turns the better (%s) after %.2f s; weighted by the error %.3f s "
            "against %.3f s%s. The plan itself takes %.2f s, until offset and turning are at rest.",
            ours->name, job->band / DEG, a->settled, theirs->name, b->settled, a->unsettled, b->unsettled,
            fabs(a->unsettled / b->unsettled - 1) < 0.02
                ? ", as good as the same: the fastest turn is a bang-bang one, which the plan finds without trials"
            : a->unsettled < b->unsettled ? ""
                                          : ": the optimised one LOSES",
            plan);
}

static void print_all(const turn_job *job, const moray_table *table)
{
    char text[text_size];
    const moray_turn_plan *plans[] = {&job->averaged, &job->plan[0], &job->plan[1]};
    printf("%d links, current (%g, %g) m/s, turn by %g deg", job->common.robot.links, job->common.current[0],
           job->common.current[1], job->angle / DEG);
    if (job->to_position)
        printf(" to (%g, %g) m", job->end[0], job->end[1]);
    printf("\n\n");
    moray_table_print(table, stdout);
    verdict(job, text, sizeof text);
    printf("\n%s\n\n", text);
    turn_explain(job, text, sizeof text);
    printf("%s\n\n", text);
    for (int k = 0; k <= 1 + (int)job->common.model; k++) {
        int meshes;
        const moray_mesh_record *record = moray_solution_history(plans[k]->solution, &meshes);
        moray_solver_line(plans[k]->solution, k ? job->common.scheme : "radau3", record[meshes - 1].intervals, text,
                          sizeof text);
        printf("%s: turn of %.3f s, %s\n", k ? model_names[k - 1] : "period-averaged", turn_duration(plans[k]), text);
        if (k > 0) {
            moray_certificate_line(&job->certificate[k - 1], text, sizeof text);
            printf("    %s\n", text);
        }
    }
}

// ---- JSON ----------------------------------------------------------------------------------------------------------

static void json_score(moray_json *json, const turn_job *job, const char *key, const turn_score *score)
{
    moray_json_open(json, key);
    moray_json_number(json, "settled_s", score->settled);
    moray_json_number(json, "weighted_s", score->unsettled);
    moray_json_number(json, "final_deg", score->final / DEG);
    moray_json_number(json, "miss_m", job->to_position ? score->miss : NAN);
    moray_json_number(json, "power_W", score->power);
    moray_json_close(json);
}

static void json_plan(moray_json *json, const char *key, const turn_job *job, moray_model model)
{
    const moray_steering_limits limits = turn_limits(job, model);
    const moray_turn_plan *plan = &job->plan[model];
    const steer_saturation share = steer_saturation_of(plan->solution, &limits);
    moray_json_open(json, key);
    moray_json_number(json, "time_s", turn_duration(plan));
    moray_json_number(json, "turn_rate_deg_s", fabs(job->turn_rate[model]) / DEG);
    moray_json_number(json, "offset_at_limit_percent", 100 * share.offset);
    moray_json_number(json, "offset_rate_at_limit_percent", 100 * share.rate);
    moray_solver_to_json(json, plan->solution);
    moray_json_close(json);
    moray_certificate_to_json(json, &job->certificate[model]);
    moray_json_close(json);
}

static moray_json *make_json(const turn_job *job)
{
    static const char *const laws[] = {"bang-bang", "bang-bang, braking", "plan", "plan and feedback"};
    const bool control = job->common.model == MORAY_CONTROL_ORIENTED;
    const moray_gait gaits[2] = {job->straight[0].gait, job->straight[1].gait};
    moray_json *json = moray_json_new();
    moray_json_text(json, "problem", "min_time_turn");
    moray_json_text(json, "version", moray_version());
    moray_json_text(json, "model", control ? "control" : "fp");
    moray_json_open(json, "robot");
    moray_json_number(json, "links", job->common.robot.links);
    moray_json_close(json);
    moray_json_numbers(json, "current_m_s", job->common.current, 2);
    moray_json_number(json, "angle_deg", job->angle / DEG);
    if (job->to_position)
        moray_json_numbers(json, "end_m", job->end, 2);
    moray_json_text(json, "scheme", job->common.scheme);
    moray_gait_to_json(json, "gait", &job->common.robot, gaits);
    json_plan(json, "control_oriented_plan", job, MORAY_CONTROL_ORIENTED);
    if (!control)
        json_plan(json, "first_principles_plan", job, MORAY_FIRST_PRINCIPLES);
    moray_json_open_list(json, "steering");
    for (int k = 0; k < job->n_trials; k++) {
        const turn_trial *trial = &job->trial[k];
        moray_json_open(json, NULL);
        moray_json_text(json, "law", laws[trial->law]);
        moray_json_text(json, "plan",
                        !planned(trial)                         ? NULL
                        : trial->plan == MORAY_CONTROL_ORIENTED ? "control"
                                                                : "fp");
        moray_json_number(json, "hold_s", planned(trial) ? NAN : trial->hold);
        moray_json_number(json, "brake_s", planned(trial) ? NAN : trial->brake);
        moray_json_number(json, "gain_m_rad", trial->law == TURN_BOTH ? trial->gain : NAN);
        json_score(json, job, "predicted", &trial->score[MORAY_CONTROL_ORIENTED]);
        json_score(json, job, "validated", &trial->score[MORAY_FIRST_PRINCIPLES]);
        moray_json_close(json);
    }
    moray_json_close(json);
    return json;
}

// ---- Figures -------------------------------------------------------------------------------------------------------

enum { shown = 3 };

// Both bang-bang turns and the last plan.
static void choose_shown(const turn_job *job, const turn_trial **trials)
{
    trials[0] = &job->trial[0];
    trials[1] = &job->trial[1];
    for (int k = 0; k < job->n_trials; k++)
        if (job->trial[k].law == TURN_PLAN)
            trials[2] = &job->trial[k];
}

static moray_status draw_over_time(const turn_job *job, const turn_trial *const *trials,
                                   const moray_closed_loop *closed_loops)
{
    const int n = closed_loops->track.n;
    const double *t = closed_loops->track.t;
    double *data = malloc((size_t)(2 * shown * n) * sizeof *data);
    moray_curve heading[shown], offset[shown];
    if (!data)
        return moray_error(MORAY_MEMORY, "no memory for figures");
    for (int i = 0; i < shown; i++) {
        double *angle = data + 2 * i * n, *phi = angle + n;
        for (int k = 0; k < n; k++) {
            angle[k] =
                moray_straight_motion_heading(&job->straight[1], t[k], closed_loops[i].track.pose[k].heading) / DEG;
            phi[k] = closed_loops[i].offset[k] / DEG;
        }
        heading[i] = (moray_curve){.label = trials[i]->name, .x = t, .y = angle, .n = n};
        offset[i] = (moray_curve){.label = trials[i]->name, .x = t, .y = phi, .n = n};
    }
    moray_figure figure = {.name = "heading",
                           .title = "Heading without its undulation, first-principles model",
                           .x_label = "time [s]",
                           .y_label = "heading [deg]",
                           .curves = heading,
                           .n_curves = shown};
    moray_status status = steer_draw(job->common.output, job->common.quiet, "min_time_turn", &figure);
    figure.name = "offset";
    figure.title = "Joint offset, first-principles model";
    figure.y_label = "phi_0 [deg]";
    figure.curves = offset;
    if (!moray_failed(status))
        status = steer_draw(job->common.output, job->common.quiet, "min_time_turn", &figure);
    free(data);
    return status;
}

static moray_status draw_shown(const turn_job *job, const turn_trial *const *trials,
                               const moray_closed_loop *closed_loops)
{
    const steer_curve curves[shown] = {
        {trials[0]->name, &closed_loops[0]}, {trials[1]->name, &closed_loops[1]}, {trials[2]->name, &closed_loops[2]}};
    MORAY_TRY(draw_over_time(job, trials, closed_loops));
    MORAY_TRY(steer_draw_path(&job->common, "min_time_turn", curves, shown, NULL, 0));
    MORAY_TRY(steer_draw_joints(&job->common, "min_time_turn", &closed_loops[shown - 1]));
    return steer_write_trajectory(&job->common, &closed_loops[shown - 1]);
}

static moray_status draw(const turn_job *job)
{
    const turn_trial *trials[shown];
    moray_closed_loop closed_loops[shown] = {{0}};
    moray_status status = moray_ok();
    choose_shown(job, trials);
    for (int k = 0; k < shown && !moray_failed(status); k++)
        status = turn_swim(job, trials[k], MORAY_FIRST_PRINCIPLES, &closed_loops[k]);
    if (!moray_failed(status))
        status = draw_shown(job, trials, closed_loops);
    for (int k = 0; k < shown; k++)
        moray_closed_loop_free(&closed_loops[k]);
    return status;
}

// ---- Files ---------------------------------------------------------------------------------------------------------

static moray_status write_files(turn_job *job, const moray_table *table, const moray_json *json)
{
    moray_output *output = job->common.output;
    char text[text_size];
    FILE *file;
    MORAY_TRY(moray_output_file(output, "summary.json", &file));
    MORAY_TRY(moray_json_write(json, file));
    MORAY_TRY(draw(job));
    verdict(job, text, sizeof text);
    const moray_report report = {.title = "min_time_turn",
                                 .text = text,
                                 .tables = table,
                                 .n_tables = 1,
                                 .argc = job->common.argc,
                                 .argv = job->common.argv};
    MORAY_TRY(moray_output_report(output, &report));
    return moray_output_commit(output);
}

moray_status turn_report(turn_job *job)
{
    moray_table_row rows[TURN_TRIALS];
    const moray_table table = make_table(job, rows);
    moray_json *json = make_json(job);
    moray_status status = job->common.output ? write_files(job, &table, json) : moray_ok();
    if (!moray_failed(status) && job->common.json)
        status = moray_json_write(json, stdout);
    else if (!moray_failed(status))
        print_all(job, &table);
    moray_json_free(json);
    return status;
}
