// SPDX-License-Identifier: MIT
#include <stdlib.h>

#include "linear/parts.h"

enum { work_size = 8 };

// Multiplications and additions, before fronts are merged.
static double cost(const struct plan *plan)
{
    double sum = 0;
    for (int c = 0; c < plan->n; c++)
        sum += (double)plan->count[c] * plan->count[c];
    return sum;
}

// mate, order and tree by pairs of that strength.
static moray_status try_pairs(struct plan *plan, const struct graph *graph, double strong, int *mate, int *work)
{
    plan->pairs = moray_ldl_graph_pair(graph, strong, mate, work);
    MORAY_TRY(moray_ldl_graph_order(graph, mate, plan->order));
    moray_ldl_plan_tree(plan, graph, work);
    return moray_ok();
}

// How strong a partner must be decides which of several stable ones is taken, and that decides the fill, which cannot
// be told beforehand: both are tried.
static moray_status choose_order(struct plan *plan, const struct graph *graph, int *mate, int *work)
{
    enum { trials = 2 };
    static const double strengths[trials] = {0.1, 0.5};
    double costs[trials];
    for (int k = 0; k < trials; k++) {
        MORAY_TRY(try_pairs(plan, graph, strengths[k], mate, work));
        costs[k] = cost(plan);
    }
    return costs[1] < costs[0] ? moray_ok() : try_pairs(plan, graph, strengths[0], mate, work);
}

static moray_status make(struct plan *plan, const struct graph *graph, const moray_pattern *pattern, int *mate)
{
    int *work = mate + graph->n;
    MORAY_TRY(choose_order(plan, graph, mate, work));
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
