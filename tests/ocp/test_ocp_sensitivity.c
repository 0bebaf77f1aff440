// SPDX-License-Identifier: MIT
//
// Sensitivities of optimal-control problems: the cart moved from rest to rest, of which all is known in closed form,
// and a nonlinear problem solved again beside its parameter.
#include "tap.h"

#include <string.h>

#include "moray/sensitivity.h"

enum { DISTANCE, START, END, GAIN, LIMIT, PARAMETERS };

// A cart moved by d in T from rest to rest at least effort: x' = v, v' = b u, |u| <= U, of the control or along the
// path.
//   u = 6 d/(b T²) (1 - 2 t/T),  J = integral of u² = 12 d²/(b² T³)
struct cart {
    double p[PARAMETERS];
    bool free_time; // then T is chosen for least T + J/2: T⁴ = 18 d²/b²
    bool by_path;   // which has the limit
};

static void move(const moray_node *at, moray_rates *out, const void *data)
{
    const struct cart *cart = data;
    out->f[0] = at->x[1];
    out->f[1] = cart->p[GAIN] * at->u[0];
    out->g[0] = at->u[0] * at->u[0];
    if (cart->by_path)
        out->c[0] = at->u[0];
}

static void pay(const moray_ends *at, moray_end_values *out, const void *data)
{
    const struct cart *cart = data;
    out->objective = cart->free_time ? at->phase[0].tf + at->phase[0].q[0] / 2 : at->phase[0].q[0];
}

static moray_ocp *cart_ocp(const struct cart *cart)
{
    static const char *const u_names[] = {"push"};
    const moray_bounds limit[] = {moray_between(-cart->p[LIMIT], cart->p[LIMIT])}, any[] = {moray_free()};
    moray_ocp *ocp;
    const moray_phase_spec phase = {
        .name = "cart",
        .nx = 2,
        .nu = 1,
        .nq = 1,
        .nc = cart->by_path,
        .continuous = move,
        .t0 = moray_fixed(cart->p[START]),
        .tf = cart->free_time ? moray_between(0.1, 100) : moray_fixed(cart->p[END]),
        .x0 = MORAY_BOUNDS(moray_fixed(0), moray_fixed(0)),
        .xf = MORAY_BOUNDS(moray_fixed(cart->p[DISTANCE]), moray_fixed(0)),
        .u = {cart->by_path ? any : limit, 1},
        .c = {limit, cart->by_path},
        .u_names = u_names,
    };
    CHECK_OK(moray_ocp_new(
                 &ocp, &(moray_ocp_spec){.name = "cart", .phases = 1, .phase = &phase, .endpoint = pay, .data = cart}),
             "cart");
    return ocp;
}

static moray_settings tight(void)
{
    moray_settings settings = moray_settings_default();
    settings.tolerance = 1e-11;
    settings.intervals = 6;
    return settings;
}

static void by(moray_sensitivity *s, const struct cart *cart, int parameter, double h)
{
    struct cart displaced[4];
    moray_ocp *ocp[4];
    for (int k = 0; k < 4; k++) {
        displaced[k] = *cart;
        displaced[k].p[parameter] += (k < 2 ? k - 2 : k - 1) * h;
        ocp[k] = cart_ocp(&displaced[k]);
    }
    CHECK_OK(moray_sensitivity_by(s, (const moray_ocp *const *)ocp, h), "by a parameter");
    for (int k = 0; k < 4; k++)
        moray_ocp_free(ocp[k]);
}

