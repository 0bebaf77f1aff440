// SPDX-License-Identifier: MIT
//
// Which columns share a front: pairs, and fronts merged with their parent by how many zeros that leaves, counted here
// from the entries of all columns.
#include "sample.h"

#include "linear/parts.h"

enum { KINDS = 5 };

// Bands, crowded graphs, sparse ones, blocks that a few unknowns join, and chains of constraints.
static void make(sample *s, unsigned long long seed)
{
    s->seed = seed;
    start(s, seed % 3 ? MOST : 1 + pick(s, MOST));
    const int kind = (int)(seed % KINDS), band = 1 + pick(s, s->n), size = 2 + pick(s, 30);
    const bool paired = pick(s, 2);
    for (int i = 0; i < s->n; i++)
        if (!paired || i % 2)
            put(s, i, i, 4);
    for (int i = 0; i < s->n; i++)
        for (int j = 0; j < i; j++) {
            const bool near = kind == 0   ? i - j < band
                              : kind == 1 ? pick(s, 4) > 0
                              : kind == 2 ? pick(s, s->n) < 2
                              : kind == 3 ? i / size == j / size || j % size == 0
                                          : i - j < 3 && pick(s, 4) > 0;
            if (near)
                put(s, i, j, pick(s, 3) ? 1 : 0.3);
        }
}

// An order with its tree, and who are partners.
struct ordered {
    int mate[MOST], block[4 * MOST];
    struct plan plan;
};

static double order_by(const struct graph *graph, double strong, struct ordered *o)
{
    int work[4 * MOST + 4];
    double cost = 0;
    o->plan = (struct plan){.n = graph->n,
                            .order = o->block,
                            .position = o->block + MOST,
                            .parent = o->block + 2 * MOST,
                            .count = o->block + 3 * MOST};
    moray_ldl_graph_pair(graph, strong, o->mate, work);
    CHECK_OK(moray_ldl_graph_order(graph, o->mate, o->plan.order), "order");
    moray_ldl_plan_tree(&o->plan, graph, work);
    for (int c = 0; c < graph->n; c++)
        cost += o->plan.count[c] * o->plan.count[c];
    return cost;
}

// Fronts as they are merged: how many columns, entries in them and rows of the first.
struct fronts {
    int n, of[MOST], parent[MOST], columns[MOST], entries[MOST], height[MOST];
};

static void find_first(const struct ordered *o, struct fronts *f)
{
    const struct plan *plan = &o->plan;
    *f = (struct fronts){0};
    for (int c = 0; c < plan->n; c++, f->n++) {
        const bool pair = c + 1 < plan->n && plan->parent[c] == c + 1 && o->mate[plan->order[c]] == plan->order[c + 1];
        const int last = c + pair, count = plan->count[last];
        f->of[c] = f->of[last] = f->n;
        f->columns[f->n] = 1 + pair;
        f->height[f->n] = count + pair;
        f->entries[f->n] = count + pair * (count + 1);
        f->parent[f->n] = plan->parent[last];
        c = last;
    }
    for (int k = 0; k < f->n; k++)
        f->parent[k] = f->parent[k] < 0 ? -1 : f->of[f->parent[k]];
}

// In columns that begin one below the other.
static int zeros_in(int columns, int height, int entries)
{
    return columns * height - columns * (columns - 1) / 2 - entries;
}

static bool is_worth(int columns, double share)
{
    return columns <= 4 ? true : columns <= 16 ? share < 0.3 : columns <= 48 ? share < 0.1 : share < 0.02;
}

// Children before parents, each with what its parent has become by then. Returns how many were kept apart.
static int merge(struct fronts *f)
{
    int kept = 0, into[MOST];
    for (int k = 0; k < f->n; k++) {
        const int up = f->parent[k];
        into[k] = k;
        if (up < 0)
            continue;
        const int columns = f->columns[k] + f->columns[up], height = f->columns[k] + f->height[up];
        const int entries = f->entries[k] + f->entries[up], zeros = zeros_in(columns, height, entries);
        const int before = zeros_in(f->columns[k], f->height[k], f->entries[k]) +
                           zeros_in(f->columns[up], f->height[up], f->entries[up]);
        if (zeros > before && !is_worth(columns, zeros / ((double)columns * height))) {
            kept++;
            continue;
        }
        into[k] = up;
        f->columns[up] = columns, f->height[up] = height, f->entries[up] = entries;
    }
    for (int k = f->n - 1; k >= 0; k--)
        into[k] = into[into[k]];
    for (int c = 0; c < MOST; c++)
        f->of[c] = into[f->of[c]];
    return kept;
}

static int front_of(const struct plan *plan, int c)
{
    int s = 0;
    while (c >= plan->node[s].first + plan->node[s].columns)
        s++;
    return s;
}

static void test_fronts(void)
{
    static sample s;
    int wrong = 0, kept = 0, merged = 0, large = 0;
    for (int trial = 0; trial < 1200; trial++) {
        struct graph graph;
        struct plan plan;
        static struct ordered o[2];
        struct fronts fronts;
        make(&s, 4000 + (unsigned long long)trial);
        CHECK_OK(moray_ldl_graph_new(&graph, s.n, &s.pattern, s.value), "graph");
        moray_ldl_graph_equilibrate(&graph);
        CHECK_OK(moray_ldl_plan_new(&plan, &graph, &s.pattern), "plan");
        const double first = order_by(&graph, 0.1, &o[0]), second = order_by(&graph, 0.5, &o[1]);
        const struct ordered *taken = &o[second < first];
        find_first(taken, &fronts);
        const int apart = merge(&fronts);
        bool same = true;
        for (int c = 0; c < s.n; c++)
            for (int d = 0; d < c; d++) {
                const int one = plan.position[taken->plan.order[c]], other = plan.position[taken->plan.order[d]];
                same = same && (front_of(&plan, one) == front_of(&plan, other)) == (fronts.of[c] == fronts.of[d]);
            }
        wrong += !same;
        kept += apart;
        merged += fronts.n - plan.nodes;
        large += plan.widest > 48;
        moray_ldl_plan_free(&plan);
        moray_ldl_graph_free(&graph);
    }
    CHECK(wrong == 0, "the same fronts, but for %d", wrong);
    CHECK(kept > 1000 && merged > 1000 && large > 50, "%d merged, %d kept apart; %d times more than 48 columns", merged,
          kept, large);
}

int main(void)
{
    test_fronts();
    return tap_done();
}
