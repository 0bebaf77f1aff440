// SPDX-License-Identifier: MIT
//
// The tuner on functions of many optima, and what a controller with more freedom owes to its subset.
#include "moray/control/tuning.h"

#include <string.h>

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
    const moray_tuning_problem problem = {.n = 2, .number = box, .cost = ripples, .self = &calls};
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
        far = tap_worse(far, fabs(x[k] - (k == 2 ? 0 : 0.123456)));
    *cost = far < 1e-7 ? 1 : 2 + x[0] * x[0];
    return true;
}

static void test_subset(void)
{
    static const moray_tuned_number all[] = {
        {MORAY_TUNED_LINEAR, -1, 1, 0}, {MORAY_TUNED_LINEAR, -1, 1, 0}, {MORAY_TUNED_WITH_ZERO, 0, 10, 0.01}};
    const double subset[] = {0.123456, 0.123456, 0};
    const moray_tuning_problem problem = {.n = 3, .number = all, .cost = hole, .self = NULL};
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
    const moray_tuning_problem problem = {.n = 2, .number = all, .cost = plain, .self = NULL};
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

// ---- Where it looks ------------------------------------------------------------------------------------------------

enum { ROOM = 20000 };

typedef struct diary {
    int n, calls;
    double x[ROOM][MORAY_TUNED_NUMBERS];
    double least;      // of all costs so far
    int last, refused; // after so many calls it is told to end, 0: never; how often
} diary;

// A curved valley in the first two numbers, a bowl in all others.
static bool valley(void *self, const double *x, double *cost)
{
    diary *d = self;
    for (int j = 0; j < d->n && d->calls < ROOM; j++)
        d->x[d->calls][j] = x[j];
    d->calls++;
    *cost = 1;
    for (int j = 0; j < d->n; j++) {
        const double off = j == 1 ? 5 * (x[1] - x[0] * x[0]) : x[j] - 0.3;
        *cost += off * off;
    }
    d->least = d->calls == 1 ? *cost : fmin(d->least, *cost);
    return true;
}

static bool until(void *observer)
{
    diary *d = observer;
    const bool goes_on = d->last == 0 || d->calls < d->last;
    d->refused += !goes_on;
    return goes_on;
}

// g^(n + 1) = g + 1, by bisection.
static double ratio(int n)
{
    double low = 1, high = 2;
    for (int k = 0; k < 60; k++) {
        const double middle = (low + high) / 2;
        *(pow(middle, n + 1) < middle + 1 ? &low : &high) = middle;
    }
    return low;
}

static double bowl(double x)
{
    return (x - 0.3) * (x - 0.3);
}

// How many of the points looked at are no worse than those on either side of them, at most `most`; of one number.
static int count_lows(const diary *seen, double (*cost_of)(double), int first, int n, int most)
{
    int lows = 0;
    for (int k = first; k < n; k++) {
        double at = seen->x[k][0], below = -INFINITY, above = INFINITY, cost[3];
        for (int i = 0; i < n; i++) {
            below = seen->x[i][0] < at ? fmax(below, seen->x[i][0]) : below;
            above = seen->x[i][0] > at ? fmin(above, seen->x[i][0]) : above;
        }
        const double places[] = {below, at, above};
        for (int i = 0; i < 3; i++)
            cost[i] = isfinite(places[i]) ? cost_of(places[i]) : INFINITY;
        lows += cost[1] <= cost[0] && cost[1] <= cost[2];
    }
    return lows < most ? lows : most;
}

// First the points that are told, then a Kronecker sequence; in no search more calls than are allowed.
static void test_looks(int n)
{
    static diary d;
    enum { told = 2, starts = 3, of_each = 7, looks = told + 4 * starts, rounds = 8, polished = 3 };
    moray_tuned_number all[MORAY_TUNED_NUMBERS];
    double from[told * MORAY_TUNED_NUMBERS], x[MORAY_TUNED_NUMBERS], worst = 0;
    for (int j = 0; j < n; j++)
        all[j] = (moray_tuned_number){MORAY_TUNED_LINEAR, -1 - j, 2, 0};
    for (int i = 0; i < told * n; i++)
        from[i] = 0.9 - 0.17 * i / n;
    d = (diary){.n = n};
    const moray_tuning_problem problem = {.n = n, .number = all, .cost = valley, .self = &d};
    moray_tuning_settings settings = moray_tuning_settings_default();
    moray_tuning_info info;
    settings.starts = starts, settings.evaluations = of_each, settings.jobs = 1;
    CHECK_OK(moray_tune(&problem, &settings, from, told, x, &info), "tunes");
    for (int i = 0; i < looks; i++)
        for (int j = 0; j < n; j++) {
            double part;
            const double z = modf(0.5 + (i - told + 1) * pow(ratio(n), -(j + 1)), &part);
            const double want = i < told ? from[i * n + j] : all[j].lower + z * (all[j].upper - all[j].lower);
            worst = tap_worse(worst, fabs(d.x[i][j] - want));
        }
    CHECK(worst < 1e-11, "%d numbers: it looks where it should, to %.1e", n, worst);
    const int begun = n > 1 ? starts : count_lows(&d, bowl, told, looks, starts);
    CHECK(info.searches == told + begun && info.evaluations == d.calls &&
              d.calls <= looks + (told + starts + rounds * polished) * of_each * n,
          "%d calls", d.calls);
    bool inside = true;
    for (int k = 0; k < d.calls && k < ROOM; k++)
        for (int j = 0; j < n; j++)
            inside = inside && d.x[k][j] >= all[j].lower && d.x[k][j] <= all[j].upper;
    CHECK(inside, "and nowhere outside");
}

static double wavy(double x)
{
    return 2 + cos(12 * x) + 0.1 * x;
}

static bool waves(void *self, const double *x, double *cost)
{
    diary *d = self;
    if (d->calls < ROOM)
        d->x[d->calls][0] = x[0];
    d->calls++;
    *cost = wavy(x[0]);
    return true;
}

// Along one number a search begins in every valley that was seen, in as many as are allowed.
static void test_valleys(int starts)
{
    static diary d;
    static const moray_tuned_number unit = {MORAY_TUNED_LINEAR, -2, 3, 0};
    const double told = 2.9, least = -7 * M_PI / 12 - asin(0.1 / 12) / 12;
    const moray_tuning_problem problem = {.n = 1, .number = &unit, .cost = waves, .self = &d};
    moray_tuning_settings settings = moray_tuning_settings_default();
    moray_tuning_info info;
    double x;
    d = (diary){.n = 1};
    settings.starts = starts, settings.jobs = 1;
    CHECK_OK(moray_tune(&problem, &settings, &told, 1, &x, &info), "tunes");
    CHECK(info.searches == 1 + count_lows(&d, wavy, 1, 1 + 4 * starts, starts), "%d searches", info.searches);
    CHECK(starts < 12 || fabs(x - least) < 1e-3, "the least is at %g: %g", least, x);
}

static void test_precise(int n)
{
    static diary d;
    moray_tuned_number all[MORAY_TUNED_NUMBERS];
    double x[MORAY_TUNED_NUMBERS], worst = 0;
    for (int j = 0; j < n; j++)
        all[j] = (moray_tuned_number){MORAY_TUNED_LINEAR, -1, 2, 0};
    d = (diary){.n = n};
    const moray_tuning_problem problem = {.n = n, .number = all, .cost = valley, .self = &d};
    moray_tuning_settings settings = moray_tuning_settings_default();
    moray_tuning_info info;
    settings.jobs = 1;
    CHECK_OK(moray_tune(&problem, &settings, NULL, 0, x, &info), "tunes");
    for (int j = 0; j < n; j++)
        worst = tap_worse(worst, fabs(x[j] - (j == 1 ? 0.09 : 0.3)));
    CHECK(info.cost - 1 < 1e-4 && worst < 1e-2, "%d numbers: least to %.1e, where it is to %.1e", n, info.cost - 1,
          worst);
    const int calls = d.calls;
    CHECK(calls < ROOM, "%d calls", calls);
    const int ends[] = {1, 20, 60, calls / 2, calls - 1};
    settings.go_on = until;
    settings.observer = &d;
    for (int k = 0; k < 5; k++) {
        d = (diary){.n = n, .last = ends[k]};
        CHECK(moray_tune(&problem, &settings, NULL, 0, x, &info).code == MORAY_INTERRUPTED && d.calls == ends[k] &&
                  info.evaluations == d.calls,
              "told to end after %d of %d calls", ends[k], calls);
    }
}

// Whenever it is told to end, the best so far is what it has found; told so once, a search asks no more.
static void test_ended(void)
{
    static diary d;
    const moray_tuned_number all[] = {{MORAY_TUNED_LINEAR, -1, 2, 0}, {MORAY_TUNED_LINEAR, -1, 2, 0}};
    const moray_tuning_problem problem = {.n = 2, .number = all, .cost = valley, .self = &d};
    moray_tuning_settings settings = moray_tuning_settings_default();
    moray_tuning_info info;
    double x[2];
    settings.starts = 3, settings.evaluations = 5, settings.jobs = 1;
    settings.go_on = until;
    settings.observer = &d;
    for (int remembers = 0; remembers < 2; remembers++) {
        settings.remembers = remembers;
        d = (diary){.n = 2};
        CHECK_OK(moray_tune(&problem, &settings, NULL, 0, x, &info), "tunes");
        const int calls = d.calls;
        int wrong = 0;
        for (int last = 1; last < calls; last++) {
            d = (diary){.n = 2, .last = last};
            wrong += moray_tune(&problem, &settings, NULL, 0, x, &info).code != MORAY_INTERRUPTED;
            const double least = d.least;
            double cost;
            d.last = 0;
            valley(&d, x, &cost);
            wrong += info.cost != least || cost != least;
        }
        CHECK(wrong == 0 && calls > 100, "of %d calls: the best so far, but for %d", calls, wrong);
        CHECK(d.refused == 1, "told so at its last call it asks once: %d", d.refused);
    }
}

static void test_ranges(void)
{
    static diary d;
    const moray_tuned_number good = {MORAY_TUNED_LINEAR, 0, 1, 0};
    const struct {
        moray_tuned_number number;
        bool sound;
    } cases[] = {{{MORAY_TUNED_LINEAR, 1, 1, 0}, false},      {{MORAY_TUNED_LINEAR, 2, 1, 0}, false},
                 {{MORAY_TUNED_LOGARITHMIC, 0, 1, 0}, false}, {{MORAY_TUNED_LOGARITHMIC, 0.1, 1, 0}, true},
                 {{MORAY_TUNED_WITH_ZERO, 0, 1, 0}, false},   {{MORAY_TUNED_WITH_ZERO, -1, 1, 0.1}, true},
                 {{MORAY_TUNED_LINEAR, NAN, 1, 0}, false}};
    moray_tuning_settings settings = moray_tuning_settings_default();
    moray_tuning_info info;
    double x[MORAY_TUNED_NUMBERS + 1];
    settings.starts = settings.evaluations = settings.jobs = 1;
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        const moray_tuned_number both[] = {good, cases[k].number};
        const moray_tuning_problem problem = {.n = 2, .number = both, .cost = valley, .self = &d};
        d = (diary){.n = 2};
        const moray_status status = moray_tune(&problem, &settings, NULL, 0, x, &info);
        CHECK(cases[k].sound ? !moray_failed(status)
                             : status.code == MORAY_INPUT && strstr(status.text, "number 2 to tune"),
              "%s", status.text);
    }
    moray_tuned_number many[MORAY_TUNED_NUMBERS + 1];
    for (int n = 0; n <= MORAY_TUNED_NUMBERS + 1; n++) {
        if (n > 0)
            many[n - 1] = good;
        const moray_tuning_problem problem = {.n = n, .number = many, .cost = valley, .self = &d};
        d = (diary){.n = n};
        const moray_status status =
            n <= 1 || n >= MORAY_TUNED_NUMBERS ? moray_tune(&problem, &settings, NULL, 0, x, &info) : moray_ok();
        CHECK((status.code == MORAY_INPUT) == (n < 1 || n > MORAY_TUNED_NUMBERS), "%d numbers: %s", n, status.text);
    }
}

