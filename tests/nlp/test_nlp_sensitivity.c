// SPDX-License-Identifier: MIT
//
// Sensitivities of programmes that are solved by hand: a quadratic one at a bound, the least norm on a line (the
// example of the sensitivity literature, Ganesh and Biegler 1987), the nearest point of a disc.
#include "tap.h"

#include <string.h>

#include "programme.h"

// ---- A quadratic programme at a bound: ½(x0² + 2 x1² + 3 x2²), x0 + x1 + x2 = 1, x0 >= l = p[0] --------------------

static void quadratic(const double *x, const double *p, struct facts *f)
{
    (void)p;
    f->f = (x[0] * x[0] + 2 * x[1] * x[1] + 3 * x[2] * x[2]) / 2;
    f->g[0] = x[0] + x[1] + x[2];
    for (int j = 0; j < 3; j++) {
        f->gradient[j] = (j + 1) * x[j];
        f->jac[0][j] = 1;
        f->hess[j][j] = j + 1;
    }
}

static void test_bound(void)
{
    const double l = 0.6;
    struct dense d = {.facts = quadratic, .p = {l}, .g_lower = {1}, .g_upper = {1}};
    struct slope room;
    moray_iterate slope = slope_in(&room);
    moray_nlp_sensitivity *s;
    int weak[4];
    dense_new(&d, 3, 1);
    d.x_lower[0] = l;
    const double x[] = {l, 0.6 * (1 - l), 0.4 * (1 - l)}; // 2 x1 = 3 x2 = -lambda
    memcpy(d.x, x, sizeof x);
    d.g[0] = 1;
    d.lambda[0] = -2 * x[1];
    d.z_lower[0] = l - 2 * x[1]; // 2.2 l - 1.2
    CHECK_OK(moray_nlp_sensitivity_new(&s, &d.nlp, &d.at), "a quadratic programme at a bound");
    CHECK(moray_nlp_sensitivity_weak(s, weak, 4) == 0, "what is active is certain");
    const double rises[] = {1, 0, 0};
    const moray_nlp_shift shift = {.x_lower = rises};
    room.beyond = 7;
    CHECK_OK(moray_nlp_sensitivity_solve(s, &shift, &slope), "its bound rises");
    CHECK(room.beyond == 7, "nothing is written behind the multipliers");
    const double want[] = {1, -0.6, -0.4};
    for (int j = 0; j < 3; j++)
        CHECK_NEAR(slope.x[j], want[j], 1e-15, "d x / d bound");
    CHECK_NEAR(slope.lambda[0], 1.2, 1e-15, "d lambda / d bound");
    CHECK_NEAR(slope.z_lower[0], 2.2, 1e-14, "d z / d bound");
    CHECK_NEAR(slope.g[0], 0, 1e-15, "the equation stays");
    CHECK_NEAR(slope.objective, d.z_lower[0], 1e-15, "d f / d bound is its multiplier");
    const moray_nlp_change down = moray_nlp_sensitivity_change(s, &shift, &slope, -1),
                           up = moray_nlp_sensitivity_change(s, &shift, &slope, 1);
    CHECK_NEAR(down.step, 1.2 / 2.2 - l, 1e-14, "step to where the bound lets go");
    CHECK(down.constraint == 1 && !down.upper && down.leaves, "it is that of x0, the lower one, which lets go");
    CHECK(up.constraint == -1 && up.step > 1e300, "the other way nothing changes");
    const double pull[] = {0, -1, 0}; // f - p x1: nothing but x1 = 0.6 (1-l) + p/5 and x2 gives way
    const moray_nlp_shift pulled = {.objective = -x[1], .gradient = pull};
    CHECK_OK(moray_nlp_sensitivity_solve(s, &pulled, &slope), "a force on x1");
    CHECK_NEAR(slope.x[0], 0, 1e-15, "the bound holds x0");
    CHECK_NEAR(slope.x[1], 0.2, 1e-15, "x1 gives way");
    CHECK_NEAR(slope.objective, -x[1], 1e-15, "d f / d p is that at the solution (envelope theorem)");
    moray_nlp_sensitivity_free(s);
}

// ---- The least |x|² with 6 x0 + 3 x1 + 2 x2 = p0, p1 x0 + x1 - x2 = 1, x >= 0 --------------------------------------

