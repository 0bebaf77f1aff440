// SPDX-License-Identifier: MIT
//
// Residuals' derivatives against differences, the normal equations and what they say against sums and an inverse that
// are written out, steps within bounds, and where searches start.
#include "swum_logs.h"

#include "moray/dense.h"
#include "moray/snake/instruments.h"

enum { MOST_ITEMS = SWUM_ROWS * 6, MOST_COLUMNS = MORAY_MOST_UNKNOWNS + FIRST * SWUM_LOGS };

static const char *const many[] = {
    "c_t",          "mu_n",           "lambda_2",      "current_y",  "m", "camera_y", "camera_rotation",
    "heading_bias", "position_delay", "heading_delay", "joint_delay"};
enum { MANY = sizeof many / sizeof *many };

static void moved_start(const moray_identify *v, moray_estimate *at)
{
    moray_identify_start(v, 0, at);
    for (int k = 0; k < v->spec.n; k++)
        at->value[k] += 0.03 * v->scale[k] * (1 + k % 3);
    for (int r = 0; r < v->runs; r++)
        for (int i = 0; i < FIRST; i++)
            at->first[r][i] += 0.002 * (i + 1) * (r + 1);
}

// ---- Derivatives ---------------------------------------------------------------------------------------------------

static void differences(const moray_identify *v, int r, const moray_estimate *at, int column, double *slope)
{
    static double value[4][MOST_ITEMS];
    const int n = v->spec.n;
    const double scale = column < n ? v->scale[column] : first_scale, h = 1e-3;
    for (int k = 0; k < 4; k++) {
        moray_estimate moved = *at;
        *(column < n ? &moved.value[column] : &moved.first[r][column - n]) += (k < 2 ? k - 2 : k - 1) * h * scale;
        CHECK(moray_identify_residual(v, r, &moved, value[k], NULL), "swum");
    }
    for (int i = 0; i < v->run[r].items; i++)
        slope[i] = (8 * (value[2][i] - value[1][i]) - (value[3][i] - value[0][i])) / (12 * h);
}

// Each column, in its scale, of either run; of first states that do not vary nothing.
static void check_jacobian(moray_identify *v, bool rest)
{
    static double residual[MOST_ITEMS], jacobian[MOST_ITEMS * (MORAY_MOST_UNKNOWNS + FIRST)], slope[MOST_ITEMS];
    const int stride = v->spec.n + FIRST;
    moray_estimate at;
    moved_start(v, &at);
    for (int r = 0; r < v->runs; r++) {
        CHECK(moray_identify_residual(v, r, &at, residual, jacobian), "swum");
        for (int j = 0; j < stride; j++) {
            double worst = 0, largest = 0;
            differences(v, r, &at, j, slope);
            const bool varies = j < v->spec.n || !rest || j - v->spec.n < MORAY_STATE_V_THETA;
            for (int i = 0; i < v->run[r].items; i++) {
                const double want = varies ? slope[i] : 0;
                worst = tap_worse(worst, fabs(jacobian[i * stride + j] - want));
                largest = fmax(largest, fabs(want));
            }
            CHECK(worst <= 1e-5 * largest && (largest > 0) == varies, "run %d, column %d: off by %.1e of %.1e", r, j,
                  worst, largest);
        }
    }
}

// ---- Equations -----------------------------------------------------------------------------------------------------

// Column of run r's column j among all.
static int column_of(const moray_identify *v, int r, int j)
{
    return j < v->spec.n ? j : j + FIRST * r;
}

