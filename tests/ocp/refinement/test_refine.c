// SPDX-License-Identifier: MIT
//
// Mesh refinement, and solutions as guesses on other meshes.
#include "tap.h"

#include <stdlib.h>
#include <string.h>
#include <tgmath.h>

#include "moray/ocp.h"
#include "rk4.h"

static const int rk4_steps = 100;
static const moray_integrator rk4 = {rk4_run, &rk4_steps};

// ---- Hypersensitive problem (Rao & Mease 1999): x' = -x^3 + u, minimise the integral of (x^2 + u^2)/2, x(0) = 1.5,
//      x(tf) = 1. For long times the Hamiltonian vanishes, so the costate is -x^3 +- x sqrt(x^4 + 1) on the way in and
//      out, and the cost is its integral over x, in closed form: ----

static double primitive(double y) // of sqrt(1 + y^2)
{
    return (y * sqrt(1 + y * y) + asinh(y)) / 2;
}

static double hypersensitive_cost(double x0, double xf)
{
    const double in = x0 * x0, out = xf * xf;
    return (primitive(in) - in * in / 2 + primitive(out) + out * out / 2) / 2;
}

static void drift(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = -at->x[0] * at->x[0] * at->x[0] + at->u[0];
    out->g[0] = (at->x[0] * at->x[0] + at->u[0] * at->u[0]) / 2;
}

static void total_cost(const moray_ends *at, moray_end_values *out, const void *data)
{
    out->objective = at->phase[0].q[0];
    if (*(const int *)data > 1) {
        out->objective += at->phase[1].q[0];
        out->e[0] = at->phase[1].x0[0] - at->phase[0].xf[0];
    }
}

static moray_ocp *hypersensitive(double tf, const int *phases)
{
    const double middle = *phases > 1 ? tf / 2 : tf;
    const moray_phase_spec phase[] = {{.name = "in",
                                       .nx = 1,
                                       .nu = 1,
                                       .nq = 1,
                                       .continuous = drift,
                                       .t0 = moray_fixed(0),
                                       .tf = moray_fixed(middle),
                                       .x0 = MORAY_BOUNDS(moray_fixed(1.5)),
                                       .xf = MORAY_BOUNDS(*phases > 1 ? moray_free() : moray_fixed(1))},
                                      {.name = "out",
                                       .nx = 1,
                                       .nu = 1,
                                       .nq = 1,
                                       .continuous = drift,
                                       .t0 = moray_fixed(middle),
                                       .tf = moray_fixed(tf),
                                       .xf = MORAY_BOUNDS(moray_fixed(1))}};
    moray_ocp *ocp = NULL;
    CHECK_OK(moray_ocp_new(&ocp, &(moray_ocp_spec){.name = "hypersensitive",
                                                   .phases = *phases,
                                                   .phase = phase,
                                                   .ne = *phases - 1,
                                                   .e = {(const moray_bounds[]){moray_fixed(0)}, *phases - 1},
                                                   .endpoint = total_cost,
                                                   .data = phases}),
             "hypersensitive problem");
    return ocp;
}

static moray_solution *solve(const moray_ocp *ocp, const char *scheme, int intervals, int refinements,
                             const moray_guess *guess)
{
    moray_settings settings = moray_settings_default();
    settings.scheme = scheme;
    settings.intervals = intervals;
    settings.max_refinements = refinements;
    moray_solution *solution = NULL;
    moray_status status = moray_solve(ocp, &settings, guess, &solution);
    if (!CHECK(!moray_failed(status), "%s, %d intervals: %s", scheme, intervals, status.text))
        exit(1);
    return solution;
}

static moray_mesh_record last_mesh(const moray_solution *solution)
{
    int meshes;
    const moray_mesh_record *history = moray_solution_history(solution, &meshes);
    return history[meshes - 1];
}

static const int one = 1, two = 2;

