// SPDX-License-Identifier: MIT
//
// Simulated guesses by an integrator of one step a sample, whose every number is known: of phases of different sizes,
// with parameters, time, and controls that a function gives or bounds do.
#include "tap.h"

#include <string.h>

#include "moray/ocp.h"

enum { nx = 2, nu = 2, first_rows = 4, second_rows = 3 };

// x += (t1 - t0) x'(t0).
static moray_status step(const moray_integrator *self, const moray_ode *ode, double t0, double t1, double *x,
                         const double *times, int n_times, moray_ode_observer *observe, void *observer)
{
    (void)self, (void)times, (void)n_times, (void)observe, (void)observer;
    double dx[8];
    if (!ode->rhs(t0, x, dx, ode->self))
        return moray_error(MORAY_NUMERIC, "no slope at %g", t0);
    for (int i = 0; i < ode->n; i++)
        x[i] += (t1 - t0) * dx[i];
    return moray_ok();
}
static const moray_integrator integrator = {.run = step};

static void rates(const double *x, const double *u, const double *s, double t, double *f)
{
    f[0] = x[1] + 3 * u[0] * s[1] + t;
    f[1] = u[1] - s[0] * x[0];
}

static void go(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = at->x[1] + 3 * at->u[0] * at->s[1] + at->t;
    out->f[1] = at->u[1] - at->s[0] * at->x[0];
    out->c[0] = at->u[0];
}

// Nothing drives it.
static void roll(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = at->s[0] * at->x[1];
    out->f[1] = at->s[1] + at->t;
    out->f[2] = at->x[0];
}

static void verdict(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase[0].xf[0];
}

static moray_ocp *problem(bool rolls)
{
    const moray_bounds u[] = {{-1, 3}, {-8, -2}};
    moray_phase_spec phase[2] = {{.name = "out",
                                  .nx = nx,
                                  .nu = nu,
                                  .nc = 1,
                                  .continuous = go,
                                  .tf = moray_fixed(1),
                                  .u = MORAY_BOUNDS_OF(u),
                                  .c = MORAY_BOUNDS(moray_free())},
                                 {.name = "back", .nx = 3, .continuous = roll, .tf = moray_fixed(1)}};
    if (!rolls)
        phase[1] = phase[0], phase[1].name = "on";
    moray_ocp *ocp = NULL;
    CHECK_OK(moray_ocp_new(&ocp, &(moray_ocp_spec){.phases = 2, .phase = phase, .ns = 2, .endpoint = verdict}),
             "problem");
    return ocp;
}

static void steer(int phase, double t, const double *x, double *u, void *self)
{
    u[0] = 10 * phase + t + x[0];
    u[1] = *(const double *)self - x[1];
}

static void middles(int phase, double t, const double *x, double *u, void *self)
{
    (void)phase, (void)t, (void)x, (void)self;
    u[0] = 1, u[1] = -5;
}

static const double s[] = {0.5, -0.25}, x0[] = {1, -2}, gain = 7;

// The samples of a phase that begins at x: leaves there where it ends.
static void check_phase(const moray_samples *got, int p, int rows, double t0, double tf, double *x,
                        moray_control_fn *control)
{
    double self = gain;
    CHECK(got->n == rows, "%d samples", got->n);
    for (int k = 0; k < rows; k++) {
        double u[nu], f[nx];
        const double t = t0 + (tf - t0) * k / (rows - 1), length = (tf - t0) / (rows - 1);
        control(p, t, x, u, &self);
        CHECK_NEAR(got->time[k], t, 1e-12, "a time");
        for (int i = 0; i < nx; i++)
            CHECK_NEAR(got->x[k * nx + i], x[i], 1e-9, "a state");
        for (int i = 0; i < nu; i++)
            CHECK_NEAR(got->u[k * nu + i], u[i], 1e-9, "a control");
        rates(x, u, s, t, f);
        for (int i = 0; i < nx && k < rows - 1; i++)
            x[i] += length * f[i];
    }
}

static void test_samples(bool steered)
{
    moray_ocp *ocp = problem(false);
    moray_guess guess;
    double self = gain, x[nx] = {x0[0], x0[1]};
    const moray_drive drive[] = {{.t0 = 1, .tf = 2.5, .x0 = x0, .samples = first_rows},
                                 {.t0 = 3, .tf = 4, .samples = second_rows}};
    CHECK_OK(moray_guess_simulate(&guess, ocp, drive, s, steered ? steer : NULL, &self, &integrator), "simulated");
    check_phase(&guess.phase[0], 0, first_rows, 1, 2.5, x, steered ? steer : middles);
    check_phase(&guess.phase[1], 1, second_rows, 3, 4, x, steered ? steer : middles);
    CHECK(guess.s[0] == s[0] && guess.s[1] == s[1], "parameters");
    moray_guess_free(&guess);
    moray_ocp_free(ocp);
}

