// SPDX-License-Identifier: MIT
//
// What the form of a problem says beside functions and bounds: durations, meshes; and multipliers over time.
#include "tap.h"

#include <stdlib.h>
#include <string.h>

#include "moray/ocp.h"
#include "ocp/solution.h"
#include "rk4.h"

static moray_solution *solve(const moray_ocp *ocp, const char *scheme, int intervals)
{
    moray_settings settings = moray_settings_default();
    moray_solution *solution;
    settings.scheme = scheme;
    settings.intervals = intervals;
    settings.tolerance = 1e-10;
    CHECK_OK(moray_solve(ocp, &settings, NULL, &solution), "solve");
    CHECK(moray_solution_info(solution)->outcome == MORAY_NLP_SOLVED, "%s", moray_solution_diagnosis(solution));
    return solution;
}

// ---- Durations: x' = u, least u^2 over two phases from 0 to 1 and on to 3, each of a given length
// ---------------------

static void walk(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = at->u[0];
    out->g[0] = at->u[0] * at->u[0];
}

static void join(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase[0].q[0] + at->phase[1].q[0];
    out->e[0] = at->phase[1].t0 - at->phase[0].tf;
}

static const moray_bounds zero[] = {{0, 0}}, one[] = {{1, 1}}, three[] = {{3, 3}};

static moray_ocp *walks(moray_bounds t0, moray_bounds tf, moray_bounds first, moray_bounds second, moray_status *status)
{
    moray_ocp *ocp;
    moray_phase_spec phase[2];
    for (int p = 0; p < 2; p++)
        phase[p] = (moray_phase_spec){.nx = 1, .nu = 1, .nq = 1, .continuous = walk, .t0 = t0, .tf = tf};
    phase[0].x0 = (moray_bounds_list){zero, 1}, phase[0].xf = (moray_bounds_list){one, 1};
    phase[1].x0 = (moray_bounds_list){one, 1}, phase[1].xf = (moray_bounds_list){three, 1};
    phase[0].duration = first, phase[1].duration = second;
    *status =
        moray_ocp_new(&ocp, &(moray_ocp_spec){.phases = 2, .phase = phase, .ne = 1, .e = {zero, 1}, .endpoint = join});
    return ocp;
}

// In all of one window: 1 / 2 + 4 / 3 when the first takes at most 2 of at least 1, the second at most 3; and with
// fixed lengths what they say.
static void test_durations(void)
{
    const struct {
        moray_bounds first, second;
        double objective, length[2];
    } cases[] = {{moray_between(1, 2), moray_at_most(3), 1.0 / 2 + 4.0 / 3, {2, 3}},
                 {moray_fixed(0.5), moray_fixed(4), 1 / 0.5 + 4.0 / 4, {0.5, 4}},
                 {moray_fixed(2), {0, 0}, 1.0 / 2 + 4.0 / 8, {2, 8}}};
    for (int k = 0; k < 3; k++) {
        moray_status status;
        moray_ocp *ocp = walks(moray_between(0, 10), moray_between(0, 10), cases[k].first, cases[k].second, &status);
        CHECK_OK(status, "times that share a window");
        moray_solution *solution = solve(ocp, "hermite-simpson", 3);
        CHECK_RELATIVE(moray_solution_objective(solution), cases[k].objective, 1e-6, "objective");
        for (int p = 0; p < 2; p++) {
            double t0, tf;
            moray_solution_times(solution, p, &t0, &tf);
            CHECK_NEAR(tf - t0, cases[k].length[p], 1e-5, "length of a phase");
        }
        moray_certificate certificate;
        const int steps = 20;
        const moray_integrator rk4 = {rk4_run, &steps};
        CHECK_OK(moray_certify(solution, &rk4, &certificate), "certificate");
        CHECK(certificate.pass, "passes: %s", certificate.why);
        moray_solution_free(solution);
        moray_ocp_free(ocp);
    }
}

