// SPDX-License-Identifier: MIT
//
// Closed loops against the exact solutions of sampled linear systems.
#include "tap.h"

#include <string.h>

#include "moray/control/closed_loop.h"

// ---- A mass under sampled feedback ---------------------------------------------------------------------------------

enum { PERIODS = 40 };
static const double period = 0.3, gain[2] = {0.8, 1.3};

// x'' = u; u is held between measurements.
static bool mass(double t, const double *x, const double *u, double *dx, void *self)
{
    (void)t, (void)self;
    dx[0] = x[1];
    dx[1] = u[0];
    return true;
}

typedef struct feedback {
    double u;
    int measured;
    double applied[PERIODS + 2], t[PERIODS + 2]; // what `measure` saw
    int fail_at;                                 // -1: never
} feedback;

static void held(double t, double *u, const void *self)
{
    (void)t;
    u[0] = ((const feedback *)self)->u;
}

static moray_status measure(const moray_closed_loop_sample *sample, void *self)
{
    feedback *f = self;
    if (f->measured == f->fail_at)
        return moray_error(MORAY_NOT_SOLVED, "the sensor is wet");
    f->t[f->measured] = sample->t;
    f->applied[f->measured++] = sample->u[0];
    f->u = -gain[0] * sample->x[0] - gain[1] * sample->x[1];
    return moray_ok();
}

// x_{k+1} = x_k + h v_k + h^2/2 u_k, v_{k+1} = v_k + h u_k, u_k = -K x_k.
static void test_sampled(void)
{
    enum { n = 2 * PERIODS + 1 };
    feedback f = {.fail_at = -1};
    const moray_controller controller = {.nu = 1, .control = held, .measure = measure, .period = period, .self = &f};
    moray_closed_loop_record record;
    moray_sim_statistics statistics;
    double times[n], x[2] = {1, -0.5}, exact[2] = {1, -0.5}, worst = 0, worst_u = 0;
    bool timed = true;
    for (int k = 0; k < n; k++)
        times[k] = k * period / 2;
    CHECK_OK(moray_closed_loop_record_new(&record, 2, 1, n), "record");
    const moray_closed_loop_spec spec = {.plant = {.nx = 2, .nu = 1, .rates = mass},
                                         .controller = &controller,
                                         .t1 = times[n - 1],
                                         .times = times,
                                         .n_times = n,
                                         .observe = moray_closed_loop_record_add,
                                         .observer = &record,
                                         .settings = moray_sim_settings_default(),
                                         .statistics = &statistics};
    CHECK_OK(moray_closed_loop_run(&spec, x), "run");
    for (int k = 0; k < n; k++) {
        const double u = -gain[0] * exact[0] - gain[1] * exact[1], h = k % 2 * period / 2;
        const double at[2] = {exact[0] + h * exact[1] + h * h / 2 * u, exact[1] + h * u};
        worst = tap_worse(worst, fmax(fabs(record.x[2 * k] - at[0]), fabs(record.x[2 * k + 1] - at[1])));
        worst_u = tap_worse(worst_u, fabs(record.u[k] - u));
        timed = timed && record.t[k] == times[k];
        if (k % 2 == 0)
            continue;
        exact[0] += period * exact[1] + period * period / 2 * u;
        exact[1] += period * u;
    }
    CHECK(record.n == n && worst < 1e-11, "states at and between measurements: %.1e", worst);
    CHECK(worst_u < 1e-11, "the new control from the measurement on: %.1e", worst_u);
    CHECK(timed, "each with its time");
    CHECK(x[0] == record.x[2 * n - 2] && x[1] == record.x[2 * n - 1], "the end state");
    CHECK(f.measured == PERIODS + 1 && f.applied[0] == 0 && fabs(f.applied[7] - record.u[12]) < 1e-15,
          "%d measurements, each shown the control until then", f.measured);
    CHECK_NEAR(f.t[PERIODS], PERIODS * period, 1e-12, "time of the last");
    CHECK(statistics.steps >= PERIODS, "%ld steps", statistics.steps);
    moray_closed_loop_record_free(&record);
    moray_closed_loop_record_free(&record);
}

// ---- A plant that jumps --------------------------------------------------------------------------------------------

typedef struct decay {
    double rate;
    int jumps;
} decay;

static bool decaying(double t, const double *x, const double *u, double *dx, void *self)
{
    (void)t, (void)u;
    dx[0] = -((const decay *)self)->rate * x[0];
    return true;
}

