// SPDX-License-Identifier: MIT
#include <stdlib.h>

#include "steer.h"

enum { arrow_points = 5 };

moray_status steer_draw_figure(const steer_job *job, const moray_figure *figure)
{
    const moray_status status = moray_output_figure(job->common.output, figure);
    if (status.code != MORAY_IO)
        return status;
    if (!job->common.quiet)
        fprintf(stderr, "%s: %s\n", job->name, status.text);
    return moray_ok();
}

// ---- Over time -----------------------------------------------------------------------------------------------------

static moray_status draw_offsets(const steer_job *job, const moray_curve *curves)
{
    return steer_draw_figure(job, &(moray_figure){.name = "offset",
                                                  .title = "Joint offset, first-principles model",
                                                  .x_label = "time [s]",
                                                  .y_label = "phi_0 [deg]",
                                                  .curves = curves,
                                                  .n_curves = STEER_CURVES});
}

static moray_status draw_over_time(const steer_job *job, const steer_trial *const *trials,
                                   const moray_closed_loop *closed_loops)
{
    moray_curve values[STEER_CURVES + 1], offset[STEER_CURVES];
    moray_figure figure = job->program->over_time;
    int most = 0;
    for (int i = 0; i < STEER_CURVES; i++)
        most = closed_loops[i].track.n > most ? closed_loops[i].track.n : most;
    double *data = malloc((size_t)(most * (2 * STEER_CURVES + 1)) * sizeof *data);
    if (!data)
        return moray_error(MORAY_MEMORY, "no memory for figures");
    for (int i = 0; i < STEER_CURVES; i++) {
        const moray_swim_track *track = &closed_loops[i].track;
        double *value = data + 2 * i * most, *phi = value + most;
        job->program->values(job, trials[i], track, value);
        for (int k = 0; k < track->n; k++)
            phi[k] = closed_loops[i].offset[k] / DEG;
        values[i] = (moray_curve){.label = trials[i]->name, .x = track->t, .y = value, .n = track->n};
        offset[i] = (moray_curve){.label = trials[i]->name, .x = track->t, .y = phi, .n = track->n};
    }
    double *reference = data + 2 * STEER_CURVES * most;
    const moray_swim_track *track = &closed_loops->track;
    values[STEER_CURVES] = (moray_curve){.label = "reference", .x = track->t, .y = reference, .n = track->n};
    figure.x_label = "time [s]";
    figure.curves = values;
    figure.n_curves = STEER_CURVES + job->program->values(job, NULL, track, reference);
    moray_status status = steer_draw_figure(job, &figure);
    if (!moray_failed(status))
        status = draw_offsets(job, offset);
    free(data);
    return status;
}

// ---- Over ground ---------------------------------------------------------------------------------------------------

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

// path.svg: the paths of the closed loops, the robot along the last, the current as an arrow.
static moray_status draw_path(const steer_job *job, const steer_trial *const *trials,
                              const moray_closed_loop *closed_loops)
{
    const moray_closed_loop *last = &closed_loops[STEER_CURVES - 1];
    const double *V = job->common.current;
    moray_curve all[STEER_CURVES + 3];
    double *x, *y, arrow_x[arrow_points], arrow_y[arrow_points], path_x[STEER_POINTS], path_y[STEER_POINTS];
    int points, used = 0;
    char label[60];
    MORAY_TRY(moray_swim_outline(&last->track, last->swimmer, &x, &y, &points));
    if (job->program->path) {
        job->program->path(job, path_x, path_y);
        all[used++] = (moray_curve){.label = "path", .x = path_x, .y = path_y, .n = STEER_POINTS};
    }
    for (int k = 0; k < STEER_CURVES; k++)
        all[used++] = (moray_curve){.label = trials[k]->name,
                                    .x = &closed_loops[k].track.pose->p_x,
                                    .y = &closed_loops[k].track.pose->p_y,
                                    .n = closed_loops[k].track.n,
                                    .stride = sizeof(moray_pose) / sizeof(double)};
    all[used++] = (moray_curve){.label = "the robot on the last of these", .x = x, .y = y, .n = points};
    if (V[0] != 0 || V[1] != 0) {
        make_arrow(V, all, used, arrow_x, arrow_y);
        snprintf(label, sizeof label, "current, %.3g m/s", hypot(V[0], V[1]));
        all[used++] = (moray_curve){.label = label, .x = arrow_x, .y = arrow_y, .n = arrow_points};
    }
    const moray_status status = steer_draw_figure(job, &(moray_figure){.name = "path",
                                                                       .title = "Path over ground",
                                                                       .x_label = "x [m]",
                                                                       .y_label = "y [m]",
                                                                       .equal_axes = true,
                                                                       .curves = all,
                                                                       .n_curves = used});
    free(x);
    return status;
}

