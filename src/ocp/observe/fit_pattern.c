// SPDX-License-Identifier: MIT
//
// Where the entries of a fit stand: those of the endpoint, then those of each observation; entries between parameters
// are shared.
#include "ocp/observe/fit_parts.h"

#include <stdlib.h>
#include <string.h>

#include "ocp/observe/observed.h"

// Which local inputs and pairs h has: a second derivative is of inputs of one row of slopes, so that products of these
// have it.
static moray_status find_pairs(struct part *part, int ns)
{
    const int n = part->phase->nx + part->phase->nu + ns;
    const moray_map *map = part->map;
    bool *felt = calloc((size_t)n * (size_t)(n + 1) + 1, sizeof *felt), *pair = felt ? felt + n : NULL;
    part->input = calloc((size_t)n + 1, sizeof *part->input);
    part->a = calloc((size_t)n * (size_t)n + 1, sizeof *part->a);
    part->b = calloc((size_t)n * (size_t)n + 1, sizeof *part->b);
    if (!felt || !part->input || !part->a || !part->b) {
        free(felt);
        return moray_error(MORAY_MEMORY, "no memory for the observations");
    }
    for (int e = 0; e < map->jac.nnz; e++)
        for (int d = 0; d < map->jac.nnz && map->jac.col[e] < n; d++) {
            felt[map->jac.col[e]] = true;
            if (map->jac.row[d] == map->jac.row[e] && map->jac.col[d] <= map->jac.col[e])
                pair[map->jac.col[e] * n + map->jac.col[d]] = true;
        }
    for (int i = 0; i < n; i++)
        if (felt[i])
            part->input[part->inputs++] = i;
    for (int k = 0; k < n * n; k++)
        if (pair[k])
            part->a[part->pairs] = k / n, part->b[part->pairs++] = k % n;
    free(felt);
    return moray_ok();
}

static moray_status number_events(struct part *part, int event)
{
    const struct observed *o = &part->phase->observed;
    part->event = calloc((size_t)o->n * (size_t)o->ny + 1, sizeof *part->event);
    if (!part->event)
        return moray_error(MORAY_MEMORY, "no memory for the observations");
    for (int k = 0; k < o->n; k++)
        for (int j = 0; j < o->ny; j++)
            part->event[k * o->ny + j] = moray_has_residual_event(o, k, j) ? event++ : -1;
    part->sum = o->has_sum ? event : -1;
    return moray_ok();
}

moray_status moray_fit_part_new(struct part *part, const moray_ocp *ocp, int p, int first, int event)
{
    const struct phase *phase = &ocp->phase[p];
    *part = (struct part){.map = phase->observed.map, .phase = phase, .first = first, .sum = -1};
    if (phase->observed.n == 0)
        return moray_ok();
    MORAY_TRY(number_events(part, event));
    const moray_map *map = part->map;
    const size_t n = (size_t)map->n_in, ny = (size_t)map->n_out;
    part->in = calloc(2 * n + 2 * ny + (size_t)map->jac.nnz + (size_t)map->hess.nnz + n * n, sizeof *part->in);
    if (!part->in)
        return moray_error(MORAY_MEMORY, "no memory for the observations");
    part->gradient = part->in + n;
    part->out = part->gradient + n;
    part->weight = part->out + ny;
    part->jac = part->weight + ny;
    part->hess = part->jac + map->jac.nnz;
    part->bend = part->hess + map->hess.nnz;
    return find_pairs(part, ocp->ns);
}

// An entry of the pattern; one between parameters stands once, at *known unless that is negative.
static int entry(moray_pattern *pattern, int row, int col, int *known)
{
    if (known && *known >= 0)
        return *known;
    pattern->row[pattern->nnz] = row;
    pattern->col[pattern->nnz] = col;
    if (known)
        *known = pattern->nnz;
    return pattern->nnz++;
}

// Where the endpoint has entries between parameters: slope[ns] of the objective, pair[ns][ns]; -1: nowhere.
static void find_shared(const struct fit_map *fit, int *slope, int *pair)
{
    const int ns = fit->ocp->ns;
    const moray_pattern *jac = &fit->base->jac, *hess = &fit->base->hess;
    for (int i = 0; i < ns + ns * ns; i++)
        slope[i] = -1;
    for (int k = 0; k < jac->nnz; k++)
        if (jac->row[k] == 0 && jac->col[k] >= fit->s)
            slope[jac->col[k] - fit->s] = k;
    for (int k = 0; k < hess->nnz; k++)
        if (hess->col[k] >= fit->s) // and so is the row, in the lower triangle
            pair[(hess->row[k] - fit->s) * ns + hess->col[k] - fit->s] = k;
}

