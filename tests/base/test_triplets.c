// SPDX-License-Identifier: MIT
//
// Walks over a sparse matrix against a dense one that adds up what is put.
#include "tap.h"

#include "base/triplets.h"

enum { ROWS = 40, COLS = 70 };

typedef struct walk {
    int rows, cols, puts;
    bool lower;
    unsigned long long seed;
} walk;

// The same puts each time, but for their values, which `scale` multiplies; into the dense sum too.
static void walk_over(const walk *w, triplets *t, double scale, double *dense, bool *there)
{
    unsigned long long seed = w->seed;
    for (int k = 0; k < w->puts; k++) {
        int row = (int)tap_random(&seed, 0, w->rows), col = (int)tap_random(&seed, 0, w->cols);
        const double value = tap_random(&seed, -1, 1);
        if (w->lower) {
            triplets_put_lower(t, row, col, scale * value);
            const int larger = row > col ? row : col;
            col = row + col - larger;
            row = larger;
        } else {
            triplets_put(t, row, col, scale * value);
        }
        dense[row * w->cols + col] += scale * value;
        there[row * w->cols + col] = true;
    }
}

static void test_walk(const walk *w)
{
    static double first[ROWS * COLS], dense[ROWS * COLS], values[ROWS * COLS];
    bool there[ROWS * COLS] = {false};
    triplets t;
    moray_triplets_record(&t);
    walk_over(w, &t, 1, first, there);
    CHECK_OK(moray_triplets_close(&t), "closed");
    int entries = 0;
    bool in_order = true;
    for (int k = 0; k < w->rows * w->cols; k++)
        if (there[k]) {
            in_order = in_order && entries < t.pattern.nnz && t.pattern.row[entries] == k / w->cols &&
                       t.pattern.col[entries] == k % w->cols;
            entries++;
        }
    CHECK(t.pattern.nnz == entries && in_order, "%d puts: %d entries, row by row", w->puts, entries);
    for (int round = 0; round < 2; round++) { // the second starts from nothing too
        for (int k = 0; k < w->rows * w->cols; k++)
            dense[k] = 0;
        moray_triplets_start(&t, values);
        walk_over(w, &t, round + 2, dense, there);
        double worst = 0;
        for (int k = 0; k < entries && in_order; k++)
            worst = tap_worse(worst, fabs(values[k] - dense[t.pattern.row[k] * w->cols + t.pattern.col[k]]));
        CHECK(worst < 1e-13, "and their sums: %.1e", worst);
    }
    moray_triplets_free(&t);
    CHECK(!t.slot && !t.pattern.row && t.pattern.nnz == 0, "nothing is left");
    moray_triplets_free(&t);
}

int main(void)
{
    // More puts than the first room, exactly as many, one, none; wide, tall, symmetric.
    const walk walks[] = {
        {ROWS, COLS, 5000, false, 1}, {ROWS, 3, 1024, false, 2}, {3, COLS, 1025, false, 3}, {ROWS, ROWS, 300, true, 4},
        {5, 5, 1, false, 5},          {5, 5, 0, false, 6},       {1, 1, 7, true, 7}};
    for (size_t k = 0; k < sizeof walks / sizeof *walks; k++)
        test_walk(&walks[k]);
    return tap_done();
}
