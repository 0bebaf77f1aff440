// SPDX-License-Identifier: MIT
//
// Sparse symmetric indefinite factors against LAPACK's dense ones: solution and inertia of random matrices of many
// structures.
#include "tap.h"

#include <stdlib.h>
#include <string.h>

#include "linear/ldl.h"

extern void dsyev_(const char *job, const char *uplo, const int *n, double *A, const int *lda, double *w, double *work,
                   const int *lwork, int *info);
extern void dsytrf_(const char *uplo, const int *n, double *A, const int *lda, int *pivot, double *work,
                    const int *lwork, int *info);
extern void dsytrs_(const char *uplo, const int *n, const int *columns, const double *A, const int *lda,
                    const int *pivot, double *B, const int *ldb, int *info);

enum { MOST = 60, ROOM = 4 * MOST * MOST };

typedef struct sample {
    int n, row[ROOM], col[ROOM];
    moray_pattern pattern;
    double value[ROOM], A[MOST * MOST];
    unsigned long long seed;
} sample;

static int pick(sample *s, int n)
{
    return (int)tap_random(&s->seed, 0, n);
}

static void put(sample *s, int i, int j, double value)
{
    const int k = s->pattern.nnz++;
    const bool turned = pick(s, 2);
    s->row[k] = turned ? j : i;
    s->col[k] = turned ? i : j;
    s->value[k] = value;
    s->A[i * s->n + j] += value;
    if (i != j)
        s->A[j * s->n + i] += value;
}

static void start(sample *s, int n)
{
    s->n = n;
    s->pattern = (moray_pattern){0, s->row, s->col};
    memset(s->A, 0, sizeof s->A);
}

static double some(sample *s)
{
    return tap_random(&s->seed, -1, 1);
}

// ---- Structures ------------------------------------------------------------------------------------------------------

static void make_sparse(sample *s)
{
    const int entries = pick(s, 6 * s->n) + 1;
    for (int k = 0; k < entries; k++)
        put(s, pick(s, s->n), pick(s, s->n), some(s));
    for (int i = 0; i < s->n; i++)
        put(s, i, i, some(s));
}

static void make_dense(sample *s)
{
    for (int i = 0; i < s->n; i++)
        for (int j = 0; j <= i; j++)
            put(s, i, j, some(s));
}

static void make_band(sample *s)
{
    const int band = 1 + pick(s, 4);
    for (int i = 0; i < s->n; i++)
        for (int j = i > band ? i - band : 0; j <= i; j++)
            put(s, i, j, j == i && i % 3 ? 0 : some(s));
}

static void make_arrow(sample *s)
{
    const int heads = 1 + pick(s, 3);
    for (int i = 0; i < s->n; i++) {
        put(s, i, i, i < heads ? 0 : some(s));
        for (int j = 0; j < heads && j < i; j++)
            put(s, i, j, some(s));
    }
}

static void make_blocks(sample *s) // disconnected
{
    const int size = 1 + pick(s, 5);
    for (int i = 0; i < s->n; i++)
        for (int j = i / size * size; j <= i; j++)
            put(s, i, j, i == j ? 0.1 * some(s) : some(s));
}

// [H J'; J 0]: row i of J holds variable i, and some others.
static void make_kkt(sample *s)
{
    const int m = pick(s, s->n / 2), variables = s->n - m;
    for (int i = 0; i < variables; i++) {
        if (pick(s, 2))
            put(s, i, i, some(s));
        if (pick(s, 2))
            put(s, i, pick(s, i + 1), some(s));
        put(s, i, i, 0.5);
    }
    for (int i = 0; i < m; i++) {
        put(s, variables + i, i, 1 + 0.5 * some(s));
        for (int k = pick(s, 4); k > 0; k--)
            put(s, variables + i, pick(s, variables), some(s));
    }
}

static void make_saddle_chain(sample *s) // states of a stage, defects between stages, nothing on the diagonal
{
    const int stages = s->n / 2;
    for (int i = 0; i < stages; i++)
        put(s, i, i, i % 4 ? 0 : 1e-3 * some(s));
    for (int i = 0; i < s->n - stages; i++) {
        put(s, stages + i, i < stages ? i : stages - 1, 1);
        if (i > 0)
            put(s, stages + i, i - 1, -1 + 0.1 * some(s));
    }
}

typedef void maker(sample *s);

// Rows and columns of sizes 1e-8 to 1e8.
static void unscale(sample *s)
{
    double scale[MOST];
    for (int i = 0; i < s->n; i++)
        scale[i] = pow(10, tap_random(&s->seed, -8, 8));
    for (int k = 0; k < s->pattern.nnz; k++)
        s->value[k] *= scale[s->row[k]] * scale[s->col[k]];
    for (int i = 0; i < s->n * s->n; i++)
        s->A[i] *= scale[i / s->n] * scale[i % s->n];
}

