// SPDX-License-Identifier: MIT
//
// Maps of complex-valued functions: d f/d x_j = Im f(x + i h e_j) / h has no cancellation, so h can be tiny and the
// Jacobian is exact to rounding; second derivatives are central differences of it.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "moray/num.h"
#include "base/numeric_map.h"

static const double complex_step = 1e-50;
static const double bend_step =
    1e-6; // below the cube root of the rounding unit: functions often change within a part of their input
static const double mark_step = 1e-3;

struct complex_self {
    struct numeric_map map; // first
    moray_complex_fn *function;
    double complex *in, *out;
};

// A real function of real numbers: an imaginary part says that a root, logarithm or power has left its domain, and
// would swamp the complex step.
static void complex_value(void *opaque, const double *in, double *out)
{
    struct complex_self *self = opaque;
    for (int j = 0; j < self->map.n_in; j++)
        self->in[j] = in[j];
    self->function(self->map.user, self->in, self->out);
    for (int i = 0; i < self->map.n_out; i++)
        out[i] = cimag(self->out[i]) == 0 ? creal(self->out[i]) : NAN;
}

// The slope along `direction` at in + step * move.
static void slope_at(struct numeric_map *map, const double *in, double step, const double *move,
                     const double *direction, double *slope)
{
    struct complex_self *self = (struct complex_self *)map;
    for (int j = 0; j < map->n_in; j++)
        self->in[j] = moray_complex(in[j] + step * move[j], complex_step * direction[j]);
    self->function(map->user, self->in, self->out);
    for (int i = 0; i < map->n_out; i++)
        slope[i] = cimag(self->out[i]) / complex_step;
}

static void complex_along(struct numeric_map *map, const double *in, const double *direction, double *slope)
{
    slope_at(map, in, 0, direction, direction, slope);
}

static void bend_between(struct numeric_map *map, const double *in, const double *move, const double *direction,
                         double *curvature)
{
    slope_at(map, in, -bend_step, move, direction, map->sum);
    slope_at(map, in, bend_step, move, direction, curvature);
    for (int i = 0; i < map->n_out; i++)
        curvature[i] = (curvature[i] - map->sum[i]) / (2 * bend_step);
}

static void complex_bend(struct numeric_map *map, const double *in, const double *direction, double *curvature)
{
    bend_between(map, in, direction, direction, curvature);
}

static void complex_bend_pair(struct numeric_map *map, const double *in, int g, int h, double *curvature)
{
    moray_set_direction(map, in, &map->nonlinear, g, map->direction);
    moray_set_direction(map, in, &map->nonlinear, h, map->other);
    bend_between(map, in, map->other, map->direction, curvature);
}

// A step in x_j leaves no imaginary part, not even of rounding, in an output that does not depend on it.
static void complex_mark_slopes(struct numeric_map *map, const double *at)
{
    memset(map->direction, 0, (size_t)map->n_in * sizeof *map->direction);
    for (int j = 0; j < map->n_in; j++) {
        map->direction[j] = 1;
        complex_along(map, at, map->direction, map->slope);
        map->direction[j] = 0;
        for (int i = 0; i < map->n_out; i++)
            if (map->slope[i] != 0 && !isnan(map->slope[i]))
                moray_mark_slope(map, i, j);
    }
}

// A slope that does not depend on x_c stays the same to the last bit when x_c moves. That it moves on both sides says
// that it bends there, not that a kink is near.
static void complex_find_bent(struct numeric_map *map, const double *at)
{
    const double *here = map->sum, *behind = map->behind, *ahead = map->slope;
    slope_at(map, at, -mark_step, map->other, map->direction, map->behind);
    slope_at(map, at, mark_step, map->other, map->direction, map->slope);
    for (int i = 0; i < map->n_out; i++)
        map->bent[i] = behind[i] != here[i] && ahead[i] != here[i] && isfinite(behind[i] + here[i] + ahead[i]);
}

static struct numeric_map *complex_twin(const struct numeric_map *map);

static void complex_release(struct numeric_map *map)
{
    free(((struct complex_self *)map)->in);
}

static const struct numeric_kind complex_kind = {
    .value = complex_value,
    .along = complex_along,
    .bend = complex_bend,
    .bend_pair = complex_bend_pair,
    .mark_slopes = complex_mark_slopes,
    .find_bent = complex_find_bent,
    .twin = complex_twin,
    .release = complex_release,
    .doubt = {.slope = 1e-10, .bend = 1e-6, .bend_of_slope = 1e-7},
};

static struct numeric_map *self_new(int n_in, int n_out, moray_complex_fn *function, void *user)
{
    struct complex_self *self = calloc(1, sizeof *self);
    double complex *block = calloc((size_t)(n_in + n_out) + 1, sizeof *block);
    if (!self || !block) {
        free(self);
        free(block);
        return NULL;
    }
    *self = (struct complex_self){
        {.kind = &complex_kind, .n_in = n_in, .n_out = n_out, .user = user}, function, block, block + n_in};
    return &self->map;
}

static struct numeric_map *complex_twin(const struct numeric_map *map)
{
    return self_new(map->n_in, map->n_out, ((const struct complex_self *)map)->function, map->user);
}

moray_status moray_complex_map_new(moray_map *map, int n_in, int n_out, moray_complex_fn *function, void *user,
                                   void (*release_user)(void *user), const struct numeric_probe *probe)
{
    return moray_numeric_map_new(map, self_new(n_in, n_out, function, user), n_in, user, release_user, probe);
}

moray_status moray_map_from_complex(moray_map *map, int n_in, int n_out, moray_complex_fn *function, void *user,
                                    void (*release_user)(void *user), const double *probe)
{
    return moray_numeric_map_around(map, self_new(n_in, n_out, function, user), n_in, user, release_user, probe);
}
