// SPDX-License-Identifier: MIT
#include "ocp/certificate/witness.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "ocp/certificate/columns.h"
#include "ocp/certificate/sizes.h"

static const double least_step = 1e-4; // of the width of an input's box, as a size to difference by
static const double silent = 1e-6;     // doubt of a derivative, relative, at which it says nothing

// ---- Memory ----

static moray_status allocate_phase(struct witness *e, int p, bool differences)
{
    const moray_map *map = moray_witness_cache(e, p)->map;
    const size_t n_in = (size_t)map->n_in, n_out = (size_t)map->n_out,
                 nq = (size_t)e->solution->transcription->ocp->phase[p].nq;
    struct phase_witness *phase = &e->phase[p];
    phase->size = calloc(n_in + n_out + nq + n_in * n_out, sizeof *phase->size);
    phase->box = calloc(n_in, sizeof *phase->box);
    if (!phase->size || !phase->box)
        return moray_error(MORAY_MEMORY, "no memory for the certificate");
    phase->out_size = phase->size + n_in;
    phase->integral = phase->out_size + n_out;
    phase->slope = phase->integral + nq;
    return differences ? moray_kept_new(&phase->kept, map, moray_witness_layout(e, p)->nodes) : moray_ok();
}

static moray_status allocate(struct witness *e, bool differences)
{
    const struct transcription *t = e->solution->transcription;
    const size_t n_in = (size_t)t->endpoint->n_in, n_out = (size_t)t->endpoint->n_out;
    e->phase = calloc((size_t)t->ocp->phases, sizeof *e->phase);
    e->end_size = calloc(n_in + n_out, sizeof *e->end_size);
    e->end_box = calloc(n_in, sizeof *e->end_box);
    if (!e->phase || !e->end_size || !e->end_box)
        return moray_error(MORAY_MEMORY, "no memory for the certificate");
    e->end_out_size = e->end_size + n_in;
    if (differences)
        MORAY_TRY(moray_kept_new(&e->end, t->endpoint, 1));
    for (int p = 0; p < t->ocp->phases; p++)
        MORAY_TRY(allocate_phase(e, p, differences));
    return moray_ok();
}

void moray_witness_free(struct witness *e)
{
    for (int p = 0; e->phase && p < e->solution->transcription->ocp->phases; p++) {
        free(e->phase[p].size);
        free(e->phase[p].box);
        moray_kept_free(&e->phase[p].kept);
    }
    moray_kept_free(&e->end);
    free(e->phase);
    free(e->end_size);
    free(e->end_box);
    *e = (struct witness){0};
}

// ---- Derivatives ----

// A slope that moves an output, |output| at most `most`, by no more than its last digits over all that the input does
// (a table that an argument has no part in, say) drives nothing.
static void note_slope(double *slope, double value, double size, double most)
{
    if (size <= 0 || fabs(value) * size > 16 * DBL_EPSILON * most)
        *slope = fmax(*slope, fabs(value));
}

// |output| at most, over all nodes.
static double largest_output(const struct phase_cache *cache, int nodes, int out)
{
    double most = 0;
    for (int n = 0; n < nodes; n++)
        most = fmax(most, fabs(cache->out[n * cache->map->n_out + out]));
    return most;
}

// Without differences, those in use.
static void take_in_use(struct witness *e, int p)
{
    const struct phase_cache *cache = moray_witness_cache(e, p);
    const moray_map *map = cache->map;
    const int nodes = moray_witness_layout(e, p)->nodes;
    for (int k = 0; k < map->jac.nnz; k++) {
        const int in = map->jac.col[k], out = map->jac.row[k];
        const double most = largest_output(cache, nodes, out);
        for (int n = 0; n < nodes; n++)
            if (moray_witness_layout(e, p)->node[n].collocated)
                note_slope(&e->phase[p].slope[in * map->n_out + out], cache->jac[n * map->jac.nnz + k],
                           e->phase[p].size[in], most);
    }
}

