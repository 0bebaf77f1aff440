// SPDX-License-Identifier: MIT
//
// What happens only between the nodes of the first meshes: refinement finds it, or the certificate says that it is
// there.
#include "tap.h"

#include <tgmath.h>

#include "moray/ocp.h"
#include "rk4.h"

static const int rk4_steps = 400;
static const moray_integrator rk4 = {rk4_run, &rk4_steps};

static const double middle = 4.95, narrow = 0.02;

static moray_num bump(moray_num at)
{
    return exp(-(at - middle) * (at - middle) / (narrow * narrow));
}

static void endpoint(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    const moray_num miss = at->phase[0].xf[0] - 1;
    out->objective = at->phase[0].q[0] + miss * miss;
}

static void first_integral(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase[0].q[0];
}

struct outcome {
    double objective;
    moray_certificate certificate;
};

static struct outcome solve(const moray_phase_spec *phase, moray_endpoint_fn *end, int refinements)
{
    moray_ocp *ocp = NULL;
    moray_solution *solution = NULL;
    struct outcome found = {0};
    moray_settings settings = moray_settings_default();
    settings.max_refinements = refinements;
    CHECK_OK(moray_ocp_new(&ocp, &(moray_ocp_spec){.phases = 1, .phase = phase, .endpoint = end}), phase->name);
    CHECK_OK(moray_solve(ocp, &settings, NULL, &solution), phase->name);
    CHECK_OK(moray_certify(solution, &rk4, &found.certificate), phase->name);
    found.objective = moray_solution_objective(solution);
    moray_solution_free(solution);
    moray_ocp_free(ocp);
    return found;
}

// Found with refinements; without, not certified.
static void check(const moray_phase_spec *phase, moray_endpoint_fn *end, double optimum)
{
    const struct outcome blind = solve(phase, end, 0), found = solve(phase, end, 40);
    CHECK(!blind.certificate.pass, "%s: %.8g on the first mesh, which fails: %s", phase->name, blind.objective,
          blind.certificate.why);
    CHECK(fabs(found.objective - optimum) < 3e-5 * fabs(optimum), "%s: %.8g, expected %.8g", phase->name,
          found.objective, optimum);
    CHECK(found.certificate.pass, "%s: %s", phase->name, found.certificate.why);
}

// ---- A control that acts only while w > 0: x' = w u, J = integral of u^2 / 100 + (x(10) - 1)^2 = 1 / (1 + 100 W) with
//      the integral W of w^2 ----

static void in_window(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    const double t = creal(at->t);
    out->f[0] = t >= 4.93 && t <= 4.97 ? at->u[0] : 0;
    out->g[0] = at->u[0] * at->u[0] / 100;
}

static void in_bump(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = bump(at->t) * at->u[0];
    out->g[0] = at->u[0] * at->u[0] / 100;
}

// The same where another state, which runs as time does, is within the window.
static void in_place(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = bump(at->x[1]) * at->u[0];
    out->f[1] = 1;
    out->g[0] = at->u[0] * at->u[0] / 100;
}

static void test_windows(void)
{
    const double W = narrow * sqrt(M_PI / 2);
    moray_phase_spec phase = {.name = "a window in time",
                              .nx = 1,
                              .nu = 1,
                              .nq = 1,
                              .continuous = in_window,
                              .tf = moray_fixed(10),
                              .x0 = MORAY_BOUNDS(moray_fixed(0)),
                              .u = MORAY_BOUNDS(moray_between(-100, 100))};
    check(&phase, endpoint, 1 / (1 + 100 * 0.04));
    phase.name = "a smooth window in time";
    phase.continuous = in_bump;
    check(&phase, endpoint, 1 / (1 + 100 * W));
    const moray_bounds start[] = {moray_fixed(0), moray_fixed(0)};
    phase.name = "a window in a state";
    phase.nx = 2;
    phase.continuous = in_place;
    phase.x0 = moray_bounds_of(start, 2);
    check(&phase, endpoint, 1 / (1 + 100 * W));
}

