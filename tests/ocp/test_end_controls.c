// SPDX-License-Identifier: MIT
//
// Controls at the ends of phases. x' = v, v' = u with the algebraic variable z = x + v: from rest, where u0 fixes z and
// so x, to an event on z at the end, with least integral of u^2. With u = k (2 - t) the event's distance c is 7/3 k,
// and J = 3/7 c^2.
#include "tap.h"

#include <stdlib.h>
#include <string.h>

#include "moray/ocp.h"
#include "ocp/problem.h"
#include "rk4.h"

static const double z0 = 1, zf = 3, c = 2;

static void plant(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = at->x[1];
    out->f[1] = at->u[0];
    out->c[0] = at->u[1] - at->x[0] - at->x[1];
    out->g[0] = at->u[0] * at->u[0];
}

static void verdict(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase[0].q[0];
    out->e[0] = at->phase[0].uf[1];
}

static void real_verdict(const moray_real_ends *at, moray_real_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase[0].q[0];
    out->e[0] = at->phase[0].uf[1];
}

static moray_phase_spec phase_of(const moray_bounds *u, int n_u0, const moray_bounds *u0)
{
    static const moray_bounds start[] = {{-MORAY_INFINITY, MORAY_INFINITY}, {0, 0}}, nothing[] = {{0, 0}};
    static const char *const names[] = {"force", "sum"};
    return (moray_phase_spec){.nx = 2,
                              .nu = 2,
                              .nc = 1,
                              .nq = 1,
                              .continuous = plant,
                              .t0 = moray_fixed(0),
                              .tf = moray_fixed(1),
                              .x0 = {start, 2},
                              .c = {nothing, 1},
                              .u = {u, u ? 2 : 0},
                              .u0 = {u0, n_u0},
                              .u_names = names,
                              .end_controls = true};
}

static moray_status build(moray_ocp **ocp, const moray_phase_spec *phase, bool real)
{
    return moray_ocp_new(ocp, &(moray_ocp_spec){.name = "ends",
                                                .phases = 1,
                                                .phase = phase,
                                                .ne = 1,
                                                .endpoint = real ? NULL : verdict,
                                                .endpoint_real = real ? real_verdict : NULL,
                                                .e = MORAY_BOUNDS(moray_fixed(zf))});
}

static void check_solution(const moray_solution *solution, const char *scheme, double tolerance)
{
    CHECK(moray_solution_info(solution)->outcome == MORAY_NLP_SOLVED, "%s: %s", scheme,
          moray_solution_diagnosis(solution));
    CHECK_RELATIVE(moray_solution_objective(solution), 3.0 / 7 * c * c, tolerance, scheme);
    CHECK_RELATIVE(moray_solution_event_multipliers(solution)[0], -6.0 / 7 * c, 100 * tolerance, "the event's price");
    double x[2], u[2];
    moray_solution_at(solution, 0, 0, x, u);
    CHECK_NEAR(x[0], z0, 100 * tolerance, "the start follows from the control's bounds");
    CHECK_NEAR(u[1], z0, 100 * tolerance, "which hold");
    moray_solution_at(solution, 0, 1, x, u);
    CHECK_NEAR(u[1], zf, 100 * tolerance, "the event holds for what is told of the control");
    moray_certificate certificate;
    const int steps = 20;
    const moray_integrator rk4 = {rk4_run, &steps};
    CHECK_OK(moray_certify(solution, &rk4, &certificate), "certificate");
    CHECK(certificate.pass, "%s passes: %s", scheme, certificate.why);
}

