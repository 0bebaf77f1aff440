// SPDX-License-Identifier: MIT
//
// The kernels of the factorisation against loops written out, for all small shapes, with room around what they read.
#include "tap.h"

#include <string.h>

#include "linear/parts.h"

enum { most = 34, lead = 40 };

static double L[lead * lead], W[lead * lead], C[lead * lead], kept[lead * lead];

static void draw(double *to, unsigned long long *seed)
{
    for (int k = 0; k < lead * lead; k++)
        to[k] = tap_random(seed, -1, 1);
}

// C[i][j] less the sum of L[i][k] W[j][k] for j <= i; nothing is written outside of the rows and columns.
static void test_update(void)
{
    unsigned long long seed = 5;
    double worst = 0;
    int outside = 0;
    draw(L, &seed), draw(W, &seed), draw(kept, &seed);
    for (int rows = 0; rows < most; rows++)
        for (int columns = 0; columns <= rows; columns++)
            for (int depth = 0; depth < 6; depth++) {
                memcpy(C, kept, sizeof C);
                moray_ldl_kernel_update(rows, columns, depth, L, lead, W, lead - 1, C, lead - 2);
                for (int j = 0; j < lead - 2; j++)
                    for (int i = 0; i < lead - 2; i++) {
                        double want = kept[i + j * (lead - 2)];
                        const bool inside = i < rows && j < columns;
                        for (int k = 0; k < depth && inside && i >= j; k++)
                            want -= L[i + k * lead] * W[j + k * (lead - 1)];
                        if (!inside)
                            outside += C[i + j * (lead - 2)] != want;
                        else if (i >= j)
                            worst = tap_worse(worst, fabs(C[i + j * (lead - 2)] - want));
                    }
            }
    CHECK(worst < 1e-15, "updates: %.1e", worst);
    CHECK(outside == 0, "and nothing beside, but for %d", outside);
}

static void test_substitution(void)
{
    unsigned long long seed = 6;
    double worst[2] = {0};
    int beside = 0;
    draw(L, &seed);
    for (int k = 0; k < lead * lead; k++)
        L[k] *= 0.2;
    for (int height = 0; height < most; height++)
        for (int pivots = 0; pivots <= height; pivots++) {
            double x[lead], y[lead], want[lead];
            for (int i = 0; i < lead; i++)
                x[i] = y[i] = want[i] = tap_random(&seed, -1, 1);
            for (int k = 0; k < pivots; k++)
                for (int i = k + 1; i < height; i++)
                    want[i] -= L[i + k * lead] * want[k];
            moray_ldl_kernel_forward(height, pivots, L, lead, x);
            for (int i = 0; i < lead; i++) {
                worst[0] = tap_worse(worst[0], fabs(x[i] - want[i]));
                beside += i >= height && x[i] != want[i];
                want[i] = y[i];
            }
            for (int k = pivots - 1; k >= 0; k--)
                for (int i = k + 1; i < height; i++)
                    want[k] -= L[i + k * lead] * want[i];
            moray_ldl_kernel_backward(height, pivots, L, lead, y);
            for (int i = 0; i < lead; i++) {
                worst[1] = tap_worse(worst[1], fabs(y[i] - want[i]));
                beside += i >= pivots && y[i] != want[i];
            }
        }
    CHECK(worst[0] < 1e-14 && worst[1] < 1e-14, "substitution forward and backward: %.1e, %.1e", worst[0], worst[1]);
    CHECK(beside == 0, "with nothing else moved, but for %d", beside);
}

static void test_largest(void)
{
    double x[most];
    unsigned long long seed = 7;
    int wrong = 0;
    for (int n = 0; n < most; n++) {
        double largest = 0;
        for (int i = 0; i < most; i++)
            x[i] = i < n ? tap_random(&seed, -1, 1) : -5;
        for (int i = 0; i < n; i++)
            largest = fmax(largest, fabs(x[i]));
        wrong += moray_ldl_kernel_largest(n, x) != largest;
        if (n > 0) {
            x[n / 2] = -INFINITY;
            wrong += moray_ldl_kernel_largest(n, x) != INFINITY;
            x[n / 3] = NAN;
            wrong += !isnan(moray_ldl_kernel_largest(n, x));
        }
    }
    CHECK(wrong == 0, "largest of absolute values, but for %d", wrong);
    CHECK(moray_ldl_kernel_largest(2, (double[]){-0.0, 0.0}) == 0, "zeros");
}

int main(void)
{
    test_update();
    test_substitution();
    test_largest();
    return tap_done();
}
