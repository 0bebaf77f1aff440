// SPDX-License-Identifier: MIT
//
// How Newton's method comes to an orbit: from guesses whose defects are all of one sign, and at no cost from where it
// is there already.
#include "tap.h"

#include <string.h>

#include "moray/control/periodic_orbit.h"
#include "moray/num.h"

static const double probe[] = {0.3, 0.7, 0.4, 0.9, 1.1, 0.6};

static void start_at(double t, double *x, const void *self)
{
    (void)t;
    x[0] = ((const double *)self)[0];
    x[1] = ((const double *)self)[1];
}

static moray_periodic_orbit *orbit_of(const moray_map *plant, const moray_map *closing, const char *scheme)
{
    moray_periodic_orbit *orbit;
    const moray_periodic_orbit_spec spec = {
        .nx = 2, .ns = 1, .plant = plant, .closing = closing, .scheme = scheme, .intervals = 8};
    CHECK_OK(moray_periodic_orbit_new(&orbit, &spec), "orbit");
    return orbit;
}

static moray_map returning(void)
{
    static const moray_closing_condition both[] = {{MORAY_CLOSE_RETURNS, 0, 0}, {MORAY_CLOSE_RETURNS, 1, 0}};
    moray_map closing;
    CHECK_OK(moray_closing_map(&closing, 2, 1, both, 2), "closing conditions");
    return closing;
}

// ---- To rest -------------------------------------------------------------------------------------------------------

// x + x^3 = p is where both come to rest.
static void resting(void *self, const moray_num *in, moray_num *out)
{
    (void)self;
    for (int r = 0; r < 2; r++)
        out[r] = in[2] - in[r] - in[r] * in[r] * in[r];
}

// From below or above all defects have one sign.
static void test_signs(const char *scheme)
{
    moray_map plant, closing = returning();
    CHECK_OK(moray_map_from_complex(&plant, 4, 2, resting, NULL, NULL, probe), "plant");
    for (int k = 0; k < 4; k++) {
        moray_periodic_orbit *orbit = orbit_of(&plant, &closing, scheme);
        const double side = k % 2 ? -1 : 1, from[] = {k < 2 ? 0 : 1.5 * side, k < 2 ? 0 : 1.2 * side};
        const double p[2] = {side, 0.7}, rest = side * 0.6823278038280193;
        const moray_periodic_orbit_guess guess = {.state = start_at, .self = from};
        moray_periodic_orbit_info info;
        double x[2];
        CHECK_OK(moray_periodic_orbit_solve(orbit, p, &guess, &info), "found");
        moray_periodic_orbit_state(orbit, 0.3, x);
        CHECK_NEAR(x[0], rest, 1e-10, "at rest");
        CHECK_NEAR(x[1], rest, 1e-10, "and the other one");
        CHECK(info.residual <= 1e-11 && info.iterations > 2, "to %.1e in %d steps", info.residual, info.iterations);
        moray_periodic_orbit_free(orbit);
    }
    moray_map_release(&plant);
    moray_map_release(&closing);
}

// atan(x) = p is where both come to rest: from far off whole steps of Newton's method go further away each time.
static void flat(void *self, const moray_num *in, moray_num *out)
{
    (void)self;
    for (int r = 0; r < 2; r++)
        out[r] = in[2] - catan(in[r]);
}

static void test_halves(void)
{
    moray_map plant, closing = returning();
    const double from[2] = {3, -2.5}, p[2] = {0.3, 1e3};
    const moray_periodic_orbit_guess guess = {.state = start_at, .self = from};
    moray_periodic_orbit_info info;
    double x[2];
    CHECK_OK(moray_map_from_complex(&plant, 4, 2, flat, NULL, NULL, probe), "plant");
    moray_periodic_orbit *orbit = orbit_of(&plant, &closing, "radau1");
    CHECK_OK(moray_periodic_orbit_solve(orbit, p, &guess, &info), "found by halves of steps");
    moray_periodic_orbit_state(orbit, 0, x);
    CHECK_NEAR(x[0], tan(0.3), 1e-10, "at rest");
    CHECK_NEAR(x[1], tan(0.3), 1e-10, "and the other one");
    moray_periodic_orbit_free(orbit);
    moray_map_release(&plant);
    moray_map_release(&closing);
}

