// SPDX-License-Identifier: MIT
//
// The check of a problem's derivatives on maps by hand with one entry wrong by a known amount: which it names, with
// which numbers; where it asks; and what it does where functions are not finite.
#include "tap.h"

#include <string.h>

#include "moray/ocp.h"

enum { nx = 2, n_in = 5, n_out = 3, jacobian_entries = 8, hessian_entries = 4 };

// f0 = x0 x1 + u, f1 = 3 u^2 + s x0, c = 2 x1^2 + t
static int jac_row[] = {0, 0, 0, 1, 1, 1, 2, 2}, jac_col[] = {0, 1, 2, 0, 2, 3, 1, 4}, hess_row[] = {1, 1, 2, 3},
           hess_col[] = {0, 1, 2, 0};
static const int hess_output[] = {0, 2, 1, 1};
static const double hess_value[] = {1, 4, 6, 1};

struct lab {
    double jacobian_slip[jacobian_entries], hessian_slip[hessian_entries],
        joint_slip;                 // of entries; of the last two together
    double finite_below;            // of x0
    double least[n_in], most[n_in]; // where it was asked
    double least_weight, most_weight, weights_apart;
};

static void value(void *self, const double *in, double *out)
{
    struct lab *lab = self;
    out[0] = in[0] < lab->finite_below ? in[0] * in[1] + in[2] : NAN;
    out[1] = 3 * in[2] * in[2] + in[3] * in[0];
    out[2] = 2 * in[1] * in[1] + in[4];
    for (int j = 0; j < n_in; j++)
        lab->least[j] = fmin(lab->least[j], in[j]), lab->most[j] = fmax(lab->most[j], in[j]);
}

static void jacobian(void *self, const double *in, double *values)
{
    const struct lab *lab = self;
    const double right[] = {in[1], in[0], 1, in[3], 6 * in[2], in[0], 4 * in[1], 1};
    for (int k = 0; k < jacobian_entries; k++)
        values[k] = right[k] + lab->jacobian_slip[k];
}

static void hessian(void *self, const double *in, const double *weight, double *values)
{
    struct lab *lab = self;
    (void)in;
    for (int k = 0; k < hessian_entries; k++)
        values[k] = weight[hess_output[k]] * (hess_value[k] + lab->hessian_slip[k]);
    if (weight[1] * weight[2] != 0)
        values[2] += lab->joint_slip;
    for (int i = 0; i < n_out; i++) {
        lab->least_weight = fmin(lab->least_weight, weight[i]), lab->most_weight = fmax(lab->most_weight, weight[i]);
        lab->weights_apart = fmin(lab->weights_apart, fabs(weight[i] - weight[(i + 1) % n_out]));
    }
}

static struct lab lab;
static const moray_map map = {.n_in = n_in,
                              .n_out = n_out,
                              .self = &lab,
                              .jac = {jacobian_entries, jac_row, jac_col},
                              .hess = {hessian_entries, hess_row, hess_col},
                              .value = value,
                              .jacobian = jacobian,
                              .hessian = hessian};

static struct lab flawless(void)
{
    struct lab fresh = {.finite_below = INFINITY, .least_weight = INFINITY, .weights_apart = INFINITY};
    fresh.most_weight = -INFINITY;
    for (int j = 0; j < n_in; j++)
        fresh.least[j] = INFINITY, fresh.most[j] = -INFINITY;
    return fresh;
}

// ---- The endpoint, J = x0[0] x0[1] and e = 5 tf, likewise: in = [x0, t0, xf, tf, s] ----

static int end_row[] = {0, 0, 1}, end_col[] = {0, 1, 5}, end_hess_row[] = {1}, end_hess_col[] = {0};
static double end_slip, end_bend;
static bool end_finite = true;

static void end_value(void *self, const double *in, double *out)
{
    (void)self;
    out[0] = end_finite ? in[0] * in[1] : INFINITY;
    out[1] = 5 * in[5];
}

static void end_jacobian(void *self, const double *in, double *values)
{
    (void)self;
    values[0] = in[1], values[1] = in[0], values[2] = 5 + end_slip;
}

static void end_hessian(void *self, const double *in, const double *weight, double *values)
{
    (void)self, (void)in;
    values[0] = weight[0] * (1 + end_bend);
}

static const moray_map ends = {.n_in = 7,
                               .n_out = 2,
                               .jac = {3, end_row, end_col},
                               .hess = {1, end_hess_row, end_hess_col},
                               .value = end_value,
                               .jacobian = end_jacobian,
                               .hessian = end_hessian};

// ---- What is observed: y0 = u, y1 = 7 x1 ----

static int seen_row[] = {0, 1}, seen_col[] = {2, 1};
static double seen_slip;

