// SPDX-License-Identifier: MIT
//
// Inside the application layer: what figures and the report need of the output and of tables.
#ifndef SRC_RESULTS_RESULTS_H
#define SRC_RESULTS_RESULTS_H

#include "moray/app/options.h"
#include "moray/app/results.h"

// What stands in column j: the row's text in the first where there is one, else the number.
const char *moray_table_cell(const moray_table_row *row, int j, char text[32]);

// Files started so far, in that order: the name of file i, or NULL beyond the last; and its stream.
const char *moray_output_name(const moray_output *output, int i);
FILE *moray_output_stream(const moray_output *output, int i);

// Takes back the file started last.
void moray_output_drop(moray_output *output);

// Takes back all that is not committed; whether a summary.json is.
void moray_output_discard(moray_output *output);
bool moray_output_summarised(const moray_output *output);

// Whether gnuplot had to be stopped: the pictures that follow do without it.
bool *moray_output_gnuplot_hangs(moray_output *output);

// Runs gnuplot from a script to a picture, both as open files, so that no path passes through it. Error: MORAY_IO
// naming the figure, with what gnuplot said, or that it did not end in time, which *hangs then tells.
moray_status moray_gnuplot(const char *name, FILE *script, FILE *picture, bool *hangs);

#endif
