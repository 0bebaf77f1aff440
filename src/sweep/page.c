// SPDX-License-Identifier: MIT
//
// A page that shows the grid as it fills and loads itself again until the sweep has ended.
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "sweep/sweep.h"

enum { MOST_ROWS = 120, MOST_COLUMNS = 240, MOST_FAILED = 50 };

// Rows and columns of cells: columns are the last axis that has several values, rows all that stand before it.
typedef struct map {
    long columns, rows, step_column, step_row; // of every n-th only, where there are too many
    int axis;
    double low, high; // of what is to be lowered, over the points that are solved
} map;

static map map_of(const struct store *store)
{
    const struct grid *grid = store->grid;
    map m = {.axis = grid->axes - 1, .low = INFINITY, .high = -INFINITY};
    while (m.axis > 0 && grid->shape[m.axis] == 1)
        m.axis--;
    m.columns = grid->shape[m.axis];
    m.rows = grid->points / m.columns;
    m.step_column = (m.columns + MOST_COLUMNS - 1) / MOST_COLUMNS;
    m.step_row = (m.rows + MOST_ROWS - 1) / MOST_ROWS;
    for (long k = 0; k < grid->points; k++)
        if (store->state[k] == POINT_SOLVED && isfinite(store->objective[k])) {
            m.low = fmin(m.low, store->objective[k]);
            m.high = fmax(m.high, store->objective[k]);
        }
    return m;
}

static void escape(FILE *file, const char *text)
{
    for (; *text; text++)
        if (*text == '<' || *text == '>' || *text == '&' || *text == '"')
            fprintf(file, "&#%d;", *text);
        else
            putc(*text, file);
}

// "links 6, current_x 0.1"
static void setting(FILE *file, const struct store *store, long point)
{
    enum { most = MORAY_SWEEP_AXES + MORAY_SWEEP_RANGES };
    moray_key_value settings[most];
    double value[most];
    char text[most][32];
    moray_grid_settings(store->grid, point, settings, value, text);
    for (int k = 0; k < store->grid->spec->axes + store->grid->spec->ranges; k++) {
        fputs(k ? ", " : "", file);
        escape(file, settings[k].key);
        putc(' ', file);
        escape(file, settings[k].value);
    }
}

// From dark blue, the lowest, to yellow.
static void colour(FILE *file, const struct store *store, const map *m, long point)
{
    if (store->state[point] != POINT_SOLVED) {
        fputs(store->state[point] == POINT_FAILED ? "#d03030" : "#e4e4e4", file);
        return;
    }
    const double width = m->high - m->low;
    const double part = width > 0 && isfinite(store->objective[point]) ? (store->objective[point] - m->low) / width : 0;
    fprintf(file, "rgb(%.0f,%.0f,%.0f)", 30 + 210 * part, 60 + 150 * part, 140 - 90 * part);
}

static void draw(FILE *file, const struct store *store, const map *m)
{
    const long columns = (m->columns + m->step_column - 1) / m->step_column,
               rows = (m->rows + m->step_row - 1) / m->step_row;
    const double width = fmin(28, 1000. / (double)columns), height = fmin(28, 800. / (double)rows);
    fprintf(file, "<svg width=\"%.0f\" height=\"%.0f\">\n", width * (double)columns, height * (double)rows);
    for (long row = 0; row < rows; row++)
        for (long column = 0; column < columns; column++) {
            const long point = row * m->step_row * m->columns + column * m->step_column;
            fprintf(file, "<rect x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"%.1f\" fill=\"", width * (double)column,
                    height * (double)row, fmax(width - 1, 0.8 * width), height - 1); // above 5
            colour(file, store, m, point);
            fputs("\"><title>", file);
            setting(file, store, point);
            if (store->state[point] == POINT_SOLVED)
                fprintf(file, ": %.6g", store->objective[point]);
            fputs("</title></rect>\n", file);
        }
    fputs("</svg>\n", file);
}

static void list_failed(FILE *file, const struct store *store)
{
    int listed = 0;
    for (long k = 0; k < store->grid->points && listed < MOST_FAILED; k++) {
        if (store->state[k] != POINT_FAILED)
            continue;
        fputs(listed++ ? "<li>" : "<h2>Not solved</h2>\n<ul>\n<li>", file);
        setting(file, store, k);
        fputs(": ", file);
        escape(file, store->reason[k] ? store->reason[k] : "");
        fputs("</li>\n", file);
    }
    fputs(listed ? "</ul>\n" : "", file);
}

static void write_page(FILE *file, const struct store *store, const char *progress, bool ended)
{
    const moray_sweep_spec *spec = store->grid->spec;
    const map m = map_of(store);
    const char *title = spec->title ? spec->title : "sweep";
    fputs("<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n", file);
    fputs(ended ? "" : "<meta http-equiv=\"refresh\" content=\"3\">\n", file);
    fputs("<title>", file);
    escape(file, title);
    fputs("</title><style>body{font:15px sans-serif;margin:1.5em}</style></head><body>\n<h1>", file);
    escape(file, title);
    fputs("</h1>\n<p>", file);
    escape(file, progress);
    fputs("</p>\n<p>", file);
    escape(file, m.axis < store->grid->first ? "draw" : spec->axis[m.axis - store->grid->first].key);
    fputs(" from left to right, a row for each setting of the others; grey: not tried yet, red: not solved", file);
    if (m.high >= m.low && spec->objective) {
        fputs(", from blue to yellow: ", file);
        escape(file, spec->objective);
        fprintf(file, " from %.6g to %.6g", m.low, m.high);
    }
    fputs(". What a cell is, it tells under the pointer.</p>\n", file);
    draw(file, store, &m);
    list_failed(file, store);
    fputs("</body></html>\n", file);
}

moray_status moray_page_write(const struct store *store, const char *progress, bool ended)
{
    const char *name = store->grid->spec->page;
    char temporary[4200];
    snprintf(temporary, sizeof temporary, "%s.new", name);
    FILE *file = fopen(temporary, "w");
    if (!file)
        return moray_error(MORAY_IO, "%.200s: %s", temporary, strerror(errno));
    write_page(file, store, progress, ended);
    const bool failed = ferror(file) != 0;
    if (fclose(file) == 0 && !failed && rename(temporary, name) == 0)
        return moray_ok();
    const int error = errno;
    unlink(temporary);
    return moray_error(MORAY_IO, "%.200s cannot be written: %s", name, strerror(error));
}
