// SPDX-License-Identifier: MIT
#include "tap.h"

#include <string.h>
#include <unistd.h>

#include "moray/sim.h"

// ---- Equations with known solutions --------------------------------------------------------------------------------

static bool decay(double t, const double *x, double *dx, void *self)
{
    (void)t, (void)self;
    dx[0] = -x[0];
    return true;
}

static bool oscillator(double t, const double *x, double *dx, void *self)
{
    (void)t, (void)self;
    dx[0] = x[1];
    dx[1] = -x[0];
    return true;
}

static const double eccentricity = 0.2;

// Two bodies: position and velocity relative to the attracting one, mean motion 1.
static bool kepler(double t, const double *x, double *dx, void *self)
{
    (void)t, (void)self;
    const double r = hypot(x[0], x[1]);
    dx[0] = x[2];
    dx[1] = x[3];
    dx[2] = -x[0] / (r * r * r);
    dx[3] = -x[1] / (r * r * r);
    return true;
}

// Prothero-Robinson: x = cos t for every rate; stiff for a large one.
static bool stiff(double t, const double *x, double *dx, void *self)
{
    const double *rate = self;
    dx[0] = -*rate * (x[0] - cos(t)) - sin(t);
    return true;
}

// Nothing but a quadrature: x = sin t.
static bool quadrature(double t, const double *x, double *dx, void *self)
{
    (void)x, (void)self;
    dx[0] = cos(t);
    return true;
}

// A slope of 1, and soon after the start a push that moves x by 1 more.
static bool early_push(double t, const double *x, double *dx, void *self)
{
    (void)x, (void)self;
    const double width = 0.0045, z = (t - 0.028) / width;
    dx[0] = 1 + exp(-z * z) / (width * sqrt(M_PI));
    return true;
}

// x' = -1/sqrt(x), x(0) = 1: x^(3/2) = 1 - 3t/2 reaches the end of the domain at t = 2/3.
static bool sinking(double t, const double *x, double *dx, void *self)
{
    (void)t, (void)self;
    if (x[0] <= 0)
        return false;
    dx[0] = -1 / sqrt(x[0]);
    return true;
}

// Like decay, but not defined below 0, where trial steps may look.
static bool positive_decay(double t, const double *x, double *dx, void *self)
{
    return decay(t, x, dx, self) && x[0] > 0;
}

// Bernoulli: x = 1/(1 - t), gone at t = 1.
static bool explosion(double t, const double *x, double *dx, void *self)
{
    (void)t, (void)self;
    dx[0] = x[0] * x[0];
    return true;
}

static bool not_finite(double t, const double *x, double *dx, void *self)
{
    (void)self;
    dx[0] = t > 0.5 ? NAN : x[0];
    return true;
}

// x' = slope of the piece; counts the questions asked beyond the end of the piece.
typedef struct piece {
    double slope, end;
    int beyond;
} piece;

static bool piecewise(double t, const double *x, double *dx, void *self)
{
    piece *now = self;
    now->beyond += t > now->end;
    dx[0] = now->slope * x[0];
    return true;
}

// ---- Help -----------------------------------------------------------------------------------------------------------

static moray_sim_settings with_tolerance(moray_sim_method method, double tolerance)
{
    moray_sim_settings settings = moray_sim_settings_default();
    settings.method = method;
    settings.rtol = settings.atol = tolerance;
    return settings;
}

static moray_sim *started(const moray_ode *ode, const moray_sim_settings *settings, const double *x0)
{
    moray_sim *sim = NULL;
    CHECK_OK(moray_sim_new(&sim, ode, settings), "simulator");
    CHECK_OK(moray_sim_start(sim, 0, x0), "start");
    return sim;
}

// Final x[0] at t; the number of steps too unless NULL.
static double simulate(const moray_ode *ode, const moray_sim_settings *settings, const double *x0, double t,
                       long *steps)
{
    moray_sim *sim = started(ode, settings, x0);
    CHECK_OK(moray_sim_advance(sim, t), "advance");
    CHECK(moray_sim_time(sim) == t, "stops exactly at t = %g", t);
    const double x = moray_sim_state(sim)[0];
    if (steps)
        *steps = moray_sim_get_statistics(sim).steps;
    moray_sim_free(sim);
    return x;
}

static moray_status failure(const moray_ode *ode, moray_sim_settings settings, double *x, double t, double *reached)
{
    moray_sim *sim = started(ode, &settings, x);
    const moray_status status = moray_sim_advance(sim, t);
    *reached = moray_sim_time(sim);
    *x = moray_sim_state(sim)[0];
    moray_sim_free(sim);
    return status;
}

