// SPDX-License-Identifier: MIT
//
// What a search returns, against a record of all points that it asked for: the best of them, the first in the order
// that they came; what it tells meanwhile; and how it begins.
#include "tap.h"

#include <string.h>

#include "moray/clock.h"
#include "moray/search.h"

enum { n = 3, room = 4000 };
static const double tolerance = 1e-3;

struct record {
    int calls, told, shift; // the objective's and the constraints' own places
    double least;           // of the constraint, at best
    double x[room][n], f[room], violation[room];
    bool defined[room];
};

// A bowl with waves; within |x - c| >= 1 (never, where `least` is more than 0; everywhere on the limit of what is
// tolerated, where it is less) and x0 + x1 <= 1; not defined in
// between.
static bool waves(void *self, const double *x, double *f, double *c, double *gradient, double *jacobian)
{
    struct record *r = self;
    const double centre[n] = {0.3, -0.4, 0.9};
    double away = 0;
    *f = 0;
    for (int j = 0; j < n; j++) {
        const double d = x[j] - centre[j];
        *f += d * d - 0.3 * cos(5 * d);
        away += d * d;
        if (gradient)
            gradient[j] = 2 * d + 1.5 * sin(5 * d);
        if (jacobian)
            jacobian[j] = -2 * d, jacobian[n + j] = j < 2;
    }
    c[0] = 1 + r->least - away;
    c[1] = x[0] + x[1] - 1;
    if (r->least > 0)
        c[0] = r->least + away;
    if (r->least < 0)
        c[0] = tolerance;
    for (int j = 0; j < n && jacobian; j++)
        jacobian[j] *= r->least > 0 ? -1 : r->least < 0 ? 0 : 1;
    if (r->calls < room) {
        memcpy(r->x[r->calls], x, sizeof r->x[0]);
        r->f[r->calls] = *f;
        r->violation[r->calls] = fmax(fmax(c[0], c[1]), 0);
        r->defined[r->calls] = !(x[0] > 2 && x[0] < 3.5) && isfinite(*f); // COBYLA makes points of infinite values
    }
    r->calls++;
    return !(x[0] > 2 && x[0] < 3.5);
}

static bool precedes(const struct record *r, int one, int other, double within)
{
    const bool inside = r->violation[one] <= within, other_inside = r->violation[other] <= within;
    if (inside && other_inside)
        return r->f[one] < r->f[other];
    return inside || (!other_inside && r->violation[one] < r->violation[other]);
}

static int best_of(const struct record *r, int calls, double within)
{
    int best = -1;
    for (int k = 0; k < calls; k++)
        if (r->defined[k] && (best < 0 || precedes(r, k, best, within)))
            best = k;
    return best;
}

// Every time the best so far.
static bool listen(void *observer, const moray_search_progress *progress)
{
    struct record *r = observer;
    const int best = best_of(r, r->calls, tolerance);
    r->told += progress->evaluations == r->calls && best >= 0 && progress->objective == r->f[best] &&
               progress->violation == r->violation[best] && memcmp(progress->x, r->x[best], sizeof r->x[0]) == 0;
    return true;
}

static const double lower[n] = {-2, -3, -1}, upper[n] = {4, 3.5, 3};

static moray_search_info run(struct record *r, moray_search_method method, unsigned long seed, int population,
                             double *x)
{
    const moray_search_problem problem = {n, 2, lower, upper, true, r, waves};
    moray_search_settings settings = moray_search_settings_default();
    moray_search_info info;
    settings.method = method, settings.max_evaluations = 600, settings.constraint_tolerance = tolerance;
    settings.seed = seed, settings.population = population;
    settings.progress = listen, settings.observer = r;
    r->calls = r->told = 0;
    CHECK_OK(moray_search(&problem, &settings, x, &info), moray_search_method_name(method));
    return info;
}

static struct record records[2];

static void test_best(moray_search_method method, double least)
{
    const char *name = moray_search_method_name(method);
    struct record *r = &records[0];
    double x[n] = {1.5, 3, 2.4};
    r->least = least;
    const moray_search_info info = run(r, method, 1, 0, x);
    const int best = best_of(r, r->calls, tolerance);
    int defined = 0, first = 0;
    for (int k = 0; k < r->calls; k++)
        defined += r->defined[k];
    while (!r->defined[first])
        first++;
    CHECK(info.evaluations == r->calls && r->calls <= room, "%s: %d evaluations", name, info.evaluations);
    CHECK(memcmp(x, r->x[best], sizeof x) == 0 && info.objective == r->f[best] && info.violation == r->violation[best],
          "%s: the best of all points, %d of %d, violated by %g", name, best, r->calls, info.violation);
    CHECK(r->told == r->calls - first, "%s: told %d times of %d that there was a point to tell of", name, r->told,
          r->calls - first);
    CHECK((info.violation > tolerance) == (least > 0), "%s: %s", name, least > 0 ? "nothing is allowed" : "allowed");
}

