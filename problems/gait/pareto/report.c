// SPDX-License-Identifier: MIT
#include <stdlib.h>

#include "pareto.h"

enum { text_size = 4000 };

// ---- In words ------------------------------------------------------------------------------------------------------

static double percent(double value, double reference)
{
    return 100 * (value / reference - 1);
}

static const stage *last(const pareto_front *front)
{
    return &front->at[front->n - 1];
}

// How the gait changes along a front.
static void say_trend(const pareto *run, const pareto_front *front, char *text)
{
    double first[PARETO_VALUES], end[PARETO_VALUES], value[PARETO_VALUES];
    const double bound = run->job.omega[1] / DEG;
    int at_bound = -1;
    bool rises = true;
    pareto_values(run, &front->at[0], first);
    pareto_values(run, last(front), end);
    double before = first[PARETO_DELTA], turn = first[PARETO_DELTA];
    for (int k = 0; k < front->n; k++) {
        pareto_values(run, &front->at[k], value);
        if (at_bound == k - 1 && value[PARETO_OMEGA] > 0.999 * bound) {
            at_bound = k;
            rises = rises && value[PARETO_DELTA] >= before;
            turn = value[PARETO_DELTA];
        }
        before = value[PARETO_DELTA];
    }
    moray_text_add(text, text_size, "%s model, %s: %.3g m/s at %.3g W to %.3g m/s at %.3g W. ",
                   moray_model_name(front->model), pareto_kinds[front->kind], first[PARETO_SPEED], first[PARETO_POWER],
                   end[PARETO_SPEED], end[PARETO_POWER]);
    if (at_bound >= 0) {
        pareto_values(run, &front->at[at_bound], value);
        moray_text_add(text, text_size,
                       "omega stays at its bound of %.4g deg/s down to %.3g W while delta %s from %.3g to %.3g deg; ",
                       bound, value[PARETO_POWER], rises ? "rises" : "goes", first[PARETO_DELTA], turn);
    }
    moray_text_add(text, text_size, "at the end omega is %.4g deg/s, delta %.3g deg.\n", end[PARETO_OMEGA],
                   end[PARETO_DELTA]);
}

// An eel beside lateral undulation: the fastest of both, and both at equal power.
static void say_eel(const pareto_front *lateral, const pareto_front *eel, char *text)
{
    const moray_gait_prediction *a = &lateral->at[0].prediction, *b = &eel->at[0].prediction;
    double least = INFINITY, most = -INFINITY;
    for (int k = 0; k < eel->n; k++) {
        const double change =
            percent(eel->at[k].prediction.course_speed, pareto_speed_at(lateral, eel->at[k].prediction.power));
        least = fmin(least, change);
        most = fmax(most, change);
    }
    moray_text_add(text, text_size,
                   "%s model, fastest %s gait against fastest lateral one: %+.1f %% speed for %+.1f %% power",
                   moray_model_name(eel->model), pareto_kinds[eel->kind], percent(b->course_speed, a->course_speed),
                   percent(b->power, a->power));
    if (isfinite(least))
        moray_text_add(text, text_size, "; at equal power %+.1f to %+.1f %% speed", least, most);
    moray_text_add(text, text_size, ".\n");
}

// How far the control-oriented gaits fall short of the front of the first-principles model, at the power they use
// there.
static void say_shortfall(const pareto *run, const pareto_front *control, const pareto_front *front, char *text)
{
    double least = INFINITY, most = -INFINITY, value[PARETO_VALUES];
    for (int k = 0; k < control->n; k++) {
        pareto_values(run, &control->at[k], value);
        const double change = percent(value[PARETO_TRUE_SPEED], pareto_speed_at(front, value[PARETO_TRUE_POWER]));
        least = fmin(least, change);
        most = fmax(most, change);
    }
    if (isfinite(least))
        moray_text_add(
            text, text_size,
            "The %s gaits that the control-oriented model finds best are on the first-principles model %.1f to %.1f %% "
            "slower than its own at equal power.\n",
            pareto_kinds[control->kind], -most, -least);
}

// Not so a front that is left out, or one with free taper that is the lateral one.
static bool is_shown(const pareto_front *front)
{
    return front->n > 0 && !(front->kind == 2 && pareto_is_lateral(front));
}

