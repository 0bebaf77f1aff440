// SPDX-License-Identifier: MIT
//
// The first-principles model with its joints on the gait, as a map: six states, or eight with a moving offset; rows of
// the Jacobian by the adjoint, the Hessian by how that moves.
#include "snake/plant/fp_gait.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "snake/plant/fp_free.h"
#include "snake/plant/series.h"
#include "snake/plant/water.h"

enum { body = MORAY_BODY_STATES, most_inputs = 13 };

typedef struct fp_plant {
    fp_setting of;
    fp_gait at;
    fp_part *part;
    double *rows, *weight; // of the Jacobian, n_out x n_in; n_out
    int n_in, n_out;
    moray_pattern jac, hess; // the latter by columns
    bool held[most_inputs];
    double bends[most_inputs * most_inputs]; // of the Hessian, what is asked for
} fp_plant;

static void value(void *self, const double *in, double *out)
{
    fp_plant *plant = self;
    fp_gait *at = &plant->at;
    const moray_plant_spec *spec = &plant->of.spec;
    const int N = spec->robot.links;
    double mean = 0;
    moray_fp_gait_move(at, in);
    for (int i = 0; i < N; i++)
        mean += at->ddtheta[i] / N;
    memcpy(out, in + MORAY_STATE_V_THETA, 3 * sizeof *out);
    out[MORAY_STATE_V_THETA] = mean;
    out[MORAY_STATE_V_1] = at->ddp[0];
    out[MORAY_STATE_V_2] = at->ddp[1];
    if (spec->joints == MORAY_JOINTS_STEERED)
        memcpy(out + body, in + body + 1, 2 * sizeof *out);
    out += plant->of.size.nx;
    for (int i = 0; i < N - 1 && spec->path_forces; i++)
        *out++ = at->u[i];
    if (spec->path_supply) {
        moray_fp_supply_d(&plant->of.robot, &at->motion, at->u, out);
        out += spec->robot.motor.lines * (N - 1);
    }
    for (int i = 0; i < N && spec->path_angles; i++)
        *out++ = at->theta[i] - in[MORAY_STATE_THETA];
    *out = at->power;
}

// The input that an output of the state is; -1: none.
static int input_of(const fp_plant *plant, int output)
{
    if (output < MORAY_STATE_V_THETA)
        return MORAY_STATE_V_THETA + output;
    return output >= body && output < plant->of.size.nx ? output + 1 : -1;
}

static void jacobian_row(fp_plant *plant, int output, double *row)
{
    const moray_plant_spec *spec = &plant->of.spec;
    const int input = input_of(plant, output);
    const int angles = plant->n_out - 1 - (spec->path_angles ? spec->robot.links : 0);
    if (input >= 0) {
        row[input] = 1;
    } else if (output >= angles && output < plant->n_out - 1) {
        moray_fp_gait_angle_gradient(&plant->at, output - angles, row);
    } else {
        plant->weight[output] = 1;
        moray_fp_gait_gradient(&plant->at, plant->weight, row);
        plant->weight[output] = 0;
    }
}

static void find_rows(fp_plant *plant, const double *in)
{
    moray_fp_gait_move(&plant->at, in);
    for (int output = 0; output < plant->n_out; output++)
        jacobian_row(plant, output, plant->rows + output * plant->n_in);
}

static void jacobian(void *self, const double *in, double *values)
{
    fp_plant *plant = self;
    const int n_in = plant->n_in;
    const moray_pattern *pattern = &plant->jac;
    find_rows(plant, in);
    for (int k = 0; k < pattern->nnz; k++)
        values[k] = plant->rows[pattern->row[k] * n_in + pattern->col[k]];
}

