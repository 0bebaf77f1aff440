// SPDX-License-Identifier: MIT
//
// Maps of functions that know only real numbers: central differences of fourth order for the Jacobian, of second order
// for the Hessian, each with the step at which rounding and truncation are about equal.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/numeric_map.h"

static const double slope_step = 5e-4, shrink = 0.01;
static const double bend_step = 1.5e-4; // near the fourth root of the rounding unit
static const double slope_mark = 1e-3;
static const double bend_mark = 4e-3; // as narrow as a second difference stands out of the rounding, for kinks
static const double rounding = 2e-13; // of a second difference, relative to what it is made of
enum { shrinks = 3 };                 // tries with smaller steps, for points next to the end of the function's domain

struct real_self {
    struct numeric_map map; // first
    moray_real_fn *function;
    double *in, *out[4]; // [n_in], [n_out]
    double *around;      // [1 + 2 n_in][n_out]: at the point, behind and ahead of it along every group
};

static void real_value(void *opaque, const double *in, double *out)
{
    struct real_self *self = opaque;
    self->function(self->map.user, in, out);
}

// out at in + a * one + b * other; other may be NULL
static void shifted(struct real_self *self, const double *in, double a, const double *one, double b,
                    const double *other, double *out)
{
    for (int j = 0; j < self->map.n_in; j++)
        self->in[j] = in[j] + a * one[j] + (other ? b * other[j] : 0);
    self->function(self->map.user, self->in, out);
}

static bool difference(struct real_self *self, const double *in, const double *direction, double step, double *slope)
{
    bool finite = true;
    shifted(self, in, step, direction, 0, NULL, self->out[0]);
    shifted(self, in, -step, direction, 0, NULL, self->out[1]);
    shifted(self, in, 2 * step, direction, 0, NULL, self->out[2]);
    shifted(self, in, -2 * step, direction, 0, NULL, self->out[3]);
    for (int i = 0; i < self->map.n_out; i++) {
        const double near = (self->out[0][i] - self->out[1][i]) / (2 * step);
        const double far = (self->out[2][i] - self->out[3][i]) / (4 * step);
        slope[i] = (4 * near - far) / 3;
        finite = finite && isfinite(slope[i]);
    }
    return finite;
}

static void real_along(struct numeric_map *map, const double *in, const double *direction, double *slope)
{
    double step = slope_step;
    for (int k = 0; k <= shrinks && !difference((struct real_self *)map, in, direction, step, slope); k++)
        step *= shrink;
}

static void real_bend(struct numeric_map *map, const double *in, const double *direction, double *curvature)
{
    struct real_self *self = (struct real_self *)map;
    self->function(map->user, in, self->out[0]);
    shifted(self, in, -bend_step, direction, 0, NULL, self->out[1]);
    shifted(self, in, bend_step, direction, 0, NULL, self->out[2]);
    for (int i = 0; i < map->n_out; i++)
        curvature[i] = (self->out[1][i] - 2 * self->out[0][i] + self->out[2][i]) / (bend_step * bend_step);
}

static double *around(struct real_self *self, int g, int side)
{
    return self->around + (1 + 2 * g + side) * self->map.n_out;
}

static void real_around(struct numeric_map *map, const double *in)
{
    struct real_self *self = (struct real_self *)map;
    self->function(map->user, in, self->around);
    for (int g = 0; g < map->nonlinear.count; g++) {
        moray_set_direction(map, in, &map->nonlinear, g, map->direction);
        shifted(self, in, -bend_step, map->direction, 0, NULL, around(self, g, 0));
        shifted(self, in, bend_step, map->direction, 0, NULL, around(self, g, 1));
    }
}

// Of two groups: half of the second derivative along their sum less those along each.
static void real_bend_pair(struct numeric_map *map, const double *in, int g, int h, double *curvature)
{
    struct real_self *self = (struct real_self *)map;
    const double *here = self->around, square = bend_step * bend_step;
    if (g != h) {
        moray_set_direction(map, in, &map->nonlinear, g, map->direction);
        moray_set_direction(map, in, &map->nonlinear, h, map->other);
        shifted(self, in, -bend_step, map->direction, -bend_step, map->other, self->out[0]);
        shifted(self, in, bend_step, map->direction, bend_step, map->other, self->out[1]);
    }
    for (int i = 0; i < map->n_out; i++) {
        const double along_g = around(self, g, 0)[i] - here[i] + (around(self, g, 1)[i] - here[i]);
        const double along_h = around(self, h, 0)[i] - here[i] + (around(self, h, 1)[i] - here[i]);
        const double sum = self->out[0][i] - here[i] + (self->out[1][i] - here[i]);
        curvature[i] = (g == h ? along_g : (sum - along_g - along_h) / 2) / square;
    }
}

