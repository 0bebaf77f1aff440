// SPDX-License-Identifier: MIT
//
// What the settings make of a solve: where it starts, in which scales, when it ends and what is told of that.
#include "tap.h"

#include <string.h>

#include "moray/nlp.h"

// ---- min sum a_j (x_j - b_j)^2 / 2 with rows size_i x_i^2 ----

enum { n = 3 };

struct sums {
    double a[n], b[n], size[n], lower[n], upper[n], g_lower[n], g_upper[n], rough;
    int row[n], spin;
    moray_nlp nlp;
};

static bool objective(void *self, const double *x, bool fresh, double *f)
{
    const struct sums *s = self;
    volatile double waste = 0;
    (void)fresh;
    for (int k = 0; k < s->spin; k++)
        waste = waste + sin(k);
    *f = 0;
    for (int j = 0; j < n; j++)
        *f += s->a[j] * (x[j] - s->b[j]) * (x[j] - s->b[j]) / 2;
    return true;
}

static bool gradient(void *self, const double *x, bool fresh, double *slope)
{
    const struct sums *s = self;
    (void)fresh;
    for (int j = 0; j < n; j++)
        slope[j] = s->a[j] * (x[j] - s->b[j]);
    return true;
}

// With a roughness that no slope tells.
static bool constraints(void *self, const double *x, bool fresh, double *g)
{
    const struct sums *s = self;
    (void)fresh;
    for (int i = 0; i < s->nlp.m; i++)
        g[i] = s->size[i] * x[i] * x[i] + s->rough * sin(1e17 * x[i]);
    return true;
}

static bool jacobian(void *self, const double *x, bool fresh, double *values)
{
    const struct sums *s = self;
    (void)fresh;
    for (int i = 0; i < s->nlp.m; i++)
        values[i] = 2 * s->size[i] * x[i];
    return true;
}

static bool hessian(void *self, const double *x, bool fresh, double sigma, const double *lambda, double *values)
{
    const struct sums *s = self;
    (void)x, (void)fresh;
    for (int j = 0; j < n; j++)
        values[j] = sigma * s->a[j] + (j < s->nlp.m ? 2 * s->size[j] * lambda[j] : 0);
    return true;
}

static void sums_new(struct sums *s, int m)
{
    *s = (struct sums){.a = {1, 2, 4},
                       .b = {3, -1, 2},
                       .nlp = {.n = n,
                               .m = m,
                               .x_lower = s->lower,
                               .x_upper = s->upper,
                               .g_lower = s->g_lower,
                               .g_upper = s->g_upper,
                               .nnz_jac = m,
                               .nnz_hess = n,
                               .jac_row = s->row,
                               .jac_col = s->row,
                               .hess_row = s->row,
                               .hess_col = s->row,
                               .self = s,
                               .objective = objective,
                               .gradient = gradient,
                               .constraints = constraints,
                               .jacobian = jacobian,
                               .hessian = hessian}};
    for (int j = 0; j < n; j++) {
        s->row[j] = j;
        s->size[j] = 1;
        s->lower[j] = s->g_lower[j] = -MORAY_INFINITY, s->upper[j] = s->g_upper[j] = MORAY_INFINITY;
    }
}

// The iterations that were told of, and where to stop.
struct record {
    int last, stop;
    moray_progress at[60];
};

static bool keep(void *observer, const moray_progress *progress)
{
    struct record *record = observer;
    record->last = progress->iteration;
    if (progress->iteration < 60)
        record->at[progress->iteration] = *progress;
    return progress->iteration < record->stop;
}

static double x[n], z_lower[n], z_upper[n], g[n], lambda[n];
static moray_iterate at = {x, z_lower, z_upper, g, lambda, 0};

static struct record solve_from(struct sums *s, moray_nlp_settings settings, const double *start, int stop,
                                moray_nlp_info *info)
{
    struct record record = {.stop = stop};
    memcpy(x, start, sizeof x);
    settings.progress = keep, settings.observer = &record;
    CHECK_OK(moray_ipopt_solve(&s->nlp, &settings, &at, info), "solve");
    return record;
}

