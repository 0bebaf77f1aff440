// SPDX-License-Identifier: MIT
//
// Hock-Schittkowski 71: min x0 x3 (x0+x1+x2) + x2, x0 x1 x2 x3 >= 25, |x|^2 = 40, 1 <= x <= 5. f* = 17.0140173.
#include "tap.h"

#include <string.h>

#include "moray/nlp.h"

static bool objective(void *self, const double *x, bool fresh, double *f)
{
    (void)self;
    (void)fresh;
    *f = x[0] * x[3] * (x[0] + x[1] + x[2]) + x[2];
    return true;
}

static bool gradient(void *self, const double *x, bool fresh, double *g)
{
    (void)self;
    (void)fresh;
    g[0] = x[3] * (2 * x[0] + x[1] + x[2]);
    g[1] = x[0] * x[3];
    g[2] = x[0] * x[3] + 1;
    g[3] = x[0] * (x[0] + x[1] + x[2]);
    return true;
}

static bool constraints(void *self, const double *x, bool fresh, double *g)
{
    (void)fresh;
    g[0] = x[0] * x[1] * x[2] * x[3];
    g[1] = x[0] * x[0] + x[1] * x[1] + x[2] * x[2] + x[3] * x[3];
    return self == NULL;
}

static bool jacobian(void *self, const double *x, bool fresh, double *v)
{
    (void)self;
    (void)fresh;
    for (int j = 0; j < 4; j++) {
        v[j] = x[(j + 1) % 4] * x[(j + 2) % 4] * x[(j + 3) % 4];
        v[4 + j] = 2 * x[j];
    }
    return true;
}

// lower triangle row by row
static bool hessian(void *self, const double *x, bool fresh, double sigma, const double *lambda, double *v)
{
    (void)self;
    (void)fresh;
    const double f[10] = {2 * x[3], x[3], 0, x[3], 0, 0, 2 * x[0] + x[1] + x[2], x[0], x[0], 0};
    for (int i = 0, k = 0; i < 4; i++)
        for (int j = 0; j <= i; j++, k++) {
            double others = 1;
            for (int l = 0; l < 4; l++)
                others *= l == i || l == j ? 1 : x[l];
            v[k] = sigma * f[k] + (i == j ? 2 * lambda[1] : lambda[0] * others);
        }
    return true;
}

static const double lower[] = {1, 1, 1, 1}, upper[] = {5, 5, 5, 5}, g_lower[] = {25, 40},
                    g_upper[] = {MORAY_INFINITY, 40};
static const int jac_row[] = {0, 0, 0, 0, 1, 1, 1, 1}, jac_col[] = {0, 1, 2, 3, 0, 1, 2, 3};
static const int hess_row[] = {0, 1, 1, 2, 2, 2, 3, 3, 3, 3}, hess_col[] = {0, 0, 1, 0, 1, 2, 0, 1, 2, 3};

static moray_nlp hock_schittkowski_71(void)
{
    return (moray_nlp){.n = 4,
                       .m = 2,
                       .x_lower = lower,
                       .x_upper = upper,
                       .g_lower = g_lower,
                       .g_upper = g_upper,
                       .nnz_jac = 8,
                       .nnz_hess = 10,
                       .jac_row = jac_row,
                       .jac_col = jac_col,
                       .hess_row = hess_row,
                       .hess_col = hess_col,
                       .objective = objective,
                       .gradient = gradient,
                       .constraints = constraints,
                       .jacobian = jacobian,
                       .hessian = hessian};
}

// x0 = x1 in metres of an orbit, and x0 free.
static bool difference(void *self, const double *x, bool fresh, double *g)
{
    (void)self;
    (void)fresh;
    g[0] = x[0] - x[1];
    return true;
}
static bool difference_jacobian(void *self, const double *x, bool fresh, double *v)
{
    (void)self;
    (void)x;
    (void)fresh;
    v[0] = 1;
    v[1] = -1;
    return true;
}
static bool no_gradient(void *self, const double *x, bool fresh, double *g)
{
    (void)self;
    (void)x;
    (void)fresh;
    g[0] = g[1] = 0;
    return true;
}