static void refuses(moray_bounds duration, const char *says)
{
    moray_status status;
    moray_ocp *ocp = walks(moray_fixed(1), moray_between(2, 3), duration, (moray_bounds){0, 0}, &status);
    CHECK(status.code == MORAY_INPUT && strstr(status.text, says) && !ocp, "%s", status.text);
}

static void test_duration_refusals(void)
{
    refuses(moray_between(3, 2), "duration[0] of 1: lower bound 3 is above upper bound 2");
    refuses(moray_between(-2, -1), "phase 1: duration of at most -1");
    refuses(moray_at_least(5), "does not meet t0 in [1, 1] and tf in [2, 3]");
    refuses(moray_at_most(0.5), "does not meet t0");
    refuses(moray_fixed(NAN), "not a number");
}

// A way of 1 at a speed of at most 1, begun as late as may be, or ended as soon: backwards in time it would be more so.
static void depart(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase[0].tf - 2 * at->phase[0].t0;
}

static void arrive(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = 2 * at->phase[0].tf - at->phase[0].t0;
}

// One time is free, over a box that holds the fixed one: time runs forwards all the same.
static void test_direction(void)
{
    for (int late = 0; late < 2; late++) {
        const moray_bounds any = moray_between(0, 5);
        const moray_phase_spec phase = {.nx = 1,
                                        .nu = 1,
                                        .nq = 1,
                                        .continuous = walk,
                                        .t0 = late ? any : moray_fixed(3),
                                        .tf = late ? moray_fixed(2) : any,
                                        .x0 = {zero, 1},
                                        .xf = {one, 1},
                                        .u = MORAY_BOUNDS(moray_between(-1, 1))};
        moray_ocp *ocp;
        double t0, tf;
        CHECK_OK(
            moray_ocp_new(&ocp, &(moray_ocp_spec){.phases = 1, .phase = &phase, .endpoint = late ? depart : arrive}),
            "a free time beside a fixed one");
        moray_solution *solution = solve(ocp, "hermite-simpson", 3);
        const moray_nlp *nlp = &solution->transcription->nlp;
        const struct phase_layout *layout = &solution->transcription->layout.phase[0];
        const int column = late ? layout->t0 : layout->tf;
        CHECK(nlp->x_lower[column] == (late ? 0 : 3) && nlp->x_upper[column] == (late ? 2 : 5),
              "the free time is in [%g, %g]", nlp->x_lower[column], nlp->x_upper[column]);
        moray_solution_times(solution, 0, &t0, &tf);
        CHECK_NEAR(t0, late ? 1 : 3, 1e-6, "begins as late as the speed allows");
        CHECK_NEAR(tf, late ? 2 : 4, 1e-6, "ends as soon");
        moray_solution_free(solution);
        moray_ocp_free(ocp);
    }
}

// ---- Meshes that the user gives ------------------------------------------------------------------------------------

static void own_effort(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase[0].q[0];
}

static moray_ocp *meshed(const double *mesh, int intervals, moray_status *status)
{
    moray_ocp *ocp;
    const moray_phase_spec phase = {.nx = 1,
                                    .nu = 1,
                                    .nq = 1,
                                    .continuous = walk,
                                    .t0 = moray_fixed(2),
                                    .tf = moray_fixed(4),
                                    .x0 = {zero, 1},
                                    .xf = {one, 1},
                                    .mesh = mesh,
                                    .intervals = intervals};
    *status = moray_ocp_new(&ocp, &(moray_ocp_spec){.phases = 1, .phase = &phase, .endpoint = own_effort});
    return ocp;
}

