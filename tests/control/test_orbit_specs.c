// SPDX-License-Identifier: MIT
//
// What orbits are refused, by whole messages, and their monodromy matrix against orbits that start beside.
#include "tap.h"

#include <string.h>

#include "moray/control/periodic_orbit.h"
#include "moray/num.h"

// ---- Sizes ---------------------------------------------------------------------------------------------------------

// Maps of sizes alone, which are refused before anything is asked of them.
static void refuse(const moray_periodic_orbit_spec *spec, int plant_in, int plant_out, int closing_in, int closing_out,
                   const char *says)
{
    const moray_map plant = {.n_in = plant_in, .n_out = plant_out},
                    closing = {.n_in = closing_in, .n_out = closing_out};
    moray_periodic_orbit_spec of = *spec;
    moray_periodic_orbit *orbit;
    of.plant = &plant;
    of.closing = &closing;
    const moray_status status = moray_periodic_orbit_new(&orbit, &of);
    CHECK(status.code == MORAY_INPUT && !orbit && strcmp(status.text, says) == 0, "%s, not %s", status.text, says);
}

static void test_sizes(void)
{
    static const int at_least[4] = {1, 0, 0, 0};
    const moray_periodic_orbit_spec good = {.nx = 2, .ns = 3, .nw = 4, .scheme = "radau2", .intervals = 5};
    char says[200];
    for (int k = 0; k < 4; k++) {
        int size[4] = {2, 3, 4, 0};
        size[k] = at_least[k] - 1;
        const moray_periodic_orbit_spec spec = {.nx = size[0], .ns = size[1], .nw = size[2], .n_found = size[3]};
        snprintf(
            says, sizeof says,
            "orbit of %d states, %d parameters, %d of them found, %d further unknowns: must be at least 1, 0, 0, 0",
            size[0], size[1], size[3], size[2]);
        refuse(&spec, 6, 2, 12, 6, says);
    }
    refuse(&good, 5, 2, 12, 6, "plant of 5 inputs and 2 outputs: must be 6 and at least 2");
    refuse(&good, 6, 1, 12, 6, "plant of 6 inputs and 1 outputs: must be 6 and at least 2");
    refuse(&good, 6, 2, 11, 6, "closing conditions of 11 inputs and 6 outputs: must be 12 and 6");
    refuse(&good, 6, 2, 12, 7, "closing conditions of 12 inputs and 7 outputs: must be 12 and 6");
    static const int intervals[] = {0, -1, 10001};
    for (int k = 0; k < 3; k++) {
        moray_periodic_orbit_spec spec = good;
        spec.intervals = intervals[k];
        snprintf(says, sizeof says, "intervals = %d: must be 1 to 10000", intervals[k]);
        refuse(&spec, 6, 2, 12, 6, says);
    }
    const moray_periodic_orbit_spec large = {.nx = 100, .ns = 400, .scheme = "radau5", .intervals = 10000};
    refuse(&large, 501, 100, 601, 100, "an orbit of 50001 nodes with 100 outputs by 501 inputs each is too large");
}

static void test_found(void)
{
    static const int cases[][3] = {{-1, 1, 2}, {0, 0, 2}, {0, 2, 1}, {1, 2, 4}, {0, 4, 5}, {4, 5, 6}, {0, 1, 1}};
    static const int wrong[] = {0, 1, 2, 2, 1, 0, 2};
    for (int k = 0; k < 7; k++) {
        const moray_periodic_orbit_spec spec = {
            .nx = 2, .ns = 3, .found = cases[k], .n_found = 3, .scheme = "radau2", .intervals = 5};
        char says[100];
        snprintf(says, sizeof says, "found[%d] = %d: must ascend from 0 to 3", wrong[k], cases[k][wrong[k]]);
        refuse(&spec, 6, 2, 8, 5, says);
    }
}

// ---- Monodromy -----------------------------------------------------------------------------------------------------

static const double probe[] = {0.3, 0.7, 0.4, 0.9};

static void driven(void *self, const moray_num *in, moray_num *out)
{
    (void)self;
    out[0] = in[1] - 0.1 * in[0];
    out[1] = -in[0] - 0.5 * in[0] * in[0] * in[0] - 0.3 * in[1] + in[2] * ccos(in[3]);
}

