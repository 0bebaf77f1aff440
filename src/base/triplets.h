// SPDX-License-Identifier: MIT
//
// One walk over a sparse matrix serves its pattern and its values: the walk calls triplets_put for every contribution,
// always in the same order. The first walk records positions; triplets_close merges repeated ones; later walks add
// values up.
#ifndef BASE_TRIPLETS_H
#define BASE_TRIPLETS_H

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

void triplets_record(triplets *t);        // starts the recording walk
moray_status triplets_close(triplets *t); // ends it. Error: MORAY_MEMORY
void triplets_free(triplets *t);
void triplets_start(triplets *t, double *values); // starts a walk that fills values[pattern.nnz]
void triplets_record_put(triplets *t, int row, int col);

static inline void triplets_put(triplets *t, int row, int col, double value)
{
    if (t->recording)
        triplets_record_put(t, row, col);
    else
        t->values[t->slot[t->next++]] += value;
}

// For symmetric matrices: whatever the order, the entry goes to the lower triangle.
static inline void triplets_put_lower(triplets *t, int one, int other, double value)
{
    triplets_put(t, one > other ? one : other, one > other ? other : one, value);
}

#endif
