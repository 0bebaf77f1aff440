// SPDX-License-Identifier: MIT
#include <stdlib.h>
#include <string.h>

#include "search_gait.h"

enum { TEXT = 2000 };

static double value_of(const search_gait *run, const optimum *o)
{
    return search_gait_value(run, moray_course_speed(&o->orbit.steady, run->spec.course), o->orbit.steady.power);
}

static double polished_value(const search_gait *run, const optimum *o)
{
    return search_gait_value(run, o->at.prediction.course_speed, o->at.prediction.power);
}

static const char *unit_of(const search_gait *run)
{
    return search_gait_fastest(run) ? "m/s" : "J/m";
}

// ---- Tables --------------------------------------------------------------------------------------------------------

enum { TABLES = 4, ROWS = MORAY_RUNGS };

struct tables {
    moray_table table[TABLES];
    moray_table_row rows[TABLES][ROWS];
};

// The columns of the optima; the paper's gait, the first column, has been through no search.
static int search_rows(const search_gait *run, moray_table_row *rows)
{
    const bool fastest = search_gait_fastest(run), control = run->spec.model == MORAY_CONTROL_ORIENTED;
    const char *const labels[][2] = {{fastest ? "speed along the course" : "work per distance", unit_of(run)},
                                     {"the same, polished by collocation", unit_of(run)},
                                     {"difference", unit_of(run)},
                                     {moray_power_label(&run->spec.robot, run->spec.model), "W"},
                                     {control ? "peak joint force" : "peak joint torque", control ? "N" : "N m"},
                                     {"largest Floquet multiplier", NULL},
                                     {"starts that end here", NULL},
                                     {"global search ends here", NULL},
                                     {"faster than the paper's gait at its power", "%"}};
    enum { count = sizeof labels / sizeof *labels };
    for (int i = 0; i < count; i++)
        rows[i] = (moray_table_row){.label = labels[i][0], .unit = labels[i][1], .value = {NAN}};
    for (int k = 0; k < run->shown; k++) {
        const optimum *o = &run->optimum[k];
        const double values[count] = {value_of(run, o),
                                      polished_value(run, o),
                                      polished_value(run, o) - value_of(run, o),
                                      o->orbit.steady.power,
                                      o->orbit.steady.peak_effort,
                                      o->floquet.largest,
                                      o->hits,
                                      run->global_method > 0 ? (double)o->global : NAN,
                                      o->at.gain.speed_percent_at_equal_power};
        for (int i = 0; i < count; i++)
            rows[i].value[k + 1] = values[i];
    }
    return count;
}

static void make_tables(const search_gait *run, struct tables *t)
{
    const moray_gait_trial *trials[1 + SEARCH_GAIT_SHOWN] = {&run->job.paper};
    const moray_ladder_row *ladders[SEARCH_GAIT_SHOWN];
    for (int k = 0; k < run->shown; k++) {
        trials[k + 1] = &run->optimum[k].at.trial;
        ladders[k] = run->optimum[k].at.ladder;
    }
    const int columns = 1 + run->shown;
    const int rows[TABLES] = {
        moray_gait_rows(&run->spec.robot, trials, columns, t->rows[0]),
        search_rows(run, t->rows[1]),
        moray_steady_rows(&run->job.snake.robot, MORAY_FIRST_PRINCIPLES, trials, columns, run->spec.course, t->rows[2]),
        moray_ladder_rows(ladders, run->shown, t->rows[3]),
    };
    const char *const titles[TABLES] = {"Gait", "Found", "Swum on the first-principles model",
                                        "Gain in speed at the power of the paper's gait, on the ladder of models"};
    const char *const names[] = {"paper's", "optimum 1", "optimum 2", "optimum 3", "optimum 4", "optimum 5"};
    for (int k = 0; k < TABLES; k++) {
        const int first = k == TABLES - 1;
        t->table[k] =
            (moray_table){.title = titles[k], .n_columns = columns - first, .rows = t->rows[k], .n_rows = rows[k]};
        memcpy(t->table[k].columns, names + first, (size_t)(columns - first) * sizeof *names);
    }
}

// ---- In words ------------------------------------------------------------------------------------------------------

static void print_demand(const search_gait *run)
{
    gait_job_print_head(&run->job);
    printf("; %s model", moray_model_name(run->job.snake.model));
    if (isfinite(run->demand.power))
        printf(", %s at most %.4g W", moray_power_label(&run->job.snake.robot, run->job.snake.model),
               run->demand.power);
    if (run->demand.speed > 0)
        printf(", speed along the course at least %.4g m/s", run->demand.speed);
    printf("\n\n");
}

