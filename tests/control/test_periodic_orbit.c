// SPDX-License-Identifier: MIT
//
// Periodic orbits against closed forms: a forced oscillator, Van der Pol's limit cycle, Mathieu's equation, a pendulum
// that turns over.
#include "tap.h"

#include <string.h>

#include "moray/control/periodic_orbit.h"
#include "moray/num.h"

enum { MOST_STATES = 2, MOST_PARAMETERS = 4 };

// A plant of two states with its orbit.
typedef struct rig {
    moray_map plant, closing;
    moray_periodic_orbit *orbit;
    moray_periodic_orbit_info info;
} rig;

static void rig_set(rig *r, moray_complex_fn *plant, int ns, int outputs, const moray_closing_condition *condition,
                    int n, int intervals)
{
    static const double probe[MOST_STATES + MOST_PARAMETERS + 1] = {0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9};
    const int period = ns;
    *r = (rig){0};
    CHECK_OK(moray_map_from_complex(&r->plant, 2 + ns + 1, outputs, plant, NULL, NULL, probe), "plant");
    CHECK_OK(moray_closing_map(&r->closing, 2, ns, condition, n), "closing conditions");
    const moray_periodic_orbit_spec spec = {.nx = 2,
                                            .ns = ns,
                                            .plant = &r->plant,
                                            .closing = &r->closing,
                                            .found = &period,
                                            .n_found = n - 2,
                                            .scheme = "lobatto5",
                                            .intervals = intervals};
    CHECK_OK(moray_periodic_orbit_new(&r->orbit, &spec), "orbit");
}

static void rig_free(rig *r)
{
    moray_periodic_orbit_free(r->orbit);
    moray_map_release(&r->plant);
    moray_map_release(&r->closing);
}

static void rest(double t, double *x, const void *self)
{
    (void)t, (void)self;
    x[0] = x[1] = 0;
}
static const moray_periodic_orbit_guess at_rest = {.state = rest};

static const moray_closing_condition returns[] = {
    {MORAY_CLOSE_RETURNS, 0, 0}, {MORAY_CLOSE_RETURNS, 1, 0}, {MORAY_CLOSE_STARTS, 1, 0}};

// ---- A forced oscillator: x'' + c x' + k x = F cos(omega t), power c x'^2 ------------------------------------------

enum { DAMPING, STIFFNESS, FORCE, OMEGA };

static void oscillator(void *self, const moray_num *in, moray_num *out)
{
    const moray_num *x = in, *s = in + 2, t = in[6];
    (void)self;
    out[0] = x[1];
    out[1] = s[FORCE] * ccos(s[OMEGA] * t) - s[DAMPING] * x[1] - s[STIFFNESS] * x[0];
    out[2] = s[DAMPING] * x[1] * x[1];
}

// x = Re(A e^{i omega t}), A = F / (k - omega^2 + i c omega).
static double complex amplitude(const double s[4])
{
    return s[FORCE] / (s[STIFFNESS] - s[OMEGA] * s[OMEGA] + I * s[DAMPING] * s[OMEGA]);
}

static double mean_power(const double s[4])
{
    const double speed = cabs(amplitude(s)) * s[OMEGA];
    return s[DAMPING] * speed * speed / 2;
}

// The acceleration at a phase, as a fraction of the period.
static double acceleration(const double s[4], double phase)
{
    return creal(-s[OMEGA] * s[OMEGA] * amplitude(s) * cexp(2 * M_PI * I * phase));
}

static double start(const double s[4], double phase)
{
    (void)phase;
    return creal(amplitude(s));
}

static double power(const double s[4], double phase)
{
    (void)phase;
    return mean_power(s);
}

// Derivatives by s at constant phase, the period following omega, against differences of the closed form.
static void check_gradient(const double s[4], const double by[5], double (*exact)(const double *, double), double phase,
                           const char *what)
{
    const double T = 2 * M_PI / s[OMEGA], h = 1e-5;
    for (int k = 0; k < 4; k++) {
        double up[4], down[4];
        memcpy(up, s, sizeof up);
        memcpy(down, s, sizeof down);
        up[k] += h;
        down[k] -= h;
        const double found = by[k] + (k == OMEGA ? -by[4] * T / s[OMEGA] : 0);
        CHECK_RELATIVE(found, (exact(up, phase) - exact(down, phase)) / (2 * h), 1e-7, what);
    }
}

