// SPDX-License-Identifier: MIT
//
// A wrong derivative is found, wherever it stands and at whatever point, and told with both numbers; right ones pass.
#include "tap.h"

#include "moray/map.h"

// y0 = x0^2 x1 + sin x2, y1 = exp(0.3 x0) - x1 x2; one entry of a derivative is off by some amount.
enum { N_IN = 3, N_OUT = 2, NNZ_JAC = 5, NNZ_HESS = 4 };
static int jac_row[NNZ_JAC] = {0, 0, 0, 1, 1}, jac_col[NNZ_JAC] = {0, 1, 2, 0, 1};
static int hess_row[NNZ_HESS] = {0, 1, 2, 2}, hess_col[NNZ_HESS] = {0, 0, 1, 2};

typedef struct planted {
    int jac, hess; // which entry; -1: none
    double by;
} planted;

static void value(void *self, const double *x, double *y)
{
    (void)self;
    y[0] = x[0] * x[0] * x[1] + sin(x[2]);
    y[1] = exp(0.3 * x[0]) - x[1] * x[2];
}

// d y1 / d x2 stands nowhere: x1 is 0 where that counts.
static void true_jacobian(const double *x, double *values)
{
    values[0] = 2 * x[0] * x[1];
    values[1] = x[0] * x[0];
    values[2] = cos(x[2]);
    values[3] = 0.3 * exp(0.3 * x[0]);
    values[4] = -x[2];
}

static void jacobian(void *self, const double *x, double *values)
{
    const planted *p = self;
    true_jacobian(x, values);
    if (p->jac >= 0)
        values[p->jac] += p->by;
}

static void true_hessian(const double *x, const double *weight, double *values)
{
    values[0] = weight[0] * 2 * x[1] + weight[1] * 0.09 * exp(0.3 * x[0]);
    values[1] = weight[0] * 2 * x[0];
    values[2] = -weight[1];
    values[3] = -weight[0] * sin(x[2]);
}

static void hessian(void *self, const double *x, const double *weight, double *values)
{
    const planted *p = self;
    true_hessian(x, weight, values);
    if (p->hess >= 0)
        values[p->hess] += p->by;
}

static moray_derivative_report report_of(planted p, const double *x, const double *weight)
{
    const moray_map map = {.n_in = N_IN,
                           .n_out = N_OUT,
                           .jac = {.nnz = NNZ_JAC, .row = jac_row, .col = jac_col},
                           .hess = {.nnz = NNZ_HESS, .row = hess_row, .col = hess_col},
                           .self = &p,
                           .value = value,
                           .jacobian = jacobian,
                           .hessian = hessian};
    moray_derivative_report report;
    CHECK_OK(moray_check_derivatives(&map, x, weight, &report), "checked");
    return report;
}

static const double weight[N_OUT] = {1.5, 0};
static const double points[][N_IN] = {{0.4, 0, 1.2}, {-1, 0, -1}, {-3, 0, -2.5}, {20, 0, 0}, {-1.5, 0, 1000}};
enum { POINTS = sizeof points / sizeof *points };

// Of the Jacobian alone, at points where all of its entries stand in the pattern.
static void test_jacobian(void)
{
    for (int i = 0; i < POINTS; i++) {
        double right[NNZ_JAC];
        true_jacobian(points[i], right);
        moray_derivative_report report = report_of((planted){-1, -1, 0}, points[i], weight);
        CHECK(report.jacobian_error < 1e-8, "point %d: a right one is right, to %.1e", i, report.jacobian_error);
        for (int k = 0; k < NNZ_JAC; k++)
            for (int sign = -1; sign < 2; sign += 2) {
                const double by = sign * 0.1 * (1 + fabs(right[k]));
                report = report_of((planted){k, -1, by}, points[i], weight);
                CHECK(report.jacobian_row == jac_row[k] && report.jacobian_col == jac_col[k],
                      "point %d: entry %d, %+g off, is found", i, k, by);
                CHECK_RELATIVE(report.jacobian_given, right[k] + by, 1e-14, "what is given");
                CHECK_RELATIVE(report.jacobian_reference, right[k], 1e-8, "what it should be");
                CHECK_NEAR(report.jacobian_error, 0.1, 1e-3, "by how much");
            }
    }
}

// Of the Hessian, whose reference is the Jacobian: on either side of the diagonal, whichever comes first.
static void test_hessian(void)
{
    for (int i = 0; i < POINTS; i++) {
        double right[NNZ_HESS];
        true_hessian(points[i], weight, right);
        moray_derivative_report report = report_of((planted){-1, -1, 0}, points[i], weight);
        CHECK(report.hessian_error < 1e-7, "point %d: a right one is right, to %.1e", i, report.hessian_error);
        for (int k = 0; k < NNZ_HESS; k++) {
            const double by = -0.1 * (1 + fabs(right[k]));
            report = report_of((planted){-1, k, by}, points[i], weight);
            CHECK((report.hessian_row == hess_row[k] && report.hessian_col == hess_col[k]) ||
                      (report.hessian_row == hess_col[k] && report.hessian_col == hess_row[k]),
                  "point %d: entry %d, %+g off, is found", i, k, by);
            CHECK_RELATIVE(report.hessian_given, right[k] + by, 1e-14, "what is given");
            CHECK_RELATIVE(report.hessian_reference, right[k], 1e-6, "what it should be");
        }
    }
}

