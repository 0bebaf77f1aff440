// SPDX-License-Identifier: MIT
//
// Problems in units and boxes that mislead, with kinks at their ends and functions that do not exist beyond their
// bounds: the right optimum, with a certificate.
#include "tap.h"

#include <tgmath.h>

#include "moray/ocp.h"
#include "rk4.h"

static const int rk4_steps = 100;

// As adaptive ones do, it gives up where its steps drown in the digits of the time.
static moray_status careful_run(const moray_integrator *self, const moray_ode *ode, double t0, double t1, double *x,
                                const double *times, int n_times, moray_ode_observer *observe, void *observer)
{
    if (!((t1 - t0) / rk4_steps > 1e-10 * fabs(t0)))
        return moray_error(MORAY_NUMERIC, "steps too small at t = %g", t0);
    return rk4_run(self, ode, t0, t1, x, times, n_times, observe, observer);
}

static const moray_integrator careful = {careful_run, &rk4_steps};

struct hostile {
    const char *name;
    moray_phase_spec phase;
    moray_endpoint_fn *endpoint;
    int ns;
    double optimum, tolerance; // relative
};

static void check(const struct hostile *h)
{
    const moray_bounds s[] = {moray_between(-1, 1)};
    moray_ocp_spec spec = {.name = h->name, .phases = 1, .phase = &h->phase, .endpoint = h->endpoint, .ns = h->ns};
    moray_ocp *ocp = NULL;
    moray_solution *solution = NULL;
    moray_certificate c;
    moray_settings settings = moray_settings_default();
    spec.s = moray_bounds_of(s, h->ns);
    settings.max_refinements = 12;
    CHECK_OK(moray_ocp_new(&ocp, &spec), h->name);
    CHECK_OK(moray_solve(ocp, &settings, NULL, &solution), h->name);
    CHECK_OK(moray_certify(solution, &careful, &c), h->name);
    const double found = moray_solution_objective(solution);
    CHECK(fabs(found / h->optimum - 1) < h->tolerance, "%s: %.10g, expected %.10g", h->name, found, h->optimum);
    CHECK(c.pass, "%s: %s", h->name, c.why);
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

static void first_integral(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase[0].q[0];
}

static void duration(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase[0].tf - at->phase[0].t0;
}

// ---- Least time from rest to rest, |u| <= a: 2 sqrt(distance / a) ----

static void dash(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = at->x[1];
    out->f[1] = at->u[0];
}

static void test_dash(const char *name, double distance, double a, moray_bounds t0, moray_bounds tf, moray_bounds x)
{
    const moray_bounds all[] = {x, x}, start[] = {moray_fixed(0), moray_fixed(0)},
                       end[] = {moray_fixed(distance), moray_fixed(0)}, u[] = {moray_between(-a, a)};
    check(&(struct hostile){name,
                            {.name = "dash",
                             .nx = 2,
                             .nu = 1,
                             .continuous = dash,
                             .t0 = t0,
                             .tf = tf,
                             .x = moray_bounds_of(all, 2),
                             .x0 = moray_bounds_of(start, 2),
                             .xf = moray_bounds_of(end, 2),
                             .u = moray_bounds_of(u, 1)},
                            duration,
                            0,
                            2 * sqrt(distance / a),
                            1e-6});
}

static void test_dashes(void)
{
    const moray_bounds none = moray_free(), at_once = moray_fixed(0);
    test_dash("times within 1e5 s for 2 s", 1, 1, moray_between(0, 1e5), moray_between(0, 1e5), none);
    test_dash("any final time, 1e7 m", 1e7, 1, at_once, none, none);
    test_dash("any final time, a micrometre at 1e12 m/s2", 1e-6, 1e12, at_once, none, none);
    test_dash("a millimetre in a box of 1e6 m", 1e-3, 1, at_once, moray_between(0, 100), moray_between(-1e6, 1e6));
    test_dash("bounds of 2e19", 1, 1, at_once, moray_between(0, 2e19), moray_between(-2e19, 2e19));
}

// ---- Costs of 1e-12 and 1e15: the integral of k (1 + t) u^2, x from 0 to 1 in 1 s; the optimum is k / log 2 ----

static void costly(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = at->u[0];
    out->g[0] = 1e15 * at->u[0] * at->u[0] * (1 + at->t);
}

static void cheap(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = at->u[0];
    out->g[0] = 1e-12 * at->u[0] * at->u[0] * (1 + at->t);
}

static void test_cost(const char *name, moray_continuous_fn *continuous, double k)
{
    check(&(struct hostile){name,
                            {.name = "walk",
                             .nx = 1,
                             .nu = 1,
                             .nq = 1,
                             .continuous = continuous,
                             .tf = moray_fixed(1),
                             .x0 = MORAY_BOUNDS(moray_fixed(0)),
                             .xf = MORAY_BOUNDS(moray_fixed(1)),
                             .u = MORAY_BOUNDS(moray_between(-5, 5))},
                            first_integral,
                            0,
                            k / log(2),
                            1e-6});
}

// ---- A parameter whose middle is the worst, beside an integral that is 0: J = q - s^2, |s| <= 1 ----

static void rest(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = at->u[0];
    out->g[0] = at->u[0] * at->u[0];
}

static void bowl(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase[0].q[0] - at->s[0] * at->s[0];
}

static void test_parameter(void)
{
    check(&(struct hostile){"a parameter at its worst in the middle",
                            {.name = "rest",
                             .nx = 1,
                             .nu = 1,
                             .nq = 1,
                             .continuous = rest,
                             .tf = moray_fixed(1),
                             .x0 = MORAY_BOUNDS(moray_fixed(0)),
                             .xf = MORAY_BOUNDS(moray_fixed(0)),
                             .u = MORAY_BOUNDS(moray_between(-8, 8))},
                            bowl,
                            1,
                            -1,
                            1e-6});
}

// ---- Dry friction 0.3 against a motion that begins and ends at its kink, v = 0, over 1 m with |u| <= 1: with
//      accelerations 0.7 and 1.3 the least time is sqrt(2 (1 / 0.7 + 1 / 1.3)) ----

static void slide(const moray_node *at, moray_rates *out, const void *data)
{
    const double v = creal(at->x[1]);
    (void)data;
    out->f[0] = at->x[1];
    out->f[1] = at->u[0] - 0.3 * (v > 0 ? 1 : v < 0 ? -1 : 0);
}

static void test_friction(void)
{
    check(&(struct hostile){"dry friction",
                            {.name = "slide",
                             .nx = 2,
                             .nu = 1,
                             .continuous = slide,
                             .tf = moray_between(0.1, 20),
                             .x0 = MORAY_BOUNDS(moray_fixed(0), moray_fixed(0)),
                             .xf = MORAY_BOUNDS(moray_fixed(1), moray_fixed(0)),
                             .u = MORAY_BOUNDS(moray_between(-1, 1))},
                            duration,
                            0,
                            sqrt(2 * (1 / 0.7 + 1 / 1.3)),
                            1e-6});
}

// ---- A table that is read by a cast: it has no entries outside the box, where the functions are never asked, neither
//      by the solve and its diagnosis nor by the certificate and the check of derivatives ----

enum { entries = 10 };
static int outside; // how often

static void read_table(const moray_node *at, moray_rates *out, const void *data)
{
    static const double table[entries + 1] = {0, 1, 4, 9, 16, 25, 36, 49, 64, 81, 100};
    const int i = (int)creal(at->x[0]), second = (int)creal(at->t);
    (void)data;
    outside += i < 0 || i >= entries || second < 0 || second > 5;
    const int k = i < 0 ? 0 : i >= entries ? entries - 1 : i;
    out->f[0] = at->u[0] + 0.001 * (table[k] + (at->x[0] - k) * (table[k + 1] - table[k]));
    out->g[0] = at->u[0] * at->u[0];
}

static void test_table(void)
{
    const moray_phase_spec phase = {.name = "climb",
                                    .nx = 1,
                                    .nu = 1,
                                    .nq = 1,
                                    .continuous = read_table,
                                    .tf = moray_fixed(5),
                                    .x = MORAY_BOUNDS(moray_between(0, 9.999)),
                                    .x0 = MORAY_BOUNDS(moray_fixed(0)),
                                    .xf = MORAY_BOUNDS(moray_fixed(9.9)),
                                    .u = MORAY_BOUNDS(moray_between(-5, 5))};
    moray_ocp *ocp;
    moray_solution *solution;
    moray_certificate c;
    moray_ocp_derivative_report report;
    moray_settings settings = moray_settings_default();
    settings.max_iterations = 30; // of no matter: kinks end the solve, and the diagnosis looks for a reason
    CHECK_OK(moray_ocp_new(
                 &ocp, &(moray_ocp_spec){.name = "table", .phases = 1, .phase = &phase, .endpoint = first_integral}),
             "table");
    CHECK_OK(moray_solve(ocp, &settings, NULL, &solution), "table");
    CHECK_OK(moray_certify(solution, &careful, &c), "table");
    CHECK_OK(moray_ocp_check_derivatives(ocp, &report), "table");
    CHECK(outside == 0, "asked outside the box %d times", outside);
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

// ---- From 1e9 s on, as clocks count: the integral of u^2 with x' = u sin(t - t0), x from 0 to 1 in 10 s, is
//      1 / the integral of sin^2 ----

static void wave(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = at->u[0] * sin(at->t - 1e9);
    out->g[0] = at->u[0] * at->u[0];
}

static void test_late(void)
{
    check(&(struct hostile){"from 1e9 s on",
                            {.name = "wave",
                             .nx = 1,
                             .nu = 1,
                             .nq = 1,
                             .continuous = wave,
                             .t0 = moray_fixed(1e9),
                             .tf = moray_fixed(1e9 + 10),
                             .x0 = MORAY_BOUNDS(moray_fixed(0)),
                             .xf = MORAY_BOUNDS(moray_fixed(1))},
                            first_integral,
                            0,
                            1 / (5 - sin(20) / 4),
                            1e-6});
}

// ---- A constraint whose values drown in an offset: its derivative is told by no difference, those of the rest are
// ----

static void drowned(const moray_node *at, moray_rates *out, const void *data)
{
    out->f[0] = at->u[0];
    out->c[0] = (*(const double *)data + at->u[0]) - *(const double *)data;
    out->g[0] = at->u[0] * at->u[0] * (1 + at->t);
}

static double untold(const double *offset)
{
    const moray_phase_spec phase = {.name = "walk",
                                    .nx = 1,
                                    .nu = 1,
                                    .nc = 1,
                                    .nq = 1,
                                    .continuous = drowned,
                                    .tf = moray_fixed(1),
                                    .x0 = MORAY_BOUNDS(moray_fixed(0)),
                                    .xf = MORAY_BOUNDS(moray_fixed(1)),
                                    .c = MORAY_BOUNDS(moray_between(-1e3, 1e3))};
    const moray_ocp_spec spec = {
        .name = "walk", .phases = 1, .phase = &phase, .endpoint = first_integral, .data = offset};
    moray_ocp *ocp;
    moray_solution *solution;
    moray_certificate c = {0};
    const moray_settings settings = moray_settings_default();
    CHECK_OK(moray_ocp_new(&ocp, &spec), "walk");
    CHECK_OK(moray_solve(ocp, &settings, NULL, &solution), "walk");
    CHECK_OK(moray_certify(solution, &careful, &c), "walk");
    moray_solution_free(solution);
    moray_ocp_free(ocp);
    return c.untold;
}

static void test_untold(void)
{
    const double none = 0, large = 1e12;
    CHECK(untold(&none) == 0, "every derivative is told");
    const double share = untold(&large); // of f by u, c by u, g by u and t at each node
    CHECK(share > 0.2 && share < 0.4, "one in three or four is not: %.3f", share);
}

// ---- Sizes 1e18 apart, told by one bound alone: u = 3 (1 - t), J = 3 ----

static void far_apart(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = 1e9 * at->u[0];
    out->f[1] = 1e-18 * at->x[0];
    out->g[0] = at->u[0] * at->u[0];
}

static void test_far_apart(void)
{
    check(&(struct hostile){"sizes of 1e9 and 1e-9",
                            {.name = "far apart",
                             .nx = 2,
                             .nu = 1,
                             .nq = 1,
                             .continuous = far_apart,
                             .tf = moray_fixed(1),
                             .x0 = MORAY_BOUNDS(moray_fixed(0), moray_fixed(0)),
                             .xf = MORAY_BOUNDS(moray_free(), moray_fixed(1e-9))},
                            first_integral,
                            0,
                            3,
                            1e-6});
}

// ---- A double well without bounds from the top between its sides, where x = u = 0 is stationary and J = 0: the top is
//      left; and with pow, which has no value where x is negative, its Hessian there is told to be none ----

static void well(const moray_node *at, moray_rates *out, const void *data)
{
    const moray_num x = at->x[0];
    (void)data;
    out->f[0] = at->u[0];
    out->g[0] = at->u[0] * at->u[0] + moray_pow(x, 4) - x * x;
}

static void well_of_pow(const moray_node *at, moray_rates *out, const void *data)
{
    const moray_num x = at->x[0];
    (void)data;
    out->f[0] = at->u[0];
    out->g[0] = at->u[0] * at->u[0] + pow(x, 4.0) - x * x;
}

static void test_well(moray_continuous_fn *continuous, bool has_values)
{
    const moray_phase_spec phase = {.nx = 1,
                                    .nu = 1,
                                    .nq = 1,
                                    .continuous = continuous,
                                    .tf = moray_fixed(10),
                                    .x0 = MORAY_BOUNDS(moray_fixed(0)),
                                    .xf = MORAY_BOUNDS(moray_fixed(0))};
    moray_ocp *ocp;
    moray_solution *solution;
    moray_certificate c;
    moray_settings settings = moray_settings_default();
    settings.max_refinements = 12;
    CHECK_OK(moray_ocp_new(&ocp, &(moray_ocp_spec){.phases = 1, .phase = &phase, .endpoint = first_integral}), "well");
    CHECK_OK(moray_solve(ocp, &settings, NULL, &solution), "well");
    CHECK_OK(moray_certify(solution, &careful, &c), "well");
    if (has_values)
        CHECK(moray_solution_objective(solution) < -1 && c.pass, "a well, left its top: %.6g %s",
              moray_solution_objective(solution), c.why);
    else
        CHECK(!c.pass && c.directions > MORAY_LIMIT_DIRECTIONS, "half a well: %.6g, %s",
              moray_solution_objective(solution), c.why);
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

int main(void)
{
    test_far_apart();
    test_well(well, true);
    test_well(well_of_pow, false);
    test_untold();
    test_late();
    test_dashes();
    test_cost("a cost of 1e-12", cheap, 1e-12);
    test_cost("a cost of 1e15", costly, 1e15);
    test_parameter();
    test_friction();
    test_table();
    return tap_done();
}