// most[n_out]: |output| at most.
static moray_status difference_node(struct phase_witness *w, const double *in, const double *step, const double *most)
{
    struct kept *k = &w->kept;
    const size_t n_out = (size_t)k->map->n_out, block = (size_t)k->map->n_in * n_out;
    MORAY_TRY(moray_difference_columns(k->map, in, step, w->box, k->jac, k->doubt, k->kink));
    for (size_t i = 0; i < block; i++)
        if (fabs(k->jac[i]) > k->doubt[i])
            note_slope(&w->slope[i], k->jac[i], w->size[i / n_out], most[i % n_out]);
    return moray_kept_add(k);
}

static moray_status difference_phase(struct witness *e, int p)
{
    const struct phase_cache *cache = moray_witness_cache(e, p);
    const size_t n_in = (size_t)cache->map->n_in, n_out = (size_t)cache->map->n_out;
    const int nodes = moray_witness_layout(e, p)->nodes;
    double *step = calloc(n_in + n_out, sizeof *step), *most = step ? step + n_in : NULL;
    moray_status status = step ? moray_ok() : moray_error(MORAY_MEMORY, "no memory for the certificate");
    for (size_t i = 0; i < n_in && step; i++) {
        step[i] = fmax(e->phase[p].size[i], least_step * moray_witness_width(e->phase[p].box[i]));
        step[i] = step[i] > 0 ? step[i] : 1;
    }
    for (size_t i = 0; i < n_out && step; i++)
        most[i] = largest_output(cache, nodes, (int)i);
    for (int n = 0; n < nodes && !moray_failed(status); n++)
        if (moray_witness_layout(e, p)->node[n].collocated)
            status = difference_node(&e->phase[p], cache->in + (size_t)n * n_in, step, most);
        else
            moray_kept_skip(&e->phase[p].kept);
    free(step);
    return status;
}

// ---- All of it ----

static moray_status gather(struct witness *e, bool differences)
{
    const struct transcription *t = e->solution->transcription;
    MORAY_TRY(allocate(e, differences));
    moray_fill_boxes(e);
    for (int p = 0; p < t->ocp->phases; p++) {
        moray_size_by_range(e, p);
        if (differences)
            MORAY_TRY(difference_phase(e, p));
        else
            take_in_use(e, p);
        moray_size_by_effect(e, p);
        moray_size_integrals(e, p);
    }
    MORAY_TRY(moray_size_idle(e));
    moray_size_ends(e);
    MORAY_TRY(moray_size_end_outputs(e));
    for (int p = 0; p < t->ocp->phases; p++) {
        MORAY_TRY(moray_size_by_costate(e, p));
        MORAY_TRY(moray_size_outputs(e, p));
        moray_size_integrals(e, p);
    }
    moray_size_ends(e);
    MORAY_TRY(moray_size_end_outputs(e));
    if (!differences)
        return moray_ok();
    MORAY_TRY(moray_difference_columns(t->endpoint, t->end_in, e->end_size, e->end_box, e->end.jac, e->end.doubt,
                                       e->end.kink));
    return moray_kept_add(&e->end);
}

static moray_status create(struct witness *e, const moray_solution *solution, bool differences)
{
    *e = (struct witness){.solution = solution};
    const moray_status status = gather(e, differences);
    if (moray_failed(status))
        moray_witness_free(e);
    return status;
}

moray_status moray_witness_new(struct witness *e, const moray_solution *solution)
{
    return create(e, solution, true);
}

moray_status moray_witness_of_sizes(struct witness *e, const moray_solution *solution)
{
    return create(e, solution, false);
}

bool moray_witness_speaks(double doubt, double kink, double size, double out_size)
{
    return (doubt + fabs(kink)) * size <= silent * out_size;
}

const struct kept *moray_witness_at(const struct witness *e, int p, int node)
{
    const struct kept *kept = p < 0 ? &e->end : &e->phase[p].kept;
    moray_kept_show(kept, p < 0 ? 0 : node);
    return kept;
}

void moray_witness_in_use(const struct witness *e, int p, int node, double *jac)
{
    const struct transcription *t = e->solution->transcription;
    const moray_map *map = p < 0 ? t->endpoint : t->phase[p].map;
    const double *values = p < 0 ? t->end_jac : t->phase[p].jac + node * map->jac.nnz;
    memset(jac, 0, (size_t)map->n_in * (size_t)map->n_out * sizeof *jac);
    for (int k = 0; k < map->jac.nnz; k++)
        jac[map->jac.col[k] * map->n_out + map->jac.row[k]] += values[k];
}
