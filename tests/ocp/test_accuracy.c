// SPDX-License-Identifier: MIT
//
// Orders of optimum, control and costates against closed forms, as the mesh is refined.
#include "tap.h"

#include <stdlib.h>
#include <tgmath.h>

#include "moray/ocp.h"

enum { most_nodes = 1200 };

static void energy(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase[0].q[0];
}

static moray_ocp *problem(const char *name, const moray_phase_spec *phase)
{
    moray_ocp *ocp = NULL;
    moray_status status =
        moray_ocp_new(&ocp, &(moray_ocp_spec){.name = name, .phases = 1, .phase = phase, .endpoint = energy});
    if (!CHECK(!moray_failed(status), "%s: %s", name, status.text))
        exit(1);
    return ocp;
}

static moray_solution *solve(const moray_ocp *ocp, const char *scheme, int intervals)
{
    moray_settings settings = moray_settings_default();
    settings.scheme = scheme;
    settings.intervals = intervals;
    settings.tolerance = 1e-11;
    moray_solution *solution = NULL;
    moray_status status = moray_solve(ocp, &settings, NULL, &solution);
    if (!CHECK(!moray_failed(status), "%s, %d intervals: %s", scheme, intervals, status.text))
        exit(1);
    return solution;
}

// The exact solution: u and costates at t; NaN where a costate jumps.
typedef void exact_fn(double t, double *u, double *costate);

struct errors {
    double objective, control, costate, end_costate; // the last: at the first and the last node, not in the one before
};

static struct errors errors_of(const moray_ocp *ocp, const char *scheme, int intervals, double optimum, exact_fn *exact)
{
    static double time[most_nodes], costate[2 * most_nodes];
    int nx, nu;
    moray_ocp_widths(ocp, 0, &nx, &nu);
    moray_solution *solution = solve(ocp, scheme, intervals);
    struct errors e = {.objective = fabs(moray_solution_objective(solution) - optimum)};
    const int nodes = moray_solution_nodes(solution, 0, time, costate);
    for (int n = 0; n < nodes; n++) {
        double u, lambda[2], found[2], x[2];
        exact(time[n], &u, lambda);
        moray_solution_at(solution, 0, time[n], x, found);
        const bool end = n == 0 || n == nodes - 1;
        double *worst = end ? &e.end_costate : &e.costate;
        e.control = end ? e.control : fmax(e.control, fabs(found[0] - u));
        for (int i = 0; i < nx; i++)
            *worst = fmax(*worst, fabs(costate[n * nx + i] - lambda[i])); // passes over NaN
    }
    moray_solution_free(solution);
    return e;
}

static void check_order(const char *what, const char *scheme, double coarse, double fine, double order)
{
    const double measured = log2(coarse / fine);
    CHECK(fabs(measured - order) < 0.25, "%s, %s: measured order %.2f, theory %g (errors %.1e, %.1e)", scheme, what,
          measured, order, coarse, fine);
}

// ---- Regulator: x' = u, x(0) = 1, least integral of (x^2 + u^2) / 2 over [0, 1]: lambda = sinh(1 - t) / cosh 1,
//      u = -lambda, J = tanh(1) / 2 ----

static void regulate(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = at->u[0];
    out->g[0] = (at->x[0] * at->x[0] + at->u[0] * at->u[0]) / 2;
}

static void regulated(double t, double *u, double *costate)
{
    costate[0] = sinh(1 - t) / cosh(1.0);
    *u = -costate[0];
}

// Costates are values at the stages, whose order is lower than the scheme's.
static void test_regulator(void)
{
    const struct {
        const char *scheme;
        int intervals;
        double objective, costate, end_costate;
    } cases[] = {{"trapezoid", 16, 2, 2, 1}, {"hermite-simpson", 8, 4, 2, 2}, {"radau2", 8, 3, 2, 3},
                 {"radau3", 6, 5, 3, 3},     {"gauss1", 16, 2, 2, 2},         {"gauss2", 4, 4, 3, 4}};
    moray_ocp *ocp = problem("regulator", &(moray_phase_spec){.name = "regulator",
                                                              .nx = 1,
                                                              .nu = 1,
                                                              .nq = 1,
                                                              .continuous = regulate,
                                                              .t0 = moray_fixed(0),
                                                              .tf = moray_fixed(1),
                                                              .x0 = MORAY_BOUNDS(moray_fixed(1))});
    for (unsigned k = 0; k < sizeof cases / sizeof *cases; k++) {
        const char *scheme = cases[k].scheme;
        const struct errors coarse = errors_of(ocp, scheme, cases[k].intervals, tanh(1.0) / 2, regulated),
                            fine = errors_of(ocp, scheme, 2 * cases[k].intervals, tanh(1.0) / 2, regulated);
        check_order("regulator, optimum", scheme, coarse.objective, fine.objective, cases[k].objective);
        check_order("regulator, costate", scheme, coarse.costate, fine.costate, cases[k].costate);
        check_order("regulator, costate at the ends", scheme, coarse.end_costate, fine.end_costate,
                    cases[k].end_costate);
    }
    moray_ocp_free(ocp);
}

// ---- Double integrator, x'' = u, least integral of u^2 / 2 over [0, 1] ----

static void push(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = at->x[1];
    out->f[1] = at->u[0];
    out->g[0] = at->u[0] * at->u[0] / 2;
}

// From rest at 0 to rest at 1: u = 6 - 12 t, J = 6.
static void rest_to_rest(double t, double *u, double *costate)
{
    *u = 6 - 12 * t;
    costate[0] = -12;
    costate[1] = -*u;
}

