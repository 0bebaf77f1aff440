// SPDX-License-Identifier: MIT
//
// One wrong solution for each number of the certificate, which it alone, or it first, must refuse.
#include "tap.h"

#include <stdlib.h>
#include <string.h>
#include <tgmath.h>

#include "ocp/certificate/bends.h"
#include "ocp/certificate/differences.h"
#include "ocp/solution.h"
#include "rk4.h"
#include "symmetric_line.h"

static const int rk4_steps = 40;
static const moray_integrator rk4 = {rk4_run, &rk4_steps};

// ---- A cart with cubic drag, x' = v, v' = u - v^3, from rest to rest over 1 m in 2 s; J = integral of u^2 + v^4 / 4.
//      Derivatives by hand, with a fault ----

enum fault { none, wrong_jacobian, wrong_hessian, missing_entry };

static void value(void *self, const double *in, double *out)
{
    (void)self;
    const double v = in[1], u = in[2];
    out[0] = v;
    out[1] = u - v * v * v;
    out[2] = v;
    out[3] = u * u + v * v * v * v / 4;
}

static void jacobian(void *self, const double *in, double *values)
{
    const enum fault fault = *(const enum fault *)self;
    const double v = in[1], u = in[2];
    values[0] = 1;
    values[1] = -3 * v * v * (fault == wrong_jacobian ? 1.001 : 1);
    values[2] = 1;
    values[3] = 1;
    values[4] = 2 * u;
    if (fault != missing_entry)
        values[5] = v * v * v;
}

static void hessian(void *self, const double *in, const double *weight, double *values)
{
    const enum fault fault = *(const enum fault *)self;
    values[0] = -6 * in[1] * weight[1] * (fault == wrong_hessian ? 1.1 : 1) +
                (fault == missing_entry ? 0 : 3 * in[1] * in[1] * weight[3]);
    values[1] = 2 * weight[3];
}

static void total(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase[0].q[0];
}

struct cart {
    const char *scheme;
    int intervals;
    enum fault fault;
    double barrier,
        fastest; // where the solver's barrier ends, 0: at nothing; bound of the path constraint v <= fastest
};

static moray_solution *solve_cart(struct cart *cart, moray_ocp **ocp)
{
    static int row[] = {0, 1, 1, 2, 3, 3}, col[] = {1, 1, 2, 1, 2, 1}, hess_row[] = {1, 2}, hess_col[] = {1, 2};
    const moray_map map = {.n_in = 4,
                           .n_out = 4,
                           .jac = {.nnz = cart->fault == missing_entry ? 5 : 6, .row = row, .col = col},
                           .hess = {.nnz = 2, .row = hess_row, .col = hess_col},
                           .value = value,
                           .jacobian = jacobian,
                           .hessian = hessian,
                           .self = &cart->fault};
    static moray_map kept; // must outlive the problem
    kept = map;
    const moray_phase_spec track = {.name = "track",
                                    .nx = 2,
                                    .nu = 1,
                                    .nc = 1,
                                    .nq = 1,
                                    .map = &kept,
                                    .t0 = moray_fixed(0),
                                    .tf = moray_fixed(2),
                                    .x0 = MORAY_BOUNDS(moray_fixed(0), moray_fixed(0)),
                                    .xf = MORAY_BOUNDS(moray_fixed(1), moray_fixed(0)),
                                    .c = MORAY_BOUNDS(moray_at_most(cart->fastest))};
    moray_settings settings = moray_settings_default();
    moray_solution *solution = NULL;
    settings.scheme = cart->scheme;
    settings.intervals = cart->intervals;
    char target[20];
    snprintf(target, sizeof target, "%g", cart->barrier);
    const moray_key_value end = {"mu_target", target};
    settings.ipopt = &end;
    settings.n_ipopt = cart->barrier > 0;
    CHECK_OK(moray_ocp_new(ocp, &(moray_ocp_spec){.phases = 1, .phase = &track, .endpoint = total}), "cart");
    CHECK_OK(moray_solve(*ocp, &settings, NULL, &solution), "solved");
    if (!solution)
        exit(1);
    return solution;
}

