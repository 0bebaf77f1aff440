// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "ocp/certificate/differences.h"
#include "ocp/names.h"

static const double certain = 4; // doubts that a disagreement is to exceed
enum { name_size = 120 };

// The worst entry so far: p < 0 for the endpoint.
struct worst {
    double error, given, found;
    int p, node, row, col;
    bool missing; // from the pattern in use
};

// Derivatives that are not 0, and those of them that differences say nothing of.
struct tally {
    int all, untold;
};

// From the slope on the nearer side.
static double distance(double in_use, double jac, double kink)
{
    return fmin(fabs(in_use - (jac + kink)), fabs(in_use - (jac - kink)));
}

static void compare(const struct witness *w, int p, int n, const double *in_use, struct worst *worst,
                    struct tally *tally)
{
    const struct transcription *t = w->solution->transcription;
    const moray_map *map = p < 0 ? t->endpoint : t->phase[p].map;
    const int block = map->n_in * map->n_out;
    const struct kept *found = moray_witness_at(w, p, n);
    const double *jac = found->jac, *doubt = found->doubt, *kink = found->kink;
    const double *size = p < 0 ? w->end_size : w->phase[p].size;
    const double *out_size = p < 0 ? w->end_out_size : w->phase[p].out_size;
    const bool timeless =
        p >= 0 && t->layout.phase[p].t0 == absent && t->layout.phase[p].tf == absent; // no variable moves t
    for (int k = 0; k < block - (timeless ? map->n_out : 0); k++) {
        const int row = k % map->n_out, col = k / map->n_out;
        const double far = (distance(in_use[k], jac[k], kink[k]) - certain * doubt[k]) * size[col];
        const double moves = out_size[row] > 0 ? out_size[row] : far; // one that nothing moves has no slope
        const double error = isfinite(doubt[k]) && moves > 0 ? far / moves : 0;
        const bool speaks = moray_witness_speaks(doubt[k], kink[k], size[col], out_size[row]);
        tally->all += in_use[k] != 0 || (speaks && jac[k] != 0);
        tally->untold += in_use[k] != 0 && !speaks;
        if (error > worst->error)
            *worst = (struct worst){error, in_use[k], jac[k], p, n, row, col, !found->expected[k]};
    }
}

static void say_where(const struct witness *w, const struct worst *worst, char *where, int size)
{
    const struct transcription *t = w->solution->transcription;
    char out[name_size], in[name_size], place[name_size] = "";
    if (worst->p < 0) {
        moray_endpoint_output_name(t->ocp, worst->row, out, name_size);
        moray_endpoint_input_name(t->ocp, worst->col, in, name_size);
    } else {
        moray_phase_output_name(t->ocp, worst->p, worst->row, out, name_size);
        moray_phase_input_name(t->ocp, worst->p, worst->col, in, name_size);
        snprintf(place, sizeof place, " in phase %.60s at t = %.6g", t->ocp->phase[worst->p].name,
                 moray_layout_time(&t->layout, t->ocp, w->solution->iterate.x, worst->p,
                                   t->layout.phase[worst->p].node[worst->node].tau));
    }
    snprintf(where, (size_t)size, "d (%s) / d (%s) is %.6g, by differences %.6g%s%s", out, in, worst->given,
             worst->found, place, worst->missing ? ": its pattern lacks it" : "");
}

moray_status moray_compare_columns(const struct witness *w, double *worst, double *untold, char *where, int size)
{
    const struct transcription *t = w->solution->transcription;
    size_t room = (size_t)t->endpoint->n_in * (size_t)t->endpoint->n_out;
    for (int p = 0; p < t->ocp->phases; p++) {
        const size_t block = (size_t)t->phase[p].map->n_in * (size_t)t->phase[p].map->n_out;
        room = block > room ? block : room;
    }
    double *in_use = calloc(room, sizeof *in_use);
    if (!in_use)
        return moray_error(MORAY_MEMORY, "no memory for the certificate");
    struct worst found = {.p = -1};
    struct tally tally = {0};
    moray_witness_in_use(w, -1, 0, in_use);
    compare(w, -1, 0, in_use, &found, &tally);
    for (int p = 0; p < t->ocp->phases; p++)
        for (int n = 0; n < t->layout.phase[p].nodes; n++)
            if (t->layout.phase[p].node[n].collocated) {
                moray_witness_in_use(w, p, n, in_use);
                compare(w, p, n, in_use, &found, &tally);
            }
    *worst = found.error;
    *untold = tally.all > 0 ? (double)tally.untold / tally.all : 0;
    where[0] = 0;
    if (found.error > 0)
        say_where(w, &found, where, size);
    free(in_use);
    return moray_ok();
}
