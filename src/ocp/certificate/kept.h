// SPDX-License-Identifier: MIT
#ifndef SRC_OCP_KEPT_H
#define SRC_OCP_KEPT_H

#include <stdbool.h>
#include <stddef.h>

#include "moray/map.h"

struct kept_entry;

// Differences of one map at many nodes. The block at hand is dense, what is kept of each is not: entries that are not
// zero, or that stand in the pattern of the map.
struct kept {
    const moray_map *map;
    double *jac, *doubt, *kink; // [n_in][n_out] the block at hand; kink: slopes on either side are jac +- kink
    // owned
    bool *expected; // [n_in][n_out]: in the pattern
    struct kept_entry *entry;
    size_t *start; // [nodes + 1] of the entries of a node
    size_t room;
    int nodes; // kept so far
};

// Error: MORAY_MEMORY. Free with moray_kept_free, which is safe after an error and on a zeroed one.
moray_status moray_kept_new(struct kept *k, const moray_map *map, int nodes);
void moray_kept_free(struct kept *k);

// Keeps the block at hand as that of the next node; or nothing, as if it were zero. Error: MORAY_MEMORY.
moray_status moray_kept_add(struct kept *k);
void moray_kept_skip(struct kept *k);

// Makes the block of a node the one at hand, with doubts of 0 where nothing was kept.
void moray_kept_show(const struct kept *k, int node);

#endif
