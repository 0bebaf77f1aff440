// SPDX-License-Identifier: MIT
#include "tap.h"

#include <string.h>
#include <tgmath.h>

#include "moray/map.h"

// Sparse and not symmetric: out = (x0 x1 + sin x2, x2^2 exp x3, x4, x0/x3)
static void sample(void *self, const double complex *x, double complex *out)
{
    (void)self;
    out[0] = x[0] * x[1] + sin(x[2]);
    out[1] = x[2] * x[2] * exp(x[3]);
    out[2] = x[4];
    out[3] = x[0] / x[3];
}

static const double point[5] = {0.3, -1.2, 0.7, 1.9, 4};

static double entry(const moray_pattern *pattern, const double *values, int row, int col, bool *found)
{
    *found = false;
    for (int k = 0; k < pattern->nnz; k++)
        if (pattern->row[k] == row && pattern->col[k] == col) {
            *found = true;
            return values[k];
        }
    return 0;
}

static void test_complex_step(void)
{
    moray_map map;
    CHECK_OK(moray_map_from_complex(&map, 5, 4, sample, NULL, NULL, point), "a map from a complex function");
    double values[32];
    bool found;
    map.jacobian(map.self, point, values);
    const double jac[4][5] = {{point[1], point[0], cos(point[2]), 0, 0},
                              {0, 0, 2 * point[2] * exp(point[3]), point[2] * point[2] * exp(point[3]), 0},
                              {0, 0, 0, 0, 1},
                              {1 / point[3], 0, 0, -point[0] / (point[3] * point[3]), 0}};
    int nnz = 0;
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 5; j++) {
            CHECK_RELATIVE(entry(&map.jac, values, i, j, &found), jac[i][j], 1e-15, "complex-step Jacobian entry");
            CHECK(found == (jac[i][j] != 0), "pattern knows entry %d, %d", i, j);
            nnz += found;
        }
    CHECK(map.jac.nnz == nnz, "no entry stands twice");
    const double w[4] = {2, -0.5, 3, 0.25};
    map.hessian(map.self, point, w, values);
    CHECK_RELATIVE(entry(&map.hess, values, 1, 0, &found), w[0], 1e-10, "Hessian x1 x0");
    CHECK_RELATIVE(entry(&map.hess, values, 2, 2, &found), -w[0] * sin(point[2]) + w[1] * 2 * exp(point[3]), 1e-9,
                   "Hessian x2 x2");
    CHECK_RELATIVE(entry(&map.hess, values, 3, 2, &found), w[1] * 2 * point[2] * exp(point[3]), 1e-9, "Hessian x3 x2");
    CHECK_RELATIVE(entry(&map.hess, values, 3, 0, &found), -w[3] / (point[3] * point[3]), 1e-9, "Hessian x3 x0");
    entry(&map.hess, values, 4, 4, &found);
    CHECK(!found, "a linear variable has no second derivative in the pattern");
    moray_map_release(&map);
    moray_map_release(&map);
}

static void test_not_finite(void)
{
    moray_map map;
    const double bad[5] = {1, 1, 1, 0, 1};
    moray_status status = moray_map_from_complex(&map, 5, 4, sample, NULL, NULL, bad);
    CHECK(status.code == MORAY_INPUT && strstr(status.text, "output 3"), "not finite at the probe: %s", status.text);
}

// A hand-written map of f = (x0^2 x1, x1^3) with a bug planted on request.
static int bug;
static void by_hand_value(void *self, const double *x, double *out)
{
    (void)self;
    out[0] = x[0] * x[0] * x[1];
    out[1] = x[1] * x[1] * x[1];
}
static void by_hand_jacobian(void *self, const double *x, double *values)
{
    (void)self;
    values[0] = 2 * x[0] * x[1];
    values[1] = x[0] * x[0] * (bug == 1 ? 1.0001 : 1);
    values[2] = 3 * x[1] * x[1];
}
static void by_hand_hessian(void *self, const double *x, const double *w, double *values)
{
    (void)self;
    values[0] = 2 * w[0] * x[1];
    values[1] = 2 * w[0] * x[0];
    values[2] = 6 * w[1] * x[1] + (bug == 2 ? 1e-3 : 0);
}

