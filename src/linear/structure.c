// SPDX-License-Identifier: MIT
//
// The rows of each front, their places in its parent, and where contribution blocks lie in memory.
#include <stdlib.h>

#include "linear/parts.h"

static void add_row(struct plan *plan, const struct node *node, int s, int row, int *seen, int *count)
{
    if (row < node->first + node->columns || seen[row] == s)
        return;
    seen[row] = s;
    plan->rows[node->structure + (*count)++] = row;
}

// What the columns meet in the matrix and what the children leave.
static void find_rows(struct plan *plan, const struct graph *graph, int s, int *seen)
{
    const struct node *node = &plan->node[s];
    int count = 0;
    for (int c = node->first; c < node->first + node->columns; c++) {
        const int i = plan->order[c];
        for (int k = graph->start[i]; k < graph->start[i + 1]; k++)
            add_row(plan, node, s, plan->position[graph->near[k]], seen, &count);
    }
    for (int child = node->child; child >= 0; child = plan->node[child].sibling)
        for (int k = 0; k < plan->node[child].rows; k++)
            add_row(plan, node, s, plan->rows[plan->node[child].structure + k], seen, &count);
}

// Sorts the rows of all fronts at once: those fronts that hold a row are listed by rows, and the lists read in order.
static void sort_rows(struct plan *plan, int total, int *begin)
{
    int *holder = plan->into;
    for (int c = 0; c <= plan->n; c++)
        begin[c] = 0;
    for (int k = 0; k < total; k++)
        begin[plan->rows[k] + 1]++;
    for (int c = 0; c < plan->n; c++)
        begin[c + 1] += begin[c];
    for (int s = 0; s < plan->nodes; s++)
        for (int k = 0; k < plan->node[s].rows; k++)
            holder[begin[plan->rows[plan->node[s].structure + k]]++] = s;
    for (int c = plan->n; c > 0; c--)
        begin[c] = begin[c - 1];
    begin[0] = 0;
    for (int s = 0; s < plan->nodes; s++)
        plan->node[s].own = 0; // counts what is in place meanwhile
    for (int c = 0; c < plan->n; c++)
        for (int k = begin[c]; k < begin[c + 1]; k++) {
            struct node *node = &plan->node[holder[k]];
            plan->rows[node->structure + node->own++] = c;
        }
}

void moray_ldl_plan_places(const struct plan *plan, int s, int *place)
{
    const struct node *node = &plan->node[s];
    for (int k = 0; k < node->columns; k++)
        place[node->first + k] = k;
    for (int k = 0; k < node->rows; k++)
        place[plan->rows[node->structure + k]] = node->columns + k;
}

static void find_places(struct plan *plan, int s, int *place)
{
    const struct node *node = &plan->node[s];
    moray_ldl_plan_places(plan, s, place);
    for (int c = node->child; c >= 0; c = plan->node[c].sibling) {
        struct node *child = &plan->node[c];
        child->own = 0;
        for (int k = child->structure; k < child->structure + child->rows; k++) {
            plan->into[k] = place[plan->rows[k]];
            child->own += plan->into[k] < node->columns;
        }
    }
}

// Two stacks, for fronts at even and at odd depth: when a front is made, what lies on top of the other stack are its
// children, so that nothing is ever moved.
static void place_updates(struct plan *plan, int *odd)
{
    size_t top[2] = {0, 0}, most[2] = {0, 0};
    for (int s = plan->nodes - 1; s >= 0; s--)
        odd[s] = plan->node[s].parent >= 0 && !odd[plan->node[s].parent];
    for (int s = 0; s < plan->nodes; s++) {
        struct node *node = &plan->node[s];
        node->update = top[odd[s]];
        top[odd[s]] += (size_t)node->rows * (size_t)node->rows;
        if (top[odd[s]] > most[odd[s]])
            most[odd[s]] = top[odd[s]];
        if (node->child >= 0)
            top[!odd[s]] = plan->node[node->child].update;
    }
    for (int s = 0; s < plan->nodes; s++)
        if (odd[s])
            plan->node[s].update += most[0];
    plan->update_room = most[0] + most[1];
}

static void measure(struct plan *plan)
{
    for (int s = 0; s < plan->nodes; s++) {
        const struct node *node = &plan->node[s];
        const int height = node->columns + node->rows;
        plan->panel_room += (size_t)height * (size_t)node->columns;
        plan->tallest = height > plan->tallest ? height : plan->tallest;
        plan->widest = node->columns > plan->widest ? node->columns : plan->widest;
        for (int k = 0; k < node->columns; k++)
            plan->flops += (double)(height - k) * (height - k);
    }
}

moray_status moray_ldl_plan_structure(struct plan *plan, const struct graph *graph, int *work)
{
    const struct node *last = &plan->node[plan->nodes > 0 ? plan->nodes - 1 : 0];
    const int total = plan->nodes > 0 ? last->structure + last->rows : 0;
    plan->rows = malloc((2 * (size_t)total + 1) * sizeof *plan->rows);
    if (!plan->rows)
        return moray_error(MORAY_MEMORY, "no memory for the structure of %d fronts", plan->nodes);
    plan->into = plan->rows + total;
    for (int c = 0; c < plan->n; c++)
        work[c] = -1;
    for (int s = 0; s < plan->nodes; s++)
        find_rows(plan, graph, s, work);
    sort_rows(plan, total, work);
    for (int s = 0; s < plan->nodes; s++)
        find_places(plan, s, work);
    place_updates(plan, work);
    measure(plan);
    return moray_ok();
}
