// SPDX-License-Identifier: MIT
//
// Elimination in one front against the same done on the whole symmetric matrix, each pivot at once: which pivots are
// taken, in which order, and what is left. What the threshold promises: columns do not grow by more than its inverse.
#include "tap.h"

#include <string.h>

#include "linear/parts.h"

enum { most = 40, block = 4 };

// ---- The same on a full matrix ----

struct full {
    int height, width, done, end;
    double M[most][most], L[most][most], D[most][2]; // what is left; columns of L; inverse pivots
    int index[most], positive, negative, zero, pairs;
    double threshold;
    const int *taken; // the order to compare with, which decides between what is equal but for rounding
};

static void swap(struct full *f, int a, int b)
{
    for (int i = 0; i < f->height; i++) {
        const double kept = f->M[i][a];
        f->M[i][a] = f->M[i][b], f->M[i][b] = kept;
    }
    for (int i = 0; i < f->height; i++) {
        const double kept = f->M[a][i], part = f->L[a][i];
        f->M[a][i] = f->M[b][i], f->M[b][i] = kept;
        f->L[a][i] = f->L[b][i], f->L[b][i] = part;
    }
    const int index = f->index[a];
    f->index[a] = f->index[b], f->index[b] = index;
}

// The largest of column t beside rows t and skip.
static double beside(const struct full *f, int t, int skip)
{
    double largest = 0;
    for (int i = f->done; i < f->height; i++)
        largest = fmax(largest, i == t || i == skip ? 0 : fabs(f->M[i][t]));
    return largest;
}

// Of a column by itself or with the row of the block in which it is largest (Duff and Reid 1996).
static double quality(const struct full *f, int t, int *partner)
{
    const double d = f->M[t][t], rest = beside(f, t, t), alone = rest > 0 ? fabs(d) / rest : INFINITY;
    int r = -1;
    *partner = -1;
    if (fmax(fabs(d), rest) <= 2e-14 || alone >= 0.1)
        return fmax(fabs(d), rest) <= 2e-14 ? INFINITY : alone;
    for (int i = f->done; i < f->end; i++)
        if (i != t && f->M[i][t] != 0 && (r < 0 || fabs(f->M[i][t]) > fabs(f->M[r][t])))
            r = i;
    if (r < 0)
        return alone;
    const double e = f->M[r][r], c = f->M[r][t], determinant = fabs(d * e - c * c);
    const double one = beside(f, t, r), other = beside(f, r, t);
    const double growth = fmax(fabs(e) * one + fabs(c) * other, fabs(c) * one + fabs(d) * other);
    if (determinant <= 1e-2 * fmax(fabs(d * e), c * c) || determinant / growth <= alone)
        return alone;
    *partner = r;
    return determinant / growth;
}

static void take_column(struct full *f)
{
    const int k = f->done++;
    const double d = f->M[k][k];
    if (fmax(fabs(d), beside(f, k, k)) <= 2e-14) {
        f->zero++;
        return;
    }
    f->D[k][0] = 1 / d;
    *(d > 0 ? &f->positive : &f->negative) += 1;
    for (int i = k + 1; i < f->height; i++)
        f->L[i][k] = f->M[i][k] / d;
    for (int i = k + 1; i < f->height; i++)
        for (int j = k + 1; j < f->height; j++)
            f->M[i][j] -= f->L[i][k] * f->M[k][j];
}

static void take_pair(struct full *f)
{
    const int k = f->done;
    const double d = f->M[k][k], c = f->M[k + 1][k], e = f->M[k + 1][k + 1], determinant = d * e - c * c;
    f->D[k][0] = e / determinant, f->D[k][1] = -c / determinant, f->D[k + 1][0] = d / determinant;
    f->positive += determinant < 0 ? 1 : 2 * (d > 0);
    f->negative += determinant < 0 ? 1 : 2 * (d < 0);
    f->pairs++;
    f->done += 2;
    for (int i = k + 2; i < f->height; i++) {
        f->L[i][k] = (f->M[i][k] * e - f->M[i][k + 1] * c) / determinant;
        f->L[i][k + 1] = (f->M[i][k + 1] * d - f->M[i][k] * c) / determinant;
    }
    for (int i = k + 2; i < f->height; i++)
        for (int j = k + 2; j < f->height; j++)
            f->M[i][j] -= f->L[i][k] * f->M[k][j] + f->L[i][k + 1] * f->M[k + 1][j];
}

