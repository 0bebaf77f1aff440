// SPDX-License-Identifier: MIT
//
// What a control that stands still, or a parameter near 0, could do is told by its box, not by the solution. Each is as
// large as tells: as moves an output by a part of the most that this is.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "ocp/certificate/sizes.h"
#include "ocp/probe.h"

static const double telling = 1e-2;
static const double idle = 1e-2; // of the width of its box: what is smaller stands still

// most: |outputs| at most, of each phase in turn, then of the endpoint; work: [inputs + outputs] of the largest
// function.
struct watch {
    struct witness *e;
    double *most, *work;
};

static const moray_ocp *ocp_of(const struct watch *w)
{
    return w->e->solution->transcription->ocp;
}

static double *most_of(const struct watch *w, int p)
{
    double *most = w->most;
    for (int k = 0; k < p; k++)
        most += moray_witness_cache(w->e, k)->map->n_out;
    return most;
}

// Whether input j moved by `size`, to either side, tells at a point.
static bool tells(const struct watch *w, const moray_map *map, const double *in, const double *out,
                  const moray_bounds *box, int j, double size, const double *most)
{
    double *moved = w->work + map->n_in;
    bool found = false;
    memcpy(w->work, in, (size_t)map->n_in * sizeof *w->work);
    for (int side = -1; side <= 1 && !found; side += 2) {
        w->work[j] = fmin(fmax(in[j] + side * size, box[j].lower), box[j].upper);
        map->value(map->self, w->work, moved);
        for (int i = 0; i < map->n_out && !found; i++)
            found = !(fabs(moved[i] - out[i]) <= telling * most[i]); // what is not finite as well
    }
    return found;
}

static bool tells_along(const struct watch *w, int p, int j, double size)
{
    const struct phase_cache *cache = moray_witness_cache(w->e, p);
    for (int n = 0; n < moray_witness_layout(w->e, p)->nodes; n++)
        if (moray_witness_layout(w->e, p)->node[n].collocated &&
            tells(w, cache->map, cache->in + n * cache->map->n_in, cache->out + n * cache->map->n_out,
                  w->e->phase[p].box, j, size, most_of(w, p)))
            return true;
    return false;
}

static int place_of_parameter(const struct watch *w, int p, int k)
{
    return ocp_of(w)->phase[p].nx + ocp_of(w)->phase[p].nu + k;
}

static bool parameter_tells(const struct watch *w, int k, double size)
{
    const struct transcription *t = w->e->solution->transcription;
    int place = k;
    for (int p = 0; p < t->ocp->phases; p++) {
        if (tells_along(w, p, place_of_parameter(w, p, k), size))
            return true;
        place += moray_end_inputs(&t->ocp->phase[p]);
    }
    return tells(w, t->endpoint, t->end_in, t->end_out, w->e->end_box, place, size, most_of(w, t->ocp->phases));
}

// Control j of phase p, or parameter j where p is -1.
static double grown(const struct watch *w, int p, int j, double size, moray_bounds box)
{
    const double width = moray_witness_width(box);
    if (size >= idle * width)
        return size;
    for (; size < width; size *= 10)
        if (p < 0 ? parameter_tells(w, j, size) : tells_along(w, p, j, size))
            return size;
    return width;
}

static void grow_controls(const struct watch *w, int p)
{
    struct phase_witness *phase = &w->e->phase[p];
    const int nx = ocp_of(w)->phase[p].nx;
    for (int j = nx; j < place_of_parameter(w, p, 0); j++)
        phase->size[j] = grown(w, p, j, phase->size[j], phase->box[j]);
}

static void grow_parameter(const struct watch *w, int k)
{
    double size = 0;
    for (int p = 0; p < ocp_of(w)->phases; p++)
        size = fmax(size, w->e->phase[p].size[place_of_parameter(w, p, k)]);
    const double larger = grown(w, -1, k, size, w->e->phase[0].box[place_of_parameter(w, 0, k)]);
    for (int p = 0; p < ocp_of(w)->phases && larger > size; p++)
        w->e->phase[p].size[place_of_parameter(w, p, k)] = larger;
}

static void note_most(const double *out, int n, double *most)
{
    for (int i = 0; i < n; i++)
        most[i] = fmax(most[i], fabs(out[i]));
}

static void find_most(const struct watch *w)
{
    const struct transcription *t = w->e->solution->transcription;
    for (int p = 0; p < t->ocp->phases; p++) {
        const struct phase_cache *cache = moray_witness_cache(w->e, p);
        for (int n = 0; n < moray_witness_layout(w->e, p)->nodes; n++)
            note_most(cache->out + n * cache->map->n_out, cache->map->n_out, most_of(w, p));
    }
    note_most(t->end_out, t->endpoint->n_out, most_of(w, t->ocp->phases));
}

moray_status moray_size_idle(struct witness *e)
{
    const struct transcription *t = e->solution->transcription;
    size_t outputs = (size_t)t->endpoint->n_out, room = (size_t)(t->endpoint->n_in + t->endpoint->n_out);
    for (int p = 0; p < t->ocp->phases; p++) {
        const moray_map *map = moray_witness_cache(e, p)->map;
        outputs += (size_t)map->n_out;
        room += (size_t)(map->n_in + map->n_out);
    }
    double *most = calloc(outputs + room, sizeof *most);
    if (!most)
        return moray_error(MORAY_MEMORY, "no memory for the certificate");
    const struct watch w = {e, most, most + outputs};
    find_most(&w);
    for (int p = 0; p < t->ocp->phases; p++)
        grow_controls(&w, p);
    for (int k = 0; k < t->ocp->ns; k++)
        grow_parameter(&w, k);
    free(most);
    return moray_ok();
}