// The first point is the start, within the bounds.
static void test_start(void)
{
    static const struct {
        double from[n], first[n];
    } cases[] = {{{-5, 0.5, 2}, {-2, 0.5, 2}}, {{0.5, -5, 1}, {0.5, -3, 1}}, {{0.25, 0.5, -5}, {0.25, 0.5, -1}},
                 {{7, 0.5, 2}, {4, 0.5, 2}},   {{1, 7, 0}, {1, 3.5, 0}},     {{-9, 9, 9}, {-2, 3.5, 3}}};
    const moray_search_method methods[] = {MORAY_SEARCH_SLSQP, MORAY_SEARCH_MMA, MORAY_SEARCH_COBYLA};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++)
        for (int i = 0; i < 3; i++) {
            double x[n];
            memcpy(x, cases[k].from, sizeof x);
            run(&records[0], methods[i], 1, 0, x);
            CHECK(memcmp(records[0].x[0], cases[k].first, sizeof x) == 0, "%s, start %zu: first (%g, %g, %g)",
                  moray_search_method_name(methods[i]), k, records[0].x[0][0], records[0].x[0][1], records[0].x[0][2]);
        }
}

// The point at which two searches part, or -1.
static int parting(void)
{
    for (int k = 0; k < records[0].calls && k < records[1].calls; k++)
        if (memcmp(records[0].x[k], records[1].x[k], sizeof records[0].x[k]) != 0)
            return k;
    return -1;
}

static void test_chance(moray_search_method method)
{
    const char *name = moray_search_method_name(method);
    double x[n] = {1, 1, 1}, y[n] = {1, 1, 1}, z[n] = {1, 1, 1}, w[n] = {1, 1, 1};
    records[0].least = records[1].least = 0;
    run(&records[0], method, 3, 0, x);
    run(&records[1], method, 3, 0, y);
    CHECK(parting() == -1, "%s: the same seed, the same points", name);
    run(&records[1], method, 3, 7, w);
    CHECK(parting() > 0, "%s: another population, others after %d", name, parting());
    if (method != MORAY_SEARCH_ISRES) // MLSL's points are not by chance
        return;
    run(&records[1], method, 4, 0, z);
    CHECK(parting() >= 0 && parting() < 3, "%s: another seed, other points", name);
}

// ---- An end by rounding ----

static bool shallow(void *self, const double *x, double *f, double *c, double *gradient, double *jacobian)
{
    (void)self, (void)c, (void)gradient, (void)jacobian;
    *f = 1e6 + (x[0] - 1) * (x[0] - 1) / 2 + x[1] * x[1] / 2;
    return true;
}

// Without tolerances COBYLA asks hundreds of times for one point, which is an end too.
static void test_repeats(void)
{
    moray_search_settings settings = moray_search_settings_default();
    moray_search_info info;
    const moray_search_problem problem = {2, 0, lower, upper, false, NULL, shallow};
    double x[] = {-1.2, 1};
    settings.method = MORAY_SEARCH_COBYLA, settings.max_evaluations = 400;
    settings.x_tolerance = settings.f_tolerance = 0;
    const double start = moray_clock();
    CHECK_OK(moray_search(&problem, &settings, x, &info), "no tolerance");
    const double seconds = moray_clock() - start;
    CHECK(info.outcome == MORAY_SEARCH_CONVERGED && info.evaluations > 20 && info.evaluations < 300,
          "%s, after %d points", moray_search_outcome_text(info.outcome), info.evaluations);
    CHECK(info.seconds > 0 && info.seconds <= seconds, "%g s of %g", info.seconds, seconds);
    CHECK(fabs(x[0] - 1) < 1e-4 && fabs(x[1]) < 1e-4, "as far as rounding lets it: (%g, %g)", x[0], x[1]);
}

// ---- Refusals, texts ----

static void refuse(const moray_search_problem *problem, const moray_search_settings *settings, const char *told)
{
    double x[n] = {0, 0, 0};
    moray_search_info info;
    const moray_status status = moray_search(problem, settings, x, &info);
    CHECK(status.code == MORAY_INPUT && strcmp(status.text, told) == 0, "refused: %s", status.text);
    CHECK(info.outcome == MORAY_SEARCH_FAILED && info.evaluations == 0, "and nothing was asked");
}

