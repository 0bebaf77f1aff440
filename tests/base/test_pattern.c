// SPDX-License-Identifier: MIT
//
// Patterns of user functions, and how many evaluations a Jacobian and a Hessian cost: both counted, not timed.
#include "tap.h"

#include <stdlib.h>
#include <string.h>

#include "base/numeric_map.h"
#include "moray/num.h"

enum { most = 302 };

static int calls;
static bool saw_nan;

// A function of both kinds: on complex numbers and, through it, on real ones.
struct sample {
    const char *name;
    void (*function)(const moray_num *x, moray_num *out, int n);
    int n_in, n_out, jac, hess;    // entries of the patterns
    int for_jacobian, for_hessian; // calls of the complex map
    double at;                     // probe of every input: at, or about 1 and all different where it is NAN
};

static void call_complex(void *self, const double complex *x, double complex *out)
{
    const struct sample *sample = self;
    calls++;
    for (int j = 0; j < sample->n_in; j++)
        saw_nan = saw_nan || isnan(creal(x[j])) || isnan(cimag(x[j]));
    sample->function(x, out, sample->n_in);
}

static void call_real(void *self, const double *x, double *out)
{
    const struct sample *sample = self;
    moray_num in[most], result[most];
    calls++;
    for (int j = 0; j < sample->n_in; j++) {
        saw_nan = saw_nan || isnan(x[j]);
        in[j] = x[j];
    }
    sample->function(in, result, sample->n_in);
    for (int i = 0; i < sample->n_out; i++)
        out[i] = creal(result[i]);
}

static void separable(const moray_num *x, moray_num *out, int n)
{
    for (int i = 0; i < n; i++)
        out[i] = x[i] * x[i];
}
static void sum_of_squares(const moray_num *x, moray_num *out, int n)
{
    out[0] = 0;
    for (int i = 0; i < n; i++)
        out[0] += x[i] * x[i];
}
static void bilinear(const moray_num *x, moray_num *out, int n)
{
    for (int i = 0; i + 1 < n; i += 2)
        out[i / 2] = x[i] * x[i + 1];
}
static void pairs(const moray_num *x, moray_num *out, int n) // one output of products
{
    out[0] = 0;
    for (int i = 0; i + 1 < n; i += 2)
        out[0] += x[i] * x[i + 1];
}
static void linear(const moray_num *x, moray_num *out, int n)
{
    out[0] = 0;
    for (int i = 0; i < n; i++)
        out[0] += (i + 1) * x[i] / 3;
    out[1] = 2 * x[0] - x[n - 1];
}
static void mixed(const moray_num *x, moray_num *out, int n) // linear in all but the last two
{
    linear(x, out, n);
    out[1] += sin(creal(x[0]) > 1e9 ? 0 : 1) * x[n - 2] * cexp(x[n - 1]);
}

// Positions, then velocities of a chain of masses between springs with a cubic part, the last pulled by x[n - 1].
static void masses(const moray_num *x, moray_num *out, int n)
{
    const int count = (n - 1) / 2;
    for (int i = 0; i < count; i++) {
        const moray_num before = x[i] - (i > 0 ? x[i - 1] : 0), behind = i + 1 < count ? x[i + 1] - x[i] : x[n - 1];
        out[i] = x[count + i];
        out[count + i] = behind + 0.1 * behind * behind * behind - before - 0.1 * before * before * before;
        if (i + 1 == count)
            out[count + i] = x[n - 1] - before - 0.1 * before * before * before;
    }
}