static void test_oscillator(void)
{
    static const double s[4] = {0.3, 2, 0.7, 1.3};
    const double T = 2 * M_PI / s[OMEGA], p[5] = {s[0], s[1], s[2], s[3], T};
    rig r;
    rig_set(&r, oscillator, 4, 3, returns, 2, 20);
    double worst = 0, by[5], M[4], slope[9] = {1};
    double complex lambda[2], exact = csqrt(s[DAMPING] * s[DAMPING] / 4 - s[STIFFNESS]) - s[DAMPING] / 2;
    CHECK_OK(moray_periodic_orbit_solve(r.orbit, p, &at_rest, &r.info), "found");
    CHECK(r.info.iterations <= 2 && r.info.residual < 1e-12, "a linear one in %d steps", r.info.iterations);
    for (int k = 0; k <= 50; k++) {
        const double t = T * k / 50;
        const double complex at = amplitude(s) * cexp(I * s[OMEGA] * t);
        double x[2];
        moray_periodic_orbit_state(r.orbit, t, x);
        worst = tap_worse(worst, fmax(fabs(x[0] - creal(at)), fabs(x[1] - creal(I * s[OMEGA] * at))));
    }
    CHECK(worst < 1e-8, "the forced motion, between nodes too: %.1e", worst);
    CHECK_RELATIVE(moray_periodic_orbit_integral(r.orbit, 2, T) / T, mean_power(s), 1e-10, "mean power");
    CHECK_OK(moray_periodic_orbit_monodromy(r.orbit, M), "monodromy");
    CHECK_RELATIVE(M[0] * M[3] - M[1] * M[2], exp(-s[DAMPING] * T), 1e-10, "its determinant, by Liouville");
    CHECK_OK(moray_periodic_orbit_multipliers(r.orbit, lambda), "multipliers");
    exact = cexp(exact * T);
    CHECK(cabs(lambda[0] - exact) < 1e-9 || cabs(lambda[0] - conj(exact)) < 1e-9, "e^{lambda T}: |%.9f|",
          cabs(lambda[0]));
    CHECK_OK(moray_periodic_orbit_ends_gradient(r.orbit, slope, by), "gradient of x(0)");
    check_gradient(s, by, start, 0, "d x(0)");
    CHECK_OK(moray_periodic_orbit_mean_gradient(r.orbit, 2, by), "gradient of the mean power");
    check_gradient(s, by, power, 0, "d power");
    CHECK_OK(moray_periodic_orbit_output_gradient(r.orbit, 1, 0.37 * T, by), "gradient of an acceleration");
    check_gradient(s, by, acceleration, 0.37, "d acceleration");
    rig_free(&r);
}

// ---- Van der Pol: x'' = mu (1 - x^2) x' - x, its divergence an output ----------------------------------------------

static void van_der_pol(void *self, const moray_num *in, moray_num *out)
{
    const moray_num *x = in, mu = in[2];
    (void)self;
    out[0] = x[1];
    out[1] = mu * (1 - x[0] * x[0]) * x[1] - x[0];
    out[2] = mu * (1 - x[0] * x[0]);
}

static void circle(double t, double *x, const void *self)
{
    const double T = *(const double *)self;
    x[0] = 2 * cos(2 * M_PI * t / T);
    x[1] = -2 * sin(2 * M_PI * t / T);
}

static double period_of(rig *r, double mu, double T, double *crest)
{
    const double p[2] = {mu, T};
    const moray_periodic_orbit_guess guess = {.state = circle, .self = &p[1]};
    double x[2];
    CHECK_OK(moray_periodic_orbit_solve(r->orbit, p, &guess, &r->info), "found");
    moray_periodic_orbit_state(r->orbit, 0, x);
    *crest = x[0];
    return moray_periodic_orbit_parameters(r->orbit)[1];
}

