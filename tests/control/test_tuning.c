// SPDX-License-Identifier: MIT
//
// The tuner on functions of many optima, and what a controller with more freedom owes to its subset.
#include "moray/control/tuning.h"

#include "tap.h"

// Ripples on a bowl, each a trap for a single start; the least is 0 at x[0] = 0.03, x[1] = 2.
static bool ripples(void *self, const double *x, double *cost)
{
    const double a = log(x[0] / 0.03), b = x[1] - 2;
    ++*(int *)self;
    *cost = a * a + b * b + 1.5 * (1 - cos(4 * a)) + 1.5 * (1 - cos(5 * b));
    return true;
}

static const moray_tuned_number box[] = {{MORAY_TUNED_LOGARITHMIC, 1e-3, 10, 0}, {MORAY_TUNED_LINEAR, -4, 6, 0}};

static void test_many_optima(void)
{
    int calls = 0;
    double x[2];
    moray_tuning_info info;
    moray_tuning_settings settings = moray_tuning_settings_default();
    const moray_tuning_problem problem = {2, box, ripples, &calls};
    settings.jobs = 1;
    CHECK_OK(moray_tune(&problem, &settings, NULL, 0, x, &info), "tunes");
    CHECK_NEAR(info.cost, 0, 1e-2, "the least of all optima");
    CHECK_NEAR(x[0], 0.03, 1e-3, "where it is");
    CHECK_NEAR(x[1], 2, 2e-2, "where it is");
    CHECK(info.evaluations == calls, "every call is counted: %d", calls);
    double again[2];
    moray_tuning_info parallel;
    settings.jobs = 2;
    CHECK_OK(moray_tune(&problem, &settings, NULL, 0, again, &parallel), "tunes by two processes");
    CHECK(again[0] == x[0] && again[1] == x[1] && parallel.evaluations == info.evaluations, "to the same");
}

// A narrow hole that no spread of points finds: whoever is told of it keeps it.
static bool hole(void *self, const double *x, double *cost)
{
    (void)self;
    double far = 0;
    for (int k = 0; k < 3; k++)
        far = fmax(far, fabs(x[k] - (k == 2 ? 0 : 0.123456)));
    *cost = far < 1e-7 ? 1 : 2 + x[0] * x[0];
    return true;
}

static void test_subset(void)
{
    static const moray_tuned_number all[] = {
        {MORAY_TUNED_LINEAR, -1, 1, 0}, {MORAY_TUNED_LINEAR, -1, 1, 0}, {MORAY_TUNED_WITH_ZERO, 0, 10, 0.01}};
    const double subset[] = {0.123456, 0.123456, 0};
    const moray_tuning_problem problem = {3, all, hole, NULL};
    const moray_tuning_settings settings = moray_tuning_settings_default();
    moray_tuning_info info;
    double x[3];
    CHECK_OK(moray_tune(&problem, &settings, NULL, 0, x, &info), "tunes");
    CHECK(info.cost > 1, "which the search by itself misses: %g", info.cost);
    CHECK_OK(moray_tune(&problem, &settings, subset, 1, x, &info), "tunes from the subset's optimum");
    CHECK(info.cost == 1, "and is no worse than it: %g", info.cost);
}

// A plain that ends at a slope, down which a search from elsewhere runs, to no less than the plain: on the plain
// nothing is better than the point that is told, which therefore stays.
static bool plain(void *self, const double *x, double *cost)
{
    (void)self;
    *cost = x[0] < -0.2 ? 1 : 2 - 0.1 * x[0] + 0.01 * x[1] * x[1];
    return true;
}

static void test_no_better(void)
{
    static const moray_tuned_number all[] = {{MORAY_TUNED_LINEAR, -1, 1, 0}, {MORAY_TUNED_LINEAR, -1, 1, 0}};
    static const double told[][2] = {{-0.7, 0.3}, {-1 + 1e-6, 0.3}, {-0.7, 1 - 1e-6}, {-1, -1}};
    const moray_tuning_problem problem = {2, all, plain, NULL};
    moray_tuning_settings settings = moray_tuning_settings_default();
    settings.starts = 1;
    settings.jobs = 1;
    for (int k = 0; k < 4; k++) {
        moray_tuning_info info;
        double x[2];
        CHECK_OK(moray_tune(&problem, &settings, told[k], 1, x, &info), "tunes");
        CHECK(info.cost == 1 && fabs(x[0] - told[k][0]) < 1e-12 && fabs(x[1] - told[k][1]) < 1e-12,
              "no better than %g, %g: %.9g, %.9g", told[k][0], told[k][1], x[0], x[1]);
    }
}

static bool nowhere(void *self, const double *x, double *cost)
{
    (void)self, (void)x;
    *cost = 0;
    return false;
}

static bool enough(void *observer)
{
    return ++*(int *)observer < 10;
}

static void test_refusals(void)
{
    int asked = 0;
    double x[2];
    moray_tuning_info info;
    moray_tuning_settings settings = moray_tuning_settings_default();
    moray_tuning_problem problem = {2, box, nowhere, NULL};
    settings.jobs = 1;
    CHECK(moray_tune(&problem, &settings, NULL, 0, x, &info).code == MORAY_NUMERIC, "no cost anywhere is told");
    settings.go_on = enough;
    settings.observer = &asked;
    CHECK(moray_tune(&problem, &settings, NULL, 0, x, &info).code == MORAY_INTERRUPTED, "an end called is told");
    CHECK(info.evaluations < 10, "and comes at once: %d", info.evaluations);
    const moray_tuned_number wrong[] = {{MORAY_TUNED_LOGARITHMIC, 0, 1, 0}};
    problem = (moray_tuning_problem){1, wrong, nowhere, NULL};
    CHECK(moray_tune(&problem, &settings, NULL, 0, x, &info).code == MORAY_INPUT, "no logarithm of zero");
}

int main(void)
{
    test_many_optima();
    test_subset();
    test_no_better();
    test_refusals();
    return tap_done();
}