// Sizes of the states, each of which is above 0.
static void test_scales(void)
{
    static const double wrong[] = {0, -1, NAN, INFINITY};
    const moray_closing_condition starts[] = {{MORAY_CLOSE_STARTS, 0, 1}, {MORAY_CLOSE_STARTS, 1, 2}};
    moray_map plant, closing;
    CHECK_OK(moray_map_from_complex(&plant, 4, 2, driven, NULL, NULL, probe), "plant");
    CHECK_OK(moray_closing_map(&closing, 2, 1, starts, 2), "start");
    for (int k = 0; k < 8; k++) {
        double scale[2] = {3, 4};
        char says[60];
        scale[k % 2] = wrong[k / 2];
        moray_periodic_orbit *orbit;
        const moray_periodic_orbit_spec spec = {
            .nx = 2, .ns = 1, .plant = &plant, .closing = &closing, .scale = scale, .scheme = "radau2", .intervals = 3};
        const moray_status status = moray_periodic_orbit_new(&orbit, &spec);
        snprintf(says, sizeof says, "scale[%d] = %g: must be above 0", k % 2, wrong[k / 2]);
        CHECK(status.code == MORAY_INPUT && !orbit && strcmp(status.text, says) == 0, "%s", status.text);
    }
    moray_map_release(&plant);
    moray_map_release(&closing);
}

static void start_at(double t, double *x, const void *self)
{
    (void)t;
    memcpy(x, self, 2 * sizeof *x);
}

// An orbit that starts in x and ends wherever it does.
static moray_periodic_orbit *from(const moray_map *plant, moray_map *closing, const double *x, const char *scheme,
                                  int intervals, double *end)
{
    const moray_closing_condition starts[] = {{MORAY_CLOSE_STARTS, 0, x[0]}, {MORAY_CLOSE_STARTS, 1, x[1]}};
    const double p[2] = {0.8, 2.5};
    moray_periodic_orbit *orbit;
    moray_periodic_orbit_info info;
    CHECK_OK(moray_closing_map(closing, 2, 1, starts, 2), "start");
    const moray_periodic_orbit_spec spec = {
        .nx = 2, .ns = 1, .plant = plant, .closing = closing, .scheme = scheme, .intervals = intervals};
    CHECK_OK(moray_periodic_orbit_new(&orbit, &spec), "orbit");
    CHECK_OK(moray_periodic_orbit_solve(orbit, p, &(moray_periodic_orbit_guess){.state = start_at, .self = x}, &info),
             "found");
    moray_periodic_orbit_state(orbit, p[1], end);
    return orbit;
}

static void test_monodromy(const char *scheme, int intervals)
{
    const double x[2] = {0.4, -0.3}, h = 1e-5;
    double M[4], end[2], worst = 0;
    moray_map plant, closing;
    CHECK_OK(moray_map_from_complex(&plant, 4, 2, driven, NULL, NULL, probe), "plant");
    moray_periodic_orbit *orbit = from(&plant, &closing, x, scheme, intervals, end);
    CHECK_OK(moray_periodic_orbit_monodromy(orbit, M), "monodromy");
    moray_periodic_orbit_free(orbit);
    moray_map_release(&closing);
    for (int c = 0; c < 2; c++) {
        double ends[2][2];
        for (int side = 0; side < 2; side++) {
            double beside[2] = {x[0], x[1]};
            beside[c] += side ? h : -h;
            orbit = from(&plant, &closing, beside, scheme, intervals, ends[side]);
            moray_periodic_orbit_free(orbit);
            moray_map_release(&closing);
        }
        for (int r = 0; r < 2; r++)
            worst = tap_worse(worst, fabs(M[2 * r + c] - (ends[1][r] - ends[0][r]) / (2 * h)));
    }
    CHECK(worst < 1e-8 && fabs(M[1] - M[2]) > 0.01, "%s, %d intervals: off by %.1e", scheme, intervals, worst);
    moray_map_release(&plant);
}

int main(void)
{
    static const char *const schemes[] = {"lobatto2", "gauss1", "radau1", "radau3", "lobatto4", "gauss2"};
    test_sizes();
    test_found();
    test_scales();
    for (int k = 0; k < 6; k++)
        for (int intervals = 1; intervals < 8; intervals += 3)
            test_monodromy(schemes[k], intervals);
    return tap_done();
}