static void lines(void *self, const moray_num *in, moray_num *out)
{
    (void)self;
    out[0] = in[1] - 3 * in[0] + in[2];
    out[1] = -2 * in[0] - in[1];
}

// Where nothing is left to the last bit one step says so, and needs no slopes.
static void test_exact(void)
{
    moray_map plant, closing = returning();
    const double from[2] = {0, 0};
    const moray_periodic_orbit_guess guess = {.state = start_at, .self = from};
    moray_periodic_orbit_info info;
    CHECK_OK(moray_map_from_complex(&plant, 4, 2, lines, NULL, NULL, probe), "plant");
    moray_periodic_orbit *orbit = orbit_of(&plant, &closing, "gauss2");
    const double p[2] = {0, 0.7};
    CHECK_OK(moray_periodic_orbit_solve(orbit, p, &guess, &info), "at rest already");
    CHECK(info.residual == 0 && info.iterations == 1 && info.slopes == 1, "by %d step", info.iterations);
    CHECK_OK(moray_periodic_orbit_solve(orbit, p, NULL, &info), "and again");
    CHECK(info.residual == 0 && info.iterations == 1 && info.slopes == 0, "by %d step", info.iterations);
    for (int k = 0; k < 3; k++) {
        static const double wrong[3] = {0, -1, INFINITY};
        char says[60];
        snprintf(says, sizeof says, "period = %g: must be finite and above 0", wrong[k]);
        const moray_status status = moray_periodic_orbit_solve(orbit, (double[]){0, wrong[k]}, &guess, &info);
        CHECK(status.code == MORAY_INPUT && strcmp(status.text, says) == 0, "%s", status.text);
    }
    const moray_status status = moray_periodic_orbit_solve(orbit, (double[]){NAN, 1}, &guess, &info);
    CHECK(strcmp(status.text, "parameter 0 of the orbit = nan: must be finite") == 0, "%s", status.text);
    moray_periodic_orbit_free(orbit);
    moray_map_release(&plant);
    moray_map_release(&closing);
}

// ---- A driven spring -----------------------------------------------------------------------------------------------

// Its states' rates, and an output of its own.
static void driven(void *self, const moray_num *in, moray_num *out)
{
    (void)self;
    out[2] = in[0] * in[0] * in[2] + in[1] * in[1] * in[1] * in[1] + in[3] * in[0];
    out[0] = in[1];
    out[1] = -in[0] - in[0] * in[0] * in[0] - 0.3 * in[1] + in[2] * ccos(2 * in[3]);
}

// Solved again it takes the slopes it has, wherever rounding has left it.
static void test_again(void)
{
    moray_map plant, closing = returning();
    const double from[2] = {0.1, 0};
    const moray_periodic_orbit_guess guess = {.state = start_at, .self = from};
    moray_periodic_orbit_info info;
    int by_old = 0;
    CHECK_OK(moray_map_from_complex(&plant, 4, 3, driven, NULL, NULL, probe), "plant");
    for (int k = 0; k < 12; k++) {
        moray_periodic_orbit *orbit = orbit_of(&plant, &closing, "radau3");
        double p[2] = {0.2 + 0.07 * k, M_PI};
        CHECK_OK(moray_periodic_orbit_solve(orbit, p, &guess, &info), "found");
        CHECK(info.slopes >= 1, "by %d slopes", info.slopes);
        CHECK_OK(moray_periodic_orbit_solve(orbit, p, NULL, &info), "again");
        by_old += info.slopes == 0 && info.iterations == 1;
        double by[2];
        CHECK_OK(moray_periodic_orbit_output_gradient(orbit, 2, 0.3, by), "asked for slopes of its own");
        p[0] *= 1 + 1e-4;
        CHECK_OK(moray_periodic_orbit_solve(orbit, p, NULL, &info), "a little further");
        CHECK(info.residual <= 1e-11 && info.iterations >= 1 && info.iterations <= 12, "in %d steps", info.iterations);
        moray_periodic_orbit_free(orbit);
    }
    CHECK(by_old == 12, "%d of 12 by no slopes of their own", by_old);
    moray_map_release(&plant);
    moray_map_release(&closing);
}

