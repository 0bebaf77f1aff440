// SPDX-License-Identifier: MIT
//
// The first-principles model with free joint accelerations, as a map: rows of the Jacobian by the adjoint, the Hessian
// by complex step through it. The input is [phi, mean angle, p_x, p_y, their rates, ubar, t]; the position and t move
// nothing, and all is linear in ubar.
#include "snake/plant/fp_free.h"

#include <stdlib.h>
#include <string.h>
#include <tgmath.h>

#include "snake/model/fp_adjoint.h"

typedef double complex num;

typedef struct free_plant {
    moray_plant_spec spec;
    fp_robot robot;
    moray_plant_size size;
    int N, n, n_in, ubar;                   // links, joints, inputs, place of ubar
    num *in, *gradient;                     // n_in each, in one block with the next
    num *theta, *dtheta, *ddtheta, *u;      // N or N-1 each
    num *on_theta, *on_dtheta, *on_ddtheta; // derivatives of a weighted sum
    num *by_phi, *by_v_phi, *by_ubar;       // within gradient
    double *weight;                         // [n_out]
    fp_link_z *links;
    fp_dual_link *dual;
    fp_motion_z motion;
    num ddp[2], power;
} free_plant;

// Motion of the links at plant->in, their accelerations, torques and power.
static void move(free_plant *plant)
{
    const fp_robot *robot = &plant->robot;
    const int N = plant->N, n = plant->n;
    const num *in = plant->in, *rates = in + n + 3;
    moray_fp_angles_z(N, in[n], in, plant->theta);
    moray_fp_angles_z(N, rates[n], rates, plant->dtheta);
    plant->motion = (fp_motion_z){plant->theta, plant->dtheta, rates[n + 1], rates[n + 2], in + plant->ubar};
    if (!moray_fp_accelerations_z(robot, plant->spec.current, &plant->motion, plant->links, plant->ddtheta, plant->ddp))
        plant->ddp[0] = plant->ddp[1] = NAN;
    plant->power = moray_fp_torques_z(robot, &plant->motion, plant->links, plant->ddtheta, plant->u);
}

static void move_to(free_plant *plant, const double *in)
{
    for (int i = 0; i < plant->n_in; i++)
        plant->in[i] = in[i];
    move(plant);
}

static void value(void *self, const double *in, double *out)
{
    free_plant *plant = self;
    const int N = plant->N, n = plant->n;
    move_to(plant, in);
    memcpy(out, in + n + 3, (size_t)(n + 3) * sizeof *out);
    out += n + 3;
    memcpy(out, in + plant->ubar, (size_t)n * sizeof *out);
    out += n;
    *out = 0;
    for (int i = 0; i < N; i++)
        *out += creal(plant->ddtheta[i]) / N;
    out[1] = creal(plant->ddp[0]);
    out[2] = creal(plant->ddp[1]);
    out += 3;
    for (int i = 0; i < n && plant->spec.path_forces; i++)
        *out++ = creal(plant->u[i]);
    for (int i = 0; i < N && plant->spec.path_angles; i++)
        *out++ = creal(plant->theta[i]) - in[n];
    *out = creal(plant->power);
}

// Gradient of weight . out, but for the rows that are linear, after move.
static void find_gradient(free_plant *plant, const double *weight)
{
    const int N = plant->N, n = plant->n;
    num *gradient = plant->gradient;
    const fp_weights weights = {weight + 2 * n + 3, plant->spec.path_forces ? weight + plant->size.nx : NULL,
                                weight[plant->size.nx + plant->size.nc]};
    fp_gradient by = {plant->on_theta, plant->on_dtheta, plant->on_ddtheta, 0, 0};
    moray_fp_adjoint(&plant->robot, plant->spec.current, &plant->motion, plant->links, plant->ddtheta, plant->u,
                     &weights, plant->dual, &by);
    gradient[n] = moray_fp_pull_angles(N, by.theta, plant->by_phi);
    gradient[2 * n + 3] = moray_fp_pull_angles(N, by.dtheta, plant->by_v_phi);
    gradient[2 * n + 4] = by.v_x;
    gradient[2 * n + 5] = by.v_y;
    moray_fp_pull_angles(N, by.ddtheta, plant->by_ubar);
}

static bool is_position(const free_plant *plant, int input)
{
    return input == plant->n + 1 || input == plant->n + 2;
}

// ---- Jacobian: rows of the state, then those that depend on everything, with the link angles among them -------------

