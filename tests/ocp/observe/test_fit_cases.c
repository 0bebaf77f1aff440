// SPDX-License-Identifier: MIT
//
// Fits at the limits: as many unknowns as data, directions that the data leave open and what their parameters are
// called, and when a bound or a constraint counts as active, of multipliers and distances put there by hand.
#include "observe.h"

#include "ocp/certificate/witness.h"

static const double times[] = {0.25, 1, 1.5, 2.5}, values[] = {1.2, 2.3, 2.9, 3.7};

static moray_observations data_of(int n, moray_observe_fn *see, int ny)
{
    return (moray_observations){.n = n, .ny = ny, .time = times, .value = values, .observe = see};
}

// ---- As many unknowns as data ----

static void test_no_freedom(void)
{
    for (int n = 1; n <= 3; n++) { // a line, of start and slope
        const struct task task = {grow, data_of(n, see_state, 1), 1, 3, moray_free()};
        const moray_settings settings = moray_settings_default();
        moray_ocp *ocp;
        moray_fit fit;
        CHECK_OK(problem(&ocp, &task), "a line");
        moray_solution *solution = solve(ocp, &settings, NULL);
        CHECK_OK(moray_fit_new(&fit, solution, false), "fit");
        CHECK(fit.observations == n && fit.freedom == 2, "%d data, %d free directions", fit.observations, fit.freedom);
        CHECK(!!isfinite(fit.variance) == (n == 3) && !!isnan(fit.variance) == (n < 3), "%d data: variance %g", n,
              fit.variance);
        CHECK(n == 1 ? isinf(fit.error[0]) && fit.undetermined == 1 && strcmp(fit.names, "slope") == 0
                     : !!isnan(fit.error[0]) == (n == 2) && fit.undetermined == 0 && strcmp(fit.names, "") == 0,
              "%d data: error %g, open \"%s\"", n, fit.error[0], fit.names);
        CHECK(n == 3 ||
                  (!!isnan(fit.lower[0]) == (n == 2) && !!isnan(fit.upper[0]) == (n == 2) && isnan(fit.covariance[0])),
              "%d data: within %g and %g", n, fit.lower[0], fit.upper[0]);
        moray_fit_free(&fit);
        CHECK_OK(moray_fit_new(&fit, solution, true), "with noise that is known");
        CHECK(fit.variance == 1 && !!isinf(fit.error[0]) == (n == 1), "%d data: error %g", n, fit.error[0]);
        if (n == 2)
            CHECK_NEAR(fit.error[0], sqrt(2) / 0.75, 1e-6, "of the slope between two points");
        moray_fit_free(&fit);
        CHECK(fit.value == NULL && fit.ns == 0, "freed");
        moray_solution_free(solution);
        moray_ocp_free(ocp);
    }
}

// ---- What is open ----

enum { most_parameters = 9 };
static const double of_slope[most_parameters] = {0, 1, 0, -2, 0.5, 0, 1, 1, 1};

static void grow_by_many(const moray_node *at, moray_rates *out, const void *data)
{
    out->f[0] = 0;
    for (int i = 0; i < *(const int *)data; i++)
        out->f[0] += of_slope[i] * at->s[i];
}

// s0 and s2 by channels of their own.
static void see_some(const moray_node *at, moray_num *y, const void *data)
{
    (void)data;
    y[0] = at->x[0];
    y[1] = at->s[0] + at->s[2];
    y[2] = at->s[0] - 3 * at->s[2];
}

static moray_fit fit_many(int ns, const char *const *names, moray_observe_fn *see, int ny)
{
    static const double value[] = {1.2, 1, 2, 2.3, 1.5, 2.5, 2.9, 1.25, NAN, 3.7, 1, 2};
    const moray_phase_spec phase = {.nx = 1,
                                    .continuous = grow_by_many,
                                    .tf = moray_fixed(3),
                                    .observed = {.n = 4, .ny = ny, .time = times, .value = value, .observe = see}};
    const moray_settings settings = moray_settings_default();
    moray_ocp *ocp;
    moray_fit fit;
    CHECK_OK(
        moray_ocp_new(&ocp,
                      &(moray_ocp_spec){
                          .phases = 1, .phase = &phase, .ns = ns, .s_names = names, .endpoint = nothing, .data = &ns}),
        "problem");
    moray_solution *solution = solve(ocp, &settings, NULL);
    CHECK_OK(moray_fit_new(&fit, solution, false), "fit");
    moray_solution_free(solution);
    moray_ocp_free(ocp);
    return fit;
}

