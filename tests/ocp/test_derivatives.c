// SPDX-License-Identifier: MIT
//
// Problems of code that knows only double, and the check that names a wrong derivative.
#include "tap.h"

#include <stdlib.h>
#include <string.h>
#include <tgmath.h>

#include "moray/ocp.h"

// ---- Brachistochrone (Bryson & Ho 2.7) in real numbers: 1.80160312 s ----

static void slide(const moray_real_node *at, moray_real_rates *out, const void *data)
{
    out->f[0] = at->x[2] * sin(at->u[0]);
    out->f[1] = -at->x[2] * cos(at->u[0]);
    out->f[2] = *(const double *)data * cos(at->u[0]);
}
static void arrival(const moray_real_ends *at, moray_real_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase[0].tf;
    out->e[0] = at->phase[0].xf[0] * at->s[0];
}

static const char *const x_names[] = {"x", "y", "v"}, *const u_names[] = {"angle"}, *const s_names[] = {"unit"},
                         *const e_names[] = {"reach"};
static const double gravity = 9.80665;

static moray_phase_spec wire(void)
{
    static const moray_bounds x0[] = {{0, 0}, {10, 10}, {0, 0}}, xf[] = {{-1e20, 1e20}, {5, 5}, {-1e20, 1e20}},
                              u[] = {{0, M_PI}};
    return (moray_phase_spec){.name = "wire",
                              .nx = 3,
                              .nu = 1,
                              .t0 = moray_fixed(0),
                              .tf = moray_between(0.1, 10),
                              .x0 = {x0, 3},
                              .xf = {xf, 3},
                              .u = {u, 1},
                              .x_names = x_names,
                              .u_names = u_names};
}

static moray_status make(moray_ocp **ocp, const moray_phase_spec *phase, moray_endpoint_real_fn *endpoint)
{
    return moray_ocp_new(ocp, &(moray_ocp_spec){.name = "brachistochrone",
                                                .phases = 1,
                                                .phase = phase,
                                                .ns = 1,
                                                .s = MORAY_BOUNDS(moray_fixed(1)),
                                                .s_names = s_names,
                                                .ne = 1,
                                                .e = MORAY_BOUNDS(moray_fixed(10)),
                                                .e_names = e_names,
                                                .endpoint_real = endpoint,
                                                .data = &gravity});
}

static void test_real_problem(void)
{
    moray_ocp *ocp;
    moray_phase_spec phase = wire();
    phase.continuous_real = slide;
    CHECK_OK(make(&ocp, &phase, arrival), "a problem of real functions");
    moray_settings settings = moray_settings_default();
    settings.scheme = "lobatto5";
    settings.intervals = 10;
    moray_solution *solution;
    CHECK_OK(moray_solve(ocp, &settings, NULL, &solution), "solves");
    CHECK(moray_solution_info(solution)->outcome == MORAY_NLP_SOLVED, "to the full tolerance: %s",
          moray_nlp_outcome_text(moray_solution_info(solution)->outcome));
    CHECK_RELATIVE(moray_solution_objective(solution), 1.80160312, 1e-8, "published time");
    moray_ocp_derivative_report report;
    CHECK_OK(moray_ocp_check_derivatives(ocp, &report), "checks");
    CHECK(report.jacobian_error < 1e-9 && report.hessian_error < 1e-6, "differences agree with better ones: %.1e, %.1e",
          report.jacobian_error, report.hessian_error);
    moray_solution_free(solution);
    moray_ocp_free(ocp);
    phase.continuous_real = NULL;
    moray_status status = make(&ocp, &phase, arrival);
    CHECK(status.code == MORAY_INPUT && strstr(status.text, "phase wire: needs a continuous function"), "%s",
          status.text);
    phase.continuous_real = slide;
    status = make(&ocp, &phase, NULL);
    CHECK(status.code == MORAY_INPUT && strstr(status.text, "needs an endpoint function"), "%s", status.text);
}

// ---- Path constraints and integrals, in real numbers and in complex ones: x' = u - s x from 1 to 0.2 in 2 s with the
//      least integral of u^2 + 3 s x^2, where x u >= -0.1 ----

static void fall_real(const moray_real_node *at, moray_real_rates *out, const void *data)
{
    (void)data;
    out->f[0] = at->u[0] - at->s[0] * at->x[0];
    out->c[0] = at->x[0] * at->u[0];
    out->g[0] = at->u[0] * at->u[0];
    out->g[1] = at->x[0] * at->x[0];
}

static void fallen_real(const moray_real_ends *at, moray_real_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase[0].q[0] + 3 * at->s[0] * at->phase[0].q[1];
    out->e[0] = at->phase[0].x0[0] * at->phase[0].tf;
    out->e[1] = at->phase[0].xf[0] - at->phase[0].t0;
}

static void fall(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = at->u[0] - at->s[0] * at->x[0];
    out->c[0] = at->x[0] * at->u[0];
    out->g[0] = at->u[0] * at->u[0];
    out->g[1] = at->x[0] * at->x[0];
}

