// SPDX-License-Identifier: MIT
//
// The first-principles model with free joint accelerations, as a map: rows of the Jacobian by the adjoint, the Hessian
// by how that moves. The position and t move nothing, and all but the power of motors is linear in ubar.
#include "snake/plant/fp_free.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "snake/plant/fp_columns.h"

typedef struct free_setting {
    moray_plant_spec spec;
    fp_robot robot;
    moray_plant_size size;
    int N, n, n_in, ubar; // links, joints, inputs, place of ubar
    int full;             // path outputs that depend on everything, before the angles
    int curved;           // inputs that all is not linear in: before ubar; with motors ubar, too
} free_setting;

typedef struct fp_free {
    const free_setting *of;
    double *in, *gradient;                     // n_in each, in one block with the next
    double *theta, *dtheta, *ddtheta, *u;      // N or N-1 each
    double *on_theta, *on_dtheta, *on_ddtheta; // derivatives of a weighted sum
    fp_link_d *links;
    fp_dual_link_d *dual;
    fp_motion_d motion;
    fp_balance_d balance;
    double ddp[2], power;
} fp_free;

static bool free_new(fp_free *at, const free_setting *of)
{
    double **parts[] = {&at->theta, &at->dtheta, &at->ddtheta, &at->u, &at->on_theta, &at->on_dtheta, &at->on_ddtheta};
    const size_t N = (size_t)of->N, n_in = (size_t)of->n_in, n = sizeof parts / sizeof *parts;
    at->of = of;
    at->in = calloc(2 * n_in + n * N, sizeof *at->in);
    at->links = calloc(N, sizeof *at->links);
    at->dual = calloc(N, sizeof *at->dual);
    if (!at->in || !at->links || !at->dual)
        return false;
    at->gradient = at->in + n_in;
    for (size_t i = 0; i < n; i++)
        *parts[i] = at->gradient + n_in + i * N;
    return true;
}

static void free_free(fp_free *at)
{
    free(at->in);
    free(at->links);
    free(at->dual);
}

// Motion of the links at at->in, their accelerations, torques and power.
static void move(fp_free *at)
{
    const free_setting *of = at->of;
    const fp_robot *robot = &of->robot;
    const int N = of->N, n = of->n;
    const double *in = at->in, *rates = in + n + 3;
    moray_fp_angles_d(N, in[n], in, at->theta);
    moray_fp_angles_d(N, rates[n], rates, at->dtheta);
    at->motion = (fp_motion_d){at->theta, at->dtheta, rates[n + 1], rates[n + 2], in + of->ubar};
    if (!moray_fp_accelerations_d(robot, of->spec.current, &at->motion, at->links, &at->balance, at->ddtheta, at->ddp))
        at->ddp[0] = at->ddp[1] = NAN;
    at->power = moray_fp_torques_d(robot, &at->motion, at->links, at->ddtheta, at->u);
}

static fp_weights weights_of(const free_setting *of, const double *weight)
{
    const double *path = weight + of->size.nx;
    return (fp_weights){.lambda = weight + 2 * of->n + 3,
                        .rho = of->spec.path_forces ? path : NULL,
                        .sigma = of->spec.path_supply ? path + (of->spec.path_forces ? of->n : 0) : NULL,
                        .pi = path[of->size.nc]};
}

// Gradient of weight . out, but for the rows that are linear, after move.
static void find_gradient(fp_free *at, const double *weight)
{
    const free_setting *of = at->of;
    const int N = of->N, n = of->n;
    double *gradient = at->gradient;
    const fp_weights weights = weights_of(of, weight);
    fp_gradient_d by = {at->on_theta, at->on_dtheta, at->on_ddtheta, 0, 0};
    moray_fp_adjoint_d(&of->robot, of->spec.current, &at->motion, at->links, &at->balance, at->ddtheta, at->u, &weights,
                       at->dual, &by);
    gradient[n] = moray_fp_pull_angles_d(N, by.theta, gradient);
    gradient[2 * n + 3] = moray_fp_pull_angles_d(N, by.dtheta, gradient + n + 3);
    gradient[2 * n + 4] = by.v_x;
    gradient[2 * n + 5] = by.v_y;
    moray_fp_pull_angles_d(N, by.ddtheta, gradient + of->ubar);
}

typedef struct free_plant {
    free_setting of;
    fp_free at;
    fp_columns columns;
    int *column; // [columns.n]: the inputs that they are of
    fp_part *part;
    double *weight; // [n_out]
} free_plant;