static void only_first(int phase, double t, const double *x, double *u, void *self)
{
    CHECK(phase == 0, "a phase without controls is not asked for them");
    steer(phase, t, x, u, self);
}

static void test_without_controls(void)
{
    moray_ocp *ocp = problem(true);
    moray_guess guess;
    double self = gain, x[nx] = {x0[0], x0[1]};
    const double begin[] = {4, 5, 6};
    const moray_drive drive[] = {{.t0 = 1, .tf = 1, .x0 = x0, .samples = 2}, {.t0 = 2, .tf = 2.5, .x0 = begin}};
    CHECK_OK(moray_guess_simulate(&guess, ocp, drive, s, only_first, &self, &integrator), "simulated");
    check_phase(&guess.phase[0], 0, 2, 1, 1, x, steer);
    CHECK(guess.phase[1].n == 100 && !guess.phase[1].u, "%d samples", guess.phase[1].n);
    const double length = 0.5 / 99, *second = guess.phase[1].x + 3;
    CHECK_NEAR(second[0], 4 + length * 0.5 * 5, 1e-12, "a state after a step");
    CHECK_NEAR(second[1], 5 + length * (2 - 0.25), 1e-12, "a state after a step");
    CHECK_NEAR(second[2], 6 + length * 4, 1e-12, "a state after a step");
    moray_guess_free(&guess);
    moray_ocp_free(ocp);
}

// ---- What is wrong with a drive ----

static void check_refused(bool rolls, const moray_drive *drive, moray_code code, const char *text)
{
    moray_ocp *ocp = problem(rolls);
    moray_guess guess;
    double self = gain;
    const moray_status status = moray_guess_simulate(&guess, ocp, drive, s, steer, &self, &integrator);
    CHECK(status.code == code && strcmp(status.text, text) == 0, "%s", status.text);
    CHECK(!guess.owned && !guess.phase && !guess.s, "and there is no guess");
    moray_ocp_free(ocp);
}

static void test_refused(void)
{
    const double lost[] = {1, INFINITY}, begin[] = {0, 0, 0};
    const moray_drive good[] = {{.t0 = 0, .tf = 1, .x0 = x0, .samples = 3}, {.t0 = 1, .tf = 2, .x0 = x0, .samples = 3}};
    moray_drive drive[2];
    for (int p = 0; p < 2; p++) {
        char text[200];
        memcpy(drive, good, sizeof good), drive[p].t0 = -INFINITY;
        snprintf(text, sizeof text, "guess of phase %s: from t = -inf to %d", p ? "on" : "out", 1 + p);
        check_refused(false, drive, MORAY_INPUT, text);
        memcpy(drive, good, sizeof good), drive[p].tf = INFINITY;
        snprintf(text, sizeof text, "guess of phase %s: from t = %d to inf", p ? "on" : "out", p);
        check_refused(false, drive, MORAY_INPUT, text);
        memcpy(drive, good, sizeof good), drive[p].tf = -3;
        snprintf(text, sizeof text, "guess of phase %s: from t = %d to -3", p ? "on" : "out", p);
        check_refused(false, drive, MORAY_INPUT, text);
        memcpy(drive, good, sizeof good), drive[p].samples = p ? 1 : -1;
        snprintf(text, sizeof text, "guess of phase %s: samples = %d: must be 0 or at least 2", p ? "on" : "out",
                 p ? 1 : -1);
        check_refused(false, drive, MORAY_INPUT, text);
    }
    memcpy(drive, good, sizeof good), drive[0].x0 = NULL;
    check_refused(false, drive, MORAY_INPUT, "guess of phase out: needs x0, for it is the first");
    memcpy(drive, good, sizeof good), drive[1].x0 = NULL;
    check_refused(true, drive, MORAY_INPUT, "guess of phase back: needs x0, for the phase before has other states");
    drive[1].x0 = begin, drive[0].x0 = lost;
    check_refused(true, drive, MORAY_NUMERIC, "guess of phase out: no slope at 0");
}

int main(void)
{
    test_samples(false);
    test_samples(true);
    test_without_controls();
    test_refused();
    return tap_done();
}
