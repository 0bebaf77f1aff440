// SPDX-License-Identifier: MIT
//
// Figures of the recommended gait over one period of steady swimming, and of all gaits on the ladder.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "job.h"

enum { POINTS = 121, SHOWN = 3, SHAPES = 6 };

typedef struct orbit_view {
    const gait_job *job;
    moray_output *output;
    const moray_swim_track *track;
    const moray_swimmer *swimmer;
    int joint[SHOWN], joints; // those shown, and how many
    double *phi, *rate;       // [POINTS][joints]
    double *values;           // [(SHOWN + 1) POINTS], for one figure at a time
    bool control;
} orbit_view;

static const char *const places[SHOWN] = {"joint at the tail", "in the middle", "at the head"};

static moray_status draw(const orbit_view *v, moray_figure figure, const moray_curve *curves, int n)
{
    figure.curves = curves;
    figure.n_curves = n;
    return moray_output_figure(v->output, &figure);
}

// The shown joints' columns of rows[POINTS][joints], divided by a unit, as curves over time.
static void gather(const orbit_view *v, const double *rows, double unit, moray_curve *curves)
{
    for (int j = 0; j < SHOWN; j++) {
        double *to = v->values + j * POINTS;
        for (int k = 0; k < POINTS; k++)
            to[k] = rows[k * v->joints + v->joint[j]] / unit;
        curves[j] = (moray_curve){.label = places[j], .x = v->track->t, .y = to, .n = POINTS};
    }
}

static moray_status draw_joints(const orbit_view *v)
{
    moray_curve curves[SHOWN];
    gather(v, v->phi, v->control ? 0.01 : DEG, curves);
    return draw(v,
                (moray_figure){.name = "joints",
                               .title = "The recommended gait: joints over a period",
                               .x_label = "time [s]",
                               .y_label = v->control ? "joint coordinate phi [cm]" : "joint angle phi [deg]"},
                curves, SHOWN);
}

static moray_status draw_portrait(const orbit_view *v)
{
    moray_curve curves[SHOWN];
    const double unit = v->control ? 0.01 : DEG;
    double *x = malloc(SHOWN * POINTS * sizeof *x);
    if (!x)
        return moray_error(MORAY_MEMORY, "no memory for a figure");
    gather(v, v->phi, unit, curves);
    memcpy(x, v->values, SHOWN * POINTS * sizeof *x);
    gather(v, v->rate, unit, curves);
    for (int j = 0; j < SHOWN; j++)
        curves[j].x = x + j * POINTS;
    const moray_status status =
        draw(v,
             (moray_figure){.name = "portrait",
                            .title = "The recommended gait: phase portrait of the joints",
                            .x_label = v->control ? "joint coordinate phi [cm]" : "joint angle phi [deg]",
                            .y_label = v->control ? "its rate [cm/s]" : "its rate [deg/s]"},
             curves, SHOWN);
    free(x);
    return status;
}

static moray_status draw_effort(const orbit_view *v)
{
    const double limit = v->job->joint_effort;
    const double ends[2] = {0, v->track->t[POINTS - 1]}, low[2] = {-limit, -limit}, high[2] = {limit, limit};
    moray_curve curves[SHOWN + 2];
    gather(v, v->track->u, 1, curves);
    curves[SHOWN] = (moray_curve){.label = "limit of the effort", .x = ends, .y = high, .n = 2};
    curves[SHOWN + 1] = (moray_curve){.label = "and below", .x = ends, .y = low, .n = 2};
    return draw(v,
                (moray_figure){.name = "torque",
                               .title = v->control ? "The recommended gait: joint forces over a period"
                                                   : "The recommended gait: joint torques over a period",
                               .x_label = "time [s]",
                               .y_label = v->control ? "joint force u [N]" : "joint torque u [N m]"},
                curves, isfinite(limit) ? SHOWN + 2 : SHOWN);
}

// Of the joints together, or at the terminals of their motors.
static moray_status draw_power(const orbit_view *v)
{
    double *power = v->values, *mean = v->values + POINTS;
    const bool motors = v->job->snake.robot.motor.fitted && !v->control;
    const double T = v->track->t[POINTS - 1];
    for (int k = 0; k < POINTS; k++) {
        power[k] = moray_swimmer_power(v->swimmer, v->track->u + k * v->joints, v->rate + k * v->joints);
        mean[k] = v->track->energy[POINTS - 1] / T;
    }
    const moray_curve curves[] = {
        {.label = motors ? "power at the motors" : "joint power", .x = v->track->t, .y = power, .n = POINTS},
        {.label = "its mean", .x = v->track->t, .y = mean, .n = POINTS}};
    return draw(v,
                (moray_figure){.name = "power",
                               .title = motors ? "The recommended gait: power at the motors over a period"
                                               : "The recommended gait: joint power over a period",
                               .x_label = "time [s]",
                               .y_label = "power [W]"},
                curves, 2);
}

static moray_status draw_speed(const orbit_view *v)
{
    double *speed = v->values;
    const double course = v->job->snake.course;
    for (int k = 0; k < POINTS; k++)
        speed[k] = v->track->pose[k].v_x * cos(course) + v->track->pose[k].v_y * sin(course);
    const moray_curve curve = {.label = "speed along the course", .x = v->track->t, .y = speed, .n = POINTS};
    return draw(v,
                (moray_figure){.name = "speed",
                               .title = "The recommended gait: speed over a period",
                               .x_label = "time [s]",
                               .y_label = "speed along the course [m/s]"},
                &curve, 1);
}