// ---- Comparison ------------------------------------------------------------------------------------------------------

// Eigenvalues in ascending order of the matrix with rows and columns divided by the roots of their largest entries.
static void eigenvalues(const sample *s, double *w)
{
    static double A[MOST * MOST], work[10 * MOST];
    const int n = s->n, room = 10 * MOST;
    int info;
    memcpy(A, s->A, sizeof A);
    for (int sweep = 0; sweep < 20; sweep++)
        for (int i = 0; i < n; i++) {
            double most = 0;
            for (int j = 0; j < n; j++)
                most = fmax(most, fabs(A[i * n + j]));
            for (int j = 0; j < n && most > 0; j++) {
                A[i * n + j] /= sqrt(most);
                A[j * n + i] /= sqrt(most);
            }
        }
    dsyev_("N", "L", &n, A, &n, w, work, &room, &info);
}

static double residual(const sample *s, const double *x, const double *b)
{
    double worst = 0;
    for (int i = 0; i < s->n; i++) {
        double sum = b[i], size = fabs(b[i]);
        for (int j = 0; j < s->n; j++) {
            sum -= s->A[i * s->n + j] * x[j];
            size += fabs(s->A[i * s->n + j] * x[j]);
        }
        worst = fmax(worst, size > 0 ? fabs(sum) / size : 0);
    }
    return worst;
}

static void make_rhs(sample *s, double *b)
{
    double x[MOST];
    for (int i = 0; i < s->n; i++)
        x[i] = some(s);
    for (int i = 0; i < s->n; i++) {
        b[i] = 0;
        for (int j = 0; j < s->n; j++)
            b[i] += s->A[i * s->n + j] * x[j];
    }
}

// Of all samples of one structure.
struct tally {
    int tried, regular, wrong;
    double error;
};

static void compare(sample *s, double threshold, struct tally *tally)
{
    moray_ldl *ldl = NULL;
    double w[MOST], b[MOST], x[MOST];
    int negative = 0, small = 0;
    eigenvalues(s, w);
    for (int i = 0; i < s->n; i++) {
        negative += w[i] < 0;
        small += fabs(w[i]) < 1e-9;
    }
    make_rhs(s, b);
    memcpy(x, b, sizeof x);
    tally->tried++;
    moray_status status = moray_ldl_new(&ldl, s->n, &s->pattern);
    if (!moray_failed(status))
        status = moray_ldl_factor(ldl, s->value, threshold);
    if (!moray_failed(status))
        status = moray_ldl_solve(ldl, 1, x);
    const moray_ldl_inertia inertia = moray_failed(status) ? (moray_ldl_inertia){0} : moray_ldl_inertia_of(ldl);
    moray_ldl_free(ldl);
    if (small > 0)
        return;
    tally->regular++;
    tally->wrong += inertia.negative != negative || inertia.positive != s->n - negative || inertia.zero != 0;
    tally->error = fmax(tally->error, residual(s, x, b));
}

static void test_structure(const char *name, maker *make, bool scaled, double threshold, double tolerance)
{
    static sample s;
    struct tally tally = {0};
    s.seed = 11;
    for (int k = 0; k < 1000; k++) {
        start(&s, 1 + pick(&s, MOST));
        make(&s);
        if (!scaled)
            unscale(&s);
        compare(&s, threshold, &tally);
    }
    CHECK(tally.wrong == 0 && tally.regular > 100, "%s%s, threshold %g: %d of %d inertias wrong", name,
          scaled ? "" : ", badly scaled", threshold, tally.wrong, tally.regular);
    CHECK(tally.error < tolerance, "%s%s, threshold %g: residual %.1e", name, scaled ? "" : ", badly scaled",
          threshold, tally.error);
}

int main(void)
{
    static const struct {
        const char *name;
        maker *make;
    } all[] = {{"sparse", make_sparse}, {"dense", make_dense}, {"banded", make_band},       {"arrow", make_arrow},
               {"blocks", make_blocks}, {"KKT", make_kkt},     {"chain", make_saddle_chain}};
    for (unsigned i = 0; i < sizeof all / sizeof *all; i++)
        for (int scaled = 1; scaled >= 0; scaled--) {
            test_structure(all[i].name, all[i].make, scaled, 0.01, 1e-12);
            test_structure(all[i].name, all[i].make, scaled, 1e-8, 1e-9);
        }
    return tap_done();
}
