// SPDX-License-Identifier: MIT
//
// Observations: straight lines against linear regression in closed form, a decay against many noisy repetitions of it,
// derivatives against differences, and what is refused.
#include "observe.h"

static void decay(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = -at->s[0] * at->x[0];
}

static void decay_twice(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = -(at->s[0] + at->s[1]) * at->x[0];
}

// ---- Lines ---------------------------------------------------------------------------------------------------------

enum { times = 7 };
static const double line_time[times] = {3, 0.1, 0.7, 1.3, 1.3, 2.2, 2.9}; // in no order, one twice
static const double line_value[times] = {6.8, 1.3, 2.1, 3.9, 3.5, NAN, 7.1};

// Of the values that are there: slope, its standard error, and the sum of squares about the line.
static void regress(double *slope, double *error, double *sum)
{
    double n = 0, t = 0, y = 0, tt = 0, ty = 0;
    for (int k = 0; k < times; k++)
        if (!isnan(line_value[k]))
            n++, t += line_time[k], y += line_value[k];
    t /= n, y /= n;
    for (int k = 0; k < times; k++)
        if (!isnan(line_value[k])) {
            tt += pow(line_time[k] - t, 2);
            ty += (line_time[k] - t) * (line_value[k] - y);
        }
    *slope = ty / tt;
    *sum = 0;
    for (int k = 0; k < times; k++)
        if (!isnan(line_value[k]))
            *sum += pow(line_value[k] - y - *slope * (line_time[k] - t), 2);
    *error = sqrt(*sum / (n - 2) / tt);
}

