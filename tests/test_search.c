// SPDX-License-Identifier: MIT
#include "tap.h"

#include "moray/search.h"

typedef struct {
    double centre[2];
    int calls, give_up_at, fail_at;
} valley;

// A bent valley with its floor at the centre, value 3 there.
static bool value_of(const double *x, double *value, void *self)
{
    valley *v = self;
    const double a = x[0] - v->centre[0], b = x[1] - v->centre[1] - 0.3 * a * a;
    *value = 3 + a * a + 0.5 * a * b + 2 * b * b;
    if (++v->calls == v->fail_at)
        *value = NAN;
    return v->calls != v->give_up_at;
}

static const double lower[2] = {-2, -2}, upper[2] = {2, 2}, steps[2] = {0.2, 0.1};

static moray_search_spec spec_of(valley *v)
{
    return (moray_search_spec){.n = 2,
                               .function = value_of,
                               .self = v,
                               .lower = lower,
                               .upper = upper,
                               .step = steps,
                               .tolerance = 1e-6,
                               .max_evaluations = 500};
}

static void test_minimum(void)
{
    valley v = {.centre = {0.7, -0.4}};
    double x[2] = {-1, 1};
    moray_search_end end;
    const moray_search_spec spec = spec_of(&v);
    CHECK_OK(moray_search(&spec, x, &end), "a bent valley");
    CHECK_NEAR(x[0], 0.7, 1e-6, "first variable");
    CHECK_NEAR(x[1], -0.4, 1e-6, "second variable");
    CHECK_NEAR(end.value, 3, 1e-11, "value");
    CHECK(end.evaluations == v.calls && !end.at_bound, "%d evaluations counted", end.evaluations);
}

// The minimum on x_0 = 2 of a valley that goes on beyond: a = 2 - centre, then b from d/db = a/2 + 4 b = 0.
static void test_bound(void)
{
    valley v = {.centre = {2.5, 0}};
    double x[2] = {0, 0};
    moray_search_end end;
    const moray_search_spec spec = spec_of(&v);
    CHECK_OK(moray_search(&spec, x, &end), "a valley beyond the bound");
    CHECK_NEAR(x[0], 2, 1e-7, "stops at the bound");
    CHECK_NEAR(x[1], 0.5 / 8 + 0.3 * 0.25, 1e-6, "and goes along it");
    CHECK(end.at_bound, "which it tells");
}

static void test_endings(void)
{
    double x[2] = {-1, 1};
    moray_search_end end;
    valley v = {.give_up_at = 5};
    moray_search_spec spec = spec_of(&v);
    CHECK(moray_search(&spec, x, &end).code == MORAY_INTERRUPTED && end.evaluations == 5, "given up at once");
    v = (valley){.fail_at = 4};
    CHECK(moray_search(&spec, x, &end).code == MORAY_NUMERIC && end.evaluations == 4, "a value that is none");
    v = (valley){0};
    spec.max_evaluations = 8;
    x[0] = -1;
    x[1] = 1;
    double start;
    value_of(x, &start, &v);
    v.calls = 0;
    CHECK(moray_search(&spec, x, &end).code == MORAY_NOT_SOLVED && v.calls == 8, "out of evaluations");
    CHECK(end.value < start, "with the best so far: %g", end.value);
}

static void refuse(moray_search_spec spec, const double *x, const char *what)
{
    double at[2] = {x[0], x[1]};
    moray_search_end end;
    const moray_status status = moray_search(&spec, at, &end);
    CHECK(status.code == MORAY_INPUT, "%s: %s", what, status.text);
}

static void test_bad_input(void)
{
    valley v = {0};
    const double inside[2] = {0, 0}, outside[2] = {0, 3}, flat[2] = {2, -2}, long_steps[2] = {0.1, 2.1};
    moray_search_spec spec = spec_of(&v);
    refuse(spec, outside, "a start outside");
    spec.n = 1;
    refuse(spec, inside, "one variable");
    spec = spec_of(&v);
    spec.upper = flat;
    refuse(spec, inside, "no room");
    spec = spec_of(&v);
    spec.step = long_steps;
    refuse(spec, inside, "a step too long");
    spec = spec_of(&v);
    spec.tolerance = 1;
    refuse(spec, inside, "a tolerance of a whole step");
    spec = spec_of(&v);
    spec.max_evaluations = 0;
    refuse(spec, inside, "no evaluations");
    CHECK(v.calls == 0, "nothing was evaluated");
}

int main(void)
{
    test_minimum();
    test_bound();
    test_endings();
    test_bad_input();
    return tap_done();
}