static void test_schemes(void)
{
    // Exact where a node is at both ends. Beyond the outermost one the force bends z's polynomial to its advantage,
    // which the certificate refuses until refinement leaves little room for it.
    static const struct {
        const char *scheme;
        int refinements;
        double tolerance;
    } cases[] = {{"lobatto4", 0, 1e-9}, {"hermite-simpson", 0, 1e-8}, {"radau4", 8, 1e-5}, {"gauss4", 8, 1e-5}};
    const moray_bounds u0[] = {moray_free(), moray_fixed(z0)};
    const moray_phase_spec phase = phase_of(NULL, 2, u0);
    for (int real = 0; real < 2; real++) {
        moray_ocp *ocp;
        CHECK_OK(build(&ocp, &phase, real), "problem");
        for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
            moray_settings settings = moray_settings_default();
            moray_solution *solution, *again;
            settings.scheme = cases[k].scheme;
            settings.intervals = 4;
            settings.max_refinements = cases[k].refinements;
            CHECK_OK(moray_solve(ocp, &settings, NULL, &solution), "solve");
            check_solution(solution, cases[k].scheme, cases[k].tolerance);
            CHECK_OK(moray_solution_save(solution, "test_end_controls.moray"), "saved");
            CHECK_OK(moray_solution_load(&again, ocp, &settings, "test_end_controls.moray"), "loaded");
            check_solution(again, cases[k].scheme, cases[k].tolerance);
            remove("test_end_controls.moray");
            moray_solution_free(again);
            moray_solution_free(solution);
        }
        moray_ocp_derivative_report report;
        CHECK_OK(moray_ocp_check_derivatives(ocp, &report), "derivatives");
        CHECK(report.jacobian_error < 1e-5, "%s", report.jacobian);
        moray_ocp_free(ocp);
    }
}

static void least_effort(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase[0].q[0];
    out->e[0] = at->phase[0].xf[0];
}

static moray_nlp_size size_of(bool asked, const char *scheme)
{
    const moray_bounds u0[] = {moray_free(), moray_fixed(z0)};
    moray_phase_spec phase = phase_of(NULL, asked ? 2 : 0, u0);
    phase.end_controls = false;
    moray_ocp *ocp;
    moray_solution *solution;
    moray_settings settings = moray_settings_default();
    settings.scheme = scheme;
    settings.intervals = 2;
    CHECK_OK(moray_ocp_new(&ocp, &(moray_ocp_spec){.phases = 1,
                                                   .phase = &phase,
                                                   .ne = 1,
                                                   .endpoint = least_effort,
                                                   .e = MORAY_BOUNDS(moray_fixed(zf))}),
             "problem");
    CHECK_OK(moray_solve(ocp, &settings, NULL, &solution), "solve");
    const moray_nlp_size size = moray_solution_size(solution);
    moray_solution_free(solution);
    moray_ocp_free(ocp);
    return size;
}

// Variables are added only where they are asked for and no node has them: those of two controls at an end.
static void test_sizes(void)
{
    static const char *const schemes[] = {"lobatto4", "radau4", "gauss4"};
    for (int k = 0; k < 3; k++) {
        const moray_nlp_size with = size_of(true, schemes[k]), without = size_of(false, schemes[k]);
        CHECK(with.variables == without.variables + 2 * k && with.constraints == without.constraints + 2 * k,
              "%s: %d variables and %d constraints, %d and %d without", schemes[k], with.variables, with.constraints,
              without.variables, without.constraints);
    }
}

static void refuses(const moray_phase_spec *phase, const char *says)
{
    moray_ocp *ocp;
    const moray_status status = build(&ocp, phase, false);
    CHECK(status.code == MORAY_INPUT && strstr(status.text, says) && !ocp, "%s", status.text);
}

static void test_refusals(void)
{
    const moray_bounds u[] = {moray_between(-1, 1), moray_free()}, u0[] = {moray_at_least(2), moray_free()};
    const moray_bounds crossed[] = {moray_free(), {2, 1}};
    moray_phase_spec phase = phase_of(u, 1, u0);
    refuses(&phase, "u0 of phase: 1 bounds given, 2 needed");
    phase = phase_of(u, 2, u0);
    refuses(&phase, "u0[0] of phase: [2, ");
    phase = phase_of(u, 0, NULL);
    phase.uf = (moray_bounds_list){crossed, 2};
    refuses(&phase, "uf[1] sum of phase: lower bound 2 is above upper bound 1");
}

