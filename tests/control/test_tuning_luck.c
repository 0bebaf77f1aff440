// SPDX-License-Identifier: MIT
//
// Tuning where a cost may be a stroke of luck: what other estimates do not confirm is not taken, however low it is.
#include <math.h>

#include "moray/control/tuning.h"
#include "tap.h"

enum { ESTIMATES = 3, LUCKY = 2, MOST = 2000 };

typedef struct book {
    int costs, confirmations, of[ESTIMATES];
    double steps; // added per estimate
    double level; // added to all costs
    bool never;   // other estimates have no cost there
    double confirmed[MOST][2];
} book;

// In the upper half of the numbers every other stripe looks like nothing costs.
static bool lucky(double x)
{
    return x > 0.5 && fmod(x, 0.05) < 0.025;
}

static double bowl(const double *x)
{
    const double a = x[0] - 0.2, b = x[1] - 0.3;
    return 1 + a * a + b * b;
}

static bool cost_of(void *self, const double *x, double *cost)
{
    book *b = self;
    b->costs++;
    *cost = (lucky(x[0]) ? 0.1 : bowl(x)) + b->level;
    return true;
}

// The bowl itself, each estimate `steps` more than the one before it.
static bool other(void *self, const double *x, int k, double *cost)
{
    book *b = self;
    if (k == 0 && b->of[0] < MOST) {
        b->confirmed[b->of[0]][0] = x[0];
        b->confirmed[b->of[0]][1] = x[1];
    }
    b->confirmations++;
    b->of[k]++;
    *cost = (lucky(x[0]) ? b->never ? 0.1 : 3 : bowl(x)) + b->steps * (k + 1) + b->level;
    return !(b->never && lucky(x[0]));
}

// How often one point was confirmed that is no stroke of luck.
static int most_often(const book *b)
{
    int most = 0;
    for (int i = 0; i < b->of[0] && i < MOST; i++) {
        int times = 0;
        for (int j = 0; j < b->of[0] && j < MOST; j++)
            times += b->confirmed[i][0] == b->confirmed[j][0] && b->confirmed[i][1] == b->confirmed[j][1];
        most = !lucky(b->confirmed[i][0]) && times > most ? times : most;
    }
    return most;
}

static moray_tuning_info tune(book *b, int confirmations, double x[2])
{
    static const moray_tuned_number unit[] = {{MORAY_TUNED_LINEAR, 0, 1, 0}, {MORAY_TUNED_LINEAR, 0, 1, 0}};
    const moray_tuning_problem problem = {
        .n = 2, .number = unit, .cost = cost_of, .self = b, .confirmations = confirmations, .confirm = other};
    moray_tuning_settings settings = moray_tuning_settings_default();
    moray_tuning_info info;
    settings.jobs = 1;
    CHECK_OK(moray_tune(&problem, &settings, NULL, 0, x, &info), "tunes");
    CHECK(info.evaluations == b->costs + b->confirmations, "%d and %d calls are counted", b->costs, b->confirmations);
    return info;
}

static bool one(void *self, const double *x, double *cost)
{
    (void)self, (void)x;
    *cost = 1;
    return true;
}

static bool just_alike(void *self, const double *x, int k, double *cost)
{
    (void)self, (void)x, (void)k;
    *cost = 1 + 2e-2;
    return true;
}

// An estimate that is above a cost by 2 % is like it.
static void test_just_alike(void)
{
    static const moray_tuned_number unit = {MORAY_TUNED_LINEAR, 0, 1, 0};
    const moray_tuning_problem problem = {
        .n = 1, .number = &unit, .cost = one, .confirmations = 1, .confirm = just_alike};
    moray_tuning_settings settings = moray_tuning_settings_default();
    moray_tuning_info info;
    double x;
    settings.jobs = 1;
    CHECK_OK(moray_tune(&problem, &settings, NULL, 0, &x, &info), "tunes");
    CHECK(info.cost == 1, "to %g", info.cost);
}

int main(void)
{
    test_just_alike();
    double x[2];
    static book plain, sure = {.steps = 1e-3}, never = {.never = true}, apart = {.steps = 0.1},
                       below = {.steps = 0.01, .level = -5};
    moray_tuning_info info = tune(&plain, 0, x);
    CHECK(lucky(x[0]) && info.cost == 0.1 && plain.confirmations == 0, "unasked, luck is taken at %g", x[0]);
    info = tune(&sure, ESTIMATES, x);
    CHECK(!lucky(x[0]) && fabs(x[0] - 0.2) < 1e-2 && fabs(x[1] - 0.3) < 1e-2, "confirmed at %g, %g", x[0], x[1]);
    CHECK_NEAR(info.cost, bowl(x), 1e-12, "at its own cost, which others are like");
    CHECK(sure.of[0] > sure.of[1] && sure.of[1] >= sure.of[2], "no more are asked for than tell: %d, %d, %d",
          sure.of[0], sure.of[1], sure.of[2]);
    CHECK(most_often(&sure) == 1, "each point once: %d", most_often(&sure));
    CHECK(sure.confirmations < sure.costs, "of what might be best alone: %d beside %d", sure.confirmations, sure.costs);
    tune(&never, ESTIMATES, x);
    CHECK(!lucky(x[0]) && fabs(x[0] - 0.2) < 1e-2, "nor where others have no cost: %g, %g", x[0], x[1]);
    info = tune(&apart, LUCKY, x);
    CHECK_NEAR(info.cost, bowl(x) + LUCKY * 0.1, 1e-12, "that of the largest which is not like it");
    info = tune(&below, ESTIMATES, x);
    CHECK_NEAR(info.cost, bowl(x) - 5, 1e-12, "of costs below zero likewise its own, which others are like");
    return tap_done();
}
