// SPDX-License-Identifier: MIT
//
// What is told of factors and solutions: errors of solutions that cannot be right, of several right-hand sides, and of
// the null space to the last bit; work and memory of factorisations.
#include "sample.h"

#include "linear/kkt_factors.h"
#include "linear/ldl.h"
#include "linear/null_space_parts.h"
#include "linear/parts.h"

// ---- Errors ----

// diag(4, 0, 1) with an entry in an empty row: the residual is that entry, over the largest of solution and right-hand
// side in the scale of the factors, in which the diagonal is 1 and they are both -3, 0 and 2.
static void test_error(void)
{
    static const struct {
        double b[3], error;
    } cases[] = {{{-6, 0.5, 2}, 0.5 / 3},  {{6, 0.5, 2}, 0.5 / 3},  {{2, -0.5, -3}, 0.5 / 3}, {{2, -5, 3}, 1},
                 {{0.5, 0.5, 0.25}, 1},    {{0, 0, 0}, 0},          {{1, 0, 2}, 0},           {{-4, -0.25, 1}, 0.125},
                 {{-2, 0.25, -4}, 0.0625}, {{2, -0.125, -1}, 0.125}};
    int row[] = {0, 2}, col[] = {0, 2};
    moray_ldl *ldl;
    CHECK_OK(moray_ldl_new(&ldl, 3, &(moray_pattern){2, row, col}), "made");
    CHECK_OK(moray_ldl_factor(ldl, (double[]){4, 1}, 0.1), "factored");
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        double b[3];
        memcpy(b, cases[k].b, sizeof b);
        CHECK_OK(moray_ldl_solve(ldl, 1, b), "solved");
        CHECK_NEAR(moray_ldl_statistics_of(ldl).error, cases[k].error, 1e-15, "error of what cannot be solved");
        CHECK(b[0] == cases[k].b[0] / 4 && b[1] == 0 && b[2] == cases[k].b[2], "(%g, %g, %g)", b[0], b[1], b[2]);
    }
    moray_ldl_free(ldl);
}

// [1 s; s 1] beside an empty row: a solution that is larger than the right-hand side, by 1 / (1 - s), of any sign.
static void test_large_solution(void)
{
    int row[] = {0, 1, 1}, col[] = {0, 0, 1};
    moray_ldl *ldl;
    CHECK_OK(moray_ldl_new(&ldl, 3, &(moray_pattern){3, row, col}), "made");
    for (int k = 0; k < 8; k++) {
        const double s = k & 4 ? -0.75 : 0.75;
        CHECK_OK(moray_ldl_factor(ldl, (double[]){1, s, 1}, 0.1), "factored");
        const double sign = k & 1 ? -1 : 1, turned = k & 2 ? -1 : 1; // x = (1, -1) and (1, 1)
        double b[] = {sign * (1 + turned * s), sign * turned * (1 + turned * s), 0.0625};
        CHECK_OK(moray_ldl_solve(ldl, 1, b), "solved");
        CHECK_NEAR(b[0], sign, 1e-15, "solution");
        CHECK_NEAR(moray_ldl_statistics_of(ldl).error, 0.0625 / fmax(1, 1 + turned * s), 1e-15,
                   "error in the size of the larger of both");
    }
    moray_ldl_free(ldl);
}

// Of several right-hand sides the worst counts, whichever is last.
static void test_worst(void)
{
    int row[] = {0, 2}, col[] = {0, 2};
    kkt_factors *kkt;
    moray_ldl *ldl;
    const moray_pattern pattern = {2, row, col};
    CHECK_OK(moray_ldl_new(&ldl, 3, &pattern), "made");
    CHECK_OK(moray_ldl_factor(ldl, (double[]){1, 1}, 0.1), "factored");
    CHECK_OK(moray_kkt_factors_new(&kkt, 3, &pattern), "made");
    CHECK_OK(moray_kkt_factors_factor(kkt, (double[]){1, 1}, 0.1), "factored");
    for (int k = 0; k < 2; k++) {
        double B[] = {1, k ? 0.5 : 0.25, 0, 1, k ? 0.25 : 0.5, 0}, same[6];
        memcpy(same, B, sizeof B);
        CHECK_OK(moray_ldl_solve(ldl, 2, B), "solved");
        CHECK(moray_ldl_statistics_of(ldl).error == 0.5, "of two: %g", moray_ldl_statistics_of(ldl).error);
        CHECK_OK(moray_kkt_factors_solve(kkt, 2, same), "solved");
        CHECK(moray_kkt_factors_error(kkt) == 0.5 && memcmp(B, same, sizeof B) == 0, "by the form that suits: %g",
              moray_kkt_factors_error(kkt));
    }
    CHECK(moray_ldl_statistics_of(ldl).solves == 4 && moray_ldl_statistics_of(ldl).factors == 1, "4 solves, 1 factor");
    double b[] = {1, 0.125, 0};
    CHECK_OK(moray_kkt_factors_solve(kkt, 1, b), "solved");
    CHECK(moray_kkt_factors_error(kkt) == 0.125, "of the last call: %g", moray_kkt_factors_error(kkt));
    moray_kkt_factors_free(kkt);
    moray_ldl_free(ldl);
}

