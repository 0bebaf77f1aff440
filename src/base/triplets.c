// SPDX-License-Identifier: MIT
#include "base/triplets.h"

#include <stdlib.h>
#include <string.h>

void moray_triplets_record(triplets *t)
{
    *t = (triplets){.recording = true};
}

void moray_triplets_record_put(triplets *t, int row, int col)
{
    if (t->puts == t->room && !t->failed) {
        const int room = t->room ? 2 * t->room : 1024;
        int *rows = realloc(t->row, (size_t)room * sizeof *rows);
        if (rows)
            t->row = rows;
        int *cols = realloc(t->col, (size_t)room * sizeof *cols);
        if (cols)
            t->col = cols;
        t->failed = !rows || !cols;
        t->room = room;
    }
    if (t->failed)
        return;
    t->row[t->puts] = row;
    t->col[t->puts++] = col;
}

// Counting sort of `order` by key, stable.
static void sort_by(const int *key, int keys, const int *order, int *sorted, int n, int *count)
{
    memset(count, 0, ((size_t)keys + 1) * sizeof *count);
    for (int k = 0; k < n; k++)
        count[key[k] + 1]++;
    for (int k = 0; k < keys; k++)
        count[k + 1] += count[k];
    for (int k = 0; k < n; k++)
        sorted[count[key[order[k]]]++] = order[k];
}

static int largest(const int *values, int n)
{
    int most = 0;
    for (int k = 0; k < n; k++)
        most = values[k] > most ? values[k] : most;
    return most;
}

// Walks the puts in sorted order and gives equal positions one slot.
static int merge(triplets *t, const int *order)
{
    int entries = 0;
    for (int k = 0; k < t->puts; k++) {
        const int here = order[k], before = k ? order[k - 1] : here;
        entries += t->row[here] != t->row[before] || t->col[here] != t->col[before];
        t->slot[here] = entries;
    }
    return t->puts ? entries + 1 : 0;
}

moray_status moray_triplets_close(triplets *t)
{
    const int n = t->puts, rows = largest(t->row, n) + 1, cols = largest(t->col, n) + 1;
    const int keys = rows > cols ? rows : cols;
    int *order = malloc((2 * (size_t)n + (size_t)keys + 1) * sizeof *order);
    t->slot = malloc(((size_t)n + 1) * sizeof *t->slot);
    moray_status status = moray_error(MORAY_MEMORY, "no memory for a sparse matrix of %d contributions", n);
    if (order && t->slot && !t->failed) {
        int *other = order + n, *count = other + n;
        for (int k = 0; k < n; k++)
            order[k] = k;
        sort_by(t->col, keys, order, other, n, count);
        sort_by(t->row, keys, other, order, n, count);
        status = moray_pattern_new(&t->pattern, merge(t, order));
    }
    for (int k = 0; k < n && !moray_failed(status); k++) {
        t->pattern.row[t->slot[k]] = t->row[k];
        t->pattern.col[t->slot[k]] = t->col[k];
    }
    free(order);
    free(t->row);
    free(t->col);
    t->row = t->col = NULL;
    t->recording = false;
    if (moray_failed(status))
        moray_triplets_free(t);
    return status;
}

void moray_triplets_start(triplets *t, double *values)
{
    t->next = 0;
    t->values = values;
    memset(values, 0, (size_t)t->pattern.nnz * sizeof *values);
}

void moray_triplets_free(triplets *t)
{
    free(t->row);
    free(t->col);
    free(t->slot);
    moray_pattern_free(&t->pattern);
    *t = (triplets){0};
}
