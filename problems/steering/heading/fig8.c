// SPDX-License-Identifier: MIT
//
// The manoeuvre of Sec. V-C, Fig. 8, re-created: the heading that the paper's offset gives the first-principles model
// is the reference, and what offset gives it is asked anew of both models.
#include <stdlib.h>
#include <string.h>

#include "heading.h"

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
    return (moray_gait){.amplitude = moray_amplitude_from_theta_max(&job->steer.snake.robot, model, theta_max, delta),
                        .omega = omega,
                        .delta = delta};
}

// The paper's offset at t [m or rad].
static double paper_offset(const heading_job *job, moray_model model, double t)
{
    const double sixth = gait_of(job, model).amplitude / 6;
    return way(t) * (model == MORAY_CONTROL_ORIENTED ? sixth : -sixth); // erratum E3
}

static moray_offset steer(double t, const void *self)
{
    return (moray_offset){.value = paper_offset(self, MORAY_FIRST_PRINCIPLES, t)};
}

// The simulation stops here: every edge of the offset is a multiple of the period.
static moray_status measure(const moray_swim_sample *sample, void *self)
{
    (void)sample, (void)self;
    return moray_ok();
}

static moray_status make_reference(heading_job *job, const moray_straight_motion *straight,
                                   const moray_swim_closed_loop *closed_loop)
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
    const moray_swim_controller controller = {.offset = steer, .measure = measure, .period = 10, .self = job};
    moray_straight_motion straight;
    moray_swim_closed_loop closed_loop;
    for (int side = 0; side < 2; side++) {
        job->steer.input.theta_max[side] = theta_max;
        job->steer.input.omega[side] = omega;
        job->steer.input.delta[side] = delta;
    }
    if (isnan(job->horizon))
        job->horizon = horizon;
    MORAY_TRY(moray_straight_motion_find(&straight, &job->steer.snake.robot, MORAY_FIRST_PRINCIPLES, &gait));
    const moray_swim_closed_loop_spec plan = {.robot = &job->steer.snake.robot,
                                              .straight = &straight,
                                              .current = {job->steer.snake.current[0], job->steer.snake.current[1]},
                                              .controller = &controller,
                                              .duration = job->horizon,
                                              .intervals = (int)ceil(per_second * job->horizon),
                                              .tolerance = 1e-8};
    MORAY_TRY(moray_swim_closed_loop_run(&closed_loop, &plan));
    const moray_status status = make_reference(job, &straight, &closed_loop);
    moray_swim_closed_loop_free(&closed_loop);
    return status;
}

void heading_fig8_compare(const heading_job *job, moray_model model, double match[FIG8_VALUES])
{
    const moray_solution *solution = job->steer.plan[model].solution;
    const int n = (int)ceil(per_second * job->horizon);
    int count[FIG8_VALUES] = {0};
    for (int i = 0; i < FIG8_VALUES; i++)
        match[i] = 0;
    match[FIG8_PAPER] = paper_offset(job, model, 0.5 * (edges[0] + edges[1]));
    for (int k = 0; k < n; k++) {
        const double t = job->horizon * (k + 0.5) / n, found = moray_steering_offset(solution, t).value;
        const double error = found - paper_offset(job, model, t);
        const int which = way(t) == 0 ? FIG8_STRAIGHT : way(t) > 0 ? FIG8_THERE : FIG8_BACK;
        match[FIG8_RMS] += error * error / n;
        if (way(t - settled) == way(t) && way(t + settled) == way(t)) {
            match[which] += found;
            count[which]++;
        }
    }
    for (int which = FIG8_THERE; which <= FIG8_STRAIGHT; which++)
        match[which] /= count[which];
    match[FIG8_RMS] = sqrt(match[FIG8_RMS]);
}

// As the first-principles model would take them.
moray_status heading_fig8_draw(const heading_job *job)
{
    enum { points = 1900 };
    static const char *const labels[] = {"found on the control-oriented model", "found on the first-principles model"};
    double *t = malloc(4 * points * sizeof *t);
    if (!t)
        return moray_error(MORAY_MEMORY, "no memory for figures");
    double *paper = t + points;
    moray_curve curves[3] = {{.label = "of Sec. V-C", .x = t, .y = paper, .n = points}};
    int n = 1;
    for (int k = 0; k < points; k++) {
        t[k] = job->horizon * k / (points - 1);
        paper[k] = paper_offset(job, MORAY_FIRST_PRINCIPLES, t[k]) / DEG;
    }
    for (int model = 0; model <= (int)job->steer.snake.model; model++) {
        double *found = paper + n * points;
        const double scale = steer_offset_ratio(&job->steer, 1 + model, (moray_model)model, MORAY_FIRST_PRINCIPLES);
        for (int k = 0; k < points; k++)
            found[k] = scale * moray_steering_offset(job->steer.plan[model].solution, t[k]).value / DEG;
        curves[n++] = (moray_curve){.label = labels[model], .x = t, .y = found, .n = points};
    }
    const moray_status status =
        steer_draw_figure(&job->steer, &(moray_figure){.name = "manoeuvre",
                                                       .title = "Joint offset of Fig. 8, and found for its heading",
                                                       .x_label = "time [s]",
                                                       .y_label = "phi_0 of the first-principles model [deg]",
                                                       .curves = curves,
                                                       .n_curves = n});
    free(t);
    return status;
}
