// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "identify.h"

enum { SHOWN = 8 };
static const char *const labels[MORAY_CHANNELS] = {"p_x", "p_y", "heading", "joint torque"};

// Residuals of one kind over their standard deviations, one curve a log; of torques the middle joint.
static moray_status draw_kind(const identify *run, moray_output *output, moray_channel_kind kind, double *x)
{
    const moray_identify_fit *fit = &run->fit;
    const int middle = (run->snake.robot.links - 1) / 2;
    moray_curve curve[SHOWN];
    char name[40], title[100];
    int curves = 0;
    for (int c = 0, first = 0; c < fit->channels; first += fit->channel[c++].n) {
        const moray_channel_fit *channel = &fit->channel[c];
        if (channel->kind != kind || curves == SHOWN || (kind == MORAY_CHANNEL_TORQUE && channel->joint != middle))
            continue;
        double *t = x + 2 * first, *r = t + channel->n;
        for (int k = 0; k < channel->n; k++) {
            const moray_residual_point *p = &fit->point[first + k];
            const double off = p->observed - p->predicted;
            t[k] = p->t;
            r[k] = (kind == MORAY_CHANNEL_HEADING ? remainder(off, 2 * M_PI) : off) / p->sigma;
        }
        curve[curves++] = (moray_curve){
            .label = run->log[channel->run].name, .x = t, .y = r, .n = channel->n, .style = MORAY_CURVE_POINTS};
    }
    if (curves == 0)
        return moray_ok();
    snprintf(name, sizeof name, "residuals_%s", moray_channel_name(kind));
    snprintf(title, sizeof title, "Residuals of %s%s", labels[kind],
             kind == MORAY_CHANNEL_TORQUE ? " in the middle joint" : "");
    return moray_output_figure(output, &(moray_figure){.name = name,
                                                       .title = title,
                                                       .x_label = "time [s]",
                                                       .y_label = "observed less predicted, in standard deviations",
                                                       .curves = curve,
                                                       .n_curves = curves});
}

static moray_status draw_path(const identify *run, moray_output *output, double *x)
{
    const moray_identify_fit *fit = &run->fit;
    moray_curve curve[2];
    int n = 0, first[MORAY_CHANNELS] = {0};
    for (int c = 0, at = 0; c < fit->channels; at += fit->channel[c++].n)
        if (fit->channel[c].run == 0 && fit->channel[c].kind <= MORAY_CHANNEL_Y)
            first[fit->channel[c].kind] = at, n = fit->channel[c].n;
    for (int k = 0; k < n; k++) {
        const moray_residual_point *px = &fit->point[first[0] + k], *py = &fit->point[first[1] + k];
        if (px->row != py->row) // one of a pair is missing
            return moray_ok();
        x[4 * k] = px->observed, x[4 * k + 1] = py->observed;
        x[4 * k + 2] = px->predicted, x[4 * k + 3] = py->predicted;
    }
    if (n == 0 || fit->channels < 2)
        return moray_ok();
    curve[0] = (moray_curve){.label = "observed", .x = x, .y = x + 1, .n = n, .stride = 4, .style = MORAY_CURVE_POINTS};
    curve[1] = (moray_curve){.label = "predicted", .x = x + 2, .y = x + 3, .n = n, .stride = 4};
    return moray_output_figure(output, &(moray_figure){.name = "path",
                                                       .title = "Path of the first log",
                                                       .x_label = "x [m]",
                                                       .y_label = "y [m]",
                                                       .equal_axes = true,
                                                       .curves = curve,
                                                       .n_curves = 2});
}

moray_status identify_draw(const void *found, moray_output *output)
{
    const identify *run = found;
    double *x = calloc(4 * (size_t)run->fit.n + 1, sizeof *x);
    if (!x)
        return moray_error(MORAY_MEMORY, "no memory for the figures");
    moray_status status = draw_path(run, output, x);
    for (int kind = 0; kind < MORAY_CHANNELS && !moray_failed(status); kind++)
        status = draw_kind(run, output, (moray_channel_kind)kind, x);
    free(x);
    return status;
}
