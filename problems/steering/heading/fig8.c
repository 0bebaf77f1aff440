// SPDX-License-Identifier: MIT
//
// The manoeuvre of Sec. V-C, Fig. 8, re-created: the heading that the paper's offset gives the first-principles model
// is the reference, and what offset gives it is asked anew of both models.
#include <stdlib.h>
#include <string.h>

#include "job.h"

enum { per_second = 20 };
static const double theta_max = 10 * DEG, omega = 120 * DEG, delta = 40 * DEG, horizon = 190;
static const double edges[] = {40, 70, 130, 160}; // one way between the first two, the other between the last two
static const double settled = 3;                  // behind an edge, and before the next [s]

bool heading_is_fig8(const heading_job *job)
{
    return strcmp(job->reference_text, "fig8") == 0;
}

static double way(double t)
{
    return t >= edges[0] && t < edges[1] ? 1 : t >= edges[2] && t < edges[3] ? -1 : 0;
}

static moray_gait gait_of(const heading_job *job, moray_model model)
{
    return (moray_gait){.amplitude = moray_amplitude_from_theta_max(&job->common.robot, model, theta_max, delta),
                        .omega = omega,
                        .delta = delta};
}

double heading_fig8_offset(const heading_job *job, moray_model model, double t)
{
    const double sixth = gait_of(job, model).amplitude / 6;
    return way(t) * (model == MORAY_CONTROL_ORIENTED ? sixth : -sixth); // erratum E3
}

static moray_offset steer(double t, const void *self)
{
    return (moray_offset){.value = heading_fig8_offset(self, MORAY_FIRST_PRINCIPLES, t)};
}

// The simulation stops here: every edge of the offset is a multiple of the period.
static void look(const moray_swim_sample *sample, void *self)
{
    (void)sample, (void)self;
}

static moray_status make_reference(heading_job *job, const moray_straight_motion *straight,
                                   const moray_closed_loop *closed_loop)
{
    const int n = closed_loop->track.n;
    double *block = malloc(2 * (size_t)n * sizeof *block);
    if (!block)
        return moray_error(MORAY_MEMORY, "no memory for a reference of %d points", n);
    job->reference = (moray_reference){.n = n, .time = block, .heading = block + n};
    for (int k = 0; k < n; k++) {
        block[k] = closed_loop->track.t[k];
        block[n + k] = moray_straight_motion_heading(straight, block[k], closed_loop->track.pose[k].heading);
    }
    return moray_ok();
}

moray_status heading_fig8_prepare(heading_job *job)
{
    const moray_gait gait = gait_of(job, MORAY_FIRST_PRINCIPLES);
    const moray_controller controller = {.offset = steer, .look = look, .period = 10, .self = job};
    moray_straight_motion straight;
    moray_closed_loop closed_loop;
    for (int side = 0; side < 2; side++) {
        job->input.theta_max[side] = theta_max;
        job->input.omega[side] = omega;
        job->input.delta[side] = delta;
    }
    if (isnan(job->horizon))
        job->horizon = horizon;
    MORAY_TRY(moray_straight_motion_find(&straight, &job->common.robot, MORAY_FIRST_PRINCIPLES, &gait));
    const moray_closed_loop_spec plan = {.robot = &job->common.robot,
                                         .straight = &straight,
                                         .current = {job->common.current[0], job->common.current[1]},
                                         .controller = &controller,
                                         .duration = job->horizon,
                                         .intervals = (int)ceil(per_second * job->horizon),
                                         .tolerance = 1e-8};
    MORAY_TRY(moray_closed_loop_run(&closed_loop, &plan));
    const moray_status status = make_reference(job, &straight, &closed_loop);
    moray_closed_loop_free(&closed_loop);
    return status;
}

heading_fig8_match heading_fig8_compare(const heading_job *job, moray_model model)
{
    const moray_solution *solution = job->plan[model].solution;
    const int n = (int)ceil(per_second * job->horizon);
    int count[3] = {0};
    heading_fig8_match match = {.paper = heading_fig8_offset(job, model, 0.5 * (edges[0] + edges[1]))};
    double *const mean[] = {&match.straight, &match.there, &match.back};
    for (int k = 0; k < n; k++) {
        const double t = job->horizon * (k + 0.5) / n, found = moray_steering_offset(solution, t).value;
        const double error = found - heading_fig8_offset(job, model, t);
        const int which = way(t) == 0 ? 0 : way(t) > 0 ? 1 : 2;
        match.rms += error * error / n;
        if (way(t - settled) == way(t) && way(t + settled) == way(t)) {
            *mean[which] += found;
            count[which]++;
        }
    }
    for (int which = 0; which < 3; which++)
        *mean[which] /= count[which];
    match.rms = sqrt(match.rms);
    return match;
}
