// SPDX-License-Identifier: MIT
//
// Elimination in one front. Columns are taken in blocks: within a block each pivot updates the columns that follow at
// once, the columns after the block all together. A column that finds no pivot is tried again when others are done,
// and is left to the parent when nothing more moves.
#include <math.h>
#include <string.h>

#include "linear/parts.h"

static const double good = 0.1;      // of a pivot: growth is no worry, none better is looked for
static const double nothing = 2e-14; // of an equilibrated matrix, what rounding may leave of a column: 90 of its units
static const double distinct = 1e-2; // of a 2x2 determinant, relative to its products: no cancellation
// Columns: few, as most fronts are narrow; wide ones lose nothing.
enum { block = 4 };

struct panel {
    double *P, *W, *D; // columns; those of pivots before division; inverse pivots
    int *index;
    int height, width;
    int done, settled; // pivots so far; those that every column has been updated with
    int end;           // columns from done to here are up to date
    double threshold;
    moray_ldl *ldl;
};

struct choice {
    int column, partner; // partner -1: a 1x1 pivot
    double quality;      // reciprocal of what it can make columns grow by; INFINITY: alone
    bool empty;          // nothing in the column
};

// ---- Exchange ------------------------------------------------------------------------------------------------------

static void exchange(double *one, double *other)
{
    const double kept = *one;
    *one = *other;
    *other = kept;
}

// Swaps columns a < b and rows alike, of what is left and of the pivots done.
static void swap(struct panel *p, int a, int b)
{
    const size_t h = (size_t)p->height;
    double *A = p->P + (size_t)a * h, *B = p->P + (size_t)b * h;
    const int index = p->index[a];
    if (a == b)
        return;
    for (int j = 0; j < a; j++)
        exchange(p->P + (size_t)j * h + a, p->P + (size_t)j * h + b);
    for (int j = p->settled; j < p->done; j++)
        exchange(p->W + (size_t)j * h + a, p->W + (size_t)j * h + b);
    exchange(A + a, B + b);
    for (int j = a + 1; j < b; j++)
        exchange(A + j, p->P + (size_t)j * h + b);
    for (int i = b + 1; i < p->height; i++)
        exchange(A + i, B + i);
    p->index[a] = p->index[b];
    p->index[b] = index;
}

// ---- Choice --------------------------------------------------------------------------------------------------------

struct peak {
    double inside, outside; // largest entry in the block's rows, in others
    double second;          // largest of the block's but for that one
    int at;                 // row of the first, -1: none
};

static void meet(struct peak *peak, double size, int row)
{
    if (size > peak->inside) {
        peak->second = peak->inside;
        peak->inside = size;
        peak->at = row;
    } else if (size > peak->second)
        peak->second = size;
}

// Of a column without its diagonal and without row skip, in the block.
static struct peak scan_block(const struct panel *p, int t, int skip)
{
    const size_t h = (size_t)p->height;
    const double *column = p->P + (size_t)t * h;
    struct peak peak = {.at = -1};
    for (int j = p->done; j < t; j++)
        if (j != skip)
            meet(&peak, fabs(p->P[(size_t)j * h + t]), j);
    for (int j = t + 1; j < p->end; j++)
        if (j != skip)
            meet(&peak, fabs(column[j]), j);
    return peak;
}

static struct peak scan(const struct panel *p, int t, int skip)
{
    struct peak peak = scan_block(p, t, skip);
    peak.outside = moray_ldl_kernel_largest(p->height - p->end, p->P + (size_t)t * (size_t)p->height + p->end);
    return peak;
}

static double larger(double a, double b)
{
    return a > b ? a : b;
}

// Of a column without its diagonal.
static double most_beside(const struct panel *p, int t)
{
    const size_t h = (size_t)p->height;
    double most = moray_ldl_kernel_largest(p->height - t - 1, p->P + (size_t)t * (h + 1) + 1);
    for (int j = p->done; j < t; j++)
        most = larger(most, fabs(p->P[(size_t)j * h + t]));
    return most;
}

// Duff and Reid: the inverse of the pivot times the largest entries beside it; beside: of column t, but for row r.
static double quality_2x2(const struct panel *p, int t, int r, double beside)
{
    const size_t h = (size_t)p->height;
    const double d = p->P[(size_t)t * h + t], e = p->P[(size_t)r * h + r];
    const double c = t < r ? p->P[(size_t)t * h + r] : p->P[(size_t)r * h + t];
    const double determinant = fabs(d * e - c * c);
    if (!(determinant > distinct * larger(fabs(d * e), c * c)))
        return 0;
    const struct peak other = scan(p, r, t);
    const double more = larger(other.inside, other.outside);
    const double growth = larger(fabs(e) * beside + fabs(c) * more, fabs(c) * beside + fabs(d) * more);
    return growth > 0 ? determinant / growth : INFINITY;
}

static struct choice judge(const struct panel *p, int t)
{
    const double d = p->P[(size_t)t * (size_t)p->height + t], most = most_beside(p, t);
    const struct choice alone = {t, -1, most > 0 ? fabs(d) / most : INFINITY, false};
    if (larger(fabs(d), most) <= nothing)
        return (struct choice){t, -1, INFINITY, true};
    if (alone.quality >= good)
        return alone;
    const struct peak peak = scan(p, t, -1);
    if (peak.at < 0)
        return alone;
    const double quality = quality_2x2(p, t, peak.at, larger(peak.second, peak.outside));
    return quality > alone.quality ? (struct choice){t, peak.at, quality, false} : alone;
}

// The first good pivot of the block, or the best.
static struct choice choose(const struct panel *p)
{
    struct choice best = {-1, -1, 0, false};
    for (int t = p->done; t < p->end && best.quality < good; t++) {
        const struct choice choice = judge(p, t);
        if (choice.quality > best.quality)
            best = choice;
    }
    return best;
}

