// SPDX-License-Identifier: MIT
//
// How far the functions move where what they depend on does.
#include "ocp/certificate/sizes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double trial_part = 0.1;  // of a size, by which inputs are moved
static const double least_room = 1e-3; // of that, on a side that they are moved to

// The inputs of a map and what to move them by.
struct inputs {
    const moray_map *map;
    const double *in, *out, *size;
    const moray_bounds *box;
    double *work; // [n_in + n_out]
};

// Raises out_size[n_out] to what the outputs move by where input j moves by its size, judged by its move to `to`.
static void move_input(const struct inputs *m, int j, double to, double *out_size)
{
    double *moved = m->work + m->map->n_in;
    const double part = fabs(to - m->in[j]) / m->size[j];
    m->work[j] = to;
    m->map->value(m->map->self, m->work, moved);
    m->work[j] = m->in[j];
    for (int i = 0; i < m->map->n_out; i++)
        if (isfinite(moved[i]))
            out_size[i] = fmax(out_size[i], fabs(moved[i] - m->out[i]) / part);
}

// To both sides, as far as there is room.
static void move_inputs(const struct inputs *m, double *out_size)
{
    memcpy(m->work, m->in, (size_t)m->map->n_in * sizeof *m->work);
    for (int j = 0; j < m->map->n_in; j++)
        for (int side = -1; side <= 1; side += 2) {
            const double to = m->in[j] + side * trial_part * m->size[j];
            const double within = fmin(fmax(to, m->box[j].lower), m->box[j].upper);
            if (side * (within - m->in[j]) > least_room * trial_part * m->size[j])
                move_input(m, j, within, out_size);
        }
}

moray_status moray_size_outputs(struct witness *e, int p)
{
    const struct phase_cache *cache = moray_witness_cache(e, p);
    const struct phase *phase = &e->solution->transcription->ocp->phase[p];
    const int n_in = cache->map->n_in, n_out = cache->map->n_out, g = phase->nx + phase->nc;
    double *work = calloc((size_t)(n_in + 2 * n_out), sizeof *work);
    if (!work)
        return moray_error(MORAY_MEMORY, "no memory for the certificate");
    double *here = work + n_in + n_out;
    for (int n = 0; n < moray_witness_layout(e, p)->nodes; n++) {
        const struct node *node = &moray_witness_layout(e, p)->node[n];
        if (!node->collocated)
            continue;
        memset(here, 0, (size_t)n_out * sizeof *here);
        const struct inputs inputs = {cache->map,       cache->in + n * n_in, cache->out + n * n_out,
                                      e->phase[p].size, e->phase[p].box,      work};
        move_inputs(&inputs, here);
        for (int i = 0; i < n_out; i++)
            e->phase[p].out_size[i] = fmax(e->phase[p].out_size[i], here[i]);
        for (int m = 0; m < phase->nq; m++)
            e->phase[p].integral[m] += fabs(moray_witness_span(e, p)) * node->weight * here[g + m];
    }
    free(work);
    return moray_ok();
}

moray_status moray_size_end_outputs(struct witness *e)
{
    const struct transcription *t = e->solution->transcription;
    double *work = calloc((size_t)(t->endpoint->n_in + t->endpoint->n_out), sizeof *work);
    if (!work)
        return moray_error(MORAY_MEMORY, "no memory for the certificate");
    memset(e->end_out_size, 0, (size_t)t->endpoint->n_out * sizeof *e->end_out_size);
    const struct inputs inputs = {t->endpoint, t->end_in, t->end_out, e->end_size, e->end_box, work};
    move_inputs(&inputs, e->end_out_size);
    free(work);
    return moray_ok();
}

double moray_witness_objective(const struct witness *e)
{
    return e->end_out_size[0] > 0 ? e->end_out_size[0] : 1;
}
