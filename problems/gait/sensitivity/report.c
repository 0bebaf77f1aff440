// SPDX-License-Identifier: MIT
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "sensitivity.h"

// ---- In words ------------------------------------------------------------------------------------------------------

static double worst_deviation(const sensitivity *run)
{
    double worst = 0;
    for (int k = 0; k < run->rows; k++)
        worst = run->row[k].unsteady ? worst : fmax(worst, run->row[k].deviation);
    return worst;
}

static void say_confirmation(const sensitivity *run, sensitivity_findings *f)
{
    int unsteady = 0;
    for (int k = 0; k < run->rows; k++)
        unsteady += run->row[k].unsteady;
    moray_text_add(
        f->text, SENSITIVITY_TEXT,
        "Solved again on both sides of each parameter, the optimum moves as the slopes say: they differ by at most "
        "%.1e %% per per cent%s.\n",
        worst_deviation(run), unsteady > 0 ? ", those aside whose active set changes on the way" : "");
}

// Where the control-oriented model errs most about the speed.
static void say_disagreement(const sensitivity *run, sensitivity_findings *f)
{
    double most = 0, own = 0, swum = 0;
    int worst = -1;
    for (int k = 0; k < run->rows; k++) {
        const sensitivity_row *row = &run->row[k];
        const double predicted = row->slope[SLOPE_SPEED] * row->scale / run->size[SLOPE_SPEED];
        const double found = sensitivity_swum_share(run, row, SLOPE_SPEED);
        if (fabs(predicted - found) > most) {
            most = fabs(predicted - found);
            own = predicted, swum = found;
            worst = k;
        }
    }
    if (worst >= 0)
        moray_text_add(
            f->text, SENSITIVITY_TEXT,
            "These are slopes of the control-oriented model. The same changes of parameter and gait swum on the "
            "first-principles model are in the lines and columns beside; in per cent of speed they differ most for %s: "
            "%+.3f predicted, %+.3f swum.\n",
            run->row[worst].name, own, swum);
}

// The first changes of the active set, as far as tangents tell.
static void say_changes(const sensitivity *run, sensitivity_findings *f)
{
    const double far = 0.5, near = 0.05;
    int told = 0;
    for (int k = 0; k < run->rows; k++)
        for (int up = 0; up < 2; up++) {
            const sensitivity_row *row = &run->row[k];
            const moray_active_change *change = up ? &row->up : &row->down;
            const double share = change->step / row->scale;
            if (fabs(share) > far)
                continue;
            moray_text_add(f->text, SENSITIVITY_TEXT, "%s%s %+.2g %%: %s.\n",
                           fabs(share) < near ? "WARNING: the slopes hold only up to " : "Slopes hold up to ",
                           row->name, 100 * share, change->what);
            told++;
        }
    moray_text_add(
        f->text, SENSITIVITY_TEXT, "%s that no slope will jump for changes of up to %g %%, by their tangents.\n",
        told > 0 ? "Otherwise no constraint comes or goes, so" : "No constraint comes or goes, so", 100 * far);
}

static void say_reservations(const sensitivity *run, sensitivity_findings *f)
{
    if (run->weak[0])
        moray_text_add(f->text, SENSITIVITY_TEXT, "WARNING: active or not, that is not certain: %s.\n", run->weak);
    if (run->left_out[0])
        moray_text_add(f->text, SENSITIVITY_TEXT, "Without slopes: %s.\n", run->left_out);
    if (run->unreached[0])
        moray_text_add(f->text, SENSITIVITY_TEXT, "Limits that are not reached, so that nothing depends on them: %s.\n",
                       run->unreached);
}

static double percent(double value, double reference)
{
    return 100 * (value / reference - 1);
}

