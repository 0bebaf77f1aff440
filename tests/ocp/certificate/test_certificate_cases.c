// SPDX-License-Identifier: MIT
//
// Problems whose wrong answers once passed, and right ones that were refused.
#include "tap.h"

#include <stdlib.h>
#include <string.h>
#include <tgmath.h>

#include "moray/ocp.h"

#include "ocp/certificate/bends.h"
#include "rk4.h"
#include "symmetric_line.h"

static const int rk4_steps = 40;
static const moray_integrator rk4 = {rk4_run, &rk4_steps};

static moray_solution *solve(const moray_ocp *ocp, const moray_settings *settings, moray_certificate *certificate)
{
    moray_solution *solution = NULL;
    CHECK_OK(moray_solve(ocp, settings, NULL, &solution), "solved");
    if (!solution)
        exit(1);
    CHECK_OK(moray_certify(solution, &rk4, certificate), "certificate");
    return solution;
}

// ---- A maximum: minimise -x(1)^2, x' = u, |u| <= 1, from the symmetric start; the optimum is -1 ----

static void test_maximum(void)
{
    const char *schemes[] = {"hermite-simpson", "radau3", "gauss2"};
    moray_ocp *ocp = NULL;
    CHECK_OK(symmetric_line_new(&ocp), "a maximum");
    for (unsigned k = 0; k < sizeof schemes / sizeof *schemes; k++) {
        moray_settings settings = moray_settings_default();
        moray_certificate certificate;
        settings.scheme = schemes[k];
        moray_solution *solution = solve(ocp, &settings, &certificate);
        CHECK_NEAR(moray_solution_objective(solution), -1, 1e-6, "the saddle of the start is left");
        CHECK(certificate.pass && certificate.curvature == 0, "%s: passes %s", schemes[k], certificate.why);
        moray_solution_free(solution);
    }
    moray_ocp_free(ocp);
}

// ---- Held by a path constraint: g = -u^2, which bends down, and 1 + x - u >= 1/2 beside x + 1e9 >= 0; x = exp(-t)
// ----
// ----

static void fenced(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    const moray_num u = at->u[0];
    out->f[0] = -at->x[0];
    out->c[0] = at->x[0] + 1e9;
    out->c[1] = 1 + at->x[0] - u;
    out->g[0] = -u * u;
}

static void total(const moray_ends *at, moray_end_values *out, const void *data);