static int optimum_of_global(const search_gait *run)
{
    for (int k = 0; k < run->n; k++)
        if (run->optimum[k].global)
            return k + 1;
    return 0;
}

static void say_found(const search_gait *run, char *text)
{
    const int global = optimum_of_global(run);
    moray_text_add(text, TEXT, "%d %s from %d starts (%s: %d orbits, %.1f s)", run->n,
                   run->n == 1 ? "optimum" : "optima", run->starts, search_gait_locals[run->local_method], run->orbits,
                   run->seconds);
    if (run->n > run->shown)
        moray_text_add(text, TEXT, ", the best %d shown", run->shown);
    if (run->lost > 0)
        moray_text_add(text, TEXT, "; %d starts lead to no gait within the limits", run->lost);
    if (run->global_method > 0)
        moray_text_add(text, TEXT, "; %s (%d orbits, %.1f s) leads to ", search_gait_globals[run->global_method],
                       run->global.evaluations, run->global.seconds);
    if (run->global_method > 0 && global > 0)
        moray_text_add(text, TEXT, "optimum %d", global);
    else if (run->global_method > 0)
        moray_text_add(text, TEXT, "none");
    moray_text_add(text, TEXT, ".");
}

static void say_ladders(const search_gait *run, char *text)
{
    for (int k = 0; k < run->shown; k++) {
        const stage *at = &run->optimum[k].at;
        moray_text_add(text, TEXT, "Optimum %d ", k + 1);
        gait_job_verdict(&run->job, at, text, TEXT);
        moray_text_add(text, TEXT, ".\n");
    }
}

static double largest_difference(const search_gait *run)
{
    double most = 0;
    for (int k = 0; k < run->shown; k++)
        most = fmax(most, fabs(polished_value(run, &run->optimum[k]) - value_of(run, &run->optimum[k])));
    return most;
}

static void say_certificates(const search_gait *run, char *text)
{
    int passed = 0;
    for (int k = 0; k < run->shown; k++)
        passed += run->optimum[k].at.certificate.pass;
    moray_text_add(
        text, TEXT,
        "Search over orbits and collocation differ by at most %.1e %s. Certificates of the collocation: %d of %d "
        "pass.",
        largest_difference(run), unit_of(run), passed, run->shown);
}

static void print(const void *found, const moray_report *report)
{
    const search_gait *run = found;
    char text[TEXT] = "";
    print_demand(run);
    moray_tables_print(report->tables, report->n_tables, stdout);
    say_found(run, text);
    moray_text_add(text, TEXT, "\n");
    say_ladders(run, text);
    say_certificates(run, text);
    printf("%s\n", text);
}

// ---- JSON ----------------------------------------------------------------------------------------------------------

static void json_optimum(moray_json *json, const search_gait *run, const optimum *o)
{
    moray_json_open(json, NULL);
    moray_json_number(json, "starts_that_end_here", o->hits);
    moray_json_bool(json, "global_ends_here", o->global);
    moray_json_open(json, "search");
    moray_json_members(json, MORAY_MEMBERS({"course_speed_m_s", moray_course_speed(&o->orbit.steady, run->spec.course)},
                                           {"power_W", o->orbit.steady.power}, {"value", value_of(run, o)},
                                           {"difference_to_collocation", polished_value(run, o) - value_of(run, o)},
                                           {"largest_multiplier", o->floquet.largest}));
    moray_json_bool(json, "stable", o->floquet.stable);
    moray_json_close(json);
    gait_job_json_stage(json, &run->job, &o->at);
    moray_json_close(json);
}

static void json_found(moray_json *json, const search_gait *run)
{
    moray_json_open(json, "search");
    moray_json_text(json, "goal", search_gait_fastest(run) ? "speed" : "economy");
    moray_json_text(json, "local", search_gait_locals[run->local_method]);
    moray_json_members(json, MORAY_MEMBERS({"starts", run->starts}, {"starts_lost", run->lost}, {"optima", run->n},
                                           {"orbits", run->orbits}, {"time_s", run->seconds}));
    moray_json_text(json, "global", search_gait_globals[run->global_method]);
    moray_json_members(json,
                       MORAY_MEMBERS({"global_orbits", run->global.evaluations}, {"global_time_s", run->global.seconds},
                                     {"largest_difference", largest_difference(run)}));
    moray_json_close(json);
}