static void test_feasibility_of_large_numbers(void)
{
    const double free_lower[] = {-MORAY_INFINITY, -MORAY_INFINITY}, free_upper[] = {MORAY_INFINITY, MORAY_INFINITY};
    const moray_nlp nlp = {.n = 2,
                           .m = 1,
                           .x_lower = free_lower,
                           .x_upper = free_upper,
                           .g_lower = (const double[]){0},
                           .g_upper = (const double[]){0},
                           .nnz_jac = 2,
                           .jac_row = (const int[]){0, 0},
                           .jac_col = (const int[]){0, 1},
                           .gradient = no_gradient,
                           .constraints = difference,
                           .jacobian = difference_jacobian};
    double x[2] = {2e7, 2e7 + 1e-6}, none[2] = {0}, g[1], lambda[1] = {0};
    const moray_iterate it = {x, none, none, g, lambda, 0};
    moray_kkt kkt;
    CHECK_OK(moray_kkt_error(&nlp, &it, &kkt), "KKT");
    CHECK(kkt.feasibility < 1e-12, "a micron in 20000 km is feasible: %.1e", kkt.feasibility);
    x[1] = 2e7 + 1e3;
    moray_kkt_error(&nlp, &it, &kkt);
    CHECK_NEAR(kkt.feasibility, 1e3 / 2.0001e7, 1e-9, "a kilometre is not");
}

// ---- A linear programme whose optimum is a corner of bounds that all differ ----

static const double price[] = {1, -2, 3, -4, 0.5};
static const double room_below[] = {1, -3, 5, -7, 2}, room_above[] = {2, -1, 9, -6.5, 4};

static bool cost(void *self, const double *x, bool is_new, double *f)
{
    (void)self;
    (void)is_new;
    *f = 0;
    for (int j = 0; j < 5; j++)
        *f += price[j] * x[j];
    return true;
}

static bool cost_gradient(void *self, const double *x, bool is_new, double *g)
{
    (void)self;
    (void)x;
    (void)is_new;
    memcpy(g, price, sizeof price);
    return true;
}

static bool third(void *self, const double *x, bool is_new, double *g)
{
    (void)self;
    (void)is_new;
    g[0] = 3 * x[2];
    return true;
}

static bool slope_of_third(void *self, const double *x, bool is_new, double *v)
{
    (void)self;
    (void)x;
    (void)is_new;
    v[0] = 3;
    return true;
}

static bool straight(void *self, const double *x, bool is_new, double sigma, const double *lambda, double *v)
{
    (void)self, (void)x, (void)is_new, (void)sigma, (void)lambda, (void)v;
    return true;
}

// Ipopt lets bounds give way; what comes back does not go beyond them, with the values that belong to it.
static void test_corner(void)
{
    const moray_nlp nlp = {.n = 5,
                           .m = 1,
                           .x_lower = room_below,
                           .x_upper = room_above,
                           .g_lower = (const double[]){-100},
                           .g_upper = (const double[]){100},
                           .nnz_jac = 1,
                           .jac_row = (const int[]){0},
                           .jac_col = (const int[]){2},
                           .objective = cost,
                           .gradient = cost_gradient,
                           .constraints = third,
                           .jacobian = slope_of_third,
                           .hessian = straight};
    double x[5] = {1.5, -2, 7, -6.7, 3}, z_lower[5], z_upper[5], g[1], lambda[1], f, row;
    moray_iterate it = {x, z_lower, z_upper, g, lambda, 0};
    moray_nlp_settings settings = moray_nlp_settings_default();
    moray_nlp_info info;
    settings.tolerance = 1e-10;
    CHECK_OK(moray_ipopt_solve(&nlp, &settings, &it, &info), "a corner");
    for (int j = 0; j < 5; j++) {
        const double corner = price[j] > 0 ? room_below[j] : room_above[j];
        CHECK(x[j] >= room_below[j] && x[j] <= room_above[j] && fabs(x[j] - corner) < 1e-8,
              "x[%d] = %.12g is within its bounds, at %g", j, x[j], corner);
    }
    cost(NULL, x, true, &f);
    third(NULL, x, true, &row);
    CHECK(it.objective == f && g[0] == row, "objective and row are those of that corner, off by %.1e and %.1e",
          it.objective - f, g[0] - row);
}

// ---- sign x^2 at x = 1 with g = x: stationary by one multiplier or another, of 2 each, which is not due ----

