// SPDX-License-Identifier: MIT
//
// The course of a tuning, read off from its calls: how often the best places are searched again, how far around them
// and by which model. A place is as good as a script says at each visit, and nothing else is any good.
#include "moray/control/tuning.h"

#include "tap.h"

#include <string.h>

enum { TOLD = 4, POLISHED = 3, STARTS = 1, SEARCHES = TOLD + STARTS, LOOKS = TOLD + 4 * STARTS, OF_EACH = 3, N = 2 };
enum { ROUNDS = 8, CALLS = OF_EACH * N, MOST = LOOKS + CALLS * (SEARCHES + ROUNDS * POLISHED) };

static const double told[TOLD][N] = {{0.3, 0.4}, {0.6, 0.7}, {0.45, 0.55}, {0.7, 0.25}};

typedef struct script {
    double level[TOLD];  // of the places told, at first
    double gain[ROUNDS]; // of each round, of all levels' first
    int visits[TOLD], calls;
    bool falls; // what costs else, with the numbers
    double x[MOST][N];
} script;

static bool scripted(void *self, const double *x, double *cost)
{
    script *s = self;
    for (int j = 0; j < N && s->calls < MOST; j++)
        s->x[s->calls][j] = x[j];
    s->calls++;
    *cost = 100 + (s->falls ? -1 : 1) * (x[0] + x[1]);
    for (int i = 0; i < TOLD; i++)
        if (x[0] == told[i][0] && x[1] == told[i][1]) {
            *cost = s->level[i];
            for (int round = 0; round < ROUNDS && round < s->visits[i] - 1; round++)
                *cost -= s->gain[round] * fabs(s->level[0]);
            s->visits[i]++;
        }
    return true;
}

static moray_tuning_info tune(script *s)
{
    static const moray_tuned_number unit[N] = {{MORAY_TUNED_LINEAR, 0, 1, 0}, {MORAY_TUNED_LINEAR, 0, 1, 0}};
    const moray_tuning_problem problem = {.n = N, .number = unit, .cost = scripted, .self = s};
    moray_tuning_settings settings = moray_tuning_settings_default();
    moray_tuning_info info;
    double x[N];
    settings.starts = STARTS, settings.evaluations = OF_EACH, settings.jobs = 1;
    settings.remembers = false; // as good as a script says at each visit
    CHECK_OK(moray_tune(&problem, &settings, told[0], TOLD, x, &info), "tunes");
    CHECK(x[0] == told[0][0] && x[1] == told[0][1], "to the best place: %g, %g", x[0], x[1]);
    return info;
}

// The best of the points looked at starts a search beside the places told.
static void test_start(void)
{
    script s = {.level = {20, 21, 22, 23}, .falls = true};
    tune(&s);
    int best = TOLD;
    for (int k = TOLD; k < LOOKS; k++)
        best = s.x[k][0] + s.x[k][1] > s.x[best][0] + s.x[best][1] ? k : best;
    CHECK(best != TOLD, "which is not the first: %d", best - TOLD);
    bool again = false;
    for (int k = LOOKS; k < s.calls && k < MOST; k++)
        again = again || s.x[k][0] == s.x[best][0]; // the other number is near a bound
    CHECK(again, "from %g, the best", s.x[best][0]);
}

