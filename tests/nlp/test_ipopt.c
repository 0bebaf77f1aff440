// SPDX-License-Identifier: MIT
//
// What Ipopt is given and what it tells: a linear programme in a box whose corner is known, with bounds of every kind,
// more rows than columns, and a record of all calls; and a quadratic one without bounds, whose first slopes are known.
#include "tap.h"

#include <string.h>

#include "moray/clock.h"
#include "moray/nlp.h"

// ---- min price x, rows x_j, 2 x_j for the first columns ----

enum { n = 4, m = 6 };
static const double price[n] = {300, -200, 500, -400};

struct box {
    double lower[n], upper[n], g_lower[m], g_upper[m], x_scale[n], g_scale[m];
    double least[n], most[n], g_least[m], g_most[m]; // of all points that were asked for
    int calls[5], begun, ended;
    double seconds[5], wait;
    moray_nlp nlp;
};

static const int row_of[m] = {0, 1, 2, 3, 4, 5}, column_of[m] = {0, 1, 2, 3, 0, 1};

static double slope_of(int i)
{
    return i < n ? 1 : 2;
}

static void spend(struct box *b, int which)
{
    const double start = moray_clock();
    while (moray_clock() - start < b->wait * (1 + which))
        ;
    b->calls[which]++;
    b->seconds[which] += moray_clock() - start;
}

static bool cost(void *self, const double *x, bool fresh, double *f)
{
    struct box *b = self;
    (void)fresh;
    *f = 0;
    for (int j = 0; j < n; j++) {
        *f += price[j] * x[j];
        b->least[j] = fmin(b->least[j], x[j]);
        b->most[j] = fmax(b->most[j], x[j]);
    }
    spend(b, 0);
    return true;
}

static bool cost_gradient(void *self, const double *x, bool fresh, double *g)
{
    (void)x, (void)fresh;
    memcpy(g, price, sizeof price);
    spend(self, 1);
    return true;
}

static bool rows(void *self, const double *x, bool fresh, double *g)
{
    struct box *b = self;
    (void)fresh;
    for (int i = 0; i < m; i++) {
        g[i] = slope_of(i) * x[column_of[i]];
        b->g_least[i] = fmin(b->g_least[i], g[i]);
        b->g_most[i] = fmax(b->g_most[i], g[i]);
    }
    spend(b, 2);
    return true;
}

static bool slopes(void *self, const double *x, bool fresh, double *values)
{
    (void)x, (void)fresh;
    for (int i = 0; i < m; i++)
        values[i] = slope_of(i);
    spend(self, 3);
    return true;
}

static bool straight(void *self, const double *x, bool fresh, double sigma, const double *lambda, double *values)
{
    (void)x, (void)fresh, (void)sigma, (void)lambda, (void)values;
    spend(self, 4);
    return true;
}

static void hold(void *self, bool begins)
{
    struct box *b = self;
    *(begins ? &b->begun : &b->ended) += 1;
}

static void box_new(struct box *b)
{
    *b = (struct box){.nlp = {.n = n,
                              .m = m,
                              .x_lower = b->lower,
                              .x_upper = b->upper,
                              .g_lower = b->g_lower,
                              .g_upper = b->g_upper,
                              .nnz_jac = m,
                              .jac_row = row_of,
                              .jac_col = column_of,
                              .self = b,
                              .objective = cost,
                              .gradient = cost_gradient,
                              .constraints = rows,
                              .jacobian = slopes,
                              .hessian = straight,
                              .hold = hold}};
    for (int j = 0; j < n; j++) {
        b->lower[j] = -MORAY_INFINITY, b->upper[j] = MORAY_INFINITY;
        b->least[j] = INFINITY, b->most[j] = -INFINITY;
    }
    for (int i = 0; i < m; i++) {
        b->g_lower[i] = -MORAY_INFINITY, b->g_upper[i] = MORAY_INFINITY;
        b->g_least[i] = INFINITY, b->g_most[i] = -INFINITY;
    }
}

static double x[n], z_lower[n], z_upper[n], g[m], lambda[m];
static moray_iterate at = {x, z_lower, z_upper, g, lambda, 0};

static moray_status solve(struct box *b, const moray_nlp_settings *settings, moray_nlp_info *info)
{
    static const double start[n] = {1, 0.2, 1, -100};
    memcpy(x, start, sizeof x);
    return moray_ipopt_solve(&b->nlp, settings, &at, info);
}

static moray_nlp_settings tight(void)
{
    moray_nlp_settings settings = moray_nlp_settings_default();
    settings.tolerance = 1e-11;
    return settings;
}

// ---- Bounds give way by 1e-8 of their size, and of the scale where that is less than 1; the result does not ----

static void check_gives(const char *what, double seen, double bound, double gives)
{
    CHECK(fabs(fabs(seen - bound) - gives) < 0.02 * gives, "%s: beyond %g by %.3g, expected %.3g", what, bound,
          seen - bound, gives);
}