static void test_line(const char *scheme, bool gauss_newton)
{
    const struct task task = {
        grow, {.n = times, .ny = 1, .time = line_time, .value = line_value, .observe = see_state}, 1, 3, moray_free()};
    double slope, error, sum;
    moray_ocp *ocp;
    moray_fit fit;
    moray_certificate certificate;
    moray_settings settings = moray_settings_default();
    settings.scheme = scheme, settings.intervals = 5, settings.gauss_newton = gauss_newton;
    regress(&slope, &error, &sum);
    CHECK_OK(problem(&ocp, &task), "a line");
    moray_solution *solution = solve(ocp, &settings, NULL);
    CHECK_OK(moray_fit_new(&fit, solution, false), "fit");
    CHECK_NEAR(fit.value[0], slope, 1e-9, "slope as by regression");
    CHECK_NEAR(fit.error[0], error, 1e-7 * error, "its standard error");
    CHECK_NEAR(fit.upper[0] - slope, 2.7764451 * error, 1e-6, "its interval, with Student's factor for 4 degrees");
    CHECK_NEAR(fit.sum, sum, 1e-9, "sum of squares");
    CHECK_NEAR(moray_solution_objective(solution), sum, 1e-9, "which is the objective");
    CHECK(fit.observations == 6 && fit.freedom == 2 && fit.undetermined == 0, "%d observations, %d free, %d open",
          fit.observations, fit.freedom, fit.undetermined);
    CHECK_OK(moray_certify(solution, &rk4, &certificate), "certificate");
    CHECK(certificate.pass, "%s: passes %s", scheme, certificate.why);
    moray_fit_free(&fit);
    CHECK_OK(moray_fit_new(&fit, solution, true), "fit with known noise");
    CHECK_NEAR(fit.error[0], error / sqrt(sum / 4), 1e-7, "standard error where the weights are known");
    moray_fit_free(&fit);
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

// ---- With a duration, with a mesh of the user's ----

static bool has_node(const moray_solution *solution, double t)
{
    double time[100];
    const int nodes = moray_solution_nodes(solution, 0, NULL, NULL);
    if (nodes > 100)
        return false;
    moray_solution_nodes(solution, 0, time, NULL);
    for (int n = 0; n < nodes; n++)
        if (fabs(time[n] - t) < 1e-12)
            return true;
    return false;
}

// The line, whose end comes of the duration; an observation stands near an edge, which it moves unless that is given.
static void test_given_mesh(bool given)
{
    static const double mesh[] = {0, 1.4 / 3, 1};
    double slope, error, sum;
    moray_ocp *ocp;
    const moray_settings settings = moray_settings_default();
    const moray_phase_spec phase = {
        .nx = 1,
        .continuous = grow,
        .tf = moray_between(1, 10),
        .duration = moray_fixed(3),
        .intervals = 2,
        .mesh = given ? mesh : NULL,
        .observed = {.n = times, .ny = 1, .time = line_time, .value = line_value, .observe = see_state}};
    regress(&slope, &error, &sum);
    CHECK_OK(moray_ocp_new(&ocp, &(moray_ocp_spec){.phases = 1, .phase = &phase, .ns = 1, .endpoint = nothing}),
             "an end by its duration");
    moray_solution *solution = solve(ocp, &settings, NULL);
    if (!solution)
        return;
    CHECK_NEAR(moray_solution_parameters(solution)[0], slope, 1e-9, "slope as by regression");
    CHECK_NEAR(moray_solution_objective(solution), sum, 1e-9, "sum of squares");
    CHECK(has_node(solution, 1.3) && has_node(solution, 2.2), "edges at the times");
    CHECK(has_node(solution, given ? 1.4 : 1.5) == given, "%s", given ? "and the user's stays" : "another one moves");
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

// Outliers pull with the threshold only: sum over the others of (x - y) = threshold.
static void test_huber(void)
{
    static const double time[] = {0, 0.25, 0.6, 1}, value[] = {0, 1, 2, 100};
    struct task task = {
        grow,
        {.n = 4, .ny = 1, .time = time, .value = value, .observe = see_state, .loss = MORAY_HUBER, .threshold = 1.5},
        1,
        1,
        moray_free()};
    moray_ocp *ocp;
    double x;
    const moray_settings settings = moray_settings_default();
    const moray_bounds still[] = {moray_fixed(0)};
    const moray_phase_spec phase = {.nx = 1, .continuous = grow, .tf = moray_fixed(1), .observed = task.data};
    CHECK_OK(
        moray_ocp_new(
            &ocp,
            &(moray_ocp_spec){.phases = 1, .phase = &phase, .ns = 1, .s = MORAY_BOUNDS_OF(still), .endpoint = nothing}),
        "a level");
    moray_solution *solution = solve(ocp, &settings, NULL);
    moray_solution_at(solution, 0, 0.5, &x, NULL);
    CHECK_NEAR(x, 1.5, 1e-6, "a level with an outlier, by Huber's loss");
    moray_solution_free(solution);
    moray_ocp_free(ocp);
    task.data.threshold = 0;
    refused(problem(&ocp, &task), MORAY_INPUT, "a threshold of 0");
}

// ---- What the data do not determine ----

static void test_undetermined(void)
{
    static const double time[] = {0.2, 0.5, 1, 1.7}, value[] = {0.83, 0.59, 0.38, 0.17};
    struct task task = {
        decay_twice, {.n = 4, .ny = 1, .time = time, .value = value, .observe = see_state}, 2, 2, moray_fixed(1)};
    moray_ocp *ocp;
    moray_fit fit;
    const moray_settings settings = moray_settings_default();
    const double s[] = {0.7, 0.4};
    CHECK_OK(problem(&ocp, &task), "two rates of which the sum counts");
    moray_solution *solution = solve(ocp, &settings, s);
    CHECK_OK(moray_fit_new(&fit, solution, false), "fit");
    CHECK(fit.undetermined == 2 && strcmp(fit.names, "slope, twin") == 0 && isinf(fit.error[0]) &&
              isnan(fit.covariance[1]),
          "the data do not determine: %s", fit.names);
    moray_fit_free(&fit);
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

// ---- Noise ----

static void test_noise(void)
{
    enum { n = 12 };
    const int repetitions = tap_thorough() ? 1000 : 250;
    const double rate = 0.8, sigma = 0.03;
    double time[n], value[n], sum = 0, squares = 0, variance = 0;
    int inside = 0;
    for (int r = 0; r < repetitions; r++) {
        for (int k = 0; k < n; k++) {
            time[k] = 3.0 * k / (n - 1);
            value[k] = exp(-rate * time[k]) + sigma * noise();
        }
        const struct task task = {
            decay, {.n = n, .ny = 1, .time = time, .value = value, .observe = see_state}, 1, 3, moray_fixed(1)};
        moray_settings settings = moray_settings_default();
        moray_ocp *ocp;
        moray_solution *solution = NULL;
        moray_fit fit;
        settings.scheme = "gauss3", settings.intervals = 4;
        if (moray_failed(problem(&ocp, &task)) ||
            moray_failed(moray_solve(ocp, &settings, &(moray_guess){.s = &rate}, &solution)) ||
            moray_failed(moray_fit_new(&fit, solution, false))) {
            CHECK(false, "repetition %d", r);
            return;
        }
        sum += fit.value[0], squares += fit.value[0] * fit.value[0], variance += fit.covariance[0] / repetitions;
        inside += fit.lower[0] < rate && rate < fit.upper[0];
        moray_fit_free(&fit);
        moray_solution_free(solution);
        moray_ocp_free(ocp);
    }
    const double mean = sum / repetitions, seen = squares / repetitions - mean * mean;
    CHECK(fabs(seen / variance - 1) < 5 * sqrt(2.0 / repetitions),
          "variance of a rate over %d repetitions: %g, fits say %g", repetitions, seen, variance);
    CHECK(fabs((double)inside / repetitions - 0.95) < 4 * sqrt(0.95 * 0.05 / repetitions),
          "the rate is within its interval in %d of %d repetitions", inside, repetitions);
}

// ---- Derivatives ----

static void steer(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = at->x[1] * at->s[0];
    out->f[1] = at->u[0] - csin(at->x[0]);
    out->g[0] = at->u[0] * at->u[0];
}

static void see_all(const moray_node *at, moray_num *y, const void *data)
{
    const bool controls = *(const bool *)data; // where one is observed it spikes there: no problem to solve
    y[0] = at->x[0] * at->x[1] + at->s[1] * at->t;
    y[1] = cexp(-at->x[1]) * at->s[0] + (controls ? at->u[0] * at->u[0] : 0);
    y[2] = at->s[0] * at->s[1];
}

static void link_phases(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = 0.1 * (at->phase[0].q[0] + at->phase[1].q[0]) + 0.1 * at->s[0] * at->s[1] * at->phase[1].xf[0];
    out->e[0] = at->phase[1].x0[0] - at->phase[0].xf[0];
    out->e[1] = at->phase[1].x0[1] - at->phase[0].xf[1];
}

static moray_status two_phases(moray_ocp **ocp, moray_loss loss, bool controls)
{
    static const bool flags[] = {false, true};
    const moray_bounds box[] = {moray_between(-3, 3), moray_between(-3, 3)};
    static const double time[2][3] = {{0.9, 0.33, 0}, {1, 1.6, 2}},
                        value[9] = {0.3, 1.1, 0.4, 0.2, NAN, 0.5, 0.1, 0.9, 3}, weight[] = {2, 0.5, 1.5};
    moray_phase_spec phase[2];
    for (int p = 0; p < 2; p++)
        phase[p] = (moray_phase_spec){.nx = 2,
                                      .nu = 1,
                                      .nq = 1,
                                      .continuous = steer,
                                      .x = MORAY_BOUNDS_OF(box),
                                      .t0 = moray_fixed(p),
                                      .tf = moray_fixed(p + 1),
                                      .observed = {.n = 3,
                                                   .ny = 3,
                                                   .time = time[p],
                                                   .value = value,
                                                   .weight = weight,
                                                   .observe = see_all,
                                                   .loss = loss,
                                                   .threshold = 0.4}};
    return moray_ocp_new(ocp, &(moray_ocp_spec){.phases = 2,
                                                .phase = phase,
                                                .ns = 2,
                                                .ne = 2,
                                                .s = MORAY_BOUNDS(moray_between(0.2, 2), moray_between(-1, 1)),
                                                .e = MORAY_BOUNDS(moray_fixed(0), moray_fixed(0)),
                                                .endpoint = link_phases,
                                                .data = &flags[controls]});
}

// The map of all that is added, at random points.
static void test_controls(moray_loss loss)
{
    moray_ocp *ocp;
    struct transcription *t;
    struct mesh mesh[2];
    CHECK_OK(two_phases(&ocp, loss, true), "controls observed, too");
    for (int p = 0; p < 2; p++)
        CHECK_OK(moray_mesh_uniform(&mesh[p], 4, (struct method){MORAY_LOBATTO, 3}), "mesh");
    CHECK_OK(moray_transcription_new(&t, ocp, mesh), "transcription");
    test_map(t->endpoint);
    moray_transcription_free(t);
    moray_mesh_free(&mesh[0]);
    moray_mesh_free(&mesh[1]);
    moray_ocp_free(ocp);
}

static void test_derivatives(moray_loss loss)
{
    moray_ocp *ocp;
    moray_ocp_derivative_report report;
    moray_certificate certificate;
    moray_settings settings = moray_settings_default();
    settings.intervals = 8, settings.max_refinements = 8, settings.scheme = "lobatto4";
    test_controls(loss);
    CHECK_OK(two_phases(&ocp, loss, false), "two phases with data");
    CHECK_OK(moray_ocp_check_derivatives(ocp, &report), "check");
    CHECK(report.jacobian_error < 1e-7 && report.hessian_error < 1e-5, "check of what is observed: %.1e, %.1e",
          report.jacobian_error, report.hessian_error);
    moray_solution *solution = solve(ocp, &settings, NULL);
    if (!solution)
        return;
    test_map(solution->transcription->endpoint);
    CHECK(moray_solution_info(solution)->outcome == MORAY_NLP_SOLVED, "solved");
    CHECK_OK(moray_certify(solution, &rk4, &certificate), "certificate");
    CHECK(certificate.pass, "loss %d: passes %s", loss, certificate.why);
    moray_residual residual[18];
    const int n = moray_solution_residuals(solution, residual);
    double worst = 0, loss_sum = 0;
    for (int k = 0; k < n; k++) {
        double x[2], u[1], z = sqrt(residual[k].weight) * (residual[k].predicted - residual[k].observed);
        moray_solution_at(solution, residual[k].phase, residual[k].time, x, u);
        if (residual[k].channel == 0)
            worst = tap_worse(worst, fabs(residual[k].predicted - x[0] * x[1] -
                                          moray_solution_parameters(solution)[1] * residual[k].time));
        loss_sum += loss == MORAY_HUBER && fabs(z) > 0.4 ? 0.8 * fabs(z) - 0.16 : z * z;
    }
    const double *s = moray_solution_parameters(solution);
    double xf[2];
    moray_solution_at(solution, 1, 2, xf, NULL);
    CHECK(n == 16 && worst < 1e-12, "%d residuals are those of the trajectory: %.1e", n, worst);
    CHECK_NEAR(loss_sum + 0.1 * s[0] * s[1] * xf[0] +
                   0.1 * (moray_solution_integrals(solution, 0)[0] + moray_solution_integrals(solution, 1)[0]),
               moray_solution_objective(solution), 1e-9, "losses and the endpoint make the objective");
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

// ---- Refusals ----

static void test_refusals(void)
{
    static const double time[] = {0.5}, late[] = {5}, value[] = {1}, minus[] = {-1};
    struct task task = {
        decay, {.n = 1, .ny = 1, .time = time, .value = value, .observe = see_state}, 1, 3, moray_fixed(1)};
    moray_ocp *ocp;
    const moray_observations good = task.data;
    task.data.time = late;
    refused(problem(&ocp, &task), MORAY_INPUT, "a time beyond the phase");
    task.data = good, task.data.weight = minus;
    refused(problem(&ocp, &task), MORAY_INPUT, "a negative weight");
    task.data = good, task.data.observe = NULL;
    refused(problem(&ocp, &task), MORAY_INPUT, "no function");
    moray_phase_spec free_end = {.nx = 1, .continuous = decay, .tf = moray_between(0.1, 0.4), .observed = good};
    refused(moray_ocp_new(&ocp, &(moray_ocp_spec){.phases = 1, .phase = &free_end, .ns = 1, .endpoint = nothing}),
            MORAY_INPUT, "an observation after the latest end of a phase");
    free_end.t0 = moray_between(0.6, 1), free_end.tf = moray_between(1, 2);
    refused(moray_ocp_new(&ocp, &(moray_ocp_spec){.phases = 1, .phase = &free_end, .ns = 1, .endpoint = nothing}),
            MORAY_INPUT, "an observation before the earliest start");
    task.data = good, task.data.residual = (moray_bounds_list)MORAY_BOUNDS(moray_free(), moray_free());
    refused(problem(&ocp, &task), MORAY_INPUT, "bounds for two channels of one");
    task.data = good, task.data.sum = moray_between(2, 1);
    refused(problem(&ocp, &task), MORAY_INPUT, "a sum of at least 2 and at most 1");
    moray_settings settings = moray_settings_default();
    moray_solution *solution;
    settings.scheme = "gauss3";
    CHECK_OK(two_phases(&ocp, MORAY_LEAST_SQUARES, true), "two phases");
    refused(moray_solve(ocp, &settings, NULL, &solution), MORAY_INPUT, "controls observed where gauss has none");
    moray_ocp_free(ocp);
}

int main(void)
{
    test_line("gauss3", false);
    test_line("radau3", false);
    test_line("hermite-simpson", true);
    test_given_mesh(true);
    test_given_mesh(false);
    test_huber();
    test_undetermined();
    test_noise();
    test_derivatives(MORAY_LEAST_SQUARES);
    test_derivatives(MORAY_HUBER);
    test_refusals();
    return tap_done();
}
