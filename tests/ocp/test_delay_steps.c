// SPDX-License-Identifier: MIT
//
// The functions and the bounds of all steps of a problem with delays, entry by entry: four steps of half a second, of
// two states, three controls and two path constraints, which know what came three and two steps before.
#include "tap.h"

#include <stdlib.h>
#include <string.h>

#include "moray/delay.h"
#include "ocp/problem.h"
#include "ocp/solution.h"

enum { nx = 2, nu = 3, nc = 2, steps = 4, x_delay = 3, u_delay = 2 };
static const double step = 0.5;

static double past_state(double t, int i)
{
    return 100 * t + i;
}

static double past_control(double t, int i)
{
    return -10 * t + 7 * i;
}

static void past(moray_num t, moray_num *x, moray_num *u, const void *data)
{
    (void)data;
    for (int i = 0; i < nx; i++)
        x[i] = past_state(creal(t), i);
    for (int i = 0; i < nu; i++)
        u[i] = past_control(creal(t), i);
}

// Tells what it was asked with.
static void echo(const moray_delay_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = at->x[0] + 2 * at->past_x[1] + 3 * at->u[2];
    out->f[1] = at->x[1] - at->past_x[0] + at->t;
    out->c[0] = at->u[0] + 5 * at->past_u[2];
    out->c[1] = at->u[1] * at->past_u[0] - at->past_u[1];
    out->g[0] = at->t * at->x[0];
}

static moray_num last(const moray_num *x, const void *data)
{
    (void)data;
    return x[0] - 2 * x[1];
}

static const moray_bounds x_bounds[] = {{-1, 2}, {-3, 4}}, x0_bounds[] = {{0, 1}, {1, 1}},
                          xf_bounds[] = {{2, 2}, {3, 4}}, u_bounds[] = {{-5, 6}, {-7, 8}, {-9, 10}},
                          c_bounds[] = {{-11, 12}, {-13, 14}};

static const moray_delay_spec usual = {.nx = nx,
                                       .nu = nu,
                                       .nc = nc,
                                       .step = 0.5,
                                       .steps = steps,
                                       .x_delay = x_delay,
                                       .u_delay = u_delay,
                                       .continuous = echo,
                                       .past = past,
                                       .final = last,
                                       .x = {x_bounds, nx},
                                       .x0 = {x0_bounds, nx},
                                       .xf = {xf_bounds, nx},
                                       .u = {u_bounds, nu},
                                       .c = {c_bounds, nc}};

static moray_delay *make(const moray_delay_spec *spec)
{
    moray_delay *delay = NULL;
    CHECK_OK(moray_delay_new(&delay, spec), "problem");
    return delay;
}

// ---- Functions: inputs are u[i] of step k or x[i] of step k, before step 0 the past ----

static double state(const double *in, int k, int i, double t)
{
    return k >= 0 ? in[k * nx + i] : past_state(t, i);
}

static double control(const double *in, int k, int i, double t)
{
    return k >= 0 ? in[steps * nx + k * nu + i] : past_control(t, i);
}

static void test_functions(void)
{
    moray_delay *delay = make(&usual);
    const moray_map *map = moray_delay_ocp(delay)->phase[0].map;
    double in[steps * (nx + nu) + 1], out[steps * (nx + nc) + 1], integrand = 0;
    CHECK(map->n_in == steps * (nx + nu) + 1 && map->n_out == steps * (nx + nc) + 1, "%d inputs, %d outputs", map->n_in,
          map->n_out);
    for (int i = 0; i < steps * (nx + nu); i++)
        in[i] = 1 + i * i % 17 + i / 8.;
    in[steps * (nx + nu)] = 0.375;
    map->value(map->self, in, out);
    for (int k = 0; k < steps; k++) {
        const double t = 0.375 + 0.5 * k, tx = t - 1.5, tu = t - 1;
        const double f[nx] = {state(in, k, 0, t) + 2 * state(in, k - x_delay, 1, tx) + 3 * control(in, k, 2, t),
                              state(in, k, 1, t) - state(in, k - x_delay, 0, tx) + t};
        const double c[nc] = {control(in, k, 0, t) + 5 * control(in, k - u_delay, 2, tu),
                              control(in, k, 1, t) * control(in, k - u_delay, 0, tu) - control(in, k - u_delay, 1, tu)};
        for (int i = 0; i < nx; i++)
            CHECK_NEAR(out[k * nx + i], f[i], 1e-9, "a rate");
        for (int i = 0; i < nc; i++)
            CHECK_NEAR(out[steps * nx + k * nc + i], c[i], 1e-9, "a path constraint");
        integrand += t * state(in, k, 0, t);
    }
    CHECK_NEAR(out[steps * (nx + nc)], integrand, 1e-9, "the integrands of all steps are added up");
    moray_delay_free(delay);
}

