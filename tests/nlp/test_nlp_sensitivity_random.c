// SPDX-License-Identifier: MIT
//
// Sensitivities of random quadratic programmes whose solutions are made up, of every kind of activity, against the
// linear system written out; and the first change of what is active, against all there may be.
#include "tap.h"

#include <string.h>

#include "moray/dense.h"
#include "programme.h"

enum { n = 3, m = 2, all = n + m };
enum kind { inactive, at_lower, at_upper, equal };

static double H[n][n], A[m][n], q[n];

static void quadratic(const double *x, const double *p, struct facts *f)
{
    (void)p;
    for (int i = 0; i < n; i++) {
        f->gradient[i] = q[i];
        for (int j = 0; j < n; j++) {
            f->gradient[i] += H[i][j] * x[j];
            f->hess[i][j] = H[i][j];
            f->f += H[i][j] * x[i] * x[j] / 2;
        }
        f->f += q[i] * x[i];
        for (int r = 0; r < m; r++) {
            f->g[r] += A[r][i] * x[i];
            f->jac[r][i] = A[r][i];
        }
    }
}

static double draw(unsigned long long *seed, double low, double high)
{
    return tap_random(seed, low, high);
}

// Bounds about a value: on it where that is active, else away or not there.
static void bound(unsigned long long *seed, enum kind kind, double value, double *lower, double *upper)
{
    *lower = kind == at_lower || kind == equal ? value
             : draw(seed, 0, 1) < 0.3          ? -MORAY_INFINITY
                                               : value - draw(seed, 0.5, 2);
    *upper = kind == at_upper || kind == equal ? value
             : draw(seed, 0, 1) < 0.3          ? MORAY_INFINITY
                                               : value + draw(seed, 0.5, 2);
}

// A point, its multipliers, and the linear term that makes it the solution. kind[m + n]: of rows, then columns.
static void make(struct dense *d, unsigned long long *seed, enum kind *kind)
{
    for (int i = 0; i < n; i++)
        for (int j = 0; j <= i; j++)
            H[i][j] = H[j][i] = i == j ? draw(seed, 3, 5) : draw(seed, -1, 1);
    for (int r = 0; r < m; r++)
        for (int j = 0; j < n; j++)
            A[r][j] = draw(seed, -2, 2);
    int active = 0;
    for (int i = 0; i < all; i++) {
        kind[i] = (enum kind)(int)draw(seed, 0, 4);
        kind[i] = active == n - 1 ? inactive : kind[i];
        active += kind[i] != inactive;
    }
    for (int j = 0; j < n; j++)
        d->x[j] = draw(seed, -3, 3);
    for (int r = 0; r < m; r++) {
        d->g[r] = 0;
        for (int j = 0; j < n; j++)
            d->g[r] += A[r][j] * d->x[j];
        bound(seed, kind[r], d->g[r], &d->g_lower[r], &d->g_upper[r]);
        const double size = draw(seed, 0.5, 2);
        d->lambda[r] = kind[r] == inactive ? 0 : kind[r] == at_lower ? -size : kind[r] == at_upper ? size : size - 1;
    }
    for (int j = 0; j < n; j++) {
        bound(seed, kind[m + j], d->x[j], &d->x_lower[j], &d->x_upper[j]);
        d->z_lower[j] = kind[m + j] == at_lower ? draw(seed, 0.5, 2) : 0;
        d->z_upper[j] = kind[m + j] == at_upper ? draw(seed, 0.5, 2) : 0;
        q[j] = d->z_lower[j] - d->z_upper[j];
        for (int i = 0; i < n; i++)
            q[j] -= H[j][i] * d->x[i];
        for (int r = 0; r < m; r++)
            q[j] -= A[r][j] * d->lambda[r];
    }
}

struct shift {
    double gradient[n], g[m], lower[all], upper[all]; // bounds of rows, then of columns
};

static double bound_moves(const struct shift *shift, const enum kind *kind, int i)
{
    return kind[i] == at_upper ? shift->upper[i] : shift->lower[i];
}

// dx and dlambda by the linear system; what is left of the slope of the Lagrangian.
static void solve_linear(const enum kind *kind, const struct shift *shift, double *solution, double *left)
{
    double K[all * all] = {0};
    for (int j = 0; j < n; j++) {
        const bool held = kind[m + j] != inactive;
        for (int i = 0; i < n; i++)
            K[j * all + i] = held ? i == j : H[j][i];
        for (int r = 0; r < m; r++)
            K[j * all + n + r] = held ? 0 : A[r][j];
        solution[j] = held ? bound_moves(shift, kind, m + j) : -shift->gradient[j];
    }
    for (int r = 0; r < m; r++) {
        for (int j = 0; j < n; j++)
            K[(n + r) * all + j] = kind[r] == inactive ? 0 : A[r][j];
        K[(n + r) * all + n + r] = kind[r] == inactive;
        solution[n + r] = kind[r] == inactive ? 0 : bound_moves(shift, kind, r) - shift->g[r];
    }
    CHECK(moray_dense_solve(all, K, 1, solution), "regular");
    for (int j = 0; j < n; j++) {
        left[j] = -shift->gradient[j];
        for (int i = 0; i < n; i++)
            left[j] -= H[j][i] * solution[i];
        for (int r = 0; r < m; r++)
            left[j] -= A[r][j] * solution[n + r];
    }
}