static bool has_changed(double before, double after)
{
    return after != before && isfinite(after);
}

// An output depends on x_j where its value changes, however little, when x_j moves, and on both sides: a change on one
// side alone may be a jump of a branch that x_j decides.
static void real_mark_slopes(struct numeric_map *map, const double *at)
{
    struct real_self *self = (struct real_self *)map;
    memset(map->direction, 0, (size_t)map->n_in * sizeof *map->direction);
    for (int j = 0; j < map->n_in; j++) {
        map->direction[j] = map->size[j] + fabs(at[j]);
        shifted(self, at, -slope_mark, map->direction, 0, NULL, self->out[0]);
        shifted(self, at, slope_mark, map->direction, 0, NULL, self->out[1]);
        for (int i = 0; i < map->n_out; i++)
            if (has_changed(map->out[i], self->out[0][i]) && has_changed(map->out[i], self->out[1][i]))
                moray_mark_slope(map, i, j);
        map->direction[j] = 0;
    }
}

// bent[n_out] &= f(x + a + b) - f(x + a) - f(x + b) + f(x) is more than rounding, with a step along either direction.
static void keep_bent(struct real_self *self, const double *at, double step)
{
    const double *one = self->map.direction, *other = self->map.other;
    shifted(self, at, step, one, step, other, self->out[0]);
    shifted(self, at, step, one, 0, NULL, self->out[1]);
    shifted(self, at, step, other, 0, NULL, self->out[2]);
    for (int i = 0; i < self->map.n_out; i++) {
        const double here = self->map.out[i], both = self->out[0][i], first = self->out[1][i], second = self->out[2][i];
        const double sum = both - first - second + here;
        self->map.bent[i] = self->map.bent[i] && isfinite(sum) && fabs(sum) > rounding * (fabs(first) + fabs(second));
    }
}

// On both sides: a kink ahead bends nothing behind.
static void real_find_bent(struct numeric_map *map, const double *at)
{
    memset(map->bent, true, (size_t)map->n_out * sizeof *map->bent);
    keep_bent((struct real_self *)map, at, -bend_mark);
    keep_bent((struct real_self *)map, at, bend_mark);
}

static struct numeric_map *real_twin(const struct numeric_map *map);

static void real_release(struct numeric_map *map)
{
    free(((struct real_self *)map)->in);
}

static const struct numeric_kind real_kind = {
    .value = real_value,
    .along = real_along,
    .bend = real_bend,
    .around = real_around,
    .bend_pair = real_bend_pair,
    .mark_slopes = real_mark_slopes,
    .find_bent = real_find_bent,
    .twin = real_twin,
    .release = real_release,
    .doubt = {.slope = 1e-6, .slope_of_value = 1e-9, .bend = 1e-3, .bend_of_value = 1e-6},
};

static struct numeric_map *self_new(int n_in, int n_out, moray_real_fn *function, void *user)
{
    struct real_self *self = calloc(1, sizeof *self);
    double *block = calloc((size_t)n_in + (5 + 2 * (size_t)n_in) * n_out + 1, sizeof *block);
    if (!self || !block) {
        free(self);
        free(block);
        return NULL;
    }
    self->map = (struct numeric_map){.kind = &real_kind, .n_in = n_in, .n_out = n_out, .user = user};
    self->function = function;
    self->in = block;
    for (int k = 0; k < 4; k++)
        self->out[k] = block + n_in + k * n_out;
    self->around = self->out[3] + n_out;
    return &self->map;
}

static struct numeric_map *real_twin(const struct numeric_map *map)
{
    return self_new(map->n_in, map->n_out, ((const struct real_self *)map)->function, map->user);
}

moray_status moray_real_map_new(moray_map *map, int n_in, int n_out, moray_real_fn *function, void *user,
                                void (*release_user)(void *user), const struct numeric_probe *probe)
{
    return moray_numeric_map_new(map, self_new(n_in, n_out, function, user), n_in, user, release_user, probe);
}

moray_status moray_map_from_real(moray_map *map, int n_in, int n_out, moray_real_fn *function, void *user,
                                 void (*release_user)(void *user), const double *probe)
{
    return moray_numeric_map_around(map, self_new(n_in, n_out, function, user), n_in, user, release_user, probe);
}
