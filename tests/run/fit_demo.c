// SPDX-License-Identifier: MIT
//
// A fit with everything that results show, for test_fit.sh: a decay of rate 1/2 from an unknown start, seen five times
// with errors; a second parameter acts on nothing, so that the data leave it open.
#include "moray/app/run.h"

#include <math.h>

static const char *const channels[] = {"level", "twice"};
enum { n = 5, ny = 2 };
static double time[n], value[n * ny];
static const double error = 0.01;

static void decay(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = -at->s[0] * at->x[0];
}

static void see(const moray_node *at, moray_num *y, const void *data)
{
    (void)data;
    y[0] = at->x[0];
    y[1] = 2 * at->x[0];
}

static void nothing(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)at, (void)data;
    out->objective = 0;
}

// Of y = 3 exp(-t / 2), one value missing.
static void measure(void)
{
    for (int k = 0; k < n; k++) {
        const double x = 3 * exp(-k / 2.);
        time[k] = k;
        value[k * ny] = k == 3 ? NAN : x + (k % 2 ? error : -error);
        value[k * ny + 1] = 2 * x + (k % 3 ? error : -error);
    }
}

int main(int argc, char **argv)
{
    const char *const parameters[] = {"rate", "spare"}, *const rates[] = {"1/s", NULL};
    const moray_phase_spec phase = {
        .nx = 1,
        .continuous = decay,
        .tf = moray_fixed(4),
        .x = MORAY_BOUNDS(moray_between(0, 10)),
        .observed = {.n = n, .ny = ny, .time = time, .value = value, .observe = see, .names = channels}};
    const moray_ocp_spec spec = {.name = "fit_demo",
                                 .phases = 1,
                                 .phase = &phase,
                                 .ns = 2,
                                 .s = MORAY_BOUNDS(moray_between(0, 5), moray_between(0, 5)),
                                 .s_names = parameters,
                                 .endpoint = nothing};
    measure();
    return moray_app_run(&(moray_app){.spec = &spec, .time_unit = "s", .s_units = rates}, argc, argv);
}
