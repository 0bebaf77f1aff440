// SPDX-License-Identifier: MIT
//
// Search on problems with known optima: local methods on smooth problems, global ones on many-peaked ones.
#include "tap.h"

#include <string.h>

#include "moray/search.h"

// What to minimise, and how often it was asked.
typedef struct task {
    int evaluations, undefined;
    bool holes; // not defined where x + y > 2.1
} task;

// Rosenbrock's valley (1 - x)^2 + 100 (y - x^2)^2, least at (1, 1).
static bool valley(void *self, const double *x, double *f, double *c, double *gradient, double *jacobian)
{
    task *t = self;
    (void)c;
    (void)jacobian;
    const double bend = x[1] - x[0] * x[0];
    t->evaluations++;
    if (t->holes && x[0] + x[1] > 2.1) {
        t->undefined++;
        return false;
    }
    *f = (1 - x[0]) * (1 - x[0]) + 100 * bend * bend;
    if (gradient) {
        gradient[0] = -2 * (1 - x[0]) - 400 * x[0] * bend;
        gradient[1] = 200 * bend;
    }
    return true;
}

// Hock & Schittkowski 43 (Rosen & Suzuki): least -44 at (0, 1, 2, -1), with the first and third constraint active.
static bool rosen_suzuki(void *self, const double *x, double *f, double *c, double *gradient, double *jacobian)
{
    static const double square[4][4] = {{1, 1, 2, 1}, {1, 1, 1, 1}, {1, 2, 1, 2}, {2, 1, 1, 0}};
    static const double linear[4][4] = {{-5, -5, -21, 7}, {1, -1, 1, -1}, {-1, 0, 0, -1}, {2, -1, 0, -1}};
    static const double constant[4] = {0, -8, -10, -5};
    task *t = self;
    t->evaluations++;
    for (int i = 0; i < 4; i++) {
        double *value = i ? c + i - 1 : f, *slope = i ? (jacobian ? jacobian + 4 * (i - 1) : NULL) : gradient;
        *value = constant[i];
        for (int j = 0; j < 4; j++) {
            *value += square[i][j] * x[j] * x[j] + linear[i][j] * x[j];
            if (slope)
                slope[j] = 2 * square[i][j] * x[j] + linear[i][j];
        }
    }
    return true;
}

// Rastrigin's egg box on [-5.12, 5.12]^2 shifted to (0.3, -0.7); with the constraint x + y >= 1.1 its least value
// within is that of a smaller egg: found below by a fine grid.
static bool egg_box(void *self, const double *x, double *f, double *c, double *gradient, double *jacobian)
{
    task *t = self;
    const double at[] = {x[0] - 0.3, x[1] + 0.7};
    t->evaluations++;
    *f = 20;
    for (int j = 0; j < 2; j++) {
        *f += at[j] * at[j] - 10 * cos(2 * M_PI * at[j]);
        if (gradient)
            gradient[j] = 2 * at[j] + 20 * M_PI * sin(2 * M_PI * at[j]);
    }
    c[0] = 1.1 - x[0] - x[1];
    if (jacobian)
        jacobian[0] = jacobian[1] = -1;
    return true;
}

static bool open_egg_box(void *self, const double *x, double *f, double *c, double *gradient, double *jacobian)
{
    double ignored[2];
    (void)c;
    (void)jacobian;
    return egg_box(self, x, f, ignored, gradient, NULL);
}

static const double wide[] = {-5.12, -5.12, -5.12, -5.12}, high[] = {5.12, 5.12, 5.12, 5.12};
static const double none_below[] = {-MORAY_INFINITY, -MORAY_INFINITY, -MORAY_INFINITY, -MORAY_INFINITY};
static const double none_above[] = {MORAY_INFINITY, MORAY_INFINITY, MORAY_INFINITY, MORAY_INFINITY};

static double away(int n, const double *x, const double *expected)
{
    double worst = 0;
    for (int k = 0; k < n; k++)
        worst = tap_worse(worst, isnan(x[k]) ? INFINITY : fabs(x[k] - expected[k]));
    return worst;
}