static void test_problems(void)
{
    const double above[n] = {4, MORAY_INFINITY, 3}, below[n] = {-2, -3, -MORAY_INFINITY}, turned[n] = {4, 3, -1.5};
    moray_search_settings settings = moray_search_settings_default();
    moray_search_problem problem = {n, 2, lower, turned, true, &records[0], waves};
    refuse(&problem, &settings, "bounds of x[2] = -1:-1.5: must be a range lo:hi");
    problem.upper = above, settings.method = MORAY_SEARCH_ISRES;
    refuse(&problem, &settings, "bounds of x[1] = -3:1e+20: isres needs finite ones");
    problem.upper = upper, problem.lower = below, settings.method = MORAY_SEARCH_MLSL;
    refuse(&problem, &settings, "bounds of x[2] = -1e+20:3: mlsl needs finite ones");
    problem.lower = lower, settings.method = MORAY_SEARCH_BOBYQA;
    refuse(&problem, &settings, "method = bobyqa: takes no constraints, and the problem has 2");
    problem.gradients = false, settings.method = MORAY_SEARCH_MMA;
    refuse(&problem, &settings, "method = mma: needs gradients, and the problem has none");
}

static void test_settings(void)
{
    const moray_search_settings good = {.x_tolerance = 0, .f_tolerance = 0, .max_evaluations = 1};
    const moray_search_problem problem = {n, 2, lower, upper, true, &records[0], waves};
    moray_search_settings settings = good;
    moray_search_info info;
    double x[n] = {1, 0, 0};
    records[0].calls = 0;
    CHECK_OK(moray_search(&problem, &settings, x, &info), "one evaluation and no tolerance at all");
    CHECK(info.outcome == MORAY_SEARCH_EVALUATION_LIMIT, "ends: %s", moray_search_outcome_text(info.outcome));
    const double fixed_lower[n] = {-2, 0.25, -1}, fixed_upper[n] = {1.5, 0.25, 3};
    const moray_search_problem fixed = {n, 2, fixed_lower, fixed_upper, true, &records[0], waves};
    settings.max_evaluations = 300, settings.x_tolerance = 1e-10;
    records[0].calls = 0;
    CHECK_OK(moray_search(&fixed, &settings, x, &info), "one variable fixed");
    CHECK(x[1] == 0.25 && info.evaluations > 3, "stays where it is: %g", x[1]);
    settings.x_tolerance = 1;
    refuse(&problem, &settings, "x_tolerance = 1: must lie between 0 and 1");
    settings = good, settings.f_tolerance = -0.5;
    refuse(&problem, &settings, "f_tolerance = -0.5: must lie between 0 and 1");
    settings = good, settings.constraint_tolerance = 2;
    refuse(&problem, &settings, "constraint_tolerance = 2: must lie between 0 and 1");
    settings = good, settings.max_evaluations = 0;
    refuse(&problem, &settings, "max_evaluations = 0: must be at least 1");
    settings = good, settings.population = -1;
    refuse(&problem, &settings, "max_seconds = 0, population = -1: must not be below 0");
    settings = good, settings.max_seconds = -0.5;
    refuse(&problem, &settings, "max_seconds = -0.5, population = 0: must not be below 0");
    settings = good, settings.method = (moray_search_method)7;
    refuse(&problem, &settings, "method = 7: there is no such one");
}

static void test_texts(void)
{
    static const char *const outcomes[] = {"converged", "evaluation limit", "time limit", "interrupted",
                                           "failed",    "unknown",          "unknown"};
    static const char *const names[] = {"slsqp", "mma",    "cobyla",  "bobyqa", "mlsl",
                                        "isres", "direct", "unknown", "unknown"};
    for (int k = 0; k < 7; k++)
        CHECK(strcmp(moray_search_outcome_text((moray_search_outcome)k), outcomes[k]) == 0, "%s", outcomes[k]);
    for (int k = 0; k < 9; k++)
        CHECK(strcmp(moray_search_method_name((moray_search_method)k), names[k]) == 0, "%s", names[k]);
    const moray_search_settings usual = moray_search_settings_default();
    CHECK(usual.x_tolerance == 1e-10 && usual.f_tolerance == 1e-12 && usual.constraint_tolerance == 1e-9 &&
              usual.max_evaluations == 2000 && usual.seed == 1,
          "settings by default");
}

int main(void)
{
    const moray_search_method all[] = {MORAY_SEARCH_SLSQP, MORAY_SEARCH_MMA,   MORAY_SEARCH_COBYLA,
                                       MORAY_SEARCH_MLSL,  MORAY_SEARCH_ISRES, MORAY_SEARCH_DIRECT};
    for (int k = 0; k < 6; k++) {
        test_best(all[k], 0);
        test_best(all[k], 0.4);
        test_best(all[k], -1);
    }
    test_start();
    test_chance(MORAY_SEARCH_ISRES);
    test_chance(MORAY_SEARCH_MLSL);
    test_repeats();
    test_problems();
    test_settings();
    test_texts();
    return tap_done();
}
