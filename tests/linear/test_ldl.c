// SPDX-License-Identifier: MIT
//
// Sparse symmetric indefinite factors against LAPACK's eigenvalues and planted solutions: random matrices of many
// structures, regular and singular.
#include "tap.h"

#include <stdlib.h>
#include <string.h>

#include "linear/ldl.h"
#include "sample.h"

static double some(sample *s)
{
    return tap_random(&s->seed, -1, 1);
}

// ---- Structures ----------------------------------------------------------------------------------------------------

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
    const int stages = (s->n + 1) / 2;
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

// ---- Comparison ----------------------------------------------------------------------------------------------------

// Eigenvalues in ascending order of the matrix with rows and columns divided by the roots of their largest entries,
// and what they were multiplied by.
static void eigenvalues(const sample *s, double *w, double *scale)
{
    static double A[MOST * MOST], work[10 * MOST];
    const int n = s->n, room = 10 * MOST;
    int info;
    memcpy(A, s->A, sizeof A);
    for (int i = 0; i < n; i++)
        scale[i] = 1;
    for (int sweep = 0; sweep < 20; sweep++)
        for (int i = 0; i < n; i++) {
            double most = 0;
            for (int j = 0; j < n; j++)
                most = fmax(most, fabs(A[i * n + j]));
            if (most > 0)
                scale[i] /= sqrt(most);
            for (int j = 0; j < n && most > 0; j++) {
                A[i * n + j] /= sqrt(most);
                A[j * n + i] /= sqrt(most);
            }
        }
    dsyev_("N", "L", &n, A, &n, w, work, &room, &info);
}

// In that scale, relative to solution and right-hand side.
static double residual(const sample *s, const double *scale, const double *x, const double *b)
{
    double worst = 0, size = 0;
    for (int i = 0; i < s->n; i++) {
        double sum = b[i];
        for (int j = 0; j < s->n; j++)
            sum -= s->A[i * s->n + j] * x[j];
        worst = fabs(sum * scale[i]) <= worst ? worst : fabs(sum * scale[i]);
        size = fmax(size, fmax(fabs(x[i] / scale[i]), fabs(b[i] * scale[i])));
    }
    return size > 0 ? worst / size : worst;
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
    int regular, singular, wrong;
    double error;
};

struct census {
    int negative, doubtful; // eigenvalues: below zero, and hard to tell from it
};

static struct census count(const double *w, int n)
{
    struct census c = {0};
    for (int i = 0; i < n; i++) {
        c.negative += w[i] < -1e-9;
        c.doubtful += fabs(w[i]) <= 1e-9;
    }
    return c;
}

// Twice, since the second factorisation finds everything made.
static void compare(sample *s, double threshold, struct tally *tally)
{
    moray_ldl *ldl = NULL;
    double w[MOST], scale[MOST], b[MOST], x[MOST];
    eigenvalues(s, w, scale);
    const struct census expected = count(w, s->n);
    make_rhs(s, b);
    moray_status status = moray_ldl_new(&ldl, s->n, &s->pattern);
    for (int again = 0; again < 2 && !moray_failed(status); again++) {
        status = moray_ldl_factor(ldl, s->value, threshold);
        const moray_ldl_inertia inertia = moray_ldl_inertia_of(ldl);
        memcpy(x, b, sizeof x);
        if (!moray_failed(status))
            status = moray_ldl_solve(ldl, 1, x);
        tally->wrong += inertia.negative < expected.negative || inertia.zero > expected.doubtful ||
                        inertia.negative + inertia.zero > expected.negative + expected.doubtful ||
                        inertia.positive + inertia.negative + inertia.zero != s->n;
        tally->error = fmax(tally->error, moray_failed(status) ? INFINITY : residual(s, scale, x, b));
    }
    moray_ldl_free(ldl);
    tally->wrong += moray_failed(status);
    tally->regular += expected.doubtful == 0;
    tally->singular += expected.doubtful > 0;
}

enum { samples = 200, least = 50 };

static void test_structure(const char *name, maker *make, bool scaled, double threshold)
{
    static sample s;
    struct tally tally = {0};
    s.seed = 11;
    for (int k = 0; k < samples; k++) {
        start(&s, 1 + pick(&s, MOST));
        make(&s);
        if (!scaled)
            unscale(&s);
        compare(&s, threshold, &tally);
    }
    CHECK(tally.wrong == 0 && tally.regular > least,
          "%s%s, threshold %g: %d inertias wrong of %d regular and %d nearly singular ones", name,
          scaled ? "" : ", badly scaled", threshold, tally.wrong, tally.regular, tally.singular);
    CHECK(tally.error < 1e-12, "%s%s, threshold %g: residual %.1e", name, scaled ? "" : ", badly scaled", threshold,
          tally.error);
}

// ---- Singular ones -------------------------------------------------------------------------------------------------