static void check_equations(moray_identify *v)
{
    static double residual[MOST_ITEMS], jacobian[MOST_ITEMS * (MORAY_MOST_UNKNOWNS + FIRST)];
    static double normal[MOST_COLUMNS][MOST_COLUMNS], gradient[MOST_COLUMNS];
    const int stride = v->spec.n + FIRST, m = v->columns;
    const double bound = v->spec.huber;
    double cost = 0, got = NAN, alone = NAN, worst = 0;
    int beyond = 0;
    moray_estimate at;
    moved_start(v, &at);
    memset(normal, 0, sizeof normal);
    memset(gradient, 0, sizeof gradient);
    for (int r = 0; r < v->runs; r++) {
        CHECK(moray_identify_residual(v, r, &at, residual, jacobian), "swum");
        for (int k = 0; k < v->run[r].items; k++) {
            const double *row = jacobian + k * stride, size = fabs(residual[k]);
            const bool far = bound > 0 && size > bound;
            const double weight = far ? bound / size : 1;
            beyond += far;
            cost += far ? 2 * bound * size - bound * bound : size * size;
            for (int i = 0; i < stride; i++) {
                gradient[column_of(v, r, i)] += weight * row[i] * residual[k];
                for (int j = 0; j < stride; j++)
                    normal[column_of(v, r, i)][column_of(v, r, j)] += weight * row[i] * row[j];
            }
        }
    }
    CHECK(moray_identify_equations(v, &at, &got) && moray_identify_cost(v, &at, &alone), "equations");
    CHECK_RELATIVE(got, cost, 1e-12, "cost");
    CHECK_RELATIVE(alone, cost, 1e-12, "cost without the equations");
    CHECK((beyond > 10) == (bound > 0) && beyond < v->items - 10, "%d of %d residuals are beyond", beyond, v->items);
    for (int i = 0; i < m; i++) {
        worst = tap_worse(worst, fabs(v->gradient[i] - gradient[i]) / (1 + fabs(gradient[i])));
        for (int j = 0; j < m; j++)
            worst = tap_worse(worst, fabs(v->normal[i * m + j] - normal[i][j]) / (1 + fabs(normal[i][j])));
    }
    CHECK(worst < 1e-11, "normal equations and gradient are sums over all rows: %.1e", worst);
}

// The covariance of the unknowns is their part of the inverse of all normal equations.
static void check_information(const moray_identify *v)
{
    static double A[MOST_COLUMNS * MOST_COLUMNS], inverse[MOST_COLUMNS * MOST_COLUMNS];
    const int n = v->spec.n, m = v->columns;
    double cost, worst = 0;
    moray_estimate at;
    moray_information info;
    moved_start(v, &at);
    CHECK_OK(moray_identify_information(v, &at, &info), "information");
    CHECK(info.n == n && info.rank == n && info.value[0] < 1e10 * info.value[n - 1], "all is known: %d of %d",
          info.rank, n);
    moray_identify_equations(v, &at, &cost);
    memcpy(A, v->normal, (size_t)(m * m) * sizeof *A);
    memset(inverse, 0, sizeof inverse);
    for (int i = 0; i < m; i++)
        inverse[i * m + i] = 1;
    CHECK(moray_dense_solve(m, A, m, inverse), "regular");
    for (int i = 0; i < n; i++) {
        CHECK(info.scale[i] == v->scale[i] && !info.held[i], "scale %g", info.scale[i]);
        for (int j = 0; j < n; j++) {
            const double size = sqrt(inverse[i * m + i] * inverse[j * m + j]);
            const double got = info.covariance[i * n + j] / (v->scale[i] * v->scale[j]);
            worst = tap_worse(worst, fabs(got - inverse[i * m + j]) / size);
        }
    }
    CHECK(worst < 1e-6, "covariance against the inverse: %.1e", worst);
    at.value[0] = v->lower[0];
    at.value[1] = v->upper[1];
    CHECK_OK(moray_identify_information(v, &at, &info), "at bounds");
    CHECK(info.held[0] && info.held[1] && !info.held[2] && info.rank == n - 2, "two are held");
}