static void summarise(const void *found, moray_json *json)
{
    const search_gait *run = found;
    gait_job_json_head(json, &run->job);
    json_found(json, run);
    moray_json_open_list(json, "optimum");
    for (int k = 0; k < run->shown; k++)
        json_optimum(json, run, &run->optimum[k]);
    moray_json_close(json);
    moray_json_open(json, "baseline");
    moray_gait_to_json(json, "gait", &run->spec.robot, run->job.paper.gait);
    moray_steady_to_json(json, "validated", &run->job.snake.robot, MORAY_FIRST_PRINCIPLES, &run->job.paper,
                         run->spec.course);
    moray_json_close(json);
}

// ---- Files ---------------------------------------------------------------------------------------------------------

static moray_status draw_ridge(const search_gait *run, moray_output *output)
{
    double at[SEARCH_GAIT_SHOWN], best[SEARCH_GAIT_SHOWN];
    for (int k = 0; k < run->shown; k++) {
        at[k] = run->optimum[k].gait.delta / DEG;
        best[k] = value_of(run, &run->optimum[k]);
    }
    const moray_curve curves[] = {{.label = "best gait of each phase shift",
                                   .x = run->ridge[0],
                                   .y = run->ridge[1],
                                   .n = SEARCH_GAIT_RIDGE,
                                   .colour = MORAY_COLOUR_LIMIT},
                                  {.label = "optima",
                                   .x = at,
                                   .y = best,
                                   .n = run->shown,
                                   .style = MORAY_CURVE_POINTS,
                                   .colour = MORAY_COLOUR_BEST}};
    const moray_figure figure = {.name = "ridge",
                                 .title = "The ridge: best gait within the limits for each phase shift",
                                 .x_label = "phase shift delta [deg]",
                                 .y_label = search_gait_fastest(run) ? "speed along the course [m/s]"
                                                                     : "work per distance [J/m]",
                                 .curves = curves,
                                 .n_curves = 2};
    return moray_output_figure(output, &figure);
}

static moray_status draw(const void *found, moray_output *output)
{
    const search_gait *run = found;
    MORAY_TRY(search_gait_draw_map(run, output));
    MORAY_TRY(draw_ridge(run, output));
    return gait_job_draw_gait(&run->job, "Optimum 1", &run->optimum[0].at.trial, output);
}

// The optima beside one another, and the paper's gait.
static moray_status make_scene(const void *found, moray_swim_scene *scene)
{
    const search_gait *run = found;
    static const moray_colour colours[] = {MORAY_COLOUR_BEST, MORAY_COLOUR_SECOND, MORAY_COLOUR_THIRD};
    enum { most = sizeof colours / sizeof *colours };
    const int n = run->shown < most ? run->shown : most;
    char name[32], baseline[64];
    scene->scene.title = "The optima swimming";
    scene->scene.text = "All from rest on the same water, simulated, side by side.";
    for (int k = 0; k < n; k++) {
        snprintf(name, sizeof name, "optimum %d", k + 1);
        MORAY_TRY(gait_job_scene_add(&run->job, scene, name, colours[k], &run->optimum[k].at.trial, n - k,
                                     GAIT_SHOWN_SECONDS));
    }
    return gait_job_scene_add(&run->job, scene, gait_job_baseline(&run->job, baseline), MORAY_COLOUR_BASELINE,
                              &run->job.paper, 0, GAIT_SHOWN_SECONDS);
}

static moray_status write(const void *found, moray_output *output)
{
    const search_gait *run = found;
    return gait_job_trajectory(&run->job, &run->optimum[0].at, output);
}

static const gait_job_shown shown = {summarise, print, write, draw, make_scene};

moray_status search_gait_report(search_gait *run)
{
    struct tables t;
    char text[TEXT] = "";
    int passed = 0;
    if (run->job.common.output) {
        MORAY_TRY(search_gait_ridge(run));
        MORAY_TRY(search_gait_map_new(run));
    }
    moray_ticker_end(&run->job.ticker);
    make_tables(run, &t);
    say_found(run, text);
    moray_text_add(text, TEXT, "\n");
    say_ladders(run, text);
    say_certificates(run, text);
    for (int k = 0; k < run->shown; k++)
        passed += run->optimum[k].at.certificate.pass;
    return gait_job_publish(&run->job, &shown, passed, run->shown,
                            &(moray_report){.title = "search_gait: all optima within the limits",
                                            .text = text,
                                            .tables = t.table,
                                            .n_tables = TABLES,
                                            .words = moray_ladder_words()});
}