static moray_certificate certify(const moray_solution *solution)
{
    moray_certificate certificate;
    CHECK_OK(moray_certify(solution, &rk4, &certificate), "certificate");
    return certificate;
}

static moray_certificate certificate_of(struct cart cart)
{
    moray_ocp *ocp = NULL;
    moray_solution *solution = solve_cart(&cart, &ocp);
    const moray_certificate certificate = certify(solution);
    moray_solution_free(solution);
    moray_ocp_free(ocp);
    return certificate;
}

static const struct cart right = {"radau5", 10, none, 0, 10};

static void test_right_solution(void)
{
    const moray_certificate c = certificate_of(right);
    CHECK(c.pass && !c.why[0], "the right solution passes: KKT %.1e, gap %.1e, curvature %.1e, Hamiltonian %.1e %s",
          c.kkt, c.gap, c.curvature, c.hamiltonian, c.why);
}

static void test_wrong_derivatives(void)
{
    struct cart cart = right;
    cart.fault = wrong_jacobian;
    moray_certificate c = certificate_of(cart);
    CHECK(!c.pass && c.derivatives > MORAY_LIMIT_DERIVATIVES && strstr(c.why, "d (dynamics of state x[1])"),
          "Jacobian: %s", c.why);
    CHECK(!strstr(c.why, "lacks"), "which is there, but wrong: %s", c.why);
    CHECK(c.kkt > MORAY_LIMIT_KKT, "and the optimum that it led to is none: %.1e", c.kkt);
    cart.fault = missing_entry;
    c = certificate_of(cart);
    CHECK(!c.pass && c.derivatives > MORAY_LIMIT_DERIVATIVES && strstr(c.why, "d (integrand g[0]) / d (state x[1])"),
          "pattern: %s", c.why);
    CHECK(strstr(c.why, "its pattern lacks it"), "which says so: %s", c.why);
    cart.fault = wrong_hessian;
    c = certificate_of(cart);
    CHECK(!c.pass && c.derivatives <= MORAY_LIMIT_DERIVATIVES && c.directions > MORAY_LIMIT_DIRECTIONS, "Hessian: %s",
          c.why);
}

static void test_wrong_meshes(void)
{
    struct cart cart = {"trapezoid", 6, none, 0, 10};
    moray_certificate c = certificate_of(cart);
    CHECK(!c.pass && c.mesh_error > 1e-6 && c.resimulation > 1e-6 && strstr(c.why, "phase track near t ="),
          "coarse mesh: %s", c.why);
    cart = (struct cart){"radau5", 3, none, 0, 0.6};
    c = certificate_of(cart);
    CHECK(!c.pass && c.between_nodes > 1e-4, "a limit passed between the nodes: %.1e, %s", c.between_nodes, c.why);
}

static void test_stopped_early(void)
{
    struct cart cart = right;
    cart.barrier = 1e-3;
    cart.fastest = 0.7;
    const moray_certificate c = certificate_of(cart);
    CHECK(!c.pass && c.gap > MORAY_LIMIT_GAP, "a solver that stops inside: gap %.1e, %s", c.gap, c.why);
}

