// SPDX-License-Identifier: MIT
//
// Figures of a gait job: the proof, one period of the recommended gait, all gaits on the ladder, the solve.
#include <math.h>
#include <stdlib.h>

#include "figures.h"

moray_colour gait_job_colour(const gait_job *job, const stage *at)
{
    if (at == &job->ladder)
        return MORAY_COLOUR_BEST;
    return at->model == MORAY_CONTROL_ORIENTED ? MORAY_COLOUR_THIRD : MORAY_COLOUR_SECOND;
}

moray_status gait_period_draw(const gait_period *period, moray_figure figure, const moray_curve *curves, int n)
{
    char title[120];
    snprintf(title, sizeof title, "%s: %s", period->what, figure.title);
    figure.title = title;
    figure.curves = curves;
    figure.n_curves = n;
    return moray_output_figure(period->output, &figure);
}

// Speed along the course from rest, every gait on both models: what the reader wants to see of the proof.
static moray_status draw_start(const gait_job *job, moray_output *output)
{
    enum { points = 301, most = 2 * (1 + GAIT_STAGES) };
    const double horizon = 15;
    const stage *at[GAIT_STAGES];
    const int gaits = 1 + gait_job_stages(job, at);
    char labels[most][80], baseline[64];
    double *data = calloc((most + 1) * points, sizeof *data), *time = data ? data + most * points : NULL;
    moray_curve curves[most];
    moray_status status = data ? moray_ok() : moray_error(MORAY_MEMORY, "no memory for a figure");
    int n = 0;
    for (int model = 1; model >= 0; model--)
        for (int k = 0; k < gaits && !moray_failed(status); k++) {
            const moray_gait_trial *trial = k ? &at[k - 1]->trial : &job->paper;
            double *speed = data + n * points;
            if (isnan(trial->steady[model].speed))
                continue;
            status = moray_gait_trial_speeds(&job->rig, trial, (moray_model)model, horizon, points, time, speed);
            snprintf(labels[n], sizeof *labels, "%s, %s model",
                     k ? gait_job_kind(job, at[k - 1]) : gait_job_baseline(job, baseline),
                     moray_model_name((moray_model)model));
            curves[n] = (moray_curve){.label = labels[n],
                                      .x = time,
                                      .y = speed,
                                      .n = points,
                                      .colour = k ? gait_job_colour(job, at[k - 1]) : MORAY_COLOUR_BASELINE,
                                      .dotted = model == MORAY_CONTROL_ORIENTED};
            n++;
        }
    if (!moray_failed(status))
        status = moray_output_figure(
            output, &(moray_figure){.name = "start",
                                    .title = "From rest: speed along the course, mean over the last period",
                                    .x_label = "time [s]",
                                    .y_label = "speed along the course [m/s]",
                                    .over_time = true,
                                    .curves = curves,
                                    .n_curves = n});
    free(data);
    return status;
}

// Gains in speed at equal power, a row a model, a mark a gait.
static moray_status draw_ladder(const gait_job *job, moray_output *output)
{
    const stage *at[GAIT_STAGES];
    const int n = gait_job_stages(job, at);
    const moray_ladder_row *ladders[GAIT_STAGES];
    const char *names[GAIT_STAGES];
    moray_colour colours[GAIT_STAGES];
    for (int k = 0; k < n; k++) {
        ladders[k] = at[k]->ladder;
        names[k] = gait_job_kind(job, at[k]);
        colours[k] = gait_job_colour(job, at[k]);
    }
    return moray_ladder_draw(output, ladders, names, colours, n);
}

static moray_status draw_period(gait_period *v)
{
    const int N = v->joints;
    double *phi = malloc((size_t)(GAIT_POINTS * 2 * N) * sizeof *phi);
    if (!phi)
        return moray_error(MORAY_MEMORY, "no memory for figures");
    v->phi = phi;
    v->rate = phi + GAIT_POINTS * N;
    for (int k = 0; k < GAIT_POINTS; k++)
        moray_swimmer_joints(v->swimmer, v->track->x + (size_t)k * (size_t)v->track->n_states, v->phi + k * N,
                             v->rate + k * N);
    moray_status status = gait_period_draw_body(v);
    if (!moray_failed(status))
        status = gait_period_draw_time(v);
    free(phi);
    return status;
}

moray_status gait_job_draw_gait(const gait_job *job, const char *what, const moray_gait_trial *trial,
                                moray_output *output)
{
    const moray_model model = job->snake.model;
    const moray_swim_setup setup = moray_test_rig_setup(&job->rig, model);
    moray_steady steady;
    moray_swim_track track = {0};
    if (isnan(trial->steady[model].speed))
        return moray_ok();
    moray_status status = moray_swim_steady(&setup, &trial->gait[model], trial->steady[model].start_heading, &steady,
                                            &track, GAIT_POINTS);
    if (!moray_failed(status))
        status = draw_period(&(gait_period){.job = job,
                                            .output = output,
                                            .what = what,
                                            .gait = &trial->gait[model],
                                            .track = &track,
                                            .swimmer = job->rig.swimmer[model],
                                            .joints = job->snake.robot.links - 1,
                                            .control = model == MORAY_CONTROL_ORIENTED});
    moray_swim_track_free(&track);
    return status.code == MORAY_MEMORY || status.code == MORAY_IO ? status
                                                                  : moray_ok(); // what never settles is not drawn
}

moray_status gait_job_draw(const void *found, moray_output *output)
{
    const gait_job *job = found;
    MORAY_TRY(draw_start(job, output));
    MORAY_TRY(draw_ladder(job, output));
    MORAY_TRY(gait_job_draw_gait(job, "The recommended gait", &recommended(job)->trial, output));
    return moray_solution_draw(recommended(job)->solution, GAIT_MESH_TOLERANCE, "s", output);
}