static void fallen(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase[0].q[0] + 3 * at->s[0] * at->phase[0].q[1];
    out->e[0] = at->phase[0].x0[0] * at->phase[0].tf;
    out->e[1] = at->phase[0].xf[0] - at->phase[0].t0;
}

static void test_real_and_complex(void)
{
    double objective[2], x[2], u[2], q[2][2];
    for (int real = 0; real < 2; real++) {
        const moray_phase_spec phase = {.name = "fall",
                                        .nx = 1,
                                        .nu = 1,
                                        .nc = 1,
                                        .nq = 2,
                                        .continuous = real ? NULL : fall,
                                        .continuous_real = real ? fall_real : NULL,
                                        .t0 = moray_fixed(0),
                                        .tf = moray_fixed(2),
                                        .x = MORAY_BOUNDS(moray_between(-5, 5)),
                                        .u = MORAY_BOUNDS(moray_between(-5, 5)),
                                        .c = MORAY_BOUNDS(moray_at_least(-0.1))};
        moray_ocp *ocp;
        moray_solution *solution;
        const moray_settings settings = moray_settings_default();
        CHECK_OK(moray_ocp_new(&ocp, &(moray_ocp_spec){.phases = 1,
                                                       .phase = &phase,
                                                       .ns = 1,
                                                       .s = MORAY_BOUNDS(moray_fixed(0.7)),
                                                       .ne = 2,
                                                       .e = MORAY_BOUNDS(moray_fixed(2), moray_fixed(0.2)),
                                                       .endpoint = real ? NULL : fallen,
                                                       .endpoint_real = real ? fallen_real : NULL}),
                 "a problem");
        CHECK_OK(moray_solve(ocp, &settings, NULL, &solution), "solved");
        objective[real] = moray_solution_objective(solution);
        moray_solution_at(solution, 0, 0.8, &x[real], &u[real]);
        memcpy(q[real], moray_solution_integrals(solution, 0), sizeof q[real]);
        moray_solution_free(solution);
        moray_ocp_free(ocp);
    }
    CHECK(fabs(x[0] * u[0] + 0.1) < 1e-6, "the path is at its limit: %.9g", x[0] * u[0]);
    CHECK_RELATIVE(q[0][0] + 3 * 0.7 * q[0][1], objective[0], 1e-9, "the objective is made of both integrals");
    CHECK_RELATIVE(objective[1], objective[0], 1e-8, "the same objective in real numbers");
    CHECK_RELATIVE(x[1], x[0], 1e-6, "state");
    CHECK_RELATIVE(u[1], u[0], 1e-5, "control");
    CHECK_RELATIVE(q[1][1], q[0][1], 1e-7, "integral");
}

// ---- What the check finds: the same by hand, with a slip where asked ----

static int slip;

static void by_hand_value(void *self, const double *in, double *out)
{
    (void)self;
    out[0] = in[2] * sin(in[3]);
    out[1] = -in[2] * cos(in[3]);
    out[2] = gravity * cos(in[3]);
}
static void by_hand_jacobian(void *self, const double *in, double *values)
{
    (void)self;
    const double v = in[2], angle = in[3];
    values[0] = sin(angle);
    values[1] = v * cos(angle);
    values[2] = -cos(angle);
    values[3] = v * sin(angle);
    values[4] = slip == 1 ? gravity * sin(angle) : -gravity * sin(angle);
}
static void by_hand_hessian(void *self, const double *in, const double *w, double *values)
{
    (void)self;
    const double v = in[2], angle = in[3];
    values[0] = (slip == 2 ? 0 : w[0]) * cos(angle) + w[1] * sin(angle);
    values[1] = -w[0] * v * sin(angle) + w[1] * v * cos(angle) - w[2] * gravity * cos(angle);
}

static void check_says(const moray_ocp *ocp, bool in_hessian, const char *what)
{
    moray_ocp_derivative_report report;
    CHECK_OK(moray_ocp_check_derivatives(ocp, &report), "checks");
    const char *text = in_hessian ? report.hessian : report.jacobian;
    const double error = in_hessian ? report.hessian_error : report.jacobian_error;
    CHECK(error > 1e-3 && strstr(text, what), "%s", text);
}

static void test_check_names(void)
{
    moray_ocp *ocp;
    int jr[] = {0, 0, 1, 1, 2}, jc[] = {2, 3, 2, 3, 3}, hr[] = {3, 3}, hc[] = {2, 3};
    const moray_map map = {.n_in = 6,
                           .n_out = 3,
                           .jac = {5, jr, jc},
                           .hess = {2, hr, hc},
                           .value = by_hand_value,
                           .jacobian = by_hand_jacobian,
                           .hessian = by_hand_hessian};
    moray_phase_spec phase = wire();
    phase.map = &map;
    CHECK_OK(make(&ocp, &phase, arrival), "derivatives by hand");
    moray_ocp_derivative_report report;
    CHECK_OK(moray_ocp_check_derivatives(ocp, &report), "checks");
    CHECK(report.jacobian_error < 1e-9 && report.hessian_error < 1e-6, "right ones pass: %.1e, %.1e",
          report.jacobian_error, report.hessian_error);
    slip = 1;
    check_says(ocp, false, "phase wire: d (dynamics of state v) / d (control angle) is ");
    slip = 2;
    check_says(ocp, true, "phase wire: d2 (dynamics of state x) / d (control angle) d (state v) is 0, by differences");
    slip = 0;
    moray_ocp_free(ocp);
}