// ---- Accuracy -------------------------------------------------------------------------------------------------------

static void test_explicit(void)
{
    const moray_sim_settings settings = moray_sim_settings_default();
    const double one[] = {1, 0}, zero = 0;
    double x = simulate(&(moray_ode){.n = 1, .rhs = decay}, &settings, one, 3, NULL);
    CHECK_NEAR(x, exp(-3), 1e-11, "exponential decay");
    x = simulate(&(moray_ode){.n = 2, .rhs = oscillator}, &settings, one, 200 * M_PI, NULL);
    CHECK_NEAR(x, 1, 2e-9, "harmonic oscillator after 100 periods");
    x = simulate(&(moray_ode){.n = 1, .rhs = quadrature}, &settings, &zero, 20, NULL);
    CHECK_NEAR(x, sin(20), 1e-9, "a right-hand side of t alone");
}

// Distance from the orbit's true position and velocity (mean anomaly t).
static double kepler_error(double t, const double *x)
{
    double E = t;
    for (int i = 0; i < 50; i++)
        E -= (E - eccentricity * sin(E) - t) / (1 - eccentricity * cos(E));
    const double b = sqrt(1 - eccentricity * eccentricity), dE = 1 / (1 - eccentricity * cos(E));
    const double truth[] = {cos(E) - eccentricity, b * sin(E), -sin(E) * dE, b * cos(E) * dE};
    double square = 0;
    for (int i = 0; i < 4; i++)
        square += (x[i] - truth[i]) * (x[i] - truth[i]);
    return sqrt(square);
}

static double oscillator_error(double t, const double *x)
{
    return hypot(x[0] - cos(t), x[1] + sin(t));
}

static double error_at(const moray_ode *ode, double (*error)(double, const double *), const double *x0,
                       const moray_sim_settings *settings, double t)
{
    moray_sim *sim = started(ode, settings, x0);
    CHECK_OK(moray_sim_advance(sim, t), "advance");
    const double e = error(t, moray_sim_state(sim));
    moray_sim_free(sim);
    return e;
}

static void test_tolerance(void)
{
    const moray_ode ode = {.n = 4, .rhs = kepler};
    const double x0[] = {1 - eccentricity, 0, 0, sqrt((1 + eccentricity) / (1 - eccentricity))};
    const moray_sim_settings loose = with_tolerance(MORAY_SIM_EXPLICIT, 1e-4);
    const moray_sim_settings tight = with_tolerance(MORAY_SIM_EXPLICIT, 1e-12);
    const double gain = error_at(&ode, kepler_error, x0, &loose, 20) / error_at(&ode, kepler_error, x0, &tight, 20);
    CHECK_NEAR(log10(gain) / 8, 1, 0.1, "the error is proportional to the tolerance over 8 decades");
}

// With tolerances so loose that the step limit binds, the step h is constant and the order shows.
static void test_order(void)
{
    const moray_ode nonlinear = {.n = 4, .rhs = kepler}, linear = {.n = 2, .rhs = oscillator};
    const double perihelion[] = {1 - eccentricity, 0, 0, sqrt((1 + eccentricity) / (1 - eccentricity))}, one[] = {1, 0};
    double explicit_error[2], tr_bdf2_error[2];
    for (int i = 0; i < 2; i++) {
        moray_sim_settings settings = with_tolerance(MORAY_SIM_EXPLICIT, 0.1);
        settings.max_step = 0.2 / (1 << i);
        explicit_error[i] = error_at(&nonlinear, kepler_error, perihelion, &settings, 10);
        settings = with_tolerance(MORAY_SIM_TR_BDF2, 1e-3);
        settings.max_step = 0.01 / (1 << i);
        tr_bdf2_error[i] = error_at(&linear, oscillator_error, one, &settings, 10);
    }
    // The pair's error terms of order 9 are so small (8e-6) that the slope here is that of order 9.
    const double slope = log2(explicit_error[0] / explicit_error[1]);
    CHECK(slope > 8, "order of RK8(7)13M at least 8: %.3g", slope);
    CHECK_NEAR(log2(tr_bdf2_error[0] / tr_bdf2_error[1]), 2, 0.02, "order of TR-BDF2");
}

