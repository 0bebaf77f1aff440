// SPDX-License-Identifier: MIT
//
// What a pattern determines, against elimination in full of the pattern: tree, counts, fronts with their rows, and
// places of all that is kept.
#include "sample.h"

#include "linear/parts.h"

// A graph of n unknowns, sparse or less so, in one piece or in several; repeated entries, and some that cancel.
static void make(sample *s, unsigned long long seed)
{
    s->seed = seed;
    start(s, pick(s, 8) == 0 ? pick(s, 4) : 1 + pick(s, MOST));
    const int kind = pick(s, 4), entries = kind == 0 ? s->n / 2 : kind == 1 ? 2 * s->n : 5 * s->n;
    const bool constraints = pick(s, 2);
    for (int k = 0; k < entries && s->n > 0; k++)
        put(s, pick(s, s->n), pick(s, s->n), tap_random(&s->seed, -1, 1));
    for (int i = 0; i < s->n; i++)
        if (!constraints || pick(s, 2))
            put(s, i, i, 3);
    if (kind == 3) // a chain with two that all meet
        for (int i = 0; i + 1 < s->n; i++) {
            put(s, i, i + 1, 1);
            put(s, s->n - 1, i, 0.5);
            put(s, i / 2, s->n - 2 >= 0 ? s->n - 2 : 0, 0.25);
        }
}

// L[c][r], r > c: whether eliminating in this order leaves an entry there.
static bool L[MOST][MOST];

static void eliminate(const sample *s, const int *position)
{
    memset(L, 0, sizeof L);
    for (int k = 0; k < s->pattern.nnz; k++) {
        const int one = position[s->row[k]], other = position[s->col[k]];
        if (one != other)
            L[one < other ? one : other][one < other ? other : one] = true;
    }
    for (int c = 0; c < s->n; c++)
        for (int i = c + 1; i < s->n; i++)
            for (int j = i + 1; j < s->n && L[c][i]; j++)
                L[i][j] = L[i][j] || L[c][j];
}

static int first_below(int n, int c)
{
    for (int r = c + 1; r < n; r++)
        if (L[c][r])
            return r;
    return -1;
}

// ---- Graph ----

static double size_between(const struct graph *graph, int i, int j)
{
    double found = 0;
    for (int k = graph->start[i]; k < graph->start[i + 1]; k++)
        if (graph->near[k] == j)
            found = found == 0 ? graph->size[k] : NAN; // once
    return found;
}

static void test_graph(void)
{
    static sample s;
    double worst = 0, uneven = 0;
    int wrong = 0;
    for (int trial = 0; trial < 200; trial++) {
        struct graph graph;
        double scale[MOST];
        make(&s, 100 + (unsigned long long)trial);
        CHECK_OK(moray_ldl_graph_new(&graph, s.n, &s.pattern, s.value), "graph");
        int ends = 0;
        for (int i = 0; i < s.n; i++) {
            for (int j = 0; j < s.n; j++)
                worst = tap_worse(
                    worst, fabs((i == j ? graph.diagonal[i] : size_between(&graph, i, j)) - fabs(s.A[i * s.n + j])));
            scale[i] = 1;
        }
        moray_ldl_graph_equilibrate(&graph);
        for (int sweep = 0; sweep < 5; sweep++)
            for (int i = 0; i < s.n; i++) {
                double largest = 0;
                for (int j = 0; j < s.n; j++)
                    largest = fmax(largest, fabs(s.A[i * s.n + j]) * scale[i] * scale[j]);
                scale[i] /= largest > 0 ? sqrt(largest) : 1;
            }
        for (int i = 0; i < s.n; i++)
            for (int j = 0; j < s.n; j++)
                uneven = tap_worse(uneven, fabs((i == j ? graph.diagonal[i] : size_between(&graph, i, j)) -
                                                fabs(s.A[i * s.n + j]) * scale[i] * scale[j]));
        for (int i = 0; i < s.n; i++)
            for (int j = 0; j < s.n; j++) {
                bool meet = false;
                for (int k = 0; k < s.pattern.nnz; k++)
                    meet = meet || (i != j && s.row[k] + s.col[k] == i + j && (s.row[k] == i || s.row[k] == j));
                ends += meet;
            }
        wrong += s.n > 0 && graph.start[s.n] != ends;
        moray_ldl_graph_free(&graph);
    }
    CHECK(worst < 1e-15, "sizes of entries, repeated ones added up: %.1e", worst);
    CHECK(uneven < 1e-13, "brought to scale as in full: %.1e", uneven);
    CHECK(wrong == 0, "each neighbour from both ends once, but for %d", wrong);
}

