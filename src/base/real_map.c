// SPDX-License-Identifier: MIT
//
// Maps of functions that know only real numbers: central differences of fourth order for the Jacobian, of second order
// in both directions for the Hessian, each with the step at which rounding and truncation are about equal.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/numeric_map.h"

static const double fine_step = 5e-4, rough_step = 1e-4, shrink = 0.01;
enum { shrinks = 3 }; // tries with smaller steps, for points next to the end of the function's domain

struct real_self {
    struct numeric_map map; // first
    moray_real_fn *function;
    double *in, *out[4]; // [n_in], [n_out]
};

static void real_value(void *opaque, const double *in, double *out)
{
    struct real_self *self = opaque;
    self->function(self->map.user, in, out);
}

static void shifted(struct real_self *self, const double *in, const double *direction, double step, double *out)
{
    for (int j = 0; j < self->map.n_in; j++)
        self->in[j] = in[j] + step * direction[j];
    self->function(self->map.user, self->in, out);
}

static bool difference(struct real_self *self, const double *in, const double *direction, double step, bool rough,
                       double *slope)
{
    bool finite = true;
    shifted(self, in, direction, step, self->out[0]);
    shifted(self, in, direction, -step, self->out[1]);
    if (!rough) {
        shifted(self, in, direction, 2 * step, self->out[2]);
        shifted(self, in, direction, -2 * step, self->out[3]);
    }
    for (int i = 0; i < self->map.n_out; i++) {
        const double near = (self->out[0][i] - self->out[1][i]) / (2 * step);
        const double far = (self->out[2][i] - self->out[3][i]) / (4 * step);
        slope[i] = rough ? near : (4 * near - far) / 3;
        finite = finite && isfinite(slope[i]);
    }
    return finite;
}

static void real_along(struct numeric_map *map, const double *in, const double *direction, bool rough, double *slope)
{
    double step = rough ? rough_step : fine_step;
    for (int k = 0; k <= shrinks && !difference((struct real_self *)map, in, direction, step, rough, slope); k++)
        step *= shrink;
}

// An output depends on x_j where a NaN put into x_j reaches it, or where a change of x_j changes it (comparisons
// swallow NaNs).
static void mark_jacobian(struct real_self *self, const double *at, bool *depends)
{
    const int n = self->map.n_in, m = self->map.n_out;
    double *x = self->map.direction;
    memcpy(x, at, (size_t)n * sizeof *x);
    self->function(self->map.user, x, self->out[0]);
    for (int j = 0; j < n; j++) {
        const double step = 0.1 * (self->map.size[j] + fabs(at[j]));
        x[j] = NAN;
        self->function(self->map.user, x, self->out[1]);
        x[j] = at[j] + step;
        self->function(self->map.user, x, self->out[2]);
        x[j] = at[j] - step;
        self->function(self->map.user, x, self->out[3]);
        x[j] = at[j];
        for (int i = 0; i < m; i++)
            depends[i * n + j] |= !(self->out[1][i] == self->out[0][i] && self->out[2][i] == self->out[0][i] &&
                                    self->out[3][i] == self->out[0][i]);
    }
}

static bool share_output(const struct real_self *self, const bool *depends, int r, int c)
{
    const int n = self->map.n_in;
    for (int i = 0; i < self->map.n_out; i++)
        if (depends[i * n + r] && depends[i * n + c])
            return true;
    return false;
}

// Whether f(x + a e_r + b e_c) - f(x + a e_r) - f(x + b e_c) + f(x) is more than rounding, or no number.
static bool is_curved(struct real_self *self, const double *at, int r, int c)
{
    double *x = self->map.direction;
    for (int k = 0; k < 4; k++) {
        memcpy(x, at, (size_t)self->map.n_in * sizeof *x);
        x[r] += k & 1 ? 0.07 * (self->map.size[r] + fabs(at[r])) : 0;
        x[c] += k & 2 ? 0.05 * (self->map.size[c] + fabs(at[c])) : 0;
        self->function(self->map.user, x, self->out[k]);
    }
    for (int i = 0; i < self->map.n_out; i++) {
        double sum = 0, size = 0;
        for (int k = 0; k < 4; k++) {
            sum += k == 0 || k == 3 ? self->out[k][i] : -self->out[k][i];
            size += fabs(self->out[k][i]);
        }
        if (!(fabs(sum) <= 1e-13 * size))
            return true;
    }
    return false;
}

static void real_mark(struct numeric_map *map, const double *at, bool *jac, bool *hess)
{
    struct real_self *self = (struct real_self *)map;
    mark_jacobian(self, at, jac);
    for (int r = 0; r < map->n_in; r++)
        for (int c = 0; c <= r; c++)
            if (!hess[r * map->n_in + c] && share_output(self, jac, r, c))
                hess[r * map->n_in + c] = is_curved(self, at, r, c);
}

static void real_release(struct numeric_map *map)
{
    free(((struct real_self *)map)->in);
}

static const struct numeric_kind real_kind = {
    .value = real_value,
    .along = real_along,
    .mark = real_mark,
    .release = real_release,
    .hessian_step = 1e-4, // with rough_step: near the fourth root of the rounding unit
};

moray_status moray_real_map_new(moray_map *map, int n_in, int n_out, moray_real_fn *function, void *user,
                                void (*release_user)(void *user), const double *probe, const double *size)
{
    struct real_self *self = calloc(1, sizeof *self);
    double *block = calloc((size_t)(n_in + 4 * n_out) + 1, sizeof *block);
    *map = (moray_map){0};
    if (self && block) {
        *self = (struct real_self){{.kind = &real_kind, .n_in = n_in, .n_out = n_out}, function, block, {NULL}};
        self->map.user = user, self->map.release_user = release_user;
        for (int k = 0; k < 4; k++)
            self->out[k] = block + n_in + k * n_out;
        const moray_status status = moray_numeric_map_new(map, &self->map, probe, size);
        if (moray_failed(status))
            moray_map_release(map);
        return status;
    }
    free(self);
    free(block);
    if (release_user)
        release_user(user);
    return moray_error(MORAY_MEMORY, "no memory for a map of %d inputs", n_in);
}

moray_status moray_map_from_real(moray_map *map, int n_in, int n_out, moray_real_fn *function, void *user,
                                 void (*release_user)(void *user), const double *probe)
{
    return moray_real_map_new(map, n_in, n_out, function, user, release_user, probe, NULL);
}
