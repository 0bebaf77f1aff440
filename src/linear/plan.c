// SPDX-License-Identifier: MIT
#include <stdlib.h>
#include <string.h>

#include "linear/parts.h"

enum { work_size = 13 };

// Multiplications and additions, before fronts are merged.
static double cost(const struct plan *plan)
{
    double sum = 0;
    for (int c = 0; c < plan->n; c++)
        sum += (double)plan->count[c] * plan->count[c];
    return sum;
}

// How strong a partner must be decides which of several stable ones is taken, and that decides the fill, which cannot
// be told beforehand: both are tried.
// other[5 n]: partners and tree of the first.
static moray_status choose_order(struct plan *plan, const struct graph *graph, int *mate, int *other, int *work)
{
    static const double strong = 0.1, stronger = 0.5;
    const size_t size = (size_t)graph->n * sizeof *mate;
    const int pairs = plan->pairs = moray_ldl_graph_pair(graph, strong, mate, work);
    MORAY_TRY(moray_ldl_graph_order(graph, mate, plan->order));
    moray_ldl_plan_tree(plan, graph, work);
    const double before = cost(plan);
    memcpy(other, mate, size);
    plan->pairs = moray_ldl_graph_pair(graph, stronger, mate, work);
    if (memcmp(other, mate, size) == 0)
        return moray_ok();
    memcpy(other + graph->n, plan->block, 4 * size);
    MORAY_TRY(moray_ldl_graph_order(graph, mate, plan->order));
    moray_ldl_plan_tree(plan, graph, work);
    if (cost(plan) < before)
        return moray_ok();
    plan->pairs = pairs;
    memcpy(mate, other, size);
    memcpy(plan->block, other + graph->n, 4 * size);
    return moray_ok();
}

static moray_status make(struct plan *plan, const struct graph *graph, const moray_pattern *pattern, int *mate)
{
    int *other = mate + graph->n, *work = other + 5 * (size_t)graph->n;
    MORAY_TRY(choose_order(plan, graph, mate, other, work));
    MORAY_TRY(moray_ldl_plan_fronts(plan, mate, work));
    MORAY_TRY(moray_ldl_plan_structure(plan, graph, work));
    return moray_ldl_plan_entries(plan, pattern, work);
}

moray_status moray_ldl_plan_new(struct plan *plan, const struct graph *graph, const moray_pattern *pattern)
{
    const size_t n = (size_t)graph->n;
    *plan = (struct plan){.n = graph->n};
    int *work = malloc((work_size * n + 2) * sizeof *work);
    plan->block = malloc((4 * n + 1) * sizeof *plan->block);
    moray_status status = moray_error(MORAY_MEMORY, "no memory to order a matrix of %d rows", graph->n);
    if (work && plan->block) {
        plan->order = plan->block;
        plan->position = plan->order + n;
        plan->parent = plan->position + n;
        plan->count = plan->parent + n;
        status = make(plan, graph, pattern, work);
    }
    free(work);
    if (moray_failed(status))
        moray_ldl_plan_free(plan);
    return status;
}

void moray_ldl_plan_free(struct plan *plan)
{
    free(plan->block);
    free(plan->node);
    free(plan->rows);
    free(plan->source);
    *plan = (struct plan){0};
}