// Breakwell: (0, 1) to (0, -1) with x <= l = 0.1: u = -(2 / 3l) (1 - t / 3l) before 3l, 0 up to 1 - 3l, and back again;
// J = 4 / 9l. lambda_v = -u, and lambda_x = u' jumps where the constraint is reached and left.
static const double l = 0.1;

static void below_the_ceiling(double t, double *u, double *costate)
{
    const double left = fmin(t, 1 - t), arc = 3 * l - left, slope = 2 / (9 * l * l);
    *u = arc > 0 ? -slope * arc : 0;
    costate[0] = fabs(arc) < 1e-9 ? NAN : arc < 0 ? 0 : t < 0.5 ? slope : -slope;
    costate[1] = -*u;
}

static moray_phase_spec cart(void)
{
    return (moray_phase_spec){
        .name = "cart", .nx = 2, .nu = 1, .nq = 1, .continuous = push, .t0 = moray_fixed(0), .tf = moray_fixed(1)};
}

static void test_trapezoid(const char *what, const moray_phase_spec *phase, double optimum, exact_fn *exact,
                           double control_order)
{
    moray_ocp *ocp = problem(what, phase);
    const struct errors coarse = errors_of(ocp, "trapezoid", 40, optimum, exact),
                        fine = errors_of(ocp, "trapezoid", 80, optimum, exact),
                        exactly = errors_of(ocp, "hermite-simpson", 10, optimum, exact);
    char text[80];
    snprintf(text, sizeof text, "%s, optimum", what);
    check_order(text, "trapezoid", coarse.objective, fine.objective, 2);
    snprintf(text, sizeof text, "%s, costates", what);
    check_order(text, "trapezoid", coarse.costate, fine.costate, 2);
    snprintf(text, sizeof text, "%s, control", what);
    check_order(text, "trapezoid", coarse.control, fine.control, control_order);
    CHECK(exactly.objective < 1e-6 && exactly.control < 1e-5 && exactly.costate < 2e-4,
          "%s: cubic, so exact with hermite-simpson: optimum %.1e, control %.1e, costates %.1e", what,
          exactly.objective, exactly.control, exactly.costate);
    moray_ocp_free(ocp);
}

// ---- A scheme for each phase: x' = -x and y' = -y, one after the other, of the order of its own ----

static void decay(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = -at->x[0];
}

static void no_cost(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)at, (void)data;
    out->objective = 0;
}

static void errors_of_phases(const char *of_settings, const char *first, const char *second, int intervals,
                             double error[2])
{
    const moray_phase_spec phase[] = {
        {.nx = 1, .continuous = decay, .tf = moray_fixed(2), .x0 = MORAY_BOUNDS(moray_fixed(1)), .scheme = first},
        {.nx = 1,
         .continuous = decay,
         .t0 = moray_fixed(2),
         .tf = moray_fixed(4),
         .x0 = MORAY_BOUNDS(moray_fixed(1)),
         .scheme = second}};
    moray_ocp *ocp = NULL;
    CHECK_OK(moray_ocp_new(&ocp, &(moray_ocp_spec){.phases = 2, .phase = phase, .endpoint = no_cost}), "two phases");
    moray_solution *solution = solve(ocp, of_settings, intervals);
    for (int p = 0; p < 2; p++) {
        double x;
        moray_solution_at(solution, p, 2.0 + 2 * p, &x, NULL);
        error[p] = fabs(x - exp(-2.0));
    }
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

static void test_phases(void)
{
    const struct {
        const char *of_settings, *first, *second;
        int intervals;
        double order[2];
    } cases[] = {{"trapezoid", NULL, "radau2", 8, {2, 3}},
                 {"gauss2", "radau2", NULL, 8, {3, 4}},
                 {"hermite-simpson", "trapezoid", "gauss1", 8, {2, 2}},
                 {"trapezoid,gauss2", "radau2", NULL, 8, {2, 4}}};
    for (unsigned k = 0; k < sizeof cases / sizeof *cases; k++) {
        double coarse[2], fine[2];
        errors_of_phases(cases[k].of_settings, cases[k].first, cases[k].second, cases[k].intervals, coarse);
        errors_of_phases(cases[k].of_settings, cases[k].first, cases[k].second, 2 * cases[k].intervals, fine);
        check_order("first phase", cases[k].of_settings, coarse[0], fine[0], cases[k].order[0]);
        check_order("second phase", cases[k].of_settings, coarse[1], fine[1], cases[k].order[1]);
    }
}

int main(void)
{
    test_phases();
    test_regulator();
    moray_phase_spec phase = cart();
    phase.x0 = (moray_bounds_list)MORAY_BOUNDS(moray_fixed(0), moray_fixed(0));
    phase.xf = (moray_bounds_list)MORAY_BOUNDS(moray_fixed(1), moray_fixed(0));
    test_trapezoid("double integrator", &phase, 6, rest_to_rest, 2);
    phase.x0 = (moray_bounds_list)MORAY_BOUNDS(moray_fixed(0), moray_fixed(1));
    phase.xf = (moray_bounds_list)MORAY_BOUNDS(moray_fixed(0), moray_fixed(-1));
    phase.x = (moray_bounds_list)MORAY_BOUNDS(moray_at_most(l), moray_free());
    test_trapezoid("Breakwell", &phase, 4 / (9 * l), below_the_ceiling, 1); // it has kinks
    return tap_done();
}
