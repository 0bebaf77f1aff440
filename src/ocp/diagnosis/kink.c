// SPDX-License-Identifier: MIT
//
// Kinks of the functions, which make a solver step to and fro: looked for between the least and the largest value that
// an input has along the last trajectory. The slope of a smooth function changes by less from one short piece to the
// next than between long ones, at a kink by the same.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "ocp/diagnosis/diagnosis.h"
#include "ocp/names.h"

enum { pieces = 16, zooms = 6, places = 5 }; // of a range; of a range, one in another; nodes of a phase
static const double stays = 0.2;             // of the change of slope between the longest pieces
static const double grows = 10;              // of the same: beyond that a jump or a pole, no kink
static const double matters = 0.05;          // of the steepest slope

struct look {
    const moray_map *map;
    double *in, *out; // [n_in], [pieces + 1][n_out]
};

// The change of slope of an output where it is largest, and the pieces around.
static double largest_change(const struct look *l, int input, int output, double *low, double *high, double *steepest)
{
    const double width = (*high - *low) / pieces, first = *low, last = *high;
    const int n_out = l->map->n_out;
    double largest = 0;
    for (int k = 0; k <= pieces; k++) {
        l->in[input] = fmin(first + k * width, last);
        l->map->value(l->map->self, l->in, l->out + k * n_out);
    }
    for (int k = 1; k < pieces; k++) {
        const double before = l->out[k * n_out + output] - l->out[(k - 1) * n_out + output],
                     after = l->out[(k + 1) * n_out + output] - l->out[k * n_out + output];
        *steepest = fmax(*steepest, fmax(fabs(before), fabs(after)) / width);
        if (fabs(after - before) / width > largest) {
            largest = fabs(after - before) / width;
            *low = fmax(first, first + (k - 1.5) * width);
            *high = fmin(last, first + (k + 1.5) * width);
        }
    }
    return largest;
}

static bool has_kink(const struct look *l, int input, int output, double low, double high, double *where)
{
    double steepest = 0, at_first = 0, change = 0;
    for (int z = 0; z < zooms; z++) {
        change = largest_change(l, input, output, &low, &high, &steepest);
        at_first = z == 0 ? change : at_first;
    }
    *where = (low + high) / 2;
    return change > stays * at_first && change < grows * at_first && change > matters * steepest;
}

static void range_of(const struct transcription *t, int p, int input, double *low, double *high)
{
    const struct phase_cache *cache = &t->phase[p];
    *low = INFINITY, *high = -INFINITY;
    for (int n = 0; n < t->layout.phase[p].nodes; n++)
        if (t->layout.phase[p].node[n].collocated) {
            *low = fmin(*low, cache->in[n * cache->map->n_in + input]);
            *high = fmax(*high, cache->in[n * cache->map->n_in + input]);
        }
}

static bool look_at(const struct evidence *e, struct look *l, int p, int node)
{
    const struct phase *phase = &e->t->ocp->phase[p];
    const double *at = e->t->phase[p].in + node * l->map->n_in;
    for (int input = 0; input < phase->nx + phase->nu; input++) {
        double low, high, where;
        range_of(e->t, p, input, &low, &high);
        memcpy(l->in, at, (size_t)l->map->n_in * sizeof *at);
        for (int output = 0; output < l->map->n_out && low < high; output++)
            if (has_kink(l, input, output, low, high, &where)) {
                char of[200], by[200];
                moray_phase_output_name(e->t->ocp, p, output, of, sizeof of);
                moray_phase_input_name(e->t->ocp, p, input, by, sizeof by);
                moray_diagnosis_say(
                    e->solution,
                    "Try: a smooth form of the %s of phase %.100s, which has a kink in %s at %.2g (|u|: of "
                    "two controls of one sign each).\n",
                    of, phase->name, by, where);
                return true;
            }
    }
    return false;
}

bool moray_has_kink(const struct evidence *e)
{
    for (int p = 0; p < e->t->ocp->phases; p++) {
        struct look l = {.map = e->t->phase[p].map};
        const int nodes = e->t->layout.phase[p].nodes;
        bool found = false;
        l.in = calloc((size_t)l.map->n_in + (pieces + 1) * (size_t)l.map->n_out, sizeof *l.in);
        if (!l.in)
            return false;
        l.out = l.in + l.map->n_in;
        for (int k = 1; k <= places && !found; k++) {
            const int node = nodes * k / (places + 1);
            found = e->t->layout.phase[p].node[node].collocated && look_at(e, &l, p, node);
        }
        free(l.in);
        if (found)
            return true;
    }
    return false;
}
