// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdlib.h>

#include "moray/snake/swim.h"

static double path_length(const moray_swim_track *track)
{
    double length = 0;
    for (int k = 1; k < track->n; k++)
        length += hypot(track->pose[k].p_x - track->pose[k - 1].p_x, track->pose[k].p_y - track->pose[k - 1].p_y);
    return length;
}

// As many robots as fit on the path with room between them.
static int count_robots(const moray_swim_track *track, const moray_robot *robot)
{
    const double fit = path_length(track) / (1.5 * 2 * robot->l * robot->links);
    return fit < 2 ? 2 : fit > 12 ? 12 : (int)fit;
}

// The links of sample k as strokes, each interrupted by a NaN: the prismatic joints leave gaps between them.
static void trace_links(const moray_swimmer *swimmer, const double *state, double *scratch, double *x, double *y)
{
    const int N = moray_swimmer_robot(swimmer)->links;
    double *x_i = scratch, *y_i = scratch + N, *angle = scratch + 2 * N;
    moray_swimmer_links(swimmer, state, x_i, y_i, angle);
    for (int i = 0; i < N; i++)
        for (int point = 0; point < 3; point++) {
            const double l = moray_swimmer_half_length(swimmer, i), along = point == 0 ? -l : point == 1 ? l : NAN;
            x[3 * i + point] = x_i[i] + along * cos(angle[i]);
            y[3 * i + point] = y_i[i] + along * sin(angle[i]);
        }
}

moray_status moray_swim_outline(const moray_swim_track *track, const moray_swimmer *swimmer, double **x, double **y,
                                int *n)
{
    const moray_robot *robot = moray_swimmer_robot(swimmer);
    const int N = robot->links, robots = count_robots(track, robot);
    *n = 3 * N * robots;
    *x = malloc((size_t)(2 * *n + 3 * N) * sizeof **x);
    if (!*x)
        return moray_error(MORAY_MEMORY, "no memory for the outlines of %d robots", robots);
    *y = *x + *n;
    for (int i = 0; i < robots; i++) {
        const int k = (int)((double)(track->n - 1) * i / (robots - 1));
        trace_links(swimmer, track->x + (size_t)k * track->n_states, *y + *n, *x + 3 * N * i, *y + 3 * N * i);
    }
    return moray_ok();
}