static const double origin[n] = {1, 1, 1};
static const moray_nlp_settings usual = {.tolerance = 1e-8, .max_iterations = 100};

// ---- Where it is stopped ----

static void test_start(void)
{
    struct sums s;
    moray_nlp_info info;
    sums_new(&s, 0);
    struct record record = solve_from(&s, usual, origin, 0, &info);
    CHECK(info.outcome == MORAY_NLP_INTERRUPTED && info.iterations == 0 && record.last == 0, "stopped at once");
    CHECK(isnan(info.regularisation), "no step, no regularisation: %g", info.regularisation);
    CHECK(memcmp(x, origin, sizeof x) == 0 && at.objective == 8, "where it began");
    record = solve_from(&s, usual, origin, 1, &info);
    CHECK(info.iterations == 1 && info.regularisation == 0, "a step of a convex one needs none: %g",
          info.regularisation);
    CHECK_NEAR(x[1], -1, 1e-12, "which leads to the end");
    s.a[1] = -2, s.lower[1] = -3, s.upper[1] = 5;
    solve_from(&s, usual, origin, 1, &info);
    CHECK(info.iterations == 1 && info.regularisation > 0, "another's does: %g", info.regularisation);
}

// A limit of iterations leaves the best of what was told of, as an interruption does.
static void test_limit(void)
{
    for (int limit = 0; limit < 6; limit++) {
        struct sums s;
        moray_nlp_info info;
        moray_nlp_settings settings = usual;
        double f;
        sums_new(&s, 2);
        s.g_lower[0] = s.g_upper[0] = 7, s.g_upper[1] = 0.3, s.g_lower[1] = 0.2;
        settings.max_iterations = limit;
        const struct record record = solve_from(&s, settings, origin, 1000, &info);
        int best = 1;
        for (int k = 2; k <= limit; k++) {
            const double violation = fmax(record.at[k].infeasibility, 1e-6),
                         least = fmax(record.at[best].infeasibility, 1e-6);
            if (violation < least || (violation == least && record.at[k].objective < record.at[best].objective))
                best = k;
        }
        if (limit == 0) {
            CHECK(info.outcome == MORAY_NLP_ITERATION_LIMIT && memcmp(x, origin, sizeof x) == 0, "none: the start");
            continue;
        }
        objective(&s, x, true, &f);
        CHECK(info.outcome == MORAY_NLP_ITERATION_LIMIT && info.iterations == limit && record.last == limit,
              "a limit of %d: %d", limit, info.iterations);
        CHECK(at.objective == record.at[best].objective, "the best of %d iterations is %d", limit, best);
        CHECK_NEAR(f, at.objective, 1e-12, "and stands in x");
    }
}

static void test_time(void)
{
    struct sums s;
    moray_nlp_info info;
    moray_nlp_settings settings = usual;
    sums_new(&s, 1);
    s.g_lower[0] = s.g_upper[0] = 7;
    s.spin = 400000;
    settings.max_cpu_seconds = 1e-6;
    solve_from(&s, settings, origin, 1000, &info);
    const int iterations = info.iterations;
    CHECK(info.outcome == MORAY_NLP_ITERATION_LIMIT, "no time: %s", moray_nlp_outcome_text(info.outcome));
    settings.max_cpu_seconds = 0;
    solve_from(&s, settings, origin, 1000, &info);
    CHECK(info.outcome == MORAY_NLP_SOLVED && info.iterations > iterations, "no limit: %d iterations, %d with",
          info.iterations, iterations);
}

// ---- Scales ----