// ---- Pivots --------------------------------------------------------------------------------------------------------

// Updates the block's columns after the last `depth` pivots with these.
static void update_block(struct panel *p, int depth)
{
    const size_t h = (size_t)p->height, from = (size_t)(p->done - depth) * h + (size_t)p->done;
    moray_ldl_kernel_update(p->height - p->done, p->end - p->done, depth, p->P + from, p->height, p->W + from,
                            p->height, p->P + (size_t)p->done * h + p->done, p->height);
}

static void take_empty(struct panel *p)
{
    const size_t from = (size_t)p->done * (size_t)p->height + (size_t)p->done;
    memset(p->P + from, 0, (size_t)(p->height - p->done) * sizeof *p->P);
    memset(p->W + from, 0, (size_t)(p->height - p->done) * sizeof *p->W);
    p->D[2 * p->done] = p->D[2 * p->done + 1] = 0;
    p->ldl->inertia.zero++;
    p->done++;
}

static void take_1x1(struct panel *p)
{
    const int k = p->done;
    double *restrict column = p->P + (size_t)k * (size_t)p->height, *restrict kept =
                                                                        p->W + (size_t)k * (size_t)p->height;
    const double inverse = 1 / column[k];
    for (int i = k + 1; i < p->height; i++) {
        kept[i] = column[i];
        column[i] *= inverse;
    }
    p->D[2 * k] = inverse;
    p->D[2 * k + 1] = 0;
    *(inverse > 0 ? &p->ldl->inertia.positive : &p->ldl->inertia.negative) += 1;
    p->done++;
    update_block(p, 1);
}

static void count_2x2(moray_ldl *ldl, double determinant, double diagonal)
{
    ldl->statistics.pivots_2x2++;
    if (determinant < 0) {
        ldl->inertia.positive++;
        ldl->inertia.negative++;
    } else
        *(diagonal > 0 ? &ldl->inertia.positive : &ldl->inertia.negative) += 2;
}

static void take_2x2(struct panel *p)
{
    const int k = p->done;
    const size_t h = (size_t)p->height;
    double *restrict one = p->P + (size_t)k * h, *restrict other = one + h;
    double *restrict V = p->W + (size_t)k * h, *restrict W = V + h;
    const double d = one[k], c = one[k + 1], e = other[k + 1], determinant = d * e - c * c;
    const double D = e / determinant, C = -c / determinant, E = d / determinant;
    for (int i = k + 2; i < p->height; i++) {
        const double v = one[i], w = other[i];
        V[i] = v;
        W[i] = w;
        one[i] = v * D + w * C;
        other[i] = v * C + w * E;
    }
    one[k + 1] = 0;
    p->D[2 * k] = D;
    p->D[2 * k + 1] = C;
    p->D[2 * k + 2] = E;
    p->D[2 * k + 3] = 0;
    count_2x2(p->ldl, determinant, d);
    p->done += 2;
    update_block(p, 2);
}

static void take(struct panel *p, struct choice choice)
{
    const int k = p->done;
    int partner = choice.partner == k ? choice.column : choice.partner; // who stands at k makes room
    swap(p, k, choice.column);
    if (choice.empty)
        take_empty(p);
    else if (partner < 0)
        take_1x1(p);
    else {
        swap(p, k + 1, partner);
        take_2x2(p);
    }
}

// ---- Blocks --------------------------------------------------------------------------------------------------------

// Updates the columns after the block with its pivots.
static void settle(struct panel *p)
{
    const size_t h = (size_t)p->height, from = (size_t)p->settled * h + (size_t)p->end;
    moray_ldl_kernel_update(p->height - p->end, p->width - p->end, p->done - p->settled, p->P + from, p->height,
                            p->W + from, p->height, p->P + (size_t)p->end * h + p->end, p->height);
    p->settled = p->done;
}

// Tries each column once; those that fail go to the end. Returns whether a pivot was found.
static bool pass(struct panel *p, int size)
{
    const int before = p->done;
    for (int last = p->width; p->done < last;) {
        p->end = p->done + size < last ? p->done + size : last;
        while (p->done < p->end) {
            const struct choice choice = choose(p);
            if (!(choice.quality > p->threshold))
                break;
            take(p, choice);
        }
        settle(p);
        const int failed = p->end - p->done, after = last - p->end;
        for (int t = 0; t < failed && t < after; t++)
            swap(p, p->done + t, last - 1 - t);
        last -= failed;
    }
    return p->done > before;
}

static void eliminate(struct panel *p, bool root)
{
    while (p->done < p->width && pass(p, block))
        continue;
    if (!root)
        return;
    p->threshold = 0; // nothing to pass on to: the best there is
    while (p->done < p->width && pass(p, p->width))
        continue;
}

void moray_ldl_front_eliminate(moray_ldl *ldl, int s)
{
    const struct node *node = &ldl->plan.node[s];
    struct front *f = &ldl->front[s];
    struct panel p = {.P = ldl->panel + f->panel,
                      .W = ldl->kept,
                      .D = ldl->pivot + 2 * f->index,
                      .index = ldl->index + f->index,
                      .height = f->height,
                      .width = f->width,
                      .threshold = ldl->threshold,
                      .ldl = ldl};
    eliminate(&p, node->parent < 0);
    f->pivots = p.done;
    moray_ldl_kernel_update(node->rows, node->rows, p.done, p.P + f->width, f->height, p.W + f->width, f->height,
                            ldl->update + node->update, node->rows);
    for (int k = 0; k < p.done; k++)
        ldl->statistics.done += (double)(f->height - k) * (f->height - k);
}
