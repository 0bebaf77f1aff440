// SPDX-License-Identifier: MIT
#include "sweep/figures.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_CURVES = 8, MOST_FIGURES = 12 };

// Which axes are drawn, -1: none; points between two values of each.
typedef struct cut {
    int across, curves;
    long step[MORAY_SWEEP_AXES], points; // points: of one draw
} cut;

static bool slice_of(const sweep_arguments *a, cut *s)
{
    *s = (cut){.across = -1, .curves = -1, .points = 1};
    for (int k = a->axes - 1; k >= 0; k--) {
        s->step[k] = s->points;
        s->points *= a->axis[k].n;
        if (!a->axis[k].value || a->axis[k].n < 2)
            continue;
        if (s->across < 0)
            s->across = k;
        else if (s->curves < 0)
            s->curves = k;
    }
    return s->across >= 0;
}

static long place_of(const sweep_arguments *a, const cut *s, long point, int k)
{
    return point / s->step[k] % a->axis[k].n;
}

static void add_setting(const sweep_arguments *a, int k, long place, char *text, size_t size)
{
    const moray_sweep_axis *axis = &a->axis[k];
    if (axis->value)
        moray_text_add(text, size, "%s%s %.4g", *text ? ", " : "", axis->key, axis->value[place]);
    else
        moray_text_add(text, size, "%s%s %s", *text ? ", " : "", axis->key, axis->word[place]);
}

static void file_name(const char *title, int number, char *name, size_t size)
{
    snprintf(name, size, "%.90s_%d", title, number);
    for (char *c = name; *c; c++)
        *c = isalnum((unsigned char)*c) ? *c : '_';
}

// Curves through `first` along `across`, one for each value of `curves`, -1: one.
static moray_status draw(const shown *s, const cut *slice, moray_output *output, const shown_column *column, long first,
                         int across, int curves, const char *at, int number)
{
    const sweep_arguments *a = s->a;
    const moray_sweep_axis *x = &a->axis[across];
    moray_curve curve[MOST_CURVES];
    char label[MOST_CURVES][80], name[120], title[300];
    const int all = curves < 0 ? 1 : a->axis[curves].n, n = all < MOST_CURVES ? all : MOST_CURVES;
    for (int k = 0; k < n; k++) {
        const long place = n > 1 ? (long)k * (all - 1) / (n - 1) : 0; // spread over its values
        label[k][0] = 0;
        if (curves >= 0)
            add_setting(a, curves, place, label[k], sizeof label[k]);
        curve[k] = (moray_curve){.label = label[k],
                                 .x = x->value,
                                 .y = column->value + first + (curves < 0 ? 0 : place * slice->step[curves]),
                                 .n = x->n,
                                 .style = MORAY_CURVE_MARKED};
    }
    double *y = calloc((size_t)(n * x->n), sizeof *y);
    if (!y)
        return moray_error(MORAY_MEMORY, "no memory for a figure");
    for (int k = 0; k < n; k++) {
        for (int i = 0; i < x->n; i++)
            y[k * x->n + i] = curve[k].y[i * slice->step[across]];
        curve[k].y = y + (size_t)k * (size_t)x->n;
    }
    file_name(column->title, number, name, sizeof name);
    snprintf(title, sizeof title, "%s%s%.150s", column->title, *at ? ", at " : "", at);
    const moray_status status = moray_output_figure(
        output,
        &(moray_figure){
            .name = name, .title = title, .x_label = x->key, .y_label = column->title, .curves = curve, .n_curves = n});
    free(y);
    return status;
}

// Of all points those that stand at the first value of what is drawn.
static bool is_first(const sweep_arguments *a, const cut *s, long point)
{
    return place_of(a, s, point, s->across) == 0 && (s->curves < 0 || place_of(a, s, point, s->curves) == 0);
}

static moray_status draw_planes(const shown *s, const cut *slice, moray_output *output, const shown_column *column,
                                int *number)
{
    for (long point = 0; point < slice->points && *number < MOST_FIGURES; point++) {
        char at[200] = "";
        if (!is_first(s->a, slice, point))
            continue;
        for (int k = 0; k < s->a->axes; k++)
            if (k != slice->across && k != slice->curves && s->a->axis[k].n > 1)
                add_setting(s->a, k, place_of(s->a, slice, point, k), at, sizeof at);
        MORAY_TRY(draw(s, slice, output, column, point, slice->across, slice->curves, at, ++*number));
    }
    return moray_ok();
}

static moray_status draw_lines(const shown *s, const cut *slice, moray_output *output, const shown_column *column,
                               int *number)
{
    for (int across = 0; across < s->a->axes; across++) {
        char at[200] = "";
        long point = 0;
        if (across == slice->across || !s->a->axis[across].value || s->a->axis[across].n < 2)
            continue;
        for (int k = 0; k < s->a->axes; k++) {
            const long middle = (s->a->axis[k].n - 1) / 2;
            if (k == across)
                continue;
            point += middle * slice->step[k];
            if (s->a->axis[k].n > 1)
                add_setting(s->a, k, middle, at, sizeof at);
        }
        MORAY_TRY(draw(s, slice, output, column, point, across, -1, at, ++*number));
    }
    return moray_ok();
}

moray_status sweep_draw(const shown *s, moray_output *output)
{
    cut slice;
    if (!slice_of(s->a, &slice))
        return moray_ok();
    for (int k = 0; k < s->n; k++) {
        int number = 0;
        MORAY_TRY(draw_planes(s, &slice, output, &s->column[k], &number));
        MORAY_TRY(draw_lines(s, &slice, output, &s->column[k], &number));
    }
    return moray_ok();
}