// A pair of two each of which is the other's best is as good from either side.
static bool is_mirrored(const struct full *f, int column, int partner, double best)
{
    int back;
    return partner >= 0 && partner < f->end && fabs(quality(f, partner, &back) / best - 1) < 1e-12 && back == column &&
           f->index[partner] == f->taken[f->done];
}

// The first column of the block that is good, or the best of it.
static bool take_one(struct full *f)
{
    double best = 0;
    int column = -1, partner = -1;
    for (int t = f->done; t < f->end && best < 0.1; t++) {
        int with;
        const double here = quality(f, t, &with);
        if (here > best)
            best = here, column = t, partner = with;
    }
    if (!(best > f->threshold))
        return false;
    if (is_mirrored(f, column, partner, best)) {
        const int kept = column;
        column = partner, partner = kept;
    }
    const int k = f->done;
    swap(f, k, column);
    if (partner < 0)
        take_column(f);
    else {
        swap(f, k + 1, partner == k ? column : partner);
        take_pair(f);
    }
    return true;
}

static bool pass(struct full *f, int size)
{
    const int before = f->done;
    int last = f->width;
    while (f->done < last) {
        f->end = f->done + size < last ? f->done + size : last;
        while (f->done < f->end && take_one(f))
            continue;
        const int failed = f->end - f->done, after = last - f->end;
        for (int t = 0; t < failed && t < after; t++)
            swap(f, f->done + t, last - 1 - t);
        last -= failed;
    }
    return f->done > before;
}

static void eliminate(struct full *f, bool root)
{
    while (f->done < f->width && pass(f, block))
        continue;
    f->threshold = root ? 0 : f->threshold;
    while (root && f->done < f->width && pass(f, f->width))
        continue;
}

// ---- Fronts ----

// Of several kinds: anything; nothing much on the diagonal; rows below that are large; few entries; columns of
// rounding. A root has no rows below.
static void draw(struct full *f, unsigned long long *seed, bool root)
{
    const int kind = (int)tap_random(seed, 0, 5);
    *f = (struct full){.width = 1 + (int)tap_random(seed, 0, 18)};
    f->height = f->width + (root ? 0 : (int)tap_random(seed, 0, 16));
    for (int i = 0; i < f->height; i++)
        for (int j = 0; j <= i; j++) {
            double value = tap_random(seed, -1, 1);
            value *= i == j && kind == 1 ? 1e-3 : 1;
            value *= i >= f->width && j < f->width && kind == 2 ? 30 : 1;
            value = tap_random(seed, 0, 1) < 0.7 && kind == 3 ? 0 : value;
            value *= kind == 4 && (i % 3 == 1 || j % 3 == 1) ? 1e-17 : 1;
            f->M[i][j] = f->M[j][i] = i >= f->width && j >= f->width ? 0 : value;
        }
    for (int k = 0; k < f->width; k++)
        f->index[k] = 100 + k;
}

struct made {
    struct node node;
    struct front front;
    double panel[most * most], kept[most * most], update[most * most], pivot[2 * most];
    int index[most];
    moray_ldl ldl;
};

