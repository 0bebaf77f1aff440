// SPDX-License-Identifier: MIT
//
// Covariance in any units: of a straight line through points, whose normal equations are of two unknowns.
#include "observe.h"

enum { TIMES = 5 };
static const double at_times[TIMES] = {0.25, 0.5, 1, 1.5, 1.75}, seen[TIMES] = {1.4, 1.3, 2.1, 2.2, 2.9};

// Of the slope, where the variance of the points is told, 1 in these units.
static double variance_of_slope(void)
{
    double mean = 0, sum = 0;
    for (int k = 0; k < TIMES; k++)
        mean += at_times[k] / TIMES;
    for (int k = 0; k < TIMES; k++)
        sum += (at_times[k] - mean) * (at_times[k] - mean);
    return 1 / sum;
}

static void check(double unit)
{
    const moray_bounds box = moray_between(-20 * unit, 20 * unit);
    const double weight = 1 / (unit * unit);
    double value[TIMES];
    for (int k = 0; k < TIMES; k++)
        value[k] = unit * seen[k];
    const moray_phase_spec phase = {
        .nx = 1,
        .continuous = grow,
        .tf = moray_fixed(2),
        .x = MORAY_BOUNDS(box),
        .observed = {.n = TIMES, .ny = 1, .time = at_times, .value = value, .weight = &weight, .observe = see_state}};
    moray_settings settings = moray_settings_default();
    moray_ocp *ocp = NULL;
    moray_fit fit;
    settings.tolerance = 1e-10;
    CHECK_OK(moray_ocp_new(
                 &ocp,
                 &(moray_ocp_spec){.phases = 1, .phase = &phase, .ns = 1, .s = MORAY_BOUNDS(box), .endpoint = nothing}),
             "a line");
    moray_solution *solution = solve(ocp, &settings, NULL);
    CHECK_OK(moray_fit_new(&fit, solution, true), "fit");
    CHECK(fit.undetermined == 0 && fit.freedom == 2, "in units of %g: %d open, %d free", unit, fit.undetermined,
          fit.freedom);
    CHECK_RELATIVE(fit.covariance[0], unit * unit * variance_of_slope(), 1e-6, "variance of the slope");
    CHECK_RELATIVE(fit.error[0], unit * sqrt(variance_of_slope()), 1e-6, "its error");
    moray_fit_free(&fit);
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

int main(void)
{
    check(1);
    check(1e-6);
    check(1e6);
    return tap_done();
}
