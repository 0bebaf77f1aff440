// SPDX-License-Identifier: MIT
#include <stdlib.h>

#include "steer.h"

moray_status steer_draw_figure(const steer_job *job, const moray_figure *figure)
{
    return moray_app_drawn(&job->common, job->name, moray_output_figure(job->common.output, figure));
}

// The plan, its plainest rival, and what lies between them.
static moray_colour colour_of(const steer_trial *trial)
{
    static const moray_colour colours[] = {MORAY_COLOUR_BASELINE, MORAY_COLOUR_SECOND, MORAY_COLOUR_BEST};
    _Static_assert(sizeof colours / sizeof *colours == STEER_CURVES, "one of each");
    return colours[trial->law->curve - 1];
}

// ---- Over time -----------------------------------------------------------------------------------------------------

static moray_status draw_offsets(const steer_job *job, const moray_curve *curves, int n)
{
    return steer_draw_figure(job, &(moray_figure){.name = "offset",
                                                  .title = "Joint offset, first-principles model",
                                                  .x_label = "time [s]",
                                                  .over_time = true,
                                                  .y_label = "phi_0 [deg]",
                                                  .curves = curves,
                                                  .n_curves = n});
}

static moray_status draw_over_time(const steer_job *job, const steer_trial *const *trials,
                                   const moray_swim_closed_loop *closed_loops, int n)
{
    moray_curve values[STEER_CURVES + 1], offset[STEER_CURVES];
    moray_figure figure = job->program->over_time;
    int most = 0;
    for (int i = 0; i < n; i++)
        most = closed_loops[i].track.n > most ? closed_loops[i].track.n : most;
    double *data = malloc((size_t)(most * (2 * n + 1)) * sizeof *data);
    if (!data)
        return moray_error(MORAY_MEMORY, "no memory for figures");
    for (int i = 0; i < n; i++) {
        const moray_swim_track *track = &closed_loops[i].track;
        double *value = data + 2 * i * most, *phi = value + most;
        job->program->values(job, trials[i], track, value);
        for (int k = 0; k < track->n; k++)
            phi[k] = closed_loops[i].offset[k] / DEG;
        values[i] = (moray_curve){
            .label = trials[i]->name, .x = track->t, .y = value, .n = track->n, .colour = colour_of(trials[i])};
        offset[i] = values[i];
        offset[i].y = phi;
    }
    double *reference = data + 2 * n * most;
    const moray_swim_track *track = &closed_loops->track;
    values[n] =
        (moray_curve){.label = "reference", .x = track->t, .y = reference, .n = track->n, .colour = MORAY_COLOUR_LIMIT};
    figure.x_label = "time [s]";
    figure.over_time = true;
    figure.curves = values;
    figure.n_curves = n + job->program->values(job, NULL, track, reference);
    moray_status status = steer_draw_figure(job, &figure);
    if (!moray_failed(status))
        status = draw_offsets(job, offset, n);
    free(data);
    return status;
}

// ---- All -----------------------------------------------------------------------------------------------------------

static moray_status draw_path(const steer_job *job, const steer_trial *const *trials,
                              const moray_swim_closed_loop *closed_loops, int n)
{
    const char *labels[STEER_CURVES];
    moray_colour colours[STEER_CURVES];
    double x[STEER_POINTS], y[STEER_POINTS];
    const moray_curve path = {
        .label = "path asked for", .x = x, .y = y, .n = STEER_POINTS, .colour = MORAY_COLOUR_LIMIT};
    for (int k = 0; k < n; k++) {
        labels[k] = trials[k]->name;
        colours[k] = colour_of(trials[k]);
    }
    if (job->program->path)
        job->program->path(job, x, y);
    return moray_app_drawn(&job->common, job->name,
                           moray_swim_closed_loop_draw_path(job->common.output, closed_loops, labels, colours, n,
                                                            job->snake.current, job->program->path ? &path : NULL));
}