static void least_norm(const double *x, const double *p, struct facts *f)
{
    const double A[2][3] = {{6, 3, 2}, {p[1], 1, -1}};
    memcpy(f->jac, A, sizeof A);
    for (int j = 0; j < 3; j++) {
        f->f += x[j] * x[j];
        f->gradient[j] = 2 * x[j];
        f->hess[j][j] = 2;
        for (int i = 0; i < 2; i++)
            f->g[i] += A[i][j] * x[j];
    }
}

// x = A' (A A')^-1 b and lambda = -2 (A A')^-1 b where no bound is active.
static void least_norm_solution(const double *p, double *x, double *lambda)
{
    const double a = 49, b = 6 * p[1] + 1, c = p[1] * p[1] + 2, det = a * c - b * b;
    const double y[] = {(c * p[0] - b) / det, (a - b * p[0]) / det}, A[2][3] = {{6, 3, 2}, {p[1], 1, -1}};
    for (int j = 0; j < 3; j++)
        x[j] = A[0][j] * y[0] + A[1][j] * y[1];
    for (int i = 0; i < 2; i++)
        lambda[i] = -2 * y[i];
}

static void test_least_norm(void)
{
    struct dense d = {.facts = least_norm, .p = {5, 1}, .g_lower = {5, 1}, .g_upper = {5, 1}};
    struct slope room;
    moray_iterate slope = slope_in(&room);
    moray_nlp_sensitivity *s;
    dense_new(&d, 3, 2);
    memset(d.x_lower, 0, sizeof d.x_lower);
    memcpy(d.g, d.g_lower, sizeof d.g);
    least_norm_solution(d.p, d.x, d.lambda);
    CHECK_OK(moray_nlp_sensitivity_new(&s, &d.nlp, &d.at), "least norm");
    const double one[] = {1, 0};
    const moray_nlp_shift first = {.g_lower = one, .g_upper = one};
    CHECK_OK(moray_nlp_sensitivity_solve(s, &first, &slope), "by p0");
    const double want[] = {11 / 98.0, 2 / 98.0, 13 / 98.0};
    for (int j = 0; j < 3; j++)
        CHECK_NEAR(slope.x[j], want[j], 1e-15, "d x / d p0");
    CHECK_NEAR(slope.g[0], 1, 1e-14, "the row follows its bound");
    const moray_nlp_change change = moray_nlp_sensitivity_change(s, &first, &slope, -1);
    CHECK_NEAR(change.step, -2 / 13.0, 1e-14, "x2 comes to 0 when p0 falls by");
    CHECK(change.constraint == 2 + 2 && !change.upper && !change.leaves, "and would pass that bound");
    const double force[] = {d.lambda[1], 0, 0}, moved[] = {0, d.x[0]};
    const moray_nlp_shift second = {.gradient = force, .g = moved};
    CHECK_OK(moray_nlp_sensitivity_solve(s, &second, &slope), "by p1, which is in the Jacobian");
    double x[2][3], lambda[2][2];
    const double h = 1e-5, below[] = {5, 1 - h}, above[] = {5, 1 + h};
    least_norm_solution(below, x[0], lambda[0]);
    least_norm_solution(above, x[1], lambda[1]);
    for (int j = 0; j < 3; j++)
        CHECK_NEAR(slope.x[j], (x[1][j] - x[0][j]) / (2 * h), 1e-9, "d x / d p1");
    for (int i = 0; i < 2; i++)
        CHECK_NEAR(slope.lambda[i], (lambda[1][i] - lambda[0][i]) / (2 * h), 1e-9, "d lambda / d p1");
    CHECK_NEAR(slope.g[1], 0, 1e-14, "the row stays at its bound");
    moray_nlp_sensitivity_free(s);
}

// ---- The point of the disc |x|² <= r² nearest to c = (p0, p1): x = r c / |c|, lambda = |c|/r - 1 -------------------

static void disc(const double *x, const double *p, struct facts *f)
{
    for (int j = 0; j < 2; j++) {
        f->f += (x[j] - p[j]) * (x[j] - p[j]);
        f->gradient[j] = 2 * (x[j] - p[j]);
        f->g[0] += x[j] * x[j];
        f->jac[0][j] = 2 * x[j];
        f->hess[j][j] = f->hess_g[0][j][j] = 2;
    }
}

