// SPDX-License-Identifier: MIT
//
// One walk over a sparse matrix serves its pattern and its values: the walk calls triplets_put for every contribution,
// always in the same order. The first walk records positions; moray_triplets_close merges repeated ones; later walks
// add values up.
#ifndef SRC_BASE_TRIPLETS_H
#define SRC_BASE_TRIPLETS_H

#include "moray/map.h"

typedef struct triplets {
    bool recording, failed;
    int puts, room;
    int *row, *col;        // while recording: of every put; afterwards freed
    int *slot;             // afterwards: entry of the pattern that the k-th put belongs to
    moray_pattern pattern; // sorted by row, then column
    int next;              // put that comes next in this walk
    double *values;
} triplets;

void moray_triplets_record(triplets *t);        // starts the recording walk
moray_status moray_triplets_close(triplets *t); // ends it. Error: MORAY_MEMORY
void moray_triplets_free(triplets *t);
void moray_triplets_start(triplets *t, double *values); // starts a walk that fills values[pattern.nnz]
void moray_triplets_record_put(triplets *t, int row, int col);

static inline void triplets_put(triplets *t, int row, int col, double value)
{
    if (t->recording)
        moray_triplets_record_put(t, row, col);
    else
        t->values[t->slot[t->next++]] += value;
}

// For symmetric matrices: whatever the order, the entry goes to the lower triangle.
static inline void triplets_put_lower(triplets *t, int one, int other, double value)
{
    triplets_put(t, one > other ? one : other, one > other ? other : one, value);
}

#endif
