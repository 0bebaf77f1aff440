// SPDX-License-Identifier: MIT
//
// Where the entries of the matrix go: sorted by column and row of the pivot order, repeated ones share a slot.
#include <stdlib.h>
#include <string.h>

#include "linear/parts.h"

static int upper(const struct plan *plan, const moray_pattern *pattern, int k) // its column in the lower triangle
{
    const int one = plan->position[pattern->row[k]], other = plan->position[pattern->col[k]];
    return one < other ? one : other;
}

static int lower(const struct plan *plan, const moray_pattern *pattern, int k)
{
    const int one = plan->position[pattern->row[k]], other = plan->position[pattern->col[k]];
    return one < other ? other : one;
}

typedef int key_of(const struct plan *plan, const moray_pattern *pattern, int k);

// Stable: sorting by row and then by column leaves both in order. from NULL: entries as given.
static void sort(const struct plan *plan, const moray_pattern *pattern, key_of *key, const int *from, int *to,
                 int *begin)
{
    memset(begin, 0, ((size_t)plan->n + 1) * sizeof *begin);
    for (int k = 0; k < pattern->nnz; k++)
        begin[key(plan, pattern, k) + 1]++;
    for (int c = 0; c < plan->n; c++)
        begin[c + 1] += begin[c];
    for (int t = 0; t < pattern->nnz; t++) {
        const int k = from ? from[t] : t;
        to[begin[key(plan, pattern, k)]++] = k;
    }
}

static void make_slots(struct plan *plan, const moray_pattern *pattern)
{
    int column = -1, slots = 0;
    for (int t = 0; t < pattern->nnz; t++) {
        const int c = upper(plan, pattern, plan->source[t]), row = lower(plan, pattern, plan->source[t]);
        const bool repeated = c == column && row == plan->row[slots - 1];
        while (column < c)
            plan->start[++column] = slots;
        if (!repeated)
            plan->row[slots++] = row;
        plan->slot[t] = slots - 1;
    }
    while (column < plan->n)
        plan->start[++column] = slots;
    plan->slots = slots;
}

static void find_places(struct plan *plan, int *place)
{
    for (int s = 0; s < plan->nodes; s++) {
        const struct node *node = &plan->node[s];
        const int height = node->columns + node->rows;
        moray_ldl_plan_places(plan, s, place);
        for (int c = 0; c < node->columns; c++)
            for (int k = plan->start[node->first + c]; k < plan->start[node->first + c + 1]; k++)
                plan->place[k] = c * height + place[plan->row[k]];
    }
}

moray_status moray_ldl_plan_entries(struct plan *plan, const moray_pattern *pattern, int *work)
{
    const size_t n = (size_t)plan->n, puts = (size_t)pattern->nnz;
    plan->puts = pattern->nnz;
    plan->source = malloc((4 * puts + n + 1) * sizeof *plan->source);
    if (!plan->source)
        return moray_error(MORAY_MEMORY, "no memory for %d entries", pattern->nnz);
    plan->slot = plan->source + puts;
    plan->row = plan->slot + puts;
    plan->place = plan->row + puts;
    plan->start = plan->place + puts;
    sort(plan, pattern, lower, NULL, plan->slot, work);
    sort(plan, pattern, upper, plan->slot, plan->source, work);
    make_slots(plan, pattern);
    find_places(plan, work);
    return moray_ok();
}