static void test_derivatives(void)
{
    static const char *const few[] = {"c_t", "mu_n", "current_y", "heading_bias"};
    moray_swim_log log[SWUM_LOGS];
    swum_spec s;
    moray_identify *v;
    swum_logs(MORAY_FIRST_PRINCIPLES, swum_noise(), log);
    log[1].p_x[7] = log[1].heading[3] = log[0].p_y[9] = log[0].u[12] = NAN;
    log[1].at_motors = true;
    for (int rest = 0; rest < 2; rest++) {
        swum_choose(&s, MORAY_FIRST_PRINCIPLES, many, MANY);
        s.spec.rest = rest;
        s.spec.huber = rest ? 0 : 1.5;
        s.spec.start.robot.motor =
            (moray_motor){.fitted = true, .friction = 0.05, .viscous = 0.02, .forward = 0.8, .smooth_rate = 0.1};
        s.spec.start.robot.motor.smooth_power = 1e-3;
        CHECK_OK(moray_identify_new(&v, &s.spec, log, SWUM_LOGS), "new");
        check_jacobian(v, rest);
        check_equations(v);
        moray_identify_free(v);
        swum_choose(&s, MORAY_FIRST_PRINCIPLES, few, 4);
        CHECK_OK(moray_identify_new(&v, &s.spec, log, SWUM_LOGS), "new");
        check_information(v);
        moray_identify_free(v);
    }
    swum_free(log);
}

// ---- Starts --------------------------------------------------------------------------------------------------------

// Drawn between bounds, in logarithms where both are above 0; 0 is the spec's own.
static void test_starts(void)
{
    static const char *const few[] = {"c_t", "current_y", "rot_gain"};
    moray_swim_log logs[SWUM_LOGS];
    swum_spec s;
    moray_identify *v;
    swum_logs(MORAY_CONTROL_ORIENTED, swum_noise(), logs);
    swum_choose(&s, MORAY_CONTROL_ORIENTED, few, 3);
    s.lower[2] = 0;
    CHECK_OK(moray_identify_new(&v, &s.spec, logs, SWUM_LOGS), "new");
    for (unsigned long seed = 0; seed < 4; seed++) {
        unsigned long state = seed;
        moray_estimate at;
        moray_identify_start(v, seed, &at);
        for (int k = 0; k < 3; k++) {
            const double u = moray_random(&state), start = *moray_unknown_at(s.unknown[k], &s.spec.start);
            const double drawn =
                k == 0 ? exp((1 - u) * log(s.lower[k]) + u * log(s.upper[k])) : (1 - u) * s.lower[k] + u * s.upper[k];
            CHECK_RELATIVE(at.value[k], seed ? drawn : start, 1e-12, few[k]);
        }
        for (int r = 0; r < SWUM_LOGS; r++)
            CHECK(memcmp(at.first[r], v->run[r].guess, sizeof at.first[r]) == 0, "first states of the guess");
    }
    moray_identify_free(v);
    swum_free(logs);
}

// ---- Steps ---------------------------------------------------------------------------------------------------------

// Where the least lies beyond a bound the estimate stops there, the others where the slope is nothing; on either side.
static void test_bounds(void)
{
    static const char *const few[] = {"c_t", "c_n", "current_x"};
    moray_swim_log log[SWUM_LOGS];
    swum_spec s;
    moray_identify *v;
    swum_logs(MORAY_FIRST_PRINCIPLES, swum_noise(), log);
    for (int side = 0; side < 2; side++) {
        moray_estimate at;
        double cost;
        swum_choose(&s, MORAY_FIRST_PRINCIPLES, few, 3);
        const double c_n = s.spec.start.robot.c_n;
        s.lower[1] = c_n * (side ? 0.2 : 1.1);
        s.upper[1] = c_n * (side ? 0.9 : 3);
        s.spec.start.robot.c_n = c_n * (side ? 0.5 : 2);
        CHECK_OK(moray_identify_new(&v, &s.spec, log, SWUM_LOGS), "new");
        moray_identify_start(v, 0, &at);
        CHECK_OK(moray_identify_solve(v, &at), "solve");
        CHECK(at.value[1] == (side ? s.upper[1] : s.lower[1]) && at.converged && at.iterations < 40,
              "at the bound, c_n = %.6g, after %d iterations", at.value[1], at.iterations);
        CHECK(moray_identify_equations(v, &at, &cost) && cost == at.cost, "of the cost that is told");
        CHECK((v->gradient[1] > 0) == !side, "which the descent would cross");
        for (int i = 0; i < v->columns; i++)
            CHECK(i == 1 || fabs(v->gradient[i]) < 1e-5 * sqrt(v->normal[i * v->columns + i] * cost),
                  "slope %d is nothing: %.1e", i, v->gradient[i]);
        moray_identify_free(v);
    }
    swum_free(log);
}