static void test_open(void)
{
    moray_fit fit = fit_many(4, NULL, see_some, 3);
    CHECK(fit.undetermined == 2 && strcmp(fit.names, "s[1], s[3]") == 0, "%d open: %s", fit.undetermined, fit.names);
    for (int i = 0; i < 4; i++) {
        CHECK(!!isfinite(fit.error[i]) == !(i % 2) && (fit.lower[i] == -INFINITY) == i % 2 &&
                  (fit.upper[i] == INFINITY) == i % 2,
              "s[%d] in %g and %g", i, fit.lower[i], fit.upper[i]);
        for (int j = 0; j < 4; j++)
            CHECK(!!isnan(fit.covariance[4 * i + j]) == (i % 2 || j % 2), "covariance %d, %d: %g", i, j,
                  fit.covariance[4 * i + j]);
    }
    CHECK_NEAR(fit.covariance[2], fit.covariance[8], 1e-9, "symmetric");
    moray_fit_free(&fit);
}

// Names that are longer together than their text end where it does.
static void test_names(void)
{
    enum { n = 9, length = 63 };
    char names[n][length + 1], all[n * (length + 2) + 1] = "";
    const char *name[n];
    for (int i = 0; i < n; i++) {
        memset(names[i], 'a' + i, length);
        names[i][length] = 0;
        name[i] = names[i];
        if (i != 0 && i != 2)
            snprintf(all + strlen(all), sizeof all - strlen(all), "%s%s", *all ? ", " : "", name[i]);
    }
    for (int ns = 4; ns <= n; ns += n - 4) {
        moray_fit fit = fit_many(ns, name, see_some, 3);
        const size_t want = ns == n ? sizeof fit.names - 1 : 2 * length + 2;
        CHECK(fit.undetermined == (ns == n ? 7 : 2) && strlen(fit.names) == want && memcmp(fit.names, all, want) == 0,
              "%d are open: %s", fit.undetermined, fit.names);
        moray_fit_free(&fit);
    }
}

// ---- What is active ----

static void ends(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = 0;
    out->e[0] = at->s[0] / 50;
    out->e[1] = 20 * at->s[1];
    out->e[2] = at->s[0];
}

static void see_line(const moray_node *at, moray_num *y, const void *data)
{
    (void)data;
    y[0] = at->x[0] + 300 * at->s[1] * at->t * at->t;
}

static moray_solution *solve_free(moray_ocp **ocp)
{
    const moray_phase_spec phase = {
        .nx = 1, .continuous = grow, .tf = moray_fixed(3), .observed = data_of(4, see_line, 1)};
    const moray_bounds within = moray_between(-90, 70);
    const moray_settings settings = moray_settings_default();
    CHECK_OK(moray_ocp_new(ocp, &(moray_ocp_spec){.phases = 1,
                                                  .phase = &phase,
                                                  .ns = 2,
                                                  .ne = 3,
                                                  .e = MORAY_BOUNDS(within, within, within),
                                                  .endpoint = ends}),
             "a parabola");
    return solve(*ocp, &settings, NULL);
}

static int freedom(const moray_solution *solution)
{
    moray_fit fit;
    CHECK_OK(moray_fit_new(&fit, solution, false), "fit");
    const int found = fit.freedom;
    moray_fit_free(&fit);
    return found;
}

// A bound at `distance`, with `multiplier`, in the limits of what is active.
static void check_bound(moray_solution *solution, int column, bool upper, double multiplier, double distance,
                        const double *most, int expected)
{
    const moray_nlp *nlp = &solution->transcription->nlp;
    double *bound = solution->transcription->bounds + (upper ? nlp->n : 0) + column, kept = *bound;
    double *z = (upper ? solution->iterate.z_upper : solution->iterate.z_lower) + column, kept_z = *z;
    *z = multiplier * most[0];
    *bound = solution->iterate.x[column] + (upper ? 1 : -1) * distance * most[1];
    CHECK(freedom(solution) == expected, "bound %d of column %d, %g of the multiplier, %g of the distance: %s", upper,
          column, multiplier, distance, expected == 3 ? "idle" : "active");
    *bound = kept, *z = kept_z;
}