// The same method in ARKODE, which shares nothing with ours but the tableau; both at the tolerance they were asked for.
static void test_against_arkode(void)
{
    const moray_ode ode = {.n = 4, .rhs = kepler};
    const double x0[] = {1 - eccentricity, 0, 0, sqrt((1 + eccentricity) / (1 - eccentricity))};
    for (int k = 4; k <= 12; k += 2) {
        const moray_sim_settings ours = with_tolerance(MORAY_SIM_EXPLICIT, pow(10, -k));
        const moray_sim_settings library = with_tolerance(MORAY_SIM_ARKODE, pow(10, -k));
        const double error = error_at(&ode, kepler_error, x0, &ours, 20);
        const double other = error_at(&ode, kepler_error, x0, &library, 20);
        CHECK(error < 200 * ours.rtol && other < 200 * ours.rtol, "tolerance %g: errors %.1e, ARKODE %.1e", ours.rtol,
              error, other);
    }
}

static void test_tr_bdf2(void)
{
    double rate = 1e6, errors[3];
    long steps[3];
    const moray_ode ode = {.n = 1, .rhs = stiff, .self = &rate};
    const double x0[] = {1};
    for (int i = 0; i < 3; i++) {
        const moray_sim_settings settings = with_tolerance(MORAY_SIM_TR_BDF2, pow(10, -4 - 2 * i));
        errors[i] = fabs(simulate(&ode, &settings, x0, 10, &steps[i]) - cos(10));
        CHECK(errors[i] < settings.rtol, "stiff problem, rate 1e6: error %.2g at tolerance %g", errors[i],
              settings.rtol);
    }
    CHECK(steps[0] < 2000, "stiffness does not limit the step: %ld steps over 10 s", steps[0]);
    const moray_sim_settings settings = with_tolerance(MORAY_SIM_TR_BDF2, 1e-8);
    const double one[] = {1, 0};
    const double x = simulate(&(moray_ode){.n = 2, .rhs = oscillator}, &settings, one, 2 * M_PI, NULL);
    CHECK_NEAR(x, 1, 1e-5, "harmonic oscillator over a period");
}

// ---- Stops, restarts ------------------------------------------------------------------------------------------------

static void test_discontinuity(void)
{
    for (int method = MORAY_SIM_EXPLICIT; method <= MORAY_SIM_TR_BDF2; method++) {
        piece now = {.slope = 1, .end = 1.3};
        const moray_ode ode = {.n = 1, .rhs = piecewise, .self = &now};
        const moray_sim_settings settings = with_tolerance(method, method == MORAY_SIM_TR_BDF2 ? 1e-7 : 1e-9);
        const double one = 1;
        moray_sim *sim = started(&ode, &settings, &one);
        CHECK_OK(moray_sim_advance(sim, now.end), "to the jump");
        now = (piece){.slope = -2, .end = 3.1, .beyond = now.beyond};
        CHECK_OK(moray_sim_start(sim, moray_sim_time(sim), moray_sim_state(sim)), "start again where it stands");
        CHECK_OK(moray_sim_advance(sim, now.end), "to the end");
        CHECK_NEAR(moray_sim_state(sim)[0], exp(1.3 - 2 * 1.8), method == MORAY_SIM_TR_BDF2 ? 1e-6 : 1e-10,
                   "two pieces");
        CHECK(now.beyond == 0, "never asked beyond the stop: %d times", now.beyond);
        moray_sim_free(sim);
    }
}

static const double push = 1e4;

// An oscillator pushed from a time on that nobody stops at.
static bool pushed(double t, const double *x, double *dx, void *self)
{
    const double *from = self;
    oscillator(t, x, dx, NULL);
    dx[1] += t > *from ? push : 0;
    return true;
}

static void test_jumps_within_steps(void)
{
    const moray_sim_settings settings = with_tolerance(MORAY_SIM_EXPLICIT, 1e-6);
    const double start[] = {1, 0};
    double worst = 0;
    for (int k = 0; k < 50; k++) {
        double from = 16 + 0.0137 * k;
        const double x = simulate(&(moray_ode){.n = 2, .rhs = pushed, .self = &from}, &settings, start, 17, NULL);
        const double error = x - (cos(17) + push * (1 - cos(17 - from)));
        worst = isnan(error) ? INFINITY : fmax(worst, fabs(error));
    }
    CHECK(worst < 1e-6 * push, "jumps are found and crossed: %.1e", worst);
}

// Between the stages of a first step over all of the way lies the push.
static void test_first_step(void)
{
    const moray_sim_settings settings = with_tolerance(MORAY_SIM_EXPLICIT, 1e-9);
    const double x = simulate(&(moray_ode){.n = 1, .rhs = early_push}, &settings, (double[]){1}, 1, NULL);
    CHECK_NEAR(x, 3, 1e-7, "a push soon after the start is not stepped over");
}

