// SPDX-License-Identifier: MIT
#include "base/number.h"
#include "results/results.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// Okabe and Ito's palette in order of contrast on white, without its yellow; dashes differ as well.
static const struct {
    const char *colour, *dash;
    int marker;
} looks[] = {
    {"#0072B2", "solid", 7},       {"#D55E00", "(14,6)", 5}, {"#009E73", "(3,5)", 9},
    {"#000000", "(14,5,3,5)", 6},  {"#CC79A7", "(7,4)", 4},  {"#E69F00", "(14,4,3,4,3,4)", 8},
    {"#56B4E9", "(20,4,7,4)", 11},
};
enum { N_LOOKS = sizeof looks / sizeof *looks, LIMIT_LOOK = 3 };

static int look_of(const moray_curve *curve, int number)
{
    static const int named[] = {[MORAY_COLOUR_BEST] = 0,
                                [MORAY_COLOUR_BASELINE] = 1,
                                [MORAY_COLOUR_SECOND] = 2,
                                [MORAY_COLOUR_THIRD] = 4,
                                [MORAY_COLOUR_LIMIT] = LIMIT_LOOK};
    return curve->colour == MORAY_COLOUR_BY_NUMBER ? number % N_LOOKS : named[curve->colour];
}

// A text in gnuplot's single quotes, where only the quote itself and a line's end mean something; quotes are appended
// in double ones, for gnuplot cannot read two of them doubled.
static void quote(FILE *script, const char *text)
{
    fputc('\'', script);
    for (const char *c = text ? text : ""; *c; c++)
        if (*c == '\'')
            fputs("'.\"'\".'", script);
        else
            fputc((unsigned char)*c < ' ' ? ' ' : *c, script);
    fputc('\'', script);
}

static void set_text(FILE *script, const char *what, const char *text)
{
    fprintf(script, "set %s ", what);
    quote(script, text);
    fputc('\n', script);
}

// A blank line interrupts the curve; so does a NaN.
static void write_data(FILE *script, const moray_curve *curve, int number)
{
    char x[32], y[32];
    const int stride = curve->stride ? curve->stride : 1;
    fprintf(script, "$curve%d << EOD\n", number);
    for (size_t i = 0; i < (size_t)curve->n; i++) {
        const double at_x = curve->x[i * stride], at_y = curve->y[i * stride];
        if (isfinite(at_x) && isfinite(at_y))
            fprintf(script, "%s %s\n", moray_number_text(at_x, x), moray_number_text(at_y, y));
        else
            fputc('\n', script);
    }
    fputs("EOD\n", script);
}

static double half_cell(const double *at, int n)
{
    return (at[n - 1] - at[0]) / (n - 1) / 2;
}

// The field as rectangles of a light palette, on which curves show, and its lines of equal height.
static void write_field(FILE *script, const moray_field *field)
{
    char x[32], y[32], z[32];
    fputs("$field << EOD\n", script);
    for (int i = 0; i < field->n_y; i++) {
        for (int k = 0; k < field->n_x; k++) {
            const double value = field->z[(size_t)i * (size_t)field->n_x + (size_t)k];
            fprintf(script, "%s %s %s\n", moray_number_text(field->x[k], x), moray_number_text(field->y[i], y),
                    isfinite(value) ? moray_number_text(value, z) : "NaN");
        }
        fputc('\n', script);
    }
    fputs("EOD\nset table $heights\nset contour base\nset cntrparam levels auto 10\nunset surface\n"
          "splot $field using 1:2:3\nunset table\nunset contour\nset surface\n"
          "set palette defined (0 '#ffffff', 1 '#cfe3f1', 2 '#86b9dc')\n",
          script);
    set_text(script, "cblabel", field->label);
    fprintf(script, "set xrange [%.17g:%.17g]\nset yrange [%.17g:%.17g]\n",
            field->x[0] - half_cell(field->x, field->n_x), field->x[field->n_x - 1] + half_cell(field->x, field->n_x),
            field->y[0] - half_cell(field->y, field->n_y), field->y[field->n_y - 1] + half_cell(field->y, field->n_y));
}

