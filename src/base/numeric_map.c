// SPDX-License-Identifier: MIT
#include "base/numeric_map.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/colouring.h"

// One step along every column of a group.
static void set_direction(struct numeric_map *self, const double *in, const int *group, int which)
{
    for (int j = 0; j < self->n_in; j++)
        self->direction[j] = group[j] == which ? self->size[j] + fabs(in[j]) : 0;
}

static void jacobian(struct numeric_map *self, const double *in, bool rough, double *values)
{
    for (int group = 0, k = 0; group < self->jac_groups; group++) {
        set_direction(self, in, self->jac_group, group);
        self->kind->along(self, in, self->direction, rough, self->slope);
        for (; k < self->jac.nnz && self->jac_group[self->jac.col[k]] == group; k++) // entries are sorted by group
            values[k] = self->slope[self->jac.row[k]] / self->direction[self->jac.col[k]];
    }
}

static void numeric_jacobian(void *self, const double *in, double *values)
{
    jacobian(self, in, false, values);
}

// gradient of sum weight[i] f_i at self->point
static void weighted_gradient(struct numeric_map *self, const double *weight, double *gradient)
{
    jacobian(self, self->point, true, self->values);
    memset(gradient, 0, (size_t)self->n_in * sizeof *gradient);
    for (int k = 0; k < self->jac.nnz; k++)
        if (weight[self->jac.row[k]] != 0)
            gradient[self->jac.col[k]] += weight[self->jac.row[k]] * self->values[k];
}

static void numeric_hessian(void *opaque, const double *in, const double *weight, double *values)
{
    struct numeric_map *self = opaque;
    const double step = self->kind->hessian_step;
    double *ahead = self->gradient, *behind = self->gradient + self->n_in;
    for (int group = 0; group < self->hess_groups; group++) {
        for (int side = -1; side <= 1; side += 2) {
            for (int j = 0; j < self->n_in; j++) {
                const double move = self->hess_group[j] == group ? step * (self->size[j] + fabs(in[j])) : 0;
                self->point[j] = in[j] + side * move;
            }
            weighted_gradient(self, weight, side > 0 ? ahead : behind);
        }
        for (int k = 0; k < self->hess.nnz; k++) {
            const int row = self->hess.row[k], col = self->hess.col[k];
            if (self->hess_group[col] == group)
                values[k] = (ahead[row] - behind[row]) / (2 * step * (self->size[col] + fabs(in[col])));
        }
    }
}

// ---- Construction ----

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

// Patterns at the probe and at two points near it (a branch may hide an entry at one of them).
static moray_status find_patterns(struct numeric_map *self, const double *probe)
{
    const int n = self->n_in;
    bool *jac = calloc((size_t)(self->n_out * n) + 1, sizeof *jac), *hess = calloc((size_t)(n * n) + 1, sizeof *hess);
    moray_status status = jac && hess ? moray_ok() : moray_error(MORAY_MEMORY, "no memory for %d inputs", n);
    for (int trial = 0; trial < 3 && !moray_failed(status); trial++) {
        for (int j = 0; j < n; j++) { // quasi-random relative shifts up to 1 %
            const double shift = 0.01 * trial * (fmod(0.618 * (j + 1) * trial, 1) - 0.5);
            self->point[j] = probe[j] + shift * (self->size[j] + fabs(probe[j]));
        }
        self->kind->mark(self, self->point, jac, hess);
    }
    if (!moray_failed(status))
        status = pattern_from_marks(jac, self->n_out, n, &self->jac);
    if (!moray_failed(status))
        status = pattern_from_marks(hess, n, n, &self->hess);
    free(jac);
    free(hess);
    return status;
}

static moray_status find_directions(struct numeric_map *self)
{
    MORAY_TRY(moray_colour_columns(&self->jac, self->n_out, self->n_in, self->jac_group, &self->jac_groups));
    moray_sort_by_group(&self->jac, self->jac_group);
    return moray_colour_symmetric(&self->hess, self->n_in, self->hess_group, &self->hess_groups);
}

static void numeric_release(moray_map *map)
{
    struct numeric_map *self = map->self;
    moray_pattern_free(&self->jac);
    moray_pattern_free(&self->hess);
    free(self->jac_group);
    free(self->size);
    free(self->values);
    self->kind->release(self);
    if (self->release_user)
        self->release_user(self->user);
    free(self);
}

static moray_status numeric_allocate(struct numeric_map *self, const double *size)
{
    const size_t n = (size_t)self->n_in + 1, m = (size_t)self->n_out + 1;
    self->jac_group = calloc(2 * n, sizeof(int));
    self->size = calloc(5 * n + m, sizeof(double));
    self->values = calloc(n * m, sizeof(double));
    if (!self->jac_group || !self->size || !self->values)
        return moray_error(MORAY_MEMORY, "no memory for a map of %d inputs and %d outputs", self->n_in, self->n_out);
    self->hess_group = self->jac_group + n;
    self->point = self->size + n;
    self->direction = self->point + n;
    self->gradient = self->direction + n;
    self->slope = self->gradient + 2 * n;
    for (int j = 0; j < self->n_in; j++)
        self->size[j] = size ? size[j] : 1;
    return moray_ok();
}

static moray_status check_finite(struct numeric_map *self, const double *probe)
{
    self->kind->value(self, probe, self->slope);
    for (int i = 0; i < self->n_out; i++)
        if (!isfinite(self->slope[i]))
            return moray_error(MORAY_INPUT,
                               "output %d of the function is %g at the probe point; it must be finite and real", i,
                               self->slope[i]);
    return moray_ok();
}

moray_status moray_numeric_map_new(moray_map *map, struct numeric_map *self, const double *probe, const double *size)
{
    *map = (moray_map){.n_in = self->n_in, .n_out = self->n_out, .self = self, .release = numeric_release};
    MORAY_TRY(numeric_allocate(self, size));
    MORAY_TRY(check_finite(self, probe));
    MORAY_TRY(find_patterns(self, probe));
    MORAY_TRY(find_directions(self));
    map->jac = self->jac;
    map->hess = self->hess;
    map->value = self->kind->value;
    map->jacobian = numeric_jacobian;
    map->hessian = numeric_hessian;
    return moray_ok();
}