// Inputs that entries of the Hessian belong to that are asked for, into input; their places there.
static int bent_inputs(const fp_plant *plant, int *input, int *place)
{
    int n = 0;
    for (int i = 0; i < plant->n_in; i++)
        place[i] = -1;
    for (int k = 0; k < plant->hess.nnz; k++)
        place[plant->hess.row[k]] = place[plant->hess.col[k]] = 0;
    for (int i = 0; i < plant->n_in; i++)
        if (place[i] == 0 && !plant->held[i]) {
            place[i] = n;
            input[n++] = i;
        }
    return n;
}

static void hessian(void *self, const double *in, const double *weight, double *values)
{
    fp_plant *plant = self;
    const moray_pattern *pattern = &plant->hess;
    int input[most_inputs], place[most_inputs];
    const int n = bent_inputs(plant, input, place);
    moray_fp_gait_move(&plant->at, in);
    moray_fp_gait_hessian(&plant->at, weight, n, input, plant->bends);
    for (int k = 0; k < pattern->nnz; k++) {
        const int row = pattern->row[k], col = pattern->col[k];
        values[k] = plant->held[row] || plant->held[col] ? 0 : plant->bends[place[row] * n + place[col]];
    }
}

static void hold(void *self, const bool *held)
{
    fp_plant *plant = self;
    for (int j = 0; j < plant->n_in; j++)
        plant->held[j] = held && held[j];
}

// ---- Patterns ------------------------------------------------------------------------------------------------------

// A swimming robot in the middle of a stroke, no number of which is below 0, and others, quasi-random, up to half of
// 1 + it away.
static void probe(const moray_plant_spec *spec, int n_in, int k, double *in)
{
    const double speed = spec->robot.l, state[body] = {0.1, 0, 0, 0.2, speed, 0.3 * speed};
    const double on_gait[] = {0.2, 2, 0.7, 0.01, 0.1, 0.4}, steered[] = {0.01, 0.003, 0.002, 0.2, 2, 0.7, 0.4};
    memcpy(in, state, sizeof state);
    if (spec->joints == MORAY_JOINTS_STEERED)
        memcpy(in + body, steered, sizeof steered);
    else
        memcpy(in + body, on_gait, sizeof on_gait);
    for (int j = 0; j < n_in && k > 0; j++)
        in[j] += 0.5 * (2 * fmod(0.618033988749895 * (j + 1) * k, 1) - 1) * (1 + in[j]);
}

static void mark(fp_plant *plant, const double *in, const double *weight, bool *slopes, bool *bends)
{
    const int n_in = plant->n_in;
    const int angles = plant->n_out - 1 - (plant->of.spec.path_angles ? plant->of.spec.robot.links : 0);
    int all[most_inputs];
    find_rows(plant, in);
    for (int e = 0; e < plant->n_out * n_in; e++) {
        const int row = e / n_in;
        const bool no_heading = row >= angles && row < plant->n_out - 1 && e % n_in == MORAY_STATE_THETA;
        slopes[e] = slopes[e] || (plant->rows[e] != 0 && !no_heading);
    }
    for (int col = 0; col < n_in; col++)
        all[col] = col;
    moray_fp_gait_hessian(&plant->at, weight, n_in, all, plant->bends);
    for (int col = 0; col < n_in; col++)
        for (int row = col; row < n_in; row++)
            bends[col * n_in + row] = bends[col * n_in + row] || plant->bends[row * n_in + col] != 0;
}

// Entries of marks[outer][inner]; `outer` are the columns or the rows.
static moray_status list(const bool *marks, int outer, int inner, bool columns, moray_pattern *pattern)
{
    int n = 0;
    for (int e = 0; e < outer * inner; e++)
        n += marks[e];
    MORAY_TRY(moray_pattern_new(pattern, n));
    for (int e = 0, k = 0; e < outer * inner; e++) {
        if (!marks[e])
            continue;
        pattern->row[k] = columns ? e % inner : e / inner;
        pattern->col[k++] = columns ? e / inner : e % inner;
    }
    return moray_ok();
}

