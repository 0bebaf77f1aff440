// SPDX-License-Identifier: MIT
//
// What a complex function of one point is found to depend on, and where it bends: kinks, ends of domains and rounding
// are neither.
#include "tap.h"

#include "base/numeric_map.h"
#include "moray/map.h"
#include "moray/num.h"

static moray_map look(int n_in, int n_out, moray_complex_fn *function, const double *at)
{
    moray_map map;
    const struct numeric_probe probe = {.points = at, .n = 1};
    CHECK_OK(moray_complex_map_new(&map, n_in, n_out, function, NULL, NULL, &probe), "a map by what is at one point");
    return map;
}

static bool has(const moray_pattern *pattern, int row, int col)
{
    for (int k = 0; k < pattern->nnz; k++)
        if (pattern->row[k] == row && pattern->col[k] == col)
            return true;
    return false;
}

// Input i bends only output i: lines with kinks beside the point, squares, and what has no slope on one side.
enum { LINES = 9 };
static const bool curved[LINES] = {[2] = true, [5] = true};

static void lines(void *self, const double complex *x, double complex *out)
{
    (void)self;
    out[0] = x[0] + moray_max(x[0] - 1e-4, 0);
    out[1] = 2 * x[1] + moray_max(-x[1] - 1e-4, 0);
    out[2] = 3 * x[2] + x[2] * x[2];
    out[3] = 5 * x[3] + moray_max(-x[3] - 2e-4, 0);
    out[4] = 7 * x[4] + moray_max(x[4] - 2e-4, 0);
    out[5] = 9 * x[5] - 2 * x[5] * x[5];
    out[6] = 11 * x[6] + (creal(x[6]) > 1e-4 ? NAN : 0) * x[6];
    out[7] = 13 * x[7] + (creal(x[7]) < -1e-4 ? INFINITY : 0) * x[7];
    out[8] = 17 * x[8] + moray_max(x[8] - 3e-4, 0);
}

static void test_lines(void)
{
    const double at[LINES] = {0};
    moray_map map = look(LINES, LINES, lines, at);
    CHECK(map.jac.nnz == LINES && map.hess.nnz == 2, "%d slopes, %d bends", map.jac.nnz, map.hess.nnz);
    for (int i = 0; i < LINES; i++)
        CHECK(has(&map.jac, i, i) && has(&map.hess, i, i) == curved[i], "output %d is %s", i,
              curved[i] ? "curved" : "straight");
    moray_map_release(&map);
}

// Of one input, so that outputs are looked at together: no kink of one is another's.
static void together(void *self, const double complex *x, double complex *out)
{
    double complex all[LINES], same[LINES];
    for (int i = 0; i < LINES; i++)
        same[i] = x[0];
    lines(self, same, all);
    for (int i = 0; i < LINES; i++)
        out[i] = curved[i] ? 3.0 * i * x[0] : all[i];
}

static void test_together(void)
{
    const double at = 0;
    moray_map map = look(1, LINES, together, &at);
    CHECK(map.jac.nnz == LINES && map.hess.nnz == 0, "%d slopes, %d bends", map.jac.nnz, map.hess.nnz);
    moray_map_release(&map);
}

// Values where slopes are no numbers, and none at all where weights are 0.
static void edges(void *self, const double complex *x, double complex *out)
{
    (void)self;
    out[0] = x[0] * x[1];
    out[1] = moray_complex(creal(x[0]), cimag(x[0]) != 0 ? NAN : 0);
    out[2] = creal(x[1]) < 0 ? NAN * x[1] * x[1] : x[1] * x[1];
    out[3] = creal(x[0]) < -5 ? 4 : moray_complex(1, cimag(x[1]) != 0 ? INFINITY : 0);
}

static void test_edges(void)
{
    const double at[] = {0.5, 2}, beyond[] = {0.5, -2}, weight[] = {3, 0, 0, 0};
    double values[3];
    moray_map map = look(2, 4, edges, at);
    CHECK(!has(&map.jac, 1, 0) && has(&map.jac, 3, 1), "a NaN is no slope, however steep a slope may be");
    CHECK(map.jac.nnz == 4 && map.hess.nnz == 2, "%d slopes, %d bends", map.jac.nnz, map.hess.nnz);
    map.hessian(map.self, beyond, weight, values);
    for (int k = 0; k < map.hess.nnz; k++)
        CHECK_NEAR(values[k], map.hess.row[k] == map.hess.col[k] ? 0 : 3, 1e-9, "what weighs nothing may be no number");
    moray_map_release(&map);
}

// Where x0 x1 is flat in x0, it bends nothing that is felt there; the other outputs keep the two inputs apart.
static void flat(void *self, const double complex *x, double complex *out)
{
    (void)self;
    out[0] = x[0] * x[1];
    out[1] = x[0] + x[1];
    out[2] = x[0];
}

static void flat_behind(void *self, const double complex *x, double complex *out)
{
    const double complex turned[] = {x[1], x[0]};
    flat(self, turned, out);
}

static void test_flat(void)
{
    const double at[] = {0.5, 0}, turned[] = {0, 0.5};
    for (int k = 0; k < 2; k++) {
        moray_map map = look(2, 3, k ? flat_behind : flat, k ? turned : at);
        const int own = k, other = 1 - k;
        CHECK(map.jac.nnz == 4 && has(&map.jac, 0, other) && has(&map.jac, 1, own) && has(&map.jac, 1, other) &&
                  has(&map.jac, 2, own),
              "%d slopes", map.jac.nnz);
        CHECK(map.hess.nnz == 0, "%d bends", map.hess.nnz);
        moray_map_release(&map);
    }
}

// A slope that bends where there is no value.
static void holed(void *self, const double complex *x, double complex *out)
{
    (void)self;
    const bool within = creal(x[0]) < 0, on_axis = cimag(x[0]) == 0 && cimag(x[1]) == 0;
    out[0] = within ? (on_axis ? NAN : x[0] + x[1] * x[1]) : x[0] + x[1];
    out[1] = x[0];
}

static void test_holed(void)
{
    const double at[] = {1, 1, -1, 1};
    moray_map map;
    CHECK_OK(moray_complex_map_new(&map, 2, 2, holed, NULL, NULL, &(struct numeric_probe){.points = at, .n = 2}),
             "a map by what is at two points");
    CHECK(map.jac.nnz == 3 && map.hess.nnz == 0, "%d slopes, %d bends", map.jac.nnz, map.hess.nnz);
    moray_map_release(&map);
}

// Of what never changes nothing is missing.
static void constant(void *self, const double complex *x, double complex *out)
{
    (void)self;
    out[0] = 3;
    out[1] = 2 * x[0];
    out[2] = 0;
}

static void test_constant(void)
{
    const double at = 0.5, elsewhere = -7;
    moray_map map = look(1, 3, constant, &at);
    CHECK(map.jac.nnz == 1 && map.hess.nnz == 0, "%d slopes, %d bends", map.jac.nnz, map.hess.nnz);
    CHECK(moray_map_pattern_holds(&map, &elsewhere), "which holds elsewhere");
    moray_map_release(&map);
}

int main(void)
{
    test_constant();
    test_flat();
    test_holed();
    test_lines();
    test_together();
    test_edges();
    return tap_done();
}
