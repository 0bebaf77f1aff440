// SPDX-License-Identifier: MIT
//
// The order of pivots against AMD on the graph of pairs and single unknowns, set up in full.
#include "sample.h"

#include <suitesparse/amd.h>

#include "linear/parts.h"

// vertex[unknown]: pairs and single ones, numbered by their first members. Returns how many.
static int number(int n, const int *mate, int *vertex)
{
    int vertices = 0;
    for (int i = 0; i < n; i++)
        vertex[i] = mate[i] >= 0 && mate[i] < i ? vertex[mate[i]] : vertices++;
    return vertices;
}

// order <- the members of the vertices as AMD has them, the first member first.
static void order_in_full(const sample *s, const int *mate, int *order)
{
    static bool meets[MOST][MOST];
    int vertex[MOST], start[MOST + 1] = {0}, near[MOST * MOST], turn[MOST], entries = 0, k = 0;
    const int vertices = number(s->n, mate, vertex);
    memset(meets, 0, sizeof meets);
    for (int e = 0; e < s->pattern.nnz; e++) {
        const int one = vertex[s->row[e]], other = vertex[s->col[e]];
        meets[one][other] = meets[other][one] = one != other;
    }
    for (int v = 0; v < vertices; v++) {
        for (int w = 0; w < vertices; w++)
            if (meets[v][w] && v != w)
                near[entries++] = w;
        start[v + 1] = entries;
    }
    CHECK(amd_order(vertices, start, near, turn, NULL, NULL) == AMD_OK, "ordered");
    for (int t = 0; t < vertices; t++)
        for (int i = 0; i < s->n; i++)
            if (vertex[i] == turn[t])
                order[k++] = i;
}

int main(void)
{
    static sample s;
    int wrong = 0, pairs = 0, single = 0;
    for (int trial = 0; trial < 500; trial++) {
        struct graph graph;
        int mate[MOST], order[MOST], want[MOST], work[2 * MOST + 2];
        s.seed = 60 + (unsigned long long)trial;
        start(&s, 1 + pick(&s, MOST));
        const int entries = pick(&s, 4 * s.n);
        for (int e = 0; e < entries; e++)
            put(&s, pick(&s, s.n), pick(&s, s.n), tap_random(&s.seed, -1, 1));
        for (int i = 0; i < s.n; i++)
            if (pick(&s, 2))
                put(&s, i, i, 1);
        CHECK_OK(moray_ldl_graph_new(&graph, s.n, &s.pattern, s.value), "graph");
        const int found = moray_ldl_graph_pair(&graph, 0.1, mate, work);
        CHECK_OK(moray_ldl_graph_order(&graph, mate, order), "order");
        order_in_full(&s, mate, want);
        wrong += memcmp(order, want, (size_t)s.n * sizeof *order) != 0;
        pairs += found;
        single += s.n - 2 * found;
        moray_ldl_graph_free(&graph);
    }
    CHECK(wrong == 0 && pairs > 2000 && single > 2000, "%d pairs and %d single ones, but for %d graphs", pairs, single,
          wrong);
    return tap_done();
}
