// SPDX-License-Identifier: MIT
//
// Inside a figure: the parts of the script that gnuplot draws it by.
#ifndef SRC_RESULTS_FIGURE_H
#define SRC_RESULTS_FIGURE_H

#include "results/results.h"

// A text in gnuplot's single quotes; `set WHAT 'text'`.
void moray_figure_quote(FILE *script, const char *text);
void moray_figure_set_text(FILE *script, const char *what, const char *text);

// ---- Curves --------------------------------------------------------------------------------------------------------

// The points of each curve and the numbers of the field, as blocks of data; then the command that draws them.
void moray_figure_data(FILE *script, const moray_figure *figure);
void moray_figure_plot(FILE *script, const moray_figure *figure);
// How many curves have a line in the key.
int moray_figure_key_lines(const moray_figure *figure);

// ---- Axes ----------------------------------------------------------------------------------------------------------

// The canvas in units of its own, and how far from its sides the frame of the axes stands: left and right where time
// runs along. The key is below.
typedef struct moray_figure_layout {
    int width, height;
    double left, right, top, bottom;
} moray_figure_layout;
moray_figure_layout moray_figure_lay_out(const moray_figure *figure);

// Whether the figure has an axis of time that the cursor of a scene can follow, and its ends.
bool moray_figure_time(const moray_figure *figure, double range[2]);
// Terminal, title, ranges, scales, numbers and names of both axes.
void moray_figure_axes(FILE *script, const moray_figure *figure);

#endif