static void check_prediction(moray_sensitivity *s, const struct cart *cart, double step)
{
    struct cart target = *cart;
    moray_solution *predicted;
    double u, x[2], t0, tf;
    target.p[DISTANCE] += step;
    moray_ocp *ocp = cart_ocp(&target);
    CHECK_OK(moray_sensitivity_predict(s, ocp, step, &predicted), "prediction");
    const double d = target.p[DISTANCE], b = target.p[GAIN], T = target.p[END];
    for (double t = 0.1; t < T; t += 0.3) {
        moray_solution_at(predicted, 0, t, x, &u);
        CHECK_NEAR(u, 6 * d / (b * T * T) * (1 - 2 * t / T), 1e-8, "predicted push, linear in the distance");
        CHECK_NEAR(x[0], d * t * t / (T * T) * (3 - 2 * t / T), 1e-8, "predicted way");
    }
    double time[100], costate[200], off = 0;
    const int nodes = moray_solution_nodes(predicted, 0, time, costate);
    for (int n = 0; n < nodes; n++) {
        off = tap_worse(off, fabs(costate[2 * n] + 24 * d / (b * b * T * T * T)));
        off = tap_worse(off, fabs(costate[2 * n + 1] + 12 * d / (b * b * T * T) * (1 - 2 * time[n] / T)));
    }
    CHECK(off < 1e-7, "predicted costates, linear in the distance, to %.1e", off);
    moray_solution_times(predicted, 0, &t0, &tf);
    CHECK_NEAR(tf, T, 1e-14, "in its time");
    CHECK(moray_solution_info(predicted)->outcome == MORAY_NLP_ITERATION_LIMIT &&
              moray_solution_info(predicted)->iterations == 0,
          "nothing was solved, and it says so");
    const double *q = moray_solution_integrals(predicted, 0), J = 12 * d * d / (b * b * T * T * T);
    CHECK(q[0] < J && q[0] > J * (1 - 1.1 * step * step / (d * d)), "the effort is that of the tangent: %g of %g", q[0],
          J);
    CHECK_NEAR(moray_solution_objective(predicted), q[0], 1e-15, "and is the objective");
    moray_solution_free(predicted);
    moray_ocp_free(ocp);
}