// ---- Tree ----

static void test_tree(void)
{
    static sample s;
    int orders = 0, parents = 0, counts = 0, ranges = 0, work[4 * MOST + 4], block[4 * MOST];
    for (int trial = 0; trial < 300; trial++) {
        struct graph graph;
        make(&s, 500 + (unsigned long long)trial);
        CHECK_OK(moray_ldl_graph_new(&graph, s.n, &s.pattern, s.value), "graph");
        struct plan plan = {
            .n = s.n, .order = block, .position = block + MOST, .parent = block + 2 * MOST, .count = block + 3 * MOST};
        for (int c = 0; c < s.n; c++)
            plan.order[c] = (c * 7 + trial) % s.n;
        if (s.n % 7 == 0)
            for (int c = 0; c < s.n; c++)
                plan.order[c] = s.n - 1 - c;
        moray_ldl_plan_tree(&plan, &graph, work);
        eliminate(&s, plan.position);
        int least[MOST];
        for (int c = 0; c < s.n; c++)
            least[c] = c;
        for (int c = 0; c < s.n; c++) {
            int count = 1;
            for (int r = c + 1; r < s.n; r++)
                count += L[c][r];
            orders += plan.position[plan.order[c]] != c;
            parents += plan.parent[c] != first_below(s.n, c);
            counts += plan.count[c] != count;
            if (plan.parent[c] >= 0 && least[c] < least[plan.parent[c]])
                least[plan.parent[c]] = least[c];
        }
        for (int c = 0; c < s.n; c++) { // children first: a subtree is all of a range
            int size = 0;
            for (int d = 0; d <= c; d++) {
                int up = d;
                while (up >= 0 && up < c)
                    up = plan.parent[up];
                size += up == c;
            }
            ranges += size != c - least[c] + 1;
        }
        moray_ldl_graph_free(&graph);
    }
    CHECK(orders == 0, "order and position are each other's reverse, but for %d", orders);
    CHECK(parents == 0, "the parent is the first row below, but for %d", parents);
    CHECK(counts == 0, "columns hold as many entries as elimination leaves, but for %d", counts);
    CHECK(ranges == 0, "subtrees are ranges, but for %d", ranges);
}

// ---- Plan ----

struct faults {
    int numbering, rows, merged, parents, into, blocks, sizes, entries, choice;
};

static int front_of(const struct plan *plan, int c)
{
    for (int s = 0; s < plan->nodes; s++)
        if (c >= plan->node[s].first && c < plan->node[s].first + plan->node[s].columns)
            return s;
    return -1;
}

static void check_numbering(const sample *s, const struct plan *plan, struct faults *f)
{
    int next = 0;
    for (int c = 0; c < s->n; c++)
        f->numbering += plan->order[c] < 0 || plan->order[c] >= s->n || plan->position[plan->order[c]] != c;
    for (int k = 0; k < plan->nodes; k++) {
        f->numbering += plan->node[k].first != next || plan->node[k].columns < 1;
        next += plan->node[k].columns;
    }
    f->numbering += next != s->n;
}

static void check_rows(const sample *s, const struct plan *plan, struct faults *f)
{
    for (int k = 0; k < plan->nodes; k++) {
        const struct node *node = &plan->node[k];
        int found = 0, own = 0;
        for (int r = node->first + node->columns; r < s->n; r++) {
            bool reached = false;
            for (int c = node->first; c < node->first + node->columns; c++)
                reached = reached || L[c][r];
            if (!reached)
                continue;
            f->rows += found >= node->rows || plan->rows[node->structure + found] != r;
            own += node->parent >= 0 && front_of(plan, r) == node->parent;
            found++;
        }
        f->rows += found != node->rows;
        f->parents += node->parent != (node->rows > 0 ? front_of(plan, plan->rows[node->structure]) : -1);
        f->parents += node->rows > 0 && node->own != own;
    }
}