// T = 6.66328685933 and largest x = 2.00861986087 at mu = 1; T = 2 pi (1 + mu^2/16 - 5 mu^4/3072) for small mu.
static void test_van_der_pol(void)
{
    rig r;
    rig_set(&r, van_der_pol, 1, 3, returns, 3, 60);
    double complex lambda[2];
    double crest, by[2], slope[6] = {0}, crest_by[2], h = 1e-4, up[2], down[2];
    const double small = period_of(&r, 0.1, 6, &crest);
    CHECK_NEAR(small, 2 * M_PI * (1 + 0.01 / 16 - 5 * 1e-4 / 3072), 1e-6, "period at mu = 0.1");
    const double T = period_of(&r, 1, 6, &crest);
    CHECK_NEAR(T, 6.6632868593, 1e-8, "period at mu = 1");
    CHECK_NEAR(crest, 2.0086198609, 1e-8, "its crest");
    CHECK_OK(moray_periodic_orbit_multipliers(r.orbit, lambda), "multipliers");
    CHECK(cabs(lambda[0] - 1) < 1e-8, "one is 1: %.10f", creal(lambda[0]));
    CHECK_NEAR(creal(lambda[1]), exp(moray_periodic_orbit_integral(r.orbit, 2, T)), 1e-9, "the other, by Liouville");
    slope[5] = 1;
    CHECK_OK(moray_periodic_orbit_ends_gradient(r.orbit, slope, by), "gradient of the period");
    slope[5] = 0, slope[0] = 1;
    CHECK_OK(moray_periodic_orbit_ends_gradient(r.orbit, slope, crest_by), "gradient of the crest");
    up[0] = period_of(&r, 1 + h, T, &up[1]);
    down[0] = period_of(&r, 1 - h, T, &down[1]);
    CHECK_NEAR(by[0], (up[0] - down[0]) / (2 * h), 1e-6, "dT/dmu");
    CHECK_NEAR(crest_by[0], (up[1] - down[1]) / (2 * h), 1e-6, "d crest/dmu");
    CHECK(by[1] == 0 && crest_by[1] == 0, "a period that is found is no parameter");
    const double p[2] = {1.2, 1};
    CHECK_OK(moray_periodic_orbit_solve(r.orbit, p, NULL, &r.info), "mu = 1.2 from the last orbit and its period");
    CHECK(r.info.slopes <= 4, "in %d steps, %d by slopes of their own", r.info.iterations, r.info.slopes);
    rig_free(&r);
}

// ---- Mathieu: x'' + (a - 2 q cos 2t) x = 0, over its period pi -----------------------------------------------------

static void mathieu(void *self, const moray_num *in, moray_num *out)
{
    const moray_num *x = in, a = in[2], q = in[3], t = in[4];
    (void)self;
    out[0] = x[1];
    out[1] = -(a - 2 * q * ccos(2 * t)) * x[0];
}

// The characteristic values b_1(1) and a_1(1) bound a tongue of instability; from a_0(1) to b_1(1) all is stable.
static void test_mathieu(void)
{
    static const struct {
        double a, trace; // NAN: not a characteristic value
        bool stable;
    } samples[] = {{-0.1102488170, -2, true}, {1.8591080725, -2, true}, {-0.3, NAN, true}, {2.5, NAN, true},
                   {-0.5, NAN, false},        {0.5, NAN, false},        {1.8, NAN, false}};
    rig r;
    rig_set(&r, mathieu, 2, 2, returns, 2, 40);
    for (int k = 0; k < 7; k++) {
        const double p[3] = {samples[k].a, 1, M_PI};
        double M[4];
        double complex lambda[2];
        CHECK_OK(moray_periodic_orbit_solve(r.orbit, p, &at_rest, &r.info), "at rest");
        CHECK_OK(moray_periodic_orbit_monodromy(r.orbit, M), "monodromy");
        CHECK_OK(moray_periodic_orbit_multipliers(r.orbit, lambda), "multipliers");
        CHECK_NEAR(M[0] * M[3] - M[1] * M[2], 1, 1e-9, "nothing is damped");
        if (!isnan(samples[k].trace))
            CHECK_NEAR(M[0] + M[3], samples[k].trace, 1e-7, "trace at a characteristic value");
        else
            CHECK((cabs(lambda[0]) < 1 + 1e-8) == samples[k].stable, "a = %g: |multiplier| %.6f", samples[k].a,
                  cabs(lambda[0]));
    }
    rig_free(&r);
}

// ---- A pendulum that turns over: theta'' + c theta' + sin theta = torque -------------------------------------------

static void pendulum(void *self, const moray_num *in, moray_num *out)
{
    (void)self;
    out[0] = in[1];
    out[1] = in[3] - in[2] * in[1] - csin(in[0]);
}

static void spin(double t, double *x, const void *self)
{
    const double rate = *(const double *)self;
    x[0] = rate * t;
    x[1] = rate;
}

