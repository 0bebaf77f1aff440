// SPDX-License-Identifier: MIT
#include <stdlib.h>

#include "heading_job.h"

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

static moray_status draw_over_time(const heading_job *job, heading_trial *const *trials, const moray_voyage *voyages)
{
    const int n = voyages->track.n;
    const double *t = voyages->track.t;
    double *data = malloc((size_t)(n * (2 * shown + 1)) * sizeof *data), *reference = data + 2 * shown * n, rate;
    moray_curve heading[shown + 1], offset[shown];
    if (!data)
        return moray_error(MORAY_MEMORY, "no memory for figures");
    for (int k = 0; k < n; k++)
        reference[k] = moray_reference_at(&job->reference, t[k], &rate) / DEG;
    heading[shown] = (moray_curve){.label = "reference", .x = t, .y = reference, .n = n};
    for (int i = 0; i < shown; i++) {
        const moray_cruise *cruise = &job->cruise[trials[i]->gait][1];
        double *angle = data + 2 * i * n, *phi = angle + n;
        for (int k = 0; k < n; k++) {
            angle[k] = moray_cruise_heading(cruise, t[k], voyages[i].track.pose[k].heading) / DEG;
            phi[k] = voyages[i].offset[k] / DEG;
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
        const moray_cruise *cruise = job->cruise[1 + model];
        const double scale = model == MORAY_FIRST_PRINCIPLES ? 1 : -cruise[1].gait.amplitude / cruise[0].gait.amplitude;
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

static moray_status draw_shown(heading_job *job, heading_trial *const *trials, const moray_voyage *voyages)
{
    const steer_curve paths[shown] = {
        {trials[0]->name, &voyages[0]}, {trials[1]->name, &voyages[1]}, {trials[2]->name, &voyages[2]}};
    MORAY_TRY(draw_over_time(job, trials, voyages));
    MORAY_TRY(steer_draw_path(&job->common, "heading_tracking", paths, shown, NULL, 0));
    MORAY_TRY(steer_draw_joints(&job->common, "heading_tracking", &voyages[shown - 1]));
    return steer_write_trajectory(&job->common, &voyages[shown - 1]);
}

moray_status heading_draw(heading_job *job)
{
    heading_trial *trials[shown];
    moray_voyage voyages[shown] = {{0}};
    moray_status status = moray_ok();
    choose_shown(job, trials);
    for (int k = 0; k < shown && !moray_failed(status); k++)
        status = heading_swim(job, trials[k], MORAY_FIRST_PRINCIPLES, &voyages[k]);
    if (!moray_failed(status))
        status = draw_shown(job, trials, voyages);
    for (int k = 0; k < shown; k++)
        moray_voyage_free(&voyages[k]);
    if (!moray_failed(status) && heading_is_fig8(job))
        status = draw_manoeuvre(job);
    return status;
}
