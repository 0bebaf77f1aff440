// SPDX-License-Identifier: MIT
#include <stdlib.h>
#include <string.h>

#include "base/triplets.h"

struct joined {
    moray_map base, extra;
    int at;         // the extra outputs stand before this one of the base
    int *place;     // of the base's inputs
    double *in;     // the base's
    double *out;    // the base's, or their weights
    double *values; // of one of the two, whichever pattern is longer
    triplets jac, hess;
    bool *held; // of the base's inputs
};

static void gather(const struct joined *j, const double *in)
{
    for (int k = 0; k < j->base.n_in; k++)
        j->in[k] = in[j->place[k]];
}

static void joined_value(void *self, const double *in, double *out)
{
    struct joined *j = self;
    const size_t before = (size_t)j->at, after = (size_t)(j->base.n_out - j->at), extra = (size_t)j->extra.n_out;
    gather(j, in);
    j->base.value(j->base.self, j->in, j->out);
    memcpy(out, j->out, before * sizeof *out);
    j->extra.value(j->extra.self, in, out + before);
    memcpy(out + before + extra, j->out + before, after * sizeof *out);
}

static int base_row(const struct joined *j, int row)
{
    return row < j->at ? row : row + j->extra.n_out;
}

static void joined_jacobian(void *self, const double *in, double *values)
{
    struct joined *j = self;
    const moray_map *base = &j->base, *extra = &j->extra;
    gather(j, in);
    moray_triplets_start(&j->jac, values);
    base->jacobian(base->self, j->in, j->values);
    for (int k = 0; k < base->jac.nnz; k++)
        triplets_put(&j->jac, 0, 0, j->values[k]);
    extra->jacobian(extra->self, in, j->values);
    for (int k = 0; k < extra->jac.nnz; k++)
        triplets_put(&j->jac, 0, 0, j->values[k]);
}

static void joined_hessian(void *self, const double *in, const double *weight, double *values)
{
    struct joined *j = self;
    const moray_map *base = &j->base, *extra = &j->extra;
    for (int i = 0; i < base->n_out; i++)
        j->out[i] = weight[base_row(j, i)];
    gather(j, in);
    moray_triplets_start(&j->hess, values);
    base->hessian(base->self, j->in, j->out, j->values);
    for (int k = 0; k < base->hess.nnz; k++)
        triplets_put(&j->hess, 0, 0, j->values[k]);
    extra->hessian(extra->self, in, weight + j->at, j->values);
    for (int k = 0; k < extra->hess.nnz; k++)
        triplets_put(&j->hess, 0, 0, j->values[k]);
}

static void joined_hold(void *self, const bool *held)
{
    const struct joined *j = self;
    for (int k = 0; k < j->base.n_in && held; k++)
        j->held[k] = held[j->place[k]];
    if (j->base.hold)
        j->base.hold(j->base.self, held ? j->held : NULL);
    if (j->extra.hold)
        j->extra.hold(j->extra.self, held);
}

static void joined_release(moray_map *map)
{
    struct joined *j = map->self;
    moray_map_release(&j->base);
    moray_map_release(&j->extra);
    moray_triplets_free(&j->jac);
    moray_triplets_free(&j->hess);
    free(j->place);
    free(j->held);
    free(j->in);
    free(j);
}

static moray_status record(struct joined *j)
{
    const moray_map *base = &j->base, *extra = &j->extra;
    moray_triplets_record(&j->jac);
    for (int k = 0; k < base->jac.nnz; k++)
        triplets_put(&j->jac, base_row(j, base->jac.row[k]), j->place[base->jac.col[k]], 0);
    for (int k = 0; k < extra->jac.nnz; k++)
        triplets_put(&j->jac, j->at + extra->jac.row[k], extra->jac.col[k], 0);
    MORAY_TRY(moray_triplets_close(&j->jac));
    moray_triplets_record(&j->hess);
    for (int k = 0; k < base->hess.nnz; k++)
        triplets_put(&j->hess, j->place[base->hess.row[k]], j->place[base->hess.col[k]], 0);
    for (int k = 0; k < extra->hess.nnz; k++)
        triplets_put(&j->hess, extra->hess.row[k], extra->hess.col[k], 0);
    return moray_triplets_close(&j->hess);
}

static int largest_pattern(const moray_map *one, const moray_map *other)
{
    int most = one->jac.nnz > one->hess.nnz ? one->jac.nnz : one->hess.nnz;
    most = other->jac.nnz > most ? other->jac.nnz : most;
    return other->hess.nnz > most ? other->hess.nnz : most;
}

static moray_status joined_new(struct joined *j, const int *place)
{
    const int n_in = j->base.n_in, n_out = j->base.n_out;
    j->place = malloc((size_t)n_in * sizeof *j->place);
    j->in = calloc((size_t)(n_in + n_out + largest_pattern(&j->base, &j->extra)), sizeof *j->in);
    j->held = calloc((size_t)n_in, sizeof *j->held);
    if (!j->place || !j->in || !j->held)
        return moray_error(MORAY_MEMORY, "no memory for a map of %d inputs", j->extra.n_in);
    memcpy(j->place, place, (size_t)n_in * sizeof *place);
    j->out = j->in + n_in;
    j->values = j->out + n_out;
    return record(j);
}

moray_status moray_map_join(moray_map *map, moray_map *base, const int *place, moray_map *extra, int at)
{
    struct joined *j = calloc(1, sizeof *j);
    *map = (moray_map){0};
    if (!j) {
        moray_map_release(base);
        moray_map_release(extra);
        return moray_error(MORAY_MEMORY, "no memory for a map");
    }
    *j = (struct joined){.base = *base, .extra = *extra, .at = at};
    *map = (moray_map){.n_in = extra->n_in,
                       .n_out = base->n_out + extra->n_out,
                       .self = j,
                       .value = joined_value,
                       .jacobian = joined_jacobian,
                       .hessian = joined_hessian,
                       .hold = joined_hold,
                       .release = joined_release};
    *base = *extra = (moray_map){0};
    moray_status status = joined_new(j, place);
    map->jac = j->jac.pattern;
    map->hess = j->hess.pattern;
    if (moray_failed(status))
        moray_map_release(map);
    return status;
}
