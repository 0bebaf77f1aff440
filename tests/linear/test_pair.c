// SPDX-License-Identifier: MIT
//
// Partners for 2x2 pivots: by hand, and on random graphs against the rules read off a full matrix.
#include "sample.h"

#include "linear/parts.h"

// The matrix brought to scale already: sizes as they are.
static moray_status graph_of(struct graph *graph, sample *s)
{
    return moray_ldl_graph_new(graph, s->n, &s->pattern, s->value);
}

static int work[2 * MOST + 2];

// mate[] as text, of up to nine unknowns: "10-" says that 0 and 1 are a pair and 2 is alone.
static void check_pairs(const char *what, sample *s, double strong, int pairs, const char *mates)
{
    struct graph graph;
    int mate[MOST];
    char text[MOST + 1] = "";
    CHECK_OK(graph_of(&graph, s), "graph");
    const int found = moray_ldl_graph_pair(&graph, strong, mate, work);
    for (int i = 0; i < s->n; i++)
        text[i] = (char)(mate[i] < 0 ? '-' : '0' + mate[i]);
    text[s->n] = 0;
    CHECK(found == pairs && strcmp(text, mates) == 0, "%s: %d pairs, %s", what, found, text);
    moray_ldl_graph_free(&graph);
}

static void test_by_hand(void)
{
    static sample s;
    start(&s, 3);
    put(&s, 0, 0, 1), put(&s, 1, 1, 1), put(&s, 2, 0, 0.5), put(&s, 2, 1, -1);
    check_pairs("a constraint and what is stronger by half", &s, 0.6, 1, "-21");
    check_pairs("or both: the first of as few neighbours", &s, 0.4, 1, "2-0");
    check_pairs("just strong enough", &s, 0.5, 1, "2-0");
    put(&s, 2, 2, 0.01);
    check_pairs("something on the diagonal", &s, 0.5, 0, "---");
    put(&s, 2, 2, -0.0001);
    check_pairs("hardly anything there", &s, 0.5, 1, "2-0");

    start(&s, 5); // constraint 4 has one variable alone, which 3 would take first by number
    for (int i = 0; i < 3; i++)
        put(&s, i, i, 1);
    put(&s, 3, 0, 1), put(&s, 3, 1, 1), put(&s, 4, 0, 1);
    check_pairs("few neighbours choose first", &s, 0.1, 2, "43-10");

    start(&s, 6); // two constraints of two variables each; what 4 takes has fewer neighbours
    for (int i = 0; i < 4; i++)
        put(&s, i, i, 1);
    put(&s, 4, 0, 1), put(&s, 4, 1, 1), put(&s, 5, 0, 1), put(&s, 5, 2, 1);
    check_pairs("each takes who has fewest neighbours", &s, 0.1, 2, "-45-12");

    start(&s, 5); // 3 takes 0, of as few neighbours as 1; then 4, which has 0 alone, asks 3 for another
    for (int i = 0; i < 3; i++)
        put(&s, i, i, 1);
    put(&s, 3, 0, 1), put(&s, 3, 1, 1), put(&s, 0, 2, 0.05), put(&s, 4, 0, 1), put(&s, 4, 2, 0.01), put(&s, 1, 2, 0.05);
    check_pairs("a second choice for one in the way", &s, 0.1, 2, "43-10");

    start(&s, 3); // entries that are there and 0
    put(&s, 0, 0, 1), put(&s, 1, 0, 1), put(&s, 2, 0, 0);
    check_pairs("nothing makes no pair, nor takes one over", &s, 0.1, 1, "10-");
    start(&s, 0);
    check_pairs("nobody", &s, 0.1, 0, "");
}

// ---- The rules, on a full matrix ----

struct rules {
    int n, degree[MOST], crowded, mate[MOST];
    double strong;
    const struct graph *graph;
};

static double size_at(const struct rules *r, int i, int k)
{
    return r->graph->size[r->graph->start[i] + k];
}

static bool is_strong(const struct rules *r, int i, int k)
{
    double largest = 0;
    for (int l = 0; l < r->degree[i]; l++)
        largest = fmax(largest, size_at(r, i, l));
    return size_at(r, i, k) > 0 && size_at(r, i, k) >= r->strong * largest;
}

static int neighbour(const struct rules *r, int i, int k)
{
    return r->graph->near[r->graph->start[i] + k];
}

static int fewest(const struct rules *r, int i)
{
    int best = -1;
    for (int k = 0; k < r->degree[i]; k++) {
        const int j = neighbour(r, i, k);
        if (r->mate[j] < 0 && is_strong(r, i, k) && r->degree[j] <= r->crowded &&
            (best < 0 || r->degree[j] < r->degree[best]))
            best = j;
    }
    return best;
}

static bool ask_another(struct rules *r, int i)
{
    for (int k = 0; k < r->degree[i]; k++) {
        const int j = neighbour(r, i, k), other = r->mate[j];
        if (!is_strong(r, i, k) || other < 0 || r->graph->diagonal[other] >= 1e-2)
            continue;
        const int second = fewest(r, other);
        if (second < 0 || second == i)
            continue;
        r->mate[other] = second, r->mate[second] = other;
        r->mate[i] = j, r->mate[j] = i;
        return true;
    }
    return false;
}