// ---- What it remembers ----------------------------------------------------------------------------------------------

static int repeated(const diary *d)
{
    int again = 0;
    for (int k = 0; k < d->calls; k++)
        for (int i = 0; i < k; i++)
            again += memcmp(d->x[i], d->x[k], (size_t)d->n * sizeof **d->x) == 0;
    return again;
}

static void test_remembers(int n)
{
    static diary d;
    moray_tuned_number all[MORAY_TUNED_NUMBERS];
    double x[3][MORAY_TUNED_NUMBERS];
    moray_tuning_info info[3];
    for (int j = 0; j < n; j++)
        all[j] = (moray_tuned_number){MORAY_TUNED_LINEAR, -1, 2, 0};
    const moray_tuning_problem problem = {.n = n, .number = all, .cost = valley, .self = &d};
    moray_tuning_settings settings = moray_tuning_settings_default();
    for (int k = 0; k < 3; k++) { // without, with, and with by two processes
        d = (diary){.n = n};
        settings.remembers = k > 0;
        settings.jobs = k < 2 ? 1 : 2;
        CHECK_OK(moray_tune(&problem, &settings, NULL, 0, x[k], &info[k]), "tunes");
        CHECK(k == 2 || d.calls == info[k].evaluations, "%d numbers: %d calls", n, d.calls);
        CHECK(k == 2 || (repeated(&d) == 0) == settings.remembers, "%d of them of a point tried before", repeated(&d));
        CHECK(info[k].cost == info[0].cost && memcmp(x[k], x[0], (size_t)n * sizeof **x) == 0, "to the same");
    }
    CHECK(info[1].evaluations < info[0].evaluations && info[2].evaluations == info[1].evaluations, "in fewer calls");
}

