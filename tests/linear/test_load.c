// SPDX-License-Identifier: MIT
//
// The scale in which a matrix is factored, against sweeps over the full one.
#include "sample.h"

#include "linear/parts.h"

// One sweep: rows and columns divided by the roots of their largest entries, all as they were before it (Ruiz 2001).
static void sweep(const sample *s, double *scale)
{
    double peak[MOST] = {0};
    for (int i = 0; i < s->n; i++)
        for (int j = 0; j < s->n; j++)
            peak[i] = fmax(peak[i], fabs(s->A[i * s->n + j]) * scale[i] * scale[j]);
    for (int i = 0; i < s->n; i++)
        scale[i] /= peak[i] > 0 ? sqrt(peak[i]) : 1;
}

// Five sweeps at first, two for each matrix after it, which go on from the scale of the one before.
static void test_scales(void)
{
    static sample s;
    double worst = 0;
    for (int trial = 0; trial < 50; trial++) {
        moray_ldl *ldl;
        double scale[MOST];
        s.seed = 800 + (unsigned long long)trial;
        start(&s, 2 + pick(&s, 20));
        for (int i = 0; i < s.n; i++) {
            scale[i] = 1;
            put(&s, i, i, pow(10, tap_random(&s.seed, -3, 3)));
            put(&s, i, pick(&s, s.n), pow(10, tap_random(&s.seed, -3, 3)));
        }
        CHECK_OK(moray_ldl_new(&ldl, s.n, &s.pattern), "made");
        for (int turn = 0; turn < 3; turn++) {
            CHECK_OK(moray_ldl_factor(ldl, s.value, 0.1), "factored");
            for (int k = 0; k < (turn == 0 ? 5 : 2); k++)
                sweep(&s, scale);
            for (int i = 0; i < s.n; i++)
                worst = tap_worse(worst, fabs(ldl->scale[ldl->plan.position[i]] / scale[i] - 1));
            memset(s.A, 0, sizeof s.A);
            for (int k = 0; k < s.pattern.nnz; k++) {
                const int i = s.row[k], j = s.col[k];
                s.value[k] *= pow(10, tap_random(&s.seed, -1, 1));
                s.A[i * s.n + j] += s.value[k];
                s.A[j * s.n + i] += i != j ? s.value[k] : 0;
            }
        }
        moray_ldl_free(ldl);
    }
    CHECK(worst < 1e-13, "as they should be, to %.1e", worst);
}

int main(void)
{
    test_scales();
    return tap_done();
}
