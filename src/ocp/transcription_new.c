// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdlib.h>

#include "ocp/observe/observed.h"
#include "ocp/transcription.h"

static void set_row(struct transcription *t, int row, moray_bounds bounds)
{
    double *lower = t->bounds + 2 * t->layout.columns, *upper = lower + t->layout.rows;
    lower[row] = bounds.lower;
    upper[row] = bounds.upper;
}

static void set_column(struct transcription *t, int column, moray_bounds bounds)
{
    double *lower = t->bounds, *upper = lower + t->layout.columns;
    lower[column] = bounds.lower;
    upper[column] = bounds.upper;
}

// Time has a direction: a free time stays on its side of a fixed one, two free ones have a row between them.
static void set_times(struct transcription *t, const struct phase *phase, const struct phase_layout *layout)
{
    moray_bounds t0 = phase->t0, tf = phase->tf;
    if (layout->tf == absent)
        t0.upper = fmax(fmin(t0.upper, tf.upper), t0.lower);
    if (layout->t0 == absent)
        tf.lower = fmin(fmax(tf.lower, t0.lower), tf.upper);
    if (layout->t0 != absent)
        set_column(t, layout->t0, t0);
    if (layout->tf != absent)
        set_column(t, layout->tf, tf);
    if (layout->length_row != absent)
        set_row(t, layout->length_row, phase->duration);
}

// Of a held control the first node has the bounds, unless the end has its own.
static void free_held(struct transcription *t, const struct phase *phase, const struct phase_layout *layout)
{
    const int last = layout->nodes - (phase->bounds_end_controls ? 1 : 0);
    for (int n = 0; n < last; n++)
        for (int i = 0; i < phase->n_held && layout->node[n].before != absent; i++)
            set_column(t, layout->node[n].x + phase->nx + phase->held[i], moray_free());
}

static void set_phase_bounds(struct transcription *t, int p)
{
    const struct phase *phase = &t->ocp->phase[p];
    const struct phase_layout *layout = &t->layout.phase[p];
    for (int n = 0; n < layout->nodes; n++) {
        const struct node *node = &layout->node[n];
        const moray_bounds *x = n == 0 ? phase->x0 : n == layout->nodes - 1 ? phase->xf : phase->x;
        for (int r = 0; r < phase->nx; r++)
            set_column(t, node->x + r, x[r]);
        for (int r = 0; r < phase->nu && node->collocated; r++)
            set_column(t, node->x + phase->nx + r, phase->u[r]);
        for (int r = 0; r < phase->nc && node->collocated; r++)
            set_row(t, node->path + r, phase->c[r]);
    }
    for (int end = 0; end < 2; end++)
        for (int r = 0; r < phase->nu && layout->u_end[end] != absent; r++)
            set_column(t, layout->u_end[end] + r, end ? phase->uf[r] : phase->u0[r]);
    free_held(t, phase, layout);
    for (int r = 0; r < phase->nq; r++)
        set_column(t, layout->q + r, phase->q[r]); // rows of defects and integrals stay at zero
    for (int k = 0; layout->sight && k < phase->observed.n; k++)
        for (int i = 0; i < phase->nx + phase->nu; i++)
            set_column(t, layout->sight[k].x + i, moray_free());
    set_times(t, phase, layout);
}

static void set_bounds(struct transcription *t)
{
    for (int p = 0; p < t->ocp->phases; p++)
        set_phase_bounds(t, p);
    for (int i = 0; i < t->ocp->ns; i++)
        set_column(t, t->layout.s + i, t->ocp->s[i]);
    for (int i = 0; i < t->ocp->ne; i++)
        set_row(t, t->layout.events + i, t->ocp->e[i]);
    int row = t->layout.events + t->ocp->ne, k, j;
    for (int p = 0; p < t->ocp->phases; p++)
        for (int i = 0; i < moray_observed_events(&t->ocp->phase[p].observed); i++)
            set_row(t, row++, moray_observed_event(&t->ocp->phase[p].observed, i, &k, &j));
}

