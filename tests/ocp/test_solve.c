// SPDX-License-Identifier: MIT
//
// Problems with known solutions: optimum, costates, order of every scheme, certificate.
#include "tap.h"

#include <stdlib.h>
#include <string.h>
#include <tgmath.h>

#include "moray/ocp.h"
#include "rk4.h"

static const int rk4_steps = 200;
static const moray_integrator rk4 = {rk4_run, &rk4_steps};

static moray_solution *solve(moray_ocp *ocp, const char *scheme, int intervals, const moray_guess *guess)
{
    moray_settings settings = moray_settings_default();
    settings.scheme = scheme;
    settings.intervals = intervals;
    settings.tolerance = 1e-10;
    moray_solution *solution = NULL;
    moray_status status = moray_solve(ocp, &settings, guess, &solution);
    if (!CHECK(!moray_failed(status), "%s, %d intervals: %s", scheme, intervals, status.text))
        exit(1);
    const moray_nlp_outcome outcome = moray_solution_info(solution)->outcome;
    CHECK(outcome == MORAY_NLP_SOLVED, "%s, %d intervals: %s", scheme, intervals, moray_nlp_outcome_text(outcome));
    return solution;
}

// The Hamiltonian is the same at every collocated node; those are most of all.
static void check_hamiltonian(const moray_solution *solution, const char *what, double value, double tolerance)
{
    double hamiltonian[64], worst = 0;
    const int nodes = moray_solution_hamiltonian(solution, 0, hamiltonian);
    int missing = 0;
    for (int n = 0; n < nodes; n++) {
        missing += isnan(hamiltonian[n]);
        worst = fmax(worst, fabs(hamiltonian[n] - value)); // which passes over NaN
    }
    CHECK(2 * missing < nodes, "%s: at %d of %d nodes there is none", what, missing, nodes);
    CHECK(worst < tolerance, "%s: Hamiltonian %g at %d nodes: %.1e", what, value, nodes, worst);
    moray_certificate certificate;
    CHECK_OK(moray_certify(solution, &rk4, &certificate), "certificate");
    CHECK(certificate.hamiltonian <= 2 * worst / fabs(value) + 1e-15, "%s: its drift: %.1e", what,
          certificate.hamiltonian);
}

// ---- Brachistochrone (Bryson & Ho 2.7): (0, 10) to (10, 5), g = 9.80665, 1.80160312 s ----

static void slide(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = at->x[2] * sin(at->u[0]);
    out->f[1] = -at->x[2] * cos(at->u[0]);
    out->f[2] = 9.80665 * cos(at->u[0]);
}
static void arrival(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase[0].tf;
}

