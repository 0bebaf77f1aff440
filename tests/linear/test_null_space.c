// SPDX-License-Identifier: MIT
//
// Matrices of few degrees of freedom in the null space of their constraints: planted solutions, LAPACK's eigenvalues,
// and matrices that do not suit, which LDL' then takes.
#include "tap.h"

#include <stdlib.h>
#include <string.h>

#include "linear/kkt_factors.h"
#include "linear/null_space.h"
#include "sample.h"

// A chain of constraints as of dynamics, with parameters that all of them meet, entries in two parts, a Hessian of its
// own; spread: powers of ten over which rows are scaled.
static void make(sample *s, unsigned long long seed, double spread)
{
    s->seed = seed;
    s->m = 1 + pick(s, 24);
    const int freedom = pick(s, 5), variables = s->m + freedom;
    start(s, variables + s->m);
    double scale[MOST];
    for (int i = 0; i < s->n; i++)
        scale[i] = pow(10, spread * tap_random(&s->seed, -0.5, 0.5));
    for (int i = 0; i < variables; i++)
        for (int j = i > 3 ? i - 3 : 0; j <= i; j++)
            put(s, i, j, scale[i] * scale[j] * tap_random(&s->seed, -1, 1));
    for (int c = 0; c < s->m; c++) {
        const int row = variables + c;
        put(s, row, c, scale[row] * scale[c] * tap_random(&s->seed, 1, 2));
        put(s, row, c, scale[row] * scale[c] * tap_random(&s->seed, 0, 1)); // adds up
        if (c > 0)
            put(s, row, c - 1, scale[row] * scale[c - 1] * tap_random(&s->seed, -1, 1));
        for (int j = s->m; j < variables; j++)
            put(s, row, j, scale[row] * scale[j] * tap_random(&s->seed, -1, 1));
        put(s, row, row, 0);
    }
}

// b <- A x for an x in which every entry counts. Returns the largest of |A| |x|.
static void plant(const sample *s, double *x, double *b)
{
    for (int i = 0; i < s->n; i++) {
        x[i] = 1 + 0.1 * i;
        b[i] = 0;
    }
    for (int i = 0; i < s->n; i++)
        for (int j = 0; j < s->n; j++)
            b[i] += s->A[i * s->n + j] * x[j];
}

static int negative_eigenvalues(const sample *s)
{
    static double A[MOST * MOST], w[MOST], work[10 * MOST];
    const int size = 10 * MOST;
    int info, count = 0;
    memcpy(A, s->A, (size_t)(s->n * s->n) * sizeof *A);
    dsyev_("N", "L", &s->n, A, &s->n, w, work, &size, &info);
    for (int i = 0; i < s->n; i++)
        count += w[i] < 0;
    return count;
}

static void test_random(void)
{
    static sample s;
    double worst = 0, residual = 0;
    int wrong = 0, taken = 0, failed = 0;
    enum { samples = 600 };
    for (int k = 0; k < samples; k++) {
        double x[MOST], b[MOST], error;
        bool fits;
        null_space *ns;
        make(&s, 100 + (unsigned long long)k, k % 3 * 2);
        failed += moray_failed(moray_null_space_new(&ns, s.n, &s.pattern));
        failed += moray_failed(moray_null_space_factor(ns, s.value, &fits));
        taken += fits;
        if (fits) {
            plant(&s, x, b);
            failed += moray_failed(moray_null_space_solve(ns, b, &error));
            for (int i = 0; i < s.n; i++)
                worst = tap_worse(worst, fabs(b[i] / x[i] - 1) * (k % 3 == 0));
            residual = tap_worse(residual, error);
            const moray_ldl_inertia inertia = moray_null_space_inertia(ns);
            wrong += inertia.zero != 0 || inertia.negative != negative_eigenvalues(&s) ||
                     inertia.positive + inertia.negative != s.n;
        }
        moray_null_space_free(ns);
    }
    CHECK(failed == 0, "%d of %d calls failed", failed, 3 * samples);
    CHECK(taken == samples, "%d of %d factored", taken, samples);
    CHECK(wrong == 0, "inertia of %d differs from LAPACK's", wrong);
    CHECK(worst < 1e-6, "planted solutions to %.1e where rows have one scale", worst);
    CHECK(residual < 1e-13, "residuals to %.1e", residual);
}

