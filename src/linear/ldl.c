// SPDX-License-Identifier: MIT
#include "linear/ldl.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "linear/parts.h"

static const double worn = 4; // factorisations' worth of work by delayed pivots that another order costs
// Growth of the factors by delayed pivots that ends a factorisation; but for the few that 8 MB hold.
static const double hopeless = 8, few_entries = 1e6;

static moray_status no_memory(int n)
{
    return moray_error(MORAY_MEMORY, "no memory for a sparse symmetric matrix of %d rows", n);
}

static moray_status check_pattern(int n, const moray_pattern *pattern)
{
    for (int k = 0; k < pattern->nnz; k++)
        if (pattern->row[k] < 0 || pattern->row[k] >= n || pattern->col[k] < 0 || pattern->col[k] >= n)
            return moray_error(MORAY_INPUT, "entry %d stands at (%d, %d): outside a matrix of %d rows", k,
                               pattern->row[k], pattern->col[k], n);
    return moray_ok();
}

moray_status moray_ldl_new(moray_ldl **result, int n, const moray_pattern *pattern)
{
    *result = NULL;
    MORAY_TRY(check_pattern(n, pattern));
    moray_ldl *ldl = calloc(1, sizeof *ldl);
    if (!ldl)
        return no_memory(n);
    ldl->n = n;
    const moray_status status = moray_pattern_new(&ldl->pattern, pattern->nnz);
    if (moray_failed(status)) {
        moray_ldl_free(ldl);
        return status;
    }
    memcpy(ldl->pattern.row, pattern->row, (size_t)pattern->nnz * sizeof *pattern->row);
    memcpy(ldl->pattern.col, pattern->col, (size_t)pattern->nnz * sizeof *pattern->col);
    *result = ldl;
    return moray_ok();
}

static void forget_plan(moray_ldl *ldl)
{
    moray_ldl_plan_free(&ldl->plan);
    free(ldl->front);
    free(ldl->value);
    free(ldl->update);
    free(ldl->panel);
    free(ldl->kept);
    free(ldl->pivot);
    free(ldl->index);
    free(ldl->local);
    ldl->front = NULL;
    ldl->value = ldl->update = ldl->panel = ldl->kept = ldl->pivot = ldl->local = NULL;
    ldl->index = NULL;
    ldl->planned = ldl->factored = false;
    ldl->usual = ldl->surplus = 0;
}

void moray_ldl_free(moray_ldl *ldl)
{
    if (!ldl)
        return;
    forget_plan(ldl);
    moray_pattern_free(&ldl->pattern);
    free(ldl);
}

// ---- Ordering ------------------------------------------------------------------------------------------------------

static moray_status make_plan(moray_ldl *ldl, const double *values)
{
    struct graph graph;
    moray_status status = moray_ldl_graph_new(&graph, ldl->n, &ldl->pattern, values);
    if (!moray_failed(status)) {
        moray_ldl_graph_equilibrate(&graph);
        status = moray_ldl_plan_new(&ldl->plan, &graph, &ldl->pattern);
    }
    moray_ldl_graph_free(&graph);
    return status;
}

static moray_status make_room(moray_ldl *ldl)
{
    const struct plan *plan = &ldl->plan;
    const size_t n = (size_t)plan->n, slots = (size_t)plan->slots;
    ldl->most_entries = fmax(few_entries, hopeless * (double)plan->panel_room);
    ldl->panel_room = plan->panel_room + 1;
    ldl->index_room = n + 1;
    ldl->kept_room = (size_t)plan->tallest * (size_t)plan->widest + 1;
    ldl->local_room = (size_t)plan->tallest + 1;
    ldl->front = calloc((size_t)plan->nodes + 1, sizeof *ldl->front);
    ldl->value = malloc((2 * slots + 5 * n + 1) * sizeof *ldl->value);
    ldl->update = malloc((plan->update_room + 1) * sizeof *ldl->update);
    ldl->panel = malloc(ldl->panel_room * sizeof *ldl->panel);
    ldl->kept = malloc(ldl->kept_room * sizeof *ldl->kept);
    ldl->pivot = malloc(2 * ldl->index_room * sizeof *ldl->pivot);
    ldl->index = malloc(ldl->index_room * sizeof *ldl->index);
    ldl->local = malloc(ldl->local_room * sizeof *ldl->local);
    if (!ldl->front || !ldl->value || !ldl->update || !ldl->panel || !ldl->kept || !ldl->pivot || !ldl->index ||
        !ldl->local)
        return no_memory(ldl->n);
    ldl->scaled = ldl->value + slots;
    ldl->scale = ldl->scaled + slots;
    ldl->peak = ldl->scale + n;
    ldl->permuted = ldl->peak + n;
    ldl->rhs = ldl->permuted + n;
    ldl->solution = ldl->rhs + n;
    for (size_t i = 0; i < n; i++)
        ldl->scale[i] = 1;
    return moray_ok();
}

