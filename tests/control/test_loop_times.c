// SPDX-License-Identifier: MIT
//
// When a closed loop jumps, measures and is seen, all of them in one order; which periods it takes.
#include "tap.h"

#include <string.h>

#include "moray/control/closed_loop.h"

enum { MOST = 60 };

typedef struct diary {
    int n;
    char what[MOST]; // j: jump, m: measurement, s: sample
    double t[MOST], u[MOST];
    double level; // what the controller holds
} diary;

static void note(diary *d, char what, double t, double u)
{
    if (d->n < MOST) {
        d->what[d->n] = what;
        d->t[d->n] = t;
        d->u[d->n++] = u;
    }
}

// x' = u, held; the control is the number of measurements.
static bool rates(double t, const double *x, const double *u, double *dx, void *self)
{
    (void)t, (void)x, (void)self;
    dx[0] = u[0];
    return true;
}

static void control(double t, double *u, const void *self)
{
    (void)t;
    u[0] = ((const diary *)self)->level;
}

static moray_status measure(const moray_closed_loop_sample *sample, void *self)
{
    diary *d = self;
    note(d, 'm', sample->t, sample->u[0]);
    d->level++;
    return moray_ok();
}

static void change(int k, void *self)
{
    note(self, 'j', k, 0);
}

static bool see(const moray_closed_loop_sample *sample, void *self)
{
    note(self, 's', sample->t, sample->u[0]);
    return true;
}

// Jumps before measurements, these before samples of the same time, from a start that is not 0.
static void test_order(void)
{
    static const double jumps[] = {-6, -4.5, -4.5, -4, -3.75}, times[] = {-5, -4.5, -4.25, -4, -3.9};
    diary d = {.level = 10};
    const moray_controller controller = {.nu = 1, .control = control, .measure = measure, .period = 0.5, .self = &d};
    const moray_closed_loop_spec spec = {.plant = {.nx = 1, .nu = 1, .rates = rates},
                                         .controller = &controller,
                                         .jumps = {.times = jumps, .n = 5, .change = change, .self = &d},
                                         .t0 = -5,
                                         .t1 = -3.7,
                                         .times = times,
                                         .n_times = 5,
                                         .observe = see,
                                         .observer = &d,
                                         .settings = moray_sim_settings_default()};
    double x = 2;
    CHECK_OK(moray_closed_loop_run(&spec, &x), "run");
    const char *const want = "jmsjmjssjmssj";
    CHECK(d.n == (int)strlen(want) && strncmp(d.what, want, strlen(want)) == 0, "%.*s", d.n, d.what);
    CHECK_NEAR(x, 2 + 0.5 * 11 + 0.5 * 12 + 0.3 * 13, 1e-9, "state in the end");
    int samples = 0, measurements = 0, made = 0;
    for (int k = 0; k < d.n; k++) {
        if (d.what[k] == 's')
            CHECK_NEAR(d.t[k], times[samples++], 0, "time of a sample");
        if (d.what[k] == 'j')
            CHECK_NEAR(d.t[k], made++, 0, "jump by jump");
        if (d.what[k] == 'm') {
            CHECK_NEAR(d.t[k], -5 + 0.5 * measurements, 1e-12, "time of a measurement");
            CHECK_NEAR(d.u[k], 10 + measurements++, 0, "is shown the control until then");
        }
    }
}

// Periods from 1e-9 of the larger time on, whatever its sign.
static void test_periods(void)
{
    static const struct {
        double t0, t1, shortest;
    } spans[] = {{-2000, -1999.5, 2e-6}, {-0.25, 1000, 1e-6}, {0, 2, 2e-9}, {0, -1000, 1e-6}};
    for (int k = 0; k < 4; k++) {
        diary d = {0};
        char says[200];
        double x = 1;
        moray_controller controller = {.nu = 1, .control = control, .measure = measure, .self = &d};
        const moray_closed_loop_spec spec = {.plant = {.nx = 1, .nu = 1, .rates = rates},
                                             .controller = &controller,
                                             .t0 = spans[k].t0,
                                             .t1 = spans[k].t1,
                                             .settings = moray_sim_settings_default()};
        controller.period = 0.7 * spans[k].shortest;
        moray_status status = moray_closed_loop_run(&spec, &x);
        snprintf(says, sizeof says, "period of the controller = %g: must be at least %g between t = %g and %g",
                 controller.period, spans[k].shortest, spans[k].t0, spans[k].t1);
        CHECK(status.code == MORAY_INPUT && strcmp(status.text, says) == 0 && d.n == 0, "%s", status.text);
        controller.measure = NULL; // needs none
        if (k < 3)
            CHECK_OK(moray_closed_loop_run(&spec, &x), "without measurements");
    }
}

static moray_status end(const moray_closed_loop_sample *sample, void *self)
{
    (void)sample;
    ++*(int *)self;
    return moray_error(MORAY_INTERRUPTED, "seen");
}

// The shortest period is one.
static void test_shortest(void)
{
    int measured = 0;
    double x = 1;
    const moray_controller controller = {
        .nu = 1, .control = control, .measure = end, .period = 1e-9, .self = &measured};
    const moray_closed_loop_spec spec = {.plant = {.nx = 1, .nu = 1, .rates = rates},
                                         .controller = &controller,
                                         .t0 = -0.5,
                                         .t1 = 1,
                                         .settings = moray_sim_settings_default()};
    CHECK(moray_closed_loop_run(&spec, &x).code == MORAY_INTERRUPTED && measured == 1, "measured %d times", measured);
}

int main(void)
{
    test_shortest();
    test_order();
    test_periods();
    return tap_done();
}