// ---- One closed loop -----------------------------------------------------------------------------------------------

// Ten seconds either side of the largest offset: first sample and how many.
static int busiest(const moray_closed_loop *closed_loop, int *first)
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

// joints.svg: joints at the tail, in the middle and at the head while the robot steers most.
static moray_status draw_joints(const steer_job *job, const moray_closed_loop *closed_loop)
{
    enum { shown = 3 };
    const moray_swim_track *track = &closed_loop->track;
    const int joints = track->n_joints, joint[shown] = {0, (joints - 1) / 2, joints - 1};
    const char *const labels[] = {"joint at the tail", "in the middle", "at the head", "offset"};
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
            values[j * n + k] = phi[joint[j]] / DEG;
        values[shown * n + k] = closed_loop->offset[first + k] / DEG;
    }
    for (int j = 0; j <= shown; j++)
        curves[j] = (moray_curve){.label = labels[j], .x = track->t + first, .y = values + j * n, .n = n};
    const moray_status status =
        steer_draw_figure(job, &(moray_figure){.name = "joints",
                                               .title = "Joint motion where the robot steers most",
                                               .x_label = "time [s]",
                                               .y_label = "joint angle [deg]",
                                               .curves = curves,
                                               .n_curves = shown + 1});
    free(phi);
    return status;
}

static moray_status write_trajectory(const steer_job *job, const moray_closed_loop *closed_loop)
{
    const moray_swim_track *track = &closed_loop->track;
    const int pose = sizeof *track->pose / sizeof(double);
    const moray_column columns[] = {
        {"t", "s", track->t, 1},
        {"heading", "rad", &track->pose->heading, pose},
        {"p_x", "m", &track->pose->p_x, pose},
        {"p_y", "m", &track->pose->p_y, pose},
        {"v_x", "m/s", &track->pose->v_x, pose},
        {"v_y", "m/s", &track->pose->v_y, pose},
        {"phi_0", "rad", closed_loop->offset, 1},
        {"energy", "J", track->energy, 1},
    };
    FILE *file;
    MORAY_TRY(moray_output_file(job->common.output, "trajectory.csv", &file));
    moray_csv_write(file, columns, sizeof columns / sizeof *columns, track->n);
    return moray_ok();
}

// ---- All -----------------------------------------------------------------------------------------------------------

static moray_status draw_shown(const steer_job *job, const steer_trial *const *trials,
                               const moray_closed_loop *closed_loops)
{
    MORAY_TRY(draw_over_time(job, trials, closed_loops));
    MORAY_TRY(draw_path(job, trials, closed_loops));
    MORAY_TRY(draw_joints(job, &closed_loops[STEER_CURVES - 1]));
    MORAY_TRY(write_trajectory(job, &closed_loops[STEER_CURVES - 1]));
    return job->program->draw ? job->program->draw(job) : moray_ok();
}

moray_status steer_draw(const steer_job *job)
{
    const steer_trial *trials[STEER_CURVES] = {NULL};
    moray_closed_loop closed_loops[STEER_CURVES] = {{0}};
    moray_status status = moray_ok();
    for (int k = 0; k < job->n_trials; k++)
        if (job->trial[k].law->curve > 0)
            trials[job->trial[k].law->curve - 1] = &job->trial[k];
    for (int k = 0; k < STEER_CURVES && !moray_failed(status); k++)
        status = steer_swim(job, trials[k], &closed_loops[k]);
    if (!moray_failed(status))
        status = draw_shown(job, trials, closed_loops);
    for (int k = 0; k < STEER_CURVES; k++)
        moray_closed_loop_free(&closed_loops[k]);
    return status;
}