static bool half_square(void *self, const double *x, bool is_new, double *f)
{
    (void)is_new;
    *f = *(const double *)self * x[0] * x[0];
    return true;
}

static bool half_square_gradient(void *self, const double *x, bool is_new, double *gradient)
{
    (void)is_new;
    gradient[0] = *(const double *)self * 2 * x[0];
    return true;
}

static bool same(void *self, const double *x, bool is_new, double *g)
{
    (void)self;
    (void)is_new;
    g[0] = x[0];
    return true;
}

static bool one(void *self, const double *x, bool is_new, double *slope)
{
    (void)self;
    (void)x;
    (void)is_new;
    slope[0] = 1;
    return true;
}

// Each kind of multiplier by itself: where its bound is a distance away, on the side where there is none, and with the
// wrong sign at its bound.
static void test_complementarity(void)
{
    static const struct {
        const char *what;
        double sign, x_lower, x_upper, g_lower, g_upper, z_lower, z_upper, lambda, error;
    } cases[] = {
        {"a lower bound 0.5 below", 1, 0.5, 9, -9, 9, 2, 0, 0, 1},
        {"an upper bound 3 above", -1, -9, 4, -9, 9, 0, 2, 0, 6},
        {"the lower end of a row, 0.25 below", 1, -9, 9, 0.75, 9, 0, 0, -2, 0.5},
        {"the upper end of a row, 2 above", -1, -9, 9, -9, 3, 0, 0, 2, 4},
        {"no lower bound", 1, -MORAY_INFINITY, 9, -9, 9, 2, 0, 0, 2},
        {"no upper bound", -1, -9, MORAY_INFINITY, -9, 9, 0, 2, 0, 2},
        {"no end of a row", 1, -9, 9, -MORAY_INFINITY, 9, 0, 0, -2, 2},
        {"the wrong sign at the lower bound", -1, 1, 9, -9, 9, -2, 0, 0, 2},
        {"the wrong sign at the upper bound", 1, -9, 1, -9, 9, 0, -2, 0, 2},
        {"the right sign at the lower bound", 1, 1, 9, -9, 9, 2, 0, 0, 0},
        {"the right sign at the upper bound", -1, -9, 1, -9, 9, 0, 2, 0, 0},
        {"the right sign at the end of a row", 1, -9, 9, 1, 9, 0, 0, -2, 0},
    };
    static int zero[1];
    for (unsigned k = 0; k < sizeof cases / sizeof *cases; k++) {
        double sign = cases[k].sign, x[] = {1}, g[] = {1}, z_lower[] = {cases[k].z_lower},
               z_upper[] = {cases[k].z_upper}, lambda[] = {cases[k].lambda};
        const moray_nlp nlp = {.n = 1,
                               .m = 1,
                               .nnz_jac = 1,
                               .jac_row = zero,
                               .jac_col = zero,
                               .x_lower = &cases[k].x_lower,
                               .x_upper = &cases[k].x_upper,
                               .g_lower = &cases[k].g_lower,
                               .g_upper = &cases[k].g_upper,
                               .objective = half_square,
                               .gradient = half_square_gradient,
                               .constraints = same,
                               .jacobian = one,
                               .self = &sign};
        const moray_iterate it = {x, z_lower, z_upper, g, lambda, sign};
        moray_kkt kkt;
        CHECK_OK(moray_kkt_error(&nlp, &it, &kkt), "KKT");
        CHECK(kkt.stationarity == 0 && kkt.feasibility == 0 && fabs(kkt.error - cases[k].error) < 1e-15,
              "%s: error %g, expected %g; stationarity %g", cases[k].what, kkt.error, cases[k].error, kkt.stationarity);
    }
}

// What was reported up to the last iteration, and the least violated of it after the start.
struct record {
    int last, stop;
    double violation, objective;
};

static bool stop(void *observer, const moray_progress *progress)
{
    struct record *record = observer;
    record->last = progress->iteration;
    const double violation = fmax(progress->infeasibility, 1e-6);
    const bool better =
        violation < record->violation || (violation == record->violation && progress->objective < record->objective);
    if (progress->iteration > 0 && !progress->restoring && better) {
        record->violation = violation;
        record->objective = progress->objective;
    }
    return progress->iteration < record->stop;
}