static void make(struct made *m, const struct full *f, double threshold, bool root)
{
    memset(m, 0, sizeof *m);
    const int rows = f->height - f->width;
    m->node = (struct node){.parent = root ? -1 : 1, .columns = f->width, .rows = rows};
    m->front = (struct front){.columns = f->width, .width = f->width, .height = f->height};
    for (int j = 0; j < f->width; j++) {
        m->index[j] = f->index[j];
        for (int i = 0; i < f->height; i++)
            m->panel[j * f->height + i] = i < j ? NAN : f->M[i][j]; // above the diagonal nothing is read
    }
    m->ldl = (moray_ldl){.plan = {.node = &m->node},
                         .front = &m->front,
                         .panel = m->panel,
                         .kept = m->kept,
                         .update = m->update,
                         .pivot = m->pivot,
                         .index = m->index,
                         .threshold = threshold};
}

struct faults {
    int order, inertia, delayed, pairs, empty;
    double pivots, L, left, update, growth;
};

static void compare(const struct made *m, const struct full *f, double threshold, bool root, struct faults *faults)
{
    const int h = f->height, rows = h - f->width, pivots = m->front.pivots;
    const moray_ldl_inertia inertia = m->ldl.inertia;
    double done = 0;
    faults->order += pivots != f->done || memcmp(m->index, f->index, (size_t)f->width * sizeof *m->index) != 0;
    faults->inertia += inertia.positive != f->positive || inertia.negative != f->negative || inertia.zero != f->zero ||
                       m->ldl.statistics.pivots_2x2 != f->pairs;
    faults->delayed += f->width - pivots, faults->pairs += f->pairs, faults->empty += f->zero;
    for (int k = 0; k < pivots; k++) {
        done += (h - k) * (h - k);
        const double size = 1 + fabs(f->D[k][0]) + fabs(f->D[k][1]);
        faults->pivots = tap_worse(faults->pivots, fabs(m->pivot[2 * k] - f->D[k][0]) / size);
        faults->pivots = tap_worse(faults->pivots, fabs(m->pivot[2 * k + 1] - f->D[k][1]) / size);
        for (int i = k + 1; i < h; i++) {
            const double l = m->panel[k * h + i];
            faults->L = tap_worse(faults->L, fabs(l - f->L[i][k]) / (1 + fabs(f->L[i][k])));
            if (f->D[k][0] == 0 && f->D[k][1] == 0 && (k == 0 || f->D[k - 1][1] == 0))
                faults->inertia += l != 0;
            if (!root)
                faults->growth = tap_worse(faults->growth, fabs(l) * threshold);
        }
    }
    faults->inertia += m->ldl.statistics.done != done;
    for (int j = pivots; j < f->width; j++)
        for (int i = j; i < h; i++)
            faults->left = tap_worse(faults->left, fabs(m->panel[j * h + i] - f->M[i][j]) / (1 + fabs(f->M[i][j])));
    for (int j = 0; j < rows; j++)
        for (int i = j; i < rows; i++) {
            const double want = f->M[f->width + i][f->width + j];
            faults->update = tap_worse(faults->update, fabs(m->update[j * rows + i] - want) / (1 + fabs(want)));
        }
}

static void test_fronts(double threshold, bool root)
{
    static struct full full;
    static struct made made;
    struct faults faults = {0};
    unsigned long long seed = 31;
    for (int trial = 0; trial < 1500; trial++) {
        draw(&full, &seed, root);
        make(&made, &full, threshold, root);
        moray_ldl_front_eliminate(&made.ldl, 0);
        full.threshold = threshold;
        full.taken = made.index;
        eliminate(&full, root);
        compare(&made, &full, threshold, root, &faults);
    }
    CHECK(faults.order == 0, "threshold %g%s: pivots in the same order, but for %d", threshold, root ? ", root" : "",
          faults.order);
    CHECK(faults.inertia == 0, "and the same inertia and work, but for %d", faults.inertia);
    CHECK(faults.pivots < 1e-8 && faults.L < 1e-8, "the same pivots and columns: %.1e, %.1e", faults.pivots, faults.L);
    CHECK(faults.left < 1e-8 && faults.update < 1e-8, "what is left to the parent: %.1e, %.1e", faults.left,
          faults.update);
    CHECK(faults.growth < 1 + 1e-9, "columns grow by no more than the inverse of the threshold: %g of it",
          faults.growth);
    CHECK(faults.pairs > 500 && faults.empty > 10 && (root ? faults.delayed == 0 : faults.delayed > 10),
          "%d pairs, %d empty columns, %d delayed", faults.pairs, faults.empty, faults.delayed);
}

