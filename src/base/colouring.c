// SPDX-License-Identifier: MIT
#include "base/colouring.h"

#include <stdlib.h>
#include <string.h>

// Greedy: the first group none of whose rows the column touches.
static void colour_dense(const bool *touches, int rows, int cols, bool *taken, int *group, int *groups)
{
    *groups = 0;
    for (int c = 0; c < cols; c++) {
        bool empty = true;
        for (int r = 0; r < rows && empty; r++)
            empty = !touches[r * cols + c];
        group[c] = -1;
        for (int g = 0; g < cols && !empty && group[c] < 0; g++) {
            bool clash = false;
            for (int r = 0; r < rows && !clash; r++)
                clash = touches[r * cols + c] && taken[g * rows + r];
            if (!clash)
                group[c] = g;
        }
        if (empty)
            continue;
        for (int r = 0; r < rows; r++)
            taken[group[c] * rows + r] |= touches[r * cols + c];
        if (group[c] >= *groups)
            *groups = group[c] + 1;
    }
}

static moray_status colour(const moray_pattern *pattern, bool symmetric, int rows, int cols, int *group, int *groups)
{
    const size_t size = (size_t)rows * cols + 1;
    bool *touches = calloc(size, sizeof *touches), *taken = calloc(size, sizeof *taken);
    if (touches && taken) {
        for (int k = 0; k < pattern->nnz; k++) {
            touches[pattern->row[k] * cols + pattern->col[k]] = true;
            if (symmetric)
                touches[pattern->col[k] * cols + pattern->row[k]] = true;
        }
        colour_dense(touches, rows, cols, taken, group, groups);
    }
    moray_status status =
        touches && taken ? moray_ok() : moray_error(MORAY_MEMORY, "no memory to colour %d columns", cols);
    free(touches);
    free(taken);
    return status;
}

moray_status moray_colour_columns(const moray_pattern *pattern, int rows, int cols, int *group, int *groups)
{
    return colour(pattern, false, rows, cols, group, groups);
}

moray_status moray_colour_symmetric(const moray_pattern *lower, int n, int *group, int *groups)
{
    return colour(lower, true, n, n, group, groups);
}

void moray_sort_by_group(moray_pattern *pattern, const int *group)
{
    for (int k = 1; k < pattern->nnz; k++) { // insertion sort: patterns are small and nearly sorted
        const int row = pattern->row[k], col = pattern->col[k];
        int j = k;
        for (; j > 0 && group[pattern->col[j - 1]] > group[col]; j--) {
            pattern->row[j] = pattern->row[j - 1];
            pattern->col[j] = pattern->col[j - 1];
        }
        pattern->row[j] = row;
        pattern->col[j] = col;
    }
}
