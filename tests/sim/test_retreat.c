// SPDX-License-Identifier: MIT
//
// Ways too short for a step, and where ARKODE goes on once the right-hand side has no answer: read off the times at
// which it asks for slopes.
#include "tap.h"

#include <float.h>

#include "moray/sim.h"
#include "sim/prince_dormand.h"

enum { MOST = 1000, STEP = PD_STAGES - 1 };

typedef struct equation {
    double beyond;  // x' = -x; no answers after this time
    int refused[2]; // nor to these questions
    int n;
    double asked[MOST];
} equation;

static bool slope(double t, const double *x, double *dx, void *self)
{
    equation *e = self;
    dx[0] = -x[0];
    const bool answered = t <= e->beyond && e->n != e->refused[0] && e->n != e->refused[1];
    if (e->n < MOST)
        e->asked[e->n++] = t;
    return answered;
}

static moray_sim *started(equation *e, moray_sim_method method, double t)
{
    const moray_sim_settings settings = {.method = method, .rtol = 1e-3, .atol = 1e-3, .max_steps = 1000};
    moray_sim *sim;
    CHECK_OK(moray_sim_new(&sim, &(moray_ode){.n = 1, .rhs = slope, .self = e}, &settings), "new");
    CHECK_OK(moray_sim_start(sim, t, (double[]){1}), "start");
    return sim;
}

// ---- Short ways ----------------------------------------------------------------------------------------------------

// Of a way from t, and whether a step was taken on it.
static void check_way(double t, double way, bool taken)
{
    equation e = {.beyond = INFINITY, .refused = {-1, -1}};
    moray_sim *sim = started(&e, MORAY_SIM_EXPLICIT, t);
    CHECK_OK(moray_sim_advance(sim, t + way), "advance");
    CHECK((moray_sim_get_statistics(sim).steps > 0) == taken, "from %g by %g: %ld steps", t, way,
          moray_sim_get_statistics(sim).steps);
    CHECK(moray_sim_time(sim) == t + way, "there");
    moray_sim_free(sim);
}

// As far as a hundred times what the clock tells apart there.
static void test_short_ways(void)
{
    const double way = 100 * DBL_EPSILON * 1024;
    for (int past = 0; past < 2; past++) {
        const double t = past ? -1024 : 1024;
        check_way(t, 0.5 * way, false);
        check_way(t, 1.5 * way, true);
    }
    check_way(-1024, way, false);
    check_way(-1024, way * (1 + 1.0 / 64), true);
    check_way(0, 1e-200, true);
    check_way(-1e-13, 2e-13, true);
}

// ---- Retreats ------------------------------------------------------------------------------------------------------

// A question asked beyond t is of the second stage of a step.
static double step_from(double t, const equation *e, int question)
{
    return (e->asked[question] - t) / pd_c[1];
}

// Each attempt is a quarter of the one before, down to a thousand times what the clock tells apart at t and on the way.
// Returns the last one.
static double check_end(double t, double way)
{
    equation e = {.beyond = t, .refused = {-1, -1}};
    moray_sim *sim = started(&e, MORAY_SIM_ARKODE, t);
    CHECK(moray_sim_advance(sim, t + way).code == MORAY_NUMERIC, "no way");
    const double least = 1e3 * DBL_EPSILON * fmax(fabs(t), way);
    double before = 0;
    int attempts = 0;
    for (int i = 3; i < e.n; i++) {
        if (e.asked[i] <= t)
            continue;
        const double h = step_from(t, &e, i);
        if (attempts++ > 0)
            CHECK_NEAR(h / before, 0.25, 0.005, "a quarter");
        before = h;
    }
    CHECK(attempts > 5 && before > 0.98 * least && before < 4.08 * least, "the last of %d: %g of %g", attempts, before,
          least);
    moray_sim_free(sim);
    return before;
}

// Near a stop what was to be tried is longer than the way, and a quarter of the way is next.
static void test_near_stop(void)
{
    equation e = {.beyond = INFINITY, .refused = {-1, -1}};
    moray_sim *sim = started(&e, MORAY_SIM_ARKODE, 0);
    CHECK_OK(moray_sim_advance(sim, 1), "advance");
    const int first = e.n + 1, second = first + 3;
    e.refused[0] = first;
    CHECK_OK(moray_sim_advance(sim, 1.01), "advance");
    CHECK_RELATIVE(step_from(1, &e, first), 0.01, 1e-9, "all of the way");
    CHECK_RELATIVE(step_from(1, &e, second), 0.0025, 1e-9, "a quarter of it");
    moray_sim_free(sim);
}

// Between two refusals are steps that are taken: a quarter of the step first tried, and twice that. The second refusal
// makes a quarter of the step tried then.
static void test_on(void)
{
    const int first = 4, second = first + 3, next = second + STEP + 1, third = next + STEP + 1, fourth = third + 3;
    equation e = {.beyond = INFINITY, .refused = {first, third}};
    moray_sim *sim = started(&e, MORAY_SIM_ARKODE, 0);
    CHECK_OK(moray_sim_advance(sim, 1), "advance");
    const double h = step_from(0, &e, second);
    CHECK_RELATIVE(h, 0.25 * step_from(0, &e, first), 1e-12, "a quarter");
    CHECK_RELATIVE(step_from(h, &e, next), 2 * h, 1e-12, "grows to twice as much");
    CHECK(step_from(3 * h, &e, third) > 2.5 * h, "and more");
    CHECK_RELATIVE(step_from(3 * h, &e, fourth), 0.25 * step_from(3 * h, &e, third), 1e-9, "a quarter again");
    CHECK_NEAR(moray_sim_state(sim)[0], exp(-1), 1e-3, "decay");
    moray_sim_free(sim);
}

int main(void)
{
    test_short_ways();
    check_end(0, 1);
    check_end(0, 64);
    check_end(-1000, 1);
    check_end(1000, 1);
    CHECK_RELATIVE(check_end(1024, 1000 * 0x1p-12) / (1e3 * DBL_EPSILON * 1024), 1, 1e-2, "the least itself is tried");
    test_near_stop();
    test_on();
    return tap_done();
}
