// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdlib.h>

#include "linear/parts.h"

enum { sweeps = 5 };

static moray_status allocate(struct graph *graph, int n, size_t ends)
{
    const size_t rows = (size_t)n;
    graph->n = n;
    graph->block = calloc(ends + 2 * rows + 1, sizeof *graph->block);
    graph->start = calloc(rows + 2 + ends, sizeof *graph->start);
    if (!graph->block || !graph->start)
        return moray_error(MORAY_MEMORY, "no memory to order a matrix of %d rows", n);
    graph->near = graph->start + n + 2;
    graph->size = graph->block;
    graph->diagonal = graph->block + ends;
    graph->scale = graph->diagonal + n;
    return moray_ok();
}

// Leaves where the neighbours of i begin in start[i + 1], which filling moves on to their end.
static void count(struct graph *graph, const moray_pattern *pattern)
{
    int *degree = graph->start + 1, sum = 0;
    for (int k = 0; k < pattern->nnz; k++)
        if (pattern->row[k] != pattern->col[k]) {
            degree[pattern->row[k]]++;
            degree[pattern->col[k]]++;
        }
    for (int i = 0; i < graph->n; i++) {
        const int here = degree[i];
        degree[i] = sum;
        sum += here;
    }
}

static void fill(struct graph *graph, const moray_pattern *pattern, const double *values)
{
    int *next = graph->start + 1;
    for (int k = 0; k < pattern->nnz; k++) {
        const int i = pattern->row[k], j = pattern->col[k];
        if (i == j) {
            graph->diagonal[i] += values[k];
            continue;
        }
        graph->near[next[i]] = j;
        graph->size[next[i]++] = values[k];
        graph->near[next[j]] = i;
        graph->size[next[j]++] = values[k];
    }
}

// Adds up repeated entries in place, and forgets signs. seen[j]: one more than where j was last met.
static void merge(struct graph *graph, int *seen)
{
    int kept = 0, begin = 0;
    for (int i = 0; i < graph->n; i++) {
        const int end = graph->start[i + 1], first = kept;
        for (int k = begin; k < end; k++) {
            const int j = graph->near[k], at = seen[j] - 1;
            if (at >= first) {
                graph->size[at] += graph->size[k];
                continue;
            }
            graph->near[kept] = j;
            graph->size[kept] = graph->size[k];
            seen[j] = ++kept;
        }
        begin = end;
        graph->start[i + 1] = kept;
        for (int k = first; k < kept; k++)
            graph->size[k] = fabs(graph->size[k]);
        graph->diagonal[i] = fabs(graph->diagonal[i]);
    }
}

moray_status moray_ldl_graph_new(struct graph *graph, int n, const moray_pattern *pattern, const double *values)
{
    int *seen = calloc((size_t)n + 1, sizeof *seen);
    moray_status status = allocate(graph, n, 2 * (size_t)pattern->nnz);
    if (!seen)
        status = moray_error(MORAY_MEMORY, "no memory to order a matrix of %d rows", n);
    if (!moray_failed(status)) {
        count(graph, pattern);
        fill(graph, pattern, values);
        merge(graph, seen);
    }
    free(seen);
    return status;
}

void moray_ldl_graph_free(struct graph *graph)
{
    free(graph->block);
    free(graph->start);
}

static double largest_of(const struct graph *graph, int i)
{
    const double here = graph->scale[i];
    double largest = graph->diagonal[i] * here;
    for (int k = graph->start[i]; k < graph->start[i + 1]; k++)
        if (graph->size[k] * graph->scale[graph->near[k]] > largest)
            largest = graph->size[k] * graph->scale[graph->near[k]];
    return largest * here;
}

void moray_ldl_graph_equilibrate(struct graph *graph)
{
    double *scale = graph->scale;
    for (int i = 0; i < graph->n; i++)
        scale[i] = 1;
    for (int sweep = 0; sweep < sweeps; sweep++)
        for (int i = 0; i < graph->n; i++) {
            const double largest = largest_of(graph, i);
            if (largest > 0)
                scale[i] /= sqrt(largest);
        }
    for (int i = 0; i < graph->n; i++) {
        graph->diagonal[i] *= scale[i] * scale[i];
        for (int k = graph->start[i]; k < graph->start[i + 1]; k++)
            graph->size[k] *= scale[i] * scale[graph->near[k]];
    }
}
