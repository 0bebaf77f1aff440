// SPDX-License-Identifier: MIT
//
// The steps that the explicit method takes, read off the times at which it asks for slopes, of equations whose errors
// are known in closed form.
#include "tap.h"

#include "moray/sim.h"
#include "sim/prince_dormand.h"

enum { MOST = 4000, LAST = PD_STAGES - 1 };

typedef struct equation {
    double rate, power[2]; // x' = rate x + power t^7, of two states
    int refused;           // the question that has no answer, from 1 on
    bool broken;           // no answers but the first
    int n;
    double asked[MOST], told[MOST]; // the first state's slope
} equation;

static bool slope(double t, const double *x, double *dx, void *self)
{
    equation *e = self;
    dx[0] = dx[1] = NAN; // before x is read, which stands apart
    for (int i = 0; i < 2; i++)
        dx[i] = e->rate * x[i] + e->power[i] * pow(t, 7);
    if (e->n < MOST) {
        e->told[e->n] = dx[0];
        e->asked[e->n++] = t;
    }
    return e->n != e->refused && !(e->broken && e->n > 1);
}

static moray_sim *started(equation *e, double rtol, double atol, double max_step, const double x[2])
{
    const moray_sim_settings settings = {
        .method = MORAY_SIM_EXPLICIT, .rtol = rtol, .atol = atol, .max_step = max_step, .max_steps = 1000};
    moray_sim *sim;
    CHECK_OK(moray_sim_new(&sim, &(moray_ode){.n = 2, .rhs = slope, .self = e}, &settings), "new");
    CHECK_OK(moray_sim_start(sim, 0, x), "start");
    return sim;
}

// ---- The first step (Hairer, Norsett and Wanner, II.4) -------------------------------------------------------------

static void check_first_by(double rtol, double atol, double rate, const double x[2], double to, double euler,
                           double step)
{
    equation e = {.rate = rate};
    moray_sim *sim = started(&e, rtol, atol, 0, x);
    CHECK_OK(moray_sim_advance(sim, to), "advance");
    CHECK_RELATIVE(e.asked[1], euler, 1e-12, "step by Euler [s]");
    CHECK_RELATIVE(e.asked[1 + LAST], step, 1e-12, "first step [s]");
    moray_sim_free(sim);
}

static void check_first(double rate, const double x[2], double to, double euler, double step)
{
    check_first_by(1e-3, 1e-3, rate, x, to, euler, step);
}

static void test_first(void)
{
    const double x[] = {0.5, 2}, none[2] = {0}, tolerance = 1e-3 * 2 + 1e-3; // that of the state with the worst norm
    check_first(-0.5, x, 100, 0.01 / 0.5, pow(0.01 / (0.5 * 2 / tolerance), 1.0 / 8));
    check_first(-0.5, (double[]){0.5, -2}, 100, 0.01 / 0.5, pow(0.01 / (0.5 * 2 / tolerance), 1.0 / 8));
    check_first(-3, x, 100, 0.01 / 3, pow(0.01 / (9 * 2 / tolerance), 1.0 / 8));
    check_first(3, x, 1, 0.01 / 3, pow(0.01 / (9 * 2 / tolerance), 1.0 / 8));
    check_first(-50, x, 1, 0.01 / 50, 100 * 0.01 / 50); // no more than a hundred times that of Euler
    check_first(-0.5, x, 0.015, 0.015, 0.015);          // nor beyond the end
    check_first(-0.5, none, 1, 1e-6, 1e-6);             // where nothing moves
    // What is less than 1e-5 of the tolerance, in size or rate, tells no step by Euler.
    const double little[] = {2e-6, 0}, less[] = {2e-9, 0};
    check_first(-1.5e-6, x, 1, 1, 1);
    check_first(-1.5e-9, x, 1, 1e-6, 100 * 1e-6);
    check_first(-50, little, 1, 0.01 / 50, 100 * 0.01 / 50);
    check_first(-50, less, 1, 1e-6, 100 * 1e-6);
    // Nor does what is just that.
    check_first_by(1e-14, 1, -50, (double[]){1e-5, 0}, 1, 1e-6, 100 * 1e-6);
    check_first_by(1e-14, 1, 1024 * 1e-5, (double[]){1.0 / 1024, 0}, 1, 1e-6, 100 * 1e-6);
    // A curvature of no more than 1e-15 leaves the step as short as one by Euler is then.
    check_first_by(1e-14, 1, 1024 * 1e-15, (double[]){1.0 / 1024, 0}, 1, 1e-6, 1e-6);
    check_first_by(1e-14, 1, 1024 * 1.1e-15, (double[]){1.0 / 1024, 0}, 1, 1e-6, 100 * 1e-6);
}

// ---- The steps after it --------------------------------------------------------------------------------------------