// Wherever it is stopped, the iterate is the best of those reported.
static void test_interrupted(const moray_nlp *nlp)
{
    double x[4], z_lower[4], z_upper[4], g[2], lambda[2];
    moray_iterate it = {x, z_lower, z_upper, g, lambda, 0};
    moray_nlp_settings settings = moray_nlp_settings_default();
    moray_nlp_info info;
    for (int k = 1; k <= 8; k++) {
        struct record record = {.stop = k, .violation = INFINITY, .objective = INFINITY};
        double f, g_again[2];
        memcpy(x, (double[]){1, 5, 5, 1}, sizeof x);
        settings.progress = stop;
        settings.observer = &record;
        CHECK_OK(moray_ipopt_solve(nlp, &settings, &it, &info), "interrupted run");
        CHECK(info.outcome == MORAY_NLP_INTERRUPTED && record.last == k, "stops when asked, at iteration %d",
              record.last);
        objective(NULL, x, true, &f);
        constraints(NULL, x, true, g_again);
        CHECK(it.objective == record.objective && fabs(f - it.objective) < 1e-12 && g_again[0] == g[0] &&
                  g_again[1] == g[1],
              "with the best iterate so far, of objective %.9g", it.objective);
    }
}

int main(void)
{
    moray_nlp nlp = hock_schittkowski_71();
    double x[4] = {1, 5, 5, 1}, z_lower[4], z_upper[4], g[2], lambda[2];
    moray_iterate it = {x, z_lower, z_upper, g, lambda, 0};
    moray_nlp_settings settings = moray_nlp_settings_default();
    moray_nlp_info info;
    moray_kkt kkt;
    test_feasibility_of_large_numbers();
    test_complementarity();
    test_corner();
    CHECK_OK(moray_ipopt_solve(&nlp, &settings, &it, &info), "HS71");
    CHECK(info.outcome == MORAY_NLP_SOLVED, "outcome: %s", moray_nlp_outcome_text(info.outcome));
    CHECK_NEAR(it.objective, 17.0140173, 1e-6, "published optimum");
    CHECK_OK(moray_kkt_error(&nlp, &it, &kkt), "KKT");
    CHECK(kkt.error < 1e-7, "KKT error %.1e", kkt.error);
    x[1] += 1e-3;
    moray_kkt_error(&nlp, &it, &kkt);
    CHECK(kkt.error > 1e-4 && kkt.feasibility > 1e-4, "a shifted point is not optimal: %.1e", kkt.error);
    x[1] -= 1e-3;
    lambda[1] += 0.1;
    moray_kkt_error(&nlp, &it, &kkt);
    CHECK(kkt.stationarity > 1e-2, "a wrong multiplier shows in the stationarity: %.1e", kkt.stationarity);

    const double x_scale[] = {10, 0.1, 3, 1}, g_scale[] = {0.04, 2};
    nlp.x_scale = x_scale;
    nlp.g_scale = g_scale;
    nlp.f_scale = 0.1;
    memcpy(x, (double[]){1, 5, 5, 1}, sizeof x);
    CHECK_OK(moray_ipopt_solve(&nlp, &settings, &it, &info), "scaled");
    moray_kkt_error(&nlp, &it, &kkt);
    CHECK_NEAR(it.objective, 17.0140173, 1e-6, "the optimum does not depend on scaling");
    CHECK(kkt.error < 1e-6, "multipliers come back in user units: KKT %.1e", kkt.error);

    test_interrupted(&nlp);

    const double impossible[] = {5000, 40};
    nlp.g_lower = impossible;
    CHECK_OK(moray_ipopt_solve(&nlp, &settings, &it, &info), "infeasible run");
    CHECK(info.outcome == MORAY_NLP_INFEASIBLE, "infeasible is said: %s", moray_nlp_outcome_text(info.outcome));
    const double no_tolerance[] = {-1, 0, 1, NAN};
    for (int k = 0; k < 4; k++) {
        settings.tolerance = no_tolerance[k];
        const moray_status status = moray_ipopt_solve(&nlp, &settings, &it, &info);
        CHECK(status.code == MORAY_INPUT && strstr(status.text, "must lie between 0 and 1"), "%s", status.text);
    }
    nlp.self = &nlp;
    CHECK(moray_kkt_error(&nlp, &it, &kkt).code == MORAY_NUMERIC, "an undefined constraint is an error");
    return tap_done();
}