// The history agrees with the certificate, which is independent of it but for the integrand of the error.
static void check_history(const moray_solution *solution, const char *what)
{
    int meshes;
    const moray_mesh_record *history = moray_solution_history(solution, &meshes);
    moray_certificate certificate;
    CHECK_OK(moray_certify(solution, &rk4, &certificate), "certificate");
    CHECK(certificate.pass, "%s: passes %s", what, certificate.why);
    const moray_mesh_record last = history[meshes - 1];
    CHECK_NEAR(last.error, certificate.mesh_error, 1e-15, "error of the last mesh");
    CHECK(last.objective == moray_solution_objective(solution) &&
              last.variables == moray_solution_size(solution).variables,
          "%s: the last record is the solution's", what);
    bool above = true;
    for (int k = 0; k + 1 < meshes; k++)
        above = above && history[k].error > 1e-6 && history[k].outcome == MORAY_NLP_SOLVED;
    CHECK(above, "%s: every mesh but the last of %d was solved and not good enough", what, meshes);
}

static void test_against_uniform(const char *scheme, double tf)
{
    char what[80];
    snprintf(what, sizeof what, "%s, tf = %g", scheme, tf);
    moray_ocp *ocp = hypersensitive(tf, &one);
    moray_solution *refined = solve(ocp, scheme, 10, 15, NULL);
    const moray_mesh_record found = last_mesh(refined);
    CHECK(found.error <= 1e-6, "%s: error %.1e on %d intervals, %d nodes", what, found.error, found.intervals,
          found.nodes);
    CHECK_RELATIVE(found.objective, hypersensitive_cost(1.5, 1), 1e-5, "cost against its closed form");
    check_history(refined, what);
    int intervals = 10;
    moray_mesh_record uniform = {.nodes = 0};
    while (uniform.nodes < 3 * found.nodes) {
        moray_solution *solution = solve(ocp, scheme, intervals, 0, NULL);
        // A control that is sized by the horizon instead of by what it holds in check costs hundreds.
        CHECK(last_mesh(solution).iterations < 50, "%s, %d intervals: in %d iterations", scheme, intervals,
              last_mesh(solution).iterations);
        uniform = last_mesh(solution);
        moray_solution_free(solution);
        intervals *= 2;
    }
    CHECK(uniform.error > 10 * found.error, "%s: a uniform mesh of %d nodes: error %.1e, refined %.1e on %d", what,
          uniform.nodes, uniform.error, found.error, found.nodes);
    moray_solution_free(refined);
    moray_ocp_free(ocp);
}