// What is known of the method: where it is, the step to be tried, the error of the last step.
typedef struct course {
    double t, step, before;
    int at, rejections; // questions asked
} course;

// Of x' = t^7 a step of 1 has this error, since the embedded formula is exact up to t^6 and the other up to t^7.
static double error_of_power(void)
{
    double error = 0;
    for (int s = 0; s < PD_STAGES; s++)
        error += (pd_b[s] - pd_embedded[s]) * pow(pd_c[s], 7);
    return fabs(error);
}

// As precisely as a step's error comes out of slopes that are up to 1e9 times as large, and is asked for beside states
// of 1e6 with a relative tolerance of 1e-14.
static bool same(double got, double want)
{
    return fabs(got - want) <= 1e-5 * fabs(want);
}

// One step towards the stop: proportional and integral control of its size, the larger of two states' errors deciding.
static bool follow(course *c, const equation *e, double max_step, double stop, double per_step)
{
    const double longest = stop - c->t;
    double h = max_step > 0 ? fmin(c->step, max_step) : c->step;
    h = h >= longest ? longest : h > longest / 2 ? longest / 2 : h;
    bool as_asked = true, rejected = false;
    for (;; rejected = true, c->rejections++) {
        for (int s = 1; s <= LAST; s++)
            as_asked = as_asked && c->at < e->n && same(e->asked[c->at++], c->t + pd_c[s] * h);
        const double error = per_step * pow(h, 8);
        if (error <= 1) {
            const double factor = 0.9 * pow(fmax(error, 1e-10), 0.03 - 1.0 / 8) * pow(c->before, 0.04);
            const double next = h * fmax(0.2, fmin(factor, rejected ? 1 : 6));
            c->t = h == longest ? stop : c->t + h;
            c->step = h == longest ? fmax(next, c->step) : next;
            c->before = fmax(error, 1e-4);
            return as_asked;
        }
        if (!as_asked)
            return false;
        c->step = h *= fmax(0.2, 0.9 * pow(error, -1.0 / 8));
    }
}

// All steps to the stop, each of which asks for the slope where it begins; the first one's is asked for before.
static void check_steps(course *c, const equation *e, double max_step, double stop, double per_step)
{
    bool as_asked = true;
    int steps = 0;
    for (; as_asked && c->t < stop; steps++) {
        if (c->t > 0)
            as_asked = c->at < e->n && same(e->asked[c->at++], c->t);
        as_asked = as_asked && follow(c, e, max_step, stop, per_step);
    }
    CHECK(as_asked && c->at == e->n, "to %g: %d steps as the errors have them, %d of %d questions", stop, steps, c->at,
          e->n);
}

// Errors in two states of which either is the worse, with stops, of which two are close to each other, behind which
// they are a thousand times as large, so that what step was to be tried is rejected.
static void check_control(double first, double second, double max_step, bool rejected)
{
    equation e = {.power = {first, second}};
    const double x[2] = {0}, per_step = fmax(first, second) * error_of_power() / 1e-3;
    moray_sim *sim = started(&e, 1e-14, 1e-3, max_step, x);
    course c = {.step = 1e-6, .before = 1, .at = 2};
    CHECK_OK(moray_sim_advance(sim, 0.7), "advance");
    check_steps(&c, &e, max_step, 0.7, per_step);
    CHECK_OK(moray_sim_advance(sim, 0.7 + 1.0 / 1024), "a little further");
    check_steps(&c, &e, max_step, 0.7 + 1.0 / 1024, per_step);
    for (int i = 0; i < 2; i++)
        e.power[i] *= 1000;
    CHECK_OK(moray_sim_advance(sim, 1.5), "advance");
    check_steps(&c, &e, max_step, 1.5, 1000 * per_step);
    CHECK((c.rejections > 0) == rejected, "%d rejected", c.rejections);
    moray_sim_free(sim);
}

// A step whose error is the tolerance to the last bit is taken: the tolerance is what a first run's slopes make of it.
static void test_just_good(void)
{
    const double none[2] = {0};
    double tolerance = 1e-60;
    for (int round = 0; round < 2; round++) {
        equation e = {.power = {1, 0.5}};
        moray_sim *sim = started(&e, 1e-14, tolerance, 0, none);
        CHECK_OK(moray_sim_advance(sim, 1e-3), "advance");
        const double h = e.asked[1 + LAST];
        CHECK_RELATIVE(h, 1e-4, 1e-12, "the first step tried");
        CHECK((e.asked[2 + LAST] >= h) == (round > 0), "is taken the second time: %g", e.asked[2 + LAST]);
        double error = 0;
        for (int s = 0; s < PD_STAGES; s++)
            if (pd_b[s] != pd_embedded[s])
                error += h * (pd_b[s] - pd_embedded[s]) * (s > 0 ? e.told[1 + s] : e.told[0]);
        tolerance = fabs(error);
        moray_sim_free(sim);
    }
}