static double error_of(const moray_iterate *slope, const struct dense *d, const enum kind *kind,
                       const struct shift *shift, const double *want, const double *left)
{
    double worst = 0, objective = 0.7;
    for (int j = 0; j < n; j++) {
        double f = q[j];
        for (int i = 0; i < n; i++)
            f += H[j][i] * d->x[i];
        objective += f * want[j];
        worst = tap_worse(worst, fabs(slope->x[j] - want[j]));
        worst = tap_worse(worst, fabs(slope->z_lower[j] - (kind[m + j] == at_lower ? -left[j] : 0)));
        worst = tap_worse(worst, fabs(slope->z_upper[j] - (kind[m + j] >= at_upper ? left[j] : 0)));
    }
    for (int r = 0; r < m; r++) {
        double g = shift->g[r];
        for (int j = 0; j < n; j++)
            g += A[r][j] * want[j];
        worst = tap_worse(worst, fabs(slope->lambda[r] - want[n + r]));
        worst = tap_worse(worst, fabs(slope->g[r] - g));
    }
    return tap_worse(worst, fabs(slope->objective - objective));
}

// The first of all multipliers and slacks that come to 0 along the slope.
static moray_nlp_change first_change(const struct dense *d, const enum kind *kind, const struct shift *shift,
                                     const moray_iterate *slope, int direction)
{
    moray_nlp_change first = {INFINITY, -1, false, false};
    for (int i = 0; i < all; i++)
        for (int upper = 0; upper < 2; upper++) {
            const int j = i - m;
            const bool row = i < m, own = kind[i] == (upper ? at_upper : at_lower);
            const double sign = upper ? 1 : -1,
                         end = row ? (upper ? d->g_upper[i] : d->g_lower[i]) : (upper ? d->x_upper[j] : d->x_lower[j]);
            double value = row ? sign * d->lambda[i] : upper ? d->z_upper[j] : d->z_lower[j];
            double rate = row ? sign * slope->lambda[i] : upper ? slope->z_upper[j] : slope->z_lower[j];
            if (kind[i] == inactive) {
                value = sign * (end - (row ? d->g[i] : d->x[j]));
                rate = sign * ((upper ? shift->upper[i] : shift->lower[i]) - (row ? slope->g[i] : slope->x[j]));
            }
            const double step = -value / (rate * direction);
            if (fabs(end) < MORAY_INFINITY && (own || kind[i] == inactive) && step > 0 && step < first.step)
                first = (moray_nlp_change){step, i, upper, own};
        }
    first.step *= direction;
    return first;
}

static void test_random(bool scaled)
{
    unsigned long long seed = 41;
    double worst = 0, far = 0;
    int wrong = 0, leaves = 0, weak = 0, none = 0;
    for (int trial = 0; trial < 500; trial++) {
        struct dense d = {.facts = quadratic};
        struct slope room;
        moray_iterate slope = slope_in(&room);
        struct shift shift;
        enum kind kind[all];
        moray_nlp_sensitivity *s;
        double want[all], left[n], x_scale[n], g_scale[m];
        dense_new(&d, n, m);
        make(&d, &seed, kind);
        for (int j = 0; j < n; j++)
            shift.gradient[j] = draw(&seed, -1, 1), x_scale[j] = draw(&seed, 0.5, 2);
        for (int r = 0; r < m; r++)
            shift.g[r] = draw(&seed, -1, 1), g_scale[r] = draw(&seed, 0.5, 2);
        for (int i = 0; i < all; i++) {
            shift.lower[i] = draw(&seed, -1, 1);
            shift.upper[i] = kind[i] == equal ? shift.lower[i] : draw(&seed, -1, 1);
        }
        if (scaled)
            d.nlp.x_scale = x_scale, d.nlp.g_scale = g_scale, d.nlp.f_scale = 0.6;
        CHECK_OK(moray_nlp_sensitivity_new(&s, &d.nlp, &d.at), "made");
        const moray_nlp_shift given = {.objective = 0.7,
                                       .gradient = shift.gradient,
                                       .g = shift.g,
                                       .x_lower = shift.lower + m,
                                       .x_upper = shift.upper + m,
                                       .g_lower = shift.lower,
                                       .g_upper = shift.upper};
        CHECK_OK(moray_nlp_sensitivity_solve(s, &given, &slope), "solved");
        solve_linear(kind, &shift, want, left);
        worst = tap_worse(worst, error_of(&slope, &d, kind, &shift, want, left));
        for (int direction = -1; direction < 2; direction += 2) {
            const moray_nlp_change found = moray_nlp_sensitivity_change(s, &given, &slope, direction),
                                   first = first_change(&d, kind, &shift, &slope, direction);
            wrong += found.constraint != first.constraint || found.upper != first.upper || found.leaves != first.leaves;
            far = tap_worse(far, isinf(first.step) && found.step == first.step ? 0 : fabs(found.step / first.step - 1));
            leaves += first.leaves, none += first.constraint < 0;
        }
        int place[all];
        weak += moray_nlp_sensitivity_weak(s, place, all);
        moray_nlp_sensitivity_free(s);
    }
    CHECK(worst < 1e-8, "slopes of all: %.1e", worst);
    CHECK(wrong == 0 && far < 1e-12, "first changes, but for %d; steps to %.1e", wrong, far);
    CHECK(leaves > 50 && leaves < 950 && none > 0, "%d let go, %d times nothing changes", leaves, none);
    CHECK(weak == 0, "and nothing is in doubt, but for %d", weak);
}

int main(void)
{
    test_random(false);
    test_random(true);
    return tap_done();
}