static void say_forecast(const sensitivity *run, sensitivity_findings *f)
{
    const sensitivity_forecast *forecast = &run->forecast;
    double predicted[SLOPES], again[SLOPES], worst = 0;
    if (forecast->why.code) {
        moray_text_add(f->text, SENSITIVITY_TEXT, "No gait is predicted for a current of (%g, %g) m/s: %s.\n",
                       forecast->current[0], forecast->current[1], forecast->why.text);
        return;
    }
    sensitivity_values(&run->job, &forecast->prediction[1].gait, 0, 0, predicted);
    sensitivity_values(&run->job, &forecast->prediction[2].gait, 0, 0, again);
    for (int i = SLOPE_THETA_MAX; i < SLOPES; i++)
        worst = fmax(worst, fabs(predicted[i] - again[i]) / fabs(run->size[i]));
    moray_text_add(
        f->text, SENSITIVITY_TEXT,
        "The gait predicted for a current of (%g, %g) m/s is within %.2g %% of that found by solving there%s.",
        forecast->current[0], forecast->current[1], 100 * worst, forecast->solved ? "" : " (which did not converge)");
    const moray_steady *swum[SENSITIVITY_GAITS];
    bool held = true;
    for (int k = 0; k < SENSITIVITY_GAITS; k++) {
        swum[k] = &forecast->trial[k].steady[MORAY_FIRST_PRINCIPLES];
        held = held && forecast->trial[k].held[MORAY_FIRST_PRINCIPLES];
    }
    const double course = run->job.snake.course, best = moray_course_speed(swum[2], course);
    if (held)
        moray_text_add(
            f->text, SENSITIVITY_TEXT,
            " Swum on the first-principles model, it is off by %+.3f %% in speed and %+.3f %% in power; the gait kept "
            "as it "
            "was, by %+.3f %% and %+.3f %%.",
            percent(moray_course_speed(swum[1], course), best), percent(swum[1]->power, swum[2]->power),
            percent(moray_course_speed(swum[0], course), best), percent(swum[0]->power, swum[2]->power));
    moray_text_add(f->text, SENSITIVITY_TEXT, " The speed that the slopes alone predict is off by %+.2f %%.",
                   percent(forecast->prediction[1].course_speed, forecast->prediction[2].course_speed));
    if (fabs(forecast->change.step) < 1)
        moray_text_add(f->text, SENSITIVITY_TEXT, " WARNING: after %.2g %% of the way the active set changes: %s.",
                       100 * forecast->change.step, forecast->change.what);
    moray_text_add(f->text, SENSITIVITY_TEXT, "\n");
}

static void find_words(const sensitivity *run, sensitivity_findings *f)
{
    say_confirmation(run, f);
    if (run->job.snake.model == MORAY_CONTROL_ORIENTED)
        say_disagreement(run, f);
    say_changes(run, f);
    say_reservations(run, f);
    if (run->forecast.asked)
        say_forecast(run, f);
}

// ---- Files ---------------------------------------------------------------------------------------------------------

static void json_values(moray_json *json, const char *key, const double *value, int n)
{
    moray_json_open(json, key);
    for (int i = 0; i < n; i++)
        moray_json_number(json, sensitivity_names[i], value[i]);
    moray_json_close(json);
}

static void json_change(moray_json *json, const char *key, const moray_active_change *change)
{
    moray_json_open(json, key);
    moray_json_number(json, "step", change->step);
    moray_json_text(json, "what", change->what);
    moray_json_close(json);
}

static void json_row(moray_json *json, const sensitivity_row *row, int n)
{
    moray_json_open(json, NULL);
    moray_json_text(json, "parameter", row->name);
    moray_json_text(json, "unit", row->unit);
    moray_json_number(json, "value", row->value);
    json_values(json, "slope", row->slope, n);
    json_values(json, "solved_again", row->again, n);
    json_values(json, "swum", row->swum, 2);
    moray_json_number(json, "deviation", row->deviation);
    json_change(json, "change_below", &row->down);
    json_change(json, "change_above", &row->up);
    moray_json_close(json);
}

static void json_forecast(moray_json *json, const sensitivity *run)
{
    static const char *const keys[SENSITIVITY_GAITS] = {"gait_kept", "gait_predicted", "gait_solved_again"};
    const sensitivity_forecast *forecast = &run->forecast;
    moray_json_open(json, "forecast");
    moray_json_numbers(json, "current_m_s", forecast->current, 2);
    moray_json_text(json, "why_not", forecast->why.code ? forecast->why.text : NULL);
    for (int k = 0; k < SENSITIVITY_GAITS && !forecast->why.code; k++) {
        moray_json_open(json, keys[k]);
        moray_gait_to_json(json, "gait", &run->job.snake.robot, forecast->trial[k].gait);
        moray_json_number(json, "predicted_course_speed_m_s", forecast->prediction[k].course_speed);
        moray_json_number(json, "predicted_power_W", forecast->prediction[k].power);
        moray_steady_to_json(json, "validated", &run->job.snake.robot, MORAY_FIRST_PRINCIPLES, &forecast->trial[k],
                             run->job.snake.course);
        moray_json_close(json);
    }
    moray_json_close(json);
}

