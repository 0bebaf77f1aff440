// SPDX-License-Identifier: MIT
//
// What the outputs of a numeric map depend on, found by looking; the groups of directions that follow from it.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/colouring.h"
#include "base/dense.h"
#include "base/numeric_map.h"

static moray_status no_memory(const struct numeric_map *self)
{
    return moray_error(MORAY_MEMORY, "no memory for a map of %d inputs and %d outputs", self->n_in, self->n_out);
}

// ---- Marks ----

static void mark(struct numeric_map *self, bool *at)
{
    self->marks += !*at;
    *at = true;
}

void moray_mark_slope(struct numeric_map *self, int output, int input)
{
    if (isfinite(self->out[output]))
        mark(self, &self->feels[output * self->n_in + input]);
}

// The slope of the output along group g of self->linear changes along group h.
static void mark_curvature(struct numeric_map *self, int output, int g, int h)
{
    const int r = self->linear.member[output * self->linear.count + g];
    const int c = self->linear.member[output * self->linear.count + h];
    if (r < 0 || c < 0 || !isfinite(self->out[output]))
        return;
    mark(self, &self->bends[output * self->n_in + r]);
    mark(self, &self->bends[output * self->n_in + c]);
    mark(self, &self->curved[(r > c ? r : c) * self->n_in + (r > c ? c : r)]);
}

// Marks what bends the slope along group g among the groups first..last - 1: halves of them where some do, so that the
// cost goes with what is found.
static void search_bends(struct numeric_map *self, const double *at, int g, int first, int last)
{
    bool some = false;
    for (int j = 0; j < self->n_in; j++) {
        const int group = self->linear.group[j];
        self->other[j] = group >= first && group < last ? self->size[j] + fabs(at[j]) : 0;
    }
    self->kind->find_bent(self, at);
    for (int i = 0; i < self->n_out; i++) {
        some = some || self->bent[i];
        if (self->bent[i] && last - first == 1)
            mark_curvature(self, i, g, first);
    }
    if (!some || last - first == 1)
        return;
    const int middle = (first + last) / 2;
    search_bends(self, at, g, first, middle);
    search_bends(self, at, g, middle, last);
}

static void mark_curvatures(struct numeric_map *self, const double *at)
{
    for (int g = 0; g < self->linear.count; g++) {
        moray_set_direction(self, at, &self->linear, g, self->direction);
        self->kind->along(self, at, self->direction, self->sum);
        search_bends(self, at, g, 0, g + 1);
    }
}

moray_status moray_numeric_mark(struct numeric_map *self, const double *at)
{
    int before = self->marks;
    self->kind->value(self, at, self->out);
    self->kind->mark_slopes(self, at);
    if (self->marks > before) // whose groups tell the second derivatives apart
        MORAY_TRY(moray_numeric_arrange(self));
    before = self->marks;
    mark_curvatures(self, at);
    return self->marks > before ? moray_numeric_arrange(self) : moray_ok();
}

// ---- Arrangement ----

static void free_groups(struct numeric_groups *groups)
{
    free(groups->group);
    free(groups->member);
    *groups = (struct numeric_groups){0};
}

static moray_status find_groups(const struct numeric_map *self, const bool *marks, struct numeric_groups *groups)
{
    const int n = self->n_in, m = self->n_out;
    groups->group = calloc((size_t)n + 1, sizeof *groups->group);
    if (!groups->group)
        return no_memory(self);
    MORAY_TRY(moray_colour_columns(marks, m, n, groups->group, &groups->count));
    groups->member = calloc((size_t)m * groups->count + 1, sizeof *groups->member);
    if (!groups->member)
        return no_memory(self);
    for (int i = 0; i < m * groups->count; i++)
        groups->member[i] = -1;
    for (int i = 0; i < m; i++)
        for (int j = 0; j < n; j++)
            if (marks[i * n + j])
                groups->member[i * groups->count + groups->group[j]] = j;
    return moray_ok();
}

static moray_status jacobian_pattern(struct numeric_map *self)
{
    int nnz = 0;
    for (int i = 0; i < self->n_out * self->linear.count; i++)
        nnz += self->linear.member[i] >= 0;
    MORAY_TRY(moray_pattern_new(&self->jac, nnz));
    for (int g = 0, k = 0; g < self->linear.count; g++)
        for (int i = 0; i < self->n_out; i++) {
            const int input = self->linear.member[i * self->linear.count + g];
            if (input < 0)
                continue;
            self->jac.row[k] = i;
            self->jac.col[k++] = input;
        }
    self->values = calloc((size_t)nnz + 1, sizeof *self->values);
    return self->values ? moray_ok() : no_memory(self);
}

