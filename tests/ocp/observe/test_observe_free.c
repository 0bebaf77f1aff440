// SPDX-License-Identifier: MIT
//
// Observations in phases of free times, against a search over these, and residuals as events, against what is left of
// the optimum by hand.
#include "observe.h"

// ---- Times that are free: the mesh moves under the data ----

static const double seen_at[] = {1.9, 1.2, 2.4, 1.55, 2.05}, seen[] = {0.3, 0.62, 0.19, 0.5, 0.26};
enum { seen_n = 5 };

static void fade(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = -at->x[0];
}

static double misfit(double t0)
{
    double sum = 0;
    for (int k = 0; k < seen_n; k++)
        sum += pow(exp(t0 - seen_at[k]) - seen[k], 2);
    return sum;
}

// By golden section.
static double best_start(void)
{
    const double golden = (sqrt(5) - 1) / 2;
    double low = 0, high = 1.2;
    while (high - low > 1e-10)
        if (misfit(high - golden * (high - low)) < misfit(low + golden * (high - low)))
            high = low + golden * (high - low);
        else
            low = high - golden * (high - low);
    return (low + high) / 2;
}

// x' = -x from 1 at t0 to 0.1 at tf: both times follow from data that fall into other intervals than at the guess.
static void test_free_times(const char *scheme)
{
    const moray_phase_spec phase = {
        .nx = 1,
        .continuous = fade,
        .t0 = moray_between(-5, 1.2),
        .tf = moray_between(0, 60),
        .x0 = MORAY_BOUNDS(moray_fixed(1)),
        .xf = MORAY_BOUNDS(moray_fixed(0.1)),
        .observed = {.n = seen_n, .ny = 1, .time = seen_at, .value = seen, .observe = see_state}};
    moray_ocp *ocp;
    moray_certificate certificate;
    moray_settings settings = moray_settings_default();
    settings.scheme = scheme, settings.max_refinements = 12, settings.mesh_tolerance = 1e-8;
    CHECK_OK(moray_ocp_new(&ocp, &(moray_ocp_spec){.phases = 1, .phase = &phase, .endpoint = nothing}), "free times");
    moray_solution *solution = solve(ocp, &settings, NULL);
    if (!solution)
        return;
    double t0, tf;
    moray_solution_times(solution, 0, &t0, &tf);
    CHECK(fabs(t0 - best_start()) < 1e-6, "%s: start %.9g, by search %.9g", scheme, t0, best_start());
    CHECK(fabs(tf - best_start() - log(10)) < 1e-6, "%s: end %.9g", scheme, tf);
    CHECK(fabs(moray_solution_objective(solution) - misfit(best_start())) < 1e-8, "%s: sum %.9g, by search %.9g",
          scheme, moray_solution_objective(solution), misfit(best_start()));
    CHECK_OK(moray_certify(solution, &rk4, &certificate), "certificate");
    CHECK(certificate.pass, "%s: passes %s", scheme, certificate.why);
    moray_residual residual[seen_n];
    moray_solution_residuals(solution, residual);
    double worst = 0;
    for (int k = 0; k < seen_n; k++) {
        double x;
        moray_solution_at(solution, 0, seen_at[k], &x, NULL);
        worst = tap_worse(worst, fabs(residual[k].predicted - x));
    }
    CHECK(worst < 1e-9, "%s: what is seen is on the trajectory: %.1e", scheme, worst);
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

// The start is fixed, the end free and known only by the state there: x = 0.1 exp(tf - t), least squares in exp(tf).
static void test_free_end(void)
{
    double seen_by_model = 0, model_by_model = 0, t0, tf;
    const moray_phase_spec phase = {
        .nx = 1,
        .continuous = fade,
        .t0 = moray_fixed(1),
        .tf = moray_between(2.5, 60),
        .xf = MORAY_BOUNDS(moray_fixed(0.1)),
        .observed = {.n = seen_n, .ny = 1, .time = seen_at, .value = seen, .observe = see_state}};
    moray_ocp *ocp;
    const moray_settings settings = moray_settings_default();
    for (int k = 0; k < seen_n; k++) {
        seen_by_model += seen[k] * exp(-seen_at[k]) / 10;
        model_by_model += exp(-2 * seen_at[k]) / 100;
    }
    CHECK_OK(moray_ocp_new(&ocp, &(moray_ocp_spec){.phases = 1, .phase = &phase, .endpoint = nothing}), "a free end");
    moray_solution *solution = solve(ocp, &settings, NULL);
    if (!solution)
        return;
    moray_solution_times(solution, 0, &t0, &tf);
    CHECK_NEAR(tf, log(seen_by_model / model_by_model), 1e-6, "the end that fits the data best");
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

// A file tells in which intervals data are.
static void test_kept(void)
{
    const moray_phase_spec phase = {
        .nx = 1,
        .continuous = fade,
        .t0 = moray_between(-5, 1.2),
        .tf = moray_fixed(4),
        .x0 = MORAY_BOUNDS(moray_fixed(1)),
        .observed = {.n = seen_n, .ny = 1, .time = seen_at, .value = seen, .observe = see_state}};
    char path[] = "/tmp/moray_solution_XXXXXX";
    moray_ocp *ocp;
    moray_solution *loaded = NULL;
    moray_certificate certificate;
    const moray_settings settings = {.scheme = "radau3",
                                     .intervals = 30,
                                     .tolerance = 1e-10,
                                     .mesh_tolerance = 1e-6,
                                     .max_iterations = 100,
                                     .barrier = 0.1,
                                     .own_scaling = true};
    close(mkstemp(path));
    CHECK_OK(moray_ocp_new(&ocp, &(moray_ocp_spec){.phases = 1, .phase = &phase, .endpoint = nothing}), "free start");
    moray_solution *solution = solve(ocp, &settings, NULL);
    CHECK_OK(moray_solution_save(solution, path), "kept");
    CHECK_OK(moray_solution_load(&loaded, ocp, &settings, path), "read");
    CHECK_OK(moray_certify(loaded, &rk4, &certificate), "certificate");
    CHECK(certificate.pass && moray_solution_objective(loaded) == moray_solution_objective(solution), "as it was: %s",
          certificate.why);
    moray_solution_free(loaded);
    moray_solution_free(solution);
    moray_ocp_free(ocp);
    unlink(path);
}

// ---- Residuals as events ----

static void level(const moray_node *at, moray_rates *out, const void *data)
{
    (void)at, (void)data;
    out->f[0] = 0;
}

// A level of data 0, 0, 0, 10 within 6 of each: 4, against a bound that would give 12 for each unit.
static void test_bounded_residuals(void)
{
    static const double time[] = {0, 0.25, 0.6, 1}, value[] = {0, 0, 0, 10};
    const struct task task = {level,
                              {.n = 4,
                               .ny = 1,
                               .time = time,
                               .value = value,
                               .observe = see_state,
                               .residual = MORAY_BOUNDS(moray_between(-6, 6))},
                              1,
                              1,
                              moray_free()};
    moray_ocp *ocp;
    moray_certificate certificate;
    const moray_settings settings = moray_settings_default();
    CHECK_OK(problem(&ocp, &task), "a level");
    moray_solution *solution = solve(ocp, &settings, NULL);
    const double *multiplier = moray_solution_event_multipliers(solution);
    double x;
    moray_solution_at(solution, 0, 0.5, &x, NULL);
    CHECK_NEAR(x, 4, 1e-6, "as near to the most as it must be");
    CHECK(fabs(multiplier[3] + 12) < 1e-4 && fabs(multiplier[0]) < 1e-4, "which costs 12 a unit: %g", multiplier[3]);
    test_map(solution->transcription->endpoint);
    CHECK_OK(moray_certify(solution, &rk4, &certificate), "certificate");
    CHECK(certificate.pass, "passes %s", certificate.why);
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

static void steepest(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = -at->s[0];
}

// The steepest line through 0 whose weighted sum of squares is 1 at most.
static void test_bounded_sum(void)
{
    static const double time[] = {0.5, 1, 2}, value[] = {0.6, 1.1, 1.8}, weight[] = {2};
    double tt = 0, ty = 0, least = 0;
    const moray_phase_spec phase = {.nx = 1,
                                    .continuous = grow,
                                    .tf = moray_fixed(2),
                                    .x0 = MORAY_BOUNDS(moray_fixed(0)),
                                    .observed = {.n = 3,
                                                 .ny = 1,
                                                 .time = time,
                                                 .value = value,
                                                 .weight = weight,
                                                 .observe = see_state,
                                                 .sum = moray_at_most(1),
                                                 .events_only = true}};
    moray_ocp *ocp;
    moray_fit fit;
    const moray_settings settings = moray_settings_default();
    for (int k = 0; k < 3; k++)
        tt += 2 * time[k] * time[k], ty += 2 * time[k] * value[k];
    for (int k = 0; k < 3; k++)
        least += 2 * pow(ty / tt * time[k] - value[k], 2);
    CHECK_OK(moray_ocp_new(&ocp, &(moray_ocp_spec){.phases = 1, .phase = &phase, .ns = 1, .endpoint = steepest}),
             "the steepest line");
    moray_solution *solution = solve(ocp, &settings, NULL);
    CHECK_NEAR(moray_solution_parameters(solution)[0], ty / tt + sqrt((1 - least) / tt), 1e-6, "that the data allow");
    CHECK_NEAR(moray_solution_objective(solution), -moray_solution_parameters(solution)[0], 1e-12,
               "and nothing else in the objective");
    test_map(solution->transcription->endpoint);
    refused(moray_fit_new(&fit, solution, false), MORAY_INPUT, "no fit");
    moray_fit_free(&fit);
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

// ---- What the data are too large to tell ----

static void see_both(const moray_node *at, moray_num *y, const void *data)
{
    y[0] = *(const double *)data * at->x[0];
    y[1] = at->s[0];
}

// A channel of constant readings far from a constant prediction, which nothing moves, beside one that reads s = 1.
// Where that is less than 1e-9 of all squares, observed or predicted, s is open; else its error is 1 / sqrt(weight n).
static void test_size_of_data(double observed, double predicted, bool open)
{
    enum { n = 4 };
    static const double weight[] = {0.25, 9};
    double time[n], value[2 * n];
    for (int k = 0; k < n; k++)
        time[k] = 0.2 * (k + 1), value[2 * k] = observed, value[2 * k + 1] = 1;
    const moray_phase_spec phase = {
        .nx = 1,
        .continuous = level,
        .tf = moray_fixed(1),
        .x0 = MORAY_BOUNDS(moray_fixed(1)),
        .observed = {.n = n, .ny = 2, .time = time, .value = value, .weight = weight, .observe = see_both}};
    moray_ocp *ocp;
    moray_fit fit;
    const moray_settings settings = moray_settings_default();
    CHECK_OK(
        moray_ocp_new(
            &ocp, &(moray_ocp_spec){.phases = 1, .phase = &phase, .ns = 1, .endpoint = nothing, .data = &predicted}),
        "two channels");
    moray_solution *solution = solve(ocp, &settings, NULL);
    CHECK_OK(moray_fit_new(&fit, solution, true), "fit");
    CHECK(fit.undetermined == open && fit.observations == 2 * n && fabs(fit.value[0] - 1) < 1e-3,
          "%g observed, %g predicted: %d open, s = %.9g", observed, predicted, fit.undetermined, fit.value[0]);
    if (!open)
        CHECK_NEAR(fit.error[0], 1 / sqrt(9 * n), 2e-3 * fit.error[0], "as its channel tells it");
    CHECK_NEAR(fit.sum, 0.25 * n * pow(observed - predicted, 2), 1e-9 * fit.sum, "sum of squares");
    moray_fit_free(&fit);
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

int main(void)
{
    const double most = sqrt(9 / 0.25 / 1e-9); // of the constant channel, that leaves s closed
    for (int k = 0; k < 2; k++) {
        const double size = (k ? 1.05 : 0.95) * most;
        test_size_of_data(0, size, k);
        test_size_of_data(size, 0, k);
        test_size_of_data(-size, 0, k);
        test_size_of_data(size, -0.5 * size, k);
    }
    test_free_times("gauss3");
    test_free_times("radau3");
    test_free_times("hermite-simpson");
    test_free_end();
    test_kept();
    test_bounded_residuals();
    test_bounded_sum();
    return tap_done();
}
