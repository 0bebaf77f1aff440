// SPDX-License-Identifier: MIT
//
// Maps of complex-valued functions: d f/d x_j = Im f(x + i h e_j) / h has no cancellation, so h can be tiny and the
// Jacobian is exact to rounding; the Hessian is a central difference of it.
#include "moray/map.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/colouring.h"

static const double complex_step = 1e-50;
static const double hessian_step = 6e-6; // near the cube root of the rounding unit

struct complex_self {
    moray_complex_fn *function;
    void *user;
    void (*release_user)(void *user);
    int n_in, n_out;
    moray_pattern jac, hess;     // the map's own, kept here to be freed
    int *jac_group, *hess_group; // direction that each column belongs to
    int jac_groups, hess_groups;
    double complex *in, *out;
    double *point, *jac_values, *gradient; // gradient: 2 n_in, ahead and behind
};

static void complex_value(void *opaque, const double *in, double *out)
{
    struct complex_self *self = opaque;
    for (int j = 0; j < self->n_in; j++)
        self->in[j] = in[j];
    self->function(self->user, self->in, self->out);
    for (int i = 0; i < self->n_out; i++)
        out[i] = creal(self->out[i]);
}

static void complex_jacobian(void *opaque, const double *in, double *values)
{
    struct complex_self *self = opaque;
    for (int group = 0, k = 0; group < self->jac_groups; group++) {
        for (int j = 0; j < self->n_in; j++)
            self->in[j] = CMPLX(in[j], self->jac_group[j] == group ? complex_step : 0);
        self->function(self->user, self->in, self->out);
        for (; k < self->jac.nnz && self->jac_group[self->jac.col[k]] == group; k++) // entries are sorted by group
            values[k] = cimag(self->out[self->jac.row[k]]) / complex_step;
    }
}

// gradient of sum weight[i] f_i at self->point
static void weighted_gradient(struct complex_self *self, const double *weight, double *gradient)
{
    complex_jacobian(self, self->point, self->jac_values);
    memset(gradient, 0, (size_t)self->n_in * sizeof *gradient);
    for (int k = 0; k < self->jac.nnz; k++)
        if (weight[self->jac.row[k]] != 0)
            gradient[self->jac.col[k]] += weight[self->jac.row[k]] * self->jac_values[k];
}

static void complex_hessian(void *opaque, const double *in, const double *weight, double *values)
{
    struct complex_self *self = opaque;
    double *ahead = self->gradient, *behind = self->gradient + self->n_in;
    for (int group = 0; group < self->hess_groups; group++) {
        for (int side = 0; side < 2; side++) {
            for (int j = 0; j < self->n_in; j++) {
                const double step = self->hess_group[j] == group ? hessian_step * (1 + fabs(in[j])) : 0;
                self->point[j] = in[j] + (side ? -step : step);
            }
            weighted_gradient(self, weight, side ? behind : ahead);
        }
        for (int k = 0; k < self->hess.nnz; k++) {
            const int row = self->hess.row[k], col = self->hess.col[k];
            if (self->hess_group[col] == group)
                values[k] = (ahead[row] - behind[row]) / (2 * hessian_step * (1 + fabs(in[col])));
        }
    }
}

// depends[i * n_in + j] |= out i depends on in j, where a NaN put into x_j reaches it
static void mark_jacobian(struct complex_self *self, const double *at, bool *depends)
{
    for (int j = 0; j < self->n_in; j++) {
        for (int i = 0; i < self->n_in; i++)
            self->in[i] = at[i];
        self->in[j] = CMPLX(NAN, NAN);
        self->function(self->user, self->in, self->out);
        for (int i = 0; i < self->n_out; i++)
            depends[i * self->n_in + j] |= isnan(creal(self->out[i])) || isnan(cimag(self->out[i]));
    }
}

// depends[r * n_in + c] |= the derivative with respect to x_r of some output changes with x_c (r >= c): a NaN in x_c
// reaches the imaginary part that a complex step in x_r leaves.
static void mark_hessian(struct complex_self *self, const double *at, bool *depends)
{
    for (int r = 0; r < self->n_in; r++)
        for (int c = 0; c <= r; c++) {
            for (int i = 0; i < self->n_in; i++)
                self->in[i] = at[i];
            self->in[c] = NAN;
            self->in[r] += CMPLX(0, complex_step);
            self->function(self->user, self->in, self->out);
            for (int i = 0; i < self->n_out; i++)
                depends[r * self->n_in + c] |= isnan(cimag(self->out[i]));
        }
}