// [H J'; J 0] with the last constraint three times the first: rank one less, and told so.
static void make_dependent(sample *s)
{
    const int m = 2 + pick(s, 5), n = 3 * m + pick(s, 10);
    double first[MOST] = {0};
    start(s, n + m);
    for (int i = 0; i < n; i++)
        put(s, i, i, 1 + 0.5 * some(s));
    for (int i = 0; i + 1 < m; i++)
        for (int k = 0; k < 3; k++) {
            const double value = 1 + some(s);
            put(s, n + i, 3 * i + k, value);
            if (i == 0)
                first[k] = value;
        }
    for (int k = 0; k < 3; k++)
        put(s, n + m - 1, k, 3 * first[k]);
}

static void test_dependent(void)
{
    static sample s;
    int told = 0;
    double error = 0;
    s.seed = 5;
    for (int k = 0; k < samples; k++) {
        moray_ldl *ldl = NULL;
        double b[MOST], x[MOST], w[MOST], scale[MOST];
        make_dependent(&s);
        make_rhs(&s, b);
        memcpy(x, b, sizeof x);
        eigenvalues(&s, w, scale);
        bool ok = !moray_failed(moray_ldl_new(&ldl, s.n, &s.pattern)) &&
                  !moray_failed(moray_ldl_factor(ldl, s.value, 1e-4)) && !moray_failed(moray_ldl_solve(ldl, 1, x));
        told += ok && moray_ldl_inertia_of(ldl).zero == 1;
        error = tap_worse(error, ok ? residual(&s, scale, x, b) : INFINITY);
        moray_ldl_free(ldl);
    }
    CHECK(told == samples, "a constraint that repeats another: %d of %d told singular", told, samples);
    CHECK(error < 1e-12, "solved all the same where the right-hand side allows: %.1e", error);
}

static void test_empty(void)
{
    moray_ldl *ldl;
    int row[] = {1, 1}, col[] = {1, 1};
    double x[] = {5, 6, 7};
    CHECK_OK(moray_ldl_new(&ldl, 3, &(moray_pattern){2, row, col}), "rows 0 and 2 without an entry");
    CHECK_OK(moray_ldl_factor(ldl, (double[]){-1, -2}, 1e-4), "factored");
    const moray_ldl_inertia inertia = moray_ldl_inertia_of(ldl);
    CHECK(inertia.zero == 2 && inertia.negative == 1 && inertia.positive == 0, "inertia %d, %d, %d", inertia.positive,
          inertia.negative, inertia.zero);
    CHECK_OK(moray_ldl_solve(ldl, 1, x), "solved");
    CHECK(x[0] == 0 && x[1] == -2 && x[2] == 0, "repeated entries add up: %g, %g, %g", x[0], x[1], x[2]);
    moray_ldl_free(ldl);
    CHECK_OK(moray_ldl_new(&ldl, 0, &(moray_pattern){0, row, col}), "nothing at all");
    CHECK_OK(moray_ldl_factor(ldl, NULL, 1e-4), "factored");
    CHECK_OK(moray_ldl_solve(ldl, 1, NULL), "and solved");
    moray_ldl_free(ldl);
}

// ---- Other values, refusals ----------------------------------------------------------------------------------------

// Stages of a state x_i, a control u_i and a constraint that pairs with its state, until states are held by their
// bounds and it must pair with the control of a stage elsewhere: the order made for the first values is given up.
enum { STAGES = 500, PER_STAGE = 6 };

static void set_stages(int *row, int *col, double *value, bool held)
{
    for (int i = 0, k = 0; i < STAGES; i++) {
        const int x = 3 * i, u = x + 1, c = x + 2, before = i > 0 ? x - 3 : x, other = 3 * ((7 * i + 3) % STAGES) + 1;
        const int rows[PER_STAGE] = {x, u, c, c, c, c}, cols[PER_STAGE] = {x, u, x, before, u, other};
        const double values[PER_STAGE] = {held ? 1e8 : 1e-3, held ? 1e-3 : 1, 1, -0.5 + 0.1 * sin(i), 1e-3,
                                          held ? 1 : 1e-3};
        for (int e = 0; e < PER_STAGE; e++, k++) {
            row[k] = rows[e];
            col[k] = cols[e];
            value[k] = values[e];
        }
    }
}

static double stage_error(moray_ldl *ldl, const moray_pattern *pattern, const double *value)
{
    double b[3 * STAGES] = {0}, error = 0;
    for (int k = 0; k < pattern->nnz; k++) { // the right-hand side of a solution of ones
        b[pattern->row[k]] += value[k];
        b[pattern->col[k]] += pattern->row[k] == pattern->col[k] ? 0 : value[k];
    }
    if (moray_failed(moray_ldl_factor(ldl, value, 0.01)) || moray_failed(moray_ldl_solve(ldl, 1, b)))
        return INFINITY;
    for (int i = 0; i < 3 * STAGES; i++)
        error = tap_worse(error, fabs(b[i] - 1));
    return error;
}