// What is no number anywhere is told, whatever comes after it.
static void test_nan(void)
{
    int row[] = {0, 1, 2}, col[] = {0, 1, 2}, all_row[] = {0, 1, 2, 2}, all_col[] = {0, 1, 0, 1};
    moray_ldl *ldl;
    kkt_factors *kkt;
    null_space *ns;
    bool fits;
    CHECK_OK(moray_ldl_new(&ldl, 3, &(moray_pattern){3, row, col}), "made");
    CHECK_OK(moray_ldl_factor(ldl, (double[]){1, 2, 4}, 0.1), "factored");
    CHECK_OK(moray_kkt_factors_new(&kkt, 3, &(moray_pattern){4, all_row, all_col}), "made");
    CHECK_OK(moray_kkt_factors_factor(kkt, (double[]){1, 2, 3, 4}, 0.1), "factored");
    CHECK_OK(moray_null_space_new(&ns, 3, &(moray_pattern){4, all_row, all_col}), "made");
    CHECK_OK(moray_null_space_factor(ns, (double[]){1, 2, 3, 4}, &fits), "factored");
    for (int at = 0; at < 6; at++) {
        double B[] = {1, 2, 3, 4, 5, 6}, same[] = {1, 2, 3, 4, 5, 6}, b[] = {1, 2, 3}, error;
        B[at] = same[at] = b[at % 3] = NAN;
        CHECK_OK(moray_ldl_solve(ldl, 2, B), "solved");
        CHECK(isnan(moray_ldl_statistics_of(ldl).error), "number %d: %g", at, moray_ldl_statistics_of(ldl).error);
        CHECK_OK(moray_kkt_factors_solve(kkt, 2, same), "solved");
        CHECK(isnan(moray_kkt_factors_error(kkt)), "number %d: %g", at, moray_kkt_factors_error(kkt));
        CHECK_OK(moray_null_space_solve(ns, b, &error), "solved");
        CHECK(isnan(error), "number %d: %g", at, error);
    }
    moray_null_space_free(ns);
    moray_kkt_factors_free(kkt);
    moray_ldl_free(ldl);
}

// ---- Null space ----

// Variables, two more than constraints, in rows and columns of sizes far apart; two columns are much larger than the
// others, and entries of either sign.
static void make(sample *s, unsigned long long seed, double distance)
{
    s->seed = seed;
    s->m = 2 + pick(s, 5);
    const int variables = s->m + 1 + pick(s, 3), one = pick(s, variables), other = pick(s, variables);
    start(s, variables + s->m);
    for (int i = 0; i < variables; i++) {
        put(s, i, i, tap_random(&s->seed, -2, 2) * pow(10, pick(s, 3)));
        if (i > 0)
            put(s, i, i - 1, tap_random(&s->seed, -1, 1));
    }
    put_constraints(s, one, other, distance);
}

// Over what each row makes of the largest of the solution, and its right-hand side; summed up in the same order.
static double error_of(const sample *s, const double *x, const double *b)
{
    double r[MOST], largest[MOST] = {0}, size = 0, worst = 0;
    memcpy(r, b, sizeof r);
    for (int k = 0; k < s->pattern.nnz; k++) {
        const int i = s->row[k], j = s->col[k];
        r[i] -= s->value[k] * x[j];
        r[j] -= (i == j ? 0 : s->value[k]) * x[i];
        largest[i] = fmax(largest[i], fabs(s->value[k]));
        largest[j] = fmax(largest[j], fabs(s->value[k]));
    }
    for (int i = 0; i < s->n; i++)
        size = fmax(size, fabs(x[i]));
    for (int i = 0; i < s->n; i++)
        worst = fmax(worst, fabs(r[i]) / (largest[i] * size + fabs(b[i])));
    return worst;
}