// A front that its parent would take in without a zero, or that is small beside a small one, has been taken in.
static void check_merged(const struct plan *plan, struct faults *f)
{
    for (int k = 0; k < plan->nodes; k++) {
        const struct node *node = &plan->node[k], *up = &plan->node[node->parent < 0 ? 0 : node->parent];
        if (node->parent >= 0)
            f->merged += node->rows == up->columns + up->rows || node->columns + up->columns <= 4;
    }
}

// Children are listed once each; their rows find themselves in the parent's columns and rows.
static void check_children(const struct plan *plan, struct faults *f)
{
    for (int k = 0; k < plan->nodes; k++) {
        const struct node *node = &plan->node[k];
        int listed = 0, children = 0;
        for (int c = node->child; c >= 0 && listed <= plan->nodes; c = plan->node[c].sibling) {
            listed++;
            f->parents += plan->node[c].parent != k;
            for (int r = 0; r < plan->node[c].rows; r++) {
                const int at = plan->into[plan->node[c].structure + r], row = plan->rows[plan->node[c].structure + r];
                f->into +=
                    (at < node->columns ? node->first + at : plan->rows[node->structure + at - node->columns]) != row;
            }
        }
        for (int c = 0; c < plan->nodes; c++)
            children += plan->node[c].parent == k;
        f->parents += listed != children;
    }
}

static bool apart(const struct node *one, const struct node *other)
{
    const size_t a = (size_t)one->rows * (size_t)one->rows, b = (size_t)other->rows * (size_t)other->rows;
    return one->update + a <= other->update || other->update + b <= one->update;
}

static bool at_odd_depth(const struct plan *plan, int s)
{
    bool odd = false;
    for (; plan->node[s].parent >= 0; s = plan->node[s].parent)
        odd = !odd;
    return odd;
}

// While a front is made, what waits for its parent lies apart, and the front's children; each of two stacks, of even
// and of odd depth, holds no more than what waits.
static void check_blocks(const struct plan *plan, struct faults *f)
{
    size_t most[2] = {0, 0};
    for (int now = 0; now < plan->nodes; now++) {
        size_t waiting[2] = {0, 0};
        for (int one = 0; one <= now; one++)
            if (plan->node[one].parent >= now)
                waiting[at_odd_depth(plan, one)] += (size_t)(plan->node[one].rows * plan->node[one].rows);
        for (int odd = 0; odd < 2; odd++)
            most[odd] = waiting[odd] > most[odd] ? waiting[odd] : most[odd];
        for (int one = 0; one <= now; one++) {
            f->blocks += plan->node[one].update + (size_t)plan->node[one].rows * (size_t)plan->node[one].rows >
                         plan->update_room;
            for (int other = 0; other < one; other++)
                if (plan->node[one].parent >= now && plan->node[other].parent >= now)
                    f->blocks += !apart(&plan->node[one], &plan->node[other]);
        }
    }
    f->blocks += plan->update_room != most[0] + most[1];
}

static void check_sizes(const struct plan *plan, struct faults *f)
{
    size_t room = 0;
    int tallest = 0, widest = 0;
    double flops = 0;
    for (int k = 0; k < plan->nodes; k++) {
        const int columns = plan->node[k].columns, height = columns + plan->node[k].rows;
        room += (size_t)(columns * height);
        tallest = height > tallest ? height : tallest;
        widest = columns > widest ? columns : widest;
        for (int c = 0; c < columns; c++)
            flops += (height - c) * (height - c);
    }
    f->sizes += plan->panel_room != room || plan->tallest != tallest || plan->widest != widest || plan->flops != flops;
}