static void write_curve(FILE *script, const moray_curve *curve, int number)
{
    const int look = look_of(curve, number), every = curve->n > 15 ? curve->n / 15 : 1;
    const double width = curve->colour == MORAY_COLOUR_LIMIT ? 1.2 : 2;
    const char *dash = curve->dotted ? "(2,4)" : looks[look].dash;
    fprintf(script, "$curve%d using 1:2 ", number);
    switch (curve->style) {
    case MORAY_CURVE_LINE:
        fprintf(script, "with lines lw %g dt %s", width, dash);
        break;
    case MORAY_CURVE_MARKED:
        fprintf(script, "with linespoints lw %g ps 0.7 dt %s pt %d pi -%d", width, dash, looks[look].marker, every);
        break;
    case MORAY_CURVE_POINTS:
        fprintf(script, "with points ps 0.7 pt %d", looks[look].marker);
        break;
    case MORAY_CURVE_BODY:
        fputs("with lines lw 6", script);
        break;
    }
    fprintf(script, " lc rgb '%s' ", looks[look].colour);
    if (!curve->label) {
        fputs("notitle", script);
        return;
    }
    fputs("title ", script);
    quote(script, curve->label);
}

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

// The same scale on both axes, and a picture no flatter or slimmer than 4:1 around whatever is drawn.
static void write_equal_axes(FILE *script, const moray_figure *figure)
{
    double range[2][2];
    for (int axis = 0; axis < 2; axis++)
        range_along(figure, axis, range[axis]);
    const double width = range[0][1] - range[0][0], height = range[1][1] - range[1][0];
    fputs("set size ratio -1\n", script);
    if (!(isfinite(width) && isfinite(height)))
        return;
    for (int axis = 0; axis < 2; axis++) {
        const double middle = (range[axis][0] + range[axis][1]) / 2, own = axis ? height : width;
        const double half = fmax(0.53 * own, 0.125 * (axis ? width : height));
        if (half > 0)
            fprintf(script, "set %crange [%.17g:%.17g]\n", axis ? 'y' : 'x', middle - half, middle + half);
    }
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
    fprintf(script, "set %ctics (%g", name, first);
    for (double decade = first; decade <= range[1]; decade *= 10)
        for (size_t k = 0; k < sizeof steps / sizeof *steps; k++)
            fprintf(script, ", %g", steps[k] * decade);
    fputs(")\n", script);
}

enum { CANVAS = 720 }; // wide

// Where the axes stand, as shares of the canvas, when time is one of them; the key is below.
static const struct {
    double left, right, top;
} frame = {0.11, 0.97, 0.92};

static int height_of(const moray_figure *figure)
{
    const int usual = 4; // curves in the key
    return 458 + (figure->n_curves > usual ? 18 * (figure->n_curves - usual) : 0);
}

static double bottom_of(const moray_figure *figure)
{
    const double line = 18, axis = 88; // of the key; for the axis and its label
    return (axis + line * figure->n_curves) / height_of(figure);
}

// Whether the figure has an axis of time that the cursor of a scene can follow, and its ends.
static bool time_axis(const moray_figure *figure, double range[2])
{
    range_along(figure, 0, range);
    return figure->over_time && !figure->log_x && range[1] > range[0] && isfinite(range[1] - range[0]);
}

// Rows by name, the first one on top.
static void write_names(FILE *script, const moray_figure *figure)
{
    if (!figure->n_y_names)
        return;
    fputs("set ytics (", script);
    for (int i = 0; i < figure->n_y_names; i++) {
        fputs(i ? ", " : "", script);
        quote(script, figure->y_names[i]);
        fprintf(script, " %d", i);
    }
    fprintf(script, ")\nset yrange [%g:-0.5]\nset yzeroaxis lt 1 lw 1 lc rgb '#555555'\n", figure->n_y_names - 0.5);
}

static void write_time_axis(FILE *script, const moray_figure *figure)
{
    double range[2];
    if (!time_axis(figure, range))
        return;
    fprintf(script, "set xrange [%.17g:%.17g]\n", range[0], range[1]);
    fprintf(script,
            "set lmargin at screen %g\nset rmargin at screen %g\nset bmargin at screen %g\nset tmargin at screen %g\n",
            frame.left, frame.right, bottom_of(figure), frame.top);
}

