// SPDX-License-Identifier: MIT
#include "results/figure.h"

#include <math.h>
#include <string.h>

enum { LINE = 20, FONT = 14, AXIS = 62, KEY = 40 }; // of the canvas; the axis with its label; where the key begins
enum { TITLE = 76 };                                // letters in a line

static void widen_to(double value, double range[2])
{
    range[0] = fmin(range[0], value); // NaN stays out
    range[1] = fmax(range[1], value);
}

// What is drawn along an axis, 0 for x; {INFINITY, -INFINITY} where there is nothing.
static void range_along(const moray_figure *figure, int axis, double range[2])
{
    range[0] = INFINITY;
    range[1] = -INFINITY;
    for (int k = 0; k < figure->n_curves; k++) {
        const moray_curve *curve = &figure->curves[k];
        const size_t stride = curve->stride ? (size_t)curve->stride : 1;
        for (size_t i = 0; i < (size_t)curve->n; i++)
            widen_to((axis ? curve->y : curve->x)[i * stride], range);
    }
}

// ---- Scales --------------------------------------------------------------------------------------------------------

// Middle and half width of either axis: no flatter or slimmer than 4:1 around whatever is drawn. False where nothing
// is.
static bool equal_axes(const moray_figure *figure, double middle[2], double half[2])
{
    double range[2][2];
    for (int axis = 0; axis < 2; axis++)
        range_along(figure, axis, range[axis]);
    const double width = range[0][1] - range[0][0], height = range[1][1] - range[1][0];
    for (int axis = 0; axis < 2; axis++) {
        middle[axis] = (range[axis][0] + range[axis][1]) / 2;
        half[axis] = fmax(0.53 * (axis ? height : width), 0.125 * (axis ? width : height));
    }
    return isfinite(width) && isfinite(height) && width + height > 0;
}

static void write_equal_axes(FILE *script, const moray_figure *figure)
{
    double middle[2], half[2];
    fputs("set size ratio -1\n", script);
    for (int axis = 0; axis < 2 && equal_axes(figure, middle, half); axis++)
        fprintf(script, "set %crange [%.17g:%.17g]\n", axis ? 'y' : 'x', middle[axis] - half[axis],
                middle[axis] + half[axis]);
}

// As much of the axis as is used, not whole decades; within three decades, numbers at 1, 2 and 5 of each.
static void write_log_axis(FILE *script, const moray_figure *figure, int axis)
{
    static const double steps[] = {1, 2, 5};
    const double margin = 1.1;
    const char name = axis ? 'y' : 'x';
    double range[2];
    range_along(figure, axis, range);
    fprintf(script, "set logscale %c\nset format %c '%% g'\n", name, name);
    if (!(range[0] > 0 && isfinite(range[1])))
        return;
    fprintf(script, "set %crange [%.17g:%.17g]\n", name, range[0] / margin, range[1] * margin);
    if (range[1] > 1e3 * range[0])
        return;
    const double first = pow(10, floor(log10(range[0])));
    const char *before = "";
    fprintf(script, "set %ctics (", name);
    for (double decade = first; decade <= range[1]; decade *= 10)
        for (size_t k = 0; k < sizeof steps / sizeof *steps; k++, before = ", ")
            fprintf(script, "%s%g", before, steps[k] * decade);
    fputs(")\n", script);
}

bool moray_figure_time(const moray_figure *figure, double range[2])
{
    range_along(figure, 0, range);
    return figure->over_time && !figure->log_x && range[1] > range[0] && isfinite(range[1] - range[0]);
}

static void write_time_axis(FILE *script, const moray_figure *figure)
{
    const moray_figure_layout at = moray_figure_lay_out(figure);
    double range[2];
    if (!moray_figure_time(figure, range))
        return;
    fprintf(script, "set xrange [%.17g:%.17g]\nset lmargin at screen %g\nset rmargin at screen %g\n", range[0],
            range[1], at.left / at.width, 1 - at.right / at.width);
}