static void test_local(void)
{
    const struct {
        moray_search_method method;
        double valley, suzuki;
    } within[] = {{MORAY_SEARCH_SLSQP, 1e-5, 1e-6}, {MORAY_SEARCH_MMA, 1e-4, 1e-4}, {MORAY_SEARCH_COBYLA, 1e-3, 1e-4}};
    for (int k = 0; k < 3; k++) {
        moray_search_settings settings = moray_search_settings_default();
        moray_search_info info;
        task t = {0};
        double x[] = {-1.2, 1}, y[] = {0, 0, 0, 0};
        settings.method = within[k].method;
        settings.max_evaluations = 20000;
        const char *name = moray_search_method_name(settings.method);
        moray_search_problem problem = {2, 0, none_below, none_above, k < 2, &t, valley};
        CHECK_OK(moray_search(&problem, &settings, x, &info), name);
        CHECK(away(2, x, (double[]){1, 1}) < within[k].valley, "%s: valley: %.1e after %d evaluations, %s", name,
              away(2, x, (double[]){1, 1}), info.evaluations, moray_search_outcome_text(info.outcome));
        CHECK(info.evaluations == t.evaluations, "%s: every evaluation counts once", name);
        problem = (moray_search_problem){4, 3, none_below, none_above, k < 2, &t, rosen_suzuki};
        t.evaluations = 0;
        CHECK_OK(moray_search(&problem, &settings, y, &info), name);
        CHECK(away(4, y, (double[]){0, 1, 2, -1}) < within[k].suzuki && info.violation <= 1e-9,
              "%s: Rosen-Suzuki: %.1e, violation %.1e after %d evaluations, %s", name,
              away(4, y, (double[]){0, 1, 2, -1}), info.violation, info.evaluations,
              moray_search_outcome_text(info.outcome));
        CHECK(info.evaluations == t.evaluations && info.outcome == MORAY_SEARCH_CONVERGED,
              "%s: objective and constraints of one point are one evaluation", name);
        CHECK_NEAR(info.objective, -44, 1e-6, "objective");
    }
}

// Bounds that cut the valley off at x <= 0.5: least at (0.5, 0.25).
static void test_bounds(void)
{
    const moray_search_method methods[] = {MORAY_SEARCH_SLSQP, MORAY_SEARCH_MMA, MORAY_SEARCH_COBYLA,
                                           MORAY_SEARCH_BOBYQA};
    for (int k = 0; k < 4; k++) {
        moray_search_settings settings = moray_search_settings_default();
        moray_search_info info;
        task t = {0};
        const double upper[] = {0.5, 2}, lower[] = {-2, -2};
        double x[] = {7, 7}; // outside
        settings.method = methods[k];
        const moray_search_problem problem = {2, 0, lower, upper, true, &t, valley};
        CHECK_OK(moray_search(&problem, &settings, x, &info), moray_search_method_name(methods[k]));
        CHECK(away(2, x, (double[]){0.5, 0.25}) < 1e-4 && x[0] <= 0.5, "%s: at a bound: %.1e",
              moray_search_method_name(methods[k]), away(2, x, (double[]){0.5, 0.25}));
    }
}

static double grid_minimum(bool constrained)
{
    double least = INFINITY;
    for (int i = 0; i <= 1024; i++)
        for (int j = 0; j <= 1024; j++) {
            task t = {0};
            const double x[] = {-5.12 + 0.01 * i, -5.12 + 0.01 * j};
            double f, c[1];
            egg_box(&t, x, &f, c, NULL, NULL);
            if (!constrained || c[0] <= 0)
                least = fmin(least, f);
        }
    return least;
}

// ISRES need only find the cup.
static void test_global(void)
{
    const moray_search_method methods[] = {MORAY_SEARCH_MLSL, MORAY_SEARCH_ISRES, MORAY_SEARCH_DIRECT};
    const double within[] = {1e-6, 0.9, 1e-6};
    for (int constrained = 0; constrained < 2; constrained++) {
        const double least = grid_minimum(constrained);
        for (int k = 0; k < 3; k++) {
            moray_search_settings settings = moray_search_settings_default();
            moray_search_info info, again;
            task t = {0};
            double x[] = {4, 4}, y[] = {4, 4};
            settings.method = methods[k];
            settings.max_evaluations = 10000;
            const moray_search_problem problem = {
                2, constrained, wide, high, true, &t, constrained ? egg_box : open_egg_box};
            const char *name = moray_search_method_name(methods[k]);
            CHECK_OK(moray_search(&problem, &settings, x, &info), name);
            CHECK(info.objective < least + within[k] && info.violation <= 1e-9,
                  "%s%s: %.7g, on a grid %.7g; %d evaluations, %s", name, constrained ? ", constrained" : "",
                  info.objective, least, info.evaluations, moray_search_outcome_text(info.outcome));
            CHECK_OK(moray_search(&problem, &settings, y, &again), name);
            CHECK(x[0] == y[0] && x[1] == y[1] && again.evaluations == info.evaluations, "%s: the same seed, the same",
                  name);
        }
    }
}

