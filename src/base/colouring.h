// SPDX-License-Identifier: MIT
#ifndef SRC_BASE_COLOURING_H
#define SRC_BASE_COLOURING_H

#include "moray/map.h"

// Gives every column a group such that no row holds two columns of one group, so that one directional derivative serves
// a whole group. group[cols]; empty columns get -1. Error: MORAY_MEMORY.
moray_status moray_colour_columns(const moray_pattern *pattern, int rows, int cols, int *group, int *groups);

// The same for a symmetric n x n matrix of which the pattern holds the lower triangle.
moray_status moray_colour_symmetric(const moray_pattern *lower, int n, int *group, int *groups);

// Sorts the entries by the group of their column, keeping the order within a group.
void moray_sort_by_group(moray_pattern *pattern, const int *group);

#endif