// In pairs, the second for certain, each further one where that before it gained more than 0.5 % of the cost.
static void test_rounds(void)
{
    const struct {
        const char *name;
        double level, gain[ROUNDS];
        int rounds;
    } cases[] = {
        {"no gain", 20, {0}, 4},
        {"small gains", 20, {2e-3, 2e-3, 2e-3, 2e-3, 2e-3, 2e-3, 2e-3, 2e-3}, 4},
        {"gains that count together", 20, {0, 0, 3e-3, 3e-3, 3e-3, 3e-3, 3e-3, 3e-3}, 8},
        {"a gain in the first of two rounds", 20, {0, 0, 6e-3}, 6},
        {"a gain in the second of two rounds", 20, {0, 0, 0, 6e-3}, 6},
        {"a gain of the first pair", 20, {6e-3, 6e-3}, 4},
        {"small gains of a cost below zero", -20, {2e-3, 2e-3, 2e-3, 2e-3, 2e-3, 2e-3, 2e-3, 2e-3}, 4},
        {"gains of a cost below zero", -20, {0, 0, 3e-3, 3e-3, 3e-3, 3e-3}, 8},
        {"a gain of a cost below zero", -20, {0, 0, 6e-3}, 6},
        {"no gain of a cost of zero", 0, {0}, 4},
        {"a gain that counts beside the best place alone", 20, {0, 0, 5.1e-3}, 6},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        script s = {.level = {cases[k].level, cases[k].level + 1, cases[k].level + 2, cases[k].level + 3}};
        for (int round = 0; round < ROUNDS; round++)
            s.gain[round] = cases[k].gain[round];
        const moray_tuning_info info = tune(&s);
        const int rounds = s.visits[0] - 2;
        CHECK(rounds == cases[k].rounds, "%s: %d rounds", cases[k].name, rounds);
        CHECK(s.visits[1] == s.visits[0] && s.visits[2] == s.visits[0] && s.visits[3] == 2, "of the best three");
        CHECK(info.evaluations == s.calls && s.calls == LOOKS + CALLS * (SEARCHES + rounds * POLISHED), "%d calls",
              s.calls);
    }
}

static void test_agree(void)
{
    static const double levels[][TOLD] = {
        {20, 20.9, 21, 21.1}, {20, 21.1, 22, 23}, {-20, -19.1, -19, -18.9}, {-20, -18.9, 0, 1}};
    for (size_t k = 0; k < sizeof levels / sizeof *levels; k++) {
        script s = {.gain = {0}};
        int close = 0;
        for (int i = 0; i < TOLD; i++) {
            s.level[i] = levels[k][i];
            close += 20 * (s.level[i] - levels[k][0]) <= fabs(levels[k][0]);
        }
        const moray_tuning_info info = tune(&s);
        CHECK(info.agree == close, "%d of %d within 5 %%: %d", close, TOLD, info.agree);
        CHECK(info.searches == SEARCHES, "%d searches", info.searches);
    }
}

// Where all points are as good only those that were searched from count, and sizes of nothing are none.
static void test_all_agree(void)
{
    script s = {.level = {100, 100.5, 101, 101.5}};
    const moray_tuning_info info = tune(&s);
    CHECK(info.agree == SEARCHES && info.searches == SEARCHES, "%d of %d agree", info.agree, info.searches);
    static const moray_tuned_number unit[N] = {{MORAY_TUNED_LINEAR, 0, 1, 0}, {MORAY_TUNED_LINEAR, 0, 1, 0}};
    const moray_tuning_problem problem = {.n = N, .number = unit, .cost = scripted, .self = &s};
    for (int k = 0; k < 2; k++) {
        moray_tuning_settings settings = moray_tuning_settings_default();
        moray_tuning_info none;
        char says[100];
        double x[N];
        settings.starts = k;
        settings.evaluations = 1 - k;
        snprintf(says, sizeof says, "starts = %d, evaluations = %d: must be at least 1", k, 1 - k);
        const moray_status status = moray_tune(&problem, &settings, told[0], TOLD, x, &none);
        CHECK(status.code == MORAY_INPUT && strcmp(status.text, says) == 0, "%s", status.text);
    }
}

// Of the points of a search, how many of the first that follow its place lie beside that along one number alone.
static int on_cross(double (*x)[N], double *farthest)
{
    int along = 0;
    bool still = true;
    *farthest = 0;
    for (int k = 1; k < CALLS; k++) {
        const double one = fabs(x[k][0] - x[0][0]), other = fabs(x[k][1] - x[0][1]);
        still = still && fmin(one, other) < 1e-12;
        along += still;
        *farthest = fmax(*farthest, fmax(one, other));
    }
    return along;
}