// The body at equal times of the period, one below the other, each where it is along its way.
static moray_status draw_shapes(const orbit_view *v)
{
    const moray_robot *robot = moray_swimmer_robot(v->swimmer);
    const int N = robot->links;
    const double apart = 3 * robot->l;
    double *xy = malloc((size_t)(2 * SHAPES * 3 * N + 3 * N) * sizeof *xy),
           *links = xy ? xy + 2 * SHAPES * 3 * N : NULL;
    char labels[SHAPES][32];
    moray_curve curves[SHAPES];
    if (!xy)
        return moray_error(MORAY_MEMORY, "no memory for a figure");
    for (int s = 0; s < SHAPES; s++) {
        const int k = s * (POINTS - 1) / SHAPES;
        double *x = xy + 2 * s * 3 * N, *y = x + 3 * N;
        moray_swimmer_links(v->swimmer, v->track->x + (size_t)k * (size_t)v->track->n_states, links, links + N,
                            links + 2 * N);
        for (int i = 0; i < 3 * N; i++) {
            const int link = i / 3, end = i % 3; // both ends, then a gap
            const double along = end == 2 ? NAN : (2 * end - 1) * moray_swimmer_half_length(v->swimmer, link);
            x[i] = links[link] + along * cos(links[2 * N + link]);
            y[i] = links[N + link] + along * sin(links[2 * N + link]) - s * apart;
        }
        snprintf(labels[s], sizeof labels[s], "at %.2f s", v->track->t[k]);
        curves[s] = (moray_curve){.label = labels[s], .x = x, .y = y, .n = 3 * N, .style = MORAY_CURVE_BODY};
    }
    const moray_status status = draw(v,
                                     (moray_figure){.name = "shapes",
                                                    .title = "The recommended gait: shapes of the body over a period",
                                                    .x_label = "x [m]",
                                                    .y_label = "y [m], one below the other",
                                                    .equal_axes = true},
                                     curves, SHAPES);
    free(xy);
    return status;
}

static moray_status draw_orbit(orbit_view *v)
{
    const int N = v->joints;
    double *phi = malloc((size_t)(POINTS * (2 * N + SHOWN + 1)) * sizeof *phi);
    if (!phi)
        return moray_error(MORAY_MEMORY, "no memory for figures");
    v->phi = phi;
    v->rate = phi + POINTS * N;
    v->values = v->rate + POINTS * N;
    for (int k = 0; k < POINTS; k++)
        moray_swimmer_joints(v->swimmer, v->track->x + (size_t)k * (size_t)v->track->n_states, v->phi + k * N,
                             v->rate + k * N);
    moray_status (*const all[])(const orbit_view *) = {draw_shapes, draw_joints, draw_speed,
                                                       draw_power,  draw_effort, draw_portrait};
    moray_status status = moray_ok();
    for (size_t i = 0; i < sizeof all / sizeof *all && !moray_failed(status); i++)
        status = all[i](v);
    free(phi);
    return status;
}

// Gains in speed at equal power, a row a model, a mark a gait.
static moray_status draw_ladder(const gait_job *job, moray_output *output)
{
    const stage *at[GAIT_STAGES];
    const int n = gait_job_stages(job, at);
    double gain[GAIT_STAGES][MORAY_RUNGS], row[MORAY_RUNGS];
    const char *names[MORAY_RUNGS];
    moray_curve curves[GAIT_STAGES];
    bool any = false;
    for (int r = 0; r < MORAY_RUNGS; r++) {
        row[r] = r;
        names[r] = n > 0 ? at[0]->ladder[r].model : NULL;
    }
    for (int k = 0; k < n; k++) {
        for (int r = 0; r < MORAY_RUNGS; r++) {
            gain[k][r] = at[k]->ladder[r].gain_percent;
            any = any || isfinite(gain[k][r]);
        }
        curves[k] = (moray_curve){
            .label = gait_job_kind(job, at[k]), .x = gain[k], .y = row, .n = MORAY_RUNGS, .style = MORAY_CURVE_POINTS};
    }
    if (!any)
        return moray_ok();
    return moray_output_figure(output, &(moray_figure){.name = "ladder",
                                                       .title = "Gain on the ladder of models",
                                                       .x_label = "gain in speed at the power of the paper's gait [%]",
                                                       .y_label = "",
                                                       .y_names = names,
                                                       .n_y_names = MORAY_RUNGS,
                                                       .curves = curves,
                                                       .n_curves = n});
}

moray_status gait_job_draw_gait(const gait_job *job, moray_output *output)
{
    const moray_model model = job->snake.model;
    const moray_gait_trial *trial = &recommended(job)->trial;
    const moray_swim_setup setup = moray_test_rig_setup(&job->rig, model);
    const int joints = job->snake.robot.links - 1;
    moray_steady steady;
    moray_swim_track track = {0};
    MORAY_TRY(draw_ladder(job, output));
    if (isnan(trial->steady[model].speed))
        return moray_ok();
    moray_status status =
        moray_swim_steady(&setup, &trial->gait[model], trial->steady[model].start_heading, &steady, &track, POINTS);
    orbit_view view = {.job = job,
                       .output = output,
                       .track = &track,
                       .swimmer = job->rig.swimmer[model],
                       .joint = {0, (joints - 1) / 2, joints - 1},
                       .joints = joints,
                       .control = model == MORAY_CONTROL_ORIENTED};
    if (!moray_failed(status))
        status = draw_orbit(&view);
    moray_swim_track_free(&track);
    return status.code == MORAY_MEMORY || status.code == MORAY_IO ? status
                                                                  : moray_ok(); // what never settles is not drawn
}