// The mean of an output over the period: its slopes against differences of it.
static void test_mean(const char *scheme)
{
    moray_map plant, closing = returning();
    const double from[2] = {0.1, 0}, h = 1e-5;
    const moray_periodic_orbit_guess guess = {.state = start_at, .self = from};
    moray_periodic_orbit_info info;
    double by[2], mean[2];
    CHECK_OK(moray_map_from_complex(&plant, 4, 3, driven, NULL, NULL, probe), "plant");
    moray_periodic_orbit *orbit = orbit_of(&plant, &closing, scheme);
    for (int k = 0; k < 2; k++) {
        for (int side = 0; side < 2; side++) {
            double p[2] = {0.6, M_PI};
            p[k] += side ? h : -h;
            CHECK_OK(moray_periodic_orbit_solve(orbit, p, &guess, &info), "beside");
            mean[side] = moray_periodic_orbit_integral(orbit, 2, p[1]) / p[1];
        }
        CHECK_OK(moray_periodic_orbit_solve(orbit, (double[]){0.6, M_PI}, &guess, &info), "found");
        CHECK_OK(moray_periodic_orbit_mean_gradient(orbit, 2, by), "gradient");
        CHECK_NEAR(by[k], (mean[1] - mean[0]) / (2 * h), 1e-6, k ? "by the period" : "by the parameter");
        CHECK(fabs(by[k]) > 1e-3, "which counts: %g", by[k]);
    }
    moray_periodic_orbit_free(orbit);
    moray_map_release(&plant);
    moray_map_release(&closing);
}

// An orbit that cannot close: what is left of that is told as it is, whatever the scales of states.
static void never(void *self, const moray_num *in, moray_num *out)
{
    (void)self;
    out[0] = 5 + in[0] * in[0];
    out[1] = in[3] - in[1];
}

static void test_scales(void)
{
    static const double scales[][2] = {{1000, 2}, {1e-3, 3}};
    moray_map plant, closing;
    const double from[2] = {0.3, 0.2}, p[2] = {0, 0.7};
    const moray_periodic_orbit_guess guess = {.state = start_at, .self = from};
    CHECK_OK(moray_map_from_complex(&plant, 4, 2, resting, NULL, NULL, probe), "plant");
    CHECK_OK(moray_map_from_complex(&closing, 6, 2, never, NULL, NULL, probe), "closing conditions");
    for (int k = 0; k < 2; k++) {
        moray_periodic_orbit *orbit;
        moray_periodic_orbit_info info;
        const moray_periodic_orbit_spec spec = {.nx = 2,
                                                .ns = 1,
                                                .plant = &plant,
                                                .closing = &closing,
                                                .scheme = "radau2",
                                                .intervals = 4,
                                                .scale = scales[k]};
        CHECK_OK(moray_periodic_orbit_new(&orbit, &spec), "orbit");
        CHECK(moray_failed(moray_periodic_orbit_solve(orbit, p, &guess, &info)), "does not close");
        CHECK(info.residual >= 5 && info.residual < (k ? 1000 : 6), "by %g", info.residual);
        moray_periodic_orbit_free(orbit);
    }
    moray_map_release(&plant);
    moray_map_release(&closing);
}

// ---- Slopes of before ----------------------------------------------------------------------------------------------

// Rest is at 0.01 / p.
static void damped(void *self, const moray_num *in, moray_num *out)
{
    (void)self;
    out[0] = 0.01 - in[2] * in[0];
    out[1] = -in[1];
}

