// SPDX-License-Identifier: MIT
//
// The first-principles model with free joint accelerations, as a map: rows of the Jacobian by the adjoint, the Hessian
// by complex step through it. The position and t move nothing, and all but the power of motors is linear in ubar.
#include "snake/plant/fp_free.h"

#include <stdlib.h>
#include <string.h>
#include <tgmath.h>

#include "snake/model/fp_adjoint.h"

typedef struct free_setting {
    moray_plant_spec spec;
    fp_robot robot;
    moray_plant_size size;
    int N, n, n_in, ubar; // links, joints, inputs, place of ubar
    int full;             // path outputs that depend on everything, before the angles
    int curved;           // inputs that all is not linear in: before ubar; with motors ubar, too
} free_setting;

#define REAL double
#define TYPED(name) name##_d
#include "snake/plant/fp_free.inc"
#undef REAL
#undef TYPED

#define REAL double complex
#define TYPED(name) name##_z
#include "snake/plant/fp_free.inc"
#undef REAL
#undef TYPED

typedef struct free_plant {
    free_setting of;
    fp_free_d real;
    fp_free_z stepped;
    fp_part *part;
    double *weight; // [n_out]
} free_plant;

static void value(void *self, const double *in, double *out)
{
    free_plant *plant = self;
    const free_setting *of = &plant->of;
    fp_free_d *at = &plant->real;
    const int N = of->N, n = of->n;
    memcpy(at->in, in, (size_t)of->n_in * sizeof *in);
    move_d(at);
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
    find_gradient_d(&plant->real, plant->weight);
    plant->weight[row] = 0;
    for (int i = 0; i < plant->of.n_in - 1; i++)
        if (!is_position(plant, i))
            *values++ = plant->real.gradient[i];
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
    memcpy(plant->real.in, in, (size_t)plant->of.n_in * sizeof *in);
    move_d(&plant->real);
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

static void hessian(void *self, const double *in, const double *weight, double *values)
{
    const free_plant *plant = self;
    fp_free_z *at = &((free_plant *)self)->stepped;
    const double step = 1e-50;
    for (int col = 0; col < plant->of.curved; col++) {
        if (is_position(plant, col))
            continue;
        for (int i = 0; i < plant->of.n_in; i++)
            at->in[i] = in[i];
        at->in[col] += step * I;
        move_z(at);
        find_gradient_z(at, weight);
        for (int row = col; row < plant->of.n_in - 1; row++)
            if (!is_position(plant, row))
                *values++ = cimag(at->gradient[row]) / step;
    }
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
    free_free_d(&plant->real);
    free_free_z(&plant->stepped);
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
    if (free_new_d(&plant->real, &plant->of) && free_new_z(&plant->stepped, &plant->of) && plant->weight)
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