// A stationarity row of which the multipliers nearly cancel and the Hessian leaves next to nothing: the error is
// relative to what the constraints put into the row, not to what is left there.
static void test_cancelling(void)
{
    static sample s;
    double worst = 0;
    enum { variables = 3, samples = 100 };
    for (int k = 0; k < samples; k++) {
        double error, b[] = {0, 1, 2, 3, 4};
        bool fits;
        null_space *ns;
        s.seed = 1 + (unsigned long long)k;
        s.m = 2;
        start(&s, variables + s.m);
        for (int j = 0; j < variables; j++)
            put(&s, j, j, j == 0 ? 1e-9 : 1);
        const double sign = k % 2 ? -1 : 1; // a constraint turned round is the same
        for (int c = 0; c < s.m; c++) {
            put(&s, variables + c, 0, sign * tap_random(&s.seed, 1, 2));
            put(&s, variables + c, 1 + c, sign * tap_random(&s.seed, 1, 2));
        }
        CHECK_OK(moray_null_space_new(&ns, s.n, &s.pattern), "made");
        CHECK_OK(moray_null_space_factor(ns, s.value, &fits), "factored");
        CHECK_OK(moray_null_space_solve(ns, b, &error), "solved");
        worst = tap_worse(worst, error);
        moray_null_space_free(ns);
    }
    CHECK(worst < 1e-14, "errors to %.1e", worst);
}

// The factors of a matrix after others of the same pattern, and of the same constraints under another Hessian.
static void test_again(void)
{
    static sample s;
    double x[MOST], b[MOST], error;
    bool fits;
    null_space *ns;
    make(&s, 7, 0);
    CHECK_OK(moray_null_space_new(&ns, s.n, &s.pattern), "made");
    CHECK_OK(moray_null_space_factor(ns, s.value, &fits), "factored");
    for (int turn = 0; turn < 3; turn++) {
        memset(s.A, 0, sizeof s.A);
        for (int k = 0; k < s.pattern.nnz; k++) {
            const int i = s.row[k], j = s.col[k];
            const bool constraint = i >= s.n - s.m || j >= s.n - s.m;
            s.value[k] *= turn == 0 && constraint ? 1 : 1.5 + 0.1 * (k % 7);
            s.A[i * s.n + j] += s.value[k];
            s.A[j * s.n + i] += i != j ? s.value[k] : 0;
        }
        plant(&s, x, b);
        CHECK_OK(moray_null_space_factor(ns, s.value, &fits), "again");
        CHECK_OK(moray_null_space_solve(ns, b, &error), "solved");
        double worst = 0;
        for (int i = 0; i < s.n; i++)
            worst = tap_worse(worst, fabs(b[i] / x[i] - 1));
        CHECK(fits && worst < 1e-9, "other values, turn %d: %.1e", turn, worst);
    }
    moray_null_space_free(ns);
}

static void check_taken(sample *s, const char *what)
{
    double x[MOST], b[MOST], worst = 0;
    kkt_factors *kkt;
    CHECK_OK(moray_kkt_factors_new(&kkt, s->n, &s->pattern), "made");
    CHECK_OK(moray_kkt_factors_factor(kkt, s->value, 1e-4), "factored");
    CHECK(moray_kkt_factors_inertia(kkt).negative == negative_eigenvalues(s), "%s: inertia as LAPACK's", what);
    plant(s, x, b);
    CHECK_OK(moray_kkt_factors_solve(kkt, 1, b), "solved");
    for (int i = 0; i < s->n; i++)
        worst = tap_worse(worst, fabs(b[i] / x[i] - 1));
    CHECK(worst < 1e-7 && moray_kkt_factors_error(kkt) < 1e-11, "%s: %.1e", what, worst);
    moray_kkt_factors_free(kkt);
}

// A matrix of few degrees of freedom is solved in the null space: to the last bit as there, which LDL' does not do.
static void test_form(void)
{
    static sample s;
    const size_t all = sizeof(double[MOST]);
    double x[MOST], b[MOST] = {0}, in_null_space[MOST], by_ldl[MOST], error;
    bool fits;
    kkt_factors *kkt;
    null_space *ns;
    moray_ldl *ldl;
    make(&s, 11, 4);
    plant(&s, x, b);
    memcpy(in_null_space, b, all);
    memcpy(by_ldl, b, all);
    CHECK_OK(moray_null_space_new(&ns, s.n, &s.pattern), "made");
    CHECK_OK(moray_null_space_factor(ns, s.value, &fits), "factored");
    CHECK_OK(moray_null_space_solve(ns, in_null_space, &error), "solved in the null space");
    CHECK_OK(moray_ldl_new(&ldl, s.n, &s.pattern), "made");
    CHECK_OK(moray_ldl_factor(ldl, s.value, 1e-4), "factored");
    CHECK_OK(moray_ldl_solve(ldl, 1, by_ldl), "solved by LDL'");
    CHECK_OK(moray_kkt_factors_new(&kkt, s.n, &s.pattern), "made");
    CHECK_OK(moray_kkt_factors_factor(kkt, s.value, 1e-4), "factored");
    CHECK_OK(moray_kkt_factors_solve(kkt, 1, b), "solved by the form that suits");
    CHECK(fits && memcmp(in_null_space, by_ldl, all) != 0, "both forms round otherwise");
    CHECK(memcmp(b, in_null_space, all) == 0, "the form that suits is that of the null space");
    moray_kkt_factors_free(kkt);
    moray_ldl_free(ldl);
    moray_null_space_free(ns);
}