// Slopes of the losses of a time in an output; those by parameters stand once for all times, at slope[ns].
static void place_slopes(struct fit_map *fit, const struct part *part, int k, int output, int *slope, int *jac)
{
    for (int i = 0; i < part->inputs; i++) {
        const int at = part->input[i], s = at - moray_fit_width(part);
        fit->jac_at[(*jac)++] =
            entry(&fit->map.jac, output, moray_fit_place(fit, part, k, at), s >= 0 ? &slope[s] : NULL);
    }
}

// Of the residuals of a time that are events, in the order of the pattern of h, whose own slopes by time are none.
static void place_residuals(struct fit_map *fit, const struct part *part, int k, int *jac)
{
    const moray_pattern *h = &part->map->jac;
    for (int e = 0; e < h->nnz; e++) {
        const int output = part->event[k * part->map->n_out + h->row[e]];
        if (output >= 0 && h->col[e] < part->map->n_in - 1)
            fit->jac_at[(*jac)++] = entry(&fit->map.jac, output, moray_fit_place(fit, part, k, h->col[e]), NULL);
    }
}

// Parameters are inputs before those of the times: the lower triangle has them as columns. sum[ns]: scratch.
static void place_entries(struct fit_map *fit, int *slope, int *pair, int *sum)
{
    const int ns = fit->ocp->ns;
    int jac = 0, hess = 0;
    for (int p = 0; p < fit->ocp->phases; p++) {
        const struct part *part = &fit->part[p];
        const int w = part->phase->nx + part->phase->nu;
        for (int i = 0; i < ns; i++)
            sum[i] = -1;
        for (int k = 0; k < fit->ocp->phase[p].observed.n; k++) {
            if (!part->phase->observed.events_only)
                place_slopes(fit, part, k, 0, slope, &jac);
            if (part->sum >= 0)
                place_slopes(fit, part, k, part->sum, sum, &jac);
            place_residuals(fit, part, k, &jac);
            for (int e = 0; e < part->pairs; e++) {
                const int a = moray_fit_place(fit, part, k, part->a[e]), b = moray_fit_place(fit, part, k, part->b[e]);
                int *known = part->a[e] >= w && part->b[e] >= w ? &pair[(a - fit->s) * ns + b - fit->s] : NULL;
                fit->hess_at[hess++] = entry(&fit->map.hess, a > b ? a : b, a > b ? b : a, known);
            }
        }
    }
}

moray_status moray_fit_make_patterns(struct fit_map *fit)
{
    size_t jac = 1, hess = 1;
    for (int p = 0; p < fit->ocp->phases; p++) {
        const size_t slopes = 2 * (size_t)fit->part[p].inputs,
                     entries = fit->part[p].map ? (size_t)fit->part[p].map->jac.nnz : 0;
        jac += (slopes + entries) * (size_t)fit->ocp->phase[p].observed.n;
        hess += (size_t)fit->part[p].pairs * (size_t)fit->ocp->phase[p].observed.n;
    }
    const int base_jac = fit->base->jac.nnz, base_hess = fit->base->hess.nnz;
    fit->jac_at = calloc(jac, sizeof *fit->jac_at);
    fit->hess_at = calloc(hess, sizeof *fit->hess_at);
    if (!fit->jac_at || !fit->hess_at)
        return moray_error(MORAY_MEMORY, "no memory for the observations");
    MORAY_TRY(moray_pattern_new(&fit->map.jac, base_jac + (int)jac));
    MORAY_TRY(moray_pattern_new(&fit->map.hess, base_hess + (int)hess));
    memcpy(fit->map.jac.row, fit->base->jac.row, (size_t)base_jac * sizeof(int));
    memcpy(fit->map.jac.col, fit->base->jac.col, (size_t)base_jac * sizeof(int));
    memcpy(fit->map.hess.row, fit->base->hess.row, (size_t)base_hess * sizeof(int));
    memcpy(fit->map.hess.col, fit->base->hess.col, (size_t)base_hess * sizeof(int));
    fit->map.jac.nnz = base_jac, fit->map.hess.nnz = base_hess;
    const size_t ns = (size_t)fit->ocp->ns;
    int *shared = calloc(2 * ns + ns * ns + 1, sizeof *shared);
    if (!shared)
        return moray_error(MORAY_MEMORY, "no memory for the observations");
    find_shared(fit, shared, shared + ns);
    place_entries(fit, shared, shared + ns, shared + ns + ns * ns);
    free(shared);
    return moray_ok();
}
