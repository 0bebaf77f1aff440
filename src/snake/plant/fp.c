// SPDX-License-Identifier: MIT
//
// The first-principles model with its joints on the gait, as a map: six states, or eight with a moving offset; rows of
// the Jacobian by the adjoint, the Hessian by complex step through it.
#include "snake/model/fp_adjoint.h"

#include <stdlib.h>
#include <string.h>
#include <tgmath.h>

#include "snake/plant/fp_free.h"
#include "snake/plant/series.h"
#include "snake/model/circle.h"
#include "snake/model/taper.h"

enum { body = MORAY_BODY_STATES, most_inputs = 13 };
enum { anew = 16 }; // joints after which a recurrence of sines begins again

typedef struct fp_setting {
    moray_plant_spec spec;
    fp_robot robot;
    moray_plant_size size;
} fp_setting;

#define REAL double
#define TYPED(name) name##_d
#include "snake/plant/fp_gait.inc"
#undef REAL
#undef TYPED

#define REAL double complex
#define TYPED(name) name##_z
#include "snake/plant/fp_gait.inc"
#undef REAL
#undef TYPED

typedef struct fp_plant {
    fp_setting of;
    fp_gait_d real;
    fp_gait_z stepped;
    double *rows, *weight; // of the Jacobian, n_out x n_in; n_out
    moray_map by_step;     // patterns
} fp_plant;

static void value(void *self, const double *in, double *out)
{
    evaluate_d(&((fp_plant *)self)->real, in, out);
}

static void evaluate(void *self, const double complex *in, double complex *out)
{
    evaluate_z(&((fp_plant *)self)->stepped, in, out);
}

// Row i of the angles, less the heading: not to be asked for the derivative by it.
static void angle_row(fp_plant *plant, const double *in, int i, double *row)
{
    const size_t bytes = (size_t)plant->of.spec.robot.links * sizeof(double);
    fp_gait_d *at = &plant->real;
    const fp_gradient_d by = {at->on_theta, at->on_dtheta, at->on_ddtheta, 0, 0};
    memset(by.theta, 0, bytes);
    memset(by.dtheta, 0, bytes);
    memset(by.ddtheta, 0, bytes);
    by.theta[i] = 1;
    pull_input_d(at, in, &by, row);
}

// The input that an output of the state is; -1: none.
static int input_of(const fp_plant *plant, int output)
{
    if (output < MORAY_STATE_V_THETA)
        return MORAY_STATE_V_THETA + output;
    return output >= body && output < plant->of.size.nx ? output + 1 : -1;
}

static void jacobian_row(fp_plant *plant, const double *in, int output, double *row)
{
    const moray_plant_spec *spec = &plant->of.spec;
    const int input = input_of(plant, output);
    const int angles = plant->of.size.nx + (spec->path_forces ? spec->robot.links - 1 : 0);
    if (input >= 0) {
        row[input] = 1;
    } else if (output >= angles && output < plant->by_step.n_out - 1) {
        angle_row(plant, in, output - angles, row);
    } else {
        plant->weight[output] = 1;
        weighted_gradient_d(&plant->real, in, plant->weight, row);
        plant->weight[output] = 0;
    }
}

static void jacobian(void *self, const double *in, double *values)
{
    fp_plant *plant = self;
    const int n_in = plant->by_step.n_in, n_out = plant->by_step.n_out;
    const moray_pattern *pattern = &plant->by_step.jac;
    move_d(&plant->real, in);
    for (int output = 0; output < n_out; output++)
        jacobian_row(plant, in, output, plant->rows + output * n_in);
    for (int k = 0; k < pattern->nnz; k++)
        values[k] = plant->rows[pattern->row[k] * n_in + pattern->col[k]];
}

static void hessian(void *self, const double *in, const double *weight, double *values)
{
    fp_plant *plant = self;
    const moray_pattern *pattern = &plant->by_step.hess;
    const double step = 1e-50;
    double complex z[most_inputs], gradient[most_inputs];
    int before = -1;
    for (int k = 0; k < pattern->nnz; k++) {
        const int col = pattern->col[k];
        if (col != before) { // the pattern stands by columns
            for (int i = 0; i < plant->by_step.n_in; i++)
                z[i] = in[i];
            z[col] += step * I;
            move_z(&plant->stepped, z);
            weighted_gradient_z(&plant->stepped, z, weight, gradient);
            before = col;
        }
        values[k] = cimag(gradient[pattern->row[k]]) / step;
    }
}

// ---- Construction

static void plant_free(fp_plant *plant)
{
    if (!plant)
        return;
    moray_map_release(&plant->by_step);
    gait_free_d(&plant->real);
    gait_free_z(&plant->stepped);
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
    bool made = plant != NULL;
    if (made) {
        plant->of = (fp_setting){*spec, moray_fp_robot_of(&spec->robot), moray_plant_sizes(spec)};
        made = gait_new_d(&plant->real, &plant->of) && gait_new_z(&plant->stepped, &plant->of);
        const size_t n_out = (size_t)(plant->of.size.nx + plant->of.size.nc + 1);
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

// Where patterns are looked for: a swimming robot in the middle of a stroke.
static void probe(const moray_plant_spec *spec, double *in)
{
    const double speed = spec->robot.l, state[body] = {0.1, 0, 0, 0.2, speed, 0.3 * speed};
    const double on_gait[] = {0.2, 2, 0.7, 0.01, 0.1, 0.4}, steered[] = {0.01, 0.003, 0.002, 0.2, 2, 0.7, 0.4};
    memcpy(in, state, sizeof state);
    if (spec->joints == MORAY_JOINTS_STEERED)
        memcpy(in + body, steered, sizeof steered);
    else
        memcpy(in + body, on_gait, sizeof on_gait);
}

moray_status moray_fp_plant(moray_map *map, const moray_plant_spec *spec)
{
    fp_plant *plant = NULL;
    double in[most_inputs];
    *map = (moray_map){0};
    MORAY_TRY(moray_robot_check(&spec->robot));
    if (spec->joints == MORAY_JOINTS_SERIES)
        return moray_plant_series(map, spec, moray_fp_plant);
    if (spec->joints == MORAY_JOINTS_FREE)
        return moray_fp_free_plant(map, spec);
    if (spec->joints == MORAY_JOINTS_CLOSED_LOOP)
        return moray_error(MORAY_INPUT, "joints: the first-principles plant has none in closed loop");
    MORAY_TRY(plant_new(&plant, spec));
    probe(spec, in);
    const moray_plant_size *size = &plant->of.size;
    const moray_status status = moray_map_from_complex(&plant->by_step, size->nx + size->nu + size->ns + 1,
                                                       size->nx + size->nc + 1, evaluate, plant, NULL, in);
    if (moray_failed(status)) {
        plant_free(plant);
        return status;
    }
    *map = plant->by_step;
    map->self = plant;
    map->value = value;
    map->jacobian = jacobian;
    map->hessian = hessian;
    map->release = release;
    return status;
}