// The row that holds the control is told from the one beside it, which is far from its limit.
static void test_fenced(void)
{
    const moray_phase_spec pen = {
        .name = "pen",
        .nx = 1,
        .nu = 1,
        .nc = 2,
        .nq = 1,
        .continuous = fenced,
        .t0 = moray_fixed(0),
        .tf = moray_fixed(1),
        .x0 = MORAY_BOUNDS(moray_fixed(1)),
        .u = MORAY_BOUNDS(moray_between(0, 5)),
        .c = MORAY_BOUNDS(moray_between(0, MORAY_INFINITY), moray_between(0.5, MORAY_INFINITY))};
    moray_ocp *ocp = NULL;
    moray_certificate certificate;
    const moray_settings settings = moray_settings_default();
    CHECK_OK(moray_ocp_new(&ocp, &(moray_ocp_spec){.phases = 1, .phase = &pen, .endpoint = total}), "a pen");
    moray_solution *solution = solve(ocp, &settings, &certificate);
    CHECK_NEAR(moray_solution_objective(solution), -1.75 + exp(-1) + exp(-2) / 2, 1e-6, "the control at its fence");
    CHECK(certificate.pass && certificate.curvature == 0, "no saddle: %s", certificate.why);
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

// ---- A control that stands still at a maximum, of the integrand alone: g = 1 + x^2 - (u - m)^2 / 2, x = exp(-t) ----

static void idle(const moray_node *at, moray_rates *out, const void *data)
{
    const double middle = *(const double *)data;
    const moray_num away = at->u[0] - middle;
    out->f[0] = -at->x[0];
    out->g[0] = 1 + at->x[0] * at->x[0] - away * away / 2;
}

// Its range is nothing and its magnitude may be anything: its box tells how far it could go.
static void test_idle_control(double middle)
{
    const moray_phase_spec phase = {.name = "idle",
                                    .nx = 1,
                                    .nu = 1,
                                    .nq = 1,
                                    .continuous = idle,
                                    .t0 = moray_fixed(0),
                                    .tf = moray_fixed(1),
                                    .x0 = MORAY_BOUNDS(moray_fixed(1)),
                                    .u = MORAY_BOUNDS(moray_between(middle - 1, middle + 1))};
    moray_ocp *ocp = NULL;
    moray_certificate certificate;
    const moray_settings settings = moray_settings_default();
    CHECK_OK(moray_ocp_new(&ocp, &(moray_ocp_spec){.phases = 1, .phase = &phase, .endpoint = total, .data = &middle}),
             "an idle control");
    moray_solution *solution = solve(ocp, &settings, &certificate);
    CHECK_NEAR(moray_solution_objective(solution), 0.5 + (1 - exp(-2)) / 2, 1e-6, "the maximum of the start is left");
    CHECK(certificate.pass && certificate.curvature == 0, "middle %g: passes %s", middle, certificate.why);
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

// ---- A parameter at a maximum: 1 - (s - m)^2 / 2 at the end ----

static void leaning(const moray_ends *at, moray_end_values *out, const void *data)
{
    const moray_num away = at->s[0] - *(const double *)data;
    out->objective = at->phase[0].xf[0] - away * away / 2;
}

static void fading(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = -at->x[0];
}

static void test_idle_parameter(double middle)
{
    const moray_phase_spec phase = {.name = "idle",
                                    .nx = 1,
                                    .continuous = fading,
                                    .t0 = moray_fixed(0),
                                    .tf = moray_fixed(1),
                                    .x0 = MORAY_BOUNDS(moray_fixed(1))};
    moray_ocp *ocp = NULL;
    moray_certificate certificate;
    const moray_settings settings = moray_settings_default();
    CHECK_OK(moray_ocp_new(&ocp, &(moray_ocp_spec){.phases = 1,
                                                   .phase = &phase,
                                                   .ns = 1,
                                                   .s = MORAY_BOUNDS(moray_between(middle - 1, middle + 1)),
                                                   .endpoint = leaning,
                                                   .data = &middle}),
             "an idle parameter");
    moray_solution *solution = solve(ocp, &settings, &certificate);
    CHECK_NEAR(moray_solution_objective(solution), exp(-1) - 0.5, 1e-6, "the maximum of the start is left");
    CHECK(certificate.pass && certificate.curvature == 0, "parameter at %g: passes %s", middle, certificate.why);
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

// ---- A kink: g = 0.05 u^2 + |u| by fabs, whose complex step is 0; x' = u - 0.3 x, from 0 to 1 in 5 s ----

static void kinked(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    const moray_num u = at->u[0];
    out->f[0] = u - 0.3 * at->x[0];
    out->g[0] = 0.05 * u * u + fabs(u);
}

// A dependence that the complex step does not see, as behind a call of a function of doubles.
static void hidden(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    const moray_num u = at->u[0];
    out->f[0] = u - 0.3 * creal(at->x[0]);
    out->g[0] = 0.05 * u * u;
}

static void total(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase[0].q[0];
}

static void test_unseen(moray_continuous_fn *continuous, const char *what, const char *named)
{
    const moray_phase_spec tank = {.name = "tank",
                                   .nx = 1,
                                   .nu = 1,
                                   .nq = 1,
                                   .continuous = continuous,
                                   .t0 = moray_fixed(0),
                                   .tf = moray_fixed(5),
                                   .x0 = MORAY_BOUNDS(moray_fixed(0)),
                                   .xf = MORAY_BOUNDS(moray_fixed(1)),
                                   .u = MORAY_BOUNDS(moray_between(-5, 5))};
    moray_ocp *ocp = NULL;
    moray_settings settings = moray_settings_default();
    moray_certificate certificate;
    CHECK_OK(moray_ocp_new(&ocp, &(moray_ocp_spec){.phases = 1, .phase = &tank, .endpoint = total}), what);
    moray_solution *solution = solve(ocp, &settings, &certificate);
    CHECK(!certificate.pass && certificate.derivatives > 0.1 && strstr(certificate.why, named), "%s fails: %s", what,
          certificate.why);
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

// ---- Least time over a distance d from rest to rest, |u| <= a: 2 sqrt(d / a) after t0 ----

struct dash {
    double distance, push, start;
};

static void run_dash(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = at->x[1];
    out->f[1] = at->u[0];
}

static void soon(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase[0].tf;
}

// In whatever units, from whatever time on.
static void test_dash(const struct dash *dash)
{
    const double least = 2 * sqrt(dash->distance / dash->push);
    const moray_phase_spec track = {.name = "track",
                                    .nx = 2,
                                    .nu = 1,
                                    .continuous = run_dash,
                                    .t0 = moray_fixed(dash->start),
                                    .tf = moray_between(dash->start, dash->start + 10 * least),
                                    .x0 = MORAY_BOUNDS(moray_fixed(0), moray_fixed(0)),
                                    .xf = MORAY_BOUNDS(moray_fixed(dash->distance), moray_fixed(0)),
                                    .u = MORAY_BOUNDS(moray_between(-dash->push, dash->push))};
    moray_ocp *ocp = NULL;
    moray_settings settings = moray_settings_default();
    moray_certificate certificate;
    settings.scheme = "gauss2"; // whose control may jump between intervals
    CHECK_OK(moray_ocp_new(&ocp, &(moray_ocp_spec){.phases = 1, .phase = &track, .endpoint = soon}), "least time");
    moray_solution *solution = solve(ocp, &settings, &certificate);
    const double found = (moray_solution_objective(solution) - dash->start) / least;
    CHECK(fabs(found - 1) < 1e-4 && certificate.pass, "%g m at %g m/s^2 from t = %g: %.6g of the least time, %s %s",
          dash->distance, dash->push, dash->start, found, certificate.pass ? "passes" : "fails:", certificate.why);
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

// ---- A phase without length ----

static void keep_still(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase[1].xf[0] * at->phase[1].xf[0];
    out->e[0] = at->phase[1].x0[0] - at->phase[0].xf[0];
    out->e[1] = at->phase[1].t0 - at->phase[0].tf;
}

static void test_no_length(void)
{
    const moray_phase_spec phases[] = {{.name = "way",
                                        .nx = 1,
                                        .nu = 1,
                                        .continuous = symmetric_drift,
                                        .t0 = moray_fixed(0),
                                        .tf = moray_fixed(1),
                                        .x0 = MORAY_BOUNDS(moray_fixed(1)),
                                        .u = MORAY_BOUNDS(moray_between(-1, 1))},
                                       {.name = "rest",
                                        .nx = 1,
                                        .nu = 1,
                                        .continuous = symmetric_drift,
                                        .t0 = moray_fixed(1),
                                        .tf = moray_fixed(1),
                                        .u = MORAY_BOUNDS(moray_between(-1, 1))}};
    moray_ocp *ocp = NULL;
    moray_settings settings = moray_settings_default();
    moray_certificate certificate;
    CHECK_OK(moray_ocp_new(&ocp, &(moray_ocp_spec){.phases = 2,
                                                   .phase = phases,
                                                   .ne = 2,
                                                   .e = MORAY_BOUNDS(moray_fixed(0), moray_fixed(0)),
                                                   .endpoint = keep_still}),
             "a phase without length");
    moray_solution *solution = solve(ocp, &settings, &certificate);
    CHECK(!certificate.pass && strstr(certificate.why, "phase rest has no length"), "%s", certificate.why);
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

// ---- Time has a direction: two phases whose times share one window, and a bonus for a final time before the first
// ----

static void early(const moray_ends *at, moray_end_values *out, const void *data)
{
    const moray_phase_ends *one = &at->phase[0], *other = &at->phase[1];
    (void)data;
    out->objective = one->tf - one->t0 + 0.5 * (other->tf - other->t0); // the second runs backwards if it may
    out->e[0] = other->t0 - one->tf;
    out->e[1] = other->x0[0] - one->xf[0];
}

static void test_direction_of_time(void)
{
    const moray_phase_spec half = {.nx = 1,
                                   .nu = 1,
                                   .continuous = symmetric_drift,
                                   .t0 = moray_between(0, 10),
                                   .tf = moray_between(0, 10),
                                   .u = MORAY_BOUNDS(moray_between(0.5, 1))};
    moray_phase_spec phases[] = {half, half};
    moray_ocp *ocp = NULL;
    moray_settings settings = moray_settings_default();
    moray_certificate certificate;
    phases[0].x0 = (moray_bounds_list)MORAY_BOUNDS(moray_fixed(0));
    phases[1].x0 = (moray_bounds_list)MORAY_BOUNDS(moray_at_least(1));
    phases[1].xf = (moray_bounds_list)MORAY_BOUNDS(moray_between(-5, 3));
    CHECK_OK(moray_ocp_new(&ocp, &(moray_ocp_spec){.phases = 2,
                                                   .phase = phases,
                                                   .ne = 2,
                                                   .e = MORAY_BOUNDS(moray_fixed(0), moray_fixed(0)),
                                                   .endpoint = early}),
             "times that share a window");
    moray_solution *solution = solve(ocp, &settings, &certificate);
    CHECK_NEAR(moray_solution_objective(solution), 1, 1e-5, "one way of a second, and no time won back");
    CHECK(!certificate.pass && strstr(certificate.why, "has no length"), "told: %s", certificate.why);
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

// ---- Zermelo's crossing (problems/classics/zermelo.c), where x has a say by rounding alone, as in a table over (x, y)
// ----

static void drift_and_noise(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = cos(at->u[0]) - at->x[1] + 1e-16 * at->x[0];
    out->f[1] = sin(at->u[0]);
}

static void test_idle_argument(void)
{
    const moray_phase_spec crossing = {.name = "crossing",
                                       .nx = 2,
                                       .nu = 1,
                                       .continuous = drift_and_noise,
                                       .tf = moray_between(0.1, 100),
                                       .x0 = MORAY_BOUNDS(moray_fixed(3.66), moray_fixed(-1.86)),
                                       .xf = MORAY_BOUNDS(moray_fixed(0), moray_fixed(0))};
    const double deg = 3.14159265358979323846 / 180, t[] = {0, 5}, x[] = {3.66, -1.86, 0, 0},
                 u[] = {90 * deg, 250 * deg};
    const moray_samples straight = {2, t, x, u};
    const moray_guess guess = {.phase = &straight};
    moray_settings settings = moray_settings_default();
    moray_ocp *ocp = NULL;
    moray_solution *solution = NULL;
    moray_certificate certificate = {0};
    settings.scheme = "gauss3";
    settings.max_refinements = 20;
    CHECK_OK(moray_ocp_new(&ocp, &(moray_ocp_spec){.phases = 1, .phase = &crossing, .endpoint = soon}), "a crossing");
    CHECK_OK(moray_solve(ocp, &settings, &guess, &solution), "solved");
    CHECK_OK(moray_certify(solution, &rk4, &certificate), "certificate");
    CHECK_NEAR(moray_solution_objective(solution), 5.4578652636, 1e-6, "the closed form");
    CHECK(certificate.pass, "what moves nothing but the last digit refuses no answer: %s", certificate.why);
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

// ---- A wrong second derivative of the second of two integrals: least integrals of u^2 and (x - 2)^4, x' = u, x = 0 at
//      both ends, beside a state of the same rate of which nothing is asked, so that its multipliers are 0 ----

static void bow_value(void *self, const double *in, double *out)
{
    (void)self;
    out[0] = out[1] = in[2];
    out[2] = in[2] * in[2];
    out[3] = pow(in[0] - 2, 4);
}

static void bow_jacobian(void *self, const double *in, double *values)
{
    (void)self;
    values[0] = values[1] = 1;
    values[2] = 2 * in[2];
    values[3] = 4 * pow(in[0] - 2, 3);
}

static void bow_hessian(void *self, const double *in, const double *weight, double *values)
{
    const bool right = *(const bool *)self;
    values[0] = 2 * weight[2];
    values[1] = (right ? 12 : 6) * pow(in[0] - 2, 2) * weight[3];
}

static void both_integrals(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase[0].q[0] + at->phase[0].q[1];
}

static void test_second_integral(bool right)
{
    static int row[] = {0, 1, 2, 3}, col[] = {2, 2, 2, 0}, both[] = {2, 0};
    const moray_map map = {.n_in = 4,
                           .n_out = 4,
                           .jac = {.nnz = 4, .row = row, .col = col},
                           .hess = {.nnz = 2, .row = both, .col = both},
                           .value = bow_value,
                           .jacobian = bow_jacobian,
                           .hessian = bow_hessian,
                           .self = &right};
    const moray_phase_spec phase = {.name = "bow",
                                    .nx = 2,
                                    .nu = 1,
                                    .nq = 2,
                                    .map = &map,
                                    .tf = moray_fixed(1),
                                    .x0 = MORAY_BOUNDS(moray_fixed(0), moray_fixed(0)),
                                    .xf = MORAY_BOUNDS(moray_fixed(0), moray_free())};
    moray_ocp *ocp = NULL;
    moray_certificate certificate;
    moray_settings settings = moray_settings_default();
    struct witness w;
    double bends = 0;
    char where[200] = "";
    settings.intervals = 100;
    CHECK_OK(moray_ocp_new(&ocp, &(moray_ocp_spec){.phases = 1, .phase = &phase, .endpoint = both_integrals}), "a bow");
    moray_solution *solution = solve(ocp, &settings, &certificate);
    CHECK_OK(moray_witness_new(&w, solution), "witness");
    CHECK_OK(moray_difference_bends(&w, &bends, where, sizeof where), "bends");
    CHECK(certificate.pass == right, "passes only with the right one: %s", certificate.why);
    if (right)
        CHECK(bends < 1e-6, "the right one is: %.1e, %s", bends, where);
    else
        CHECK(bends > MORAY_LIMIT_DIRECTIONS && strstr(where, "second derivative in phase bow"), "told: %.1e, %s",
              bends, where);
    moray_witness_free(&w);
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

int main(void)
{
    const struct dash dashes[] = {{1, 1, 0},     {1e-6, 1e-6, 0}, {1e-9, 1e-9, 0}, {1e-9, 1, 0},
                                  {1e6, 1e6, 0}, {1e9, 1e3, 0},   {1, 1, 1e4},     {1, 1, 1e6},
                                  {1e12, 1, 0},  {1, 1e-12, 0},   {1e-6, 1, 0},    {1, 1, -1e4}};
    test_maximum();
    test_fenced();
    test_idle_control(0);
    test_idle_control(0.5);
    test_idle_control(20);
    test_idle_parameter(0);
    test_idle_parameter(1e-9);
    test_idle_parameter(0.5);
    test_unseen(kinked, "fabs", "control u[0]");
    test_unseen(hidden, "a hidden creal", "state x[0]");
    for (unsigned k = 0; k < sizeof dashes / sizeof *dashes; k++)
        test_dash(&dashes[k]);
    test_no_length();
    test_direction_of_time();
    test_idle_argument();
    test_second_integral(true);
    test_second_integral(false);
    return tap_done();
}