// A question without an answer, the fourth of a step, makes the step a quarter, after which it does not grow at once.
static void test_refused(void)
{
    const double x[] = {1, 1};
    equation e = {.refused = 2 + 4};
    moray_sim *sim = started(&e, 1e-3, 1e-3, 0, x);
    CHECK_OK(moray_sim_advance(sim, 1), "advance");
    const int again = e.refused; // the first question of the second try
    CHECK_RELATIVE(e.asked[again], pd_c[1] * 0.25e-6, 1e-12, "a quarter of the step");
    CHECK_RELATIVE(e.asked[again + LAST], 0.25e-6, 1e-12, "is taken");
    CHECK_RELATIVE(e.asked[again + 2 * LAST], 0.5e-6, 1e-12, "and once more");
    const double most = 0.9 * pow(10, 0.95 - 0.16); // where there is no error, nor was
    CHECK_RELATIVE(e.asked[again + 3 * LAST + 1], 0.5e-6 + most * 0.25e-6, 1e-12, "before it grows");
    moray_sim_free(sim);
}

// Who could go no way from one state goes from another by the slope there.
static void test_started_anew(void)
{
    const double x[] = {1, 1}, other[] = {4, -4};
    equation e = {.rate = -1, .broken = true};
    moray_sim *sim = started(&e, 1e-10, 1e-10, 0, x);
    CHECK(moray_sim_advance(sim, 1).code == MORAY_NUMERIC, "no way");
    e.broken = false;
    CHECK_OK(moray_sim_start(sim, 0, other), "started anew");
    CHECK_OK(moray_sim_advance(sim, 1), "advance");
    for (int i = 0; i < 2; i++)
        CHECK_NEAR(moray_sim_state(sim)[i], other[i] * exp(-1), 1e-8, "as if there had been nothing before");
    moray_sim_free(sim);
}

// Long before the time 0 a step ends at what the clock tells apart, a thousand times the spacing of numbers there:
// 1e-6 s / 4^k is more than 2.2e-10 s for seven k. Each asks once, as do the start and the step by Euler.
static void test_smallest_step(void)
{
    const double x[] = {1, 1};
    equation e = {.broken = true};
    moray_sim *sim = started(&e, 1e-3, 1e-3, 0, x);
    CHECK_OK(moray_sim_start(sim, -1e3, x), "long ago");
    CHECK(moray_sim_advance(sim, 1 - 1e3).code == MORAY_NUMERIC, "no way");
    CHECK(e.n == 2 + 7, "%d questions", e.n);
    moray_sim_free(sim);
}

// What is no longer than a thousand times that is not tried: 1000 / 4096 s / 4^k is longer for twenty k.
static void test_just_least(void)
{
    const double x[] = {1, 1};
    equation e = {.rate = 0.01, .broken = true};
    moray_sim *sim = started(&e, 1e-3, 1e-3, 1000 * 0x1p-12, x);
    CHECK(moray_sim_advance(sim, 1).code == MORAY_NUMERIC, "no way");
    CHECK(e.n == 2 + 20, "%d questions", e.n);
    moray_sim_free(sim);
}

// A slope at the end of a step alone, as steep as the step is short: its error is twice the tolerance whatever the
// step.
typedef struct steep {
    int asked;
} steep;

static bool ever_steeper(double t, const double *x, double *dx, void *self)
{
    steep *s = self;
    (void)x;
    const bool last = s->asked > 1 && (s->asked - 2) % LAST == LAST - 1;
    dx[0] = last ? 2e-3 / fabs(pd_b[LAST] - pd_embedded[LAST]) / t : 0;
    s->asked++;
    return true;
}

// Sixty times.
static void test_rejections(void)
{
    const moray_sim_settings settings = {.method = MORAY_SIM_EXPLICIT, .rtol = 1e-14, .atol = 1e-3, .max_steps = 1000};
    steep s = {0};
    moray_sim *sim;
    CHECK_OK(moray_sim_new(&sim, &(moray_ode){.n = 1, .rhs = ever_steeper, .self = &s}, &settings), "new");
    CHECK_OK(moray_sim_start(sim, 0, (double[]){0}), "start");
    CHECK(moray_sim_advance(sim, 1).code == MORAY_NUMERIC, "no way");
    CHECK(s.asked == 2 + 60 * LAST, "%d questions", s.asked);
    moray_sim_free(sim);
}

int main(void)
{
    test_just_least();
    test_rejections();
    test_first();
    check_control(0, 0, 0, false);
    check_control(0, 0, 0.15, false);
    check_control(1000, 1, 0, true);
    check_control(1, 1000, 0, true);
    check_control(1, 1000, 0.05, false);
    test_refused();
    test_just_good();
    test_started_anew();
    test_smallest_step();
    return tap_done();
}
