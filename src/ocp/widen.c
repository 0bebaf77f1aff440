// SPDX-License-Identifier: MIT
#include "ocp/widen.h"

#include <stdlib.h>
#include <string.h>

#include "base/numeric_map.h"

enum { most_points = 24 }; // of those that show something new; the rest is seen when the wider map is looked at again

static moray_status widen(struct own_map **own, const moray_map **current, const double *points, int n, int *found)
{
    int now;
    struct own_map *wider = calloc(1, sizeof *wider);
    if (!wider)
        return moray_error(MORAY_MEMORY, "no memory for wider patterns");
    const moray_status status = moray_map_widened(&wider->map, *current, points, n, &now);
    if (moray_failed(status) || now == 0) {
        moray_map_release(&wider->map);
        free(wider);
        return status;
    }
    wider->older = *own;
    *own = wider;
    *current = &wider->map;
    *found += now;
    return moray_ok();
}

static moray_status widen_phase(const struct transcription *t, struct phase *phase, int p, int *found)
{
    const size_t n_in = (size_t)phase->map->n_in;
    int n = 0;
    double *points = calloc(most_points * n_in, sizeof *points);
    if (!points)
        return moray_error(MORAY_MEMORY, "no memory for wider patterns");
    for (int k = 0; k < t->layout.phase[p].nodes && n < most_points; k++) {
        const double *in = t->phase[p].in + k * n_in;
        if (t->layout.phase[p].node[k].collocated && !moray_map_pattern_holds(phase->map, in))
            memcpy(points + n++ * n_in, in, n_in * sizeof *in);
    }
    const moray_status status = n > 0 ? widen(&phase->own, &phase->map, points, n, found) : moray_ok();
    free(points);
    return status;
}

static moray_status widen_observed(const struct transcription *t, struct observed *observed, int p, int *found)
{
    const size_t n_in = (size_t)observed->map->n_in;
    int n = 0;
    double *points = calloc(most_points * n_in, sizeof *points);
    if (!points)
        return moray_error(MORAY_MEMORY, "no memory for wider patterns");
    for (int k = 0; k < observed->n && n < most_points; k++) {
        moray_fit_inputs(t->fit, p, k, t->end_in, points + n * n_in);
        n += !moray_map_pattern_holds(observed->map, points + n * n_in);
    }
    const moray_status status = n > 0 ? widen(&observed->own, &observed->map, points, n, found) : moray_ok();
    free(points);
    return status;
}

moray_status moray_widen_patterns(const struct transcription *t, int *found)
{
    const moray_ocp *ocp = t->ocp;
    *found = 0;
    for (int p = 0; p < ocp->phases; p++)
        if (ocp->phase[p].own)
            MORAY_TRY(widen_phase(t, &ocp->phase[p], p, found));
    for (int p = 0; p < ocp->phases; p++)
        if (ocp->phase[p].observed.own)
            MORAY_TRY(widen_observed(t, &ocp->phase[p].observed, p, found));
    struct endpoint *end = ocp->endpoint;
    if (end->own && !moray_map_pattern_holds(end->map, t->end_in))
        return widen(&end->own, &end->map, t->end_in, 1, found);
    return moray_ok();
}