static void test_objective(void)
{
    moray_delay *delay = make(&usual);
    const moray_map *map = moray_delay_ocp(delay)->endpoint->map;
    double in[100], out[1 + nx * (steps - 1)];
    for (int i = 0; i < map->n_in; i++)
        in[i] = 1 + i * i % 19;
    map->value(map->self, in, out);
    const double *xf = in + steps * nx + 1, q = in[2 * steps * nx + 2];
    CHECK_NEAR(out[0], q + xf[6] - 2 * xf[7], 1e-12, "what the last step ends with is added to the integral");
    for (int i = 0; i < nx * (steps - 1); i++)
        CHECK_NEAR(out[1 + i], in[nx + i] - xf[i], 1e-12, "a step begins where the one before it ends");
    moray_delay_free(delay);
}

// ---- Bounds ----

static bool same(moray_bounds one, moray_bounds other)
{
    return one.lower == other.lower && one.upper == other.upper;
}

static moray_bounds meet(moray_bounds one, moray_bounds other)
{
    return moray_between(fmax(one.lower, other.lower), fmin(one.upper, other.upper));
}

static void test_bounds(void)
{
    moray_delay *delay = make(&usual);
    const moray_ocp *ocp = moray_delay_ocp(delay);
    const struct phase *phase = &ocp->phase[0];
    CHECK(phase->nx == steps * nx && phase->nu == steps * nu && phase->nc == steps * nc && phase->nq == 1, "sizes");
    CHECK(same(phase->t0, moray_fixed(0)) && same(phase->tf, moray_fixed(step)), "all steps at once");
    for (int k = 0; k < steps; k++) {
        for (int i = 0; i < nx; i++) {
            CHECK(same(phase->x[k * nx + i], x_bounds[i]), "state %d of step %d", i, k);
            CHECK(same(phase->x0[k * nx + i], k == 0 ? meet(x_bounds[i], x0_bounds[i]) : x_bounds[i]),
                  "its start alone has bounds of its own");
            CHECK(same(phase->xf[k * nx + i], k == steps - 1 ? meet(x_bounds[i], xf_bounds[i]) : x_bounds[i]),
                  "so has its end");
        }
        for (int i = 0; i < nu; i++)
            CHECK(same(phase->u[k * nu + i], u_bounds[i]), "control %d of step %d", i, k);
        for (int i = 0; i < nc; i++)
            CHECK(same(phase->c[k * nc + i], c_bounds[i]), "path constraint %d of step %d", i, k);
    }
    CHECK(ocp->ne == nx * (steps - 1), "joins");
    for (int i = 0; i < ocp->ne; i++)
        CHECK(same(ocp->e[i], moray_fixed(0)), "a step begins where the one before it ends");
    moray_delay_free(delay);
}

// ---- At a time ----

static void test_at(void)
{
    moray_delay_spec spec = usual;
    spec.u.n = 0; // a control is told within its bounds
    moray_delay *delay = make(&spec);
    moray_solution *solution = NULL;
    moray_settings settings = moray_settings_default();
    settings.max_iterations = 0;
    settings.scheme = "radau2";
    settings.intervals = 1;
    CHECK_OK(moray_solve(moray_delay_ocp(delay), &settings, NULL, &solution), "begun");
    const struct phase_layout *layout = &solution->transcription->layout.phase[0];
    // A state of step k is 10 k + i + its time, a control -(10 k + i) - its time, which the polynomials hold.
    for (int n = 0; n < layout->nodes; n++)
        for (int r = 0; r < steps * nx + (layout->node[n].collocated ? steps * nu : 0); r++) {
            const int c = r - steps * nx, width = c < 0 ? nx : nu, entry = c < 0 ? r : c;
            const double value = 10 * (entry / width) + entry % width + layout->node[n].tau * step;
            solution->iterate.x[layout->node[n].x + r] = c < 0 ? value : -value;
        }
    struct transcription *t = solution->transcription;
    for (int n = 0; n < layout->nodes; n++) // slopes of 1, which the polynomials of states go by
        for (int r = 0; r < steps * nx; r++)
            t->phase[0].out[n * t->phase[0].map->n_out + r] = 1;
    static const double times[] = {-1, 0, 0.25, 0.5, 0.75, 1, 1.25, 1.5, 1.75, 2, 3};
    for (size_t i = 0; i < sizeof times / sizeof *times; i++) {
        const double time = times[i];
        const int k = time <= 0.5 ? 0 : time <= 1 ? 1 : time <= 1.5 ? 2 : 3;
        const double inside = fmin(fmax(time - 0.5 * k, 0), 0.5);
        double x[nx] = {NAN, NAN}, u[nu] = {NAN, NAN, NAN}, again = NAN;
        CHECK_OK(moray_delay_at(delay, solution, time, x, u), "at a time");
        for (int r = 0; r < nx; r++)
            CHECK(fabs(x[r] - (10 * k + r + inside)) < 1e-12, "state %d at %g: %g", r, time, x[r]);
        for (int r = 0; r < nu; r++)
            CHECK(fabs(u[r] + (10 * k + r + inside)) < 1e-12, "control %d at %g: %g", r, time, u[r]);
        double whole[nu] = {NAN, NAN, NAN};
        CHECK_OK(moray_delay_at(delay, solution, time, NULL, whole), "the control alone");
        again = whole[2];
        CHECK(again == u[2], "is the same");
    }
    moray_solution_free(solution);
    moray_delay_free(delay);
}