// No other variable moves a basic one by more than a thousand times itself, as they weigh by their curvature; all of Z
// is in the null space.
static void look_at_basis(const null_space *ns, const sample *s, double *far, double *outside)
{
    double weight[MOST], other[MOST];
    const int f = ns->freedom;
    for (int i = 0; i < ns->variables; i++) {
        weight[i] = fmax(1, sqrt(fabs(s->A[i * s->n + i])));
        if (ns->basis.place[i] < 0)
            other[-1 - ns->basis.place[i]] = weight[i];
    }
    for (int i = 0; i < ns->variables; i++)
        for (int c = 0; c < f && ns->basis.place[i] >= 0; c++)
            *far = tap_worse(*far, fabs(ns->Z[i * f + c]) * weight[i] / other[c]);
    for (int k = 0; k < ns->m; k++)
        for (int c = 0; c < f; c++) {
            double sum = 0, size = 0;
            for (int i = 0; i < ns->variables; i++) {
                sum += s->A[(ns->variables + k) * s->n + i] * ns->Z[i * f + c];
                size += fabs(s->A[(ns->variables + k) * s->n + i] * ns->Z[i * f + c]);
            }
            *outside = tap_worse(*outside, size > 0 ? fabs(sum) / size : 0);
        }
}

// A basis of before is kept while it will do, though another would be chosen now.
static void test_kept_basis(void)
{
    int row[] = {0, 1, 2, 2}, col[] = {0, 1, 0, 1};
    null_space *ns;
    bool fits;
    CHECK_OK(moray_null_space_new(&ns, 3, &(moray_pattern){4, row, col}), "made");
    CHECK_OK(moray_null_space_factor(ns, (double[]){1, 1, 1, 1e-3}, &fits), "the first variable is the stronger");
    CHECK(fits && ns->basis.place[0] == 0 && ns->basis.place[1] == -1, "and taken");
    CHECK_OK(moray_null_space_factor(ns, (double[]){1, 1, 1e-4, 1}, &fits), "now the second is");
    CHECK(fits && ns->basis.place[0] == 0 && ns->Z[0] == -1e4, "but the first stays: it moves by %g", ns->Z[0]);
    moray_null_space_forget(ns);
    CHECK_OK(moray_null_space_factor(ns, (double[]){1, 1, 1e-4, 1}, &fits), "forgotten");
    CHECK(fits && ns->basis.place[0] == -1 && ns->basis.place[1] == 0, "the second is taken");
    moray_null_space_free(ns);
}

// Where constraints leave no choice of a basis, it is taken unless it is singular to the last digits.
static void test_no_choice(void)
{
    for (int k = 0; k < 2; k++) {
        static sample s;
        null_space *ns;
        bool fits;
        s.m = 2;
        start(&s, 4);
        for (int i = 0; i < 2; i++) {
            put(&s, i, i, 1);
            for (int j = 0; j < 2; j++)
                put(&s, 2 + i, j, 1 + (i == 1 && j == 1 ? (k ? 0x1p-51 : 0x1p-44) : 0));
        }
        CHECK_OK(moray_null_space_new(&ns, s.n, &s.pattern), "made");
        CHECK_OK(moray_null_space_factor(ns, s.value, &fits), "factored");
        CHECK(fits == !k, "a basis of condition %g %s", k ? 0x1p-51 : 0x1p-44, k ? "is none" : "is one");
        moray_null_space_free(ns);
    }
}

static void test_null_space(void)
{
    static sample s;
    double far = 0, outside = 0;
    int wrong = 0, failed = 0, negative = 0;
    for (int trial = 0; trial < 400; trial++) {
        null_space *ns;
        double x[MOST], b[MOST], error;
        bool fits;
        make(&s, 700 + (unsigned long long)trial, trial % 2 ? 1 : 1e-5);
        failed += moray_failed(moray_null_space_new(&ns, s.n, &s.pattern)) || !ns;
        failed += moray_failed(moray_null_space_factor(ns, s.value, &fits)) || !fits;
        look_at_basis(ns, &s, &far, &outside);
        for (int i = 0; i < s.n; i++)
            x[i] = b[i] = tap_random(&s.seed, -1, trial % 3 ? 1 : 0) * pow(10, pick(&s, 5));
        failed += moray_failed(moray_null_space_solve(ns, x, &error));
        wrong += error != error_of(&s, x, b);
        double low = 0, high = 0;
        for (int i = 0; i < s.n; i++)
            low = fmin(low, x[i]), high = fmax(high, x[i]);
        negative += -low > high;
        moray_null_space_free(ns);
    }
    CHECK(failed == 0, "%d failed", failed);
    CHECK(wrong == 0 && negative > 50 && negative < 350, "errors are those of the solutions, but for %d of 400", wrong);
    CHECK(far < 1e3 && far > 10, "no variable moves another by more than %g times itself", far);
    CHECK(outside < 1e-10, "Z is in the null space: %.1e", outside);
}

