// SPDX-License-Identifier: MIT
#include <stdlib.h>

#include "linear/parts.h"

enum { work_size = 8 };

static moray_status make(struct plan *plan, const struct graph *graph, const int *mate, const moray_pattern *pattern,
                         int *work)
{
    MORAY_TRY(moray_ldl_graph_order(graph, mate, plan->order));
    moray_ldl_plan_tree(plan, graph, work);
    MORAY_TRY(moray_ldl_plan_fronts(plan, mate, work));
    MORAY_TRY(moray_ldl_plan_structure(plan, graph, work));
    return moray_ldl_plan_entries(plan, pattern, work);
}

moray_status moray_ldl_plan_new(struct plan *plan, const struct graph *graph, const int *mate,
                                const moray_pattern *pattern)
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
        status = make(plan, graph, mate, pattern, work);
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