// ---- What is allowed and what not ----

static void check_text(moray_delay_spec spec, const char *text)
{
    moray_delay *delay = NULL;
    const moray_status status = moray_delay_new(&delay, &spec);
    CHECK(text ? status.code == MORAY_INPUT && !delay && strcmp(status.text, text) == 0 : status.code == MORAY_OK, "%s",
          status.text);
    moray_delay_free(delay);
}

static void alone(const moray_delay_node *at, moray_rates *out, const void *data)
{
    (void)data;
    for (int i = 0; i < nx; i++)
        out->f[i] = at->x[i];
    out->g[0] = at->x[0];
}

static void test_allowed(void)
{
    moray_delay_spec spec = usual;
    spec.x_delay = spec.u_delay = steps;
    check_text(spec, NULL);
    const moray_delay_spec least = {.nx = nx, .step = 1, .steps = 1, .continuous = alone};
    check_text(least, NULL);
}

static void test_refused(void)
{
    moray_delay_spec spec = usual;
    spec.nx = 0, check_text(spec, "nx 0, nu 3, nc 2: nx must be positive, none negative");
    spec = usual, spec.nu = -1, check_text(spec, "nx 2, nu -1, nc 2: nx must be positive, none negative");
    spec = usual, spec.nc = -1, check_text(spec, "nx 2, nu 3, nc -1: nx must be positive, none negative");
    spec = usual, spec.step = INFINITY;
    check_text(spec, "4 steps of inf: must be at least 1, of positive length");
    spec = usual, spec.step = 0, check_text(spec, "4 steps of 0: must be at least 1, of positive length");
    spec = usual, spec.steps = 0, spec.x_delay = spec.u_delay = 0;
    check_text(spec, "0 steps of 0.5: must be at least 1, of positive length");
    spec = usual, spec.x_delay = -1, check_text(spec, "delays of -1 and 2 steps: must be 0 to 4");
    spec = usual, spec.x_delay = 5, check_text(spec, "delays of 5 and 2 steps: must be 0 to 4");
    spec = usual, spec.u_delay = -1, check_text(spec, "delays of 3 and -1 steps: must be 0 to 4");
    spec = usual, spec.u_delay = 5, check_text(spec, "delays of 3 and 5 steps: must be 0 to 4");
    static const char *const needs = "needs a continuous function, and with a delay the past";
    spec = usual, spec.continuous = NULL, check_text(spec, needs);
    spec = usual, spec.past = NULL, spec.x_delay = 0, check_text(spec, needs);
    spec = usual, spec.past = NULL, spec.u_delay = 0, check_text(spec, needs);
    spec = usual, spec.x.n = 1, check_text(spec, "x: 1 bounds given, 2 needed");
    spec = usual, spec.x0.n = 1, check_text(spec, "x0: 1 bounds given, 2 needed");
    spec = usual, spec.xf.n = 1, check_text(spec, "xf: 1 bounds given, 2 needed");
    spec = usual, spec.u.n = 1, check_text(spec, "u: 1 bounds given, 3 needed");
    spec = usual, spec.c.n = 0, check_text(spec, "c: 0 bounds given, 2 needed");
}

int main(void)
{
    test_functions();
    test_objective();
    test_bounds();
    test_at();
    test_allowed();
    test_refused();
    return tap_done();
}
