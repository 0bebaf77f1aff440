// SPDX-License-Identifier: MIT
#include "results/figure.h"

#include <math.h>

#include "base/number.h"

// After Okabe and Ito's palette, its last three darker: each has a contrast of 3 on white; dashes differ as well.
static const struct {
    const char *colour, *dash;
    int marker;
} looks[] = {
    {"#0072B2", "solid", 7},       {"#D55E00", "(14,6)", 5}, {"#009E73", "(3,5)", 9},
    {"#000000", "(14,5,3,5)", 6},  {"#B0578A", "(7,4)", 4},  {"#A87000", "(14,4,3,4,3,4)", 8},
    {"#3D8FC6", "(20,4,7,4)", 11}, {"#5A6B78", "solid", 1},
};
enum { LIMIT_LOOK = 3, N_LOOKS = 7, WATER_LOOK = N_LOOKS }; // by number: all but that of water

static int look_of(const moray_curve *curve, int number)
{
    static const int named[] = {
        [MORAY_COLOUR_BEST] = 0,  [MORAY_COLOUR_BASELINE] = 1,       [MORAY_COLOUR_SECOND] = 2,
        [MORAY_COLOUR_THIRD] = 4, [MORAY_COLOUR_LIMIT] = LIMIT_LOOK, [MORAY_COLOUR_WATER] = WATER_LOOK};
    return curve->colour == MORAY_COLOUR_BY_NUMBER ? number % N_LOOKS : named[curve->colour];
}

int moray_figure_key_lines(const moray_figure *figure)
{
    int lines = 0;
    for (int i = 0; i < figure->n_curves; i++)
        lines += figure->curves[i].label != NULL;
    return lines;
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
    moray_figure_set_text(script, "cblabel", field->label);
    fprintf(script, "set xrange [%.17g:%.17g]\nset yrange [%.17g:%.17g]\n",
            field->x[0] - half_cell(field->x, field->n_x), field->x[field->n_x - 1] + half_cell(field->x, field->n_x),
            field->y[0] - half_cell(field->y, field->n_y), field->y[field->n_y - 1] + half_cell(field->y, field->n_y));
}

void moray_figure_data(FILE *script, const moray_figure *figure)
{
    for (int i = 0; i < figure->n_curves; i++)
        write_data(script, &figure->curves[i], i);
    if (figure->field)
        write_field(script, figure->field);
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
        fprintf(script, "with points ps 0.8 lw 1.5 pt %d", looks[look].marker);
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
    moray_figure_quote(script, curve->label);
}

void moray_figure_plot(FILE *script, const moray_figure *figure)
{
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
}