// Spoils the multipliers or the states of a right solution.
static void test_spoiled(void)
{
    moray_ocp *ocp = NULL;
    struct cart cart = right;
    moray_solution *solution = solve_cart(&cart, &ocp);
    const int m = solution->transcription->nlp.m, middle = solution->transcription->layout.phase[0].node[20].x;
    for (int i = 0; i < m; i++)
        solution->iterate.lambda[i] *= 1 + 1e-3 * (i % 7 - 3);
    moray_certificate c = certify(solution);
    CHECK(!c.pass && c.kkt > MORAY_LIMIT_KKT && strstr(c.why, "could still improve"), "multipliers: %s", c.why);
    for (int i = 0; i < m; i++)
        solution->iterate.lambda[i] *= 1 + 0.2 * (i % 7 - 3);
    c = certify(solution);
    CHECK(c.hamiltonian > MORAY_LIMIT_HAMILTONIAN, "which the Hamiltonian sees too: %.1e", c.hamiltonian);
    solution->iterate.x[middle] += 1e-4;
    c = certify(solution);
    CHECK(!c.pass && c.kkt > MORAY_LIMIT_KKT && strstr(c.why, "constraints are violated") && strstr(c.why, "defect"),
          "a state: %s", c.why);
    CHECK(c.resimulation > 1e-5, "and by shooting: %.1e", c.resimulation);
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

// All multipliers with the other sign: stationary where the objective is turned, too.
static void test_negated(void)
{
    moray_ocp *ocp = NULL;
    struct cart cart = right;
    moray_solution *solution = solve_cart(&cart, &ocp);
    for (int i = 0; i < solution->transcription->nlp.m; i++)
        solution->iterate.lambda[i] *= -1;
    const moray_certificate c = certify(solution);
    CHECK(!c.pass && c.kkt > MORAY_LIMIT_KKT, "negated multipliers: %.1e, %s", c.kkt, c.why);
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

static void test_edited_objective(void)
{
    moray_ocp *ocp = NULL;
    struct cart cart = right;
    moray_solution *solution = solve_cart(&cart, &ocp);
    solution->iterate.objective *= 1 - 1e-3;
    const moray_certificate c = certify(solution);
    CHECK(!c.pass && c.kkt > MORAY_LIMIT_KKT && strstr(c.why, "objective that is told"), "objective: %s", c.why);
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

// Positions in millimetres where metres were meant.
static void test_wrong_units(void)
{
    moray_ocp *ocp = NULL;
    struct cart cart = right;
    moray_solution *solution = solve_cart(&cart, &ocp);
    const struct phase_layout *layout = &solution->transcription->layout.phase[0];
    for (int n = 0; n < layout->nodes; n++)
        solution->iterate.x[layout->node[n].x] *= 1e3;
    const moray_certificate c = certify(solution);
    CHECK(!c.pass && c.kkt > MORAY_LIMIT_KKT && c.resimulation > 1e-3, "wrong units: %s", c.why);
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

// ---- A maximum at its bounds: minimise x(1), x' = u, |u| <= 1, where u = 1 with multipliers of the wrong sign ----

static void end_value(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase[0].xf[0];
}

static void test_maximum_at_bounds(void)
{
    const moray_phase_spec line = {.name = "line",
                                   .nx = 1,
                                   .nu = 1,
                                   .continuous = symmetric_drift,
                                   .t0 = moray_fixed(0),
                                   .tf = moray_fixed(1),
                                   .x0 = MORAY_BOUNDS(moray_fixed(0)),
                                   .u = MORAY_BOUNDS(moray_between(-1, 1))};
    moray_ocp *ocp = NULL;
    moray_solution *solution = NULL;
    const moray_settings settings = moray_settings_default();
    CHECK_OK(moray_ocp_new(&ocp, &(moray_ocp_spec){.phases = 1, .phase = &line, .endpoint = end_value}), "line");
    CHECK_OK(moray_solve(ocp, &settings, NULL, &solution), "solved");
    CHECK(certify(solution).pass, "the minimum, %.9g, passes", moray_solution_objective(solution));
    moray_iterate *at = &solution->iterate;
    for (int j = 0; j < solution->transcription->nlp.n; j++) {
        const double kept = at->z_lower[j];
        at->x[j] *= -1;
        at->z_lower[j] = -at->z_upper[j], at->z_upper[j] = -kept;
    }
    at->objective *= -1;
    const moray_certificate c = certify(solution);
    CHECK(!c.pass && c.kkt > MORAY_LIMIT_KKT && strstr(c.why, "could still improve"), "the maximum: %s", c.why);
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

// ---- A spike between the nodes: x' = u + spike of height 50 that no node meets, J = integral of u^2 ----

static void spiked(const moray_node *at, moray_rates *out, const void *data)
{
    const moray_num far = (at->t - 0.5122) / 0.003, u = at->u[0];
    (void)data;
    out->f[0] = u + 50 * exp(-far * far);
    out->g[0] = u * u;
}

static void test_spike(void)
{
    const moray_phase_spec line = {.name = "line",
                                   .nx = 1,
                                   .nu = 1,
                                   .nq = 1,
                                   .continuous = spiked,
                                   .t0 = moray_fixed(0),
                                   .tf = moray_fixed(1),
                                   .x0 = MORAY_BOUNDS(moray_fixed(0)),
                                   .xf = MORAY_BOUNDS(moray_fixed(1))};
    moray_ocp *ocp = NULL;
    moray_solution *solution = NULL;
    const moray_settings settings = moray_settings_default();
    CHECK_OK(moray_ocp_new(&ocp, &(moray_ocp_spec){.phases = 1, .phase = &line, .endpoint = total}), "spike");
    CHECK_OK(moray_solve(ocp, &settings, NULL, &solution), "solved");
    CHECK_NEAR(moray_solution_objective(solution), 1, 1e-3, "as if there were no spike");
    const moray_certificate c = certify(solution);
    CHECK(!c.pass && c.mesh_error > 1e-3 && c.resimulation > 1e-3, "a spike between the nodes: %s", c.why);
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

// ---- Meshes that disagree on the optimum ----

static void test_disagreement(void)
{
    moray_ocp *ocp = NULL;
    moray_solution *solution = NULL;
    moray_settings settings = moray_settings_default();
    settings.max_refinements = 4;
    settings.intervals = 4;
    CHECK_OK(
        moray_ocp_new(&ocp, &(moray_ocp_spec){.phases = 1,
                                              .phase = &(const moray_phase_spec){.name = "line",
                                                                                 .nx = 1,
                                                                                 .nu = 1,
                                                                                 .nq = 1,
                                                                                 .continuous = spiked,
                                                                                 .t0 = moray_fixed(0),
                                                                                 .tf = moray_fixed(0.3),
                                                                                 .x0 = MORAY_BOUNDS(moray_fixed(0)),
                                                                                 .xf = MORAY_BOUNDS(moray_fixed(1))},
                                              .endpoint = total}),
        "line");
    CHECK_OK(moray_solve(ocp, &settings, NULL, &solution), "solved");
    CHECK(!strstr(moray_solution_diagnosis(solution), "differ"), "one optimum: %s", moray_solution_diagnosis(solution));
    moray_mesh_record two[2] = {solution->history[0], solution->history[0]};
    moray_mesh_record *kept = solution->history;
    const int meshes = solution->meshes;
    two[0].objective *= 100;
    solution->history = two, solution->meshes = 2;
    moray_diagnose(solution);
    CHECK(strstr(moray_solution_diagnosis(solution), "The optima of 4 and 4 intervals differ"), "two optima: %s",
          moray_solution_diagnosis(solution));
    solution->history = kept, solution->meshes = meshes;
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

// ---- A saddle: minimise -x(1)^2 at x = u = 0 ----

static void test_saddle(void)
{
    moray_ocp *ocp = NULL;
    moray_solution *solution = NULL;
    const moray_settings settings = moray_settings_default();
    CHECK_OK(symmetric_line_new(&ocp), "a maximum");
    CHECK_OK(moray_solve(ocp, &settings, NULL, &solution), "solved");
    const size_t n = (size_t)solution->transcription->nlp.n, m = (size_t)solution->transcription->nlp.m;
    memset(solution->iterate.x, 0, n * sizeof(double));
    memset(solution->iterate.z_lower, 0, n * sizeof(double));
    memset(solution->iterate.z_upper, 0, n * sizeof(double));
    memset(solution->iterate.lambda, 0, m * sizeof(double));
    solution->iterate.objective = 0;
    const moray_certificate c = certify(solution);
    CHECK(!c.pass && c.kkt < 1e-12 && c.curvature > MORAY_LIMIT_CURVATURE, "stationary, but %s", c.why);
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

// ---- A wrong Hessian on so many nodes that each has next to nothing of a direction through all of them: least
// integral
//      of u^2 - k x^2 from rest to rest, where a Hessian without its x^2 makes a minimum of the maximum by x ----

static void sag_value(void *self, const double *in, double *out)
{
    (void)self;
    out[0] = in[1];
    out[1] = in[1] * in[1] - 4 * in[0] * in[0];
}

static void sag_jacobian(void *self, const double *in, double *values)
{
    (void)self;
    values[0] = 1;
    values[1] = 2 * in[1];
    values[2] = -8 * in[0];
}

static void sag_hessian(void *self, const double *in, const double *weight, double *values)
{
    (void)in;
    values[0] = 2 * weight[1];
    values[1] = *(const bool *)self ? -8 * weight[1] : 8 * weight[1];
}

static moray_certificate sag(bool right_hessian, double *along_all)
{
    static int row[] = {0, 1, 1}, col[] = {1, 1, 0}, both[] = {1, 0};
    const moray_map map = {.n_in = 3,
                           .n_out = 2,
                           .jac = {.nnz = 3, .row = row, .col = col},
                           .hess = {.nnz = 2, .row = both, .col = both},
                           .value = sag_value,
                           .jacobian = sag_jacobian,
                           .hessian = sag_hessian,
                           .self = &right_hessian};
    const moray_phase_spec phase = {.name = "chord",
                                    .nx = 1,
                                    .nu = 1,
                                    .nq = 1,
                                    .map = &map,
                                    .tf = moray_fixed(2),
                                    .x = MORAY_BOUNDS(moray_between(-5, 5)),
                                    .x0 = MORAY_BOUNDS(moray_fixed(0)),
                                    .xf = MORAY_BOUNDS(moray_fixed(0))};
    moray_ocp *ocp;
    moray_solution *solution;
    moray_settings settings = moray_settings_default();
    settings.scheme = "trapezoid";
    settings.intervals = 4000;
    CHECK_OK(moray_ocp_new(&ocp, &(moray_ocp_spec){.phases = 1, .phase = &phase, .endpoint = total}), "a chord");
    CHECK_OK(moray_solve(ocp, &settings, NULL, &solution), "solved");
    const moray_certificate c = certify(solution);
    struct witness w;
    CHECK_OK(moray_witness_of_sizes(&w, solution), "sizes");
    CHECK_OK(moray_difference_solution(&w, along_all), "directions through all nodes");
    moray_witness_free(&w);
    moray_solution_free(solution);
    moray_ocp_free(ocp);
    return c;
}

static void test_hessian_of_many_nodes(void)
{
    double along_all;
    moray_certificate c = sag(false, &along_all);
    CHECK(c.curvature == 0 && c.kkt <= MORAY_LIMIT_KKT && along_all < MORAY_LIMIT_DIRECTIONS,
          "a Hessian that makes a minimum of a saddle; along all nodes: %.1e", along_all);
    CHECK(!c.pass && c.directions > MORAY_LIMIT_DIRECTIONS && strstr(c.why, "a second derivative in phase chord"),
          "which is told: %s", c.why);
    c = sag(true, &along_all);
    CHECK(c.curvature == 0 && c.directions < MORAY_LIMIT_DIRECTIONS, "the right one leads away: %.1e", c.directions);
}

// ---- One wrong entry in the Hessian of the endpoint, whichever it is: least integral of u^2 and squares of the ends
//      of states that all have the rate u ----

enum { ends_nx = 6, ends_xf = ends_nx + 1, ends_q = ends_xf + ends_nx + 1, ends_in = ends_q + 1 };

static void together(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    for (int i = 0; i < ends_nx; i++)
        out->f[i] = at->u[0];
    out->g[0] = at->u[0] * at->u[0];
}

static void squares_value(void *self, const double *in, double *out)
{
    (void)self;
    out[0] = in[ends_q];
    for (int i = 0; i < ends_nx; i++)
        out[0] += in[i] * in[i] + (in[ends_xf + i] - 1) * (in[ends_xf + i] - 1);
}

static void squares_jacobian(void *self, const double *in, double *values)
{
    (void)self;
    for (int i = 0; i < ends_nx; i++) {
        values[i] = 2 * in[i];
        values[ends_nx + i] = 2 * (in[ends_xf + i] - 1);
    }
    values[2 * ends_nx] = 1;
}

static void squares_hessian(void *self, const double *in, const double *weight, double *values)
{
    (void)in;
    for (int i = 0; i < 2 * ends_nx; i++)
        values[i] = i == *(const int *)self ? 0 : 2 * weight[0];
}

static void test_hessian_of_ends(void)
{
    int row[2 * ends_nx + 1] = {0}, col[2 * ends_nx + 1], wrong;
    for (int i = 0; i < ends_nx; i++)
        col[i] = i, col[ends_nx + i] = ends_xf + i;
    col[2 * ends_nx] = ends_q;
    const moray_map map = {.n_in = ends_in,
                           .n_out = 1,
                           .jac = {.nnz = 2 * ends_nx + 1, .row = row, .col = col},
                           .hess = {.nnz = 2 * ends_nx, .row = col, .col = col},
                           .value = squares_value,
                           .jacobian = squares_jacobian,
                           .hessian = squares_hessian,
                           .self = &wrong};
    const moray_phase_spec phase = {.name = "ends",
                                    .nx = ends_nx,
                                    .nu = 1,
                                    .nq = 1,
                                    .continuous = together,
                                    .tf = moray_fixed(1),
                                    .x =
                                        MORAY_BOUNDS(moray_between(-5, 5), moray_between(-5, 5), moray_between(-5, 5),
                                                     moray_between(-5, 5), moray_between(-5, 5), moray_between(-5, 5))};
    for (wrong = -1; wrong < 2 * ends_nx; wrong++) {
        moray_ocp *ocp;
        moray_solution *solution;
        const moray_settings settings = moray_settings_default();
        CHECK_OK(moray_ocp_new(&ocp, &(moray_ocp_spec){.phases = 1, .phase = &phase, .endpoint_map = &map}), "ends");
        CHECK_OK(moray_solve(ocp, &settings, NULL, &solution), "solved");
        const moray_certificate c = certify(solution);
        struct witness w;
        double at_ends = 0;
        char where[200] = "";
        CHECK_OK(moray_witness_new(&w, solution), "witness");
        CHECK_OK(moray_difference_bends(&w, &at_ends, where, sizeof where), "along directions at the ends");
        if (wrong < 0)
            CHECK(c.pass && at_ends < 1e-6, "all right: %.1e %s", at_ends, c.why);
        else
            CHECK(!c.pass && at_ends > MORAY_LIMIT_DIRECTIONS && strstr(where, "second derivative of the endpoint"),
                  "entry %d: %.1e, %s", wrong, at_ends, where);
        moray_witness_free(&w);
        moray_solution_free(solution);
        moray_ocp_free(ocp);
    }
}

int main(void)
{
    test_hessian_of_ends();
    test_hessian_of_many_nodes();
    test_right_solution();
    test_wrong_derivatives();
    test_wrong_meshes();
    test_stopped_early();
    test_spoiled();
    test_negated();
    test_edited_objective();
    test_wrong_units();
    test_maximum_at_bounds();
    test_spike();
    test_disagreement();
    test_saddle();
    return tap_done();
}