static void test_phases_apart(void)
{
    moray_ocp *ocp = hypersensitive(80, &two);
    moray_solution *solution = solve(ocp, "radau3", 6, 12, NULL);
    check_history(solution, "two phases");
    CHECK_RELATIVE(moray_solution_objective(solution), hypersensitive_cost(1.5, 1), 1e-5, "cost of both phases");
    double time[400];
    int early = 0, late = 0;
    int nodes = moray_solution_nodes(solution, 0, time, NULL);
    for (int n = 0; n < nodes; n++)
        early += time[n] < 10;
    CHECK(2 * early > nodes, "the first phase is fine where it enters: %d of %d nodes", early, nodes);
    nodes = moray_solution_nodes(solution, 1, time, NULL);
    for (int n = 0; n < nodes; n++)
        late += time[n] > 70;
    CHECK(2 * late > nodes, "the second where it leaves: %d of %d nodes", late, nodes);
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

// ---- Minimum time from rest to rest with -2 <= u <= 1 over 300: switches at t = 20, arrives at t = 30 ----

static void push(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = at->x[1];
    out->f[1] = at->u[0];
}
static void arrival(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase[0].tf;
}

static moray_ocp *cart(void)
{
    moray_ocp *ocp = NULL;
    const moray_phase_spec phase = {.name = "cart",
                                    .nx = 2,
                                    .nu = 1,
                                    .continuous = push,
                                    .t0 = moray_fixed(0),
                                    .tf = moray_between(1, 100),
                                    .x0 = MORAY_BOUNDS(moray_fixed(0), moray_fixed(0)),
                                    .xf = MORAY_BOUNDS(moray_fixed(300), moray_fixed(0)),
                                    .u = MORAY_BOUNDS(moray_between(-2, 1))};
    CHECK_OK(moray_ocp_new(&ocp, &(moray_ocp_spec){.name = "cart", .phases = 1, .phase = &phase, .endpoint = arrival}),
             "bang-bang");
    return ocp;
}

static void test_switch_is_found(const char *scheme)
{
    moray_ocp *ocp = cart();
    moray_solution *solution = solve(ocp, scheme, 7, 10, NULL);
    check_history(solution, scheme);
    CHECK_NEAR(moray_solution_objective(solution), 30, 1e-3, scheme);
    double before, after;
    moray_solution_at(solution, 0, 19.8, NULL, &before);
    moray_solution_at(solution, 0, 20.2, NULL, &after);
    CHECK(fabs(before - 1) < 1e-3 && fabs(after + 2) < 1e-3, "%s: the switch is sharp: u = %g, %g", scheme, before,
          after);
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

// ---- Data with kinks: x' = u + sum |t - kink|, minimise the integral of u^2. The best u is constant, and polynomials
//      are exact, so the error is zero where edges stand on the kinks: a mesh that is coarsened there is wrong again.
//      ----

struct bends {
    const char *scheme;
    int intervals;
    double kink[3];
};

static void bend(const moray_node *at, moray_rates *out, const void *data)
{
    const struct bends *bends = data;
    out->f[0] = at->u[0];
    out->g[0] = at->u[0] * at->u[0];
    for (int i = 0; i < 3; i++)
        out->f[0] += moray_abs(at->t - bends->kink[i]);
}

static void effort(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase[0].q[0];
}

static void test_meshes_do_not_alternate(const struct bends *bends)
{
    const moray_phase_spec phase = {.name = "bent",
                                    .nx = 1,
                                    .nu = 1,
                                    .nq = 1,
                                    .continuous = bend,
                                    .t0 = moray_fixed(0),
                                    .tf = moray_fixed(1),
                                    .x0 = MORAY_BOUNDS(moray_fixed(0)),
                                    .xf = MORAY_BOUNDS(moray_fixed(1))};
    moray_ocp *ocp = NULL;
    CHECK_OK(
        moray_ocp_new(
            &ocp, &(moray_ocp_spec){.name = "kinks", .phases = 1, .phase = &phase, .endpoint = effort, .data = bends}),
        "kinks");
    moray_solution *solution = solve(ocp, bends->scheme, bends->intervals, 20, NULL);
    const moray_mesh_record last = last_mesh(solution);
    double u = 1;
    for (int i = 0; i < 3; i++)
        u -= (bends->kink[i] * bends->kink[i] + (1 - bends->kink[i]) * (1 - bends->kink[i])) / 2;
    check_history(solution, bends->scheme);
    CHECK(last.error <= 1e-6, "%s: kinks found to %.1e with %d nodes", bends->scheme, last.error, last.nodes);
    const double off = 2 * 1e-6; // of u: the error allowed, relative to size and magnitude of x, each at most 1
    CHECK_NEAR(last.objective, u * u, 2 * fabs(u) * off, "cost against its closed form");
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

// ---- Solutions as guesses ----

static void test_guess_from_solution(void)
{
    moray_ocp *ocp = cart(), *other = hypersensitive(50, &one);
    moray_solution *coarse = solve(ocp, "hermite-simpson", 10, 6, NULL);
    const moray_guess guess = moray_guess_from_solution(coarse);
    moray_solution *same = solve(ocp, "gauss1", 0, 0, &guess); // the name of the scheme does not matter
    CHECK(moray_solution_size(same).variables == moray_solution_size(coarse).variables,
          "no intervals: the mesh and scheme of the guess");
    CHECK(moray_solution_info(same)->iterations <= 5, "which is solved already: %d iterations",
          moray_solution_info(same)->iterations);
    moray_solution *another = solve(ocp, "radau3", 15, 0, &guess), *cold = solve(ocp, "radau3", 15, 0, NULL);
    // 90 bounds with a barrier of 1e-9 each, in an objective that is scaled by 1/100
    CHECK_NEAR(moray_solution_objective(another), moray_solution_objective(cold), 1e-5, "same optimum from a guess");
    CHECK(moray_solution_info(another)->iterations < moray_solution_info(cold)->iterations,
          "in fewer iterations: %d, %d", moray_solution_info(another)->iterations,
          moray_solution_info(cold)->iterations);
    moray_settings settings = moray_settings_default();
    moray_solution *none;
    moray_status status = moray_solve(other, &settings, &guess, &none);
    CHECK(status.code == MORAY_INPUT && strstr(status.text, "2 states and 1 controls"), "%s", status.text);
    settings.max_refinements = -1;
    status = moray_solve(ocp, &settings, NULL, &none);
    CHECK(status.code == MORAY_INPUT && strstr(status.text, "max_refinements = -1"), "%s", status.text);
    moray_solution_free(coarse);
    moray_solution_free(same);
    moray_solution_free(another);
    moray_solution_free(cold);
    moray_ocp_free(ocp);
    moray_ocp_free(other);
}

// ---- Interruption of a finer mesh leaves the coarser solution ----

static bool stop_second(void *observer, const moray_progress *progress)
{
    int *starts = observer;
    *starts += progress->iteration == 0;
    return *starts < 2;
}

static void test_interrupted(void)
{
    moray_ocp *ocp = hypersensitive(50, &one);
    moray_settings settings = moray_settings_default();
    int starts = 0, meshes;
    settings.max_refinements = 5;
    settings.progress = stop_second;
    settings.observer = &starts;
    moray_solution *solution;
    CHECK_OK(moray_solve(ocp, &settings, NULL, &solution), "runs");
    const moray_mesh_record *history = moray_solution_history(solution, &meshes);
    CHECK(meshes == 2 && history[0].outcome == MORAY_NLP_SOLVED && history[1].outcome == MORAY_NLP_INTERRUPTED &&
              isnan(history[1].error),
          "stopped on the second mesh");
    CHECK(moray_solution_info(solution)->outcome == MORAY_NLP_INTERRUPTED, "which the outcome says");
    CHECK(moray_solution_size(solution).variables == history[0].variables, "the solution is of the first");
    CHECK(strstr(moray_solution_diagnosis(solution), "A finer mesh of ") &&
              strstr(moray_solution_diagnosis(solution),
                     "intervals was not solved (interrupted); this is the best that "
                     "was."),
          "which the diagnosis says");
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

// ---- Rayleigh problem with a mixed constraint (Betts 2010), which binds on parts of the time: between the nodes it is
//      kept only if refinement looks there. The three families must agree. ----

static void circuit(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    const moray_num x1 = at->x[0], x2 = at->x[1], u = at->u[0];
    out->f[0] = x2;
    out->f[1] = -x1 + x2 * (1.4 - 0.14 * x2 * x2) + 4 * u;
    out->c[0] = u + x1 / 6;
    out->g[0] = u * u + x1 * x1;
}

static void test_path_constraint_between_nodes(void)
{
    moray_ocp *ocp = NULL;
    const moray_phase_spec phase = {.name = "circuit",
                                    .nx = 2,
                                    .nu = 1,
                                    .nc = 1,
                                    .nq = 1,
                                    .continuous = circuit,
                                    .t0 = moray_fixed(0),
                                    .tf = moray_fixed(4.5),
                                    .x0 = MORAY_BOUNDS(moray_fixed(-5), moray_fixed(-5)),
                                    .c = MORAY_BOUNDS(moray_at_most(0))};
    CHECK_OK(moray_ocp_new(&ocp,
                           &(moray_ocp_spec){
                               .name = "rayleigh", .phases = 1, .phase = &phase, .endpoint = total_cost, .data = &one}),
             "Rayleigh problem");
    const char *schemes[] = {"hermite-simpson", "radau3", "gauss3"};
    for (int k = 0; k < 3; k++) {
        moray_solution *solution = solve(ocp, schemes[k], 20, 15, NULL);
        moray_certificate certificate;
        CHECK_OK(moray_certify(solution, &rk4, &certificate), "certificate");
        CHECK(certificate.pass, "%s: mixed constraint between nodes within %.1e", schemes[k],
              certificate.between_nodes);
        CHECK_NEAR(last_mesh(solution).error, fmax(certificate.mesh_error, certificate.between_nodes / 100), 1e-15,
                   "error of the last mesh");
        CHECK_RELATIVE(moray_solution_objective(solution), 44.804444, 2e-6, schemes[k]);
        moray_solution_free(solution);
    }
    moray_ocp_free(ocp);
}

// ---- Limits: the best solution stays ----

static void test_limits(void)
{
    moray_ocp *ocp = hypersensitive(1000, &one);
    moray_settings settings = moray_settings_default();
    moray_solution *solution = NULL;
    int meshes;
    settings.max_refinements = 10;
    settings.max_variables = 150;
    CHECK_OK(moray_solve(ocp, &settings, NULL, &solution), "limit of the variables");
    const moray_mesh_record *mesh = moray_solution_history(solution, &meshes);
    CHECK(mesh[meshes - 1].error > settings.mesh_tolerance && mesh[meshes - 1].variables <= 150 &&
              moray_solution_info(solution)->outcome == MORAY_NLP_SOLVED,
          "150 variables at most: %d, mesh error %.1e", mesh[meshes - 1].variables, mesh[meshes - 1].error);
    moray_solution_free(solution);
    settings.max_variables = 0;
    settings.max_cpu_seconds = 1e-9;
    CHECK_OK(moray_solve(ocp, &settings, NULL, &solution), "limit of the time");
    moray_solution_history(solution, &meshes);
    CHECK(meshes == 1 && moray_solution_info(solution)->cpu_seconds < 1, "no time: %d mesh, %s", meshes,
          moray_nlp_outcome_text(moray_solution_info(solution)->outcome));
    moray_solution_free(solution);
    settings.max_cpu_seconds = -1;
    const moray_status status = moray_solve(ocp, &settings, NULL, &solution);
    CHECK(status.code == MORAY_INPUT && strstr(status.text, "max_cpu_seconds = -1"), "%s", status.text);
    moray_ocp_free(ocp);
}

static bool count_iterations(void *observer, const moray_progress *progress)
{
    (void)progress;
    ++*(int *)observer;
    return true;
}

// What is told of iterations and intervals: of every mesh, and as the user was told; the worst error is that of the
// record.
static void test_what_is_told(void)
{
    moray_ocp *ocp = hypersensitive(50, &two);
    moray_settings settings = moray_settings_default();
    moray_solution *solution = NULL;
    int told = 0, n, meshes, begun = 0, intervals = 0;
    settings.max_refinements = 5;
    settings.progress = count_iterations;
    settings.observer = &told;
    CHECK_OK(moray_solve(ocp, &settings, NULL, &solution), "solve");
    const moray_progress *at = moray_solution_iterations(solution, &n);
    const moray_mesh_record *history = moray_solution_history(solution, &meshes);
    for (int k = 0; k < n; k++)
        begun += at[k].iteration == 0;
    CHECK(n == told && n > 0, "%d iterations are kept, %d were told", n, told);
    CHECK(begun >= meshes && meshes > 1, "of %d meshes in %d solves", meshes, begun);
    CHECK(at[n - 1].iteration == history[meshes - 1].iterations, "to the last of the last");
    double worst = 0;
    for (int p = 0; p < 2; p++) {
        const int count = moray_solution_intervals(solution, p, NULL);
        double *edge = calloc((size_t)(2 * count) + 1, sizeof *edge), *error = edge + count + 1, t0, tf;
        moray_solution_times(solution, p, &t0, &tf);
        CHECK(moray_solution_intervals(solution, p, edge) == count && edge[0] == t0 && edge[count] == tf,
              "phase %d has %d intervals from end to end", p, count);
        CHECK_OK(moray_solution_interval_errors(solution, p, error), "errors");
        for (int k = 0; k < count; k++) {
            worst = tap_worse(worst, error[k]);
            CHECK(edge[k] < edge[k + 1], "interval %d has a length", k);
        }
        intervals += count;
        free(edge);
    }
    CHECK(intervals == history[meshes - 1].intervals, "all %d", intervals);
    CHECK(worst == history[meshes - 1].error, "worst error %g, on record %g", worst, history[meshes - 1].error);
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

int main(void)
{
    const char *schemes[] = {"trapezoid", "hermite-simpson", "radau3", "gauss2"};
    for (unsigned k = 0; k < sizeof schemes / sizeof *schemes; k++) {
        test_against_uniform(schemes[k], 50);
        test_against_uniform(schemes[k], 1000);
        test_switch_is_found(schemes[k]);
    }
    const struct bends bends[] = {{"trapezoid", 4, {29. / 64, 7. / 32, 5. / 32}},
                                  {"hermite-simpson", 10, {39. / 40, 67. / 160, 73. / 160}},
                                  {"gauss2", 5, {33. / 40, 11. / 40, 13. / 16}}};
    for (unsigned k = 0; k < sizeof bends / sizeof *bends; k++)
        test_meshes_do_not_alternate(&bends[k]);
    test_phases_apart();
    test_guess_from_solution();
    test_path_constraint_between_nodes();
    test_interrupted();
    test_limits();
    test_what_is_told();
    return tap_done();
}
