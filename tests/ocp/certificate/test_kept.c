// SPDX-License-Identifier: MIT
//
// What is kept of the columns of every node, against all of them: entries that say something come back, whatever nodes
// stand between, all others are 0.
#include "tap.h"

#include <stdlib.h>
#include <string.h>

#include "ocp/certificate/kept.h"

enum { n_in = 4, n_out = 3, block = n_in * n_out, nodes = 40 };

static double all[nodes][3][block]; // jac, doubt, kink; nothing where a node is skipped
static unsigned seed = 7;

static unsigned roll(unsigned faces)
{
    seed = 1664525 * seed + 1013904223;
    return (seed >> 16) % faces;
}

// Mostly zeros; now and then what differences tell nothing of.
static void fill(struct kept *k, int n)
{
    for (int e = 0; e < block; e++) {
        const unsigned face = roll(8);
        k->jac[e] = face == 0 ? NAN : face == 1 ? roll(1000) + 1. : 0;
        k->kink[e] = face == 2 ? -3. - roll(9) : 0;
        k->doubt[e] = face == 3 ? INFINITY : 1e-3 * (1 + roll(99));
        const bool told = k->expected[e] || face < 3;
        all[n][0][e] = k->jac[e], all[n][1][e] = told ? k->doubt[e] : 0, all[n][2][e] = k->kink[e];
    }
}

static bool same(const double *found, const double *wanted)
{
    bool equal = true;
    for (int e = 0; e < block; e++)
        equal = equal && (found[e] == wanted[e] || (isnan(found[e]) && isnan(wanted[e])));
    return equal;
}

// Of nothing nothing is kept.
static void test_nothing(void)
{
    const moray_map map = {.n_in = n_in, .n_out = n_out};
    struct kept k;
    CHECK_OK(moray_kept_new(&k, &map, 3), "kept");
    for (int n = 0; n < 3; n++)
        CHECK_OK(moray_kept_add(&k), "a node without a derivative");
    CHECK(k.nodes == 3 && k.start[3] == 0 && k.room == 0, "%zu entries", k.start[3]);
    moray_kept_free(&k);
}

int main(void)
{
    test_nothing();
    int row[] = {0, 2, 1, 0}, col[] = {0, 1, 3, 3};
    const moray_map map = {.n_in = n_in, .n_out = n_out, .jac = {.nnz = 4, .row = row, .col = col}};
    struct kept k;
    CHECK_OK(moray_kept_new(&k, &map, nodes), "kept");
    for (int e = 0; e < block; e++)
        CHECK(k.expected[e] == (e == 0 || e == 5 || e == 10 || e == 9), "entry %d is %s the pattern", e,
              k.expected[e] ? "in" : "not in");
    for (int n = 0; n < nodes; n++) {
        if (n % 5 == 2) {
            moray_kept_skip(&k);
            continue;
        }
        fill(&k, n);
        CHECK_OK(moray_kept_add(&k), "a node");
    }
    CHECK(k.nodes == nodes, "%d nodes", k.nodes);
    for (int n = 0; n < nodes; n++) {
        const int node = (7 * n + 3) % nodes; // in whatever order
        moray_kept_show(&k, node);
        CHECK(same(k.jac, all[node][0]) && same(k.doubt, all[node][1]) && same(k.kink, all[node][2]),
              "node %d is as it was", node);
    }
    moray_kept_free(&k);
    CHECK(!k.jac && !k.entry, "nothing is left");
    return tap_done();
}