// Two right-hand sides at once are solved as one by one, with the worse of both errors.
static void test_columns(void)
{
    static sample s;
    int wrong = 0, apart = 0, in_null_space = 0;
    for (int trial = 0; trial < 100; trial++) {
        kkt_factors *kkt;
        double b[2 * MOST], one[2 * MOST], error[2];
        make(&s, 4000 + (unsigned long long)trial, 1);
        CHECK_OK(moray_kkt_factors_new(&kkt, s.n, &s.pattern), "made");
        CHECK_OK(moray_kkt_factors_factor(kkt, s.value, 1e-4), "factored");
        for (int i = 0; i < 2 * s.n; i++)
            one[i] = b[i] = tap_random(&s.seed, -1, 1);
        for (int k = 0; k < 2; k++) {
            wrong += moray_failed(moray_kkt_factors_solve(kkt, 1, one + k * s.n));
            error[k] = moray_kkt_factors_error(kkt);
        }
        wrong += moray_failed(moray_kkt_factors_solve(kkt, 2, b));
        wrong += memcmp(b, one, 2 * (size_t)s.n * sizeof *b) != 0;
        wrong += moray_kkt_factors_error(kkt) != fmax(error[0], error[1]);
        apart += error[0] > error[1] ? 1 : 0;
        in_null_space += moray_kkt_factors_inertia(kkt).negative >= s.m;
        moray_kkt_factors_free(kkt);
    }
    CHECK(wrong == 0 && apart > 20 && apart < 80 && in_null_space == 100, "but for %d of 100; %d times the first",
          wrong, apart);
}

// ---- Work ----

// A tree of small blocks, strong on the diagonal or not.
static void set_tree(sample *s, double diagonal)
{
    s->seed = 3;
    start(s, MOST);
    for (int i = 0; i < MOST; i++) {
        put(s, i, i, diagonal);
        if (i > 0)
            put(s, i, (i - 1) / 2, 1);
        if (i > 2)
            put(s, i, (i - 3) / 4, 0.5);
    }
}

static void test_work(void)
{
    static sample s;
    moray_ldl *ldl;
    double b[MOST] = {0};
    set_tree(&s, 9);
    CHECK_OK(moray_ldl_new(&ldl, s.n, &s.pattern), "made");
    CHECK_OK(moray_ldl_factor(ldl, s.value, 0.1), "factored");
    moray_ldl_statistics at = moray_ldl_statistics_of(ldl);
    CHECK(at.done == at.planned && at.filled == at.entries && at.delayed == 0 && at.pivots_2x2 == 0 && at.pairs == 0,
          "as planned: %g of %g, %g entries of %g", at.done, at.planned, at.filled, at.entries);
    CHECK(moray_ldl_inertia_of(ldl).positive == MOST, "all positive");
    CHECK(at.fronts > 1 && at.largest <= MOST && at.entries >= at.fronts, "%d fronts of up to %d rows", at.fronts,
          at.largest);
    set_tree(&s, 1e-3);
    CHECK_OK(moray_ldl_factor(ldl, s.value, 0.4), "weak pivots");
    at = moray_ldl_statistics_of(ldl);
    const double most = at.filled;
    CHECK(at.delayed > 0 && at.pivots_2x2 > 0 && at.done > at.planned && at.filled > at.entries && at.orders == 1,
          "%d delayed: %g done of %g, %g entries of %g", at.delayed, at.done, at.planned, at.filled, at.entries);
    set_tree(&s, 9);
    CHECK_OK(moray_ldl_factor(ldl, s.value, 0.1), "strong ones");
    at = moray_ldl_statistics_of(ldl);
    CHECK(at.filled == most && at.done == at.planned && at.delayed == 0 && at.pivots_2x2 == 0 && at.factors == 3,
          "the most so far is kept: %g", at.filled);
    CHECK_OK(moray_ldl_solve(ldl, 1, b), "solved");
    CHECK(moray_ldl_statistics_of(ldl).error == 0 && b[0] == 0, "nothing of nothing");
    moray_ldl_free(ldl);
}