// Constraints that regularisation has put something on the diagonal of; one without entries; what is no number;
// patterns of another form.
static void test_unsuited(void)
{
    static sample s;
    null_space *ns;
    double error, b[MOST] = {0};
    bool fits;
    make(&s, 11, 0);
    check_taken(&s, "as it should be");
    put(&s, s.n - 1, s.n - 1, -1e-8);
    CHECK_OK(moray_null_space_new(&ns, s.n, &s.pattern), "made");
    CHECK_OK(moray_null_space_factor(ns, s.value, &fits), "looked at");
    CHECK(!fits, "something on the diagonal of a constraint");
    CHECK(moray_null_space_solve(ns, b, &error).code == MORAY_NUMERIC, "and nothing to solve with");
    moray_null_space_free(ns);
    check_taken(&s, "something on the diagonal of a constraint");

    make(&s, 11, 0);
    for (int k = 0; k < s.pattern.nnz; k++) // two constraints the same
        if (s.row[k] + s.col[k] >= s.n && (s.row[k] == s.n - 1 || s.col[k] == s.n - 1))
            s.value[k] = 0;
    CHECK_OK(moray_null_space_new(&ns, s.n, &s.pattern), "made");
    CHECK_OK(moray_null_space_factor(ns, s.value, &fits), "looked at");
    CHECK(!fits, "a constraint of nothing");
    s.value[0] = NAN;
    CHECK(moray_null_space_factor(ns, s.value, &fits).code == MORAY_NUMERIC && !fits, "not a number");
    moray_null_space_free(ns);

    CHECK_OK(moray_null_space_new(&ns, 60, &(moray_pattern){2, (int[]){59, 58}, (int[]){0, 1}}), "looked at");
    CHECK(!ns, "too many degrees of freedom");
    CHECK_OK(moray_null_space_new(&ns, 3, &(moray_pattern){2, (int[]){1, 2}, (int[]){0, 0}}), "looked at");
    CHECK(!ns, "more constraints than variables");
}

// Constraints whose basis is hardly regular at some values cost digits, and are left to LDL'.
static void test_ill(void)
{
    static sample s;
    static const double tiny[] = {1e-6, 1e-9, 1e-12, 1e-15};
    for (int k = 0; k < 4; k++) {
        kkt_factors *kkt;
        double x[MOST], b[MOST], rhs[MOST];
        make(&s, 17, 0);
        CHECK_OK(moray_kkt_factors_new(&kkt, s.n, &s.pattern), "made");
        CHECK_OK(moray_kkt_factors_factor(kkt, s.value, 1e-4), "factored");
        memset(s.A, 0, sizeof s.A);
        for (int e = 0; e < s.pattern.nnz; e++) {
            const int low = s.row[e] < s.col[e] ? s.row[e] : s.col[e], high = s.row[e] + s.col[e] - low;
            if (high >= s.n - s.m && low == high - (s.n - s.m)) // the matched entries
                s.value[e] *= tiny[k];
            s.A[s.row[e] * s.n + s.col[e]] += s.value[e];
            s.A[s.col[e] * s.n + s.row[e]] += s.row[e] != s.col[e] ? s.value[e] : 0;
        }
        plant(&s, x, b);
        memcpy(rhs, b, sizeof rhs);
        CHECK_OK(moray_kkt_factors_factor(kkt, s.value, 1e-4), "factored");
        CHECK_OK(moray_kkt_factors_solve(kkt, 1, b), "solved");
        CHECK(residual_of(&s, b, rhs) < 1e-9, "of this right-hand side: %.1e", residual_of(&s, b, rhs));
        CHECK(moray_kkt_factors_error(kkt) < 1e-11, "entries of the basis times %g: %.1e", tiny[k],
              moray_kkt_factors_error(kkt));
        CHECK(moray_kkt_factors_inertia(kkt).negative == negative_eigenvalues(&s), "inertia as LAPACK's");
        moray_kkt_factors_free(kkt);
    }
}