// Every entry given has a slot, of its column and row in the order, alone but for those at the same place.
static void check_entries(const sample *s, const struct plan *plan, struct faults *f)
{
    bool seen[ROOM] = {false};
    f->entries += plan->puts != s->pattern.nnz || plan->start[0] != 0 || plan->start[s->n] != plan->slots;
    for (int t = 0; t < plan->puts; t++) {
        const int k = plan->source[t], slot = plan->slot[t];
        if (k < 0 || k >= s->pattern.nnz || seen[k] || slot < 0 || slot >= plan->slots) {
            f->entries++;
            continue;
        }
        seen[k] = true;
        const int one = plan->position[s->row[k]], other = plan->position[s->col[k]], c = one < other ? one : other;
        f->entries += slot < plan->start[c] || slot >= plan->start[c + 1] || plan->row[slot] != one + other - c;
    }
    for (int c = 0; c < s->n; c++) {
        const struct node *node = &plan->node[front_of(plan, c)];
        const int height = node->columns + node->rows;
        for (int k = plan->start[c]; k < plan->start[c + 1]; k++) {
            const int at = plan->place[k] % height;
            f->entries += k > plan->start[c] && plan->row[k] <= plan->row[k - 1];
            f->entries += plan->place[k] / height != c - node->first ||
                          (at < node->columns ? node->first + at : plan->rows[node->structure + at - node->columns]) !=
                              plan->row[k];
        }
    }
}

// Of the two ways to choose partners that is taken which leaves less to do.
static void check_choice(const struct graph *graph, const struct plan *plan, struct faults *f)
{
    static const double strong[] = {0.1, 0.5};
    double cost[2] = {0}, taken = 0;
    int mate[MOST], work[4 * MOST + 4], block[4 * MOST], pairs[2];
    for (int k = 0; k < 2; k++) {
        struct plan one = {.n = graph->n,
                           .order = block,
                           .position = block + MOST,
                           .parent = block + 2 * MOST,
                           .count = block + 3 * MOST};
        pairs[k] = moray_ldl_graph_pair(graph, strong[k], mate, work);
        CHECK_OK(moray_ldl_graph_order(graph, mate, one.order), "order");
        moray_ldl_plan_tree(&one, graph, work);
        for (int c = 0; c < graph->n; c++)
            cost[k] += one.count[c] * one.count[c];
    }
    for (int c = 0; c < graph->n; c++)
        taken += plan->count[c] * plan->count[c];
    f->choice += taken != fmin(cost[0], cost[1]) || plan->pairs != pairs[cost[1] < cost[0]];
}

static void test_plan(void)
{
    static sample s;
    struct faults f = {0};
    for (int trial = 0; trial < 400; trial++) {
        struct graph graph;
        struct plan plan;
        make(&s, 2000 + (unsigned long long)trial);
        CHECK_OK(moray_ldl_graph_new(&graph, s.n, &s.pattern, s.value), "graph");
        moray_ldl_graph_equilibrate(&graph);
        CHECK_OK(moray_ldl_plan_new(&plan, &graph, &s.pattern), "plan");
        eliminate(&s, plan.position);
        check_numbering(&s, &plan, &f);
        check_rows(&s, &plan, &f);
        check_merged(&plan, &f);
        check_children(&plan, &f);
        check_blocks(&plan, &f);
        check_sizes(&plan, &f);
        check_entries(&s, &plan, &f);
        check_choice(&graph, &plan, &f);
        moray_ldl_plan_free(&plan);
        moray_ldl_graph_free(&graph);
    }
    CHECK(f.numbering == 0, "fronts take all positions in turn, but for %d", f.numbering);
    CHECK(f.rows == 0, "rows of fronts are what their columns reach, but for %d", f.rows);
    CHECK(f.merged == 0, "fronts are merged where that costs nothing, but for %d", f.merged);
    CHECK(f.parents == 0, "the parent holds the first of them, but for %d", f.parents);
    CHECK(f.into == 0, "each finds itself in the parent, but for %d", f.into);
    CHECK(f.blocks == 0, "what waits lies apart, but for %d", f.blocks);
    CHECK(f.sizes == 0, "sizes are the sums, but for %d", f.sizes);
    CHECK(f.entries == 0, "entries stand where they belong, but for %d", f.entries);
    CHECK(f.choice == 0, "and the order is the better of two, but for %d", f.choice);
}

int main(void)
{
    test_graph();
    test_tree();
    test_plan();
    return tap_done();
}