// The angle advances by 2 pi; the torque's work of a turn is what is damped; the multipliers are 1 and e^{-c T}.
static void test_pendulum(void)
{
    static const moray_closing_condition turn[] = {
        {MORAY_CLOSE_RETURNS, 0, 2 * M_PI}, {MORAY_CLOSE_RETURNS, 1, 0}, {MORAY_CLOSE_STARTS, 0, 0}};
    const double rate = 4, p[3] = {0.2, 0.8, 2 * M_PI / rate};
    const moray_periodic_orbit_guess guess = {.state = spin, .self = &rate};
    rig r;
    rig_set(&r, pendulum, 2, 2, turn, 3, 40);
    double complex lambda[2];
    double x[2], damped = 0;
    CHECK_OK(moray_periodic_orbit_solve(r.orbit, p, &guess, &r.info), "found");
    const double T = moray_periodic_orbit_parameters(r.orbit)[2];
    moray_periodic_orbit_state(r.orbit, T, x);
    CHECK_NEAR(x[0], 2 * M_PI, 1e-11, "over once");
    enum { n = 2000 };
    for (int k = 0; k < n; k++) { // a periodic integrand: the rectangle rule will do
        moray_periodic_orbit_state(r.orbit, T * k / n, x);
        damped += p[0] * x[1] * x[1] * T / n;
    }
    CHECK_NEAR(damped, p[1] * 2 * M_PI, 1e-8, "work of a turn");
    CHECK_OK(moray_periodic_orbit_multipliers(r.orbit, lambda), "multipliers");
    CHECK(cabs(lambda[0] - 1) < 1e-8, "one is 1: %.10f", creal(lambda[0]));
    CHECK_NEAR(creal(lambda[1]), exp(-p[0] * T), 1e-9, "the other e^{-c T}");
    rig_free(&r);
}

// ---- Units, further unknowns ---------------------------------------------------------------------------------------

// x(T) = e^w x(0), and x(0) = (1e6, 1e6): w is the growth of x' = a x in both states, a T.
static void grow(void *self, const moray_num *in, moray_num *out)
{
    (void)self;
    out[0] = in[2] * in[0];
    out[1] = in[2] * in[1];
}

static void growth(void *self, const moray_num *in, moray_num *out)
{
    const moray_num *x0 = in, *xT = in + 2, w = in[6];
    (void)self;
    out[0] = x0[0] - 1e6;
    out[1] = x0[1] - 1e6;
    out[2] = (xT[0] - cexp(w) * x0[0]) / 1e6;
}

static void stay(double t, double *x, const void *self)
{
    (void)t, (void)self;
    x[0] = x[1] = 1e6;
}

// In units of a million, which the scale tells; the closing conditions know an unknown of their own.
static void test_unknown(void)
{
    static const double probe[7] = {0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9}, scale[2] = {1e6, 1e6}, p[2] = {-0.4, 3};
    const double w = 0.1;
    const moray_periodic_orbit_guess guess = {.state = stay, .w = &w};
    rig r = {0};
    double by[2], slope[7] = {0};
    CHECK_OK(moray_map_from_complex(&r.plant, 4, 2, grow, NULL, NULL, probe), "plant");
    CHECK_OK(moray_map_from_complex(&r.closing, 7, 3, growth, NULL, NULL, probe), "closing conditions");
    const moray_periodic_orbit_spec spec = {.nx = 2,
                                            .ns = 1,
                                            .nw = 1,
                                            .plant = &r.plant,
                                            .closing = &r.closing,
                                            .scale = scale,
                                            .scheme = "gauss3",
                                            .intervals = 10};
    CHECK_OK(moray_periodic_orbit_new(&r.orbit, &spec), "orbit");
    CHECK_OK(moray_periodic_orbit_solve(r.orbit, p, &guess, &r.info), "found");
    CHECK_NEAR(moray_periodic_orbit_unknowns(r.orbit)[0], -1.2, 1e-9, "growth");
    slope[6] = 1;
    CHECK_OK(moray_periodic_orbit_ends_gradient(r.orbit, slope, by), "gradient of the growth");
    CHECK_NEAR(by[0], 3, 1e-8, "by the rate");
    CHECK_NEAR(by[1], -0.4, 1e-8, "by the period");
    rig_free(&r);
}

// ---- Refusals ------------------------------------------------------------------------------------------------------

static void refuses(moray_periodic_orbit_spec spec, const char *says)
{
    moray_periodic_orbit *orbit;
    const moray_status status = moray_periodic_orbit_new(&orbit, &spec);
    CHECK(status.code == MORAY_INPUT && strstr(status.text, says) && !orbit, "refused: %s", status.text);
}

