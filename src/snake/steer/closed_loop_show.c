// SPDX-License-Identifier: MIT
//
// Closed loops as figures and as a file.
#include <math.h>
#include <stdlib.h>

#include "moray/angle.h"
#include "moray/snake/closed_loop.h"

// ---- Over ground ---------------------------------------------------------------------------------------------------

enum { arrow_points = 5 };

// Extent of the curves along one axis.
static void extent(const moray_curve *curves, int n, bool y, double *low, double *high)
{
    *low = INFINITY;
    *high = -INFINITY;
    for (int c = 0; c < n; c++)
        for (int k = 0; k < curves[c].n; k++) {
            const double *values = y ? curves[c].y : curves[c].x;
            const double value = values[(size_t)k * (curves[c].stride ? curves[c].stride : 1)];
            *low = fmin(*low, value); // which passes over NaN
            *high = fmax(*high, value);
        }
}

// An arrow along the current beside the upper left of what is drawn, a tenth of it long.
static void make_arrow(const double current[2], const moray_curve *curves, int n, double x[arrow_points],
                       double y[arrow_points])
{
    double left, right, bottom, top;
    extent(curves, n, false, &left, &right);
    extent(curves, n, true, &bottom, &top);
    const double speed = hypot(current[0], current[1]), size = 0.1 * fmax(right - left, top - bottom);
    const double c = current[0] / speed, s = current[1] / speed;
    const double along[arrow_points] = {-0.5, 0.5, 0.2, 0.5, 0.2}, across[arrow_points] = {0, 0, 0.15, 0, -0.15};
    for (int k = 0; k < arrow_points; k++) {
        x[k] = left + size * (0.6 + along[k] * c - across[k] * s);
        y[k] = top + size * (0.6 + along[k] * s + across[k] * c);
    }
}

moray_status moray_swim_closed_loop_draw_path(moray_output *output, const moray_swim_closed_loop *closed_loops,
                                              const char *const *labels, const moray_colour *colours, int n,
                                              const double current[2], const moray_curve *path)
{
    const moray_swim_closed_loop *last = &closed_loops[n - 1];
    double *x, *y, arrow_x[arrow_points], arrow_y[arrow_points];
    int points, used = 0;
    char label[60];
    moray_curve *all = calloc((size_t)n + 3, sizeof *all);
    if (!all)
        return moray_error(MORAY_MEMORY, "no memory for a figure");
    moray_status status = moray_swim_outline(&last->track, last->swimmer, &x, &y, &points);
    if (moray_failed(status)) {
        free(all);
        return status;
    }
    if (path)
        all[used++] = *path;
    for (int k = 0; k < n; k++)
        all[used++] = (moray_curve){.label = labels[k],
                                    .x = &closed_loops[k].track.pose->p_x,
                                    .y = &closed_loops[k].track.pose->p_y,
                                    .n = closed_loops[k].track.n,
                                    .stride = sizeof(moray_pose) / sizeof(double),
                                    .colour = colours[k]};
    all[used++] = (moray_curve){.label = "the robot on the last of these",
                                .x = x,
                                .y = y,
                                .n = points,
                                .style = MORAY_CURVE_BODY,
                                .colour = colours[n - 1]};
    if (current[0] != 0 || current[1] != 0) {
        make_arrow(current, all, used, arrow_x, arrow_y);
        snprintf(label, sizeof label, "current, %.3g m/s", hypot(current[0], current[1]));
        all[used++] =
            (moray_curve){.label = label, .x = arrow_x, .y = arrow_y, .n = arrow_points, .colour = MORAY_COLOUR_WATER};
    }
    status = moray_output_figure(output, &(moray_figure){.name = "path",
                                                         .title = "Path over ground",
                                                         .x_label = "x [m]",
                                                         .y_label = "y [m]",
                                                         .equal_axes = true,
                                                         .curves = all,
                                                         .n_curves = used});
    free(x);
    free(all);
    return status;
}

// ---- One closed loop -----------------------------------------------------------------------------------------------

// Ten seconds either side of the largest offset: first sample and how many.
static int busiest(const moray_swim_closed_loop *closed_loop, int *first)
{
    const moray_swim_track *track = &closed_loop->track;
    const double around = 10;
    int most = 0, n = 0;
    for (int k = 0; k < track->n; k++)
        if (fabs(closed_loop->offset[k]) > fabs(closed_loop->offset[most]))
            most = k;
    for (*first = most; *first > 0 && track->t[*first] > track->t[most] - around;)
        --*first;
    while (*first + n < track->n && track->t[*first + n] <= track->t[most] + around)
        n++;
    return n;
}

moray_status moray_swim_closed_loop_draw_joints(moray_output *output, const moray_swim_closed_loop *closed_loop)
{
    enum { shown = 3 };
    const moray_swim_track *track = &closed_loop->track;
    const int joints = track->n_joints, joint[shown] = {0, (joints - 1) / 2, joints - 1};
    const char *const labels[] = {"joint at the tail", "in the middle", "at the head", "offset"};
    const bool control = moray_swimmer_model(closed_loop->swimmer) == MORAY_CONTROL_ORIENTED;
    const double unit = control ? 0.01 : MORAY_DEGREE;
    moray_curve curves[shown + 1];
    int first;
    const int n = busiest(closed_loop, &first);
    double *phi = malloc((size_t)(2 * joints + (shown + 1) * n) * sizeof *phi);
    if (!phi)
        return moray_error(MORAY_MEMORY, "no memory for a figure");
    double *values = phi + 2 * joints;
    for (int k = 0; k < n; k++) {
        moray_swimmer_joints(closed_loop->swimmer, track->x + (size_t)(first + k) * track->n_states, phi, phi + joints);
        for (int j = 0; j < shown; j++)
            values[j * n + k] = phi[joint[j]] / unit;
        values[shown * n + k] = closed_loop->offset[first + k] / unit;
    }
    for (int j = 0; j <= shown; j++)
        curves[j] = (moray_curve){.label = labels[j], .x = track->t + first, .y = values + j * n, .n = n};
    const moray_status status =
        moray_output_figure(output, &(moray_figure){.name = "joints",
                                                    .title = "Joint motion where the robot steers most",
                                                    .x_label = "time [s]",
                                                    .y_label = control ? "joint coordinate [cm]" : "joint angle [deg]",
                                                    .curves = curves,
                                                    .n_curves = shown + 1});
    free(phi);
    return status;
}

moray_status moray_swim_closed_loop_write(moray_output *output, const moray_swim_closed_loop *closed_loop)
{
    const moray_swim_track *track = &closed_loop->track;
    const int pose = sizeof *track->pose / sizeof(double);
    const bool control = moray_swimmer_model(closed_loop->swimmer) == MORAY_CONTROL_ORIENTED;
    const moray_column columns[] = {
        {"t", "s", track->t, 1},
        {"heading", "rad", &track->pose->heading, pose},
        {"p_x", "m", &track->pose->p_x, pose},
        {"p_y", "m", &track->pose->p_y, pose},
        {"v_x", "m/s", &track->pose->v_x, pose},
        {"v_y", "m/s", &track->pose->v_y, pose},
        {"phi_0", control ? "m" : "rad", closed_loop->offset, 1},
        {"energy", "J", track->energy, 1},
    };
    FILE *file;
    MORAY_TRY(moray_output_file(output, "trajectory.csv", &file));
    moray_csv_write(file, columns, sizeof columns / sizeof *columns, track->n);
    return moray_ok();
}