// A model that is linear has N + 1 points; one that is quadratic along each number 2 N + 1, which lie on a cross.
static void test_models(void)
{
    script s = {.level = {20, 21, 22, 23}, .gain = {0, 0, 6e-3, 0, 6e-3, 0, 6e-3, 0}};
    double farthest;
    tune(&s);
    for (int k = 0; k < SEARCHES; k++)
        CHECK(on_cross(s.x + LOOKS + k * CALLS, &farthest) == N, "search %d: a linear model", k);
    for (int round = 0; round < ROUNDS; round++)
        for (int k = 0; k < POLISHED; k++) {
            double(*x)[N] = s.x + LOOKS + (SEARCHES + round * POLISHED + k) * CALLS;
            const double reach = round < 4 ? 0.15 : 0.04;
            const int along = on_cross(x, &farthest);
            CHECK(x[0][0] == told[k][0] && x[0][1] == told[k][1], "round %d begins at place %d", round, k);
            CHECK(round % 2 == 0 ? along >= 2 * N : along == N, "with %d points along one number", along);
            CHECK(farthest <= reach + 1e-12 && farthest > reach / 4, "as far as %g", farthest);
        }
}

// ---- Down a slope --------------------------------------------------------------------------------------------------

// Three places are told, the first the farthest down, which are best until all three have been searched; then the cost
// falls along both axes.
typedef struct slope {
    double start[POLISHED * N], along[N];
    int visits;
} slope;

static bool sloping(void *self, const double *x, double *cost)
{
    slope *s = self;
    bool at_start = false;
    for (int i = 0; i < POLISHED; i++)
        at_start = at_start || (x[0] == s->start[i * N] && x[1] == s->start[i * N + 1]);
    s->visits += at_start;
    *cost = at_start ? 20 : 100;
    if (s->visits > 2 * POLISHED)
        *cost = 20 - 10 * (s->along[0] * (x[0] - s->start[0]) + s->along[1] * (x[1] - s->start[1]));
    return true;
}

// Each round goes to the edge of what it may search: four times 0.15 of a scale, then four times 0.04.
static void test_walk(void)
{
    static const double directions[][N] = {{1, 1}, {-1, -1}, {1, -1}, {-1, 1}};
    static const moray_tuned_number unit[N] = {{MORAY_TUNED_LINEAR, 0, 1, 0}, {MORAY_TUNED_LINEAR, 0, 1, 0}};
    for (int k = 0; k < 4; k++) {
        slope s = {.along = {directions[k][0], directions[k][1]}};
        double x[N];
        for (int i = 0; i < POLISHED * N; i++)
            s.start[i] = (s.along[i % N] > 0 ? 0.125 : 0.875) - 0.02 * (i / N) * s.along[i % N];
        const moray_tuning_problem problem = {.n = N, .number = unit, .cost = sloping, .self = &s};
        moray_tuning_settings settings = moray_tuning_settings_default();
        moray_tuning_info info;
        settings.starts = settings.jobs = 1;
        settings.remembers = false;
        CHECK_OK(moray_tune(&problem, &settings, s.start, POLISHED, x, &info), "tunes");
        for (int j = 0; j < N; j++)
            CHECK_NEAR(fabs(x[j] - s.start[j]), 4 * (0.15 + 0.04), 2e-3, "the way of eight rounds");
    }
}

// ---- Ends that are one ----------------------------------------------------------------------------------------------

typedef struct pair {
    double at[2][N], level[2];
    int visits[2];
} pair;

static bool of_pair(void *self, const double *x, double *cost)
{
    pair *p = self;
    *cost = 100;
    for (int i = 0; i < 2; i++)
        if (x[0] == p->at[i][0] && x[1] == p->at[i][1]) {
            *cost = p->level[i];
            p->visits[i]++;
        }
    return true;
}