// A control that is no variable at an observed time is none that h depends on, see moray_fit_map_new.
static void set_observed_columns(struct transcription *t, int *column)
{
    for (int p = 0; p < t->ocp->phases; p++) {
        const struct phase *phase = &t->ocp->phase[p];
        for (int k = 0; k < phase->observed.n; k++) {
            const struct sight *sight = t->layout.phase[p].sight ? &t->layout.phase[p].sight[k] : NULL;
            const struct node *node = sight ? NULL : moray_observed_node(&t->layout, t->ocp, p, k);
            for (int i = 0; i < phase->nx + phase->nu; i++)
                *column++ = sight ? sight->x + i : i < phase->nx || node->collocated ? node->x + i : -1;
        }
    }
}

// Where each input of the endpoint map lives among the variables, in the order [x0, t0, xf, tf, q, and where
// read u0, uf of each phase, s]; -1: fixed.
static void set_end_columns(struct transcription *t)
{
    int *column = t->end_column;
    for (int p = 0; p < t->ocp->phases; p++) {
        const struct phase *phase = &t->ocp->phase[p];
        const struct phase_layout *layout = &t->layout.phase[p];
        for (int r = 0; r < phase->nx; r++)
            *column++ = layout->node[0].x + r;
        *column++ = layout->t0;
        for (int r = 0; r < phase->nx; r++)
            *column++ = layout->node[layout->nodes - 1].x + r;
        *column++ = layout->tf;
        for (int r = 0; r < phase->nq; r++)
            *column++ = layout->q + r;
        for (int end = 0; end < 2 && phase->end_controls; end++)
            for (int r = 0; r < phase->nu; r++)
                *column++ = layout->u_end[end] + r;
    }
    for (int r = 0; r < t->ocp->ns; r++)
        *column++ = t->layout.s + r;
    if (t->fit)
        set_observed_columns(t, column);
}

static void sort_by_rows(struct phase_cache *cache)
{
    const moray_pattern *jac = &cache->map->jac;
    int *next = cache->row_start + 1; // filled up to where each row's own ends
    for (int k = 0; k < jac->nnz; k++)
        next[jac->row[k]]++;
    for (int r = 0, sum = 0; r < cache->map->n_out; r++) {
        const int own = next[r];
        next[r] = sum;
        sum += own;
    }
    for (int k = 0; k < jac->nnz; k++)
        cache->entry[next[jac->row[k]]++] = k;
}

static moray_status allocate_phase_cache(struct transcription *t, int p)
{
    const moray_map *map = t->ocp->phase[p].map;
    struct phase_cache *cache = &t->phase[p];
    cache->map = map;
    const size_t nodes = (size_t)t->layout.phase[p].nodes;
    cache->in = calloc(nodes * map->n_in, sizeof(double));
    cache->out = calloc(nodes * map->n_out, sizeof(double));
    cache->jac = calloc(nodes * map->jac.nnz + 1, sizeof(double));
    cache->lambda = calloc(nodes * t->ocp->phase[p].nx, sizeof(double));
    cache->column = calloc((size_t)map->n_in, sizeof(int));
    cache->held = calloc((size_t)map->n_in, sizeof(bool));
    cache->row_start = calloc((size_t)map->n_out + 1, sizeof(int));
    cache->entry = calloc((size_t)map->jac.nnz + 1, sizeof(int));
    cache->slope = calloc((size_t)map->jac.nnz + 1, sizeof(double));
    if (cache->row_start && cache->entry)
        sort_by_rows(cache);
    const bool sights = t->layout.phase[p].sight != NULL;
    cache->by_time = sights ? calloc(2 * nodes * (size_t)t->ocp->phase[p].nx, sizeof(double)) : NULL;
    if (cache->in && cache->out && cache->jac && cache->lambda && cache->column && cache->held && cache->row_start &&
        cache->entry && cache->slope && (cache->by_time || !sights))
        return moray_ok();
    return moray_error(MORAY_MEMORY, "no memory for the %d nodes of phase %s", t->layout.phase[p].nodes,
                       t->ocp->phase[p].name);
}