static void seen_value(void *self, const double *in, double *out)
{
    (void)self;
    out[0] = in[2], out[1] = 7 * in[1];
}

static void seen_jacobian(void *self, const double *in, double *values)
{
    (void)self, (void)in;
    values[0] = 1, values[1] = 7 + seen_slip;
}

static void seen_hessian(void *self, const double *in, const double *weight, double *values)
{
    (void)self, (void)in, (void)weight, (void)values;
}

static const moray_map seen = {.n_in = n_in,
                               .n_out = 2,
                               .jac = {2, seen_row, seen_col},
                               .value = seen_value,
                               .jacobian = seen_jacobian,
                               .hessian = seen_hessian};

static moray_ocp *problem(void)
{
    static const double time[] = {0.25}, observed[] = {0, 0};
    const moray_phase_spec phase = {.name = "leg",
                                    .nx = nx,
                                    .nu = 1,
                                    .nc = 1,
                                    .map = &map,
                                    .t0 = moray_between(0, 0.125),
                                    .tf = moray_between(0.5, 3),
                                    .x = MORAY_BOUNDS(moray_between(8, 10), moray_between(-0.01, 0.3)),
                                    .u = MORAY_BOUNDS(moray_between(-10, -8)),
                                    .c = MORAY_BOUNDS(moray_free()),
                                    .observed = {.n = 1, .ny = 2, .time = time, .value = observed, .map = &seen}};
    moray_ocp *ocp = NULL;
    CHECK_OK(moray_ocp_new(&ocp, &(moray_ocp_spec){.name = "task",
                                                   .phases = 1,
                                                   .phase = &phase,
                                                   .ns = 1,
                                                   .s = MORAY_BOUNDS(moray_between(0.375, 0.375)),
                                                   .ne = 1,
                                                   .e = MORAY_BOUNDS(moray_free()),
                                                   .endpoint_map = &ends}),
             "problem");
    return ocp;
}

static moray_ocp_derivative_report report_of(const moray_ocp *ocp)
{
    moray_ocp_derivative_report report;
    CHECK_OK(moray_ocp_check_derivatives(ocp, &report), "checked");
    return report;
}

// The text, and that the number that is given is off by so much.
static void check_says(const char *text, const char *what, double slip)
{
    double given = NAN, reference = NAN;
    const size_t length = strlen(what);
    const bool named = strncmp(text, what, length) == 0;
    CHECK(named && sscanf(text + length, " is %lf, by differences %lf", &given, &reference) == 2, "%s", text);
    CHECK(fabs(given - reference - slip) < 1e-5, "%g for %g", given, reference);
}

// Of a second derivative: by both inputs in either order.
static void check_bend(const char *text, const char *of, const char *one, const char *other, double slip)
{
    char what[200], turned[200];
    snprintf(what, sizeof what, "%s / d (%s) d (%s)", of, one, other);
    snprintf(turned, sizeof turned, "%s / d (%s) d (%s)", of, other, one);
    check_says(text, strncmp(text, turned, strlen(turned)) == 0 ? turned : what, slip);
}

static const char *const inputs[] = {"state x[0]", "state x[1]", "control u[0]", "parameter s[0]", "time"},
                         *const outputs[] = {"dynamics of state x[0]", "dynamics of state x[1]",
                                             "path constraint c[0]"};

static void test_right(const moray_ocp *ocp)
{
    static const double lower[] = {8, -0.01, -10, 0.375, 0}, upper[] = {10, 0.3, -8, 0.375, 3};
    lab = flawless();
    const moray_ocp_derivative_report report = report_of(ocp);
    CHECK(report.jacobian_error >= 0 && report.jacobian_error < 1e-8 && report.hessian_error >= 0 &&
              report.hessian_error < 1e-8,
          "right ones pass: %.1e, %.1e", report.jacobian_error, report.hessian_error);
    for (int j = 0; j < n_in; j++)
        if (lower[j] < upper[j])
            CHECK(lab.least[j] >= lower[j] && lab.least[j] < lower[j] + 1e-5 && lab.most[j] <= upper[j] &&
                      lab.most[j] > upper[j] - 1e-5,
                  "%s is asked from bound to bound: %.9g to %.9g", inputs[j], lab.least[j], lab.most[j]);
    CHECK(lab.least_weight >= 0.7 && lab.least_weight < 0.71 && lab.most_weight <= 1.3 && lab.most_weight > 1.29 &&
              lab.weights_apart > 0,
          "outputs are told apart: %g to %g", lab.least_weight, lab.most_weight);
}

