// SPDX-License-Identifier: MIT
#include "snake/plant/fp_gait.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/lanes.h"

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
    if (!moray_fp_accelerations_d(robot, at->of->spec.current, &at->motion, at->links, &at->balance, at->ddtheta,
                                  at->ddp))
        at->ddp[0] = at->ddp[1] = NAN;
    at->power = moray_fp_torques_d(robot, &at->motion, at->links, at->ddtheta, at->u);
}

// ---- Gradient ------------------------------------------------------------------------------------------------------

// From that by the joints' motion.
static void pull_input(fp_gait *at, fp_vector_d by_velocity, double *gradient)
{
    const moray_plant_size *size = &at->of->size;
    double by[GAIT_KINDS];
    moray_reference_gradient(&at->gait, at->on_joints[0], at->on_joints[1], at->on_joints[2], by);
    memset(gradient, 0, (size_t)(size->nx + size->nu + size->ns + 1) * sizeof *gradient);
    for (int kind = 0; kind < GAIT_KINDS; kind++)
        if (at->place[kind] >= 0)
            gradient[at->place[kind]] = by[kind];
    gradient[MORAY_STATE_THETA] = at->on_mean[0];
    gradient[MORAY_STATE_V_THETA] = at->on_mean[1];
    gradient[MORAY_STATE_V_1] = by_velocity.x;
    gradient[MORAY_STATE_V_2] = by_velocity.y;
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

// By the links' motion; returns that by the velocity.
static fp_vector_d find_gradient(fp_gait *at, const double *weight)
{
    const fp_setting *of = at->of;
    const int N = of->spec.robot.links;
    const double *on_angles = weight + of->size.nx + of->size.nc - N;
    const fp_weights weights = weights_of(of, weight);
    fp_gradient_d by = {at->on_links[0], at->on_links[1], at->on_links[2], 0, 0};
    moray_fp_adjoint_d(&of->robot, of->spec.current, &at->motion, at->links, &at->balance, at->ddtheta, at->u, &weights,
                       at->dual, &by);
    for (int i = 0; i < N && of->spec.path_angles; i++)
        by.theta[i] += on_angles[i];
    for (int rank = 0; rank < FP_RANKS; rank++)
        at->on_mean[rank] = moray_fp_pull_angles_d(N, at->on_links[rank], at->on_joints[rank]);
    return (fp_vector_d){by.v_x, by.v_y};
}

void moray_fp_gait_gradient(fp_gait *at, const double *weight, double *gradient)
{
    pull_input(at, find_gradient(at, weight), gradient);
}

void moray_fp_gait_angle_gradient(fp_gait *at, int i, double *gradient)
{
    const int N = at->of->spec.robot.links;
    for (int rank = 1; rank < FP_RANKS; rank++) {
        memset(at->on_joints[rank], 0, (size_t)N * sizeof(double));
        at->on_mean[rank] = 0;
    }
    memset(at->on_links[0], 0, (size_t)N * sizeof(double));
    at->on_links[0][i] = 1;
    at->on_mean[0] = moray_fp_pull_angles_d(N, at->on_links[0], at->on_joints[0]);
    pull_input(at, (fp_vector_d){0, 0}, gradient);
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

static void set_direction(fp_gait *at, int input, int kind, int k)
{
    fp_columns *columns = &at->columns;
    double *const rows[] = {columns->along.mean, columns->along.v_mean, columns->along.v,
                            columns->along.v + columns->stride};
    for (int i = 0; i < 4; i++)
        rows[i][k] = rows[i] == body_row(columns, &columns->along, input);
    for (int rank = 0; rank < FP_RANKS; rank++) {
        double *to = joint_rows(&columns->along, rank) + k;
        for (int i = 0; i < columns->N - 1; i++)
            to[i * columns->stride] = kind < 0 ? 0 : at->slope[kind][rank][i];
    }
}

// Adds the products of slopes with FP_LANES columns.
FOR_EACH_PROCESSOR
static void add_products(int n, int stride, const double *slope, const double *on, double *sum)
{
    double own[FP_LANES] = {0};
    for (int i = 0; i < n; i++)
        for (int j = 0; j < FP_LANES; j++)
            own[j] += slope[i] * on[i * stride + j];
    for (int j = 0; j < FP_LANES; j++)
        sum[j] += own[j];
}

// Entries of all columns by an input, of that kind, but for the bends of the gait.
static void find_row(const fp_gait *at, int input, int kind, double *row)
{
    const fp_columns *columns = &at->columns;
    const double *of_body = body_row(columns, &columns->gradient, input);
    for (int first = 0; first < columns->n; first += FP_LANES) {
        double sum[FP_LANES] = {0};
        for (int rank = 0; rank < FP_RANKS && kind >= 0; rank++)
            add_products(columns->N - 1, columns->stride, at->slope[kind][rank],
                         joint_rows(&columns->gradient, rank) + first, sum);
        for (int j = 0; j < FP_LANES && first + j < columns->n; j++)
            row[first + j] = of_body ? of_body[first + j] : sum[j];
    }
}

static void add_gait_bends(const fp_gait *at, int n, const int *kind, double *out)
{
    double second[GAIT_PAIRS];
    moray_reference_hessian(&at->gait, at->on_joints[0], at->on_joints[1], at->on_joints[2], second);
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++) {
            const int large = kind[i] > kind[j] ? kind[i] : kind[j], small = kind[i] > kind[j] ? kind[j] : kind[i];
            if (small >= 0 && large < GAIT_INPUTS)
                out[i * n + j] += second[large * (large + 1) / 2 + small];
        }
}

void moray_fp_gait_hessian(fp_gait *at, const double *weight, int n, const int *input, double *out)
{
    const fp_setting *of = at->of;
    const fp_weights weights = weights_of(of, weight);
    const fp_point point = {&of->robot, of->spec.current, &at->motion, at->links, &at->balance, at->ddtheta,
                            at->u,      &weights,         at->dual};
    int kind[MORAY_BODY_STATES + GAIT_KINDS];
    at->columns.n = n;
    for (int k = 0; k < n; k++) {
        const int own = kind[k] = kind_of(at, input[k]);
        if (own >= 0)
            moray_reference_tangent(&at->gait, own, at->slope[own][0], at->slope[own][1], at->slope[own][2]);
        set_direction(at, input[k], own, k);
    }
    find_gradient(at, weight);
    moray_fp_columns_find(&at->columns, &point);
    for (int k = 0; k < n; k++)
        find_row(at, input[k], kind[k], out + k * n);
    add_gait_bends(at, n, kind, out);
}
