// SPDX-License-Identifier: MIT
//
// Figures of a gait over one period of steady swimming, with the limits it was given.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "figures.h"

enum { POINTS = GAIT_POINTS, SHOWN = 3, LIMITS = 2 };

// Curves of one figure and what they point at.
typedef struct sheet {
    moray_curve curves[SHOWN + LIMITS];
    int n;
    double values[SHOWN][POINTS], other[SHOWN][POINTS], limit[LIMITS][2], ends[2];
    char label[SHOWN][40];
} sheet;

// The shown joints' columns of rows[POINTS][joints], in a unit, as curves over time.
static void gather(const gait_period *v, const double *rows, double unit, sheet *s)
{
    static const char *const places[SHOWN] = {", at the tail", "", ", at the head"};
    for (s->n = 0; s->n < SHOWN; s->n++) {
        const int j = s->n * (v->joints - 1) / (SHOWN - 1);
        snprintf(s->label[s->n], sizeof *s->label, "joint %d%s", j + 1, places[s->n]);
        for (int k = 0; k < POINTS; k++)
            s->values[s->n][k] = rows[k * v->joints + j] / unit;
        s->curves[s->n] = (moray_curve){.label = s->label[s->n], .x = v->track->t, .y = s->values[s->n], .n = POINTS};
    }
}

static void add_curve(const gait_period *v, sheet *s, const char *label, moray_colour colour)
{
    s->curves[s->n] =
        (moray_curve){.label = label, .x = v->track->t, .y = s->values[s->n], .n = POINTS, .colour = colour};
    s->n++;
}

// A level across the figure from `from` to `to`; nothing where it is not finite.
static void add_limit(sheet *s, const char *label, double level, double from, double to)
{
    const int k = label ? 0 : 1; // the second one, below, has no line of its own in the key
    if (!isfinite(level))
        return;
    s->ends[0] = from;
    s->ends[1] = to;
    s->limit[k][0] = s->limit[k][1] = level;
    s->curves[s->n++] =
        (moray_curve){.label = label, .x = s->ends, .y = s->limit[k], .n = 2, .colour = MORAY_COLOUR_LIMIT};
}

static moray_status draw_joints(const gait_period *v, sheet *s)
{
    gather(v, v->phi, v->control ? 0.01 : DEG, s);
    return gait_period_draw(
        v,
        (moray_figure){.name = "joints",
                       .title = "joints over a period",
                       .x_label = "time [s]",
                       .y_label = v->control ? "joint coordinate phi [cm]" : "joint angle phi [deg]"},
        s->curves, s->n);
}

static moray_status draw_portrait(const gait_period *v, sheet *s)
{
    const double unit = v->control ? 0.01 : DEG, limit = v->job->joint_rate / (v->control ? 0.01 : 1);
    double most = 0;
    gather(v, v->phi, unit, s);
    memcpy(s->other, s->values, sizeof s->other);
    gather(v, v->rate, unit, s);
    for (int j = 0; j < SHOWN; j++) {
        s->curves[j].x = s->other[j];
        for (int k = 0; k < POINTS; k++)
            most = fmax(most, fabs(s->other[j][k]));
    }
    add_limit(s, "limit of the rate", limit, -most, most);
    add_limit(s, NULL, -limit, -most, most);
    return gait_period_draw(
        v,
        (moray_figure){.name = "portrait",
                       .title = "phase portrait of the joints",
                       .x_label = v->control ? "joint coordinate phi [cm]" : "joint angle phi [deg]",
                       .y_label = v->control ? "its rate [cm/s]" : "its rate [deg/s]"},
        s->curves, s->n);
}

static moray_status draw_effort(const gait_period *v, sheet *s)
{
    const double T = v->track->t[POINTS - 1];
    gather(v, v->track->u, 1, s);
    add_limit(s, "limit of the effort", v->job->joint_effort, 0, T);
    add_limit(s, NULL, -v->job->joint_effort, 0, T);
    return gait_period_draw(
        v,
        (moray_figure){.name = "torque",
                       .title = v->control ? "joint forces over a period" : "joint torques over a period",
                       .x_label = "time [s]",
                       .y_label = v->control ? "joint force u [N]" : "joint torque u [N m]"},
        s->curves, s->n);
}

static moray_status draw_power(const gait_period *v, sheet *s)
{
    const double T = v->track->t[POINTS - 1], mean = v->track->energy[POINTS - 1] / T;
    const bool motors = v->job->snake.robot.motor.fitted && !v->control;
    for (int k = 0; k < POINTS; k++) {
        s->values[0][k] = moray_swimmer_power(v->swimmer, v->track->u + k * v->joints, v->rate + k * v->joints);
        s->values[1][k] = mean;
    }
    add_curve(v, s, motors ? "power at the motors" : "joint power", MORAY_COLOUR_BEST);
    add_curve(v, s, "its mean", MORAY_COLOUR_SECOND);
    add_limit(s, "limit of the mean", last_stage(v->job)->power, 0, T);
    return gait_period_draw(
        v,
        (moray_figure){.name = "power",
                       .title = motors ? "power at the motors over a period" : "joint power over a period",
                       .x_label = "time [s]",
                       .y_label = "power [W]"},
        s->curves, s->n);
}

static moray_status draw_speed(const gait_period *v, sheet *s)
{
    const double course = v->job->snake.course, T = v->track->t[POINTS - 1], least = last_stage(v->job)->speed;
    const moray_pose *from = &v->track->pose[0], *to = &v->track->pose[POINTS - 1];
    const double mean = ((to->p_x - from->p_x) * cos(course) + (to->p_y - from->p_y) * sin(course)) / T;
    for (int k = 0; k < POINTS; k++) {
        s->values[0][k] = v->track->pose[k].v_x * cos(course) + v->track->pose[k].v_y * sin(course);
        s->values[1][k] = mean;
    }
    add_curve(v, s, "speed of the centre of mass", MORAY_COLOUR_BEST);
    add_curve(v, s, "its mean", MORAY_COLOUR_SECOND);
    add_limit(s, "least mean asked for", least > 0 ? least : INFINITY, 0, T);
    return gait_period_draw(v,
                            (moray_figure){.name = "speed",
                                           .title = "speed over a period",
                                           .x_label = "time [s]",
                                           .y_label = "speed along the course [m/s]"},
                            s->curves, s->n);
}

moray_status gait_period_draw_time(const gait_period *v)
{
    moray_status (*const all[])(const gait_period *, sheet *) = {draw_joints, draw_speed, draw_power, draw_effort,
                                                                 draw_portrait};
    moray_status status = moray_ok();
    for (size_t i = 0; i < sizeof all / sizeof *all && !moray_failed(status); i++) {
        sheet s = {.n = 0};
        status = all[i](v, &s);
    }
    return status;
}
