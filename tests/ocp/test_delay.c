// SPDX-License-Identifier: MIT
//
// Delays against a published optimum, and against a delay equation in closed form.
#include "tap.h"

#include <string.h>

#include "moray/delay.h"
#include "ocp/problem.h"
#include "rk4.h"

static const int rk4_steps = 20;
static const moray_integrator rk4 = {rk4_run, &rk4_steps};
static const moray_bounds one[] = {{1, 1}};

static void ones(moray_num t, moray_num *x, moray_num *u, const void *data)
{
    (void)t;
    (void)data;
    x[0] = 1;
    u[0] = 0;
}

static moray_solution *solve(const moray_delay *delay)
{
    moray_settings settings = moray_settings_default();
    settings.scheme = "radau5"; // a polynomial of each interval tells the control well
    settings.intervals = 6;
    moray_solution *solution;
    moray_certificate certificate;
    CHECK_OK(moray_solve(moray_delay_ocp(delay), &settings, NULL, &solution), "solve");
    CHECK(moray_solution_info(solution)->outcome == MORAY_NLP_SOLVED, "%s", moray_solution_diagnosis(solution));
    CHECK_OK(moray_certify(solution, &rk4, &certificate), "certificate");
    CHECK(certificate.pass, "passes: %s", certificate.why);
    return solution;
}

// x' = x(t - 1) u(t - 2), x = 1 and u = 0 before 0, least integral of x^2 + u^2 up to 3. Goellmann, Kern & Maurer 2009,
// Optim. Control Appl. Meth. 30, sec. 6: 2 + tanh 1, u = -sinh(1 - t) / cosh 1 ... up to t = 1, then 0.
static void product(const moray_delay_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = at->past_x[0] * at->past_u[0];
    out->g[0] = at->x[0] * at->x[0] + at->u[0] * at->u[0];
}

static void test_published(void)
{
    moray_delay *delay;
    double x, u;
    CHECK_OK(moray_delay_new(&delay, &(moray_delay_spec){.nx = 1,
                                                         .nu = 1,
                                                         .step = 1,
                                                         .steps = 3,
                                                         .x_delay = 1,
                                                         .u_delay = 2,
                                                         .continuous = product,
                                                         .past = ones,
                                                         .x0 = {one, 1}}),
             "problem");
    moray_solution *solution = solve(delay);
    CHECK_RELATIVE(moray_solution_objective(solution), 2 + tanh(1), 1e-7, "published optimum");
    for (double t = 0; t <= 3; t += 0.25) {
        CHECK_OK(moray_delay_at(delay, solution, t, &x, &u), "at a time");
        CHECK_NEAR(x, t <= 2 ? 1 : cosh(3 - t) / cosh(1), 1e-6, "state");
        CHECK_NEAR(u, t <= 1 ? -sinh(1 - t) / cosh(1) : 0, 1e-4, "control");
    }
    moray_solution_free(solution);
    moray_delay_free(delay);
}

// x' = -x(t - 1), x = 1 before 0: 1 - t, then 1 - t + (t - 1)^2 / 2.
static void decay(const moray_delay_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = -at->past_x[0];
    out->g[0] = at->u[0] * at->u[0];
}

static moray_num last(const moray_num *x, const void *data)
{
    (void)data;
    return 3 * x[0];
}

static void apart(const moray_delay_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = at->x[1] + at->u[0];
    out->f[1] = -at->x[0];
}

static void test_equation(void)
{
    moray_delay *delay;
    double x;
    const moray_delay_spec spec = {.nx = 1,
                                   .nu = 1,
                                   .step = 1,
                                   .steps = 2,
                                   .x_delay = 1,
                                   .continuous = decay,
                                   .past = ones,
                                   .final = last,
                                   .x0 = {one, 1}};
    CHECK_OK(moray_delay_new(&delay, &spec), "problem");
    moray_solution *solution = solve(delay);
    CHECK_NEAR(moray_solution_objective(solution), 3 * -0.5, 1e-8, "final cost");
    for (double t = 0; t <= 2; t += 0.125) {
        CHECK_OK(moray_delay_at(delay, solution, t, &x, NULL), "at a time");
        CHECK_NEAR(x, 1 - t + (t > 1 ? (t - 1) * (t - 1) / 2 : 0), 1e-8, "state");
    }
    moray_solution_free(solution);
    moray_delay_free(delay);
}

// Three steps of two states: the end of each is the start of the next, and nothing is written behind these rows.
static void test_joins(void)
{
    enum { nx = 2, steps = 3, joins = nx * (steps - 1) };
    moray_delay *delay;
    const moray_delay_spec spec = {.nx = nx, .nu = 1, .step = 1, .steps = steps, .continuous = apart};
    const moray_num x0[] = {1, 2, 3, 4, 5, 6}, xf[] = {10, 20, 30, 40, 50, 60}, q[] = {0};
    const moray_num want[] = {3 - 10, 4 - 20, 5 - 30, 6 - 40, 7};
    moray_num e[joins + 1] = {[joins] = 7};
    const moray_phase_ends phase = {.x0 = x0, .xf = xf, .t0 = 0, .tf = 1, .q = q};
    const moray_ends ends = {.phase = &phase};
    moray_end_values out = {.e = e};
    CHECK_OK(moray_delay_new(&delay, &spec), "problem");
    const moray_ocp *ocp = moray_delay_ocp(delay);
    CHECK(ocp->ne == joins, "%d rows", ocp->ne);
    ocp->endpoint_fn(&ends, &out, ocp->data);
    for (int i = 0; i <= joins; i++)
        CHECK(e[i] == want[i], "row %d: %g", i, creal(e[i]));
    moray_delay_free(delay);
}

static void refuses(moray_delay_spec spec, const char *says)
{
    moray_delay *delay;
    const moray_status status = moray_delay_new(&delay, &spec);
    CHECK(status.code == MORAY_INPUT && !delay && strstr(status.text, says), "%s", status.text);
}

static void test_refusals(void)
{
    const moray_delay_spec good = {
        .nx = 1, .nu = 1, .step = 1, .steps = 2, .x_delay = 1, .continuous = decay, .past = ones};
    moray_delay_spec spec = good;
    spec.nx = 0;
    refuses(spec, "nx 0");
    spec = good, spec.step = 0;
    refuses(spec, "2 steps of 0");
    spec = good, spec.x_delay = 3;
    refuses(spec, "delays of 3 and 0 steps: must be 0 to 2");
    spec = good, spec.past = NULL;
    refuses(spec, "the past");
    spec = good, spec.nc = 1;
    refuses(spec, "c: 0 bounds given, 1 needed");
    spec = good, spec.u = (moray_bounds_list){one, 2};
    refuses(spec, "u: 2 bounds given, 1 needed");
    spec = good, spec.x0 = moray_bounds_of((const moray_bounds[]){{2, 1}}, 1);
    refuses(spec, "lower bound 2 is above");
    moray_delay_free(NULL);
}

int main(void)
{
    test_published();
    test_equation();
    test_joins();
    test_refusals();
    return tap_done();
}