static void test_short_ways(void)
{
    const moray_ode ode = {.n = 1, .rhs = decay};
    const moray_sim_settings settings = moray_sim_settings_default();
    const double one = 1;
    moray_sim *sim = started(&ode, &settings, &one);
    CHECK_OK(moray_sim_advance(sim, 0), "to where it stands");
    CHECK(moray_sim_state(sim)[0] == 1, "nothing moves");
    CHECK_OK(moray_sim_advance(sim, 1), "advance");
    CHECK_OK(moray_sim_advance(sim, 1 + 1e-15), "an ulp or two");
    CHECK_OK(moray_sim_advance(sim, 1 + 1e-12), "a little more");
    CHECK_OK(moray_sim_advance(sim, 2), "advance");
    CHECK_NEAR(moray_sim_state(sim)[0], exp(-2), 1e-11, "decay in pieces");
    const moray_status status = moray_sim_advance(sim, 1.5);
    CHECK(status.code == MORAY_INPUT && strstr(status.text, "1.5"), "no way back: %s", status.text);
    CHECK_OK(moray_sim_start(sim, 0, &one), "used again");
    CHECK_OK(moray_sim_advance(sim, 2), "advance");
    CHECK_NEAR(moray_sim_state(sim)[0], exp(-2), 1e-11, "decay once more");
    moray_sim_free(sim);
    moray_sim_free(NULL);
}

// ---- Errors ---------------------------------------------------------------------------------------------------------

static void test_domain(void)
{
    const moray_ode ode = {.n = 1, .rhs = sinking};
    for (int method = MORAY_SIM_EXPLICIT; method <= MORAY_SIM_TR_BDF2; method++) {
        double x = 1, reached;
        moray_status status = failure(&ode, with_tolerance(method, 1e-8), &x, 1, &reached);
        CHECK(status.code == MORAY_NUMERIC && strstr(status.text, "outside its domain") &&
                  strstr(status.text, "0.6666"),
              "leaves its domain: %s", status.text);
        CHECK_NEAR(reached, 2. / 3, 1e-5, "stands at the last time reached");
        CHECK(x > 0 && x < 1e-3, "and state: %g", x);
    }
    double x = 1, reached;
    moray_status status =
        failure(&(moray_ode){.n = 1, .rhs = not_finite}, moray_sim_settings_default(), &x, 1, &reached);
    CHECK(status.code == MORAY_NUMERIC && strstr(status.text, "not finite"), "NaN: %s", status.text);
    CHECK_NEAR(x, exp(0.5), 1e-8, "state before the NaN");
    const double one = 1;
    const moray_sim_settings settings = moray_sim_settings_default();
    x = simulate(&(moray_ode){.n = 1, .rhs = positive_decay}, &settings, &one, 60, NULL);
    CHECK(x > 0 && x < 1e-9, "trial steps outside the domain are taken again: %g", x);
}

static void test_failures(void)
{
    double x = 1, reached;
    moray_status status =
        failure(&(moray_ode){.n = 1, .rhs = explosion}, moray_sim_settings_default(), &x, 2, &reached);
    CHECK(status.code == MORAY_NUMERIC && strstr(status.text, "t = 1"), "singular solution: %s", status.text);
    CHECK_NEAR(reached, 1, 1e-8, "stands before the singularity");
    moray_sim_settings settings = moray_sim_settings_default();
    settings.max_steps = 5;
    x = 1;
    status = failure(&(moray_ode){.n = 1, .rhs = decay}, settings, &x, 10, &reached);
    CHECK(status.code == MORAY_NUMERIC && strstr(status.text, "5 steps (max_steps)"), "step limit: %s", status.text);
    CHECK_NEAR(x, exp(-reached), 1e-9, "state at the step limit");
    moray_sim *sim;
    settings.rtol = 0;
    status = moray_sim_new(&sim, &(moray_ode){.n = 1, .rhs = decay}, &settings);
    CHECK(status.code == MORAY_INPUT && !sim && strstr(status.text, "rtol = 0"), "bad tolerance: %s", status.text);
    settings = moray_sim_settings_default();
    settings.atol = NAN;
    CHECK(moray_sim_settings_check(&settings).code == MORAY_INPUT, "atol NaN");
    settings = moray_sim_settings_default();
    settings.max_step = -1;
    CHECK(moray_sim_settings_check(&settings).code == MORAY_INPUT, "max_step -1");
    settings = moray_sim_settings_default();
    settings.max_steps = 0;
    status = moray_sim_settings_check(&settings);
    CHECK(status.code == MORAY_INPUT && strstr(status.text, "max_steps = 0"), "no steps: %s", status.text);
    settings = moray_sim_settings_paper();
    CHECK(settings.method == MORAY_SIM_TR_BDF2 && settings.rtol == 1e-4 && settings.atol == 1e-4 &&
              !moray_failed(moray_sim_settings_check(&settings)),
          "those of the paper are good");
    settings.method = MORAY_SIM_TR_BDF2 + 1;
    status = moray_sim_settings_check(&settings);
    CHECK(status.code == MORAY_INPUT && strstr(status.text, "method = 3"), "a method that is none: %s", status.text);
    status = moray_sim_new(&sim, &(moray_ode){.n = 0, .rhs = decay}, &settings);
    CHECK(status.code == MORAY_INPUT && strstr(status.text, "n = 0"), "no states: %s", status.text);
    settings = moray_sim_settings_default();
    CHECK_OK(moray_sim_new(&sim, &(moray_ode){.n = 1, .rhs = decay}, &settings), "simulator");
    x = INFINITY;
    status = moray_sim_start(sim, 0, &x);
    CHECK(status.code == MORAY_NUMERIC && strstr(status.text, "x[0] = inf"), "bad start: %s", status.text);
    moray_sim_free(sim);
}