// How many gaits of a front win on every model of the ladder, and the range of all their gains.
static void say_ladder(const pareto_front *front, char *text)
{
    double least = INFINITY, most = -INFINITY;
    int win = 0;
    for (int k = 0; k < front->n; k++) {
        const moray_ladder_count count = moray_ladder_counted(front->at[k].ladder, front->at[k].found_on);
        win += count.n > 0 && count.wins == count.n;
        least = fmin(least, count.least);
        most = fmax(most, count.most);
    }
    if (isfinite(least))
        moray_text_add(
            text, text_size,
            "%s model, %s: on the ladder of models, at the power of the paper's gait, %d of %d gaits win on all "
            "models; gains from %+.1f to %+.1f %%.\n",
            moray_model_name(front->model), pareto_kinds[front->kind], win, front->n, least, most);
}

static void find_words(const pareto *run, char *text)
{
    const int kinds = run->kinds;
    for (int f = 0; f < run->fronts; f++)
        if (is_shown(&run->front[f]))
            say_trend(run, &run->front[f], text);
    for (int f = 0; f < run->fronts; f++)
        if (run->front[f].n == 0)
            moray_text_add(text, text_size, "Left out: the %s front of the %s model: %s.\n",
                           pareto_kinds[run->front[f].kind], moray_model_name(run->front[f].model),
                           run->front[f].why.text);
        else if (!is_shown(&run->front[f]))
            moray_text_add(text, text_size,
                           "%s model, free taper: none is best, everywhere; the front is the lateral one.\n",
                           moray_model_name(run->front[f].model));
        else if (run->front[f].kind > 0 && run->front[f - run->front[f].kind].n > 0)
            say_eel(&run->front[f - run->front[f].kind], &run->front[f], text);
    for (int kind = 0; kind < kinds && run->fronts > kinds; kind++)
        if (is_shown(&run->front[kind]) && run->front[kinds + kind].n > 0)
            say_shortfall(run, &run->front[kind], &run->front[kinds + kind], text);
    for (int f = 0; f < run->fronts; f++)
        if (is_shown(&run->front[f]))
            say_ladder(&run->front[f], text);
}

// ---- Tables --------------------------------------------------------------------------------------------------------

struct sheet {
    moray_table table;
    char title[120], label[PARETO_POINTS][32];
    moray_table_row row[PARETO_POINTS];
};

// Gains of a front's gaits on the ladder: some rungs, and how the others lie.
static void fill_ladder(const pareto_front *front, const struct sheet *like, struct sheet *sheet)
{
    static const char *const shown[] = {"paper", "split3", "strip", "quadratic", "consistent"};
    enum { n_shown = sizeof shown / sizeof *shown };
    snprintf(sheet->title, sizeof sheet->title, "%s optima, %s: gain at the power of the paper's gait, %% of speed",
             moray_model_name(front->model), pareto_kinds[front->kind]);
    sheet->table = (moray_table){.title = sheet->title,
                                 .columns = {shown[0], shown[1], shown[2], shown[3], shown[4], "least", "most", "wins"},
                                 .n_columns = n_shown + 3,
                                 .rows = sheet->row,
                                 .n_rows = front->n};
    for (int k = 0; k < front->n; k++) {
        const moray_ladder_row *ladder = front->at[k].ladder;
        const moray_ladder_count count = moray_ladder_counted(ladder, front->at[k].found_on);
        sheet->row[k] = (moray_table_row){.label = like->label[k]};
        for (int i = 0; i < n_shown; i++)
            sheet->row[k].value[i] = ladder[moray_rung_named(shown[i])].gain_percent;
        sheet->row[k].value[n_shown] = count.least;
        sheet->row[k].value[n_shown + 1] = count.most;
        sheet->row[k].value[n_shown + 2] = count.wins;
    }
}

static void fill_sheet(const pareto *run, const pareto_front *front, struct sheet *sheet)
{
    static const char *const columns[] = {"m/s",   "theta_max", "omega",   "delta",
                                          "taper", "m/s per W", "f.-p. W", "f.-p. m/s"};
    enum { n_columns = sizeof columns / sizeof *columns };
    static const int shown[n_columns] = {PARETO_SPEED, PARETO_THETA_MAX, PARETO_OMEGA,      PARETO_DELTA,
                                         PARETO_TAPER, PARETO_PRICE,     PARETO_TRUE_POWER, PARETO_TRUE_SPEED};
    snprintf(sheet->title, sizeof sheet->title, "%s optima, %s: by %s in that model", moray_model_name(front->model),
             pareto_kinds[front->kind], moray_power_label(&run->job.snake.robot, front->model));
    sheet->table = (moray_table){.title = sheet->title, .n_columns = n_columns, .rows = sheet->row, .n_rows = front->n};
    for (int i = 0; i < n_columns; i++)
        sheet->table.columns[i] = columns[i];
    for (int k = 0; k < front->n; k++) {
        double value[PARETO_VALUES];
        pareto_values(run, &front->at[k], value);
        snprintf(sheet->label[k], sizeof sheet->label[k], "%.4g W%s", value[PARETO_POWER], k == 0 ? " (no limit)" : "");
        sheet->row[k] = (moray_table_row){.label = sheet->label[k]};
        for (int i = 0; i < n_columns; i++)
            sheet->row[k].value[i] = value[shown[i]];
    }
}

