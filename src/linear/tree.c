// SPDX-License-Identifier: MIT
//
// The elimination tree, numbered children first, and the number of entries in each column of L.
#include <string.h>

#include "linear/parts.h"

// parent[c]: the first row below the diagonal of column c of L. ancestor[] shortens the paths walked (Liu).
static void find_parents(struct plan *plan, const struct graph *graph, int *ancestor)
{
    for (int c = 0; c < plan->n; c++) {
        const int i = plan->order[c];
        plan->parent[c] = ancestor[c] = -1;
        for (int k = graph->start[i]; k < graph->start[i + 1]; k++) {
            int r = plan->position[graph->near[k]], next;
            if (r >= c)
                continue;
            for (; ancestor[r] >= 0 && ancestor[r] != c; r = next) {
                next = ancestor[r];
                ancestor[r] = c;
            }
            if (ancestor[r] < 0)
                ancestor[r] = plan->parent[r] = c;
        }
    }
}

// Children in ascending order, so that of a pair, whose first is the last child of its second, the two stay neighbours.
static void post_order(const struct plan *plan, int *place, int *child, int *sibling, int *stack)
{
    int count = 0, depth = 0;
    memset(child, -1, (size_t)plan->n * sizeof *child);
    for (int c = plan->n - 1; c >= 0; c--)
        if (plan->parent[c] >= 0) {
            sibling[c] = child[plan->parent[c]];
            child[plan->parent[c]] = c;
        }
    for (int root = 0; root < plan->n; root++) {
        if (plan->parent[root] >= 0)
            continue;
        stack[depth++] = root;
        while (depth > 0) {
            const int c = stack[depth - 1], down = child[c];
            if (down < 0)
                place[stack[--depth]] = count++;
            else {
                child[c] = sibling[down];
                stack[depth++] = down;
            }
        }
    }
}

void moray_ldl_plan_renumber(struct plan *plan, const int *place, int *work)
{
    memcpy(work, plan->order, (size_t)plan->n * sizeof *work);
    for (int c = 0; c < plan->n; c++) {
        plan->order[place[c]] = work[c];
        plan->position[work[c]] = place[c];
    }
}

static void renumber_tree(struct plan *plan, const int *place, int *work)
{
    moray_ldl_plan_renumber(plan, place, work);
    memcpy(work, plan->parent, (size_t)plan->n * sizeof *work);
    for (int c = 0; c < plan->n; c++)
        plan->parent[place[c]] = work[c] < 0 ? -1 : place[work[c]];
}

// The columns of L that hold an entry in row i are a subtree whose leaves are among row i's neighbours; counted are the
// leaves, and what two paths from leaves have in common taken off (Gilbert, Ng and Peyton).
struct leaves {
    int *first, *most, *last, *ancestor; // least descendant; of the leaves of a row so far; the last of them
};

static int common_ancestor(struct leaves *l, int leaf)
{
    int top = leaf, next;
    while (top != l->ancestor[top])
        top = l->ancestor[top];
    for (; leaf != top; leaf = next) {
        next = l->ancestor[leaf];
        l->ancestor[leaf] = top;
    }
    return top;
}

static void count_leaf(struct plan *plan, struct leaves *l, int c, int row)
{
    if (row <= c || l->first[c] <= l->most[row])
        return;
    const int before = l->last[row];
    l->most[row] = l->first[c];
    l->last[row] = c;
    plan->count[c]++;
    if (before >= 0)
        plan->count[common_ancestor(l, before)]--;
}

static void start_leaves(struct plan *plan, struct leaves *l)
{
    for (int c = 0; c < plan->n; c++) {
        l->first[c] = l->most[c] = l->last[c] = -1;
        l->ancestor[c] = c;
    }
    for (int c = 0; c < plan->n; c++) {
        plan->count[c] = l->first[c] < 0;
        for (int j = c; j >= 0 && l->first[j] < 0; j = plan->parent[j])
            l->first[j] = c;
    }
}

static void count_columns(struct plan *plan, const struct graph *graph, struct leaves l)
{
    start_leaves(plan, &l);
    for (int c = 0; c < plan->n; c++) {
        const int up = plan->parent[c], i = plan->order[c];
        if (up >= 0)
            plan->count[up]--;
        for (int k = graph->start[i]; k < graph->start[i + 1]; k++)
            count_leaf(plan, &l, c, plan->position[graph->near[k]]);
        if (up >= 0)
            l.ancestor[c] = up;
    }
    for (int c = 0; c < plan->n; c++)
        if (plan->parent[c] >= 0)
            plan->count[plan->parent[c]] += plan->count[c];
}

void moray_ldl_plan_tree(struct plan *plan, const struct graph *graph, int *work)
{
    const int n = plan->n;
    for (int c = 0; c < n; c++)
        plan->position[plan->order[c]] = c;
    find_parents(plan, graph, work);
    post_order(plan, work, work + n, work + 2 * n, work + 3 * n);
    renumber_tree(plan, work, work + n);
    count_columns(plan, graph, (struct leaves){work, work + n, work + 2 * n, work + 3 * n});
}