static void value(void *self, const double *in, double *out)
{
    free_plant *plant = self;
    const free_setting *of = &plant->of;
    fp_free *at = &plant->at;
    const int N = of->N, n = of->n;
    memcpy(at->in, in, (size_t)of->n_in * sizeof *in);
    move(at);
    memcpy(out, in + n + 3, (size_t)(n + 3) * sizeof *out);
    out += n + 3;
    memcpy(out, in + of->ubar, (size_t)n * sizeof *out);
    out += n;
    *out = 0;
    for (int i = 0; i < N; i++)
        *out += at->ddtheta[i] / N;
    out[1] = at->ddp[0];
    out[2] = at->ddp[1];
    out += 3;
    for (int i = 0; i < n && of->spec.path_forces; i++)
        *out++ = at->u[i];
    if (of->spec.path_supply) {
        moray_fp_supply_d(&of->robot, &at->motion, at->u, out);
        out += of->spec.robot.motor.lines * n;
    }
    for (int i = 0; i < N && of->spec.path_angles; i++)
        *out++ = at->theta[i] - in[n];
    *out = at->power;
}

static bool is_position(const free_plant *plant, int input)
{
    return input == plant->of.n + 1 || input == plant->of.n + 2;
}

// ---- Jacobian: rows of the state, then those that depend on everything, with the link angles among them -------------

// Writes entries of rows that are full; returns the place behind them.
static double *full_row(free_plant *plant, int row, double *values)
{
    plant->weight[row] = 1;
    find_gradient(&plant->at, plant->weight);
    plant->weight[row] = 0;
    for (int i = 0; i < plant->of.n_in - 1; i++)
        if (!is_position(plant, i))
            *values++ = plant->at.gradient[i];
    return values;
}

// theta_i minus the mean, by phi_j
static double angle_by_joint(int N, int i, int j)
{
    return (N - 1.0 - j) / N - (j < i);
}

static void jacobian(void *self, const double *in, double *values)
{
    free_plant *plant = self;
    const int N = plant->of.N, n = plant->of.n, nx = plant->of.size.nx;
    memcpy(plant->at.in, in, (size_t)plant->of.n_in * sizeof *in);
    move(&plant->at);
    for (int i = 0; i < nx - 3; i++)
        *values++ = 1;
    for (int row = nx - 3; row < nx + plant->of.full; row++)
        values = full_row(plant, row, values);
    for (int i = 0; i < N && plant->of.spec.path_angles; i++)
        for (int j = 0; j < n; j++)
            *values++ = angle_by_joint(N, i, j);
    full_row(plant, nx + plant->of.size.nc, values);
}

static int put(moray_pattern *pattern, int at, int row, int col)
{
    if (pattern->row) {
        pattern->row[at] = row;
        pattern->col[at] = col;
    }
    return at + 1;
}

static int put_full_row(const free_plant *plant, moray_pattern *pattern, int at, int row)
{
    for (int i = 0; i < plant->of.n_in - 1; i++)
        if (!is_position(plant, i))
            at = put(pattern, at, row, i);
    return at;
}

// Returns the number of entries, which it lists unless the pattern is empty.
static int jacobian_pattern(const free_plant *plant, moray_pattern *pattern)
{
    const int N = plant->of.N, n = plant->of.n, nx = plant->of.size.nx, angles = nx + plant->of.full;
    int at = 0;
    for (int i = 0; i < nx - 3; i++) // (phi, mean, p)' and v_phi'
        at = put(pattern, at, i, n + 3 + i);
    for (int row = nx - 3; row < angles; row++)
        at = put_full_row(plant, pattern, at, row);
    for (int i = 0; i < N && plant->of.spec.path_angles; i++)
        for (int j = 0; j < n; j++)
            at = put(pattern, at, angles + i, j);
    return put_full_row(plant, pattern, at, nx + plant->of.size.nc);
}

// ---- Hessian: by columns, those of all that is not linear
// ------------------------------------------------------------

// Of an input, one entry a column.
static double *row_of(const free_plant *plant, const fp_joint_motion *motion, int input)
{
    const int n = plant->of.n, stride = plant->columns.stride;
    if (input >= plant->of.ubar)
        return motion->ubar + (input - plant->of.ubar) * stride;
    if (input >= 2 * n + 4)
        return motion->v + (input - 2 * n - 4) * stride;
    if (input >= n + 3)
        return input < 2 * n + 3 ? motion->v_phi + (input - n - 3) * stride : motion->v_mean;
    return input < n ? motion->phi + input * stride : motion->mean;
}

