// SPDX-License-Identifier: MIT
#include "base/numeric_map.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void moray_set_direction(const struct numeric_map *self, const double *in, const struct numeric_groups *groups,
                         int which, double *direction)
{
    for (int j = 0; j < self->n_in; j++)
        direction[j] = groups->group[j] == which ? self->size[j] + fabs(in[j]) : 0;
}

static void numeric_jacobian(void *opaque, const double *in, double *values)
{
    struct numeric_map *self = opaque;
    for (int group = 0, k = 0; group < self->linear.count; group++) {
        moray_set_direction(self, in, &self->linear, group, self->direction);
        self->kind->along(self, in, self->direction, self->slope);
        for (; k < self->jac.nnz && self->linear.group[self->jac.col[k]] == group; k++)
            values[k] = self->slope[self->jac.row[k]] / self->direction[self->jac.col[k]];
    }
}

static void add_pair(struct numeric_map *self, const double *in, const double *weight, int g, int h, double *values)
{
    for (int i = 0; i < self->n_out; i++) {
        const int *member = self->nonlinear.member + i * self->nonlinear.count, r = member[g], c = member[h];
        const int slot = weight[i] != 0 && r >= 0 && c >= 0 ? self->slot[r * self->n_in + c] : -1;
        if (slot >= 0)
            values[slot] +=
                weight[i] * self->slope[i] / ((self->size[r] + fabs(in[r])) * (self->size[c] + fabs(in[c])));
    }
}

static void numeric_hessian(void *opaque, const double *in, const double *weight, double *values)
{
    struct numeric_map *self = opaque;
    memset(values, 0, (size_t)self->hess.nnz * sizeof *values);
    if (self->kind->around)
        self->kind->around(self, in);
    for (int g = 0; g < self->nonlinear.count; g++)
        for (int h = 0; h <= g; h++)
            if (self->meets[g * self->nonlinear.count + h]) {
                self->kind->bend_pair(self, in, g, h, self->slope);
                add_pair(self, in, weight, g, h, values);
            }
}

// ---- Construction ----

static void numeric_release(moray_map *map)
{
    struct numeric_map *self = map->self;
    moray_numeric_release_arrangement(self);
    free(self->feels);
    free(self->size);
    self->kind->release(self);
    if (self->release_user)
        self->release_user(self->user);
    free(self);
}

bool moray_map_is_numeric(const moray_map *map)
{
    return map->release == numeric_release;
}

static moray_status allocate(struct numeric_map *self, const double *size)
{
    const size_t n = (size_t)self->n_in, m = (size_t)self->n_out;
    self->feels = calloc(2 * n * m + n * n + m + 1, sizeof *self->feels);
    self->size = calloc(4 * n + 7 * m + 1, sizeof *self->size);
    if (!self->feels || !self->size)
        return moray_error(MORAY_MEMORY, "no memory for a map of %d inputs and %d outputs", self->n_in, self->n_out);
    self->bends = self->feels + n * m;
    self->curved = self->bends + n * m;
    self->bent = self->curved + n * n;
    double **vectors[] = {&self->point, &self->direction, &self->other};
    for (size_t i = 0; i < sizeof vectors / sizeof *vectors; i++)
        *vectors[i] = self->size + (i + 1) * n;
    double **outputs[] = {&self->slope, &self->out, &self->sum, &self->behind, &self->dense}; // dense: three of them
    for (size_t i = 0; i < sizeof outputs / sizeof *outputs; i++)
        *outputs[i] = self->size + 4 * n + i * m;
    for (int j = 0; j < self->n_in; j++)
        self->size[j] = size ? size[j] : 1;
    return moray_numeric_arrange(self);
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

static void describe(moray_map *map, struct numeric_map *self)
{
    *map = (moray_map){.n_in = self->n_in,
                       .n_out = self->n_out,
                       .jac = self->jac,
                       .hess = self->hess,
                       .self = self,
                       .value = self->kind->value,
                       .jacobian = numeric_jacobian,
                       .hessian = numeric_hessian,
                       .release = numeric_release};
}

// The first points by every direction, the others where one dense direction shows that something is missing.
static moray_status look(moray_map *map, const double *points, int n, int thorough)
{
    struct numeric_map *self = map->self;
    moray_status status = moray_ok();
    for (int k = 0; k < n && !moray_failed(status); k++) {
        const double *at = points + k * self->n_in;
        if (k < thorough || !moray_map_pattern_holds(map, at))
            status = moray_numeric_mark(self, at);
        describe(map, self);
    }
    return status;
}

enum { thorough_points = 5 };

moray_status moray_numeric_map_new(moray_map *map, struct numeric_map *self, int n_in, void *user,
                                   void (*release_user)(void *user), const struct numeric_probe *probe)
{
    *map = (moray_map){0};
    if (!self) {
        if (release_user)
            release_user(user);
        return moray_error(MORAY_MEMORY, "no memory for a map of %d inputs", n_in);
    }
    self->release_user = release_user;
    describe(map, self);
    moray_status status = allocate(self, probe->size);
    if (!moray_failed(status))
        status = check_finite(self, probe->points);
    if (!moray_failed(status))
        status = look(map, probe->points, probe->n, thorough_points);
    if (moray_failed(status))
        moray_map_release(map);
    return status;
}

// At the probe and shifted by a hundredth, a tenth and a half of size + |probe|, quasi-random.
moray_status moray_numeric_map_around(moray_map *map, struct numeric_map *self, int n_in, void *user,
                                      void (*release_user)(void *user), const double *at)
{
    enum { points = 13 };
    static const double spread[] = {0.01, 0.1, 0.5};
    double *point = calloc((size_t)(points * n_in) + 1, sizeof *point);
    for (int k = 0; point && k < points; k++)
        for (int j = 0; j < n_in; j++) {
            const double shift = (2 * fmod(0.618033988749895 * (j + 1) * k, 1) - 1) * spread[k % 3];
            point[k * n_in + j] = k ? at[j] + shift * (1 + fabs(at[j])) : at[j]; // which may be infinite
        }
    if (!point && self) {
        self->kind->release(self);
        free(self);
        self = NULL;
    }
    moray_status status = moray_numeric_map_new(map, self, n_in, user, release_user,
                                                &(struct numeric_probe){.points = point, .n = points});
    free(point);
    return status;
}

moray_status moray_map_widened(moray_map *wider, const moray_map *map, const double *points, int n, int *found)
{
    const struct numeric_map *from = map->self;
    struct numeric_map *self = from->kind->twin(from);
    *wider = (moray_map){0};
    *found = 0;
    if (!self)
        return moray_error(MORAY_MEMORY, "no memory for a map of %d inputs", map->n_in);
    moray_status status = allocate(self, from->size);
    if (!moray_failed(status)) {
        memcpy(self->feels, from->feels, (size_t)((char *)from->bent - (char *)from->feels));
        self->marks = from->marks;
        status = moray_numeric_arrange(self);
    }
    describe(wider, self);
    if (!moray_failed(status))
        status = look(wider, points, n, n);
    *found = self->marks - from->marks;
    if (moray_failed(status))
        moray_map_release(wider);
    return status;
}