static void test_brachistochrone(void)
{
    moray_ocp *ocp;
    const moray_phase_spec wire = {.name = "wire",
                                   .nx = 3,
                                   .nu = 1,
                                   .continuous = slide,
                                   .t0 = moray_fixed(0),
                                   .tf = moray_between(0.1, 10),
                                   .x0 = MORAY_BOUNDS(moray_fixed(0), moray_fixed(10), moray_fixed(0)),
                                   .xf = MORAY_BOUNDS(moray_fixed(10), moray_fixed(5), moray_free()),
                                   .u = MORAY_BOUNDS(moray_between(0, M_PI))};
    CHECK_OK(moray_ocp_new(
                 &ocp, &(moray_ocp_spec){.name = "brachistochrone", .phases = 1, .phase = &wire, .endpoint = arrival}),
             "brachistochrone");
    int nx, nu;
    moray_ocp_widths(ocp, 0, &nx, &nu);
    CHECK(moray_ocp_phases(ocp) == 1 && nx == 3 && nu == 1, "sizes: %d phase of %d states, %d control",
          moray_ocp_phases(ocp), nx, nu);
    moray_solution *solution = solve(ocp, "lobatto5", 10, NULL);
    CHECK_RELATIVE(moray_solution_objective(solution), 1.80160312, 1e-8, "published time");
    moray_certificate certificate;
    CHECK_OK(moray_certify(solution, &rk4, &certificate), "certificate");
    CHECK(certificate.pass, "passes: KKT %.1e, mesh %.1e, between nodes %.1e, re-simulation %.1e", certificate.kkt,
          certificate.mesh_error, certificate.between_nodes, certificate.resimulation);
    check_hamiltonian(solution, "brachistochrone", -1, 1e-5); // of the least time
    moray_solution_free(solution);
    solution = solve(ocp, "trapezoid", 10, NULL);
    CHECK_OK(moray_certify(solution, &rk4, &certificate), "certificate of a coarse mesh");
    CHECK(!certificate.pass && certificate.mesh_error > 1e-4 && certificate.resimulation > 1e-4,
          "a coarse mesh does not pass: mesh %.1e, re-simulation %.1e", certificate.mesh_error,
          certificate.resimulation);
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

// ---- Double integrator, minimum energy: x'' = u, (0, 0) to (1, 0) in 1, u = 6 - 12 t, J = integral of u^2 / 2 = 6;
//      lambda_x = -12, lambda_v = 12 t - 6 ----

static void push(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = at->x[1];
    out->f[1] = at->u[0];
    out->g[0] = at->u[0] * at->u[0] / 2;
}
static void energy(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase[0].q[0];
}

static void test_costates(void)
{
    moray_ocp *ocp;
    const moray_phase_spec cart = {.name = "cart",
                                   .nx = 2,
                                   .nu = 1,
                                   .nq = 1,
                                   .continuous = push,
                                   .t0 = moray_fixed(0),
                                   .tf = moray_fixed(1),
                                   .x0 = MORAY_BOUNDS(moray_fixed(0), moray_fixed(0)),
                                   .xf = MORAY_BOUNDS(moray_fixed(1), moray_fixed(0))};
    CHECK_OK(moray_ocp_new(
                 &ocp, &(moray_ocp_spec){.name = "double integrator", .phases = 1, .phase = &cart, .endpoint = energy}),
             "double integrator");
    const char *schemes[] = {"hermite-simpson", "lobatto4", "radau3", "gauss2", "gauss4"};
    for (unsigned k = 0; k < sizeof schemes / sizeof *schemes; k++) {
        moray_solution *solution = solve(ocp, schemes[k], 4, NULL);
        CHECK_RELATIVE(moray_solution_objective(solution), 6, 1e-9, schemes[k]);
        double time[64], costate[64][2], worst = 0, u, x[2];
        const int nodes = moray_solution_nodes(solution, 0, time, &costate[0][0]);
        for (int n = 0; n < nodes; n++)
            worst = fmax(worst, fmax(fabs(costate[n][0] + 12), fabs(costate[n][1] - 12 * time[n] + 6)));
        CHECK(worst < 1e-7, "%s: costates at all %d nodes against the closed form: %.1e", schemes[k], nodes, worst);
        check_hamiltonian(solution, schemes[k], -18, 1e-7); // u^2/2 + lambda_x v + lambda_v u
        moray_solution_at(solution, 0, 0.37, x, &u);
        CHECK_NEAR(u, 6 - 12 * 0.37, 1e-7, "control between nodes");
        if (strcmp(schemes[k], "gauss2") != 0) // its interpolant is a parabola, the solution a cubic
            CHECK_NEAR(x[0], 3 * 0.37 * 0.37 - 2 * 0.37 * 0.37 * 0.37, 1e-8, "state between nodes");
        moray_solution_free(solution);
    }
    moray_ocp_free(ocp);
}

// ---- Order: x' = x^2 cos t, x(0) = 0.5: x = 1 / (2 - sin t) ----

static void decay(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = at->x[0] * at->x[0] * cos(at->t);
}
static void nothing(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = 0 * at->phase[0].xf[0];
}

static double end_error(moray_ocp *ocp, const char *scheme, int intervals)
{
    moray_solution *solution = solve(ocp, scheme, intervals, NULL);
    double x;
    moray_solution_at(solution, 0, 4, &x, NULL);
    moray_solution_free(solution);
    return fabs(x - 1 / (2 - sin(4.0)));
}

static void test_order(void)
{
    const struct {
        const char *scheme;
        double order;
        int intervals; // far enough for the asymptotic range, not so far as to reach rounding
    } cases[] = {{"trapezoid", 2, 64}, {"hermite-simpson", 4, 32}, {"lobatto4", 6, 16}, {"lobatto5", 8, 10},
                 {"radau1", 1, 256},   {"radau2", 3, 64},          {"radau3", 5, 24},   {"radau4", 7, 12},
                 {"gauss1", 2, 64},    {"gauss2", 4, 32},          {"gauss3", 6, 14},   {"gauss4", 8, 10}};
    moray_ocp *ocp;
    const moray_phase_spec phase = {.name = "decay",
                                    .nx = 1,
                                    .continuous = decay,
                                    .t0 = moray_fixed(0),
                                    .tf = moray_fixed(4),
                                    .x0 = MORAY_BOUNDS(moray_fixed(0.5))};
    CHECK_OK(moray_ocp_new(&ocp, &(moray_ocp_spec){.name = "order", .phases = 1, .phase = &phase, .endpoint = nothing}),
             "initial-value problem");
    for (unsigned k = 0; k < sizeof cases / sizeof *cases; k++) {
        const double coarse = end_error(ocp, cases[k].scheme, cases[k].intervals);
        const double fine = end_error(ocp, cases[k].scheme, 2 * cases[k].intervals);
        const double order = log2(coarse / fine);
        CHECK(fabs(order - cases[k].order) < 0.2, "%s: measured order %.2f, theory %g (errors %.1e, %.1e)",
              cases[k].scheme, order, cases[k].order, coarse, fine);
    }
    moray_certificate certificate;
    moray_solution *solution = solve(ocp, "gauss2", 10, NULL);
    CHECK_OK(moray_certify(solution, &rk4, &certificate), "certificate");
    CHECK(isnan(certificate.hamiltonian), "dynamics that depend on time have no constant Hamiltonian");
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

// ---- Least time of the double integrator, |u| <= 1, (0, 0) to (1, 0): tf = 2, u jumps at t = 1, which is a node: an
//      integrator that ends a step there must not see the other side ----

static void shove(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = at->x[1];
    out->f[1] = at->u[0];
}

static void test_resimulation_stays_on_its_side_of_a_jump(void)
{
    moray_ocp *ocp;
    const moray_phase_spec cart = {.name = "cart",
                                   .nx = 2,
                                   .nu = 1,
                                   .continuous = shove,
                                   .t0 = moray_fixed(0),
                                   .tf = moray_between(0.1, 10),
                                   .x0 = MORAY_BOUNDS(moray_fixed(0), moray_fixed(0)),
                                   .xf = MORAY_BOUNDS(moray_fixed(1), moray_fixed(0)),
                                   .u = MORAY_BOUNDS(moray_between(-1, 1))};
    CHECK_OK(
        moray_ocp_new(&ocp, &(moray_ocp_spec){.name = "least time", .phases = 1, .phase = &cart, .endpoint = arrival}),
        "least time");
    moray_solution *solution = solve(ocp, "gauss2", 4, NULL);
    moray_certificate certificate;
    CHECK_NEAR(moray_solution_objective(solution), 2, 1e-8, "least time");
    CHECK_OK(moray_certify(solution, &rk4, &certificate), "certificate");
    CHECK(certificate.resimulation < 1e-7, "re-simulation %.1e", certificate.resimulation);
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

// ---- An integrand that vanishes at every node: x' = 0, q = integral of sin^2(20 pi t) over [0, 1] = 1/2 ----

static void ripple(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    const moray_num wave = sin(20 * M_PI * at->t);
    out->f[0] = 0 * at->x[0];
    out->g[0] = wave * wave;
}

static void test_integrals_are_certified(void)
{
    moray_ocp *ocp;
    const moray_phase_spec phase = {.name = "ripple",
                                    .nx = 1,
                                    .nq = 1,
                                    .continuous = ripple,
                                    .t0 = moray_fixed(0),
                                    .tf = moray_fixed(1),
                                    .x0 = MORAY_BOUNDS(moray_fixed(1))};
    CHECK_OK(moray_ocp_new(&ocp, &(moray_ocp_spec){.name = "ripple", .phases = 1, .phase = &phase, .endpoint = energy}),
             "integrand that ripples");
    moray_solution *solution = solve(ocp, "hermite-simpson", 10, NULL);
    moray_certificate certificate;
    CHECK_OK(moray_certify(solution, &rk4, &certificate), "certificate");
    CHECK_NEAR(moray_solution_integrals(solution, 0)[0], 0, 1e-12, "the nodes see nothing");
    CHECK(!certificate.pass && certificate.mesh_error > 0.01, "mesh error of the integral: %.2g",
          certificate.mesh_error);
    CHECK(certificate.resimulation > 1, "integral found by simulating again: %.2g times its size",
          certificate.resimulation);
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

// ---- Bad input and failure ----

static void test_refusals(void)
{
    moray_ocp *ocp;
    moray_phase_spec phase = {.name = "wire",
                              .nx = 3,
                              .nu = 1,
                              .continuous = slide,
                              .t0 = moray_fixed(0),
                              .tf = moray_between(0.1, 10),
                              .x0 = MORAY_BOUNDS(moray_fixed(0))};
    moray_ocp_spec spec = {.name = "bad", .phases = 1, .phase = &phase, .endpoint = arrival};
    moray_status status = moray_ocp_new(&ocp, &spec);
    CHECK(status.code == MORAY_INPUT && strstr(status.text, "x0 of wire: 1 bounds given, 3 needed"), "%s", status.text);
    phase.x0 = (moray_bounds_list)MORAY_BOUNDS(moray_fixed(0), moray_between(2, 1), moray_free());
    status = moray_ocp_new(&ocp, &spec);
    CHECK(status.code == MORAY_INPUT && strstr(status.text, "lower bound 2 is above upper bound 1"), "%s", status.text);
    phase.x0 = (moray_bounds_list)MORAY_BOUNDS(moray_fixed(NAN), moray_free(), moray_free());
    status = moray_ocp_new(&ocp, &spec);
    CHECK(status.code == MORAY_INPUT && strstr(status.text, "not a number"), "%s", status.text);
    phase.x0 = (moray_bounds_list){0};
    phase.continuous = NULL;
    status = moray_ocp_new(&ocp, &spec);
    CHECK(status.code == MORAY_INPUT && strstr(status.text, "needs a continuous function"), "%s", status.text);
    phase.continuous = slide;
    CHECK_OK(moray_ocp_new(&ocp, &spec), "mended");
    moray_settings settings = moray_settings_default();
    moray_solution *solution;
    settings.intervals = 0;
    CHECK(moray_solve(ocp, &settings, NULL, &solution).code == MORAY_INPUT, "no intervals");
    settings.intervals = 5;
    settings.scheme = "euler";
    status = moray_solve(ocp, &settings, NULL, &solution);
    CHECK(status.code == MORAY_INPUT && strstr(status.text, "euler"), "%s", status.text);
    moray_ocp_free(ocp);
}

static void test_infeasible_is_explained(void)
{
    moray_ocp *ocp;
    const moray_phase_spec cart = {.name = "cart",
                                   .nx = 2,
                                   .nu = 1,
                                   .nq = 1,
                                   .continuous = push,
                                   .t0 = moray_fixed(0),
                                   .tf = moray_fixed(1),
                                   .x0 = MORAY_BOUNDS(moray_fixed(0), moray_fixed(0)),
                                   .xf = MORAY_BOUNDS(moray_fixed(1), moray_fixed(0)),
                                   .u = MORAY_BOUNDS(moray_between(-1, 1))};
    CHECK_OK(
        moray_ocp_new(&ocp, &(moray_ocp_spec){.name = "too weak", .phases = 1, .phase = &cart, .endpoint = energy}),
        "too weak a motor");
    moray_settings settings = moray_settings_default();
    moray_solution *solution;
    CHECK_OK(moray_solve(ocp, &settings, NULL, &solution), "runs");
    CHECK(moray_solution_info(solution)->outcome == MORAY_NLP_INFEASIBLE &&
              strstr(moray_solution_diagnosis(solution), "Largest violation: defect of state x["),
          "says what is violated");
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

int main(void)
{
    test_brachistochrone();
    test_costates();
    test_order();
    test_resimulation_stays_on_its_side_of_a_jump();
    test_integrals_are_certified();
    test_refusals();
    test_infeasible_is_explained();
    return tap_done();
}