static void kinks(const moray_num *x, moray_num *out, int n)
{
    (void)n;
    out[0] = moray_abs(x[0] - 0.2) + moray_max(x[1], x[2]) + moray_min(x[3], 0.9) + moray_clamp(x[4], -0.5, 0.5);
}
static void powers(const moray_num *x, moray_num *out, int n)
{
    (void)n;
    out[0] = moray_pow(x[0], 2) + moray_pow(x[1], 3) * x[2];
    out[1] = moray_pow(x[3] * x[3] + 1, 1.5);
}
static void flat(const moray_num *x, moray_num *out, int n) // at 0 nothing is felt
{
    (void)n;
    out[0] = x[0] * x[0] * x[0];
    out[1] = x[1] * x[2] * x[3];
    out[2] = (x[0] - x[1]) * (x[0] - x[1]) * (x[2] - x[3]);
}
static void table(const moray_num *x, moray_num *out, int n)
{
    static const double y[] = {3, 1, 4, 1, 5, 9, 2, 6, 5};
    (void)n;
    const int k = (int)floor(fmin(fmax(creal(x[0]) + 4, 0), 7)); // of a NaN, the processor's most negative number
    if (k < 0 || k > 7)
        abort();
    out[0] = y[k] + (y[k + 1] - y[k]) * (x[0] + 4 - k);
    out[1] = x[1] * out[0];
}
static void branching(const moray_num *x, moray_num *out, int n)
{
    (void)n;
    out[0] = creal(x[0]) > 1.2 ? x[1] : x[2] * x[3];
    out[1] = x[4] * x[5];
}
// The gradient with respect to x[0] holds rounding of everything, but x[0] meets x[1] alone.
static void rounding(const moray_num *x, moray_num *out, int n)
{
    (void)n;
    out[0] = x[0] * x[1] + 1e3 * x[2] + x[3] / 3;
    out[1] = 1e-9 * x[0] * x[3] + 1e3 * x[0];
}

static struct sample samples[] = {
    {"separable", separable, 50, 50, 50, 50, 1, 2, NAN},
    {"sum of squares", sum_of_squares, 20, 1, 20, 20, 20, 40, NAN},
    {"bilinear", bilinear, 20, 10, 20, 10, 2, 2, NAN},
    {"one sum of products", pairs, 20, 1, 20, 10, 20, 20, NAN},
    {"linear", linear, 6, 2, 8, 0, 6, 0, NAN},
    {"nonlinear in the last two", mixed, 10, 2, 13, 2, 10, 4, NAN},
    {"masses, 200 states", masses, 201, 200, 399, 199, 3, 12, NAN},
    {"masses, 300 states", masses, 301, 300, 599, 299, 3, 12, NAN},
    {"kinks", kinks, 5, 1, 5, 0, 5, 0, NAN},
    {"powers", powers, 4, 2, 4, 4, 3, 6, NAN},
    {"flat at 0", flat, 4, 3, 8, 8, 4, 16, 0},
    {"table", table, 2, 2, 3, 1, 2, 2, NAN},
    {"branching", branching, 6, 2, 5, 2, 3, 2, NAN},
    {"rounding", rounding, 4, 2, 6, 2, 4, 2, NAN},
};

static void probe_of(const struct sample *sample, double *probe)
{
    for (int j = 0; j < sample->n_in; j++)
        probe[j] = isnan(sample->at) ? 1 + 0.3 * sin(2.0 * j + 1) : sample->at;
}

static void check_patterns(const struct sample *sample, const moray_map *map, const char *kind)
{
    CHECK(map->jac.nnz == sample->jac, "%s, %s: %d entries of the Jacobian, expected %d", sample->name, kind,
          map->jac.nnz, sample->jac);
    CHECK(map->hess.nnz == sample->hess, "%s, %s: %d entries of the Hessian, expected %d", sample->name, kind,
          map->hess.nnz, sample->hess);
    CHECK(!saw_nan, "%s, %s: never called with a NaN", sample->name, kind);
}

static void check_sample(struct sample *sample)
{
    static double probe[most], weight[most], values[most * most];
    moray_map map;
    moray_derivative_report report;
    probe_of(sample, probe);
    for (int i = 0; i < sample->n_out; i++)
        weight[i] = 1 + 0.3 * cos(3.0 * i);
    calls = 0;
    saw_nan = false;
    CHECK_OK(moray_map_from_complex(&map, sample->n_in, sample->n_out, call_complex, sample, NULL, probe),
             sample->name);
    const int groups = sample->for_jacobian, points = 13;
    CHECK(calls <= points * (sample->n_in + 2 + 2 * groups * groups + 4 * groups), "%s: %d calls to find the patterns",
          sample->name, calls);
    check_patterns(sample, &map, "complex");
    calls = 0;
    map.jacobian(map.self, probe, values);
    CHECK(calls == sample->for_jacobian, "%s: %d calls a Jacobian, expected %d", sample->name, calls,
          sample->for_jacobian);
    calls = 0;
    map.hessian(map.self, probe, weight, values);
    CHECK(calls == sample->for_hessian, "%s: %d calls a Hessian, expected %d", sample->name, calls,
          sample->for_hessian);
    if (sample->n_in < 60) {
        CHECK_OK(moray_check_derivatives(&map, probe, weight, &report), "checked");
        CHECK(report.jacobian_error < 1e-9 && report.hessian_error < 1e-8, "%s: %.1e, %.1e", sample->name,
              report.jacobian_error, report.hessian_error);
    }
    moray_map_release(&map);
    if (sample->function == rounding) // differences of a real function do not resolve it
        return;
    CHECK_OK(moray_map_from_real(&map, sample->n_in, sample->n_out, call_real, sample, NULL, probe), sample->name);
    check_patterns(sample, &map, "real");
    moray_map_release(&map);
}