// A user's mistake: fabs of <tgmath.h> is the modulus, which has no complex derivative.
struct mistakes {
    bool in_phase, in_endpoint;
};
static void kinked(const moray_node *at, moray_rates *out, const void *data)
{
    for (int i = 0; i < 3; i++)
        out->f[i] = at->x[(i + 1) % 3];
    out->f[2] += ((const struct mistakes *)data)->in_phase ? fabs(at->x[1] - 20) * at->u[0]
                                                           : moray_abs(at->x[1] - 20) * at->u[0];
}
static void tied(const moray_ends *at, moray_end_values *out, const void *data)
{
    out->objective = at->phase[0].xf[0];
    out->e[0] = (((const struct mistakes *)data)->in_endpoint ? creal(at->phase[0].tf) : at->phase[0].tf) * at->s[0];
}

static void test_check_finds_kinks(void)
{
    moray_ocp *ocp;
    moray_phase_spec phase = wire();
    phase.continuous = kinked;
    moray_ocp_spec spec = {.name = "kinked",
                           .phases = 1,
                           .phase = &phase,
                           .ns = 1,
                           .ne = 1,
                           .e = MORAY_BOUNDS(moray_free()),
                           .endpoint = tied};
    struct mistakes wrong = {.in_phase = true};
    spec.data = &wrong;
    CHECK_OK(moray_ocp_new(&ocp, &spec), "with fabs");
    check_says(ocp, false, "d (dynamics of state v) / d (state y) is 0, by differences");
    moray_ocp_free(ocp);
    wrong = (struct mistakes){.in_endpoint = true};
    CHECK_OK(moray_ocp_new(&ocp, &spec), "with creal");
    check_says(ocp, false, "endpoint: d (event e[0]) / d (final time of phase wire) is 0, by differences");
    moray_ocp_free(ocp);
    wrong = (struct mistakes){0};
    CHECK_OK(moray_ocp_new(&ocp, &spec), "with moray_abs");
    moray_ocp_derivative_report report;
    CHECK_OK(moray_ocp_check_derivatives(ocp, &report), "checks");
    CHECK(report.jacobian_error < 1e-9 && report.hessian_error < 1e-8, "is right: %.1e, %.1e", report.jacobian_error,
          report.hessian_error);
    moray_ocp_free(ocp);
}

// In a box -10..-8, far from 0 on its lower side; counts the questions asked outside.
static void in_its_box(const moray_node *at, moray_rates *out, const void *data)
{
    int *outside = *(int *const *)data;
    *outside += creal(at->x[0]) < -10 || creal(at->x[0]) > -8;
    out->f[0] = log(at->x[0] + 10.1) + at->u[0];
}
static void ends_there(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase[0].tf;
}

static void test_check_stays_within(void)
{
    int outside = 0, *const count = &outside;
    moray_ocp *ocp;
    moray_ocp_derivative_report report;
    const moray_phase_spec phase = {.name = "box",
                                    .nx = 1,
                                    .nu = 1,
                                    .continuous = in_its_box,
                                    .tf = moray_between(0.1, 10),
                                    .x = MORAY_BOUNDS(moray_between(-10, -8)),
                                    .u = MORAY_BOUNDS(moray_between(-1, 1))};
    CHECK_OK(
        moray_ocp_new(&ocp, &(moray_ocp_spec){.phases = 1, .phase = &phase, .endpoint = ends_there, .data = &count}),
        "a box");
    outside = 0;
    CHECK_OK(moray_ocp_check_derivatives(ocp, &report), "checks");
    CHECK(outside == 0, "nothing is asked outside the box, where functions need not exist: %d times", outside);
    moray_ocp_free(ocp);
}

static void nowhere(const moray_real_node *at, moray_real_rates *out, const void *data)
{
    slide(at, out, data);
    out->f[1] = log(-1 - at->x[1] * at->x[1]);
}

static void test_not_finite(void)
{
    moray_ocp *ocp;
    moray_phase_spec phase = wire();
    phase.continuous_real = nowhere;
    moray_status status = make(&ocp, &phase, arrival);
    CHECK(status.code == MORAY_INPUT && strstr(status.text, "phase wire: output 1"), "%s", status.text);
}

int main(void)
{
    test_real_problem();
    test_real_and_complex();
    test_check_names();
    test_check_finds_kinks();
    test_check_stays_within();
    test_not_finite();
    return tap_done();
}
