// SPDX-License-Identifier: MIT
//
// What becomes of each interval, told by hand: more stages, pieces, cuts at nodes, or one with its neighbour.
#include "pieces.h"

// ---- More stages, or smaller intervals ----

static void add_even(struct expected *x, int k, int pieces, int stages, enum mesh_past past)
{
    for (int i = 1; i <= pieces; i++)
        add(x, mesh[k] + (mesh[k + 1] - mesh[k]) * i / pieces, stages, 0, past);
}

// The share of the largest change between two nodes.
static double share_of(const struct problem *b, int k)
{
    double sum = 0, most = 0;
    for (int j = scheme->first; j < scheme->last; j++) {
        double change = 0;
        for (int i = 0; i < QUANTITIES; i++)
            change = hypot(change, (piece[k].y[i][j + 1] - piece[k].y[i][j]) / b->e.size[i]);
        sum += change;
        most = tap_worse(most, change);
    }
    return sum > 0 ? most / sum : 0;
}

static void test_smooth(const char *name, double rate, bool even)
{
    struct problem b;
    struct expected x = {0};
    begin(&b, name);
    for (int k = 0; k < N; k++)
        piece[k] = smooth(rate, even, (k % 2 ? -1 : 1) * pow(4, k));
    look(&b);
    const double tolerance = 3e-2 * b.error[0];
    double worst = 0;
    const bool vain = b.s > 2; // two nodes have but one change, which is cut out
    const double shares[] = {0.29, vain ? 0.31 : 0, 0.29, 0, 0, vain ? 0.31 : 0}; // of the error before
    for (int k = 0; k < N; k++) {
        const double raised = shares[k] > 0 ? b.error[k] / shares[k] : 0, excess = b.error[k] / (0.1 * tolerance);
        const enum mesh_past past = k % 3 ? k % 3 == 1 ? mesh_merged : mesh_settled : mesh_untouched;
        b.layout->mesh.raised_from[k] = raised;
        b.layout->mesh.past[k] = past;
        // Of four coefficients, every other one, one is left, which tells no rate.
        const int stages = b.s == 2 ? 4 : b.s + (int)(b.s == 4 && even ? 99 : ceil(log(excess) / rate));
        const enum mesh_past after = past == mesh_untouched ? mesh_untouched : mesh_settled;
        if (stages <= REFINE_MOST_STAGES && shares[k] < 0.3)
            add(&x, mesh[k + 1], stages, b.error[k], after);
        else
            add_even(&x, k, (int)fmin(fmax(ceil(pow(excess, 1.0 / (b.s + 1))), 2), 4), b.s, after);
        CHECK(share_of(&b, k) < 0.69 || !vain, "it changes all over: %g", share_of(&b, k));
        worst = tap_worse(worst, b.error[k]);
    }
    check(&b, tolerance, worst, &x);
    look_away(&b);
    end(&b);
}

// Where coefficients grow, more stages are none, and it is cut.
static void test_growing(void)
{
    struct problem b;
    struct expected x = {0};
    double worst = 0, least = INFINITY;
    begin(&b, "radau5");
    for (int k = 0; k < N; k++)
        piece[k] = smooth(-6, false, 1);
    look(&b);
    for (int k = 0; k < N; k++) {
        worst = tap_worse(worst, b.error[k]);
        least = fmin(least, b.error[k]);
    }
    const double tolerance = 0.99 * least;
    for (int k = 0; k < N; k++) {
        const double excess = b.error[k] / (0.1 * tolerance);
        CHECK(excess > 10 && log(excess) < 6 && share_of(&b, k) < 0.69, "%g times what is aimed at", excess);
        add_even(&x, k, (int)fmax(ceil(pow(excess, 1.0 / 6)), 2), 5, mesh_untouched);
    }
    check(&b, tolerance, worst, &x);
    look_away(&b);
    end(&b);
}