// Down to a corner, into which one search steps again and again.
static bool to_corner(void *self, const double *x, double *cost)
{
    diary *d = self;
    for (int j = 0; j < d->n && d->calls < ROOM; j++)
        d->x[d->calls][j] = x[j];
    d->calls++;
    *cost = 10 - x[0] - 2 * x[1] - 0.1 * x[0] * x[1];
    return true;
}

static void test_corner(void)
{
    static diary d;
    const moray_tuned_number all[] = {{MORAY_TUNED_LINEAR, 0, 1, 0}, {MORAY_TUNED_LINEAR, 0, 1, 0}};
    const moray_tuning_problem problem = {.n = 2, .number = all, .cost = to_corner, .self = &d};
    moray_tuning_settings settings = moray_tuning_settings_default();
    moray_tuning_info info[2];
    double x[2][2];
    settings.jobs = 1;
    for (int k = 0; k < 2; k++) {
        d = (diary){.n = 2};
        settings.remembers = k;
        CHECK_OK(moray_tune(&problem, &settings, NULL, 0, x[k], &info[k]), "tunes");
    }
    CHECK(info[1].evaluations < info[0].evaluations, "%d and %d calls", info[0].evaluations, info[1].evaluations);
    CHECK(info[1].cost == info[0].cost && memcmp(x[0], x[1], sizeof x[0]) == 0, "to the same: %g, %g", info[0].cost,
          info[1].cost);
}