static void summarise(const void *found, moray_json *json)
{
    const sensitivity *run = found;
    gait_job_json_head(json, &run->job);
    gait_job_json_stage(json, &run->job, last_stage(&run->job));
    moray_json_open_list(json, "sensitivities");
    for (int k = 0; k < run->rows; k++)
        json_row(json, &run->row[k], sensitivity_quantities(run));
    moray_json_close(json);
    moray_json_text(json, "uncertain", run->weak);
    moray_json_text(json, "not_reached", run->unreached);
    moray_json_text(json, "left_out", run->left_out);
    if (run->forecast.asked)
        json_forecast(json, run);
}

static moray_status write(const void *found, moray_output *output)
{
    const sensitivity *run = found;
    return gait_job_trajectory(&run->job, last_stage(&run->job), output);
}

static void print(const void *found, const moray_report *report)
{
    const sensitivity *run = found;
    const moray_section *section = report->sections;
    char text[GAIT_TEXT] = "";
    gait_job_print_head(&run->job);
    if (isfinite(last_stage(&run->job)->power))
        printf("; %s at most %.4g W whatever changes", moray_power_label(&run->job.snake.robot, run->job.snake.model),
               last_stage(&run->job)->power);
    printf("\n\n");
    moray_tables_print(section->tables, section->n_tables, stdout);
    gait_job_headline(&run->job, text);
    printf("%s%s\n", report->text, text);
    moray_certificate_line(&last_stage(&run->job)->certificate, text, sizeof text);
    printf("%s\n", text);
}

// In the current that the gait is predicted for, or where there is no prediction in the job's own.
static moray_status make_scene(const void *found, moray_swim_scene *scene)
{
    const sensitivity *run = found;
    const sensitivity_forecast *forecast = &run->forecast;
    gait_job there = run->job; // borrows all
    char baseline[64];
    scene->scene.text = "From rest on the same water, simulated, side by side.";
    if (!forecast->asked || moray_failed(forecast->why)) {
        scene->scene.title = "The fastest gait swimming";
        MORAY_TRY(gait_job_scene_add(&there, scene, gait_job_kind(&run->job, last_stage(&run->job)), MORAY_COLOUR_BEST,
                                     &last_stage(&run->job)->trial, 1, GAIT_SHOWN_SECONDS));
        return gait_job_scene_add(&there, scene, gait_job_baseline(&there, baseline), MORAY_COLOUR_BASELINE,
                                  &there.paper, 0, GAIT_SHOWN_SECONDS);
    }
    scene->scene.title = "In another current: the gait kept, predicted, solved again";
    memcpy(there.rig.current, forecast->current, sizeof there.rig.current);
    MORAY_TRY(gait_job_scene_add(&there, scene, "solved again", MORAY_COLOUR_SECOND, &forecast->trial[2], 2,
                                 GAIT_SHOWN_SECONDS));
    MORAY_TRY(
        gait_job_scene_add(&there, scene, "predicted", MORAY_COLOUR_BEST, &forecast->trial[1], 1, GAIT_SHOWN_SECONDS));
    return gait_job_scene_add(&there, scene, "kept", MORAY_COLOUR_BASELINE, &forecast->trial[0], 0, GAIT_SHOWN_SECONDS);
}

static moray_status draw(const void *found, moray_output *output)
{
    const sensitivity *run = found;
    MORAY_TRY(gait_job_draw_gait(&run->job, "The fastest gait", &last_stage(&run->job)->trial, output));
    return moray_solution_draw(last_stage(&run->job)->solution, GAIT_MESH_TOLERANCE, "s", output);
}

static const gait_job_shown shown = {summarise, print, write, draw, make_scene};

moray_status sensitivity_report(gait_job *job)
{
    const sensitivity *run = (const sensitivity *)job;
    sensitivity_findings *found = calloc(1, sizeof *found);
    if (!found)
        return moray_error(MORAY_MEMORY, "no memory for a report");
    sensitivity_tables(run, found);
    find_words(run, found);
    const moray_section section = {
        .title = "Sensitivities", .figures = "", .tables = found->table, .n_tables = found->tables};
    const moray_status status = gait_job_publish(job, &shown, last_stage(job)->certificate.pass, 1,
                                                 &(moray_report){.title = "sensitivity: how the fastest gait moves",
                                                                 .text = found->text,
                                                                 .sections = &section,
                                                                 .n_sections = 1});
    free(found);
    return status;
}
