// SPDX-License-Identifier: MIT
//
// Meshes that cut out what no node tells, and do not cut what is next to nothing.
#include "pieces.h"

static double largest_at(int k, double *most)
{
    const int count = (int)ceil(512 * (mesh[k + 1] - mesh[k]));
    double where = 0;
    *most = 0;
    for (int point = 0; point < count; point++) {
        const double tau = (point + 0.5) / count, here = fabs(product(tau, -1) * leant(&piece[k], tau));
        if (here > *most)
            *most = here, where = tau;
    }
    return where;
}

static void add_cut(struct expected *x, int k, int s)
{
    double most;
    const double width = mesh[k + 1] - mesh[k], apart = 1 / ceil(512 * width), where = largest_at(k, &most);
    if (where > apart)
        add(x, mesh[k] + (where - apart) * width, s, 0, mesh_untouched);
    if (where < 1 - apart)
        add(x, mesh[k] + (where + apart) * width, s, 0, mesh_untouched);
    add(x, mesh[k + 1], s, 0, mesh_untouched);
}

// Cut out where it matters, in all intervals that have their share of it.
static void test_hidden(const char *name, double much)
{
    struct problem b;
    struct expected x = {0};
    struct unseen u;
    double sum = 0, where;
    begin(&b, name);
    for (int k = 0; k < N; k++)
        piece[k] = step(9, 1, 1, 0);
    for (int k = 1; k < N; k++)
        if (k != 2) {
            double most;
            piece[k].lean = k == 3 ? -1 : k == 4;
            largest_at(k, &most);
            piece[k].hidden = much / most *
                              (k == 5                          ? 1e-3
                               : k == 1                        ? 1
                               : k == 3                        ? 20
                               : scheme->family == MORAY_RADAU ? -1
                                                               : -20); // by how narrow they are
        }
    look(&b);
    CHECK_OK(moray_unseen_new(&u, &b.e), "effects");
    for (int k = 0; k < N; k++)
        sum += moray_unseen_interval(&u, &b.layout->interval[k], moray_witness_objective(&b.w), NULL, &where);
    moray_unseen_free(&u);
    CHECK((sum > MORAY_LIMIT_UNSEEN) == (much > 1), "hidden %g: %g", much, sum);
    for (int k = 0; k < N; k++)
        if (k == 0 || k == 2 || k == 5)
            add(&x, mesh[k + 1], b.s, 0, mesh_untouched);
        else
            add_cut(&x, k, b.s);
    if (much < 1)
        x = (struct expected){3, {mesh[2], mesh[4], 1}, {0}, {b.s, b.s, b.s}, {mesh_merged, mesh_merged, mesh_merged}};
    check(&b, 1e-6, much > 1 ? sum : 0, &x);
    look_away(&b);
    end(&b);
}

// Where there is nothing at all it is in the middle.
static void test_nothing(void)
{
    struct problem b;
    struct unseen u;
    begin(&b, "radau3");
    look(&b);
    CHECK_OK(moray_unseen_new(&u, &b.e), "effects");
    for (int k = 0; k < N; k++) {
        double where = -1, jumps = -1;
        const double found = moray_unseen_interval(&u, &b.layout->interval[k], 1, &jumps, &where);
        CHECK(found == 0 && jumps == 0 && where == 0.5, "nothing, %g and %g, at %g", found, jumps, where);
    }
    moray_unseen_free(&u);
    look_away(&b);
    end(&b);
}

// Next to nothing is not cut further.
static void test_narrow(double width)
{
    struct problem b;
    const double kept = mesh[N - 1];
    mesh[N - 1] = 1 - width;
    begin(&b, "radau3");
    for (int k = 0; k < N; k++)
        piece[k] = k == N - 1 ? smooth(1.5, false, 1e12) : step(9, 1, 1, 0);
    for (int j = scheme->first; j <= scheme->last; j++)
        piece[N - 1].y[0][j] *= 1e12;
    look(&b);
    const double error = b.error[N - 1];
    const bool refined = width > 1e-9;
    struct expected x = {4, {mesh[2], mesh[4], mesh[5], 1}, {0}, {3, 3, 3, 3}, {mesh_merged, mesh_merged}};
    if (refined)
        x.stages[3] = 3 + (int)ceil(log(100) / 1.5), x.raised[3] = error;
    check(&b, error / 10, error, &x);
    look_away(&b);
    end(&b);
    mesh[N - 1] = kept;
}

int main(void)
{
    test_nothing();
    test_hidden("gauss3", 1e4);
    test_hidden("radau4", 1e4);
    test_hidden("radau3", 1e-4);
    test_narrow(0.9e-9);
    test_narrow(1.1e-9);
    return tap_done();
}
