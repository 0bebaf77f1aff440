// SPDX-License-Identifier: MIT
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "main.h"

const char *const paper_reading_names[] = {"corrected", "23h", "l", "printed", NULL};

// ---- Keeping -------------------------------------------------------------------------------------------------------

typedef struct paper_thing {
    struct paper_thing *next;
    void *thing;
    void (*release)(void *);
} paper_thing;

static moray_status no_memory(const paper *p)
{
    return moray_error(MORAY_MEMORY, "%s: no memory", p->study);
}

moray_status paper_own(paper *p, void *thing, void (*release)(void *))
{
    paper_thing *link = malloc(sizeof *link);
    if (!thing || !link) {
        if (thing)
            release(thing);
        free(link);
        return no_memory(p);
    }
    *link = (paper_thing){.next = p->things, .thing = thing, .release = release};
    p->things = link;
    return moray_ok();
}

void paper_release(paper *p)
{
    while (p->things) {
        paper_thing *link = p->things;
        p->things = link->next;
        link->release(link->thing);
        free(link);
    }
}

moray_status paper_numbers(paper *p, size_t n, double **numbers)
{
    *numbers = calloc(n ? n : 1, sizeof **numbers);
    return paper_own(p, *numbers, free);
}

static void release_track(void *track)
{
    moray_swim_track_free(track);
    free(track);
}

// A zeroed track, for moray_swim_track_new or an orbit to fill.
static moray_status own_track(paper *p, moray_swim_track **track)
{
    *track = calloc(1, sizeof **track);
    return paper_own(p, *track, release_track);
}

moray_status paper_track(paper *p, const moray_swimmer *swimmer, int capacity, moray_swim_track **track)
{
    MORAY_TRY(own_track(p, track));
    return moray_swim_track_new(*track, swimmer, capacity);
}

static void release_swimmer(void *swimmer)
{
    moray_swimmer_free(swimmer);
}

moray_status paper_swimmer(paper *p, const moray_robot *robot, moray_model model, paper_reading reading,
                           moray_swimmer **swimmer)
{
    MORAY_TRY(paper_reading_swimmer(swimmer, robot, model, reading));
    MORAY_TRY(paper_own(p, *swimmer, release_swimmer));
    moray_swimmer_set_current(*swimmer, p->rig.current[0], p->rig.current[1]);
    return moray_ok();
}

// printf into memory that is p's own; NULL when there is none.
static char *print_text(paper *p, const char *format, va_list arguments)
{
    char *text = NULL;
    size_t size;
    FILE *stream = open_memstream(&text, &size);
    const bool printed = stream && vfprintf(stream, format, arguments) >= 0;
    if (stream && fclose(stream) == 0 && printed)
        return moray_failed(paper_own(p, text, free)) ? NULL : text;
    free(text);
    return NULL;
}

const char *paper_label(paper *p, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    const char *text = print_text(p, format, arguments);
    va_end(arguments);
    return text ? text : "";
}

// ---- Swimming ------------------------------------------------------------------------------------------------------

moray_gait paper_gait(const paper *p, moray_model model, double theta_max)
{
    moray_gait gait = p->gait[model];
    gait.amplitude = moray_amplitude_from_theta_max(p->robot, model, theta_max, gait.delta);
    return gait;
}

moray_status paper_orbit(paper *p, moray_model model, const moray_gait *gait, int points, moray_steady *steady,
                         moray_swim_track **orbit)
{
    return paper_orbit_in(p, p->rig.current, model, gait, points, steady, orbit);
}

moray_status paper_orbit_in(paper *p, const double current[2], moray_model model, const moray_gait *gait, int points,
                            moray_steady *steady, moray_swim_track **orbit)
{
    moray_swim_setup setup = moray_test_rig_setup(&p->rig, model);
    setup.current[0] = current[0];
    setup.current[1] = current[1];
    const moray_status status = paper_orbit_of(p, &setup, gait, points, steady, orbit);
    moray_swimmer_set_current(setup.swimmer, p->rig.current[0], p->rig.current[1]);
    return status;
}

moray_status paper_orbit_of(paper *p, const moray_swim_setup *setup, const moray_gait *gait, int points,
                            moray_steady *steady, moray_swim_track **orbit)
{
    moray_steady unused;
    MORAY_TRY(own_track(p, orbit));
    return moray_swim_steady(setup, gait, 0, steady ? steady : &unused, *orbit, points);
}

double paper_half_range(const double *values, int stride, int n)
{
    double low = values[0], high = values[0];
    for (int k = 1; k < n; k++) {
        low = fmin(low, values[k * stride]);
        high = fmax(high, values[k * stride]);
    }
    return (high - low) / 2;
}