// Of places within 0.01 of each other on all scales and within 0.1 % in cost only the best is searched again.
static void test_one_end(void)
{
    const struct {
        double apart[N], level;
        bool one;
    } cases[] = {{{9e-3, 0}, 1, true},          {{0, 9e-3}, 1, true},    {{-9e-3, 9e-3}, 1.0009, true},
                 {{9e-3, 9e-3}, 1.0011, false}, {{1.1e-2, 0}, 1, false}, {{0, -1.1e-2}, 1, false},
                 {{9e-3, 1.1e-2}, 1, false}};
    static const moray_tuned_number unit[N] = {{MORAY_TUNED_LINEAR, 0, 1, 0}, {MORAY_TUNED_LINEAR, 0, 1, 0}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++)
        for (int sign = -1; sign <= 1; sign += 2) {
            const double level = sign > 0 ? cases[k].level : 2 - cases[k].level; // the second place is not the better
            pair p = {.at = {{0.5, 0.25}, {0.5 + cases[k].apart[0], 0.25 + cases[k].apart[1]}},
                      .level = {20 * sign, 20 * sign * level}};
            const moray_tuning_problem problem = {.n = N, .number = unit, .cost = of_pair, .self = &p};
            moray_tuning_settings settings = moray_tuning_settings_default();
            moray_tuning_info info;
            double x[N];
            settings.starts = settings.jobs = 1;
            settings.remembers = false;
            CHECK_OK(moray_tune(&problem, &settings, p.at[0], 2, x, &info), "tunes");
            CHECK(p.visits[0] == 6 && p.visits[1] == (cases[k].one ? 2 : 6), "%g, %g apart, costs %g: visits %d and %d",
                  cases[k].apart[0], cases[k].apart[1], level, p.visits[0], p.visits[1]);
        }
}

// ---- A valley ------------------------------------------------------------------------------------------------------

static bool valley(void *self, const double *x, double *cost)
{
    ++*(int *)self;
    *cost = 3 + pow(x[0] - 0.2, 2) + 0.5 * fabs(x[1] - 0.9 * x[0]) + 0.1 * cos(9 * x[1]);
    return true;
}

// What is remembered costs nothing and changes nothing; a coarse tolerance costs less.
static void test_remembers(void)
{
    static const moray_tuned_number unit[N] = {{MORAY_TUNED_LINEAR, 0, 1, 0}, {MORAY_TUNED_LINEAR, 0, 1, 0}};
    int calls[3] = {0};
    double x[3][N];
    moray_tuning_info info[3];
    for (int k = 0; k < 3; k++) {
        const moray_tuning_problem problem = {.n = N, .number = unit, .cost = valley, .self = &calls[k]};
        moray_tuning_settings settings = moray_tuning_settings_default();
        settings.starts = 3;
        settings.jobs = 1;
        settings.remembers = k != 1;
        settings.tolerance = k == 2 ? 0.1 : 1e-12;
        CHECK_OK(moray_tune(&problem, &settings, NULL, 0, x[k], &info[k]), "tunes");
        CHECK(info[k].evaluations == calls[k], "%d calls", calls[k]);
    }
    CHECK(memcmp(x[0], x[1], sizeof x[0]) == 0 && info[0].cost == info[1].cost, "to the same to the last bit");
    CHECK(calls[0] < calls[1], "in %d calls instead of %d", calls[0], calls[1]);
    CHECK(calls[2] < calls[0], "coarsely in %d", calls[2]);
}

// How often the one place of no cost is visited.
static bool ramp(void *self, const double *x, double *cost)
{
    *(int *)self += x[0] == 0.5;
    *cost = fabs(x[0] - 0.5);
    return true;
}

// One number is searched by the same model in every round, beginning where the best place is.
static void test_one(void)
{
    static const moray_tuned_number unit = {MORAY_TUNED_LINEAR, 0, 1, 0};
    const double from = 0.5;
    int visits = 0;
    const moray_tuning_problem problem = {.n = 1, .number = &unit, .cost = ramp, .self = &visits};
    moray_tuning_settings settings = moray_tuning_settings_default();
    moray_tuning_info info;
    double x;
    settings.starts = settings.jobs = 1;
    settings.remembers = false;
    CHECK_OK(moray_tune(&problem, &settings, &from, 1, &x, &info), "tunes");
    CHECK(x == 0.5 && info.cost == 0, "to %g", x);
    CHECK(visits >= 6, "looked at, searched from, and in four rounds: %d", visits);
}

int main(void)
{
    test_one();
    test_remembers();
    test_walk();
    test_one_end();
    test_start();
    test_rounds();
    test_agree();
    test_all_agree();
    test_models();
    return tap_done();
}