static void test_active(void)
{
    moray_ocp *ocp;
    struct witness w;
    moray_solution *solution = solve_free(&ocp);
    const moray_nlp *nlp = &solution->transcription->nlp;
    double *column = calloc((size_t)(nlp->n + nlp->m), sizeof *column), *row = column + nlp->n;
    CHECK_OK(moray_witness_of_sizes(&w, solution), "sizes");
    moray_witness_columns(&w, column);
    moray_witness_rows(&w, row);
    const double objective = moray_witness_objective(&w);
    moray_witness_free(&w);
    CHECK(freedom(solution) == 3, "no bound is active");
    for (int i = 0; i < 2; i++) {
        const int j = solution->transcription->layout.s + i;
        const double most[] = {1e-6 * objective / column[j], 1e-6 * column[j]};
        for (int upper = 0; upper < 2; upper++) {
            check_bound(solution, j, upper, 1.5, 0.7, most, 2);
            check_bound(solution, j, upper, 0.7, 0.7, most, 3);
            check_bound(solution, j, upper, 1.5, 1.5, most, 3);
        }
    }
    for (int i = 0; i < 3; i++) {
        double *lambda = solution->iterate.lambda + solution->transcription->layout.events + i;
        const double most = 1e-6 * objective / row[lambda - solution->iterate.lambda], kept = *lambda;
        for (int part = -2; part <= 2; part++) {
            *lambda = 0.7 * part * most;
            CHECK(freedom(solution) == (abs(part) == 2 ? 2 : 3), "event %d with %g of the multiplier that is active", i,
                  0.7 * part);
        }
        *lambda = kept;
    }
    free(column);
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

// Data of nothing, met by nothing, have no size; a slope is known as well as if they had.
static void test_zeros(void)
{
    static const double zeros[] = {0, 0, 0, 0};
    const struct task task = {
        grow, {.n = 4, .ny = 1, .time = times, .value = zeros, .observe = see_state}, 1, 3, moray_free()};
    const moray_settings settings = moray_settings_default();
    double mean = 0, squares = 0;
    moray_ocp *ocp;
    moray_fit fit;
    for (int k = 0; k < 4; k++)
        mean += times[k] / 4;
    for (int k = 0; k < 4; k++)
        squares += (times[k] - mean) * (times[k] - mean);
    CHECK_OK(problem(&ocp, &task), "a line");
    moray_solution *solution = solve(ocp, &settings, NULL);
    CHECK_OK(moray_fit_new(&fit, solution, true), "fit");
    CHECK(fit.sum == 0 && fit.value[0] == 0 && fit.undetermined == 0, "nothing is left: %g", fit.sum);
    CHECK_NEAR(fit.error[0], 1 / sqrt(squares), 1e-6, "standard error of its slope");
    moray_fit_free(&fit);
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

// ---- What is none ----

static void test_no_data(void)
{
    const moray_phase_spec phase = {.nx = 1, .continuous = grow, .tf = moray_fixed(1)};
    const moray_settings settings = moray_settings_default();
    moray_ocp *ocp;
    moray_fit fit;
    CHECK_OK(moray_ocp_new(
                 &ocp, &(moray_ocp_spec){.name = "blind", .phases = 1, .phase = &phase, .ns = 1, .endpoint = nothing}),
             "without data");
    moray_solution *solution = solve(ocp, &settings, NULL);
    const moray_status status = moray_fit_new(&fit, solution, false);
    CHECK(status.code == MORAY_INPUT &&
              strcmp(status.text, "nothing that is observed in blind is in its objective") == 0,
          "told: %s", status.text);
    CHECK(moray_solution_residuals(solution, NULL) == 0, "no residuals");
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

static void test_none(void)
{
    moray_ocp *ocp;
    moray_fit fit;
    moray_solution *solution = solve_free(&ocp);
    solution->info.outcome = MORAY_NLP_INTERRUPTED;
    const moray_status status = moray_fit_new(&fit, solution, false);
    CHECK(status.code == MORAY_NOT_SOLVED &&
              strcmp(status.text, "confidence is that of an optimum, and this is none: interrupted") == 0,
          "told: %s", status.text);
    CHECK(fit.ns == 2 && fit.value == NULL, "nothing to free");
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

int main(void)
{
    test_no_freedom();
    test_open();
    test_names();
    test_active();
    test_zeros();
    test_no_data();
    test_none();
    return tap_done();
}