static void jump(int k, void *self)
{
    static const double rates[] = {7, 1, 3, 0.5};
    decay *d = self;
    d->rate = rates[k];
    d->jumps++;
}

static bool stop(const moray_closed_loop_sample *sample, void *self)
{
    *(double *)self = sample->t;
    return sample->t < 2.2;
}

// Rates 1, 3 and 0.5 from 0, 1 and 2 on; the jump at -1 is overtaken.
static void test_jumps(void)
{
    static const double jumps[] = {-1, -0.5, 1, 2}, times[] = {0.5, 2.1, 2.3, 2.4};
    decay d = {0};
    double x = 1, last = 0;
    moray_closed_loop_spec spec = {.plant = {.nx = 1, .rates = decaying, .self = &d},
                                   .jumps = {.times = jumps, .n = 4, .change = jump, .self = &d},
                                   .t1 = 3,
                                   .settings = moray_sim_settings_default()};
    CHECK_OK(moray_closed_loop_run(&spec, &x), "run without a controller");
    CHECK_NEAR(x, exp(-1 - 3 - 0.5), 1e-11, "state in the end");
    CHECK(d.jumps == 4, "%d jumps", d.jumps);
    d.jumps = 0;
    x = 1;
    spec.times = times;
    spec.n_times = 4;
    spec.observe = stop;
    spec.observer = &last;
    CHECK_OK(moray_closed_loop_run(&spec, &x), "run that the observer stops");
    CHECK(last == 2.3, "at t = %g", last);
    CHECK_NEAR(x, exp(-1 - 3 - 0.15), 1e-11, "with the state last observed");
}

// ---- Refusals ------------------------------------------------------------------------------------------------------

static void refuses(moray_closed_loop_spec spec, const char *says)
{
    double x[2] = {1, 2};
    const moray_status status = moray_closed_loop_run(&spec, x);
    CHECK(status.code == MORAY_INPUT && strstr(status.text, says), "refused: %s", status.text);
    CHECK(x[0] == 1 && x[1] == 2, "the state stays");
}

static void test_refusals(void)
{
    static const double times[] = {1, 0.5};
    feedback f = {.fail_at = 3};
    moray_controller controller = {.nu = 1, .control = held, .measure = measure, .period = period, .self = &f};
    const moray_closed_loop_spec good = {.plant = {.nx = 2, .nu = 1, .rates = mass},
                                         .controller = &controller,
                                         .t1 = 3,
                                         .settings = moray_sim_settings_default()};
    moray_closed_loop_spec bad = good;
    bad.plant.nx = 0;
    refuses(bad, "plant of 0 states");
    bad = good, bad.plant.nu = 2;
    refuses(bad, "a controller of 1 controls for a plant of 2");
    bad = good, bad.t1 = -1;
    refuses(bad, "t1 = -1");
    bad = good, bad.times = times, bad.n_times = 1;
    refuses(bad, "no observer");
    bad.observe = stop, bad.n_times = 2;
    refuses(bad, "times[1] = 0.5");
    bad = good, bad.jumps = (moray_jumps){.times = times, .n = 2, .change = jump};
    refuses(bad, "jump 2 at t = 0.5");
    const double periods[] = {0, -1, NAN, 1e-12};
    for (int k = 0; k < 4; k++) {
        controller.period = periods[k];
        refuses(good, k < 3 ? "must be above 0" : "must be at least 3e-09 between t = 0 and 3");
    }
    controller.period = period;
    double x[2] = {1, 0};
    const moray_status status = moray_closed_loop_run(&good, x);
    CHECK(status.code == MORAY_NOT_SOLVED && strstr(status.text, "wet"), "a measurement fails: %s", status.text);
    CHECK(f.measured == 3 && x[0] != 1, "after %d of them", f.measured);
    moray_closed_loop_record record;
    CHECK(moray_closed_loop_record_new(&record, -1, 1, 1).code == MORAY_INPUT && !record.t, "a record of -1 states");
    CHECK_OK(moray_closed_loop_record_new(&record, 2, 0, 1), "a record of one sample");
    const moray_closed_loop_sample sample = {.t = 1, .x = x};
    CHECK(moray_closed_loop_record_add(&sample, &record) && !moray_closed_loop_record_add(&sample, &record),
          "is full after it");
    moray_closed_loop_record_free(&record);
}

int main(void)
{
    test_sampled();
    test_jumps();
    test_refusals();
    return tap_done();
}