static void hessian(void *self, const double *in, const double *weight, double *values)
{
    free_plant *plant = self;
    const free_setting *of = &plant->of;
    fp_free *at = &plant->at;
    const fp_weights weights = weights_of(of, weight);
    const fp_point point = {&of->robot, of->spec.current, &at->motion, at->links, &at->balance, at->ddtheta,
                            at->u,      &weights,         at->dual};
    memcpy(at->in, in, (size_t)of->n_in * sizeof *in);
    move(at);
    find_gradient(at, weight);
    moray_fp_columns_find(&plant->columns, &point);
    for (int k = 0; k < plant->columns.n; k++)
        for (int row = plant->column[k]; row < of->n_in - 1; row++)
            if (!is_position(plant, row))
                *values++ = row_of(plant, &plant->columns.gradient, row)[k];
}

static int hessian_pattern(const free_plant *plant, moray_pattern *pattern)
{
    int at = 0;
    for (int col = 0; col < plant->of.curved; col++)
        for (int row = col; row < plant->of.n_in - 1; row++)
            if (!is_position(plant, row) && !is_position(plant, col))
                at = put(pattern, at, row, col);
    return at;
}

// ---- Construction --------------------------------------------------------------------------------------------------

static void plant_free(free_plant *plant)
{
    if (!plant)
        return;
    free_free(&plant->at);
    moray_fp_columns_free(&plant->columns);
    free(plant->column);
    free(plant->part);
    free(plant->weight);
    free(plant);
}

static void release(moray_map *map)
{
    moray_pattern_free(&map->jac);
    moray_pattern_free(&map->hess);
    plant_free(map->self);
}

// Along each input that not all is linear in.
static bool columns_new(free_plant *plant)
{
    fp_columns *columns = &plant->columns;
    plant->column = calloc((size_t)plant->of.curved, sizeof *plant->column);
    if (!plant->column || moray_failed(moray_fp_columns_new(columns, plant->of.N, plant->of.curved)))
        return false;
    for (int input = 0; input < plant->of.curved; input++) {
        if (is_position(plant, input))
            continue;
        row_of(plant, &columns->along, input)[columns->n] = 1;
        plant->column[columns->n++] = input;
    }
    return true;
}

static free_plant *plant_new(const moray_plant_spec *spec)
{
    free_plant *plant = calloc(1, sizeof *plant);
    if (!plant)
        return NULL;
    const int N = spec->robot.links, n = N - 1;
    const moray_plant_size size = moray_plant_sizes(spec);
    plant->part = calloc((size_t)moray_fp_parts(&spec->robot), sizeof *plant->part);
    if (!plant->part) {
        plant_free(plant);
        return NULL;
    }
    plant->of = (free_setting){.spec = *spec,
                               .robot = moray_fp_robot_of(&spec->robot, plant->part),
                               .size = size,
                               .N = N,
                               .n = n,
                               .n_in = size.nx + size.nu + 1,
                               .ubar = 2 * n + 6,
                               .curved = 2 * n + 6 + (spec->robot.motor.fitted ? n : 0),
                               .full = size.nc - (spec->path_angles ? N : 0)};
    plant->weight = calloc((size_t)(size.nx + size.nc + 1), sizeof *plant->weight);
    if (plant->weight && free_new(&plant->at, &plant->of) && columns_new(plant))
        return plant;
    plant_free(plant);
    return NULL;
}

moray_status moray_fp_free_plant(moray_map *map, const moray_plant_spec *spec)
{
    moray_pattern none = {0};
    free_plant *plant = plant_new(spec);
    if (!plant)
        return moray_error(MORAY_MEMORY, "no memory for a plant of %d links", spec->robot.links);
    *map = (moray_map){.n_in = plant->of.n_in,
                       .n_out = plant->of.size.nx + plant->of.size.nc + 1,
                       .self = plant,
                       .value = value,
                       .jacobian = jacobian,
                       .hessian = hessian,
                       .release = release};
    moray_status status = moray_pattern_new(&map->jac, jacobian_pattern(plant, &none));
    if (!moray_failed(status))
        status = moray_pattern_new(&map->hess, hessian_pattern(plant, &none));
    if (moray_failed(status)) {
        moray_map_release(map);
        return status;
    }
    jacobian_pattern(plant, &map->jac);
    hessian_pattern(plant, &map->hess);
    return status;
}
