// SPDX-License-Identifier: MIT
//
// Minimum degree (AMD) on the graph in which a pair is one vertex, so that pairs stay together. AMD sets vertices with
// many neighbours last, which parameters and end times are.
#include <stdlib.h>
#include <suitesparse/amd.h>

#include "linear/parts.h"

struct quotient {
    int vertices;
    int *vertex, *first, *second; // [n] of an unknown; [vertices] its members, second -1: none
    int *start, *near, *seen, *turn;
    int *block;
};

static moray_status allocate(struct quotient *q, const struct graph *graph)
{
    const size_t n = (size_t)graph->n, ends = (size_t)graph->start[graph->n];
    q->block = malloc((6 * n + ends + 1) * sizeof *q->block);
    if (!q->block)
        return moray_error(MORAY_MEMORY, "no memory to order a matrix of %d rows", graph->n);
    q->vertex = q->block;
    q->first = q->vertex + n;
    q->second = q->first + n;
    q->seen = q->second + n;
    q->turn = q->seen + n;
    q->start = q->turn + n;
    q->near = q->start + n + 1;
    return moray_ok();
}

static void number(struct quotient *q, const struct graph *graph, const int *mate)
{
    q->vertices = 0;
    for (int i = 0; i < graph->n; i++) {
        if (mate[i] >= 0 && mate[i] < i)
            continue;
        q->first[q->vertices] = i;
        q->second[q->vertices] = mate[i];
        q->vertex[i] = q->vertices;
        if (mate[i] >= 0)
            q->vertex[mate[i]] = q->vertices;
        q->seen[q->vertices++] = -1;
    }
}

static void meet(struct quotient *q, const struct graph *graph, int v, int member, int *end)
{
    for (int k = graph->start[member]; k < graph->start[member + 1]; k++) {
        const int other = q->vertex[graph->near[k]];
        if (other == v || q->seen[other] == v)
            continue;
        q->seen[other] = v;
        q->near[(*end)++] = other;
    }
}

static void connect(struct quotient *q, const struct graph *graph)
{
    int end = 0;
    for (int v = 0; v < q->vertices; v++) {
        q->start[v] = end;
        meet(q, graph, v, q->first[v], &end);
        if (q->second[v] >= 0)
            meet(q, graph, v, q->second[v], &end);
    }
    q->start[q->vertices] = end;
}

static void expand(const struct quotient *q, int *order)
{
    int k = 0;
    for (int t = 0; t < q->vertices; t++) {
        const int v = q->turn[t];
        order[k++] = q->first[v];
        if (q->second[v] >= 0)
            order[k++] = q->second[v];
    }
}

moray_status moray_ldl_graph_order(const struct graph *graph, const int *mate, int *order)
{
    struct quotient q = {0};
    MORAY_TRY(allocate(&q, graph));
    number(&q, graph, mate);
    connect(&q, graph);
    const int code = amd_order(q.vertices, q.start, q.near, q.turn, NULL, NULL);
    moray_status status = moray_ok();
    if (code == AMD_OK || code == AMD_OK_BUT_JUMBLED)
        expand(&q, order);
    else
        status = moray_error(MORAY_MEMORY, "no memory to order a matrix of %d rows", graph->n);
    free(q.block);
    return status;
}
