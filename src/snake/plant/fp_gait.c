// SPDX-License-Identifier: MIT
#include "snake/plant/fp_gait.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { body = MORAY_BODY_STATES };

static void find_places(fp_gait *at)
{
    const bool steered = at->of->spec.joints == MORAY_JOINTS_STEERED;
    const int s = at->of->size.nx + at->of->size.nu, t = s + at->of->size.ns;
    const int on_gait[GAIT_KINDS] = {s, s + 1, s + 2, s + 3, s + 4, t, -1, -1};
    const int moving[GAIT_KINDS] = {s, s + 1, s + 2, body, -1, t, body + 1, body + 2};
    memcpy(at->place, steered ? moving : on_gait, sizeof at->place);
}

moray_status moray_fp_gait_new(fp_gait *at, const fp_setting *of, int most)
{
    double **const parts[] = {&at->gait.sine, &at->gait.cosine, &at->gait.place, &at->gait.growth,
                              &at->theta,     &at->dtheta,      &at->ddtheta,    &at->u};
    const size_t n = sizeof parts / sizeof *parts, N = (size_t)of->spec.robot.links;
    *at = (fp_gait){.of = of, .gait.n = (int)N - 1};
    double *block = at->memory = calloc((n + FP_RANKS * (3 + GAIT_KINDS)) * N, sizeof *block);
    at->links = calloc(N, sizeof *at->links);
    at->dual = calloc(N, sizeof *at->dual);
    if (!block || !at->links || !at->dual)
        return moray_error(MORAY_MEMORY, "no memory for a gait of %d links", of->spec.robot.links);
    for (size_t i = 0; i < n; i++, block += N)
        *parts[i] = block;
    for (int rank = 0; rank < FP_RANKS; rank++) {
        at->joints[rank] = block;
        at->on_links[rank] = block + N;
        at->on_joints[rank] = block + 2 * N;
        block += 3 * N;
        for (int kind = 0; kind < GAIT_KINDS; kind++, block += N)
            at->slope[kind][rank] = block;
    }
    find_places(at);
    return moray_fp_columns_new(&at->columns, (int)N, most);
}

void moray_fp_gait_free(fp_gait *at)
{
    free(at->memory);
    free(at->links);
    free(at->dual);
    moray_fp_columns_free(&at->columns);
}

void moray_fp_gait_move(fp_gait *at, const double *in)
{
    const fp_robot *robot = &at->of->robot;
    double p[GAIT_KINDS];
    for (int kind = 0; kind < GAIT_KINDS; kind++)
        p[kind] = at->place[kind] < 0 ? 0 : in[at->place[kind]];
    moray_reference_set(&at->gait, p);
    moray_reference_values(&at->gait, at->joints[0], at->joints[1], at->joints[2]);
    moray_fp_angles_d(robot->links, in[MORAY_STATE_THETA], at->joints[0], at->theta);
    moray_fp_angles_d(robot->links, in[MORAY_STATE_V_THETA], at->joints[1], at->dtheta);
    at->motion = (fp_motion_d){at->theta, at->dtheta, in[MORAY_STATE_V_1], in[MORAY_STATE_V_2], at->joints[2]};
    if (!moray_fp_accelerations_d(robot, at->of->spec.current, &at->motion, at->links, at->ddtheta, at->ddp))
        at->ddp[0] = at->ddp[1] = NAN;
    at->power = moray_fp_torques_d(robot, &at->motion, at->links, at->ddtheta, at->u);
}

// ---- Gradient ------------------------------------------------------------------------------------------------------

// From that by the links' motion.
static void pull_input(fp_gait *at, double v_x, double v_y, double *gradient)
{
    const moray_plant_size *size = &at->of->size;
    double mean[FP_RANKS], by[GAIT_KINDS];
    for (int rank = 0; rank < FP_RANKS; rank++)
        mean[rank] = moray_fp_pull_angles_d(at->of->spec.robot.links, at->on_links[rank], at->on_joints[rank]);
    moray_reference_gradient(&at->gait, at->on_joints[0], at->on_joints[1], at->on_joints[2], by);
    memset(gradient, 0, (size_t)(size->nx + size->nu + size->ns + 1) * sizeof *gradient);
    for (int kind = 0; kind < GAIT_KINDS; kind++)
        if (at->place[kind] >= 0)
            gradient[at->place[kind]] = by[kind];
    gradient[MORAY_STATE_THETA] = mean[0];
    gradient[MORAY_STATE_V_THETA] = mean[1];
    gradient[MORAY_STATE_V_1] = v_x;
    gradient[MORAY_STATE_V_2] = v_y;
}

static fp_weights weights_of(const fp_setting *of, const double *weight)
{
    const int joints = of->spec.robot.links - 1;
    const double *path = weight + of->size.nx, *supply = path + (of->spec.path_forces ? joints : 0);
    return (fp_weights){.lambda = weight + MORAY_STATE_V_THETA,
                        .rho = of->spec.path_forces ? path : NULL,
                        .sigma = of->spec.path_supply ? supply : NULL,
                        .pi = weight[of->size.nx + of->size.nc]};
}