static void print(const void *found, const moray_report *report)
{
    const pareto *run = found;
    gait_job_print_head(&run->job);
    printf(": fastest gaits within ever less %s; columns f.-p.: swum on the first-principles model\n\n",
           moray_power_label(&run->job.snake.robot, run->job.snake.model));
    for (int f = 0; f < run->fronts; f++)
        if (is_shown(&run->front[f]))
            moray_tables_print(&report->sections[1].tables[2 * f], 2, stdout);
    printf("%s", report->text);
}

// Of the last model: the fastest gaits of each kind, the thriftiest lateral one, the paper's.
static moray_status make_scene(const void *found, moray_swim_scene *scene)
{
    const pareto *run = found;
    const pareto_front *lateral = &run->front[run->fronts - run->kinds];
    const pareto_front *eel = lateral + 1;
    const gait_job *job = &run->job;
    const double ways = 6,
                 length = 2 * job->snake.robot.l * job->snake.robot.links; // the fastest swims so many lengths
    const double speed = lateral->n > 0 ? lateral->at[0].trial.steady[job->snake.model].speed : NAN;
    const double seconds = fmin(GAIT_SHOWN_SECONDS, ways * length / speed); // of a number and a NaN the number
    char baseline[64];
    scene->scene.title = "Ends of the fronts, swimming";
    scene->scene.text = "All from rest on the same water, simulated, side by side.";
    if (lateral->n > 0)
        MORAY_TRY(gait_job_scene_add(job, scene, "fastest lateral gait", MORAY_COLOUR_BEST, &lateral->at[0].trial, 3,
                                     seconds));
    if (eel->n > 0)
        MORAY_TRY(gait_job_scene_add(job, scene, "fastest eel-like gait", MORAY_COLOUR_SECOND, &eel->at[0].trial, 2,
                                     seconds));
    if (lateral->n > 1)
        MORAY_TRY(gait_job_scene_add(job, scene, "lateral gait of the least power", MORAY_COLOUR_THIRD,
                                     &last(lateral)->trial, 1, seconds));
    return gait_job_scene_add(job, scene, gait_job_baseline(job, baseline), MORAY_COLOUR_BASELINE, &job->paper, 0,
                              seconds);
}

static const gait_job_shown shown = {pareto_summary, print, pareto_write, pareto_draw, make_scene};

static moray_status show(const pareto *run, struct sheet *sheets)
{
    char text[text_size] = "";
    moray_table tables[2 * PARETO_FRONTS];
    int n = 0, passed = 0;
    find_words(run, text);
    for (int f = 0; f < run->fronts; f++) {
        fill_sheet(run, &run->front[f], &sheets[2 * f]);
        fill_ladder(&run->front[f], &sheets[2 * f], &sheets[2 * f + 1]);
        tables[2 * f] = sheets[2 * f].table;
        tables[2 * f + 1] = sheets[2 * f + 1].table;
        for (int k = 0; k < run->front[f].n; k++, n++)
            passed += run->front[f].at[k].certificate.pass;
    }
    const moray_section sections[] = {
        {.title = "Fronts", .figures = ""},
        {.title = "The gaits of each",
         .text = "m/s per W: what another watt would bring, by the multiplier of the limit. f.-p.: swum on the "
                 "first-principles model. least, most: of the gains; wins: 1 where all are gains.",
         .tables = tables,
         .n_tables = 2 * run->fronts}};
    return gait_job_publish(&run->job, &shown, passed, n,
                            &(moray_report){.title = "pareto: speed against power",
                                            .text = text,
                                            .sections = sections,
                                            .n_sections = 2,
                                            .words = moray_ladder_words()});
}

moray_status pareto_report(gait_job *job)
{
    struct sheet *sheets = calloc(2 * PARETO_FRONTS, sizeof *sheets);
    if (!sheets)
        return moray_error(MORAY_MEMORY, "no memory for a report");
    const moray_status status = show((const pareto *)job, sheets);
    free(sheets);
    return status;
}
