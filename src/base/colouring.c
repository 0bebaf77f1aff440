// SPDX-License-Identifier: MIT
#include "base/colouring.h"

#include <stdlib.h>

static int entries(const bool *touches, int rows, int cols, int c)
{
    int n = 0;
    for (int r = 0; r < rows; r++)
        n += touches[r * cols + c];
    return n;
}

// order[cols]: columns by falling number of entries (a counting sort); start[rows + 2] is scratch. Returns how many
// are not empty.
static int order_columns(const bool *touches, int rows, int cols, int *order, int *start)
{
    for (int c = 0; c < cols; c++)
        start[rows - entries(touches, rows, cols, c) + 1]++;
    for (int k = 1; k <= rows; k++)
        start[k] += start[k - 1];
    const int filled = start[rows];
    for (int c = 0; c < cols; c++)
        order[start[rows - entries(touches, rows, cols, c)]++] = c;
    return filled;
}

static bool clashes(const bool *touches, int rows, int cols, int c, const bool *taken)
{
    for (int r = 0; r < rows; r++)
        if (touches[r * cols + c] && taken[r])
            return true;
    return false;
}

// Greedy: the first group none of whose rows the column touches.
static void colour(const bool *touches, int rows, int cols, const int *order, int filled, bool *taken, int *group,
                   int *groups)
{
    *groups = 0;
    for (int c = 0; c < cols; c++)
        group[c] = -1;
    for (int k = 0; k < filled; k++) {
        const int c = order[k];
        int g = 0;
        while (g < *groups && clashes(touches, rows, cols, c, taken + g * rows))
            g++;
        group[c] = g;
        if (g == *groups)
            ++*groups;
        for (int r = 0; r < rows; r++)
            taken[g * rows + r] |= touches[r * cols + c];
    }
}

moray_status moray_colour_columns(const bool *touches, int rows, int cols, int *group, int *groups)
{
    bool *taken = calloc((size_t)rows * cols + 1, sizeof *taken);
    int *order = calloc((size_t)cols + rows + 2, sizeof *order);
    moray_status status = moray_error(MORAY_MEMORY, "no memory to colour %d columns", cols);
    if (taken && order) {
        const int filled = order_columns(touches, rows, cols, order, order + cols);
        colour(touches, rows, cols, order, filled, taken, group, groups);
        status = moray_ok();
    }
    free(taken);
    free(order);
    return status;
}