static moray_status order(moray_ldl *ldl, const double *values)
{
    moray_status status = make_plan(ldl, values);
    if (!moray_failed(status))
        status = make_room(ldl);
    ldl->planned = !moray_failed(status);
    if (!ldl->planned)
        forget_plan(ldl);
    ldl->statistics.orders++;
    ldl->statistics.fronts = ldl->plan.nodes;
    ldl->statistics.pairs = ldl->plan.pairs;
    ldl->statistics.largest = ldl->plan.tallest;
    ldl->statistics.planned = ldl->plan.flops;
    ldl->statistics.entries = (double)ldl->plan.panel_room;
    return status;
}

// ---- Factorisation -------------------------------------------------------------------------------------------------

// Fronts one by one. Error: MORAY_NOT_SOLVED where the work passes `most` or the factors what is bearable.
static moray_status eliminate(moray_ldl *ldl, double most)
{
    ldl->panel_used = ldl->index_used = 0;
    ldl->inertia = (moray_ldl_inertia){0};
    ldl->statistics.delayed = ldl->statistics.pivots_2x2 = 0;
    ldl->statistics.done = 0;
    for (int s = 0; s < ldl->plan.nodes; s++) {
        MORAY_TRY(moray_ldl_front_assemble(ldl, s));
        moray_ldl_front_eliminate(ldl, s);
        if (ldl->statistics.done > most && s + 1 < ldl->plan.nodes)
            return moray_error(MORAY_NOT_SOLVED, "an order of pivots is worn");
    }
    ldl->statistics.filled = fmax(ldl->statistics.filled, (double)ldl->panel_used);
    return moray_ok();
}

// The first factorisation after an ordering says what the next may cost: together, in what they cost more, no more than
// another order.
static moray_status factor_ordered(moray_ldl *ldl, const double *values)
{
    const bool first = ldl->usual == 0;
    if (!moray_ldl_load(ldl, values))
        return moray_error(MORAY_NUMERIC, "a sparse matrix of %d rows is not finite", ldl->n);
    MORAY_TRY(eliminate(ldl, first ? INFINITY : (1 + worn) * ldl->usual - ldl->surplus));
    if (first)
        ldl->usual = ldl->statistics.done;
    ldl->surplus += fmax(0, ldl->statistics.done - ldl->usual);
    return moray_ok();
}

static moray_status factor(moray_ldl *ldl, const double *values)
{
    if (ldl->planned) {
        const moray_status status = factor_ordered(ldl, values);
        if (status.code != MORAY_NOT_SOLVED)
            return status;
        forget_plan(ldl);
    }
    MORAY_TRY(order(ldl, values));
    return factor_ordered(ldl, values);
}

moray_status moray_ldl_factor(moray_ldl *ldl, const double *values, double threshold)
{
    ldl->factored = false;
    ldl->threshold = threshold;
    const moray_status status = factor(ldl, values);
    ldl->factored = !moray_failed(status);
    ldl->statistics.factors++;
    return status;
}

moray_ldl_inertia moray_ldl_inertia_of(const moray_ldl *ldl)
{
    return ldl->factored ? ldl->inertia : (moray_ldl_inertia){0};
}

moray_ldl_statistics moray_ldl_statistics_of(const moray_ldl *ldl)
{
    return ldl->statistics;
}

bool moray_ldl_has_pattern(const moray_ldl *ldl, int n, const moray_pattern *pattern)
{
    const size_t size = (size_t)pattern->nnz * sizeof *pattern->row;
    return ldl->n == n && ldl->pattern.nnz == pattern->nnz && memcmp(ldl->pattern.row, pattern->row, size) == 0 &&
           memcmp(ldl->pattern.col, pattern->col, size) == 0;
}