static void test_meshes(void)
{
    const double mesh[] = {0, 0.1, 0.5, 1}, back[] = {0, 0.6, 0.5, 1}, shorter[] = {0, 0.1, 0.5, 0.9};
    double time[20];
    moray_status status;
    moray_ocp *ocp = meshed(mesh, 3, &status);
    CHECK_OK(status, "a mesh");
    moray_solution *solution = solve(ocp, "trapezoid", 20);
    CHECK(moray_solution_nodes(solution, 0, time, NULL) == 4, "4 nodes");
    for (int k = 0; k < 4; k++)
        CHECK_NEAR(time[k], 2 + 2 * mesh[k], 1e-12, "time of a node");
    moray_solution_free(solution);
    moray_ocp_free(ocp);
    ocp = meshed(NULL, 5, &status);
    CHECK_OK(status, "a number of intervals");
    solution = solve(ocp, "trapezoid", 20);
    CHECK(moray_solution_nodes(solution, 0, NULL, NULL) == 6, "6 nodes");
    moray_solution_free(solution);
    moray_ocp_free(ocp);
    CHECK(!meshed(back, 3, &status) && strstr(status.text, "mesh[2] = 0.5 after 0.6"), "%s", status.text);
    CHECK(!meshed(shorter, 3, &status) && strstr(status.text, "from 0 to 0.9"), "%s", status.text);
    CHECK(!meshed(mesh, 0, &status) && strstr(status.text, "mesh of 0 intervals"), "%s", status.text);
    CHECK(!meshed(NULL, -1, &status) && strstr(status.text, "mesh of -1 intervals"), "%s", status.text);
}

// ---- Multipliers over time -----------------------------------------------------------------------------------------
//
// u follows t within [1/4, 1/2]: mu = t - u, positive where the upper bound holds it down, negative where the lower
// holds it up, once as a bound of u and once as a path constraint.

static void follow(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = 0;
    out->g[0] = (at->u[0] - at->t) * (at->u[0] - at->t) / 2;
    out->c[0] = at->u[0];
}

static void test_control_multipliers(void)
{
    const moray_bounds within[] = {{0.25, 0.5}}, wide[] = {{-9, 9}};
    static const char *const schemes[] = {"trapezoid", "hermite-simpson", "radau3", "gauss2"};
    for (int k = 0; k < 8; k++) {
        const bool path = k % 2;
        const moray_phase_spec phase = {.nx = 1,
                                        .nu = 1,
                                        .nc = 1,
                                        .nq = 1,
                                        .continuous = follow,
                                        .t0 = moray_fixed(0),
                                        .tf = moray_fixed(2),
                                        .x0 = {zero, 1},
                                        .u = {path ? wide : within, 1},
                                        .c = {path ? within : wide, 1}};
        moray_ocp *ocp;
        CHECK_OK(moray_ocp_new(&ocp, &(moray_ocp_spec){.phases = 1, .phase = &phase, .endpoint = own_effort}),
                 "problem");
        moray_solution *solution = solve(ocp, schemes[k / 2], 15);
        double time[100], c[100], u[100], worst = 0;
        const int nodes = moray_solution_nodes(solution, 0, time, NULL);
        CHECK(moray_solution_multipliers(solution, 0, c, NULL, u) == nodes, "as many as nodes");
        for (int n = 0; n < nodes; n++) {
            const double mu = time[n] - fmin(fmax(time[n], 0.25), 0.5), found = path ? c[n] : u[n];
            worst = isnan(found) ? worst : fmax(worst, fabs(found - mu));
        }
        CHECK(worst < 1e-5, "%s: multiplier of a %s within %.1e", schemes[k / 2], path ? "path constraint" : "bound",
              worst);
        moray_solution_free(solution);
        moray_ocp_free(ocp);
    }
}

// x is drawn to 2 and held at its bound, 1: mu = 1 and costate 0 all along.
static void draw(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = at->u[0];
    out->g[0] = (at->x[0] - 2) * (at->x[0] - 2) / 2 + at->u[0] * at->u[0] / 2;
}