// Of two rows in which a column is as large its partner is the first; a column that is just good needs none.
static void test_ties(void)
{
    static struct made made;
    static const double cases[][6] = {{0, 1, 0, 1, 0.5, 0}, {0.1, 1, 0, 0, 0, 5}, {0.25, -1, 0.25, 1, 0.5, 0.25}};
    static const int pairs[] = {1, 0, 0};
    for (int k = 0; k < 3; k++) {
        struct full full = {.width = 3, .height = 3, .index = {100, 101, 102}};
        for (int i = 0, e = 0; i < 3; i++)
            for (int j = 0; j <= i; j++)
                full.M[i][j] = full.M[j][i] = cases[k][e++];
        make(&made, &full, 0.01, true);
        moray_ldl_front_eliminate(&made.ldl, 0);
        CHECK(made.index[0] == 100 && made.index[1] == 101 && made.index[2] == 102, "case %d: %d, %d, %d", k,
              made.index[0], made.index[1], made.index[2]);
        CHECK(made.ldl.statistics.pivots_2x2 == pairs[k], "case %d: %d pairs", k, made.ldl.statistics.pivots_2x2);
    }
}

// Of two columns that are as good, and not good, the first is taken first.
static void test_equal(void)
{
    static struct made made;
    struct full full = {.width = 2, .height = 3, .index = {100, 101}};
    for (int k = 0; k < 2; k++) {
        full.M[k][k] = 0.0625;
        full.M[2][k] = full.M[k][2] = 1;
    }
    make(&made, &full, 0.01, false);
    moray_ldl_front_eliminate(&made.ldl, 0);
    CHECK(made.front.pivots == 2 && made.index[0] == 100 && made.index[1] == 101, "%d, then %d", made.index[0],
          made.index[1]);
}

// A partner may be the first column, where its own best partner is another.
static void test_first_partner(void)
{
    static const double lower[4][3] = {{0.01, 0, 0}, {1, 0, 0}, {2, 0, 0}, {30, 0, 1000}};
    static struct made made;
    struct full full = {.width = 3, .height = 4, .index = {100, 101, 102}};
    for (int i = 0; i < 4; i++)
        for (int j = 0; j <= i && j < 3; j++)
            full.M[i][j] = full.M[j][i] = lower[i][j];
    make(&made, &full, 0.01, false);
    moray_ldl_front_eliminate(&made.ldl, 0);
    CHECK(made.ldl.statistics.pivots_2x2 == 1 && made.front.pivots >= 2 && made.index[0] + made.index[1] == 201,
          "%d pairs, of %d and %d", made.ldl.statistics.pivots_2x2, made.index[0], made.index[1]);
}

// A column that is as good as the threshold, and no better, is left to the parent, unless there is none.
static void test_just_threshold(void)
{
    static struct made made;
    for (int k = 0; k < 4; k++) {
        const bool root = k >= 2;
        struct full full = {.width = root ? 2 : 1, .height = 2, .index = {100, 101}};
        full.M[0][0] = k % 2 ? nextafter(0.0625, 1) : 0.0625;
        full.M[0][1] = full.M[1][0] = 1;
        make(&made, &full, 0.0625, root);
        moray_ldl_front_eliminate(&made.ldl, 0);
        CHECK(made.front.pivots == (root ? 2 : k), "%d pivots", made.front.pivots);
    }
}

int main(void)
{
    test_equal();
    test_first_partner();
    test_just_threshold();
    test_ties();
    static const double thresholds[] = {0.01, 0.1, 0.25, 0.45};
    for (int k = 0; k < 4; k++)
        for (int root = 0; root < 2; root++)
            test_fronts(thresholds[k], root);
    return tap_done();
}
