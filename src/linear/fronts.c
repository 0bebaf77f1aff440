// SPDX-License-Identifier: MIT
//
// Columns of L with the same rows below are eliminated in one front; fronts that hardly differ from their parent are
// merged with it, because a few zeros cost less than another front.
#include <stdlib.h>
#include <string.h>

#include "linear/parts.h"

struct merging {
    int fronts;
    int *front;                                    // [n] of a column
    int *parent, *columns, *height, *zeros, *into; // [fronts]; into: itself, or whom it has joined
};

// Whether column c and the next are a pair: such a pair is the smallest front, single columns aside.
static bool is_pair(const struct plan *plan, const int *mate, int c)
{
    return plan->parent[c] == c + 1 && mate[plan->order[c]] == plan->order[c + 1];
}

static void find_fronts(struct merging *m, const struct plan *plan, const int *mate)
{
    int f = 0, columns = 0;
    for (int c = 0; c < plan->n; c++) {
        m->front[c] = f;
        columns++;
        if (c + 1 < plan->n && is_pair(plan, mate, c))
            continue;
        m->columns[f] = columns;
        m->height[f] = columns + plan->count[c] - 1;
        m->parent[f] = plan->parent[c]; // a column still
        m->zeros[f] = 0;
        m->into[f] = f;
        columns = 0;
        f++;
    }
    m->fronts = f;
    for (f = 0; f < m->fronts; f++)
        if (m->parent[f] >= 0)
            m->parent[f] = m->front[m->parent[f]];
}

// By the share of zeros in the columns of the merged front, which may be larger where the front is small.
static bool is_worth(double columns, double height, double zeros)
{
    const double share = zeros / (columns * height);
    return columns <= 4 || (columns <= 16 && share < 0.3) || (columns <= 48 && share < 0.1) || share < 0.02;
}

static void merge(struct merging *m)
{
    for (int f = 0; f < m->fronts; f++) {
        const int up = m->parent[f];
        if (up < 0)
            continue;
        const int more = m->columns[f] * (m->columns[f] + m->height[up] - m->height[f]);
        const double zeros = (double)m->zeros[f] + m->zeros[up] + more;
        if (more > 0 && !is_worth(m->columns[f] + m->columns[up], m->columns[f] + m->height[up], zeros))
            continue;
        m->into[f] = up;
        m->columns[up] += m->columns[f];
        m->height[up] += m->columns[f];
        m->zeros[up] = (int)zeros;
    }
    for (int f = m->fronts - 1; f >= 0; f--)
        m->into[f] = m->into[m->into[f]];
}

static void link_children(struct plan *plan)
{
    for (int s = 0; s < plan->nodes; s++)
        plan->node[s].child = plan->node[s].sibling = -1;
    for (int s = plan->nodes - 1; s >= 0; s--) {
        const int up = plan->node[s].parent;
        if (up < 0)
            continue;
        plan->node[s].sibling = plan->node[up].child;
        plan->node[up].child = s;
    }
}

static void make_nodes(struct plan *plan, const struct merging *m, int *number)
{
    int s = 0, first = 0, structure = 0;
    for (int f = 0; f < m->fronts; f++)
        if (m->into[f] == f)
            number[f] = s++;
    for (int f = 0; f < m->fronts; f++) {
        if (m->into[f] != f)
            continue;
        const int rows = m->height[f] - m->columns[f];
        plan->node[number[f]] = (struct node){.parent = m->parent[f] < 0 ? -1 : number[m->into[m->parent[f]]],
                                              .first = first,
                                              .columns = m->columns[f],
                                              .rows = rows,
                                              .structure = structure};
        first += m->columns[f];
        structure += rows;
    }
    link_children(plan);
}

// Columns stay in order within a front. next[nodes] is overwritten.
static void place_columns(const struct plan *plan, const struct merging *m, const int *number, int *next, int *place)
{
    for (int s = 0; s < plan->nodes; s++)
        next[s] = plan->node[s].first;
    for (int c = 0; c < plan->n; c++)
        place[c] = next[number[m->into[m->front[c]]]]++;
}

moray_status moray_ldl_plan_fronts(struct plan *plan, const int *mate, int *work)
{
    const int n = plan->n;
    struct merging m = {.front = work,
                        .parent = work + n,
                        .columns = work + 2 * n,
                        .height = work + 3 * n,
                        .zeros = work + 4 * n,
                        .into = work + 5 * n};
    int *number = work + 6 * n;
    find_fronts(&m, plan, mate);
    merge(&m);
    plan->nodes = 0;
    for (int f = 0; f < m.fronts; f++)
        plan->nodes += m.into[f] == f;
    plan->node = calloc((size_t)plan->nodes + 1, sizeof *plan->node);
    if (!plan->node)
        return moray_error(MORAY_MEMORY, "no memory for %d fronts", plan->nodes);
    make_nodes(plan, &m, number);
    place_columns(plan, &m, number, m.zeros, m.height);
    moray_ldl_plan_renumber(plan, m.height, m.parent);
    return moray_ok();
}