// From where every step goes down, or up, it goes back as far as from where they differ.
static void test_return(void)
{
    static const char *const few[] = {"c_t", "c_n", "current_x"};
    moray_swim_log log[SWUM_LOGS];
    swum_spec s;
    moray_identify *v;
    moray_estimate best, at;
    double cost;
    swum_logs(MORAY_FIRST_PRINCIPLES, swum_noise(), log);
    swum_choose(&s, MORAY_FIRST_PRINCIPLES, few, 3);
    CHECK_OK(moray_identify_new(&v, &s.spec, log, SWUM_LOGS), "new");
    moray_identify_start(v, 0, &best);
    CHECK_OK(moray_identify_solve(v, &best), "solve");
    for (int side = -1; side <= 1; side++) {
        double worst = 0;
        at = best;
        for (int k = 0; k < 3; k++)
            at.value[k] += 0.01 * v->scale[k] * (side ? side : k - 1);
        for (int r = 0; r < SWUM_LOGS; r++)
            for (int i = 0; i < FIRST; i++)
                at.first[r][i] += 0.01 * first_scale * (side ? side : i % 2 - 0.5);
        CHECK_OK(moray_identify_solve(v, &at), "again");
        for (int k = 0; k < 3; k++)
            worst = tap_worse(worst, fabs(at.value[k] - best.value[k]) / v->scale[k]);
        CHECK(worst < 1e-7 && at.converged && at.iterations > 1, "side %d: back to %.1e in %d iterations", side, worst,
              at.iterations);
        CHECK(moray_identify_equations(v, &at, &cost) && fabs(cost - best.cost) < 1e-9 * cost, "at the same cost");
    }
    moray_identify_free(v);
    swum_free(log);
}

// A heading that was logged turns away is the same.
static void test_turns(void)
{
    static const char *const few[] = {"c_t"};
    moray_swim_log log[SWUM_LOGS];
    swum_spec s;
    moray_identify *v;
    moray_estimate at;
    double residual[SWUM_LOGS][MOST_ITEMS], again[MOST_ITEMS];
    swum_logs(MORAY_FIRST_PRINCIPLES, swum_noise(), log);
    swum_choose(&s, MORAY_FIRST_PRINCIPLES, few, 1);
    CHECK_OK(moray_identify_new(&v, &s.spec, log, SWUM_LOGS), "new");
    moray_identify_start(v, 0, &at);
    for (int r = 0; r < SWUM_LOGS; r++)
        CHECK(moray_identify_residual(v, r, &at, residual[r], NULL), "swum");
    moray_identify_free(v);
    for (int r = 0; r < SWUM_LOGS; r++)
        for (int row = 0; row < SWUM_ROWS; row++)
            log[r].heading[row] += r ? -2 * M_PI : 4 * M_PI;
    CHECK_OK(moray_identify_new(&v, &s.spec, log, SWUM_LOGS), "new");
    for (int r = 0; r < SWUM_LOGS; r++) {
        double worst = 0;
        CHECK(moray_identify_residual(v, r, &at, again, NULL), "swum");
        for (int k = 0; k < v->run[r].items; k++)
            worst = tap_worse(worst, fabs(again[k] - residual[r][k]));
        CHECK(worst < 1e-9, "run %d: the same residuals, %.1e", r, worst);
    }
    moray_identify_free(v);
    swum_free(log);
}