// Dual infeasibility at the start, in the solver's scale: the slope of f_scale f by x_scale x.
static void test_scales(void)
{
    const double scale[n] = {10, 0.5, 4};
    for (int k = 0; k < 4; k++) {
        struct sums s;
        moray_nlp_info info;
        sums_new(&s, 0);
        s.nlp.f_scale = k & 1 ? 0.25 : 0;
        s.nlp.x_scale = k & 2 ? scale : NULL;
        const struct record record = solve_from(&s, usual, origin, 1000, &info);
        double largest = 0;
        for (int j = 0; j < n; j++)
            largest = fmax(largest, fabs(s.a[j] * (origin[j] - s.b[j])) / (k & 2 ? scale[j] : 1) * (k & 1 ? 0.25 : 1));
        CHECK_NEAR(record.at[0].dual_infeasibility, largest, 1e-12, "slope at the start");
        CHECK(record.at[0].objective == 8, "the objective is told in the user's unit: %g", record.at[0].objective);
    }
}

// Without scales of the user Ipopt has its own, which bring the largest slope down to 100.
static void test_own_scale(void)
{
    struct sums s;
    moray_nlp_info info;
    sums_new(&s, 0);
    s.a[1] = 1e4;
    const struct record own = solve_from(&s, usual, origin, 0, &info);
    CHECK_NEAR(own.at[0].dual_infeasibility, 100, 1e-9, "slope at the start in Ipopt's scale");
    s.nlp.f_scale = 1;
    const struct record given = solve_from(&s, usual, origin, 0, &info);
    CHECK_NEAR(given.at[0].dual_infeasibility, 2e4, 1e-9, "in the user's");
}

// Rows alone: their multiplier is of the unit of the row, as the solver's first estimate is not.
static void test_row_scales(void)
{
    struct sums s;
    moray_nlp_info info;
    const double scale[n] = {1, 1, 1e-14}, multiplier = -4 * (sqrt(3) - 2) / (2e14 * sqrt(3));
    sums_new(&s, 3);
    s.size[2] = 1e14; // of no number is the square 3: rounding is 0.06 in this unit
    s.g_lower[2] = s.g_upper[2] = 3e14;
    solve_from(&s, usual, origin, 1000, &info);
    CHECK(info.outcome != MORAY_NLP_SOLVED, "unscaled, rounding is above what is asked: %s",
          moray_nlp_outcome_text(info.outcome));
    s.nlp.g_scale = scale;
    solve_from(&s, usual, origin, 1000, &info);
    CHECK(info.outcome == MORAY_NLP_SOLVED, "scaled, it is not: %s", moray_nlp_outcome_text(info.outcome));
    CHECK_NEAR(x[2], sqrt(3), 1e-8, "solved");
    CHECK_NEAR(lambda[2] / multiplier, 1, 1e-6, "with the multiplier in the user's unit");
}

// A row that is rough by 0.1, which is 1e-7 in the solver's scale: below the looser tolerance, not below the tighter.
static void test_looser(void)
{
    struct sums s;
    moray_nlp_info info;
    const double scale[n] = {1, 1e-6, 1};
    sums_new(&s, 3);
    s.size[1] = 1e6, s.rough = 0.1;
    s.g_lower[1] = s.g_upper[1] = 3e6;
    s.nlp.g_scale = scale;
    solve_from(&s, usual, origin, 1000, &info);
    CHECK(info.outcome == MORAY_NLP_ACCEPTABLE, "a rough row: %s", moray_nlp_outcome_text(info.outcome));
}

// ---- Starts ----

static void test_barrier(void)
{
    struct sums s;
    moray_nlp_info info;
    moray_nlp_settings settings = usual;
    sums_new(&s, 0);
    s.upper[0] = 2, s.lower[1] = -0.5;
    const struct record by_default = solve_from(&s, settings, origin, 1000, &info);
    settings.barrier = 0.1;
    const struct record same = solve_from(&s, settings, origin, 1000, &info);
    settings.barrier = 1e-3;
    const struct record other = solve_from(&s, settings, origin, 1000, &info);
    CHECK(by_default.at[1].objective == same.at[1].objective && by_default.last == same.last, "0.1 is the default");
    CHECK(other.at[1].objective < same.at[1].objective, "a lower barrier lets the first step come nearer");
}

