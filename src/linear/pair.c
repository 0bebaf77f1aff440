// SPDX-License-Identifier: MIT
//
// A constraint has nothing on the diagonal, so its pivot is one with a variable that it moves: [h a; a 0], regular
// whatever h is. Pairs are found by one walk over the unknowns that need one, with a second choice for those that take
// theirs: linear time, for what is left alone delayed pivots serve.
#include <math.h>

#include "linear/parts.h"

static const double weak = 1e-2; // diagonal that makes no pivot of its own, in an equilibrated matrix

struct search {
    const struct graph *graph;
    int *mate;
    double strong; // entry that makes a pair, relative to the largest of the row
    int crowded;   // neighbours of an unknown that would bring too much fill into a pair
};

static int degree(const struct graph *graph, int i)
{
    return graph->start[i + 1] - graph->start[i];
}

static double least_strong(const struct search *search, int i)
{
    const struct graph *graph = search->graph;
    double largest = 0;
    for (int k = graph->start[i]; k < graph->start[i + 1]; k++)
        largest = graph->size[k] > largest ? graph->size[k] : largest;
    return search->strong * largest;
}

// The free neighbour of fewest neighbours among those with a strong entry; -1: none.
static int choose(const struct search *search, int i)
{
    const struct graph *graph = search->graph;
    const double least = least_strong(search, i);
    int best = -1;
    for (int k = graph->start[i]; k < graph->start[i + 1]; k++) {
        const int j = graph->near[k];
        if (search->mate[j] >= 0 || !(graph->size[k] > 0 && graph->size[k] >= least) ||
            degree(graph, j) > search->crowded)
            continue;
        if (best < 0 || degree(graph, j) < degree(graph, best))
            best = j;
    }
    return best;
}

static void join(struct search *search, int i, int j)
{
    search->mate[i] = j;
    search->mate[j] = i;
}

// Takes a partner from another unknown that finds a second one.
static bool take_over(struct search *search, int i)
{
    const struct graph *graph = search->graph;
    const double least = least_strong(search, i);
    for (int k = graph->start[i]; k < graph->start[i + 1]; k++) {
        const int j = graph->near[k], other = search->mate[j];
        if (!(graph->size[k] > 0 && graph->size[k] >= least) || other < 0 || graph->diagonal[other] >= weak)
            continue;
        const int second = choose(search, other);
        if (second < 0 || second == i)
            continue;
        join(search, other, second);
        join(search, i, j);
        return true;
    }
    return false;
}

// Unknowns of few neighbours first: they have the least choice. begin[n + 1], list[n].
static void sort_by_degree(const struct graph *graph, int *begin, int *list)
{
    const int n = graph->n;
    for (int d = 0; d <= n; d++)
        begin[d] = 0;
    for (int i = 0; i < n; i++)
        begin[degree(graph, i) + 1 <= n ? degree(graph, i) + 1 : n]++;
    for (int d = 1; d <= n; d++)
        begin[d] += begin[d - 1];
    for (int i = 0; i < n; i++)
        list[begin[degree(graph, i)]++] = i;
}

int moray_ldl_graph_pair(const struct graph *graph, double strong, int *mate, int *work)
{
    const int n = graph->n;
    struct search search = {graph, mate, strong, 16 + (int)(10 * sqrt(n))};
    int *list = work + n + 1, pairs = 0;
    for (int i = 0; i < n; i++)
        mate[i] = -1;
    sort_by_degree(graph, work, list);
    for (int k = 0; k < n; k++) {
        const int i = list[k];
        if (mate[i] >= 0 || graph->diagonal[i] >= weak || degree(graph, i) > search.crowded)
            continue;
        const int j = choose(&search, i);
        if (j >= 0)
            join(&search, i, j);
        pairs += j >= 0 || take_over(&search, i);
    }
    return pairs;
}