static void write_script(FILE *script, const moray_figure *figure)
{
    const locale_t before = moray_c_locale_begin();
    fprintf(script, "set terminal svg noenhanced size %d,%d font 'Helvetica,13' background '#ffffff'\n", (int)CANVAS,
            height_of(figure));
    fputs("set grid lc rgb '#d0d0d0' lt 1 lw 0.5\nset border 3\nset tics nomirror\nset key outside below height 1\n"
          "set offsets graph 0, graph 0, graph 0.03, graph 0.03\n",
          script);
    if (figure->log_x)
        write_log_axis(script, figure, 0);
    if (figure->log_y)
        write_log_axis(script, figure, 1);
    if (figure->equal_axes)
        write_equal_axes(script, figure);
    write_time_axis(script, figure);
    write_names(script, figure);
    set_text(script, "title", figure->title);
    set_text(script, "xlabel", figure->x_label);
    set_text(script, "ylabel", figure->y_label);
    for (int i = 0; i < figure->n_curves; i++)
        write_data(script, &figure->curves[i], i);
    if (figure->field)
        write_field(script, figure->field);
    fputs("plot ", script);
    if (figure->field)
        fputs("$field using 1:2:3 with image pixels notitle, $heights using 1:2 with lines lw 0.7 lc rgb '#5a6b78' "
              "notitle, ",
              script);
    for (int i = 0; i < figure->n_curves; i++) {
        fputs(i ? ", " : "", script);
        write_curve(script, &figure->curves[i], i);
    }
    fputc('\n', script);
    moray_c_locale_end(before);
}

// An attribute's or an element's text.
static void write_escaped(FILE *picture, const char *text)
{
    for (; *text; text++)
        if (*text == '&' || *text == '<' || *text == '"')
            fprintf(picture, "&#%d;", *text);
        else
            fputc(*text, picture);
}

// Behind "<svg ": what a reader of the screen is told, and where time runs along the axis.
static void write_attributes(const moray_figure *figure, FILE *picture)
{
    double time[2];
    fputs("role=\"img\" aria-label=\"", picture);
    write_escaped(picture, figure->title ? figure->title : figure->name);
    fputs("\" ", picture);
    if (time_axis(figure, time))
        fprintf(picture, "data-time=\"%.9g %.9g %g %g %g %g\" ", time[0], time[1], frame.left * CANVAS,
                frame.right * CANVAS, (1 - frame.top) * height_of(figure), (1 - bottom_of(figure)) * height_of(figure));
}

// Gnuplot's picture with a title of ours in place of its own. Error: MORAY_IO where it is not whole.
static moray_status finish(const moray_figure *figure, FILE *raw, FILE *picture)
{
    char *line = NULL;
    size_t room = 0;
    bool begun = false, ended = false;
    rewind(raw);
    while (getline(&line, &room, raw) >= 0) {
        char *own = strstr(line, "<title>Gnuplot</title>");
        if (!begun && strncmp(line, "<svg ", 5) == 0) {
            begun = true;
            fputs("<svg ", picture);
            write_attributes(figure, picture);
            fputs(line + 5, picture);
        } else if (own) {
            fputs("<title>", picture);
            write_escaped(picture, figure->title ? figure->title : figure->name);
            fputs("</title>\n", picture);
        } else if (strncmp(line, "<desc>", 6) != 0) {
            fputs(line, picture);
        }
        ended = ended || strstr(line, "</svg>");
    }
    free(line);
    if (begun && ended)
        return moray_ok();
    return moray_error(MORAY_IO, "figure %s not drawn: gnuplot: the picture is not whole", figure->name);
}

moray_status moray_output_figure(moray_output *output, const moray_figure *figure)
{
    char name[200];
    FILE *picture, *script, *raw;
    snprintf(name, sizeof name, "%s.svg", figure->name);
    MORAY_TRY(moray_output_file(output, name, &picture));
    script = tmpfile();
    raw = tmpfile();
    moray_status status = moray_ok();
    if (script && raw) {
        write_script(script, figure);
        status = moray_gnuplot(figure->name, script, raw, moray_output_gnuplot_hangs(output));
    } else {
        status = moray_error(MORAY_IO, "figure %s not drawn: no temporary file", figure->name);
    }
    if (!moray_failed(status))
        status = finish(figure, raw, picture);
    if (script)
        fclose(script);
    if (raw)
        fclose(raw);
    if (moray_failed(status))
        moray_output_drop(output);
    return status;
}
