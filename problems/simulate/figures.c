// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdlib.h>

#include "simulate.h"

// ---- Path ----------------------------------------------------------------------------------------------------------

static moray_status draw_path(const simulate_results *results, moray_output *output)
{
    const moray_swim_track *track = &results->track;
    double *x, *y;
    int n;
    MORAY_TRY(moray_swim_outline(track, results->swimmer, &x, &y, &n));
    const moray_curve curves[] = {
        {.label = "robot, at equal intervals of time", .x = x, .y = y, .n = n, .style = MORAY_CURVE_BODY},
        {.label = "centre of mass",
         .x = &track->pose->p_x,
         .y = &track->pose->p_y,
         .n = track->n,
         .stride = sizeof *track->pose / sizeof(double)}};
    const moray_status status = moray_output_figure(output, &(moray_figure){.name = "path",
                                                                            .title = "Path of the robot",
                                                                            .x_label = "x [m]",
                                                                            .y_label = "y [m]",
                                                                            .equal_axes = true,
                                                                            .curves = curves,
                                                                            .n_curves = 2});
    free(x);
    return status;
}

// ---- Over time -----------------------------------------------------------------------------------------------------

static moray_status draw_over_time(moray_output *output, const char *name, const char *title, const char *y_label,
                                   const moray_curve *curves, int n)
{
    return moray_output_figure(output, &(moray_figure){.name = name,
                                                       .title = title,
                                                       .x_label = "time [s]",
                                                       .y_label = y_label,
                                                       .over_time = true,
                                                       .curves = curves,
                                                       .n_curves = n});
}

static moray_status draw_velocity(moray_output *output, const double *t, const double *v_x, const double *v_y, int n)
{
    const moray_curve curves[] = {{.label = "v_x", .x = t, .y = v_x, .n = n},
                                  {.label = "v_y", .x = t, .y = v_y, .n = n}};
    return draw_over_time(output, "velocity", "Velocity over ground of the centre of mass", "velocity [m/s]", curves,
                          2);
}

static moray_status draw_heading(const simulate_results *results, moray_output *output, const double *t,
                                 const double *heading, int n)
{
    const bool control = results->run->snake.model == MORAY_CONTROL_ORIENTED;
    const moray_curve curve = {.label = control ? "theta" : "mean link angle", .x = t, .y = heading, .n = n};
    return draw_over_time(output, "heading", "Heading", "heading [deg]", &curve, 1);
}

// Of the joints at the tail, in the middle and at the head: more curves than that nobody reads.
static moray_status draw_efforts(const simulate_results *results, moray_output *output, const double *t, double *u)
{
    const moray_swim_track *track = &results->track;
    const bool control = results->run->snake.model == MORAY_CONTROL_ORIENTED;
    const int joint[] = {0, (track->n_joints - 1) / 2, track->n_joints - 1}, shown = track->n_joints < 3 ? 1 : 3;
    int from = 0;
    char label[3][32], title[80];
    moray_curve curves[3];
    while (from < track->n - 2 && track->t[from] < results->window.from)
        from++;
    const int n = track->n - from;
    for (int j = 0; j < shown; j++) {
        for (int k = 0; k < n; k++)
            u[j * n + k] = track->u[(size_t)(from + k) * track->n_joints + joint[j]];
        snprintf(label[j], sizeof label[j], "joint %d%s", joint[j] + 1, j == 0 ? " (tail)" : j == 2 ? " (head)" : "");
        curves[j] = (moray_curve){.label = label[j], .x = t + from, .y = u + j * n, .n = n};
    }
    snprintf(title, sizeof title, "Joint %s, %.4g s to %.4g s", control ? "forces" : "torques", results->window.from,
             results->window.to);
    return draw_over_time(output, "effort", title, control ? "joint force [N]" : "joint torque [N m]", curves, shown);
}

moray_status simulate_figures(const void *found, moray_output *output)
{
    const simulate_results *results = found;
    const moray_swim_track *track = &results->track;
    const int n = track->n;
    double *v_x = malloc(3 * (size_t)n * sizeof *v_x);
    if (!v_x)
        return moray_error(MORAY_MEMORY, "no memory for the figures");
    double *v_y = v_x + n, *heading = v_y + n;
    for (int k = 0; k < n; k++) {
        v_x[k] = track->pose[k].v_x;
        v_y[k] = track->pose[k].v_y;
        heading[k] = track->pose[k].heading / DEG;
    }
    moray_status status = draw_path(results, output);
    if (!moray_failed(status))
        status = draw_velocity(output, track->t, v_x, v_y, n);
    if (!moray_failed(status))
        status = draw_heading(results, output, track->t, heading, n);
    if (!moray_failed(status))
        status = draw_efforts(results, output, track->t, v_x); // whose turn is over
    free(v_x);
    return status;
}
