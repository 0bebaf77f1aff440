// SPDX-License-Identifier: MIT
#include <stdarg.h>
#include <stdlib.h>

#include "pareto.h"

enum { text_size = 2400 };

// ---- In words ------------------------------------------------------------------------------------------------------

static double percent(double value, double reference)
{
    return 100 * (value / reference - 1);
}

static const stage *last(const pareto_front *front)
{
    return &front->at[front->n - 1];
}

// Adds to a text of text_size.
__attribute__((format(printf, 3, 4))) static void add(char *text, int *used, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    const int more = vsnprintf(text + *used, (size_t)(text_size - *used), format, arguments);
    va_end(arguments);
    *used = *used + more < text_size ? *used + more : text_size - 1;
}

// How the gait changes along a front.
static void say_trend(const pareto *run, const pareto_front *front, char *text, int *used)
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
    add(text, used, "%s model, %s: %.3g m/s at %.3g W to %.3g m/s at %.3g W. ", pareto_models[front->model],
        pareto_kinds[front->kind], first[PARETO_SPEED], first[PARETO_POWER], end[PARETO_SPEED], end[PARETO_POWER]);
    if (at_bound >= 0) {
        pareto_values(run, &front->at[at_bound], value);
        add(text, used, "omega stays at its bound of %.4g deg/s down to %.3g W while delta %s from %.3g to %.3g deg; ",
            bound, value[PARETO_POWER], rises ? "rises" : "goes", first[PARETO_DELTA], turn);
    }
    add(text, used, "at the end omega is %.4g deg/s, delta %.3g deg.\n", end[PARETO_OMEGA], end[PARETO_DELTA]);
}

// An eel beside lateral undulation: the fastest of both, and both at equal power.
static void say_eel(const pareto_front *lateral, const pareto_front *eel, char *text, int *used)
{
    const moray_gait_prediction *a = &lateral->at[0].prediction, *b = &eel->at[0].prediction;
    double least = INFINITY, most = -INFINITY;
    for (int k = 0; k < eel->n; k++) {
        const double change =
            percent(eel->at[k].prediction.course_speed, pareto_speed_at(lateral, eel->at[k].prediction.power));
        least = fmin(least, change);
        most = fmax(most, change);
    }
    add(text, used, "%s model, fastest %s gait against fastest lateral one: %+.1f %% speed for %+.1f %% power",
        pareto_models[eel->model], pareto_kinds[eel->kind], percent(b->course_speed, a->course_speed),
        percent(b->power, a->power));
    if (isfinite(least))
        add(text, used, "; at equal power %+.1f to %+.1f %% speed", least, most);
    add(text, used, ".\n");
}

// How far the control-oriented gaits fall short of the front of the first-principles model, at the power they use
// there.
static void say_shortfall(const pareto *run, const pareto_front *control, const pareto_front *front, char *text,
                          int *used)
{
    double least = INFINITY, most = -INFINITY, value[PARETO_VALUES];
    for (int k = 0; k < control->n; k++) {
        pareto_values(run, &control->at[k], value);
        const double change = percent(value[PARETO_TRUE_SPEED], pareto_speed_at(front, value[PARETO_TRUE_POWER]));
        least = fmin(least, change);
        most = fmax(most, change);
    }
    if (isfinite(least))
        add(text, used,
            "The %s gaits that the control-oriented model finds best are on the first-principles model %.1f to %.1f %% "
            "slower than its own at equal power.\n",
            pareto_kinds[control->kind], -most, -least);
}

// A front with free taper that is the lateral one.
static bool repeats(const pareto_front *front)
{
    return front->kind == 2 && pareto_is_lateral(front);
}

