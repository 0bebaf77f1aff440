// SPDX-License-Identifier: MIT
//
// Sensitivities of a quadratic programme whose variables are all in all of it, against two of its solutions;
// and how little of slope and curvature is enough.
#include "tap.h"

#include <string.h>

#include "moray/dense.h"
#include "programme.h"

// ---- x' H x / 2 + q x, a x = b, and one variable at a bound --------------------------------------------------------

static const double coupled_H[3][3] = {{4, 1, -0.7}, {1, 5, 1.3}, {-0.7, 1.3, 3}}, coupled_a[3] = {1, -0.4, 0.6};

// q[3], b, the bound
enum { B = 3, BOUND = 4, PARAMETERS = 5 };

static void coupled(const double *x, const double *p, struct facts *f)
{
    for (int i = 0; i < 3; i++) {
        f->gradient[i] = p[i];
        for (int j = 0; j < 3; j++) {
            f->gradient[i] += coupled_H[i][j] * x[j];
            f->hess[i][j] = coupled_H[i][j];
        }
        f->f += (f->gradient[i] + p[i]) * x[i] / 2;
        f->g[0] += coupled_a[i] * x[i];
        f->jac[0][i] = coupled_a[i];
    }
}

// x and lambda with x[held] at its bound, and what is left of the Lagrangian's slope there.
static void coupled_solution(const double *p, int held, double solution[4], double *left)
{
    double A[16] = {0};
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++)
            A[i * 4 + j] = i == held ? i == j : coupled_H[i][j];
        A[i * 4 + 3] = i == held ? 0 : coupled_a[i];
        A[3 * 4 + i] = coupled_a[i];
        solution[i] = i == held ? p[BOUND] : -p[i];
    }
    solution[3] = p[B];
    CHECK(moray_dense_solve(4, A, 1, solution), "regular");
    *left = p[held] + solution[3] * coupled_a[held];
    for (int j = 0; j < 3; j++)
        *left += coupled_H[held][j] * solution[j];
}

static void test_coupled(int held, bool lower, bool upper, const double *moves)
{
    double p[PARAMETERS] = {0.2, -0.3, 0.4, 0.5, 0.1}, moved[PARAMETERS], now[4], later[4], left[2];
    p[held] += lower ? 9 : -9; // towards the bound
    for (int k = 0; k < PARAMETERS; k++)
        moved[k] = p[k] + moves[k];
    coupled_solution(p, held, now, &left[0]);
    coupled_solution(moved, held, later, &left[1]); // all is linear: its change is the slope
    struct dense d = {.facts = coupled, .g_lower = {p[B]}, .g_upper = {p[B]}};
    struct slope room;
    moray_iterate slope = slope_in(&room);
    moray_nlp_sensitivity *s;
    dense_new(&d, 3, 1);
    memcpy(d.p, p, sizeof d.p);
    memcpy(d.x, now, sizeof d.x);
    d.g[0] = p[B], d.lambda[0] = now[3];
    if (lower)
        d.x_lower[held] = p[BOUND], d.z_lower[held] = fmax(left[0], 0);
    if (upper)
        d.x_upper[held] = p[BOUND], d.z_upper[held] = fmax(-left[0], 0);
    CHECK(lower ? left[0] > 1 : left[0] < -1, "variable %d is held: %g", held, left[0]);
    CHECK_OK(moray_nlp_sensitivity_new(&s, &d.nlp, &d.at), "coupled variables");
    double bound[3] = {0}, *still = calloc(1, sizeof *still); // of its own, as long as there are rows
    bound[held] = moves[BOUND];
    const moray_nlp_shift shift = {
        .gradient = moves, .g = still, .g_lower = &moves[B], .g_upper = &moves[B], .x_lower = bound, .x_upper = bound};
    CHECK_OK(moray_nlp_sensitivity_solve(s, &shift, &slope), "all of it moves");
    const double change = left[1] - left[0];
    for (int j = 0; j < 3; j++) {
        CHECK_NEAR(slope.x[j], later[j] - now[j], 1e-12, "x");
        CHECK_NEAR(slope.z_lower[j], j == held && lower && !upper ? change : 0, 1e-12, "multiplier of the lower bound");
        CHECK_NEAR(slope.z_upper[j], j == held && upper ? -change : 0, j == held ? 1e-12 : 0, "of the upper one");
    }
    CHECK_NEAR(slope.lambda[0], later[3] - now[3], 1e-12, "multiplier of the row");
    CHECK_NEAR(slope.g[0], moves[B], 1e-12, "the row");
    moray_nlp_sensitivity_free(s);
    free(still);
}