// Slopes that would overshoot are found out: it takes no more steps than from slopes of its own, one that solves what
// is linear and one that says so.
static void test_worse(void)
{
    moray_map plant, closing = returning();
    const double from[2] = {0.01, 0};
    const moray_periodic_orbit_guess guess = {.state = start_at, .self = from};
    moray_periodic_orbit_info own, old;
    CHECK_OK(moray_map_from_complex(&plant, 4, 2, damped, NULL, NULL, probe), "plant");
    moray_periodic_orbit *one = orbit_of(&plant, &closing, "radau2"), *other = orbit_of(&plant, &closing, "radau2");
    CHECK_OK(moray_periodic_orbit_solve(one, (double[]){5, 0.7}, &guess, &own), "from there");
    CHECK_OK(moray_periodic_orbit_solve(other, (double[]){1, 0.7}, &guess, &old), "at rest there");
    CHECK_OK(moray_periodic_orbit_solve(other, (double[]){5, 0.7}, NULL, &old), "on from there");
    CHECK(old.iterations == own.iterations && old.slopes == own.slopes && own.slopes == 1 && own.iterations == 2,
          "%d steps and %d", old.iterations, own.iterations);
    moray_periodic_orbit_free(one);
    moray_periodic_orbit_free(other);
    moray_map_release(&plant);
    moray_map_release(&closing);
}

// ---- No end --------------------------------------------------------------------------------------------------------

static void still(void *self, const moray_num *in, moray_num *out)
{
    (void)self, (void)in;
    out[0] = out[1] = 0;
}

// Of which a step of Newton's method leaves the e-th part.
static void slow(void *self, const moray_num *in, moray_num *out)
{
    (void)self;
    out[0] = 1e9 * cexp(-in[0]);
    out[1] = in[3] - in[1] + in[1];
}

// 5, whatever its slopes say.
static void stuck(void *self, const double *in, double *out)
{
    (void)self;
    out[0] = 5;
    out[1] = in[1];
}

static void given_up(const moray_map *closing, int steps, double left)
{
    char says[100];
    moray_map plant;
    const double from[2] = {0, 0}, p[2] = {0, 0.7};
    const moray_periodic_orbit_guess guess = {.state = start_at, .self = from};
    moray_periodic_orbit_info info;
    CHECK_OK(moray_map_from_complex(&plant, 4, 2, still, NULL, NULL, probe), "plant");
    moray_periodic_orbit *orbit = orbit_of(&plant, closing, "radau2");
    const moray_status status = moray_periodic_orbit_solve(orbit, p, &guess, &info);
    snprintf(says, sizeof says, "defects of %.2g are left after %d steps of Newton's method", left, steps);
    CHECK(status.code == MORAY_NOT_SOLVED && strcmp(status.text, says) == 0, "%s, not %s", status.text, says);
    CHECK(info.iterations == steps, "%d steps", info.iterations);
    moray_periodic_orbit_free(orbit);
    moray_map_release(&plant);
}

// After forty steps that each get on, or none that does.
static void test_no_end(void)
{
    moray_map closing;
    CHECK_OK(moray_map_from_complex(&closing, 6, 2, slow, NULL, NULL, probe), "closing conditions");
    given_up(&closing, 40, 1e9 * exp(-40));
    moray_map_release(&closing);
    static const moray_closing_condition starts[] = {{MORAY_CLOSE_STARTS, 0, 0}, {MORAY_CLOSE_STARTS, 1, 0}};
    CHECK_OK(moray_closing_map(&closing, 2, 1, starts, 2), "closing conditions");
    closing.value = stuck;
    given_up(&closing, 0, 5);
    moray_map_release(&closing);
}

int main(void)
{
    test_no_end();
    test_worse();
    test_scales();
    test_mean("radau3");
    test_mean("gauss3");
    test_mean("lobatto4");
    test_halves();
    test_exact();
    test_signs("radau3");
    test_signs("gauss2");
    test_signs("lobatto3");
    test_again();
    return tap_done();
}
