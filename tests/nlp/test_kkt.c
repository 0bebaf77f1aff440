// SPDX-License-Identifier: MIT
//
// How optimal a point is, against its definition written out on dense random programmes, of every kind of bound.
#include "tap.h"

#include <string.h>

#include "moray/nlp.h"

enum { n = 5, m = 4, ROUNDS = 400 };

// f = c x, g = J x + d, and a point with multipliers; nothing about it is optimal.
typedef struct linear {
    double c[n], J[m][n], d[m], x_lower[n], x_upper[n], g_lower[m], g_upper[m];
    double x[n], z_lower[n], z_upper[n], g[m], lambda[m];
} linear;

static bool slopes(void *self, const double *x, bool fresh, double *gradient)
{
    (void)x, (void)fresh;
    memcpy(gradient, ((const linear *)self)->c, sizeof((linear *)self)->c);
    return true;
}

static void values_of(const linear *p, const double *x, double *g)
{
    for (int i = 0; i < m; i++) {
        g[i] = p->d[i];
        for (int j = 0; j < n; j++)
            g[i] += p->J[i][j] * x[j];
    }
}

static bool constraints(void *self, const double *x, bool fresh, double *g)
{
    (void)fresh;
    values_of(self, x, g);
    return true;
}

static bool jacobian(void *self, const double *x, bool fresh, double *values)
{
    (void)x, (void)fresh;
    memcpy(values, ((const linear *)self)->J, sizeof((linear *)self)->J);
    return true;
}

// Of five kinds: free, from below, from above, a range, one value.
static void draw_bounds(unsigned long long *seed, double *lower, double *upper)
{
    const int kind = (int)tap_random(seed, 0, 5);
    *lower = kind == 0 || kind == 2 ? -MORAY_INFINITY : tap_random(seed, -2, 0);
    *upper = kind <= 1 ? MORAY_INFINITY : kind == 4 ? *lower : tap_random(seed, 0, 2);
}

// Multipliers of one size, values of another, so that each part of the measure is the largest at times.
static void draw(unsigned long long *seed, linear *p)
{
    const double large = pow(10, tap_random(seed, -2, 2)), far = pow(10, tap_random(seed, -1, 1));
    for (int j = 0; j < n; j++) {
        draw_bounds(seed, &p->x_lower[j], &p->x_upper[j]);
        p->c[j] = tap_random(seed, -1, 1);
        p->x[j] = far * tap_random(seed, -2, 2);
        p->z_lower[j] = large * tap_random(seed, -0.2, 1);
        p->z_upper[j] = large * tap_random(seed, -0.2, 1);
    }
    for (int i = 0; i < m; i++) {
        draw_bounds(seed, &p->g_lower[i], &p->g_upper[i]);
        p->d[i] = tap_random(seed, -1, 1);
        p->lambda[i] = large * tap_random(seed, -1, 1);
        for (int j = 0; j < n; j++)
            p->J[i][j] = tap_random(seed, -1, 1);
    }
    values_of(p, p->x, p->g);
}

static moray_status measure(linear *p, moray_kkt *kkt)
{
    int row[m * n], col[m * n];
    for (int k = 0; k < m * n; k++)
        row[k] = k / n, col[k] = k % n;
    const moray_nlp nlp = {.n = n,
                           .m = m,
                           .x_lower = p->x_lower,
                           .x_upper = p->x_upper,
                           .g_lower = p->g_lower,
                           .g_upper = p->g_upper,
                           .nnz_jac = m * n,
                           .jac_row = row,
                           .jac_col = col,
                           .self = p,
                           .gradient = slopes,
                           .constraints = constraints,
                           .jacobian = jacobian};
    const moray_iterate it = {p->x, p->z_lower, p->z_upper, p->g, p->lambda, 0};
    return moray_kkt_error(&nlp, &it, kkt);
}

static double outside(double value, double lower, double upper, double size)
{
    const double below = (lower - value) / (1 + fabs(lower) + size), above = (value - upper) / (1 + fabs(upper) + size);
    return fmax(0, fmax(below, above));
}

// A multiplier times the slack of its bound; with none, or of the wrong sign, itself.
static double unpaired(double multiplier, double bound, double value)
{
    return fabs(bound) >= MORAY_INFINITY || multiplier < 0 ? fabs(multiplier) : multiplier * fabs(value - bound);
}