static void test_bounds(void)
{
    struct box b;
    moray_nlp_info info;
    const moray_nlp_settings settings = tight();
    box_new(&b);
    b.lower[0] = -3000, b.upper[1] = 0.25, b.lower[2] = 0, b.upper[3] = -70;
    CHECK_OK(solve(&b, &settings, &info), "bounds of columns");
    const double corner[n] = {-3000, 0.25, 0, -70};
    check_gives("a large lower one", b.least[0], -3000, 3e-5);
    check_gives("a small upper one", b.most[1], 0.25, 1e-8);
    check_gives("a lower one at 0", b.least[2], 0, 1e-8);
    check_gives("an upper one below 0", b.most[3], -70, 7e-7);
    for (int j = 0; j < n; j++)
        CHECK(x[j] == corner[j], "x[%d] = %.12g stands at its bound", j, x[j]);
    box_new(&b);
    b.g_lower[0] = -3000, b.g_upper[5] = 0.5, b.g_lower[2] = 0, b.g_upper[3] = 70;
    CHECK_OK(solve(&b, &settings, &info), "bounds of rows");
    check_gives("a large lower one of a row", b.g_least[0], -3000, 3e-5);
    check_gives("a small upper one of a row", b.g_most[5], 0.5, 1e-8);
    check_gives("a lower one at 0 of a row", b.g_least[2], 0, 1e-8);
    check_gives("an upper one of a row", b.g_most[3], 70, 7e-7);
    for (int i = 0; i < m; i++) {
        const double multiplier = i == 0 ? -300 : i == 5 ? 100 : i == 2 ? -500 : i == 3 ? 400 : 0;
        CHECK_NEAR(lambda[i], multiplier, 1e-6, "multiplier of a row");
    }
}

static void test_scaled_bounds(void)
{
    struct box b;
    moray_nlp_info info;
    const moray_nlp_settings settings = tight();
    box_new(&b);
    const double scale[n] = {1e3, 1e-2, 1e2, 1e4};
    b.nlp.x_scale = memcpy(b.x_scale, scale, sizeof scale);
    b.lower[0] = 0, b.upper[1] = 0.25, b.lower[2] = -0.5, b.upper[3] = 0;
    CHECK_OK(solve(&b, &settings, &info), "bounds of columns in small units");
    check_gives("at 0, of size 1e-3", b.least[0], 0, 1e-11);
    check_gives("of a size that is more than 1", b.most[1], 0.25, 1e-8);
    check_gives("of a size that is less than its own", b.least[2], -0.5, 5e-9);
    check_gives("at 0, of size 1e-4", b.most[3], 0, 1e-12);
    box_new(&b);
    const double of_rows[m] = {1e3, 1, 1e-2, 1e2, 1, 1};
    b.nlp.g_scale = memcpy(b.g_scale, of_rows, sizeof of_rows);
    b.g_lower[0] = 0, b.upper[1] = 1, b.g_lower[2] = -0.125, b.g_upper[3] = 0;
    CHECK_OK(solve(&b, &settings, &info), "bounds of rows in small units");
    check_gives("a row at 0, of size 1e-3", b.g_least[0], 0, 1e-11);
    check_gives("a row of a size that is more than 1", b.g_least[2], -0.125, 1e-8);
    check_gives("a row at 0, of size 1e-2", b.g_most[3], 0, 1e-10);
}

// What is fixed stays, and its multiplier takes up its slope.
static void test_fixed(void)
{
    struct box b;
    moray_nlp_info info;
    const moray_nlp_settings settings = tight();
    box_new(&b);
    b.lower[0] = b.upper[0] = 7, b.upper[1] = 4, b.lower[2] = 1, b.g_lower[3] = b.g_upper[3] = -2;
    CHECK_OK(solve(&b, &settings, &info), "fixed ones");
    CHECK(b.least[0] == 7 && b.most[0] == 7 && x[0] == 7, "a column stays at 7");
    CHECK_NEAR(x[3], -2, 1e-12, "a row stays at -2");
    CHECK_NEAR(lambda[3], 400, 1e-6, "which its multiplier says");
    CHECK_NEAR(z_upper[1], 200, 1e-6, "an upper bound's multiplier");
    CHECK_NEAR(z_lower[2], 500, 1e-6, "a lower bound's");
    CHECK(at.objective == 300 * x[0] - 200 * x[1] + 500 * x[2] - 400 * x[3], "objective of the corner");
}

// ---- What is counted ----

static double sum_of(const double *seconds)
{
    double sum = 0;
    for (int k = 0; k < 5; k++)
        sum += seconds[k];
    return sum;
}