// Solved by Ipopt, so that slack and multiplier are those of an interior point.
static void test_disc(void)
{
    const double a = 3, b = 4, c = 5, r = 2;
    struct dense d = {.facts = disc, .p = {a, b}, .g_lower = {-MORAY_INFINITY}, .g_upper = {r * r}};
    struct slope room;
    moray_iterate slope = slope_in(&room);
    moray_nlp_sensitivity *s;
    moray_nlp_info info;
    moray_nlp_settings settings = moray_nlp_settings_default();
    settings.tolerance = 1e-12;
    dense_new(&d, 2, 1);
    d.x[0] = 0.3;
    CHECK_OK(moray_ipopt_solve(&d.nlp, &settings, &d.at, &info), "the nearest point of a disc");
    CHECK_NEAR(d.x[0], r * a / c, 1e-7, "solved");
    CHECK_OK(moray_nlp_sensitivity_new(&s, &d.nlp, &d.at), "its sensitivities");
    const double moved[] = {-2, 0}, wider[] = {2 * r};
    const moray_nlp_shift centre = {.objective = -2 * (d.x[0] - a), .gradient = moved}, radius = {.g_upper = wider};
    CHECK_OK(moray_nlp_sensitivity_solve(s, &centre, &slope), "by p0");
    CHECK_NEAR(slope.x[0], r * (1 / c - a * a / (c * c * c)), 1e-7, "d x0 / d p0");
    CHECK_NEAR(slope.x[1], -r * a * b / (c * c * c), 1e-7, "d x1 / d p0");
    CHECK_NEAR(slope.lambda[0], a / (c * r), 1e-7, "d lambda / d p0");
    CHECK_NEAR(slope.objective, 2 * (c - r) * a / c, 1e-7, "d f / d p0");
    CHECK_OK(moray_nlp_sensitivity_solve(s, &radius, &slope), "by r");
    CHECK_NEAR(slope.x[0], a / c, 1e-7, "d x0 / d r");
    CHECK_NEAR(slope.lambda[0], -c / (r * r), 1e-7, "d lambda / d r");
    CHECK_NEAR(slope.objective, -2 * (c - r), 1e-7, "d f / d r");
    const moray_nlp_change change = moray_nlp_sensitivity_change(s, &radius, &slope, 1);
    CHECK_NEAR(change.step, r - r * r / c, 1e-7, "lambda goes to 0, by its tangent, when r rises by");
    CHECK(change.constraint == 0 && change.upper && change.leaves, "and the disc lets go");
    moray_nlp_sensitivity_free(s);
}

// ---- What cannot be done -------------------------------------------------------------------------------------------

static void test_weak(void)
{
    struct dense d = {.facts = disc, .p = {3, 4}, .g_lower = {-MORAY_INFINITY}, .g_upper = {25}};
    moray_nlp_sensitivity *s;
    int weak[2] = {-1, -1};
    dense_new(&d, 2, 1);
    d.x_upper[0] = 3 + 1e-9; // slack, but not by much
    d.x[0] = 3;
    d.x[1] = 4;
    d.g[0] = 25;
    CHECK_OK(moray_nlp_sensitivity_new(&s, &d.nlp, &d.at), "a disc that reaches to the point");
    CHECK(moray_nlp_sensitivity_weak(s, weak, 1) == 2 && weak[0] == 0 && weak[1] == -1,
          "the row is told, as is another");
    CHECK(moray_nlp_sensitivity_weak(s, weak, 2) == 2 && weak[1] == 1 + 0, "the bound of x0");
    moray_nlp_sensitivity_free(s);
}

// Whether it is told of a bound of x0 with this slack and multiplier, which the solver sees in these scales.
static bool told(double slack, double multiplier, double x_scale, double f_scale)
{
    struct dense d = {.facts = quadratic, .g_lower = {1}, .g_upper = {1}};
    const double scales[] = {x_scale, 1, 1};
    moray_nlp_sensitivity *s;
    int weak = -1;
    dense_new(&d, 3, 1);
    d.nlp.x_scale = scales, d.nlp.f_scale = f_scale;
    d.x_lower[0] = -slack;
    d.z_lower[0] = multiplier;
    d.x[1] = 0.6, d.x[2] = 0.4;
    CHECK_OK(moray_nlp_sensitivity_new(&s, &d.nlp, &d.at), "a slack and a multiplier");
    const int n = moray_nlp_sensitivity_weak(s, &weak, 1);
    moray_nlp_sensitivity_free(s);
    return n == 1 && weak == 1;
}