static void test_jacobian(const moray_ocp *ocp)
{
    for (int k = 0; k < jacobian_entries; k++) {
        char what[200];
        lab = flawless();
        lab.jacobian_slip[k] = k % 2 ? 0.5 : -2;
        const moray_ocp_derivative_report report = report_of(ocp);
        snprintf(what, sizeof what, "phase leg: d (%s) / d (%s)", outputs[jac_row[k]], inputs[jac_col[k]]);
        check_says(report.jacobian, what, lab.jacobian_slip[k]);
    }
    lab = flawless();
    lab.jacobian_slip[2] = 0.5; // of 1, everywhere
    CHECK_NEAR(report_of(ocp).jacobian_error, 0.5 / (1 + 1), 1e-8, "relative to 1 and the right one");
    lab.jacobian_slip[5] = 100; // of 8 to 10
    const moray_ocp_derivative_report worse = report_of(ocp);
    check_says(worse.jacobian, "phase leg: d (dynamics of state x[1]) / d (parameter s[0])", 100);
    CHECK(worse.jacobian_error > 100 / 9.5 && worse.jacobian_error < 100 / 9., "where that is worst: %g",
          worse.jacobian_error);
    lab.jacobian_slip[0] = NAN;
    const moray_ocp_derivative_report none = report_of(ocp);
    CHECK(none.jacobian_error == INFINITY &&
              strncmp(none.jacobian, "phase leg: d (dynamics of state x[0]) / d (state x[0]) is ", 58) == 0,
          "one that is no number is worst: %s", none.jacobian);
}

static void test_hessian(const moray_ocp *ocp)
{
    for (int k = 0; k < hessian_entries; k++) {
        char what[200];
        lab = flawless();
        lab.hessian_slip[k] = k % 2 ? 0.5 : -2;
        const moray_ocp_derivative_report report = report_of(ocp);
        snprintf(what, sizeof what, "phase leg: d2 (%s)", outputs[hess_output[k]]);
        check_bend(report.hessian, what, inputs[hess_row[k]], inputs[hess_col[k]], lab.hessian_slip[k]);
        CHECK(report.hessian_error > 0.05, "%g", report.hessian_error);
    }
    lab = flawless();
    lab.hessian_slip[0] = 2, lab.hessian_slip[1] = 0.5;
    check_bend(report_of(ocp).hessian, "phase leg: d2 (dynamics of state x[0])", inputs[1], inputs[0], 2);
    lab = flawless();
    lab.hessian_slip[2] = 0.7, lab.hessian_slip[1] = 5;
    check_says(report_of(ocp).hessian, "phase leg: d2 (path constraint c[0]) / d (state x[1]) d (state x[1])", 5);
    lab = flawless();
    lab.joint_slip = 3;
    check_says(report_of(ocp).hessian, "phase leg: d2 (weighted sum) / d (control u[0]) d (control u[0])", 3);
    lab = flawless();
    lab.hessian_slip[1] = NAN;
    CHECK(report_of(ocp).hessian_error == INFINITY, "one that is no number is worst");
}

static void test_others(const moray_ocp *ocp)
{
    lab = flawless();
    seen_slip = -3;
    check_says(report_of(ocp).jacobian, "phase leg: d (observation y[1]) / d (state x[1])", -3);
    seen_slip = 0, end_slip = 2;
    check_says(report_of(ocp).jacobian, "endpoint: d (event e[0]) / d (final time of phase leg)", 2);
    end_slip = 0, end_bend = 0.5;
    check_bend(report_of(ocp).hessian, "endpoint: d2 (objective)", "initial state x[1] of phase leg",
               "initial state x[0] of phase leg", 0.5);
    end_bend = 0;
}

static void test_finite(const moray_ocp *ocp)
{
    moray_ocp_derivative_report report;
    lab = flawless();
    lab.finite_below = 9; // at some points
    lab.jacobian_slip[7] = 4;
    check_says(report_of(ocp).jacobian, "phase leg: d (path constraint c[0]) / d (time)", 4);
    lab = flawless();
    lab.finite_below = 0;
    moray_status status = moray_ocp_check_derivatives(ocp, &report);
    CHECK(status.code == MORAY_NUMERIC &&
              strcmp(status.text, "leg: its functions are not finite at any of 32 points within the bounds") == 0,
          "%s", status.text);
    lab = flawless();
    end_finite = false;
    status = moray_ocp_check_derivatives(ocp, &report);
    CHECK(status.code == MORAY_NUMERIC &&
              strcmp(status.text, "endpoint: its functions are not finite at any of 32 points within the bounds") == 0,
          "%s", status.text);
    end_finite = true;
}

int main(void)
{
    moray_ocp *ocp = problem();
    test_right(ocp);
    test_jacobian(ocp);
    test_hessian(ocp);
    test_others(ocp);
    test_finite(ocp);
    moray_ocp_free(ocp);
    return tap_done();
}