// A chain that fades in one direction and grows in the other, driven by a parameter: x_k+1 = fading x_k + p, or the
// other way round. A basis that runs against it loses all digits.
static void make_chain(sample *s, double forward, double backward)
{
    s->seed = 19;
    s->m = 18;
    start(s, 2 * s->m + 2);
    for (int i = 0; i < s->m + 2; i++)
        put(s, i, i, 1 + 0.1 * i);
    for (int c = 0; c < s->m; c++) {
        const int row = s->m + 2 + c;
        put(s, row, c, -forward);
        put(s, row, c + 1, backward);
        put(s, row, s->m + 1, -1);
    }
}

static double solve_planted(null_space *ns, const sample *s)
{
    double x[MOST], b[MOST], error, worst = 0;
    bool fits;
    plant(s, x, b);
    CHECK_OK(moray_null_space_factor(ns, s->value, &fits), "factored");
    CHECK(fits, "there is a basis");
    CHECK_OK(moray_null_space_solve(ns, b, &error), "solved");
    for (int i = 0; i < s->n; i++)
        worst = tap_worse(worst, fabs(b[i] / x[i] - 1));
    return error > 1e-13 ? error : worst;
}

static void test_direction(void)
{
    static sample s;
    null_space *ns;
    make_chain(&s, 0.05, 1);
    CHECK_OK(moray_null_space_new(&ns, s.n, &s.pattern), "made");
    CHECK(solve_planted(ns, &s) < 1e-11, "a chain that fades");
    make_chain(&s, 1, 0.05);
    moray_null_space_forget(ns);
    CHECK(solve_planted(ns, &s) < 1e-11, "and one that grows, by a basis of its own");
    moray_null_space_free(ns);
    check_taken(&s, "one that grows");
}

// Of constraints whose larger columns are multiples of each other, but for rounding, what is matched first is no basis:
// a small column has to come in.
static void test_repair(void)
{
    static sample s;
    enum { variables = 4, samples = 50 };
    for (int k = 0; k < samples; k++) {
        double row[2], rescue[2];
        null_space *ns;
        s.seed = 400 + (unsigned long long)k;
        s.m = 2;
        start(&s, variables + s.m);
        for (int j = 0; j < variables; j++)
            put(&s, j, j, tap_random(&s.seed, 1, 2));
        for (int c = 0; c < 2; c++) {
            row[c] = tap_random(&s.seed, 0.5, 1);
            rescue[c] = tap_random(&s.seed, 1e-4, 1e-3);
        }
        for (int c = 0; c < 2; c++) {
            put(&s, variables + c, 0, row[c]);
            put(&s, variables + c, 1, row[c] * row[0]);
            put(&s, variables + c, 2, rescue[c]);
            put(&s, variables + c, 3, c * rescue[0]);
        }
        CHECK_OK(moray_null_space_new(&ns, s.n, &s.pattern), "made");
        CHECK(solve_planted(ns, &s) < 1e-7, "constraints of nearly one direction, sample %d", k);
        moray_null_space_free(ns);
    }
}

// Variables that come to their bounds one after another, as slacks do: their curvature leaves that of others to be
// seen.
static void test_bounds(void)
{
    static sample s;
    enum { variables = 5, rows = 2 };
    const double coefficient[rows][variables] = {{1, 2, 0, -1, 1}, {0, 1, 1, 1, -2}};
    for (int first = 0; first < variables; first++) {
        null_space *ns = NULL;
        for (int bound = 0; bound < 3; bound++) { // as many as leave no freedom
            const int at[] = {first, (first + 1) % variables, (first + 2) % variables};
            s.seed = 23;
            s.m = rows;
            start(&s, variables + rows);
            for (int j = 0; j < variables; j++) {
                bool near = false;
                for (int k = 0; k < bound; k++)
                    near = near || at[k] == j;
                put(&s, j, j, near ? 1e13 + j : 1e-2 * (1 + j));
            }
            for (int c = 0; c < rows; c++)
                for (int j = 0; j < variables; j++)
                    put(&s, variables + c, j, coefficient[c][j]);
            if (!ns)
                CHECK_OK(moray_null_space_new(&ns, s.n, &s.pattern), "made");
            CHECK(solve_planted(ns, &s) < 1e-11, "%d variables at bounds, from %d", bound, first);
            CHECK(moray_null_space_inertia(ns).negative == rows, "and the inertia");
        }
        moray_null_space_free(ns);
    }
}

int main(void)
{
    test_random();
    test_cancelling();
    test_again();
    test_form();
    test_unsuited();
    test_ill();
    test_direction();
    test_repair();
    test_bounds();
    return tap_done();
}