// ---- What the endpoint is handed, in phases of sizes that differ, of which not all read controls ----

enum { phases = 3, parameters = 2, inputs = 36 };
static const struct {
    int nx, nu, nq;
    bool end_controls;
} size[phases] = {{2, 3, 1, true}, {3, 1, 2, false}, {1, 2, 3, true}};

#define ADD(from, count)                                                                                               \
    for (int i = 0; i < (count); i++)                                                                                  \
    sum += ++k * (from)[i]

// All that it is handed, times its place.
static void add_up(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    moray_num sum = 0;
    int k = 0;
    for (int p = 0; p < phases; p++) {
        const moray_phase_ends *end = &at->phase[p];
        ADD(end->x0, size[p].nx);
        ADD(&end->t0, 1);
        ADD(end->xf, size[p].nx);
        ADD(&end->tf, 1);
        ADD(end->q, size[p].nq);
        ADD(end->u0, end->u0 ? size[p].nu : 0);
        ADD(end->uf, end->uf ? size[p].nu : 0);
    }
    ADD(at->s, parameters);
    out->objective = sum, out->e[0] = 2 * sum, out->e[1] = 3 * sum;
}

static void add_up_real(const moray_real_ends *at, moray_real_end_values *out, const void *data)
{
    (void)data;
    double sum = 0;
    int k = 0;
    for (int p = 0; p < phases; p++) {
        const moray_real_phase_ends *end = &at->phase[p];
        ADD(end->x0, size[p].nx);
        ADD(&end->t0, 1);
        ADD(end->xf, size[p].nx);
        ADD(&end->tf, 1);
        ADD(end->q, size[p].nq);
        ADD(end->u0, end->u0 ? size[p].nu : 0);
        ADD(end->uf, end->uf ? size[p].nu : 0);
    }
    ADD(at->s, parameters);
    out->objective = sum, out->e[0] = 2 * sum, out->e[1] = 3 * sum;
}

static void still(const moray_node *at, moray_rates *out, const void *data)
{
    (void)at, (void)out, (void)data;
}

static void test_handed(bool real)
{
    moray_phase_spec phase[phases];
    for (int p = 0; p < phases; p++)
        phase[p] = (moray_phase_spec){.nx = size[p].nx,
                                      .nu = size[p].nu,
                                      .nq = size[p].nq,
                                      .continuous = still,
                                      .tf = moray_fixed(1),
                                      .end_controls = size[p].end_controls};
    moray_ocp *ocp;
    CHECK_OK(moray_ocp_new(&ocp, &(moray_ocp_spec){.phases = phases,
                                                   .phase = phase,
                                                   .ns = parameters,
                                                   .ne = 2,
                                                   .e = MORAY_BOUNDS(moray_free(), moray_free()),
                                                   .s = MORAY_BOUNDS(moray_free(), moray_free()),
                                                   .endpoint = real ? NULL : add_up,
                                                   .endpoint_real = real ? add_up_real : NULL}),
             "problem");
    const moray_map *map = ocp->endpoint->map;
    CHECK(map->n_in == inputs, "%d inputs", map->n_in);
    double in[inputs], out[3], sum = 0;
    for (int k = 0; k < inputs; k++) {
        in[k] = k % 7 + 1;
        sum += (k + 1) * in[k];
    }
    map->value(map->self, in, out);
    CHECK(out[0] == sum && out[1] == 2 * sum && out[2] == 3 * sum, "each input is where it belongs: %g, expected %g",
          out[0], sum);
    moray_ocp_free(ocp);
}

int main(void)
{
    test_handed(false);
    test_handed(true);
    test_schemes();
    test_sizes();
    test_refusals();
    return tap_done();
}