// A change between two nodes is cut out, with the stages of new intervals.
static void test_steps(const char *name)
{
    struct problem b;
    struct expected x = {0};
    begin(&b, name);
    double from = 1;
    double worst = 0;
    for (int k = 0; k < N; k++) {
        const int j = scheme->first + k % (scheme->last - scheme->first);
        piece[k] = step(j, from, from + (k % 2 ? -1 : 1), (k + 1) * 3);
        from += k % 2 ? -1 : 1;
    }
    look(&b);
    for (int k = 0; k < N; k++) {
        const int j = scheme->first + k % (scheme->last - scheme->first);
        const double width = mesh[k + 1] - mesh[k], left = mesh[k] + width * scheme->node[j],
                     right = mesh[k] + width * scheme->node[j + 1];
        worst = tap_worse(worst, b.error[k]);
        if (scheme->node[j] > 0)
            add(&x, left, b.s, 0, mesh_untouched);
        add(&x, (left + right) / 2, b.s, 0, mesh_untouched);
        add(&x, right, b.s, 0, mesh_untouched);
        if (scheme->node[j + 1] < 1)
            add(&x, mesh[k + 1], b.s, 0, mesh_untouched);
    }
    check(&b, 1e-9 * worst, worst, &x);
    look_away(&b);
    end(&b);
}

// ---- Merging ----

static void test_calm(const double *part, const enum mesh_past *past, const struct expected *x)
{
    static const double tolerance = 1e-3;
    struct problem b;
    double worst = 0;
    begin(&b, "radau3");
    for (int k = 0; k < N; k++)
        piece[k] = step(9, 1, 1, 1);
    look(&b);
    for (int k = 0; k < N; k++) // errors go with what is off
        piece[k].off = part[k] * tolerance / b.error[k];
    look_away(&b);
    look(&b);
    for (int k = 0; k < N; k++) {
        CHECK_RELATIVE(b.error[k] / tolerance, part[k], 1e-3, "the error that was meant");
        worst = tap_worse(worst, b.error[k]);
        b.layout->mesh.past[k] = past[k];
    }
    check(&b, tolerance, worst, x);
    look_away(&b);
    end(&b);
}

// An error that is the tolerance is small enough.
static void test_just_enough(void)
{
    struct problem b;
    begin(&b, "radau3");
    for (int k = 0; k < N; k++)
        piece[k] = step(9, 0, 0, k == 2);
    look(&b);
    check(&b, b.error[2], b.error[2],
          &(struct expected){4,
                             {mesh[2], mesh[3], mesh[5], 1},
                             {0},
                             {3, 3, 3, 3},
                             {mesh_merged, mesh_untouched, mesh_merged, mesh_untouched}});
    look_away(&b);
    end(&b);
}

static void test_merging(void)
{
    static const enum mesh_past new[N] = {0}, mixed[N] = {mesh_merged,  mesh_settled, mesh_settled,
                                                          mesh_settled, mesh_merged,  mesh_untouched};
    static const double none[N] = {0}, little[N] = {3e-4, 3.2e-4, 3.2e-4, 3e-4, 0.9, 1e-5},
                        more[N] = {3.2e-4, 3.2e-4, 2e-4, 0.5, 1e-5, 1e-5};
    const enum mesh_past u = mesh_untouched, m = mesh_merged, s = mesh_settled;
    test_calm(none, new, &(struct expected){3, {mesh[2], mesh[4], 1}, {0}, {3, 3, 3}, {m, m, m}});
    test_calm(none, mixed, &(struct expected){4, {mesh[2], mesh[3], mesh[5], 1}, {0}, {3, 3, 3, 3}, {s, s, s, u}});
    // 1e-2 of the tolerance, once 2^4 times the sum, is the most
    test_calm(little, new, &(struct expected){4, {mesh[2], mesh[4], mesh[5], 1}, {0}, {3, 3, 3, 3}, {m, m, u, u}});
    held = true; // then no edge goes
    test_calm(none, new,
              &(struct expected){6, {mesh[1], mesh[2], mesh[3], mesh[4], mesh[5], 1}, {0}, {3, 3, 3, 3, 3, 3}, {u}});
    held = false;
    test_calm(more, new, &(struct expected){4, {mesh[1], mesh[3], mesh[4], 1}, {0}, {3, 3, 3, 3}, {u, m, u, m}});
}

int main(void)
{
    test_smooth("radau5", 2, false);
    test_smooth("gauss5", 2.6, true);
    test_smooth("radau4", 1.2, false);
    test_smooth("gauss4", 3, true);
    test_smooth("radau3", 1.5, false);
    test_smooth("gauss2", 2, false);
    test_growing();
    test_steps("radau3");
    test_steps("gauss4");
    test_steps("lobatto4");
    test_just_enough();
    test_merging();
    return tap_done();
}