// SUNDIALS writes to stderr unless told not to.
static void test_silence(void)
{
    FILE *caught = tmpfile();
    fflush(stderr);
    const int terminal = dup(STDERR_FILENO);
    dup2(fileno(caught), STDERR_FILENO);
    test_domain();
    test_failures();
    fflush(stderr);
    dup2(terminal, STDERR_FILENO);
    close(terminal);
    fseek(caught, 0, SEEK_END);
    CHECK(ftell(caught) == 0, "nothing on stderr through all these failures: %ld bytes", ftell(caught));
    fclose(caught);
}

// ---- The integrator -------------------------------------------------------------------------------------------------

typedef struct notes {
    int seen, stop_after;
    double worst;
} notes;

static bool note(double t, const double *x, void *self)
{
    notes *n = self;
    const double error = fabs(x[0] - cos(t));
    n->worst = error <= n->worst ? n->worst : error;
    return ++n->seen != n->stop_after;
}

static void test_integrator(void)
{
    const moray_sim_settings settings = moray_sim_settings_default();
    const moray_integrator integrator = moray_sim_integrator(&settings);
    const moray_ode ode = {.n = 2, .rhs = oscillator};
    enum { n = 301 };
    double times[n], x[] = {1, 0};
    for (int i = 0; i < n; i++)
        times[i] = 0.1 * i;
    notes all = {.stop_after = -1};
    CHECK_OK(integrator.run(&integrator, &ode, 0, 31, x, times, n, note, &all), "run");
    CHECK(all.seen == n, "all times observed: %d", all.seen);
    CHECK(all.worst < 1e-9, "as accurate between as at the end: %g", all.worst);
    CHECK_NEAR(x[0], cos(31), 1e-9, "state at the end");
    notes some = {.stop_after = 3};
    x[0] = 1, x[1] = 0;
    CHECK_OK(integrator.run(&integrator, &ode, 0, 31, x, times, n, note, &some), "run stopped by its observer");
    CHECK(some.seen == 3, "observer stops: %d", some.seen);
    CHECK_NEAR(x[0], cos(0.2), 1e-9, "state last observed");
    x[0] = 1, x[1] = 0;
    CHECK_OK(integrator.run(&integrator, &ode, 0, 1, x, NULL, 0, NULL, NULL), "nothing observed");
    CHECK_NEAR(x[1], -sin(1), 1e-10, "state at the end");
    moray_status status = integrator.run(&integrator, &ode, 0, 1, x, (double[]){0.5, 0.4}, 2, note, &some);
    CHECK(status.code == MORAY_INPUT && strstr(status.text, "times[1] = 0.4"), "times descend: %s", status.text);
    status = integrator.run(&integrator, &ode, 0, -1, x, NULL, 0, NULL, NULL);
    CHECK(status.code == MORAY_INPUT && strstr(status.text, "t1 = -1"), "back in time: %s", status.text);
}

int main(void)
{
    test_explicit();
    test_tolerance();
    test_order();
    test_against_arkode();
    test_tr_bdf2();
    test_discontinuity();
    test_jumps_within_steps();
    test_first_step();
    test_short_ways();
    test_silence();
    test_integrator();
    return tap_done();
}