static void find_words(const pareto *run, char *text)
{
    const int kinds = run->fronts / (1 + (int)run->job.snake.model);
    int used = 0;
    for (int f = 0; f < run->fronts; f++)
        if (!repeats(&run->front[f]))
            say_trend(run, &run->front[f], text, &used);
    for (int f = 0; f < run->fronts; f++)
        if (repeats(&run->front[f]))
            add(text, &used, "%s model, free taper: none is best, everywhere; the front is the lateral one.\n",
                pareto_models[run->front[f].model]);
        else if (run->front[f].kind > 0)
            say_eel(&run->front[f - run->front[f].kind], &run->front[f], text, &used);
    for (int kind = 0; kind < kinds && run->fronts > kinds; kind++)
        if (!repeats(&run->front[kind]))
            say_shortfall(run, &run->front[kind], &run->front[kinds + kind], text, &used);
}

// ---- Tables --------------------------------------------------------------------------------------------------------

struct sheet {
    moray_table table;
    char title[120], label[PARETO_POINTS][32];
    moray_table_row row[PARETO_POINTS];
};

static void fill_sheet(const pareto *run, const pareto_front *front, struct sheet *sheet)
{
    static const char *const columns[] = {"m/s",   "theta_max", "omega",   "delta",
                                          "taper", "m/s per W", "f.-p. W", "f.-p. m/s"};
    enum { n_columns = sizeof columns / sizeof *columns };
    static const int shown[n_columns] = {PARETO_SPEED, PARETO_THETA_MAX, PARETO_OMEGA,      PARETO_DELTA,
                                         PARETO_TAPER, PARETO_PRICE,     PARETO_TRUE_POWER, PARETO_TRUE_SPEED};
    snprintf(sheet->title, sizeof sheet->title, "%s optima, %s: by mean joint power in that model",
             pareto_models[front->model], pareto_kinds[front->kind]);
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

// Text, then the sheets of the fronts.
struct findings {
    char text[text_size];
    struct sheet sheet[PARETO_FRONTS];
};

static void print(const pareto *run, const struct findings *found)
{
    const moray_snake_options *snake = &run->job.snake;
    printf("%d links, current (%g, %g) m/s, course %g deg: fastest gaits within ever less mean joint power; columns "
           "f.-p.: "
           "swum on the first-principles model\n\n",
           snake->robot.links, snake->current[0], snake->current[1], snake->course / DEG);
    for (int f = 0; f < run->fronts; f++)
        if (!repeats(&run->front[f])) {
            moray_table_print(&found->sheet[f].table, stdout);
            printf("\n");
        }
    printf("%s", found->text);
}

static moray_status write_files(const pareto *run, const struct findings *found, const moray_json *json)
{
    moray_output *output = run->job.common.output;
    moray_table tables[PARETO_FRONTS];
    FILE *file;
    MORAY_TRY(moray_output_file(output, "summary.json", &file));
    MORAY_TRY(moray_json_write(json, file));
    MORAY_TRY(pareto_files(run, output));
    for (int f = 0; f < run->fronts; f++)
        tables[f] = found->sheet[f].table;
    const moray_section section = {
        .title = "Fronts", .text = found->text, .figures = "", .tables = tables, .n_tables = run->fronts};
    const moray_report report = {.title = run->job.name,
                                 .sections = &section,
                                 .n_sections = 1,
                                 .argc = run->job.common.argc,
                                 .argv = run->job.common.argv};
    MORAY_TRY(moray_output_report(output, &report));
    return moray_output_commit(output);
}

static moray_status tell(const pareto *run, const struct findings *found)
{
    moray_json *json = pareto_json(run);
    moray_status status = run->job.common.output ? write_files(run, found, json) : moray_ok();
    if (!moray_failed(status) && run->job.common.json)
        status = moray_json_write(json, stdout);
    else if (!moray_failed(status))
        print(run, found);
    moray_json_free(json);
    return status;
}

moray_status pareto_report(gait_job *job)
{
    const pareto *run = (const pareto *)job;
    struct findings *found = calloc(1, sizeof *found);
    if (!found)
        return moray_error(MORAY_MEMORY, "no memory for a report");
    find_words(run, found->text);
    for (int f = 0; f < run->fronts; f++)
        fill_sheet(run, &run->front[f], &found->sheet[f]);
    const moray_status status = tell(run, found);
    free(found);
    return status;
}