// ---- Branches that only some of the box enters, and what shows them later ----

static void hidden(void *self, const double complex *x, double complex *out)
{
    (void)self;
    out[0] = x[0];
    if (creal(x[1]) > 4 && creal(x[1]) < 4.5)
        out[0] += x[2] * x[3];
    out[1] = x[2] + (creal(x[1]) < -4 ? x[2] * x[3] : 0 * x[3]);
}
static void hidden_real(void *self, const double *x, double *out)
{
    (void)self;
    out[0] = x[0] + (x[1] > 4 && x[1] < 4.5 ? x[2] * x[3] : 0);
    out[1] = x[2] + (x[1] < -4 ? x[2] * x[3] : 0);
}

static void check_widening(moray_map *map, const char *kind)
{
    const double here[] = {0.5, 0.2, 0.7, -0.3}, there[] = {0.5, 4.2, 0.7, -0.3}, beyond[] = {0.5, -4.2, 0.7, -0.3};
    const double weight[] = {1, 1};
    moray_map wider, widest;
    moray_derivative_report report;
    int found;
    CHECK(map->jac.nnz == 2 && map->hess.nnz == 0, "%s: the branch is hidden: %d, %d", kind, map->jac.nnz,
          map->hess.nnz);
    CHECK(moray_map_pattern_holds(map, here), "%s: the pattern holds where it was found", kind);
    CHECK(!moray_map_pattern_holds(map, there) && !moray_map_pattern_holds(map, beyond), "%s: and not beyond", kind);
    const double below[] = {-1, -4.2, 0.7, -1}; // where an input is less than nothing by its own size
    CHECK(!moray_map_pattern_holds(map, below), "%s: nor at minus 1", kind);
    CHECK_OK(moray_map_widened(&wider, map, there, 1, &found), "widened");
    CHECK(found > 0 && wider.jac.nnz == 4 && wider.hess.nnz == 1, "%s: by what is there: %d, %d", kind, wider.jac.nnz,
          wider.hess.nnz);
    CHECK(moray_map_pattern_holds(&wider, there) && moray_map_pattern_holds(&wider, here), "%s: which holds", kind);
    CHECK_OK(moray_check_derivatives(&wider, there, weight, &report), "checked");
    CHECK(report.jacobian_error < 1e-8 && report.hessian_error < 1e-5, "%s: derivatives %.1e, %.1e", kind,
          report.jacobian_error, report.hessian_error);
    CHECK_OK(moray_check_derivatives(&wider, (double[]){-1, 4.2, -1, -1}, weight, &report), "checked");
    CHECK(report.jacobian_error < 1e-8 && report.hessian_error < 1e-5, "%s: at minus 1 %.1e, %.1e", kind,
          report.jacobian_error, report.hessian_error);
    CHECK_OK(moray_map_widened(&widest, &wider, here, 1, &found), "looked at again");
    CHECK(found == 0 && widest.jac.nnz == wider.jac.nnz && widest.hess.nnz == wider.hess.nnz,
          "%s: nothing new where all is known", kind);
    moray_map_release(&widest);
    moray_map_release(&wider);
    moray_map_release(map);
}

static void test_widening(void)
{
    moray_map map;
    const double at[] = {0.5, 0.2, 0.7, -0.3};
    CHECK(!moray_map_is_numeric(&(moray_map){0}), "a map by hand is not numeric");
    CHECK_OK(moray_map_from_complex(&map, 4, 2, hidden, NULL, NULL, at), "complex");
    check_widening(&map, "complex");
    CHECK_OK(moray_map_from_real(&map, 4, 2, hidden_real, NULL, NULL, at), "real");
    check_widening(&map, "real");
}

int main(void)
{
    for (size_t i = 0; i < sizeof samples / sizeof *samples; i++)
        check_sample(&samples[i]);
    test_widening();
    return tap_done();
}