// In doubt is what is small and of one size, or nothing; in the scales of the solver, at whose points slack and
// multiplier have one product.
static void test_doubt(void)
{
    CHECK(told(5e-5, 5e-5, 1, 1), "both are small");
    CHECK(!told(1e-3, 1e-3, 1, 1), "alike, but large");
    CHECK(told(5e-5, 4e-6, 1, 1) && told(4e-6, 5e-5, 1, 1), "small, one a few times the other");
    CHECK(!told(5e-5, 1e-7, 1, 1) && !told(1e-7, 5e-5, 1, 1), "small, but one is hundreds of times the other");
    CHECK(told(5e-9, 0, 1, 1) && told(0, 5e-9, 1, 1), "one is 0, the other nothing");
    CHECK(!told(1e-7, 0, 1, 1) && !told(0, 1e-7, 1, 1), "one is 0, the other small but there");
    CHECK(told(5e-9, -5e-9, 1, 1), "nothing, with the wrong sign");
    CHECK(told(4e-7, 4e-3, 100, 1) && !told(4e-5, 4e-5, 100, 1), "in the scale of the variable both are small");
    CHECK(told(4e-5, 4e-2, 1, 1e-3) && !told(4e-5, 4e-5, 1, 1e-3), "in that of the objective");
}

static void twice(const double *x, const double *p, struct facts *f)
{
    quadratic(x, p, f);
    f->g[1] = 2 * f->g[0];
    for (int j = 0; j < 3; j++)
        f->jac[1][j] = 2;
}

// One equation and its double: x and the sum of lambda_i c_i are as with one.
static void test_dependent(void)
{
    struct dense d = {.facts = twice, .g_lower = {1, 2}, .g_upper = {1, 2}};
    struct slope room;
    moray_iterate slope = slope_in(&room);
    moray_nlp_sensitivity *s;
    dense_new(&d, 3, 2);
    const double x[] = {6 / 11.0, 3 / 11.0, 2 / 11.0}; // x_j = 6/11 / j
    memcpy(d.x, x, sizeof x);
    d.lambda[0] = -6 / 11.0;
    d.g[0] = 1, d.g[1] = 2;
    CHECK_OK(moray_nlp_sensitivity_new(&s, &d.nlp, &d.at), "one constraint twice");
    const double both[] = {1, 2}, one[] = {1, 0};
    const moray_nlp_shift together = {.g_lower = both, .g_upper = both}, apart = {.g_lower = one, .g_upper = one};
    CHECK_OK(moray_nlp_sensitivity_solve(s, &together, &slope), "both move");
    for (int j = 0; j < 3; j++)
        CHECK_NEAR(slope.x[j], x[j], 1e-12, "x grows in proportion");
    CHECK_NEAR(slope.lambda[0] + 2 * slope.lambda[1], -6 / 11.0, 1e-9, "and so does their multiplier");
    CHECK_NEAR(slope.objective, 6 / 11.0, 1e-9, "d f");
    const moray_status status = moray_nlp_sensitivity_solve(s, &apart, &slope);
    CHECK(status.code == MORAY_NUMERIC && strstr(status.text, "cannot all follow"), "one moves alone: %s", status.text);
    moray_nlp_sensitivity_free(s);
}

static void flat(const double *x, const double *p, struct facts *f)
{
    quadratic(x, p, f);
    f->f -= x[0] * x[0] / 2 + x[1] * x[1];
    f->gradient[0] = f->gradient[1] = f->hess[0][0] = f->hess[1][1] = 0;
}

static void test_refusals(void)
{
    struct dense loose = {.facts = flat, .g_lower = {1}, .g_upper = {1}};
    moray_nlp_sensitivity *s;
    moray_status status;
    dense_new(&loose, 3, 1);
    status = moray_nlp_sensitivity_new(&s, &loose.nlp, &loose.at);
    CHECK(status.code == MORAY_NUMERIC && !s, "a minimum that is not strict: %s", status.text);
    loose.x[0] = NAN;
    status = moray_nlp_sensitivity_new(&s, &loose.nlp, &loose.at);
    CHECK(status.code == MORAY_NUMERIC && !s, "not a number: %s", status.text);
}

int main(void)
{
    test_bound();
    test_least_norm();
    test_disc();
    test_weak();
    test_doubt();
    test_dependent();
    test_refusals();
    return tap_done();
}
