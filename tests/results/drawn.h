// SPDX-License-Identifier: MIT
//
// A figure whose words try everything that gnuplot, a shell and HTML could mistake. Included once by a test.
#ifndef TESTS_RESULTS_DRAWN_H
#define TESTS_RESULTS_DRAWN_H

#include <math.h>

#include "moray/app/results.h"

static const double t[] = {0, 1, 2, 3}, x[] = {0, 1, NAN, 0.5}, y[] = {1, 2, 3, 4};
static const moray_curve curves[] = {
    {.label = "with 'quotes' '' \"and\" `ls`", .x = t, .y = x, .n = 4},
    {.label = "b_1^2", .x = t, .y = y, .n = 4, .style = MORAY_CURVE_MARKED},
    {.label = "c", .x = t, .y = y, .n = 2, .stride = 2, .style = MORAY_CURVE_POINTS},
};
static const moray_figure figure = {.name = "figure",
                                    .title = "T'\n!touch pwned\nsystem('touch pwned') <&>",
                                    .x_label = "time [s]",
                                    .y_label = "θ [deg]",
                                    .curves = curves,
                                    .n_curves = 3};

#endif