static void test_state_multipliers(void)
{
    const moray_bounds most[] = {{-INFINITY, 1}};
    const moray_phase_spec phase = {.nx = 1,
                                    .nu = 1,
                                    .nq = 1,
                                    .continuous = draw,
                                    .t0 = moray_fixed(0),
                                    .tf = moray_fixed(3),
                                    .x0 = {one, 1},
                                    .x = {most, 1}};
    moray_ocp *ocp;
    CHECK_OK(moray_ocp_new(&ocp, &(moray_ocp_spec){.phases = 1, .phase = &phase, .endpoint = own_effort}), "problem");
    moray_solution *solution = solve(ocp, "hermite-simpson", 10);
    double x[21], x0, xf, worst = 0;
    const int nodes = moray_solution_multipliers(solution, 0, NULL, x, NULL);
    for (int n = 1; n < nodes - 1; n++)
        worst = tap_worse(worst, fabs(x[n] - 1));
    moray_solution_end_multipliers(solution, 0, &x0, &xf);
    CHECK(worst < 1e-4, "multiplier of a state's bound within %.1e", worst);
    CHECK(isnan(x[0]) && isnan(x[nodes - 1]) && isnan(x0), "none of the ends, nor of a fixed start");
    CHECK_NEAR(xf, 3.0 / 10 / 6, 1e-4, "at the end it is what the weight of that node leaves");
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

// Bryson and Denham, x <= l: J = 4 / (9 l), so that the multiplier integrates to -dJ/dl = 4 / (9 l^2), half of it where
// the arc begins at 3 l and half where it ends, 0 elsewhere.
static void turn(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = at->x[1];
    out->f[1] = at->u[0];
    out->c[0] = at->x[0];
    out->g[0] = at->u[0] * at->u[0] / 2;
}

static void test_bryson_denham(void)
{
    const double l = 1.0 / 9;
    const moray_bounds from[] = {{0, 0}, {1, 1}}, to[] = {{0, 0}, {-1, -1}}, limit[] = {{-INFINITY, l}};
    const moray_phase_spec phase = {.nx = 2,
                                    .nu = 1,
                                    .nc = 1,
                                    .nq = 1,
                                    .continuous = turn,
                                    .t0 = moray_fixed(0),
                                    .tf = moray_fixed(1),
                                    .x0 = {from, 2},
                                    .xf = {to, 2},
                                    .c = {limit, 1}};
    moray_ocp *ocp;
    CHECK_OK(moray_ocp_new(&ocp, &(moray_ocp_spec){.phases = 1, .phase = &phase, .endpoint = own_effort}), "problem");
    moray_solution *solution = solve(ocp, "trapezoid", 90);
    double time[91], c[91], sum = 0, entry = 0, least = 0, elsewhere = 0;
    const int nodes = moray_solution_nodes(solution, 0, time, NULL);
    moray_solution_multipliers(solution, 0, c, NULL, NULL);
    for (int n = 0; n < nodes; n++) {
        const double weight = 1.0 / 90 * (n == 0 || n == nodes - 1 ? 0.5 : 1);
        const bool near = fabs(time[n] - 3 * l) < 0.05 || fabs(time[n] - 1 + 3 * l) < 0.05;
        sum += weight * c[n];
        entry += time[n] < 0.5 ? weight * c[n] : 0;
        elsewhere += near ? 0 : weight * fabs(c[n]);
        least = fmin(least, c[n]);
    }
    CHECK_RELATIVE(sum, 4 / (9 * l * l), 5e-3, "integral of the multiplier");
    CHECK_RELATIVE(entry, 2 / (9 * l * l), 5e-3, "of its first half");
    CHECK(elsewhere < 1e-3 * sum, "beside entry and exit %.1e", elsewhere);
    CHECK(least > -1e-6, "none is negative at an upper bound: %.1e", least);
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

int main(void)
{
    test_durations();
    test_duration_refusals();
    test_direction();
    test_meshes();
    test_control_multipliers();
    test_state_multipliers();
    test_bryson_denham();
    return tap_done();
}