void moray_fp_gait_gradient(fp_gait *at, const double *weight, double *gradient)
{
    const fp_setting *of = at->of;
    const int N = of->spec.robot.links;
    const double *on_angles = weight + of->size.nx + of->size.nc - N;
    const fp_weights weights = weights_of(of, weight);
    fp_gradient_d by = {at->on_links[0], at->on_links[1], at->on_links[2], 0, 0};
    moray_fp_adjoint_d(&of->robot, of->spec.current, &at->motion, at->links, at->ddtheta, at->u, &weights, at->dual,
                       &by);
    for (int i = 0; i < N && of->spec.path_angles; i++)
        by.theta[i] += on_angles[i];
    pull_input(at, by.v_x, by.v_y, gradient);
}

void moray_fp_gait_angle_gradient(fp_gait *at, int i, double *gradient)
{
    for (int rank = 0; rank < FP_RANKS; rank++)
        memset(at->on_links[rank], 0, (size_t)at->of->spec.robot.links * sizeof(double));
    at->on_links[0][i] = 1;
    pull_input(at, 0, 0, gradient);
}

// ---- Hessian -------------------------------------------------------------------------------------------------------

static double *joint_rows(const fp_joint_motion *motion, int rank)
{
    return rank == 0 ? motion->phi : rank == 1 ? motion->v_phi : motion->ubar;
}

// Of an input that moves the robot's body alone; NULL: it does not.
static double *body_row(const fp_columns *columns, const fp_joint_motion *motion, int input)
{
    return input == MORAY_STATE_THETA     ? motion->mean
           : input == MORAY_STATE_V_THETA ? motion->v_mean
           : input == MORAY_STATE_V_1     ? motion->v
           : input == MORAY_STATE_V_2     ? motion->v + columns->stride
                                          : NULL;
}

// The gait's input that it is; -1: none.
static int kind_of(const fp_gait *at, int input)
{
    for (int kind = 0; kind < GAIT_KINDS; kind++)
        if (at->place[kind] == input)
            return kind;
    return -1;
}

static void set_direction(fp_gait *at, int input, int k)
{
    fp_columns *columns = &at->columns;
    double *const rows[] = {columns->along.mean, columns->along.v_mean, columns->along.v,
                            columns->along.v + columns->stride};
    const int kind = kind_of(at, input);
    for (int i = 0; i < 4; i++)
        rows[i][k] = rows[i] == body_row(columns, &columns->along, input);
    for (int rank = 0; rank < FP_RANKS; rank++) {
        double *to = joint_rows(&columns->along, rank) + k;
        for (int i = 0; i < columns->N - 1; i++)
            to[i * columns->stride] = kind < 0 ? 0 : at->slope[kind][rank][i];
    }
}

// Entries of all columns by an input, but for the bends of the gait.
static void find_row(const fp_gait *at, int input, double *row)
{
    const fp_columns *columns = &at->columns;
    const double *of_body = body_row(columns, &columns->gradient, input);
    const int kind = kind_of(at, input);
    for (int k = 0; k < columns->n; k++)
        row[k] = of_body ? of_body[k] : 0;
    for (int rank = 0; rank < FP_RANKS && kind >= 0; rank++) {
        const double *slope = at->slope[kind][rank], *on = joint_rows(&columns->gradient, rank);
        for (int i = 0; i < columns->N - 1; i++)
            for (int k = 0; k < columns->n; k++)
                row[k] += slope[i] * on[i * columns->stride + k];
    }
}

static void add_gait_bends(const fp_gait *at, int n, const int *column, double *out)
{
    double second[GAIT_PAIRS];
    moray_reference_hessian(&at->gait, at->on_joints[0], at->on_joints[1], at->on_joints[2], second);
    for (int k = 0; k < n; k++) {
        const int kind = kind_of(at, column[k]);
        for (int other = 0; other < GAIT_INPUTS && kind >= 0 && kind < GAIT_INPUTS; other++) {
            const int large = kind > other ? kind : other, small = kind > other ? other : kind;
            if (at->place[other] >= 0)
                out[at->place[other] * n + k] += second[large * (large + 1) / 2 + small];
        }
    }
}

void moray_fp_gait_columns(fp_gait *at, const double *weight, int n, const int *column, double *out)
{
    const fp_setting *of = at->of;
    const fp_weights weights = weights_of(of, weight);
    const fp_point point = {&of->robot, of->spec.current, &at->motion, at->links, at->ddtheta,
                            at->u,      &weights,         at->dual};
    const int n_in = of->size.nx + of->size.nu + of->size.ns + 1;
    moray_fp_gait_gradient(at, weight, out);
    for (int kind = 0; kind < GAIT_KINDS; kind++)
        moray_reference_tangent(&at->gait, kind, at->slope[kind][0], at->slope[kind][1], at->slope[kind][2]);
    at->columns.n = n;
    for (int k = 0; k < n; k++)
        set_direction(at, column[k], k);
    moray_fp_columns_find(&at->columns, &point);
    for (int input = 0; input < n_in; input++)
        find_row(at, input, out + input * n);
    add_gait_bends(at, n, column, out);
}