// ---- What is refused -----------------------------------------------------------------------------------------------

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
    moray_tuning_problem problem = {.n = 2, .number = box, .cost = nowhere, .self = NULL};
    settings.jobs = 1;
    CHECK(moray_tune(&problem, &settings, NULL, 0, x, &info).code == MORAY_NUMERIC, "no cost anywhere is told");
    settings.go_on = enough;
    settings.observer = &asked;
    CHECK(moray_tune(&problem, &settings, NULL, 0, x, &info).code == MORAY_INTERRUPTED, "an end called is told");
    CHECK(info.evaluations < 10, "and comes at once: %d", info.evaluations);
    const moray_tuned_number wrong[] = {{MORAY_TUNED_LOGARITHMIC, 0, 1, 0}};
    problem = (moray_tuning_problem){.n = 1, .number = wrong, .cost = nowhere, .self = NULL};
    CHECK(moray_tune(&problem, &settings, NULL, 0, x, &info).code == MORAY_INPUT, "no logarithm of zero");
}

int main(void)
{
    test_many_optima();
    test_subset();
    test_no_better();
    for (int n = 1; n <= 3; n++)
        test_looks(n);
    test_valleys(2);
    test_valleys(3);
    test_valleys(12);
    test_precise(1);
    test_precise(3);
    test_ended();
    test_ranges();
    test_remembers(1);
    test_remembers(3);
    test_corner();
    test_refusals();
    return tap_done();
}