static void test_accounts(bool timing)
{
    struct box b;
    moray_nlp_info info;
    moray_nlp_settings settings = tight();
    box_new(&b);
    b.upper[1] = 1, b.lower[0] = b.lower[2] = 0, b.upper[3] = 2, b.wait = 1e-4;
    settings.timing = timing;
    const double start = moray_clock();
    CHECK_OK(solve(&b, &settings, &info), "a box");
    const double all = moray_clock() - start;
    CHECK(b.begun == 1 && b.ended == 1, "told once that it begins, and that it ends");
    for (int k = 0; k < 5; k++)
        CHECK(info.evaluations[k] <= b.calls[k] && b.calls[k] <= info.evaluations[k] + 1 && info.evaluations[k] > 2,
              "function %d: %d of %d calls are Ipopt's", k, info.evaluations[k], b.calls[k]);
    CHECK_RELATIVE(sum_of(info.evaluation_by), info.evaluation_seconds, 1e-12, "the parts make the whole");
    CHECK(info.seconds <= all && info.seconds >= info.evaluation_seconds * (timing ? 0.5 : 1), "%g of %g s, in %g",
          info.evaluation_seconds, info.seconds, all);
    CHECK(info.cpu_seconds > 0 && info.cpu_seconds <= 1.5 * all + 0.01, "%g s of the processor", info.cpu_seconds);
    for (int k = 0; k < 5 && !timing; k++)
        CHECK(info.evaluation_by[k] >= b.wait * (1 + k) * info.evaluations[k],
              "function %d: %g s are as long as it took", k, info.evaluation_by[k]);
    CHECK(info.outcome == MORAY_NLP_SOLVED && info.iterations > 3 && info.regularisation >= 0, "solved in %d",
          info.iterations);
    CHECK(info.linear_seconds >= 0 && info.linear_seconds < all, "%g s in the linear solver", info.linear_seconds);
}

// ---- Refusals, names ----

static void refuse(struct box *b, const moray_nlp_settings *settings, const char *told)
{
    moray_nlp_info info;
    const moray_status status = solve(b, settings, &info);
    CHECK(status.code == MORAY_INPUT && strcmp(status.text, told) == 0, "refused: %s", status.text);
}

static void test_refusals(void)
{
    struct box b;
    box_new(&b);
    b.upper[1] = b.upper[3] = 1, b.lower[0] = b.lower[2] = 0;
    moray_nlp_settings settings = tight();
    settings.max_iterations = -1;
    refuse(&b, &settings, "max_iterations = -1: must not be negative");
    settings = tight(), settings.print_level = 13;
    refuse(&b, &settings, "print level 13: must lie between 0 and 12");
    settings.print_level = -1;
    refuse(&b, &settings, "print level -1: must lie between 0 and 12");
    settings = tight(), settings.tolerance = 0;
    refuse(&b, &settings, "tolerance = 0: must lie between 0 and 1");
    b.nlp.n = 0;
    settings = tight();
    refuse(&b, &settings, "Ipopt refuses a problem of 0 variables and 6 constraints");
}

// MA57 is where it is installed, and else refused; our own factorisation does not stand in for it.
static void test_missing_solver(void)
{
    struct box b;
    moray_nlp_info info;
    moray_nlp_settings settings = tight();
    box_new(&b);
    b.upper[1] = b.upper[3] = 1, b.lower[0] = b.lower[2] = 0;
    CHECK_OK(solve(&b, &settings, &info), "our own");
    settings.linear_solver = MORAY_LINEAR_MA57;
    const moray_status status = solve(&b, &settings, &info);
    CHECK(moray_failed(status) ? status.code == MORAY_INPUT &&
                                     strcmp(status.text, "Ipopt refuses an option when it starts: is its linear solver "
                                                         "there?") == 0
                               : info.outcome == MORAY_NLP_SOLVED,
          "another: %s", status.text);
    CHECK(info.linear_solver == MORAY_LINEAR_MA57, "and no other takes its place");
}

static void test_names(void)
{
    static const char *const outcomes[] = {"solved",
                                           "solved to a looser tolerance",
                                           "infeasible",
                                           "iteration limit",
                                           "interrupted",
                                           "stalled",
                                           "not a number, or too few degrees of freedom",
                                           "unknown",
                                           "unknown"};
    static const char *const solvers[] = {"moray", "mumps", "ma57", "unknown", "unknown"};
    for (int k = 0; k < 9; k++)
        CHECK(strcmp(moray_nlp_outcome_text((moray_nlp_outcome)k), outcomes[k]) == 0, "outcome %d: %s", k, outcomes[k]);
    for (int k = 0; k < 5; k++)
        CHECK(strcmp(moray_linear_solver_text((moray_linear_solver)k), solvers[k]) == 0, "solver %d: %s", k,
              solvers[k]);
    CHECK(strcmp(moray_nlp_outcome_text((moray_nlp_outcome)-1), "unknown") == 0, "outcome -1");
    const moray_nlp_settings usual = moray_nlp_settings_default();
    CHECK(usual.tolerance == 1e-8 && usual.max_iterations == 1000 && usual.barrier == 0.1, "settings by default");
}

int main(void)
{
    test_bounds();
    test_scaled_bounds();
    test_fixed();
    test_accounts(false);
    test_accounts(true);
    test_refusals();
    test_missing_solver();
    test_names();
    return tap_done();
}
