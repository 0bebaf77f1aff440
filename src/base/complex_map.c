// SPDX-License-Identifier: MIT
//
// Maps of complex-valued functions: d f/d x_j = Im f(x + i h e_j) / h has no cancellation, so h can be tiny and the
// Jacobian is exact to rounding; the Hessian is a central difference of it.
#include <math.h>
#include <stdlib.h>

#include "base/numeric_map.h"

static const double complex_step = 1e-50;

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

static void complex_along(struct numeric_map *map, const double *in, const double *direction, bool rough, double *slope)
{
    (void)rough;
    struct complex_self *self = (struct complex_self *)map;
    for (int j = 0; j < map->n_in; j++)
        self->in[j] = moray_complex(in[j], complex_step * direction[j]);
    self->function(map->user, self->in, self->out);
    for (int i = 0; i < map->n_out; i++)
        slope[i] = cimag(self->out[i]) / complex_step;
}

// An output depends on x_j where a NaN put into x_j reaches it.
static void mark_jacobian(struct complex_self *self, const double *at, bool *depends)
{
    const int n = self->map.n_in;
    for (int j = 0; j < n; j++) {
        for (int i = 0; i < n; i++)
            self->in[i] = at[i];
        self->in[j] = moray_complex(NAN, NAN);
        self->function(self->map.user, self->in, self->out);
        for (int i = 0; i < self->map.n_out; i++)
            depends[i * n + j] |= isnan(creal(self->out[i])) || isnan(cimag(self->out[i]));
    }
}

// The derivative with respect to x_r of some output changes with x_c where a NaN in x_c reaches the imaginary part that
// a complex step in x_r leaves.
static void mark_hessian(struct complex_self *self, const double *at, bool *depends)
{
    const int n = self->map.n_in;
    for (int r = 0; r < n; r++)
        for (int c = 0; c <= r; c++) {
            for (int i = 0; i < n; i++)
                self->in[i] = at[i];
            self->in[c] = NAN;
            self->in[r] += moray_complex(0, complex_step);
            self->function(self->map.user, self->in, self->out);
            for (int i = 0; i < self->map.n_out; i++)
                depends[r * n + c] |= isnan(cimag(self->out[i]));
        }
}

static void complex_mark(struct numeric_map *map, const double *at, bool *jac, bool *hess)
{
    struct complex_self *self = (struct complex_self *)map;
    mark_jacobian(self, at, jac);
    mark_hessian(self, at, hess);
}

static void complex_release(struct numeric_map *map)
{
    free(((struct complex_self *)map)->in);
}

static const struct numeric_kind complex_kind = {
    .value = complex_value,
    .along = complex_along,
    .mark = complex_mark,
    .release = complex_release,
    .hessian_step = 6e-6, // near the cube root of the rounding unit
};

moray_status moray_complex_map_new(moray_map *map, int n_in, int n_out, moray_complex_fn *function, void *user,
                                   void (*release_user)(void *user), const double *probe, const double *size)
{
    struct complex_self *self = calloc(1, sizeof *self);
    double complex *block = calloc((size_t)(n_in + n_out) + 1, sizeof *block);
    *map = (moray_map){0};
    if (self && block) {
        *self = (struct complex_self){{.kind = &complex_kind, .n_in = n_in, .n_out = n_out}, function, block, NULL};
        self->map.user = user, self->map.release_user = release_user;
        self->out = block + n_in;
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

moray_status moray_map_from_complex(moray_map *map, int n_in, int n_out, moray_complex_fn *function, void *user,
                                    void (*release_user)(void *user), const double *probe)
{
    return moray_complex_map_new(map, n_in, n_out, function, user, release_user, probe, NULL);
}