// A zero in the pattern that is none.
static void test_missing(void)
{
    const moray_derivative_report report = report_of((planted){-1, -1, 0}, (double[]){0.4, 0.7, 1.2}, weight);
    CHECK(report.jacobian_row == 1 && report.jacobian_col == 2 && report.jacobian_given == 0, "is found");
    CHECK_NEAR(report.jacobian_reference, -0.7, 1e-8, "and told");
    const moray_derivative_report nan = report_of((planted){1, -1, NAN}, (double[]){0.4, 0.7, 1.2}, weight);
    CHECK(isnan(nan.jacobian_error) && nan.jacobian_row == 0 && nan.jacobian_col == 1, "what is no number is worse");
}

// ---- Large values --------------------------------------------------------------------------------------------------

static void constant(void *self, const double *x, double *y)
{
    (void)self, (void)x;
    y[0] = 0;
    y[1] = -1e12;
}

static void half(void *self, const double *x, double *values)
{
    (void)self, (void)x;
    values[0] = values[1] = 0.5;
}

static void nothing(void *self, const double *x, const double *w, double *values)
{
    (void)self, (void)x, (void)w, (void)values;
}

static void zeros(void *self, const double *x, double *y)
{
    (void)self, (void)x;
    y[0] = y[1] = 0;
}

// Of two that are as wrong the first is told.
static void test_first(void)
{
    int row[] = {0, 1}, col[] = {0, 0};
    const moray_map map = {.n_in = 1,
                           .n_out = 2,
                           .jac = {.nnz = 2, .row = row, .col = col},
                           .value = zeros,
                           .jacobian = half,
                           .hessian = nothing};
    const double x = 1;
    moray_derivative_report report;
    CHECK_OK(moray_check_derivatives(&map, &x, weight, &report), "checked");
    CHECK(report.jacobian_error == 0.5 && report.jacobian_row == 0, "row %d", report.jacobian_row);
}

// Rounding of a value leaves its slope in doubt by as much as it makes of the last difference; the other's it leaves.
static void test_doubt(void)
{
    int row[] = {0, 1}, col[] = {0, 0};
    const moray_map map = {.n_in = 1,
                           .n_out = 2,
                           .jac = {.nnz = 2, .row = row, .col = col},
                           .value = constant,
                           .jacobian = half,
                           .hessian = nothing};
    moray_map other = map;
    const double x = -3, step = 0.02 * (1 + fabs(x)) / 1024;
    moray_derivative_report report;
    CHECK_OK(moray_check_derivatives(&map, &x, weight, &report), "checked");
    CHECK(report.jacobian_row == 0 && report.jacobian_error == 0.5, "of what is 0 all is known: %g",
          report.jacobian_error);
    row[0] = 1, other.jac.nnz = 1;
    CHECK_OK(moray_check_derivatives(&other, &x, weight, &report), "checked");
    CHECK_NEAR(report.jacobian_error, 0.5 / (1 + 1e4 * 0x1p-52 * 1e12 / step), 1e-12, "of a large value little");
    CHECK(report.jacobian_row == 1, "in its row");
}

// ---- Where there is no value ---------------------------------------------------------------------------------------

static void none(void *self, const double *x, double *y)
{
    (void)self;
    y[0] = NAN;
    y[1] = x[0];
}

static void given(void *self, const double *x, double *values)
{
    (void)x;
    values[0] = *(double *)self;
    values[1] = 1;
}

// There is no reference for a slope of what is no number: a number is believed, no number is not.
static void test_none(void)
{
    int row[] = {0, 1}, col[] = {0, 0};
    double slope = 5;
    const moray_map map = {.n_in = 1,
                           .n_out = 2,
                           .jac = {.nnz = 2, .row = row, .col = col},
                           .self = &slope,
                           .value = none,
                           .jacobian = given,
                           .hessian = nothing};
    const double x = 2;
    moray_derivative_report report;
    CHECK_OK(moray_check_derivatives(&map, &x, weight, &report), "checked");
    CHECK(report.jacobian_error < 1e-9 && report.jacobian_row == 1, "a number: %g", report.jacobian_error);
    slope = NAN;
    CHECK_OK(moray_check_derivatives(&map, &x, weight, &report), "checked");
    CHECK(isnan(report.jacobian_error) && report.jacobian_row == 0, "no number: %g", report.jacobian_error);
}

// y = (x^2, x^3), whose second slope is off by a constant: its Hessian is right, though it has fewer rows than outputs.
static void squares(void *self, const double *x, double *y)
{
    (void)self;
    y[0] = x[0] * x[0];
    y[1] = x[0] * x[0] * x[0];
}

static void slopes(void *self, const double *x, double *values)
{
    (void)self;
    values[0] = 2 * x[0];
    values[1] = 3 * x[0] * x[0] + 5;
}

static void bends(void *self, const double *x, const double *w, double *values)
{
    (void)self;
    values[0] = 2 * w[0] + 6 * w[1] * x[0];
}

static void test_more_outputs(void)
{
    static int rows[] = {0, 1}, columns[] = {0, 0};
    const moray_map map = {.n_in = 1,
                           .n_out = 2,
                           .jac = {.nnz = 2, .row = rows, .col = columns},
                           .hess = {.nnz = 1, .row = rows, .col = columns},
                           .value = squares,
                           .jacobian = slopes,
                           .hessian = bends};
    const double x = 0.7, weights[] = {0.4, -1.3};
    moray_derivative_report report;
    CHECK_OK(moray_check_derivatives(&map, &x, weights, &report), "checked");
    CHECK(report.jacobian_error > 1 && report.jacobian_row == 1, "the slope of row %d is wrong", report.jacobian_row);
    CHECK(report.hessian_error < 1e-8, "the Hessian is right: %.1e", report.hessian_error);
}

int main(void)
{
    test_more_outputs();
    test_none();
    test_doubt();
    test_first();
    test_jacobian();
    test_hessian();
    test_missing();
    return tap_done();
}
