// SPDX-License-Identifier: MIT
//
// What the instruments would read. With the joints known, only the six states of the body are integrated, by the
// classical Runge-Kutta method of a fixed step: its result is a smooth function of all unknowns, so that differences of
// it are derivatives. Readings are taken off the grid by cubic pieces.
#include <math.h>

#include "snake/identify/identify.h"

// ---- Swimming ------------------------------------------------------------------------------------------------------

struct swum {
    const moray_identify *of;
    const struct run *run;
    moray_gait gait; // of the model
    double delay;
    int joints;
    double *phi, *v_phi, *ubar, *u;
};

static struct swum begin(const moray_identify *v, const struct run *run, const moray_unknowns *world)
{
    const int joints = run->motion.joints;
    return (struct swum){.of = v,
                         .run = run,
                         .gait =
                             moray_gait_map(&world->robot, &run->motion.gait, MORAY_FIRST_PRINCIPLES, v->spec.model),
                         .delay = world->joint_delay,
                         .joints = joints,
                         .phi = v->joint,
                         .v_phi = v->joint + joints,
                         .ubar = v->joint + 2 * joints,
                         .u = v->joint + 3 * joints};
}

static void set_joints(const struct swum *s, double t)
{
    const struct motion *m = &s->run->motion;
    if (m->on_gait) {
        moray_gait_reference(&s->gait, s->joints, t - s->delay + m->shift, s->phi, s->v_phi, s->ubar);
        return;
    }
    for (int i = 0; i < s->joints; i++) {
        double d[3];
        moray_smooth_at(&m->joint[i], t - s->delay, d);
        s->phi[i] = d[0], s->v_phi[i] = d[1], s->ubar[i] = d[2];
    }
}

static bool rates(const struct swum *s, double t, const double y[FIRST], double dy[FIRST], double *u)
{
    const moray_identify *v = s->of;
    set_joints(s, t);
    moray_swimmer_with_joints(v->swimmer, s->phi, s->v_phi, y, v->x);
    if (!moray_swimmer_rates(v->swimmer, v->x, s->ubar, v->dx, u))
        return false;
    moray_state_body(v->spec.model, s->joints + 1, v->dx, dy);
    return true;
}

static bool step(const struct swum *s, double t, double h, const double *y, double *k1, double *next)
{
    double k2[FIRST], k3[FIRST], k4[FIRST], at[FIRST];
    bool good = rates(s, t, y, k1, NULL);
    for (int i = 0; i < FIRST; i++)
        at[i] = y[i] + h / 2 * k1[i];
    good = good && rates(s, t + h / 2, at, k2, NULL);
    for (int i = 0; i < FIRST && good; i++)
        at[i] = y[i] + h / 2 * k2[i];
    good = good && rates(s, t + h / 2, at, k3, NULL);
    for (int i = 0; i < FIRST && good; i++)
        at[i] = y[i] + h * k3[i];
    good = good && rates(s, t + h, at, k4, NULL);
    for (int i = 0; i < FIRST && good; i++)
        next[i] = y[i] + h / 6 * (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i]);
    return good;
}

static bool prepare(const moray_identify *v, const moray_unknowns *world)
{
    moray_swimmer_set_current(v->swimmer, world->current[0], world->current[1]);
    return !moray_failed(moray_swimmer_set_robot(v->swimmer, &world->robot));
}

bool moray_identify_swim(const moray_identify *v, const struct run *run, const moray_unknowns *world,
                         const double first[FIRST])
{
    const struct swum s = begin(v, run, world);
    const double t0 = run->log->t[0];
    bool good = prepare(v, world);
    for (int i = 0; i < FIRST; i++)
        run->grid[i] = first[i];
    for (int k = 0; k < run->steps && good; k++) {
        double *at = run->grid + (size_t)k * 2 * FIRST;
        good = step(&s, t0 + k * run->h, run->h, at, at + FIRST, at + 2 * FIRST);
    }
    double *last = run->grid + (size_t)run->steps * 2 * FIRST;
    return good && rates(&s, t0 + run->steps * run->h, last, last + FIRST, NULL);
}

// ---- Reading -------------------------------------------------------------------------------------------------------

static void body_at(const struct run *run, double t, double y[FIRST])
{
    const double place = (t - run->log->t[0]) / run->h;
    int k = (int)floor(place);
    k = k < 0 ? 0 : k >= run->steps ? run->steps - 1 : k;
    const double s = place - k, *left = run->grid + (size_t)k * 2 * FIRST, *right = left + 2 * FIRST;
    const double of_right = s * s * (3 - 2 * s), slope_left = s * (1 - s) * (1 - s), slope_right = -s * s * (1 - s);
    for (int i = 0; i < FIRST; i++)
        y[i] = (1 - of_right) * left[i] + of_right * right[i] +
               run->h * (slope_left * left[FIRST + i] + slope_right * right[FIRST + i]);
}

static bool read_torques(const struct swum *s, int row)
{
    double y[FIRST], dy[FIRST];
    body_at(s->run, s->run->log->t[row], y);
    return rates(s, s->run->log->t[row], y, dy, s->u);
}

static double through_camera(const moray_unknowns *world, const double y[FIRST], bool across)
{
    const double x = y[MORAY_STATE_P_X] - world->camera[0], z = y[MORAY_STATE_P_Y] - world->camera[1];
    const double c = cos(world->camera_rotation), s = sin(world->camera_rotation);
    return across ? s * x + c * z : c * x - s * z;
}

bool moray_identify_read(const moray_identify *v, const struct run *run, const moray_unknowns *world, double *predicted)
{
    const struct swum s = begin(v, run, world);
    int row = -1;
    if (!prepare(v, world))
        return false;
    for (int k = 0; k < run->items; k++) {
        const struct item *item = &run->item[k];
        const double t = run->log->t[item->row];
        double y[FIRST];
        switch (item->kind) {
        case MORAY_CHANNEL_TORQUE:
            if (item->row != row && !read_torques(&s, row = item->row))
                return false;
            predicted[k] = s.u[item->joint];
            if (run->log->at_motors)
                predicted[k] = moray_motor_torque(&world->robot.motor, predicted[k], s.v_phi[item->joint]);
            break;
        case MORAY_CHANNEL_HEADING:
            body_at(run, t - world->heading_delay, y);
            predicted[k] = y[MORAY_STATE_THETA] + world->heading_bias;
            break;
        default:
            body_at(run, t - world->position_delay, y);
            predicted[k] = through_camera(world, y, item->kind == MORAY_CHANNEL_Y);
        }
    }
    return true;
}