// What is not zero at any of the points; what the structure makes zero is so to the last bit.
static moray_status find_patterns(fp_plant *plant)
{
    enum { points = 9 };
    const int n_in = plant->n_in, n_out = plant->n_out;
    bool *slopes = calloc((size_t)((n_in + n_out) * n_in), sizeof *slopes),
         *bends = slopes ? slopes + n_out * n_in : NULL;
    double in[most_inputs], *weight = calloc((size_t)n_out, sizeof *weight);
    moray_status status = moray_ok();
    if (!slopes || !weight)
        status = moray_error(MORAY_MEMORY, "no memory for the patterns of %d outputs", n_out);
    for (int k = 0; k < points && !moray_failed(status); k++) {
        probe(&plant->of.spec, n_in, k, in);
        for (int i = 0; i < n_out; i++)
            weight[i] = 0.5 + fmod(0.618033988749895 * (i + 1) * (k + 1), 1);
        mark(plant, in, weight, slopes, bends);
    }
    if (!moray_failed(status))
        status = list(slopes, n_out, n_in, false, &plant->jac);
    if (!moray_failed(status))
        status = list(bends, n_in, n_in, true, &plant->hess);
    free(slopes);
    free(weight);
    return status;
}

// ---- Construction

static void plant_free(fp_plant *plant)
{
    if (!plant)
        return;
    moray_pattern_free(&plant->jac);
    moray_pattern_free(&plant->hess);
    moray_fp_gait_free(&plant->at);
    free(plant->part);
    free(plant->rows);
    free(plant);
}

static void release(moray_map *map)
{
    plant_free(map->self);
}

static moray_status plant_new(fp_plant **result, const moray_plant_spec *spec)
{
    fp_plant *plant = calloc(1, sizeof *plant);
    if (plant)
        plant->part = calloc((size_t)moray_fp_parts(&spec->robot), sizeof *plant->part);
    bool made = plant && plant->part;
    if (made) {
        plant->of = (fp_setting){*spec, moray_fp_robot_of(&spec->robot, plant->part), moray_plant_sizes(spec)};
        made = !moray_failed(moray_fp_gait_new(&plant->at, &plant->of, most_inputs));
        const moray_plant_size *size = &plant->of.size;
        plant->n_in = size->nx + size->nu + size->ns + 1;
        plant->n_out = size->nx + size->nc + 1;
        const size_t n_out = (size_t)plant->n_out;
        plant->rows = calloc(n_out * (most_inputs + 1), sizeof *plant->rows);
        plant->weight = plant->rows ? plant->rows + n_out * most_inputs : NULL;
    }
    if (!made || !plant->rows) {
        plant_free(plant);
        return moray_error(MORAY_MEMORY, "no memory for a plant of %d links", spec->robot.links);
    }
    *result = plant;
    return moray_ok();
}

moray_status moray_fp_plant(moray_map *map, const moray_plant_spec *spec)
{
    fp_plant *plant = NULL;
    *map = (moray_map){0};
    MORAY_TRY(moray_plant_check(spec, true));
    if (spec->water)
        return moray_water_plant(map, spec, true, moray_fp_plant);
    if (spec->joints == MORAY_JOINTS_SERIES)
        return moray_plant_series(map, spec, moray_fp_plant);
    if (spec->joints == MORAY_JOINTS_FREE)
        return moray_fp_free_plant(map, spec);
    if (spec->joints == MORAY_JOINTS_CLOSED_LOOP)
        return moray_error(MORAY_INPUT, "joints: the first-principles plant has none in closed loop");
    MORAY_TRY(plant_new(&plant, spec));
    const moray_status status = find_patterns(plant);
    if (moray_failed(status)) {
        plant_free(plant);
        return status;
    }
    *map = (moray_map){.n_in = plant->n_in,
                       .n_out = plant->n_out,
                       .jac = plant->jac,
                       .hess = plant->hess,
                       .self = plant,
                       .value = value,
                       .jacobian = jacobian,
                       .hessian = hessian,
                       .hold = hold,
                       .release = release};
    return moray_ok();
}