static void test_specs(const rig *r)
{
    static const int twice[] = {1, 1};
    static const double scale[] = {1, -1};
    const moray_periodic_orbit_spec good = {.nx = 2,
                                            .ns = 1,
                                            .plant = &r->plant,
                                            .closing = &r->closing,
                                            .found = twice,
                                            .n_found = 1,
                                            .scheme = "radau3",
                                            .intervals = 10};
    moray_periodic_orbit_spec spec = good;
    moray_map closing;
    spec.nx = 0;
    refuses(spec, "orbit of 0 states");
    spec = good, spec.ns = 2;
    refuses(spec, "plant of 4 inputs");
    spec = good, spec.n_found = 0;
    refuses(spec, "closing conditions of 6 inputs and 3 outputs: must be 6 and 2");
    spec = good, spec.intervals = 0;
    refuses(spec, "intervals = 0");
    spec = good, spec.scheme = "euler";
    refuses(spec, "euler");
    spec = good, spec.scale = scale;
    refuses(spec, "scale[1] = -1");
    const moray_closing_condition four[] = {returns[0], returns[1], returns[2], returns[2]};
    CHECK_OK(moray_closing_map(&closing, 2, 1, four, 4), "four conditions");
    spec = good, spec.closing = &closing, spec.n_found = 2;
    refuses(spec, "found[1] = 1");
    moray_map_release(&closing);
    const moray_closing_condition same[] = {returns[0], returns[2], returns[2]};
    CHECK_OK(moray_closing_map(&closing, 2, 1, same, 3), "a condition twice");
    spec = good, spec.closing = &closing;
    refuses(spec, "do not determine the orbit");
    moray_map_release(&closing);
    CHECK(moray_closing_map(&closing, 1, 0, returns, 3).code == MORAY_INPUT && !closing.self, "a state out of range");
}

static void test_refusals(void)
{
    rig r;
    rig_set(&r, van_der_pol, 1, 3, returns, 3, 20);
    const double bad_period[] = {1, -6}, not_finite[] = {NAN, 6}, start_at[] = {1, 6};
    const moray_periodic_orbit_guess guess = {.state = circle, .self = &start_at[1]};
    double by[2], slope[6] = {0}, x[2], M[4];
    test_specs(&r);
    CHECK(moray_periodic_orbit_solve(r.orbit, start_at, NULL, &r.info).code == MORAY_INPUT, "no orbit to begin from");
    CHECK(moray_periodic_orbit_solve(r.orbit, bad_period, &guess, &r.info).code == MORAY_INPUT, "a period below 0");
    CHECK(moray_periodic_orbit_solve(r.orbit, not_finite, &guess, &r.info).code == MORAY_INPUT, "a parameter NaN");
    moray_periodic_orbit_state(r.orbit, 0, x);
    CHECK(isnan(x[0]) && isnan(moray_periodic_orbit_integral(r.orbit, 0, 1)) &&
              !moray_periodic_orbit_parameters(r.orbit) && !moray_periodic_orbit_unknowns(r.orbit),
          "nothing is told of no orbit");
    CHECK(moray_periodic_orbit_ends_gradient(r.orbit, slope, by).code == MORAY_INPUT &&
              moray_periodic_orbit_monodromy(r.orbit, M).code == MORAY_INPUT,
          "nor a derivative");
    CHECK_OK(moray_periodic_orbit_solve(r.orbit, start_at, &guess, &r.info), "found");
    CHECK(moray_periodic_orbit_mean_gradient(r.orbit, 3, by).code == MORAY_INPUT &&
              moray_periodic_orbit_output_gradient(r.orbit, -1, 0, by).code == MORAY_INPUT &&
              moray_periodic_orbit_output_gradient(r.orbit, 0, 99, by).code == MORAY_INPUT &&
              isnan(moray_periodic_orbit_integral(r.orbit, 3, 1)),
          "outputs and times that are not there");
    const moray_status status = moray_periodic_orbit_solve(r.orbit, start_at, &at_rest, &r.info);
    CHECK(moray_failed(status) && !moray_periodic_orbit_parameters(r.orbit), "from rest there is no period: %s",
          status.text);
    rig_free(&r);
    moray_periodic_orbit_free(NULL);
}

int main(void)
{
    test_oscillator();
    test_van_der_pol();
    test_mathieu();
    test_pendulum();
    test_unknown();
    test_refusals();
    return tap_done();
}