// ---- Telling -------------------------------------------------------------------------------------------------------

void paper_progress(const paper *p, const char *format, ...)
{
    char text[200];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    moray_ticker_show(&p->ticker, "paper: %s: %s", p->study, text);
}

static bool prints(const paper *p)
{
    moray_ticker_end(&p->ticker);
    return !p->settings->common.json;
}

static const char *copy(paper *p, const char *text)
{
    return text ? paper_label(p, "%s", text) : NULL;
}

moray_status paper_table(paper *p, const moray_table *table)
{
    moray_table_row *rows = calloc((size_t)table->n_rows + 1, sizeof *rows);
    MORAY_TRY(paper_own(p, rows, free));
    if (p->telling->n_tables == PAPER_TABLES)
        return moray_error(MORAY_INPUT, "%s: more than %d tables", p->study, PAPER_TABLES);
    moray_table *kept = &p->telling->table[p->telling->n_tables++];
    *kept = *table;
    kept->title = copy(p, table->title);
    kept->rows = rows;
    for (int j = 0; j < table->n_columns; j++)
        kept->columns[j] = copy(p, table->columns[j]);
    for (int i = 0; i < table->n_rows; i++) {
        rows[i] = table->rows[i];
        rows[i].label = copy(p, rows[i].label);
        rows[i].unit = copy(p, rows[i].unit);
        rows[i].text = copy(p, rows[i].text);
    }
    if (prints(p)) {
        moray_table_print(table, stdout);
        printf("\n");
        fflush(stdout);
    }
    return moray_ok();
}

moray_status paper_rows(paper *p, const char *title, const char *const *heads, const moray_table_row *rows, int n)
{
    moray_table table = {.title = title, .rows = rows, .n_rows = n};
    for (; heads[table.n_columns]; table.n_columns++)
        table.columns[table.n_columns] = heads[table.n_columns];
    return paper_table(p, &table);
}

moray_status paper_say(paper *p, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    const char *text = print_text(p, format, arguments);
    va_end(arguments);
    if (!text)
        return no_memory(p);
    const char *before = p->telling->text;
    p->telling->text = paper_label(p, "%s%s%s", before ? before : "", before ? "\n" : "", text);
    if (prints(p)) {
        paper_print_wrapped(text, stdout);
        printf("\n");
        fflush(stdout);
    }
    return moray_ok();
}

static void file_name(const paper *p, const char *name, const char *end, char file[120])
{
    snprintf(file, 120, "%s%s%s%s", p->study, name ? "_" : "", name ? name : "", end);
}

moray_status paper_csv(paper *p, const char *name, const moray_column *columns, int n_columns, int n_rows)
{
    char file_of[120];
    FILE *file;
    if (!p->output)
        return moray_ok();
    file_name(p, name, ".csv", file_of);
    MORAY_TRY(moray_output_file(p->output, file_of, &file));
    moray_csv_write(file, columns, n_columns, n_rows);
    return moray_ok();
}

moray_status paper_figure(paper *p, const moray_figure *figure)
{
    char name[120];
    moray_figure named = *figure;
    if (!p->output)
        return moray_ok();
    file_name(p, figure->name, "", name);
    named.name = name;
    const moray_status status = moray_output_figure(p->output, &named);
    moray_ticker_end(&p->ticker);
    return moray_app_drawn(&p->settings->common, "paper", status);
}

moray_status paper_draw(paper *p, const paper_graph *graph)
{
    enum { MOST = 16 };
    moray_curve curves[MOST];
    const int n_curves = graph->shown ? graph->n_shown : graph->n_columns - 1;
    if (n_curves > MOST)
        return moray_error(MORAY_INPUT, "%s: %d curves; a figure may have %d", p->study, n_curves, MOST);
    for (int c = 0; c < n_curves; c++) {
        const moray_column *column = &graph->columns[graph->shown ? graph->shown[c] : 1 + c];
        curves[c] = (moray_curve){.label = graph->labels ? graph->labels[c] : column->name,
                                  .x = graph->columns->values,
                                  .y = column->values,
                                  .n = graph->n,
                                  .style = graph->style};
    }
    MORAY_TRY(paper_csv(p, graph->name, graph->columns, graph->n_columns, graph->n));
    return paper_figure(p, &(moray_figure){.name = graph->name,
                                           .title = graph->title,
                                           .x_label = graph->x_label,
                                           .y_label = graph->y_label,
                                           .curves = curves,
                                           .n_curves = n_curves});
}