// Writes entries of rows that are full; returns the place behind them.
static double *full_row(free_plant *plant, int row, double *values)
{
    plant->weight[row] = 1;
    find_gradient(plant, plant->weight);
    plant->weight[row] = 0;
    for (int i = 0; i < plant->n_in - 1; i++)
        if (!is_position(plant, i))
            *values++ = creal(plant->gradient[i]);
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
    const int N = plant->N, n = plant->n, nx = plant->size.nx;
    move_to(plant, in);
    for (int i = 0; i < nx - 3; i++)
        *values++ = 1;
    for (int row = nx - 3; row < nx + (plant->spec.path_forces ? n : 0); row++)
        values = full_row(plant, row, values);
    for (int i = 0; i < N && plant->spec.path_angles; i++)
        for (int j = 0; j < n; j++)
            *values++ = angle_by_joint(N, i, j);
    full_row(plant, nx + plant->size.nc, values);
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
    for (int i = 0; i < plant->n_in - 1; i++)
        if (!is_position(plant, i))
            at = put(pattern, at, row, i);
    return at;
}

// Returns the number of entries, which it lists unless the pattern is empty.
static int jacobian_pattern(const free_plant *plant, moray_pattern *pattern)
{
    const int N = plant->N, n = plant->n, nx = plant->size.nx, angles = nx + (plant->spec.path_forces ? n : 0);
    int at = 0;
    for (int i = 0; i < nx - 3; i++) // (phi, mean, p)' and v_phi'
        at = put(pattern, at, i, n + 3 + i);
    for (int row = nx - 3; row < angles; row++)
        at = put_full_row(plant, pattern, at, row);
    for (int i = 0; i < N && plant->spec.path_angles; i++)
        for (int j = 0; j < n; j++)
            at = put(pattern, at, angles + i, j);
    return put_full_row(plant, pattern, at, nx + plant->size.nc);
}

// ---- Hessian: by columns, those of all that is not ubar ------------------------------------------------------------

static void hessian(void *self, const double *in, const double *weight, double *values)
{
    free_plant *plant = self;
    const double step = 1e-50;
    for (int col = 0; col < plant->ubar; col++) {
        if (is_position(plant, col))
            continue;
        for (int i = 0; i < plant->n_in; i++)
            plant->in[i] = in[i];
        plant->in[col] += step * I;
        move(plant);
        find_gradient(plant, weight);
        for (int row = col; row < plant->n_in - 1; row++)
            if (!is_position(plant, row))
                *values++ = cimag(plant->gradient[row]) / step;
    }
}

static int hessian_pattern(const free_plant *plant, moray_pattern *pattern)
{
    int at = 0;
    for (int col = 0; col < plant->ubar; col++)
        for (int row = col; row < plant->n_in - 1; row++)
            if (!is_position(plant, row) && !is_position(plant, col))
                at = put(pattern, at, row, col);
    return at;
}

// ---- Construction --------------------------------------------------------------------------------------------------

static void moray_plant_free(free_plant *plant)
{
    if (!plant)
        return;
    free(plant->in);
    free(plant->weight);
    free(plant->links);
    free(plant->dual);
    free(plant);
}

static void release(moray_map *map)
{
    moray_pattern_free(&map->jac);
    moray_pattern_free(&map->hess);
    moray_plant_free(map->self);
}

static free_plant *plant_new(const moray_plant_spec *spec)
{
    free_plant *plant = calloc(1, sizeof *plant);
    if (!plant)
        return NULL;
    const int N = spec->robot.links, n = N - 1;
    *plant = (free_plant){.spec = *spec,
                          .robot = moray_fp_robot_of(&spec->robot),
                          .size = moray_plant_sizes(spec),
                          .N = N,
                          .n = n,
                          .ubar = 2 * n + 6};
    plant->n_in = plant->size.nx + plant->size.nu + 1;
    plant->in = calloc((size_t)(2 * plant->n_in + 7 * N), sizeof *plant->in);
    plant->weight = calloc((size_t)(plant->size.nx + plant->size.nc + 1), sizeof *plant->weight);
    plant->links = calloc((size_t)N, sizeof *plant->links);
    plant->dual = calloc((size_t)N, sizeof *plant->dual);
    if (!plant->in || !plant->weight || !plant->links || !plant->dual) {
        moray_plant_free(plant);
        return NULL;
    }
    plant->gradient = plant->in + plant->n_in;
    plant->by_phi = plant->gradient;
    plant->by_v_phi = plant->gradient + n + 3;
    plant->by_ubar = plant->gradient + plant->ubar;
    num **parts[] = {&plant->theta,    &plant->dtheta,    &plant->ddtheta,   &plant->u,
                     &plant->on_theta, &plant->on_dtheta, &plant->on_ddtheta};
    for (size_t i = 0; i < sizeof parts / sizeof *parts; i++)
        *parts[i] = plant->gradient + plant->n_in + i * (size_t)N;
    return plant;
}

moray_status moray_fp_free_plant(moray_map *map, const moray_plant_spec *spec)
{
    moray_pattern none = {0};
    free_plant *plant = plant_new(spec);
    if (!plant)
        return moray_error(MORAY_MEMORY, "no memory for a plant of %d links", spec->robot.links);
    *map = (moray_map){.n_in = plant->n_in,
                       .n_out = plant->size.nx + plant->size.nc + 1,
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
