// SPDX-License-Identifier: MIT
#include <stdlib.h>

#include "job.h"

enum { shown = 3 };

// The tuned feedback, the same ahead of its time, the last plan.
static void choose_shown(heading_job *job, heading_trial **trials)
{
    for (int k = 0; k < job->n_trials; k++)
        if (job->trial[k].law == HEADING_FEEDBACK)
            trials[job->trial[k].preview ? 1 : 0] = &job->trial[k];
        else if (job->trial[k].law == HEADING_PLAN)
            trials[2] = &job->trial[k];
}

static moray_status draw_over_time(const heading_job *job, heading_trial *const *trials,
                                   const moray_closed_loop *closed_loops)
{
    const int n = closed_loops->track.n;
    const double *t = closed_loops->track.t;
    double *data = malloc((size_t)(n * (2 * shown + 1)) * sizeof *data), *reference = data + 2 * shown * n, rate;
    moray_curve heading[shown + 1], offset[shown];
    if (!data)
        return moray_error(MORAY_MEMORY, "no memory for figures");
    for (int k = 0; k < n; k++)
        reference[k] = moray_reference_at(&job->reference, t[k], &rate) / DEG;
    heading[shown] = (moray_curve){.label = "reference", .x = t, .y = reference, .n = n};
    for (int i = 0; i < shown; i++) {
        const moray_straight_motion *straight = &job->straight[trials[i]->gait][1];
        double *angle = data + 2 * i * n, *phi = angle + n;
        for (int k = 0; k < n; k++) {
            angle[k] = moray_straight_motion_heading(straight, t[k], closed_loops[i].track.pose[k].heading) / DEG;
            phi[k] = closed_loops[i].offset[k] / DEG;
        }
        heading[i] = (moray_curve){.label = trials[i]->name, .x = t, .y = angle, .n = n};
        offset[i] = (moray_curve){.label = trials[i]->name, .x = t, .y = phi, .n = n};
    }
    moray_status status = steer_draw(job->common.output, job->common.quiet, "heading_tracking",
                                     &(moray_figure){.name = "heading",
                                                     .title = "Heading without its undulation, first-principles model",
                                                     .x_label = "time [s]",
                                                     .y_label = "heading [deg]",
                                                     .curves = heading,
                                                     .n_curves = 1 + shown});
    if (!moray_failed(status))
        status = steer_draw(job->common.output, job->common.quiet, "heading_tracking",
                            &(moray_figure){.name = "offset",
                                            .title = "Joint offset, first-principles model",
                                            .x_label = "time [s]",
                                            .y_label = "phi_0 [deg]",
                                            .curves = offset,
                                            .n_curves = shown});
    free(data);
    return status;
}

// The offsets found in place of the paper's, as the first-principles model would take them.
static moray_status draw_manoeuvre(const heading_job *job)
{
    enum { points = 1900 };
    static const char *const labels[] = {"found on the control-oriented model", "found on the first-principles model"};
    double *t = malloc(4 * points * sizeof *t), *paper = t + points;
    moray_curve curves[3] = {{.label = "of Sec. V-C", .x = t, .y = paper, .n = points}};
    int n = 1;
    if (!t)
        return moray_error(MORAY_MEMORY, "no memory for figures");
    for (int k = 0; k < points; k++) {
        t[k] = job->horizon * k / (points - 1);
        paper[k] = heading_fig8_offset(job, MORAY_FIRST_PRINCIPLES, t[k]) / DEG;
    }
    for (int model = 0; model <= (int)job->common.model; model++) {
        double *found = paper + n * points;
        const moray_straight_motion *straight = job->straight[1 + model];
        const double scale =
            model == MORAY_FIRST_PRINCIPLES ? 1 : -straight[1].gait.amplitude / straight[0].gait.amplitude;
        for (int k = 0; k < points; k++)
            found[k] = scale * moray_steering_offset(job->plan[model].solution, t[k]).value / DEG;
        curves[n++] = (moray_curve){.label = labels[model], .x = t, .y = found, .n = points};
    }
    const moray_status status = steer_draw(job->common.output, job->common.quiet, "heading_tracking",
                                           &(moray_figure){.name = "manoeuvre",
                                                           .title = "Joint offset of Fig. 8, and found for its heading",
                                                           .x_label = "time [s]",
                                                           .y_label = "phi_0 of the first-principles model [deg]",
                                                           .curves = curves,
                                                           .n_curves = n});
    free(t);
    return status;
}

static moray_status draw_shown(heading_job *job, heading_trial *const *trials, const moray_closed_loop *closed_loops)
{
    const steer_curve paths[shown] = {
        {trials[0]->name, &closed_loops[0]}, {trials[1]->name, &closed_loops[1]}, {trials[2]->name, &closed_loops[2]}};
    MORAY_TRY(draw_over_time(job, trials, closed_loops));
    MORAY_TRY(steer_draw_path(&job->common, "heading_tracking", paths, shown, NULL, 0));
    MORAY_TRY(steer_draw_joints(&job->common, "heading_tracking", &closed_loops[shown - 1]));
    return steer_write_trajectory(&job->common, &closed_loops[shown - 1]);
}

moray_status heading_draw(heading_job *job)
{
    heading_trial *trials[shown];
    moray_closed_loop closed_loops[shown] = {{0}};
    moray_status status = moray_ok();
    choose_shown(job, trials);
    for (int k = 0; k < shown && !moray_failed(status); k++)
        status = heading_swim(job, trials[k], MORAY_FIRST_PRINCIPLES, &closed_loops[k]);
    if (!moray_failed(status))
        status = draw_shown(job, trials, closed_loops);
    for (int k = 0; k < shown; k++)
        moray_closed_loop_free(&closed_loops[k]);
    if (!moray_failed(status) && heading_is_fig8(job))
        status = draw_manoeuvre(job);
    return status;
}