static int pair_by_rules(struct rules *r)
{
    int pairs = 0;
    for (int i = 0; i < r->n; i++) {
        r->mate[i] = -1;
        r->degree[i] = r->graph->start[i + 1] - r->graph->start[i];
    }
    for (int degree = 0; degree < r->n; degree++)
        for (int i = 0; i < r->n; i++) {
            if (r->degree[i] != degree || r->mate[i] >= 0 || r->graph->diagonal[i] >= 1e-2 || degree > r->crowded)
                continue;
            const int j = fewest(r, i);
            if (j >= 0)
                r->mate[i] = j, r->mate[j] = i;
            pairs += j >= 0 || ask_another(r, i);
        }
    return pairs;
}

static void test_rules(void)
{
    static sample s;
    int wrong = 0, pairs = 0, lonely = 0;
    for (int trial = 0; trial < 1000; trial++) {
        struct graph graph;
        int mate[MOST];
        s.seed = 9000 + (unsigned long long)trial;
        start(&s, 1 + pick(&s, MOST));
        const int entries = pick(&s, 4 * s.n);
        for (int k = 0; k < entries; k++)
            put(&s, pick(&s, s.n), pick(&s, s.n),
                !pick(&s, 4) ? 0
                : trial % 3  ? tap_random(&s.seed, -1, 1)
                             : (trial % 2 ? 0.1 : 0.5) * (1 << pick(&s, 5)));
        for (int i = 0; i < s.n; i++)
            if (pick(&s, 2))
                put(&s, i, i, pick(&s, 3) ? 0.01 : 0.0099);
        CHECK_OK(graph_of(&graph, &s), "graph");
        struct rules r = {
            .n = s.n, .graph = &graph, .strong = trial % 2 ? 0.1 : 0.5, .crowded = 16 + (int)(10 * sqrt(s.n))};
        const int expected = pair_by_rules(&r), found = moray_ldl_graph_pair(&graph, r.strong, mate, work);
        wrong += found != expected || memcmp(mate, r.mate, (size_t)s.n * sizeof *mate) != 0;
        pairs += found;
        lonely += s.n - 2 * found;
        moray_ldl_graph_free(&graph);
    }
    CHECK(wrong == 0 && pairs > 3000 && lonely > 3000, "%d pairs and %d alone by the rules, but for %d graphs", pairs,
          lonely, wrong);
}

// ---- Crowds ----

// Constraints that all meet one variable and one of their own: of as many neighbours as it may have that is taken where
// it is the first, with one more it is nobody's partner.
static void test_crowd(int constraints, bool crowded)
{
    const int n = 2 * constraints + 1;
    int *row = calloc(8 * (size_t)n, sizeof *row), *col = row + 4 * n, *mate = calloc(4 * (size_t)n + 4, sizeof *mate),
        k = 0;
    double *value = calloc(4 * (size_t)n, sizeof *value);
    struct graph graph;
    for (int i = 0; i < constraints; i++) {
        row[k] = 2 * i + 1, col[k] = 0, value[k++] = 1;
        row[k] = 2 * i + 1, col[k] = 2 * i + 2, value[k++] = i == 0 ? 0.05 : 1;
        row[k] = col[k] = 2 * i + 2, value[k++] = 1;
    }
    row[k] = col[k] = 0, value[k++] = 1;
    CHECK_OK(moray_ldl_graph_new(&graph, n, &(moray_pattern){k, row, col}, value), "graph");
    const int pairs = moray_ldl_graph_pair(&graph, 0.1, mate, mate + n);
    CHECK(pairs == constraints - crowded && mate[0] == (crowded ? -1 : 1), "%d constraints: %d pairs, the first has %d",
          constraints, pairs, mate[0]);
    moray_ldl_graph_free(&graph);
    free(row), free(value), free(mate);
}

// A constraint of as many variables as it may have takes one of them, with one more it takes none.
static void test_crowded(int variables, int pairs)
{
    int *row = calloc(8 * (size_t)variables, sizeof *row), *col = row + 4 * variables, k = 0;
    int *mate = calloc(4 * (size_t)variables + 8, sizeof *mate);
    double *value = calloc(4 * (size_t)variables, sizeof *value);
    struct graph graph;
    for (int i = 0; i < variables; i++) {
        row[k] = col[k] = i, value[k++] = 1;
        row[k] = variables, col[k] = i, value[k++] = 1;
    }
    CHECK_OK(moray_ldl_graph_new(&graph, variables + 1, &(moray_pattern){k, row, col}, value), "graph");
    const int found = moray_ldl_graph_pair(&graph, 0.1, mate, mate + variables + 1);
    CHECK(found == pairs, "%d variables: %d pairs", variables, found);
    moray_ldl_graph_free(&graph);
    free(row), free(value), free(mate);
}

int main(void)
{
    test_crowded(130, 1); // 16 + 10 sqrt(131) = 130
    test_crowded(131, 0); // 16 + 10 sqrt(132) = 130
    test_by_hand();
    test_rules();
    test_crowd(216, false); // of 433 unknowns: 16 + 10 sqrt(433) = 224
    test_crowd(224, false); // of 449: 227
    test_crowd(228, false); // of 457: 229
    test_crowd(230, false); // of 461: 230
    test_crowd(232, true);  // of 465: 231
    return tap_done();
}