static void test_fixed_time(void)
{
    const double d = 2, T = 1.5, b = 0.8, U = 8, J = 12 * d * d / (b * b * T * T * T);
    const struct cart cart = {.p = {d, 0, T, b, U}};
    moray_ocp *ocp = cart_ocp(&cart);
    const moray_settings settings = tight();
    moray_solution *solution;
    moray_sensitivity *s;
    double x0[2], xf[2], t0, tf;
    CHECK_OK(moray_solve(ocp, &settings, NULL, &solution), "solve");
    CHECK_NEAR(moray_solution_objective(solution), J, 1e-8, "the least effort");
    CHECK_OK(moray_sensitivity_new(&s, solution), "sensitivities");
    CHECK(moray_sensitivity_weak(s)[0] == 0, "no doubt of what is active");
    const double want[] = {2 * J / d, 3 * J / T, -3 * J / T, -2 * J / b, 0};
    const char *const names[] = {"distance, a bound", "start, a fixed time", "end, another", "gain, in the dynamics",
                                 "limit, not reached"};
    for (int parameter = 0; parameter < PARAMETERS; parameter++) {
        by(s, &cart, parameter, 2e-3 * (parameter == START ? T : cart.p[parameter]));
        CHECK_NEAR(moray_sensitivity_objective(s), want[parameter], 1e-8 * J, names[parameter]);
        CHECK_NEAR(moray_sensitivity_integrals(s, 0)[0], want[parameter], 1e-8 * J, "and the integral with it");
        moray_sensitivity_ends(s, 0, x0, xf);
        moray_sensitivity_times(s, 0, &t0, &tf);
        CHECK_NEAR(xf[0], parameter == DISTANCE, 1e-12, "where it ends");
        CHECK_NEAR(x0[0], 0, 1e-12, "where it starts");
        CHECK_NEAR(tf, parameter == END, 1e-12, "when");
        CHECK_NEAR(t0, parameter == START, 1e-12, "from when");
    }
    by(s, &cart, DISTANCE, 4e-3);
    const moray_active_change more = moray_sensitivity_change(s, 1), less = moray_sensitivity_change(s, -1);
    CHECK_NEAR(more.step, U * b * T * T / 6 - d, 1e-7, "the push reaches its limit");
    CHECK(strstr(more.what, "control push of phase cart") && strstr(more.what, "would pass its"), "%s", more.what);
    CHECK(less.step < -2 * d, "a shorter way changes nothing: %g %s", less.step, less.what);
    check_prediction(s, &cart, 0.2);
    moray_sensitivity_free(s);
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

static double least(const struct cart *cart)
{
    moray_ocp *ocp = cart_ocp(cart);
    const moray_settings settings = tight();
    moray_solution *solution;
    CHECK_OK(moray_solve(ocp, &settings, NULL, &solution), "solve");
    const double objective = moray_solution_objective(solution);
    moray_solution_free(solution);
    moray_ocp_free(ocp);
    return objective;
}

// The limit as bounds of the control and as a path constraint: how far it is, and what it costs on both of its sides.
static void test_limit(bool by_path)
{
    const double d = 2, T = 1.5, b = 0.8, U = 6 * d / (b * T * T), h = 1e-3;
    const double of_limit[] = {1.3, 0.8}; // beyond what is asked for, and short of it
    for (int k = 0; k < 2; k++) {
        const struct cart cart = {.p = {d, 0, T, b, of_limit[k] * U}, .by_path = by_path};
        struct cart more = cart, less = cart;
        moray_ocp *ocp = cart_ocp(&cart);
        const moray_settings settings = tight();
        moray_solution *solution;
        moray_sensitivity *s;
        CHECK_OK(moray_solve(ocp, &settings, NULL, &solution), "solve");
        CHECK_OK(moray_sensitivity_new(&s, solution), "sensitivities");
        by(s, &cart, LIMIT, h);
        more.p[LIMIT] += h;
        less.p[LIMIT] -= h;
        const double slope = (least(&more) - least(&less)) / (2 * h);
        CHECK((k == 1) == (slope < -1), "reached or not: slope %g", slope);
        CHECK_NEAR(moray_sensitivity_objective(s), slope, 1e-5, "slope by the limit, solved again");
        const moray_active_change change = moray_sensitivity_change(s, -1);
        if (k == 0) {
            CHECK_NEAR(change.step, U - cart.p[LIMIT], 1e-7, "the limit comes down to the push");
            CHECK(isinf(moray_sensitivity_change(s, 1).step), "and never by going up");
        }
        moray_sensitivity_free(s);
        moray_solution_free(solution);
        moray_ocp_free(ocp);
    }
}

static void test_free_time(void)
{
    const double d = 2, b = 0.8, T = pow(18 * d * d / (b * b), 0.25);
    const struct cart cart = {.p = {d, 0, 0, b, 100}, .free_time = true};
    moray_ocp *ocp = cart_ocp(&cart);
    const moray_settings settings = tight();
    moray_solution *solution;
    moray_sensitivity *s;
    double t0, tf;
    CHECK_OK(moray_solve(ocp, &settings, NULL, &solution), "solve");
    CHECK_OK(moray_sensitivity_new(&s, solution), "sensitivities");
    by(s, &cart, DISTANCE, 4e-3);
    moray_sensitivity_times(s, 0, &t0, &tf);
    CHECK_NEAR(tf, T / (2 * d), 1e-8, "d T / d distance");
    CHECK_NEAR(moray_sensitivity_objective(s), 12 * d / (b * b * T * T * T), 1e-8, "d J / d distance");
    by(s, &cart, GAIN, 2e-3);
    moray_sensitivity_times(s, 0, &t0, &tf);
    CHECK_NEAR(tf, -T / (2 * b), 1e-8, "d T / d gain");
    moray_sensitivity_free(s);
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

// ---- x' = s - p x² + u, x(0) = 1; least integral of x² + u², and s² + p s + p³ ------------------------------------

static void decay(const moray_node *at, moray_rates *out, const void *data)
{
    const double p = *(const double *)data;
    out->f[0] = at->s[0] - p * at->x[0] * at->x[0] + at->u[0];
    out->g[0] = at->x[0] * at->x[0] + at->u[0] * at->u[0];
}

static void add_square(const moray_ends *at, moray_end_values *out, const void *data)
{
    const double p = *(const double *)data;
    out->objective = at->phase[0].q[0] + at->s[0] * (at->s[0] + p) + p * p * p;
}

static moray_ocp *decay_ocp(const double *p, int integrals)
{
    moray_ocp *ocp;
    const moray_phase_spec phase = {.name = "decay",
                                    .nx = 1,
                                    .nu = 1,
                                    .nq = 1,
                                    .nc = integrals - 1,
                                    .continuous = decay,
                                    .t0 = moray_fixed(0),
                                    .tf = moray_fixed(1),
                                    .x0 = MORAY_BOUNDS(moray_fixed(1)),
                                    .c = {(moray_bounds[]){{-1, 1}}, integrals - 1}};
    CHECK_OK(moray_ocp_new(&ocp, &(moray_ocp_spec){.name = "decay",
                                                   .phases = 1,
                                                   .ns = 1,
                                                   .s = MORAY_BOUNDS(moray_between(-5, 5)),
                                                   .phase = &phase,
                                                   .endpoint = add_square,
                                                   .data = p}),
             "decay");
    return ocp;
}

static void test_again(void)
{
    const double h = 1e-3, p[] = {0.7 - 2 * h, 0.7 - h, 0.7 + h, 0.7 + 2 * h, 0.7};
    const moray_settings settings = tight();
    moray_ocp *ocp[5];
    moray_solution *solution[5];
    moray_sensitivity *s;
    for (int k = 0; k < 5; k++) {
        ocp[k] = decay_ocp(&p[k], 1);
        CHECK_OK(moray_solve(ocp[k], &settings, NULL, &solution[k]), "solve");
    }
    CHECK_OK(moray_sensitivity_new(&s, solution[4]), "sensitivities");
    CHECK_OK(moray_sensitivity_by(s, (const moray_ocp *const *)ocp, h), "by p");
    const double dJ = (moray_solution_objective(solution[2]) - moray_solution_objective(solution[1])) / (2 * h);
    const double ds = (moray_solution_parameters(solution[2])[0] - moray_solution_parameters(solution[1])[0]) / (2 * h);
    CHECK(fabs(ds) > 1e-3, "the parameter moves: %g", ds);
    CHECK_NEAR(moray_sensitivity_objective(s), dJ, 1e-6, "objective, solved again");
    CHECK_NEAR(moray_sensitivity_parameters(s)[0], ds, 1e-6, "parameter, solved again");
    double xf, x0, end[2];
    moray_sensitivity_ends(s, 0, &x0, &xf);
    for (int k = 0; k < 2; k++)
        moray_solution_at(solution[1 + k], 0, 1, &end[k], NULL);
    CHECK_NEAR(xf, (end[1] - end[0]) / (2 * h), 1e-6, "final state, solved again");

    // what is refused
    moray_solution *stopped;
    moray_sensitivity *none;
    moray_settings impatient = settings;
    impatient.max_iterations = 1;
    CHECK_OK(moray_solve(ocp[4], &impatient, NULL, &stopped), "stopped early");
    moray_status status = moray_sensitivity_new(&none, stopped);
    CHECK(status.code == MORAY_NOT_SOLVED && !none && strstr(status.text, "iteration limit"), "%s", status.text);
    status = moray_sensitivity_by(s, (const moray_ocp *const *)ocp, 0);
    CHECK(status.code == MORAY_INPUT && strstr(status.text, "h = 0"), "%s", status.text);
    moray_ocp *right = ocp[2], *other = decay_ocp(&p[2], 2);
    ocp[2] = other;
    status = moray_sensitivity_by(s, (const moray_ocp *const *)ocp, h);
    CHECK(status.code == MORAY_INPUT && strstr(status.text, "displaced problem has"), "%s", status.text);
    double wild = 0.7;
    moray_ocp *undefined = decay_ocp(&wild, 1);
    wild = NAN;
    ocp[2] = undefined;
    status = moray_sensitivity_by(s, (const moray_ocp *const *)ocp, h);
    CHECK(status.code == MORAY_NUMERIC && strstr(status.text, "in a displaced problem, "), "%s", status.text);
    ocp[2] = right;
    moray_solution *predicted;
    status = moray_sensitivity_predict(s, undefined, h, &predicted);
    CHECK(status.code == MORAY_NUMERIC && !predicted, "%s", status.text);
    moray_ocp_free(undefined);
    moray_ocp_free(other);
    moray_solution_free(stopped);
    moray_sensitivity_free(s);
    for (int k = 0; k < 5; k++) {
        moray_solution_free(solution[k]);
        moray_ocp_free(ocp[k]);
    }
}

// A limit that is just touched.
static void test_weak(void)
{
    const double d = 2, T = 1.5, b = 0.8;
    const struct cart cart = {.p = {d, 0, T, b, 6 * d / (b * T * T)}};
    moray_ocp *ocp = cart_ocp(&cart);
    const moray_settings settings = tight();
    moray_solution *solution;
    moray_sensitivity *s;
    CHECK_OK(moray_solve(ocp, &settings, NULL, &solution), "solve");
    CHECK_OK(moray_sensitivity_new(&s, solution), "sensitivities");
    CHECK(strstr(moray_sensitivity_weak(s), "control push of phase cart at t = 0;") &&
              strstr(moray_sensitivity_weak(s), "control push of phase cart at t = 1.5"),
          "in doubt: %s", moray_sensitivity_weak(s));
    moray_sensitivity_free(s);
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

int main(void)
{
    test_fixed_time();
    test_limit(false);
    test_limit(true);
    test_free_time();
    test_again();
    test_weak();
    return tap_done();
}