static moray_status pattern_from_marks(const bool *depends, int rows, int cols, moray_pattern *pattern)
{
    int nnz = 0;
    for (int k = 0; k < rows * cols; k++)
        nnz += depends[k];
    MORAY_TRY(moray_pattern_new(pattern, nnz));
    for (int c = 0, k = 0; c < cols; c++)
        for (int r = 0; r < rows; r++)
            if (depends[r * cols + c]) {
                pattern->row[k] = r;
                pattern->col[k++] = c;
            }
    return moray_ok();
}

// Patterns from NaN propagation at the probe and at two points near it (a branch may hide an entry at one of them).
static moray_status find_patterns(struct complex_self *self, const double *probe)
{
    const int n = self->n_in;
    bool *jac = calloc((size_t)(self->n_out * n) + 1, sizeof *jac), *hess = calloc((size_t)(n * n) + 1, sizeof *hess);
    moray_status status = jac && hess ? moray_ok() : moray_error(MORAY_MEMORY, "no memory for %d inputs", n);
    for (int trial = 0; trial < 3 && !moray_failed(status); trial++) {
        for (int j = 0; j < n; j++) // quasi-random relative shifts up to 1 %
            self->point[j] = probe[j] + 0.01 * trial * (1 + fabs(probe[j])) * (fmod(0.618 * (j + 1) * trial, 1) - 0.5);
        mark_jacobian(self, self->point, jac);
        mark_hessian(self, self->point, hess);
    }
    if (!moray_failed(status))
        status = pattern_from_marks(jac, self->n_out, n, &self->jac);
    if (!moray_failed(status))
        status = pattern_from_marks(hess, n, n, &self->hess);
    free(jac);
    free(hess);
    return status;
}

static moray_status find_directions(struct complex_self *self)
{
    MORAY_TRY(colour_columns(&self->jac, self->n_out, self->n_in, self->jac_group, &self->jac_groups));
    sort_by_group(&self->jac, self->jac_group);
    return colour_symmetric(&self->hess, self->n_in, self->hess_group, &self->hess_groups);
}

static void complex_release(moray_map *map)
{
    struct complex_self *self = map->self;
    if (!self)
        return;
    moray_pattern_free(&self->jac);
    moray_pattern_free(&self->hess);
    free(self->jac_group);
    free(self->hess_group);
    free(self->in);
    free(self->out);
    free(self->point);
    free(self->jac_values);
    free(self->gradient);
    if (self->release_user)
        self->release_user(self->user);
    free(self);
}

static moray_status complex_allocate(struct complex_self *self)
{
    const size_t n = (size_t)self->n_in + 1, m = (size_t)self->n_out + 1;
    self->jac_group = calloc(n, sizeof(int));
    self->hess_group = calloc(n, sizeof(int));
    self->in = calloc(n, sizeof *self->in);
    self->out = calloc(m, sizeof *self->out);
    self->point = calloc(n, sizeof(double));
    self->gradient = calloc(2 * n, sizeof(double));
    self->jac_values = calloc(n * m, sizeof(double));
    if (self->jac_group && self->hess_group && self->in && self->out && self->point && self->gradient &&
        self->jac_values)
        return moray_ok();
    return moray_error(MORAY_MEMORY, "no memory for a map of %d inputs and %d outputs", self->n_in, self->n_out);
}

static moray_status check_finite(struct complex_self *self, const double *probe)
{
    double *out = self->jac_values; // scratch that is large enough
    complex_value(self, probe, out);
    for (int i = 0; i < self->n_out; i++)
        if (!isfinite(out[i]))
            return moray_error(MORAY_INPUT, "output %d of the function is %g at the probe point; it must be finite", i,
                               out[i]);
    return moray_ok();
}

moray_status moray_map_from_complex(moray_map *map, int n_in, int n_out, moray_complex_fn *function, void *user,
                                    void (*release_user)(void *user), const double *probe)
{
    struct complex_self *self = calloc(1, sizeof *self);
    if (!self && release_user)
        release_user(user);
    if (!self)
        return moray_error(MORAY_MEMORY, "no memory for a map");
    *self = (struct complex_self){
        .function = function, .user = user, .release_user = release_user, .n_in = n_in, .n_out = n_out};
    *map = (moray_map){.n_in = n_in, .n_out = n_out, .self = self, .release = complex_release};
    moray_status status = complex_allocate(self);
    if (!moray_failed(status))
        status = check_finite(self, probe);
    if (!moray_failed(status))
        status = find_patterns(self, probe);
    if (!moray_failed(status))
        status = find_directions(self);
    if (moray_failed(status)) {
        moray_map_release(map);
        return status;
    }
    map->jac = self->jac;
    map->hess = self->hess;
    map->value = complex_value;
    map->jacobian = complex_jacobian;
    map->hessian = complex_hessian;
    return moray_ok();
}
