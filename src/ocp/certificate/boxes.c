// SPDX-License-Identifier: MIT
#include "ocp/certificate/sizes.h"
#include "ocp/probe.h"

// A fixed input has no room to move in: where it is moved all the same, to see what depends on it, nothing is known of
// how far.
static void free_fixed(moray_bounds *box, int n)
{
    for (int i = 0; i < n; i++)
        if (!(box[i].lower < box[i].upper))
            box[i] = moray_free();
}

static void fill_phase(struct witness *e, int p)
{
    const struct phase_cache *cache = moray_witness_cache(e, p);
    moray_bounds *box = e->phase[p].box;
    moray_phase_box(e->solution->transcription->ocp, &e->solution->transcription->ocp->phase[p], box);
    box[cache->map->n_in - 1] = moray_between(cache->t0, cache->tf);
    free_fixed(box, cache->map->n_in);
}

static void fill_end(struct witness *e)
{
    const moray_ocp *ocp = e->solution->transcription->ocp;
    moray_bounds *box = e->end_box + moray_endpoint_inputs(ocp);
    moray_endpoint_box(ocp, e->end_box);
    for (int p = 0; p < ocp->phases; p++)
        for (int k = 0; k < ocp->phase[p].observed.n; k++) {
            for (int i = 0; i < ocp->phase[p].nx; i++)
                *box++ = ocp->phase[p].x[i];
            for (int i = 0; i < ocp->phase[p].nu; i++)
                *box++ = ocp->phase[p].u[i];
        }
    free_fixed(e->end_box, e->solution->transcription->endpoint->n_in);
}

void moray_fill_boxes(struct witness *e)
{
    for (int p = 0; p < e->solution->transcription->ocp->phases; p++)
        fill_phase(e, p);
    fill_end(e);
}