// All of them over ground, with what the last one does about it.
static moray_status make_scene(const steer_job *job, const steer_trial *const *trials,
                               const moray_swim_closed_loop *closed_loops, int n)
{
    double x[STEER_POINTS], y[STEER_POINTS];
    moray_status status = moray_ok();
    for (int k = n - 1; k >= 0 && !moray_failed(status); k--)
        status = moray_swim_scene_add(job->scene,
                                      &(moray_swim_look){.name = trials[k]->name,
                                                         .colour = colour_of(trials[k]),
                                                         .width = 2 * job->snake.geometry.a_e},
                                      &closed_loops[k].track, closed_loops[k].swimmer);
    if (!moray_failed(status) && job->program->path) {
        job->program->path(job, x, y);
        status = moray_swim_scene_ask(job->scene, x, y, STEER_POINTS);
    }
    return status;
}

// What the controller wants of the joints, beside what is measured and asked for.
static moray_status tell_scene(const steer_job *job, const steer_trial *trial, const moray_swim_closed_loop *last)
{
    const moray_swim_track *track = &last->track;
    double *values = malloc((size_t)track->n * sizeof *values);
    if (!values)
        return moray_error(MORAY_MEMORY, "no memory for the animation");
    for (int k = 0; k < track->n; k++)
        values[k] = last->offset[k] / (moray_swimmer_model(last->swimmer) == MORAY_CONTROL_ORIENTED ? 0.01 : DEG);
    moray_status status = moray_swim_scene_tell(
        job->scene, "joint offset wanted", moray_swimmer_model(last->swimmer) == MORAY_CONTROL_ORIENTED ? "cm" : "deg",
        track, values);
    for (int asked = 0; asked < 2 && !moray_failed(status); asked++)
        if (job->program->values(job, asked ? NULL : trial, track, values))
            status = moray_swim_scene_tell(job->scene, asked ? "reference" : job->program->over_time.y_label, "", track,
                                           values);
    free(values);
    return status;
}

static moray_status draw_shown(const steer_job *job, const steer_trial *const *trials,
                               const moray_swim_closed_loop *closed_loops, int n)
{
    const moray_swim_closed_loop *last = &closed_loops[n - 1];
    if (job->scene) {
        MORAY_TRY(make_scene(job, trials, closed_loops, n));
        MORAY_TRY(tell_scene(job, trials[n - 1], last));
    }
    MORAY_TRY(draw_over_time(job, trials, closed_loops, n));
    MORAY_TRY(draw_path(job, trials, closed_loops, n));
    MORAY_TRY(moray_app_drawn(&job->common, job->name, moray_swim_closed_loop_draw_joints(job->common.output, last)));
    MORAY_TRY(moray_swim_closed_loop_write(job->common.output, last));
    return job->program->draw ? job->program->draw(job) : moray_ok();
}

// Those that are drawn, of those that have run, in their order.
static int find_shown(const steer_job *job, const steer_trial **trials)
{
    int n = 0;
    for (int curve = 1; curve <= STEER_CURVES; curve++) {
        const steer_trial *shown = NULL;
        for (int k = 0; k < job->n_trials; k++)
            if (job->trial[k].law->curve == curve && job->trial[k].run)
                shown = &job->trial[k];
        if (shown)
            trials[n++] = shown;
    }
    return n;
}

moray_status steer_write(const void *found, moray_output *output)
{
    (void)output;
    const steer_job *job = found;
    const steer_trial *trials[STEER_CURVES] = {NULL};
    moray_swim_closed_loop closed_loops[STEER_CURVES] = {{0}};
    moray_status status = moray_ok();
    const int n = find_shown(job, trials);
    for (int k = 0; k < n && !moray_failed(status); k++)
        status = steer_swim(job, trials[k], &closed_loops[k]);
    if (!moray_failed(status) && n > 0)
        status = draw_shown(job, trials, closed_loops, n);
    for (int k = 0; k < n; k++)
        moray_swim_closed_loop_free(&closed_loops[k]);
    return status;
}