static void test_other_values(void)
{
    static int row[PER_STAGE * STAGES], col[PER_STAGE * STAGES];
    static double value[PER_STAGE * STAGES];
    const moray_pattern pattern = {PER_STAGE * STAGES, row, col};
    moray_ldl *ldl = NULL;
    double error = 0;
    int right = 0;
    set_stages(row, col, value, false);
    CHECK_OK(moray_ldl_new(&ldl, 3 * STAGES, &pattern), "stages");
    for (int k = 0; k < 8; k++) {
        set_stages(row, col, value, k >= 4);
        error = tap_worse(error, stage_error(ldl, &pattern, value));
        right += moray_ldl_inertia_of(ldl).negative == STAGES && moray_ldl_inertia_of(ldl).zero == 0;
    }
    const moray_ldl_statistics statistics = moray_ldl_statistics_of(ldl);
    CHECK(error < 1e-8 && right == 8, "other partners after a while: error %.1e, %d of 8 inertias right", error, right);
    CHECK(statistics.orders == 2 && statistics.factors == 8 && statistics.solves == 8,
          "%d factorisations, %d solves in %d orders", statistics.factors, statistics.solves, statistics.orders);
    CHECK(statistics.done < 2 * statistics.planned, "the other order serves: %.3g operations, %.3g planned",
          statistics.done, statistics.planned);
    moray_ldl_free(ldl);
}

// An arrow whose shaft is too weak for pivots of its own: all of it is delayed to the head.
static void test_filled(void)
{
    enum { SHAFT = 1100 };
    static int row[3 * SHAFT], col[3 * SHAFT];
    static double value[3 * SHAFT];
    moray_ldl *ldl = NULL;
    for (int i = 0; i < SHAFT; i++) {
        row[3 * i] = col[3 * i] = col[3 * i + 1] = 2 * i;
        row[3 * i + 1] = col[3 * i + 2] = 2 * i + 1;
        row[3 * i + 2] = 2 * SHAFT;
        value[3 * i] = value[3 * i + 1] = value[3 * i + 2] = 1;
    }
    CHECK_OK(moray_ldl_new(&ldl, 2 * SHAFT + 1, &(moray_pattern){3 * SHAFT, row, col}), "an arrow");
    CHECK_OK(moray_ldl_factor(ldl, value, 0.1), "with a strong shaft");
    for (int i = 0; i < SHAFT; i++)
        value[3 * i + 1] = 1e-3;
    const moray_status status = moray_ldl_factor(ldl, value, 0.1);
    const moray_ldl_statistics statistics = moray_ldl_statistics_of(ldl);
    CHECK(status.code == MORAY_NOT_SOLVED && statistics.orders == 2, "a weak one, ordered twice: %s", status.text);
    CHECK(moray_ldl_solve(ldl, 0, NULL).code == MORAY_NUMERIC && moray_ldl_inertia_of(ldl).positive == 0,
          "leaves nothing to solve with");
    CHECK_OK(moray_ldl_factor(ldl, value, 1e-8), "but for one who minds small pivots less");
    CHECK(moray_ldl_statistics_of(ldl).filled < 8 * statistics.entries, "then %.3g entries for %.3g",
          moray_ldl_statistics_of(ldl).filled, statistics.entries);
    moray_ldl_free(ldl);
}

static void test_refusals(void)
{
    int row[] = {0, 1}, col[] = {0, 2};
    moray_ldl *ldl;
    double x[2] = {1, 1};
    moray_status status = moray_ldl_new(&ldl, 2, &(moray_pattern){2, row, col});
    CHECK(status.code == MORAY_INPUT && strstr(status.text, "(1, 2)") && !ldl, "refused: %s", status.text);
    col[1] = 1;
    CHECK_OK(moray_ldl_new(&ldl, 2, &(moray_pattern){2, row, col}), "a diagonal");
    status = moray_ldl_solve(ldl, 1, x);
    CHECK(status.code == MORAY_NUMERIC, "refused: %s", status.text);
    status = moray_ldl_factor(ldl, (double[]){1, NAN}, 0.1);
    CHECK(status.code == MORAY_NUMERIC && strstr(status.text, "not finite"), "refused: %s", status.text);
    CHECK(moray_ldl_inertia_of(ldl).positive == 0, "and it has no inertia");
    status = moray_ldl_factor(ldl, (double[]){1, INFINITY}, 0.1);
    CHECK(status.code == MORAY_NUMERIC, "refused: %s", status.text);
    CHECK_OK(moray_ldl_factor(ldl, (double[]){2, 4}, 0.1), "good values serve again");
    CHECK_OK(moray_ldl_solve(ldl, 1, x), "solved");
    CHECK(x[0] == 0.5 && x[1] == 0.25, "right: %g, %g", x[0], x[1]);
    CHECK(moray_ldl_has_pattern(ldl, 2, &(moray_pattern){2, row, col}), "its pattern is known again");
    col[1] = 0;
    CHECK(!moray_ldl_has_pattern(ldl, 2, &(moray_pattern){2, row, col}), "another is not");
    moray_ldl_free(ldl);
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
            test_structure(all[i].name, all[i].make, scaled, 0.01);
            test_structure(all[i].name, all[i].make, scaled, 1e-4);
            test_structure(all[i].name, all[i].make, scaled, 1e-8);
        }
    test_dependent();
    test_empty();
    test_other_values();
    test_filled();
    test_refusals();
    return tap_done();
}