// ---- The least slope of a row: x0^2 / 2 + x1^2 / 2, a x0 = b -------------------------------------------------------

static void steep(const double *x, const double *p, struct facts *f)
{
    f->f = (x[0] * x[0] + x[1] * x[1]) / 2;
    f->g[0] = p[0] * x[0];
    f->jac[0][0] = p[0];
    for (int j = 0; j < 2; j++)
        f->gradient[j] = x[j], f->hess[j][j] = 1;
}

// Each of three refinements leaves r / (r + a^2) of the row's residual, r = 1e-10 in the solver's scale: what is left
// is to be 1e-6 of the largest right-hand side in that scale, which here is of x1, 10 times that of the row.
static void test_slope(double left, bool follows)
{
    const double f_scale = 0.25, g_scale = 4, scales[] = {3, 0.5}, r = 1e-10 * f_scale / (g_scale * g_scale);
    const double rest = cbrt(left * 1e-5), by_row = 1, by_column = 10 * g_scale * scales[1] / f_scale;
    struct dense d = {.facts = steep, .p = {sqrt(r * (1 / rest - 1))}, .g_lower = {0}, .g_upper = {0}};
    struct slope room;
    moray_iterate slope = slope_in(&room);
    moray_nlp_sensitivity *s;
    dense_new(&d, 2, 1);
    d.nlp.f_scale = f_scale, d.nlp.g_scale = &g_scale, d.nlp.x_scale = scales;
    CHECK_OK(moray_nlp_sensitivity_new(&s, &d.nlp, &d.at), "a row of little slope");
    const moray_nlp_shift shift = {.gradient = (double[]){0, by_column}, .g_lower = &by_row, .g_upper = &by_row};
    const moray_status status = moray_nlp_sensitivity_solve(s, &shift, &slope);
    CHECK(follows ? !moray_failed(status) : status.code == MORAY_NUMERIC, "%g of what may be left: %s", left,
          status.text);
    if (follows)
        CHECK_NEAR(slope.x[0] * d.p[0], 1 - left * 1e-5, 1e-9, "the row, but for what is left");
    moray_nlp_sensitivity_free(s);
}

// ---- The least curvature: (x0 + x1)^2 / 2 + c x1^2 / 2 -------------------------------------------------------------

static void valley(const double *x, const double *p, struct facts *f)
{
    (void)x;
    f->hess[0][0] = f->hess[0][1] = f->hess[1][0] = 1;
    f->hess[1][1] = 1 + p[0];
}

static void test_curvature(void)
{
    const double least = 4 * 0x1p-52;
    for (int k = 0; k < 2; k++) {
        struct dense d = {.facts = valley, .p = {k * least}};
        moray_nlp_sensitivity *s;
        dense_new(&d, 2, 0);
        const moray_status status = moray_nlp_sensitivity_new(&s, &d.nlp, &d.at);
        CHECK(k ? !moray_failed(status) : status.code == MORAY_NUMERIC, "a curvature of %g: %s", d.p[0], status.text);
        moray_nlp_sensitivity_free(s);
    }
}

int main(void)
{
    // Of mixed signs; such that all that moves falls.
    static const double moves[][PARAMETERS] = {{0.3, -0.5, 0.9, 0.7, 0.2}, {0.3, 0.5, 0.9, -0.7, -0.2}};
    for (int held = 0; held < 3; held++)
        for (int kind = 1; kind < 4; kind++)
            for (int k = 0; k < 2; k++)
                test_coupled(held, kind & 1, kind & 2, moves[k]);
    test_slope(0.97, true);
    test_slope(1.03, false);
    test_curvature();
    return tap_done();
}