// Everything that solving touches is allocated here, once: no callback allocates.
static moray_status allocate(struct transcription *t)
{
    const moray_map *end = t->endpoint;
    const size_t columns = (size_t)t->layout.columns, rows = (size_t)t->layout.rows;
    int outs = end->n_out, nnz = end->hess.nnz;
    t->phase = calloc((size_t)t->ocp->phases, sizeof *t->phase);
    if (!t->phase)
        return moray_error(MORAY_MEMORY, "no memory for %d phases", t->ocp->phases);
    for (int p = 0; p < t->ocp->phases; p++) {
        const moray_map *map = t->ocp->phase[p].map;
        MORAY_TRY(allocate_phase_cache(t, p));
        outs = map->n_out > outs ? map->n_out : outs;
        nnz = map->hess.nnz > nnz ? map->hess.nnz : nnz;
    }
    t->bounds = calloc(2 * (columns + rows), sizeof(double));
    t->x = calloc(columns, sizeof(double));
    t->end_in = calloc((size_t)end->n_in + 1, sizeof(double));
    t->end_out = calloc((size_t)end->n_out, sizeof(double));
    t->end_jac = calloc((size_t)end->jac.nnz + 1, sizeof(double));
    t->end_column = calloc((size_t)end->n_in + 1, sizeof(int));
    t->weight = calloc((size_t)outs, sizeof(double));
    t->map_hess = calloc((size_t)nnz + 1, sizeof(double));
    t->no_lambda = calloc(rows + 1, sizeof(double));
    if (t->bounds && t->x && t->end_in && t->end_out && t->end_jac && t->end_column && t->weight && t->map_hess &&
        t->no_lambda)
        return moray_ok();
    return moray_error(MORAY_MEMORY, "no memory for %zu variables", columns);
}

static moray_status record_patterns(struct transcription *t)
{
    moray_triplets_record(&t->jac);
    moray_walk_jacobian(t, &t->jac);
    MORAY_TRY(moray_triplets_close(&t->jac));
    moray_triplets_record(&t->hess);
    moray_walk_hessian(t, 0, t->bounds, &t->hess); // while recording, any vector does for the multipliers
    return moray_triplets_close(&t->hess);
}

static void describe_programme(struct transcription *t)
{
    const int columns = t->layout.columns, rows = t->layout.rows;
    t->nlp = (moray_nlp){.n = columns,
                         .m = rows,
                         .x_lower = t->bounds,
                         .x_upper = t->bounds + columns,
                         .g_lower = t->bounds + 2 * columns,
                         .g_upper = t->bounds + 2 * columns + rows};
    moray_transcription_callbacks(t);
}

// Layout, memory, bounds, then one walk that records both patterns: values later follow the same walk.
moray_status moray_transcription_new(struct transcription **result, const moray_ocp *ocp, const struct mesh *meshes)
{
    *result = NULL;
    struct transcription *t = calloc(1, sizeof *t);
    if (!t)
        return moray_error(MORAY_MEMORY, "no memory for the transcription");
    t->ocp = ocp;
    t->endpoint = ocp->endpoint->map;
    moray_status status = moray_layout_new(&t->layout, ocp, meshes);
    if (!moray_failed(status))
        status = moray_fit_map_new(&t->fit, ocp, &t->layout);
    if (t->fit)
        t->endpoint = moray_fit_map(t->fit);
    if (!moray_failed(status))
        status = allocate(t);
    if (!moray_failed(status)) {
        describe_programme(t);
        set_bounds(t);
        set_end_columns(t);
        status = record_patterns(t);
    }
    if (moray_failed(status)) {
        moray_transcription_free(t);
        return status;
    }
    t->nlp.nnz_jac = t->jac.pattern.nnz, t->nlp.jac_row = t->jac.pattern.row, t->nlp.jac_col = t->jac.pattern.col;
    t->nlp.nnz_hess = t->hess.pattern.nnz, t->nlp.hess_row = t->hess.pattern.row, t->nlp.hess_col = t->hess.pattern.col;
    *result = t;
    return moray_ok();
}

void moray_transcription_free(struct transcription *t)
{
    if (!t)
        return;
    for (int p = 0; t->phase && p < t->ocp->phases; p++) {
        free(t->phase[p].in);
        free(t->phase[p].out);
        free(t->phase[p].jac);
        free(t->phase[p].lambda);
        free(t->phase[p].held);
        free(t->phase[p].by_time);
        free(t->phase[p].column);
        free(t->phase[p].row_start);
        free(t->phase[p].entry);
        free(t->phase[p].slope);
    }
    free(t->phase);
    free(t->bounds);
    free(t->scale);
    free(t->x);
    free(t->end_in);
    free(t->end_out);
    free(t->end_jac);
    free(t->end_column);
    free(t->weight);
    free(t->map_hess);
    free(t->no_lambda);
    moray_triplets_free(&t->jac);
    moray_triplets_free(&t->hess);
    moray_fit_map_free(t->fit);
    moray_layout_free(&t->layout);
    free(t);
}