// From the solution, at a bound, with its multipliers: there is nothing left to do. From there without them, the start
// is pushed from the bound.
static void test_warm(void)
{
    struct sums s;
    moray_nlp_info info;
    moray_nlp_settings settings = usual;
    sums_new(&s, 1);
    s.upper[0] = 2, s.lower[1] = -0.5, s.g_lower[0] = 1, s.g_upper[0] = 9;
    solve_from(&s, settings, origin, 1000, &info);
    const double f = at.objective, solution[n] = {x[0], x[1], x[2]};
    settings.barrier = 1e-9;
    const struct record cold = solve_from(&s, settings, solution, 1000, &info);
    CHECK(cold.at[0].objective > f + 1e-4, "pushed away: %g above", cold.at[0].objective - f);
    settings.barrier = usual.barrier;
    solve_from(&s, settings, origin, 1000, &info);
    settings.barrier = 1e-9, settings.warm = true;
    const struct record warm = solve_from(&s, settings, solution, 1000, &info);
    CHECK(fabs(warm.at[0].objective - f) < 1e-7, "warm: %g above", warm.at[0].objective - f);
    CHECK(warm.at[0].dual_infeasibility < 1e-6 && warm.last < 3, "with slopes in balance: %g, %d iterations",
          warm.at[0].dual_infeasibility, warm.last);
}

// ---- Options by name ----

static moray_status solve_with(const char *key, const char *value, moray_nlp_info *info)
{
    struct sums s;
    const moray_key_value options[] = {{"tol", "1e-6"}, {key, value}};
    moray_nlp_settings settings = usual;
    sums_new(&s, 1);
    s.g_lower[0] = s.g_upper[0] = 7;
    settings.ipopt = options, settings.n_ipopt = 2;
    memcpy(x, origin, sizeof x);
    return moray_ipopt_solve(&s.nlp, &settings, &at, info);
}

static void test_values(void)
{
    static const struct {
        const char *key, *value, *told;
    } cases[] = {
        {"max_iter", "2147483647", ""},
        {"max_iter", "2147483648", "ipopt.max_iter = 2147483648: not a value that this option of Ipopt allows"},
        {"max_iter", "3 ", "ipopt.max_iter = 3 : not a value that this option of Ipopt allows"},
        {"max_iter", "9999999999999999999999",
         "ipopt.max_iter = 9999999999999999999999: not a value that this option of Ipopt allows"},
        {"print_level", "", "ipopt.print_level = : must be an integer from 0 to 12"},
        {"print_level", "2x", "ipopt.print_level = 2x: must be an integer from 0 to 12"},
        {"print_level", "-2147483649", "ipopt.print_level = -2147483649: must be an integer from 0 to 12"},
        {"print_level", "-2147483648", "print level -2147483648: must lie between 0 and 12"},
        {"print_level", "2147483647", "print level 2147483647: must lie between 0 and 12"},
        {"print_level", "2147483648", "ipopt.print_level = 2147483648: must be an integer from 0 to 12"},
        {"print_level", "0", ""},
        {"print_level", "12", ""},
        {"option_file_name", "x", "ipopt.option_file_name cannot be set: no option file is read"},
        {"sb", "no", "ipopt.sb cannot be set: the banner is never printed"},
        {"linear_solver", "ma27", "ipopt.linear_solver cannot be set: it is a setting of moray's own"},
        {"output_file", "x", "ipopt.output_file cannot be set: print_level writes the log to standard error"},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        moray_nlp_info info;
        const moray_status status = solve_with(cases[k].key, cases[k].value, &info);
        CHECK(status.code == (*cases[k].told ? MORAY_INPUT : MORAY_OK) && strcmp(status.text, cases[k].told) == 0,
              "%s = %s: \"%s\"", cases[k].key, cases[k].value, status.text);
    }
}

int main(void)
{
    test_start();
    test_limit();
    test_time();
    test_scales();
    test_own_scale();
    test_row_scales();
    test_looser();
    test_barrier();
    test_warm();
    fflush(stdout);
    if (!freopen("/dev/null", "w", stderr)) // for the log of level 12
        return 1;
    test_values();
    return tap_done();
}