// Without iterations nothing is done, with one it has not converged; what cannot be swum is told.
static void test_iterations(void)
{
    static const char *const few[] = {"c_t", "c_n"};
    moray_swim_log log[SWUM_LOGS];
    swum_spec s;
    moray_identify *v;
    moray_estimate at, start;
    swum_logs(MORAY_FIRST_PRINCIPLES, swum_noise(), log);
    for (int most = 0; most < 3; most++) {
        swum_choose(&s, MORAY_FIRST_PRINCIPLES, few, 2);
        s.spec.max_iterations = most;
        CHECK_OK(moray_identify_new(&v, &s.spec, log, 1), "new");
        moray_identify_start(v, 0, &at);
        start = at;
        CHECK_OK(moray_identify_solve(v, &at), "solve");
        CHECK(at.iterations == most && !at.converged && (at.value[0] == start.value[0]) == (most == 0),
              "%d iterations: %d done", most, at.iterations);
        moray_identify_free(v);
    }
    CHECK_OK(moray_identify_new(&v, &s.spec, log, 1), "new");
    at.value[0] = NAN;
    moray_information info;
    const moray_status status = moray_identify_solve(v, &at);
    CHECK(status.code == MORAY_NUMERIC && strcmp(status.text, "the logs cannot be swum with these coefficients") == 0 &&
              strcmp(at.why.text, status.text) == 0 && !at.converged,
          "%s", status.text);
    CHECK(moray_identify_information(v, &at, &info).code == MORAY_NUMERIC, "nor has it any information");
    moray_identify_free(v);
    swum_free(log);
}

// The largest |sum of phi| that the steps of run r come across, and that of its end.
static double widest(const moray_identify *v, int r, double *at_end)
{
    const struct run *run = &v->run[r];
    const moray_gait gait =
        moray_gait_map(&v->spec.start.robot, &run->motion.gait, MORAY_FIRST_PRINCIPLES, v->spec.model);
    double phi[2], rates[4], most = 0;
    *at_end = 0;
    for (int k = 0; k <= 2 * run->steps; k++) {
        moray_gait_reference(&gait, 2, run->log->t[0] + k * run->h / 2 + run->motion.shift, phi, rates, rates + 2);
        *at_end = fabs(phi[0] + phi[1]);
        most = fmax(most, *at_end);
    }
    return most;
}

// An added mass with which the accelerations are not determined, where the body is bent most, within a run that ends
// well.
static void test_not_swum(void)
{
    static const char *const few[] = {"mu_n"};
    moray_swim_log logs[SWUM_LOGS];
    swum_spec s;
    moray_identify *v;
    double residual[MOST_ITEMS];
    swum_logs(MORAY_CONTROL_ORIENTED, swum_noise(), logs);
    swum_choose(&s, MORAY_CONTROL_ORIENTED, few, 1);
    CHECK_OK(moray_identify_new(&v, &s.spec, logs, SWUM_LOGS), "new");
    for (int r = 0; r < SWUM_LOGS; r++) {
        const moray_robot *robot = &v->spec.start.robot;
        double at_end, cost;
        const double most = widest(v, r, &at_end), a = 3 * (4 * robot->l) / (2 * most); // a sqrt(m (m + mu)) = mu
        const double mu = a * robot->m * (a / 2 + sqrt(a * a / 4 + 1));
        CHECK(at_end < 0.9 * most, "run %d: it ends straighter", r);
        for (int beyond = 0; beyond < 2; beyond++) {
            moray_estimate at;
            moray_identify_start(v, 0, &at);
            at.value[0] = mu * (beyond ? 1.02 : 0.98);
            CHECK(moray_identify_residual(v, r, &at, residual, NULL) == !beyond, "run %d, mu_n = %.4g kg", r,
                  at.value[0]);
            CHECK(!beyond || !moray_identify_cost(v, &at, &cost), "has no cost");
        }
    }
    moray_identify_free(v);
    swum_free(logs);
}

int main(void)
{
    test_derivatives();
    test_starts();
    test_bounds();
    test_return();
    test_turns();
    test_iterations();
    test_not_swum();
    return tap_done();
}
