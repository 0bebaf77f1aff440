// SPDX-License-Identifier: MIT
//
// Records of closed loops, and what a closed loop refuses, by whole messages.
#include "tap.h"

#include <string.h>

#include "moray/control/closed_loop.h"

enum { NX = 3, NU = 2, ROOM = 4 };

static void test_record(void)
{
    moray_closed_loop_record record;
    CHECK_OK(moray_closed_loop_record_new(&record, NX, NU, ROOM), "a record");
    CHECK(record.n == 0 && record.capacity == ROOM && record.nx == NX && record.nu == NU, "of its sizes");
    for (int k = 0; k <= ROOM; k++) {
        const double x[NX] = {k, 10 + k, 20 + k}, u[NU] = {-k, -10 - k};
        const moray_closed_loop_sample sample = {.t = 0.5 * k, .x = x, .u = u};
        CHECK(moray_closed_loop_record_add(&sample, &record) == (k < ROOM), "sample %d", k);
    }
    CHECK(record.n == ROOM, "as many as there is room for: %d", record.n);
    for (int k = 0; k < ROOM; k++) {
        CHECK(record.t[k] == 0.5 * k, "time %g", record.t[k]);
        for (int i = 0; i < NX; i++)
            CHECK(record.x[k * NX + i] == k + 10 * i, "state %d: %g", i, record.x[k * NX + i]);
        for (int i = 0; i < NU; i++)
            CHECK(record.u[k * NU + i] == -k - 10 * i, "control %d: %g", i, record.u[k * NU + i]);
    }
    moray_closed_loop_record_free(&record);
    CHECK(!record.t && record.n == 0, "nothing is left");
    moray_closed_loop_record_free(&record);
}

static void test_sizes(void)
{
    moray_closed_loop_record record;
    for (int k = 0; k < 3; k++) {
        int size[3] = {2, 2, 2};
        char says[100];
        size[k] = 0;
        CHECK_OK(moray_closed_loop_record_new(&record, size[0], size[1], size[2]), "nothing of something");
        moray_closed_loop_record_free(&record);
        size[k] = -1;
        const moray_status status = moray_closed_loop_record_new(&record, size[0], size[1], size[2]);
        snprintf(says, sizeof says, "record of %d states, %d controls, %d samples: must be at least 0", size[0],
                 size[1], size[2]);
        CHECK(status.code == MORAY_INPUT && !record.t && strcmp(status.text, says) == 0, "%s", status.text);
    }
    CHECK_OK(moray_closed_loop_record_new(&record, 1, 0, 1), "no controls");
    const double x = 5;
    CHECK(moray_closed_loop_record_add(&(moray_closed_loop_sample){.t = 1, .x = &x}, &record) && record.x[0] == 5,
          "which need no place");
    moray_closed_loop_record_free(&record);
}

// ---- Refusals ------------------------------------------------------------------------------------------------------

static bool rates(double t, const double *x, const double *u, double *dx, void *self)
{
    (void)t, (void)x, (void)u, (void)self;
    dx[0] = 0;
    return true;
}

static void control(double t, double *u, const void *self)
{
    (void)t, (void)u, (void)self;
}

static void change(int k, void *self)
{
    (void)k, (void)self;
}

static void refuse(const moray_closed_loop_spec *spec, const char *says)
{
    double x[2] = {7, 8};
    const moray_status status = moray_closed_loop_run(spec, x);
    CHECK(status.code == MORAY_INPUT && strcmp(status.text, says) == 0 && x[0] == 7, "%s", status.text);
}

static void test_refused(void)
{
    static const double jumps[] = {1, 2, 1.5, 3, 4}, times[] = {0.5};
    const moray_controller two = {.nu = 2, .control = control};
    const moray_closed_loop_spec good = {
        .plant = {.nx = 1, .rates = rates}, .t1 = 5, .settings = moray_sim_settings_default()};
    moray_closed_loop_spec spec = good;
    double x = 1;
    CHECK_OK(moray_closed_loop_run(&spec, &x), "runs");
    spec.plant.nx = 0;
    refuse(&spec, "plant of 0 states and 0 controls: must be at least 1 and 0");
    spec.plant.nx = 1, spec.plant.nu = -1;
    refuse(&spec, "plant of 1 states and -1 controls: must be at least 1 and 0");
    spec = good;
    spec.controller = &two;
    refuse(&spec, "a controller of 2 controls for a plant of 0");
    spec = good;
    spec.jumps.times = jumps, spec.jumps.n = 5, spec.jumps.change = change;
    refuse(&spec, "jump 3 at t = 1.5: must not lie before the one before, 2");
    spec.jumps.n = 2;
    CHECK_OK(moray_closed_loop_run(&spec, &x), "those before it do");
    spec = good;
    spec.times = times, spec.n_times = 1;
    refuse(&spec, "1 times to be observed, and no observer");
}

int main(void)
{
    test_record();
    test_sizes();
    test_refused();
    return tap_done();
}