static moray_status hessian_pattern(struct numeric_map *self)
{
    const int n = self->n_in, groups = self->nonlinear.count;
    int nnz = 0;
    for (int i = 0; i < n * n; i++)
        nnz += self->curved[i];
    MORAY_TRY(moray_pattern_new(&self->hess, nnz));
    self->slot = calloc((size_t)n * n + 1, sizeof *self->slot);
    self->meets = calloc((size_t)groups * groups + 1, sizeof *self->meets);
    if (!self->slot || !self->meets)
        return no_memory(self);
    for (int c = 0, k = 0; c < n; c++)
        for (int r = c; r < n; r++) {
            self->slot[r * n + c] = self->slot[c * n + r] = self->curved[r * n + c] ? k : -1;
            if (!self->curved[r * n + c])
                continue;
            const int g = self->nonlinear.group[r], h = self->nonlinear.group[c];
            self->hess.row[k] = r;
            self->hess.col[k++] = c;
            self->meets[(g > h ? g : h) * groups + (g > h ? h : g)] = true;
        }
    return moray_ok();
}

void moray_numeric_release_arrangement(struct numeric_map *self)
{
    moray_pattern_free(&self->jac);
    moray_pattern_free(&self->hess);
    free_groups(&self->linear);
    free_groups(&self->nonlinear);
    free(self->values);
    free(self->slot);
    free(self->meets);
    self->values = NULL, self->slot = NULL, self->meets = NULL;
}

moray_status moray_numeric_arrange(struct numeric_map *self)
{
    moray_numeric_release_arrangement(self);
    MORAY_TRY(find_groups(self, self->feels, &self->linear));
    MORAY_TRY(find_groups(self, self->bends, &self->nonlinear));
    MORAY_TRY(jacobian_pattern(self));
    return hessian_pattern(self);
}

// ---- Whether they explain what is seen ----

static void dense_direction(const struct numeric_map *self, const double *in, double *direction)
{
    for (int j = 0; j < self->n_in; j++)
        direction[j] = moray_dense_entry(j, MORAY_DENSE_PATTERN) * (self->size[j] + fabs(in[j]));
}

// Whether sum[n_out], what the entries of a pattern amount to along the direction, is what was seen.
static bool explains(const struct numeric_map *self, const double *sum, const double *allowed)
{
    for (int i = 0; i < self->n_out; i++)
        if (isfinite(self->out[i] + sum[i] + self->slope[i]) && fabs(self->slope[i] - sum[i]) > allowed[i])
            return false;
    return true;
}

static void sum_slopes(struct numeric_map *self, const double *direction, double *sum, double *size)
{
    for (int i = 0; i < self->n_out; i++)
        sum[i] = size[i] = 0;
    for (int k = 0; k < self->jac.nnz; k++) {
        const double part = self->values[k] * direction[self->jac.col[k]];
        sum[self->jac.row[k]] += part;
        size[self->jac.row[k]] += fabs(part);
    }
}

// Along the pair (g, h), the second derivative of every output belongs to one pair of inputs.
static void sum_pair(struct numeric_map *self, const double *in, const double *direction, int g, int h, double *sum,
                     double *size)
{
    for (int i = 0; i < self->n_out; i++) {
        const int *member = self->nonlinear.member + i * self->nonlinear.count, r = member[g], c = member[h];
        if (r < 0 || c < 0 || self->slot[r * self->n_in + c] < 0)
            continue;
        const double units = (self->size[r] + fabs(in[r])) * (self->size[c] + fabs(in[c]));
        const double part = (g == h ? 1 : 2) * self->slope[i] / units * direction[r] * direction[c];
        sum[i] += part;
        size[i] += fabs(part);
    }
}

static void sum_curvatures(struct numeric_map *self, const double *in, const double *direction, double *sum,
                           double *size)
{
    for (int i = 0; i < self->n_out; i++)
        sum[i] = size[i] = 0;
    if (self->kind->around)
        self->kind->around(self, in);
    for (int g = 0; g < self->nonlinear.count; g++)
        for (int h = 0; h <= g; h++)
            if (self->meets[g * self->nonlinear.count + h]) {
                self->kind->bend_pair(self, in, g, h, self->slope);
                sum_pair(self, in, direction, g, h, sum, size);
            }
}

bool moray_map_pattern_holds(const moray_map *map, const double *in)
{
    struct numeric_map *self = map->self;
    const int m = self->n_out;
    const struct numeric_doubt *doubt = &self->kind->doubt;
    double *direction = self->point, *sum = self->dense, *slopes = sum + m, *allowed = slopes + m;
    self->kind->value(self, in, self->out);
    dense_direction(self, in, direction);
    map->jacobian(self, in, self->values);
    sum_slopes(self, direction, sum, slopes);
    for (int i = 0; i < m; i++)
        allowed[i] = doubt->slope * slopes[i] + doubt->slope_of_value * fabs(self->out[i]);
    self->kind->along(self, in, direction, self->slope);
    if (!explains(self, sum, allowed))
        return false;
    sum_curvatures(self, in, direction, sum, allowed);
    for (int i = 0; i < m; i++)
        allowed[i] =
            doubt->bend * allowed[i] + doubt->bend_of_slope * slopes[i] + doubt->bend_of_value * fabs(self->out[i]);
    self->kind->bend(self, in, direction, self->slope);
    return explains(self, sum, allowed);
}