// ---- A prize that is paid within a moment: x' = u, J = integral of u^2 - 20 w x, which is minus the integral of
//      lambda^2 / 4 with lambda = -20 times what is left of the integral of w ----

static void prized(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = at->u[0];
    out->g[0] = at->u[0] * at->u[0] - 20 * bump(at->t) * at->x[0];
}

static double prize(void)
{
    enum { n = 200000 };
    double sum = 0;
    for (int k = 0; k < n; k++) {
        const double t = 10 * (k + 0.5) / n, left = 10 * narrow * sqrt(M_PI) * erfc((t - middle) / narrow);
        sum -= left * left / 4 * 10 / n;
    }
    return sum;
}

static void test_prize(void)
{
    const moray_phase_spec phase = {.name = "a prize of a moment",
                                    .nx = 1,
                                    .nu = 1,
                                    .nq = 1,
                                    .continuous = prized,
                                    .tf = moray_fixed(10),
                                    .x0 = MORAY_BOUNDS(moray_fixed(0)),
                                    .u = MORAY_BOUNDS(moray_between(-10, 10))};
    check(&phase, first_integral, prize());
}

// ---- A ceiling that comes down for a moment: x <= 1 - w / 2, J = integral of (x - 1)^2 + u^2 / 1e6 ----

static void under_ceiling(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = at->u[0];
    out->c[0] = at->x[0] + bump(at->t) / 2;
    out->g[0] = (at->x[0] - 1) * (at->x[0] - 1) + at->u[0] * at->u[0] / 1e6;
}

static void test_ceiling(void)
{
    const moray_phase_spec phase = {.name = "a ceiling",
                                    .nx = 1,
                                    .nu = 1,
                                    .nc = 1,
                                    .nq = 1,
                                    .continuous = under_ceiling,
                                    .tf = moray_fixed(10),
                                    .x0 = MORAY_BOUNDS(moray_fixed(1)),
                                    .c = MORAY_BOUNDS(moray_at_most(1))};
    const struct outcome blind = solve(&phase, first_integral, 0), found = solve(&phase, first_integral, 25);
    CHECK(!blind.certificate.pass && blind.certificate.between_nodes > 1e-2, "%.3g on the first mesh, which fails: %s",
          blind.objective, blind.certificate.why);
    CHECK(found.certificate.pass && found.objective > 1e-4, "%.6g once it is seen: %s", found.objective,
          found.certificate.why);
}

// ---- Light from (0, -1) to (2, 1) through two media: speed 1 below y = 0, 2 above. Least time by Fermat. The
// derivatives
//      on either side know nothing of where the surface is crossed ----

static void shine(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    const double speed = creal(at->x[1]) < 0 ? 1 : 2;
    out->f[0] = speed * cos(at->u[0]);
    out->f[1] = speed * sin(at->u[0]);
}

static void duration(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase[0].tf;
}

static double fermat(void)
{
    double least = INFINITY;
    for (int k = 0; k <= 20000; k++) {
        const double x = 2.0 * k / 20000;
        least = fmin(least, sqrt(1 + x * x) + sqrt(1 + (2 - x) * (2 - x)) / 2);
    }
    return least;
}

static void test_refraction(void)
{
    const moray_phase_spec phase = {.name = "light",
                                    .nx = 2,
                                    .nu = 1,
                                    .continuous = shine,
                                    .tf = moray_between(0.1, 10),
                                    .x0 = MORAY_BOUNDS(moray_fixed(0), moray_fixed(-1)),
                                    .xf = MORAY_BOUNDS(moray_fixed(2), moray_fixed(1)),
                                    .u = MORAY_BOUNDS(moray_between(0, M_PI / 2))};
    const struct outcome found = solve(&phase, duration, 25);
    const bool right = fabs(found.objective - fermat()) < 1e-5;
    CHECK(!found.certificate.pass, "light found %.8g, %s: %s", found.objective, right ? "right" : "wrong",
          found.certificate.why);
}

int main(void)
{
    test_windows();
    test_prize();
    test_ceiling();
    test_refraction();
    return tap_done();
}