static moray_kkt defined(const linear *p)
{
    moray_kkt kkt = {.worst_variable = -1, .worst_constraint = -1};
    double sum = 0;
    for (int i = 0; i < m; i++)
        sum += fabs(p->lambda[i]);
    for (int j = 0; j < n; j++)
        sum += fabs(p->z_lower[j]) + fabs(p->z_upper[j]);
    kkt.dual_scale = fmax(1, sum / (m + 2 * n));
    for (int k = 0; k < n + m; k++) {
        const int i = k - n, j = k;
        double slope = 0, size = 0, violation, pair = 0;
        if (k < n) {
            slope = p->c[j] - p->z_lower[j] + p->z_upper[j];
            for (int row = 0; row < m; row++)
                slope += p->lambda[row] * p->J[row][j];
            violation = outside(p->x[j], p->x_lower[j], p->x_upper[j], 0);
            pair =
                fmax(unpaired(p->z_lower[j], p->x_lower[j], p->x[j]), unpaired(p->z_upper[j], p->x_upper[j], p->x[j]));
        } else {
            for (int column = 0; column < n; column++)
                size = fmax(size, fabs(p->J[i][column] * p->x[column]));
            violation = outside(p->g[i], p->g_lower[i], p->g_upper[i], size);
            pair = unpaired(fabs(p->lambda[i]), p->lambda[i] > 0 ? p->g_upper[i] : p->g_lower[i], p->g[i]);
        }
        const bool fixed = k < n ? p->x_lower[j] == p->x_upper[j] : p->g_lower[i] == p->g_upper[i];
        if (!fixed && fabs(slope) / kkt.dual_scale > kkt.stationarity)
            kkt.stationarity = fabs(slope) / kkt.dual_scale, kkt.worst_variable = j;
        if (violation > kkt.feasibility)
            kkt.feasibility = violation, kkt.worst_constraint = k < n ? m + j : i;
        kkt.complementarity = fmax(kkt.complementarity, fixed ? 0 : pair / kkt.dual_scale);
    }
    kkt.error = fmax(fmax(kkt.stationarity, kkt.feasibility), kkt.complementarity);
    return kkt;
}

static void test_definition(void)
{
    unsigned long long seed = 17;
    double worst = 0;
    int largest[3] = {0}, scaled = 0, places = 0;
    for (int round = 0; round < ROUNDS; round++) {
        linear p;
        moray_kkt found;
        draw(&seed, &p);
        const moray_kkt want = defined(&p);
        if (moray_failed(measure(&p, &found)))
            break;
        const double pairs[][2] = {{found.stationarity, want.stationarity},
                                   {found.feasibility, want.feasibility},
                                   {found.complementarity, want.complementarity},
                                   {found.dual_scale, want.dual_scale},
                                   {found.error, want.error}};
        for (int k = 0; k < 5; k++)
            worst = tap_worse(worst, fabs(pairs[k][0] - pairs[k][1]) / (1 + pairs[k][1]));
        for (int k = 0; k < 3; k++)
            largest[k] += want.error == pairs[k][1];
        scaled += want.dual_scale > 1;
        places += found.worst_variable == want.worst_variable && found.worst_constraint == want.worst_constraint;
    }
    CHECK(worst < 1e-12, "as it is defined: %.1e", worst);
    CHECK(places == ROUNDS, "and told where, %d times", places);
    CHECK(largest[0] > 9 && largest[1] > 9 && largest[2] > 9 && scaled > 9 && scaled < ROUNDS - 9,
          "by the slopes %d, the violations %d, the multipliers %d times; %d scaled", largest[0], largest[1],
          largest[2], scaled);
}

// What is not a number is never the better of two.
static void test_not_a_number(void)
{
    for (int k = 0; k < 5; k++) {
        unsigned long long seed = 3;
        linear p;
        moray_kkt kkt;
        draw(&seed, &p);
        double *const places[] = {&p.c[0], &p.d[0], &p.J[0][0], &p.z_lower[0], &p.lambda[0]};
        *places[k] = NAN;
        const moray_status status = measure(&p, &kkt);
        CHECK(k < 3 ? status.code == MORAY_NUMERIC : !moray_failed(status) && isnan(kkt.error), "case %d: %s", k,
              status.text);
    }
}

static bool flat(void *self, const double *x, bool fresh, double *values)
{
    (void)self, (void)x, (void)fresh, (void)values; // which begin as 0
    return true;
}

// A variable that is none, of which no function tells, is told by a bound on either side.
static void test_variable(void)
{
    const double bounds[][2] = {{0, MORAY_INFINITY}, {-MORAY_INFINITY, 0}, {-1, 1}, {1, 1}};
    for (int k = 0; k < 4; k++) {
        double x = NAN, z[2] = {0};
        const moray_nlp nlp = {.n = 1,
                               .x_lower = &bounds[k][0],
                               .x_upper = &bounds[k][1],
                               .gradient = flat,
                               .constraints = flat,
                               .jacobian = flat};
        moray_kkt kkt;
        CHECK_OK(moray_kkt_error(&nlp, &(moray_iterate){.x = &x, .z_lower = &z[0], .z_upper = &z[1]}, &kkt),
                 "measured");
        CHECK(isnan(kkt.feasibility) && isnan(kkt.error) && kkt.worst_constraint == 0, "bounds %d: %g", k, kkt.error);
    }
}

int main(void)
{
    test_definition();
    test_not_a_number();
    test_variable();
    return tap_done();
}