// What is told of an order is what its plan says; each constraint has its partner.
static void test_order(void)
{
    static sample s;
    moray_ldl *ldl;
    enum { constraints = 12, variables = 20 };
    s.seed = 5;
    start(&s, variables + constraints);
    for (int j = 0; j < variables; j++)
        put(&s, j, j, 1);
    for (int c = 0; c < constraints; c++)
        put(&s, variables + c, c, 1), put(&s, variables + c, c + 1, 0.3), put(&s, variables + c, variables - 1, 0.2);
    CHECK_OK(moray_ldl_new(&ldl, s.n, &s.pattern), "made");
    CHECK_OK(moray_ldl_factor(ldl, s.value, 0.01), "factored");
    const moray_ldl_statistics at = moray_ldl_statistics_of(ldl);
    const struct plan *plan = &ldl->plan;
    int largest = 0;
    double entries = 0;
    for (int k = 0; k < plan->nodes; k++) {
        const int height = plan->node[k].columns + plan->node[k].rows;
        largest = height > largest ? height : largest;
        entries += plan->node[k].columns * height;
    }
    CHECK(at.fronts == plan->nodes && at.largest == largest && at.entries == entries && at.planned == plan->flops,
          "%d fronts of up to %d rows, %g entries", at.fronts, at.largest, at.entries);
    CHECK(at.pairs == constraints && at.orders == 1, "%d pairs", at.pairs);
    CHECK(moray_ldl_inertia_of(ldl).negative == constraints, "and their inertia");
    moray_ldl_free(ldl);
}

// An arrow whose shaft is too weak for pivots of its own: few entries may be many times those planned. Work that comes
// with the last front does not make the order worn, but counts for the time after.
static void test_small_fill(void)
{
    enum { shaft = 150 };
    static int row[3 * shaft], col[3 * shaft];
    static double value[3 * shaft];
    moray_ldl *ldl;
    for (int i = 0; i < shaft; i++) {
        row[3 * i] = col[3 * i] = col[3 * i + 1] = 2 * i;
        row[3 * i + 1] = col[3 * i + 2] = 2 * i + 1;
        row[3 * i + 2] = 2 * shaft;
        value[3 * i] = value[3 * i + 1] = value[3 * i + 2] = 1;
    }
    CHECK_OK(moray_ldl_new(&ldl, 2 * shaft + 1, &(moray_pattern){3 * shaft, row, col}), "an arrow");
    CHECK_OK(moray_ldl_factor(ldl, value, 0.1), "with a strong shaft");
    const double usual = moray_ldl_statistics_of(ldl).done;
    for (int turn = 0; turn < 2; turn++) {
        double b[2 * shaft + 1] = {0};
        for (int k = 0; k < 3 * shaft; k++) { // the right-hand side of a solution of ones
            value[k] = k % 3 == 1 ? 1e-3 : 1;
            b[row[k]] += value[k];
            b[col[k]] += row[k] == col[k] ? 0 : value[k];
        }
        CHECK_OK(moray_ldl_factor(ldl, value, 0.1), "with a weak one");
        const moray_ldl_statistics at = moray_ldl_statistics_of(ldl);
        CHECK(at.filled > 9 * at.entries && at.filled < 1e6 && at.delayed > 0, "%g entries for %g", at.filled,
              at.entries);
        CHECK(at.orders == 1 + turn && at.done > 5 * usual, "%d orders; %g done, %g before", at.orders, at.done, usual);
        CHECK_OK(moray_ldl_solve(ldl, 1, b), "solved");
        CHECK(moray_ldl_statistics_of(ldl).error < 1e-14, "to %.1e", moray_ldl_statistics_of(ldl).error);
    }
    moray_ldl_free(ldl);
}

int main(void)
{
    test_order();
    test_small_fill();
    test_error();
    test_large_solution();
    test_worst();
    test_nan();
    test_null_space();
    test_kept_basis();
    test_no_choice();
    test_columns();
    test_work();
    return tap_done();
}