static void test_checker(void)
{
    int jr[] = {0, 0, 1}, jc[] = {0, 1, 1}, hr[] = {0, 1, 1}, hc[] = {0, 0, 1};
    moray_map map = {.n_in = 2,
                     .n_out = 2,
                     .jac = {3, jr, jc},
                     .hess = {3, hr, hc},
                     .value = by_hand_value,
                     .jacobian = by_hand_jacobian,
                     .hessian = by_hand_hessian};
    const double x[] = {1.3, -0.4}, w[] = {0.7, 1.1};
    moray_derivative_report report;
    CHECK_OK(moray_check_derivatives(&map, x, w, &report), "check");
    CHECK(report.jacobian_error < 1e-11 && report.hessian_error < 1e-11, "right derivatives pass: %.1e, %.1e",
          report.jacobian_error, report.hessian_error);
    bug = 1;
    moray_check_derivatives(&map, x, w, &report);
    CHECK(report.jacobian_error > 1e-5 && report.jacobian_row == 0 && report.jacobian_col == 1,
          "a wrong Jacobian entry is named: row %d, column %d", report.jacobian_row, report.jacobian_col);
    bug = 2;
    moray_check_derivatives(&map, x, w, &report);
    CHECK(report.hessian_error > 1e-5 && report.hessian_row == 1 && report.hessian_col == 1,
          "a wrong Hessian entry is named: row %d, column %d", report.hessian_row, report.hessian_col);
    bug = 0;
    map.jac.nnz = 2;
    moray_check_derivatives(&map, x, w, &report);
    CHECK(report.jacobian_row == 1 && report.jacobian_col == 1 && report.jacobian_given == 0,
          "an entry missing from the pattern is found");
}

// u = (x1, x2), base = (u0^2 u1, u1), extra = (x0 x1, x2^2) inserted in between
static void inner(void *self, const double complex *u, double complex *out)
{
    (void)self;
    out[0] = u[0] * u[0] * u[1];
    out[1] = u[1];
}
static void outer(void *self, const double complex *x, double complex *out)
{
    (void)self;
    out[0] = x[0] * x[1];
    out[1] = x[2] * x[2];
}

static void test_join(void)
{
    moray_map base, extra, map;
    const double x[] = {0.4, 1.5, -0.7}, w[] = {0.9, -1.1, 0.3, 0.6};
    double out[4], values[16];
    moray_derivative_report report;
    bool found;
    CHECK_OK(moray_map_from_complex(&base, 2, 2, inner, NULL, NULL, x + 1), "base");
    CHECK_OK(moray_map_from_complex(&extra, 3, 2, outer, NULL, NULL, x), "extra");
    CHECK_OK(moray_map_join(&map, &base, (int[]){1, 2}, &extra, 1), "joined");
    CHECK(!base.self && !extra.self, "the map has taken over both");
    CHECK(map.n_in == 3 && map.n_out == 4, "sizes: %d in, %d out", map.n_in, map.n_out);
    map.value(map.self, x, out);
    CHECK_NEAR(out[0], x[1] * x[1] * x[2], 1e-15, "base output before");
    CHECK_NEAR(out[1], x[0] * x[1], 1e-15, "extra output");
    CHECK_NEAR(out[2], x[2] * x[2], 1e-15, "extra output");
    CHECK_NEAR(out[3], x[2], 1e-15, "base output behind");
    CHECK_OK(moray_check_derivatives(&map, x, w, &report), "check");
    CHECK(report.jacobian_error < 1e-10 && report.hessian_error < 1e-9, "derivatives: %.1e, %.1e",
          report.jacobian_error, report.hessian_error);
    map.hessian(map.self, x, w, values);
    CHECK_NEAR(entry(&map.hess, values, 2, 1, &found), w[0] * 2 * x[1], 1e-9, "Hessian entry of the base");
    int twice = 0;
    for (int k = 0; k < map.hess.nnz; k++)
        for (int l = 0; l < k; l++)
            twice += map.hess.row[k] == map.hess.row[l] && map.hess.col[k] == map.hess.col[l];
    CHECK(map.jac.nnz == 6 && twice == 0, "entries of both merged: %d, %d twice", map.jac.nnz, twice);
    moray_map_release(&map);
    CHECK(!map.self, "released");
}

int main(void)
{
    test_complex_step();
    test_not_finite();
    test_checker();
    test_join();
    return tap_done();
}