// Points where nothing is defined are walked around; DIRECT's rectangles at the hole's edge divide slowly.
static void test_holes(void)
{
    const moray_search_method methods[] = {MORAY_SEARCH_SLSQP, MORAY_SEARCH_MMA, MORAY_SEARCH_ISRES,
                                           MORAY_SEARCH_DIRECT};
    const double within[] = {1e-9, 1e-9, 1e-9, 0.1};
    for (int k = 0; k < 4; k++) {
        moray_search_settings settings = moray_search_settings_default();
        moray_search_info info;
        task t = {.holes = true};
        double x[] = {-2, 4};
        settings.method = methods[k];
        settings.max_evaluations = 20000;
        const moray_search_problem problem = {2, 0, wide, high, true, &t, valley};
        CHECK_OK(moray_search(&problem, &settings, x, &info), moray_search_method_name(methods[k]));
        CHECK(info.objective < within[k], "%s: %.1e with %d undefined points", moray_search_method_name(methods[k]),
              info.objective, t.undefined);
        CHECK(t.undefined > 0, "%s: it did meet them", moray_search_method_name(methods[k]));
    }
}

static bool nowhere(void *self, const double *x, double *f, double *c, double *gradient, double *jacobian)
{
    (void)self;
    (void)c;
    (void)jacobian;
    *f = NAN;
    if (gradient)
        gradient[0] = gradient[1] = x[0];
    return true;
}

static bool stop_at_ten(void *observer, const moray_search_progress *progress)
{
    *(int *)observer = progress->evaluations;
    return progress->evaluations < 10;
}

static void test_stopping(void)
{
    moray_search_settings settings = moray_search_settings_default();
    moray_search_info info;
    task t = {0};
    int seen = 0;
    double x[] = {-1.2, 1};
    moray_search_problem problem = {2, 0, wide, high, true, &t, valley};
    settings.max_evaluations = 7;
    CHECK_OK(moray_search(&problem, &settings, x, &info), "few evaluations");
    CHECK(info.outcome == MORAY_SEARCH_EVALUATION_LIMIT && info.evaluations <= 8, "stopped after %d", info.evaluations);
    settings.max_evaluations = 2000;
    settings.progress = stop_at_ten, settings.observer = &seen;
    double y[] = {-1.2, 1}, f;
    CHECK_OK(moray_search(&problem, &settings, y, &info), "an observer");
    CHECK(info.outcome == MORAY_SEARCH_INTERRUPTED && seen == 10, "stopped by it after %d", seen);
    valley(&t, y, &f, NULL, NULL, NULL);
    CHECK(f == info.objective && f < 24.2, "with the best point so far: %g", f);
    settings.progress = NULL;
    settings.method = MORAY_SEARCH_ISRES;
    settings.max_evaluations = 1000000000;
    settings.max_seconds = 0.05;
    CHECK_OK(moray_search(&problem, &settings, y, &info), "little time");
    CHECK(info.outcome == MORAY_SEARCH_TIME_LIMIT, "stopped: %s", moray_search_outcome_text(info.outcome));
    problem.evaluate = nowhere;
    CHECK(moray_search(&problem, &settings, y, &info).code == MORAY_NUMERIC, "nothing is defined anywhere");
}

static void refuses(const moray_search_problem *problem, moray_search_settings settings, const char *text)
{
    double x[] = {0, 0};
    moray_search_info info;
    const moray_status status = moray_search(problem, &settings, x, &info);
    CHECK(status.code == MORAY_INPUT && strstr(status.text, text), "refused: %s", status.text);
}

static void test_refusals(void)
{
    const moray_search_settings good = moray_search_settings_default();
    moray_search_settings settings = good;
    task t = {0};
    moray_search_problem problem = {2, 1, wide, high, false, &t, egg_box};
    refuses(&problem, good, "slsqp: needs gradients");
    problem.gradients = true;
    settings.method = MORAY_SEARCH_BOBYQA;
    refuses(&problem, settings, "bobyqa: takes no constraints");
    settings.method = MORAY_SEARCH_DIRECT;
    problem.upper = none_above;
    refuses(&problem, settings, "direct needs finite");
    problem.upper = (double[]){1, -7};
    refuses(&problem, good, "bounds of x[1]");
    problem.upper = high;
    settings = good, settings.f_tolerance = NAN;
    refuses(&problem, settings, "f_tolerance = nan");
    settings = good, settings.max_evaluations = 0;
    refuses(&problem, settings, "max_evaluations = 0");
    settings = good, settings.max_seconds = -1;
    refuses(&problem, settings, "max_seconds = -1");
    settings = good, settings.method = (moray_search_method)99;
    refuses(&problem, settings, "method = 99");
}

int main(void)
{
    test_local();
    test_bounds();
    test_global();
    test_holes();
    test_stopping();
    test_refusals();
    return tap_done();
}