// No more of either axis than is used: lines begin and end at its ends, points keep off them.
static void write_margins(FILE *script, const moray_figure *figure)
{
    bool points = false;
    for (int i = 0; i < figure->n_curves; i++)
        points = points || figure->curves[i].style == MORAY_CURVE_POINTS;
    const double side = points ? 0.03 : 0;
    fprintf(script, "set autoscale fix\nset offsets graph %g, graph %g, graph 0.03, graph 0.03\n", side, side);
}

// ---- Words ---------------------------------------------------------------------------------------------------------

// The end of the line of a title that begins there: at a blank, where the rest is longer than a line.
static const char *end_of_line(const char *text)
{
    const char *end = text;
    if (strlen(text) <= TITLE)
        return text + strlen(text);
    for (const char *c = text; *c && c - text <= TITLE; c++)
        if (*c == ' ')
            end = c;
    return end == text ? text + strlen(text) : end;
}

static int lines_of(const char *text)
{
    int lines = 0;
    while (text && *text) {
        lines++;
        text = end_of_line(text);
        text += *text == ' ';
    }
    return lines;
}

static void write_title(FILE *script, const char *text)
{
    char line[1000];
    fputs("set title ", script);
    moray_figure_quote(script, "");
    for (bool first = true; text && *text; first = false) {
        const char *end = end_of_line(text);
        snprintf(line, sizeof line, "%.*s", (int)(end - text), text);
        fputs(first ? "." : ".\"\\n\".", script);
        moray_figure_quote(script, line);
        text = *end == ' ' ? end + 1 : end;
    }
    fputc('\n', script);
}

// Rows by name, the first one on top.
static void write_names(FILE *script, const moray_figure *figure)
{
    if (!figure->n_y_names)
        return;
    fputs("set ytics (", script);
    for (int i = 0; i < figure->n_y_names; i++) {
        fputs(i ? ", " : "", script);
        moray_figure_quote(script, figure->y_names[i]);
        fprintf(script, " %d", i);
    }
    fprintf(script, ")\nset yrange [%g:-0.5]\nset yzeroaxis lt 1 lw 1 lc rgb '#555555'\n", figure->n_y_names - 0.5);
}

// ---- Canvas --------------------------------------------------------------------------------------------------------

// Of the frame, which a path fills as far as it may.
static int frame_height(const moray_figure *figure, double width)
{
    const double usual = 298, least = 150, most = 420;
    double middle[2], half[2];
    if (!figure->equal_axes || !equal_axes(figure, middle, half))
        return (int)usual;
    return (int)fmin(most, fmax(least, width * half[1] / half[0]));
}

// Narrow enough to be read on a phone, where it is as wide as the screen.
moray_figure_layout moray_figure_lay_out(const moray_figure *figure)
{
    moray_figure_layout at = {.width = 600, .left = 96, .right = 18};
    at.top = 22 + LINE * lines_of(figure->title);
    at.bottom = AXIS + 8 + LINE * moray_figure_key_lines(figure);
    at.height = (int)(at.top + at.bottom) + frame_height(figure, at.width - at.left - at.right);
    return at;
}

void moray_figure_axes(FILE *script, const moray_figure *figure)
{
    const moray_figure_layout at = moray_figure_lay_out(figure);
    fprintf(script, "set terminal svg noenhanced size %d,%d font 'Helvetica,%d' background '#ffffff'\n", at.width,
            at.height, (int)FONT);
    fputs("set grid lc rgb '#d0d0d0' lt 1 lw 0.5\nset border 3\nset tics nomirror\n", script);
    fprintf(script,
            "set tmargin at screen %g\nset bmargin at screen %g\n"
            "set key left top at screen %g,%g Left reverse maxcols 1\n",
            1 - at.top / at.height, at.bottom / at.height, KEY / (double)at.width, (at.bottom - AXIS) / at.height);
    write_margins(script, figure);
    if (figure->log_x)
        write_log_axis(script, figure, 0);
    if (figure->log_y)
        write_log_axis(script, figure, 1);
    if (figure->equal_axes)
        write_equal_axes(script, figure);
    write_time_axis(script, figure);
    write_names(script, figure);
    write_title(script, figure->title);
    moray_figure_set_text(script, "xlabel", figure->x_label);
    moray_figure_set_text(script, "ylabel", figure->y_label);
}
