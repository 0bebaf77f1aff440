// SPDX-License-Identifier: MIT
#include "snake/model/fp_model.h"

#include <tgmath.h>

#include "snake/model/model.h"

static inline void circle_d(double angle, double *c, double *s)
{
    *c = cos(angle);
    *s = sin(angle);
}

#define REAL double
#define TYPED(name) name##_d
#include "snake/model/fp_motor.inc"
#include "snake/model/fp_drag.inc"
#include "snake/model/fp_core.inc"
#undef REAL
#undef TYPED

typedef struct fp_scratch {
    fp_robot robot;
    fp_part *part;
    fp_link_d link[]; // [N], with the parts behind
} fp_scratch;

static size_t scratch_bytes(int N)
{
    return sizeof(fp_scratch) + (size_t)N * (sizeof(fp_link_d) + sizeof(fp_part));
}

static void prepare(const moray_robot *robot, void *memory)
{
    fp_scratch *scratch = memory;
    scratch->part = (fp_part *)(scratch->link + robot->links);
    scratch->robot = moray_fp_robot_of(robot, scratch->part);
}

static void rest(int N, double theta, double p_x, double p_y, double *x)
{
    for (int i = 0; i < N; i++)
        x[i] = theta;
    x[N] = p_x;
    x[N + 1] = p_y;
    for (int i = N + 2; i < 2 * N + 4; i++)
        x[i] = 0;
}

static void joints(int N, const double *x, double *phi, double *v_phi)
{
    const double *dtheta = x + N + 2;
    for (int i = 0; i < N - 1; i++) {
        phi[i] = x[i] - x[i + 1]; // (1)
        v_phi[i] = dtheta[i] - dtheta[i + 1];
    }
}

// Mean link angle, p_x, p_y, and their rates.
static void body(int N, const double *x, double out[MORAY_BODY_STATES])
{
    for (int half = 0; half < 2; half++, x += N + 2, out += 3) {
        out[0] = 0;
        for (int i = 0; i < N; i++)
            out[0] += x[i] / N;
        out[1] = x[N];
        out[2] = x[N + 1];
    }
}

static void assemble(int N, const double *phi, const double *v_phi, const double in[MORAY_BODY_STATES], double *x)
{
    for (int half = 0; half < 2; half++, x += N + 2, in += 3) {
        moray_fp_angles_d(N, in[0], half ? v_phi : phi, x);
        x[N] = in[1];
        x[N + 1] = in[2];
    }
}

static bool rates(const moray_robot *robot, const double current[2], const double *x, const double *ubar, double *dx,
                  double *u, void *memory)
{
    const int N = robot->links, half = N + 2;
    fp_scratch *scratch = memory;
    const fp_motion_d motion = {
        .theta = x, .dtheta = x + half, .v_x = x[half + N], .v_y = x[half + N + 1], .ubar = ubar};
    fp_balance_d balance;
    for (int i = 0; i < half; i++)
        dx[i] = x[half + i];
    const bool regular =
        moray_fp_accelerations_d(&scratch->robot, current, &motion, scratch->link, &balance, dx + half, dx + half + N);
    if (u != NULL)
        moray_fp_torques_d(&scratch->robot, &motion, scratch->link, dx + half, u);
    return regular;
}

// (2): the forces but for what the accelerations take, and that.
static bool water(const moray_robot *robot, const double current[2], const double *x, const double *ubar, double *along,
                  double *across, void *memory)
{
    const int N = robot->links, half = N + 2;
    fp_scratch *scratch = memory;
    double *ddtheta = across, ddp[2];
    fp_balance_d balance;
    for (int i = 0; i < N - 1; i++)
        along[i] = ubar ? ubar[i] : 0;
    const fp_motion_d motion = {
        .theta = x, .dtheta = x + half, .v_x = x[half + N], .v_y = x[half + N + 1], .ubar = along};
    if (!moray_fp_accelerations_d(&scratch->robot, current, &motion, scratch->link, &balance, ddtheta, ddp))
        return false;
    const fp_part alike = fp_part_alike(&scratch->robot);
    for (int i = 0; i < N; i++) {
        const fp_part *part = fp_part_of(&scratch->robot, i, scratch->robot.alike ? &alike : NULL);
        const fp_link_d *link = &scratch->link[i];
        const double taken = part->mu_n * (link->c * link->a.y - link->s * link->a.x) + part->mu_1 * ddtheta[i];
        along[i] = link->f_t;
        across[i] = link->f_n - (ubar ? taken : 0);
    }
    return true;
}

static moray_pose pose(const moray_robot *robot, const double *x)
{
    const int N = robot->links;
    double sum = 0, largest = 0;
    for (int i = 0; i < N; i++)
        sum += x[i];
    for (int i = 0; i < N; i++)
        largest = fmax(largest, fabs(x[i] - sum / N));
    return (moray_pose){.heading = sum / N,
                        .p_x = x[N],
                        .p_y = x[N + 1],
                        .v_x = x[2 * N + 2],
                        .v_y = x[2 * N + 3],
                        .link_angle = largest};
}

// From the tail on, then all moved so that their common centre of mass is (p_x, p_y).
static void links(const moray_robot *robot, const double *x, double *x_i, double *y_i, double *angle_i)
{
    const int N = robot->links;
    double tip[2] = {0, 0}, mean[2] = {0, 0};
    for (int i = 0; i < N; i++) {
        const moray_link link = moray_robot_link(robot, i);
        const double c = cos(x[i]), s = sin(x[i]), share = link.m / (N * robot->m);
        angle_i[i] = x[i];
        x_i[i] = tip[0] + link.l * c;
        y_i[i] = tip[1] + link.l * s;
        mean[0] += share * (x_i[i] + link.cm * c);
        mean[1] += share * (y_i[i] + link.cm * s);
        tip[0] += 2 * link.l * c;
        tip[1] += 2 * link.l * s;
    }
    for (int i = 0; i < N; i++) {
        x_i[i] += x[N] - mean[0];
        y_i[i] += x[N + 1] - mean[1];
    }
}

const snake_model moray_fp_model = {scratch_bytes, prepare, rest, joints, body, assemble, rates, water, pose, links};
