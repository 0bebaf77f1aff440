// SPDX-License-Identifier: MIT
//
// Derivatives of what an orbit is by its parameters, where two parameters, or one and the period, and two further
// quantities are found and the closing conditions know all of them: against differences of orbits found anew.
#include "tap.h"

#include <string.h>

#include "moray/control/periodic_orbit.h"
#include "moray/num.h"

enum { NX = 2, NS = 3, NP = NS + 1, NW = 2, NOUT = NX + 2, FOUND = 2, INTERVALS = 6 };
enum { PLANT_IN = NX + NS + 1, CLOSING_IN = 2 * NX + NS + 1 + NW };
static const double given[NP] = {0.5, -0.3, 0.4, 2.1}, scale[NX] = {2, 0.5};

static int calls;

// Rates, a power and a mixture of everything.
static void plant_of(void *self, const moray_num *in, moray_num *out)
{
    const moray_num x = in[0], v = in[1], *s = in + NX, t = in[NX + NS];
    (void)self;
    calls++;
    out[0] = v + s[1] * x;
    out[1] = -2 * x - 0.7 * v - 0.2 * x * x * x + s[0] + s[2] * csin(t);
    out[2] = v * v * s[2] + x * t;
    out[3] = csin(x) * s[0] + v * s[1] * t + t * t;
}

// Returns multiplied and shifted by what is found: w_0 scales, w_1 shifts, and both tell of the two parameters.
static void closing_of(void *self, const moray_num *in, moray_num *out)
{
    const int *found = self;
    const moray_num *start = in, *end = in + NX, *p = in + 2 * NX, *w = in + 2 * NX + NP;
    out[0] = end[0] - start[0] * (1 + 0.1 * w[0] * w[0]) - 0.05 * p[2];
    out[1] = end[1] - start[1] - 0.1 * w[1] + 0.02 * p[0] * p[NS];
    out[2] = w[0] * w[0] - 0.9 - 0.1 * w[1] * p[1];
    out[3] = w[1] - 0.4 - 0.1 * start[1] + 0.05 * p[2];
    out[4] = p[found[0]] - given[found[0]] + 0.1 * end[0] * start[1] - 0.03 * p[2] * p[1];
    out[5] = p[found[1]] - given[found[1]] - 0.05 * end[1] + 0.02 * w[0];
}

static void start_at(double t, double *x, const void *self)
{
    (void)self;
    x[0] = 0.2 * cos(t);
    x[1] = -0.1 * sin(t);
}

typedef struct rig {
    moray_map plant, closing;
    moray_periodic_orbit *orbit;
    int found[FOUND];
} rig;

static void rig_new(rig *r, const int *found, const char *scheme)
{
    static const double probe[CLOSING_IN] = {0.3, 0.7, 0.4, 0.9, 1.1, 0.6, 0.5, 0.8, 0.2, 1.3};
    memcpy(r->found, found, sizeof r->found);
    CHECK_OK(moray_map_from_complex(&r->plant, PLANT_IN, NOUT, plant_of, NULL, NULL, probe), "plant");
    CHECK_OK(moray_map_from_complex(&r->closing, CLOSING_IN, NX + FOUND + NW, closing_of, r->found, NULL, probe),
             "closing conditions");
    const moray_periodic_orbit_spec spec = {.nx = NX,
                                            .ns = NS,
                                            .nw = NW,
                                            .plant = &r->plant,
                                            .closing = &r->closing,
                                            .found = found,
                                            .n_found = FOUND,
                                            .scale = scale,
                                            .scheme = scheme,
                                            .intervals = INTERVALS};
    CHECK_OK(moray_periodic_orbit_new(&r->orbit, &spec), "orbit");
}

static void rig_free(rig *r)
{
    moray_periodic_orbit_free(r->orbit);
    moray_map_release(&r->plant);
    moray_map_release(&r->closing);
}

static void solve(rig *r, const double *p, const double *w)
{
    const moray_periodic_orbit_guess guess = {.state = start_at, .w = w};
    moray_periodic_orbit_info info;
    CHECK_OK(moray_periodic_orbit_solve(r->orbit, p, &guess, &info), "found");
}

// ---- Quantities of an orbit ----------------------------------------------------------------------------------------

enum { OF_ENDS, OF_MEAN, OF_POINT, OF_OUTPUT, KINDS };
static const char *const names[KINDS] = {"of the ends", "mean of an output", "of a point", "an output"};
static const double ends_slope[2 * NX + NP + NW] = {0.7, -1.1, 0.4, 1.3, -0.6, 0.9, 0.35, -0.45, 1.7, -0.8};
static const double point_slope[PLANT_IN] = {1.2, -0.5, 0.8, 0.3, -0.9, 0.65};

// At a phase, of an output row.
static double quantity(rig *r, int kind, double phase, int row)
{
    const double *p = moray_periodic_orbit_parameters(r->orbit), *w = moray_periodic_orbit_unknowns(r->orbit);
    const double T = p[NS], t = phase * T;
    moray_num in[PLANT_IN], out[NOUT];
    double ends[2 * NX + NP + NW], x[NX], sum = 0;
    moray_periodic_orbit_state(r->orbit, t, x);
    if (kind == OF_MEAN)
        return moray_periodic_orbit_integral(r->orbit, row, T) / T;
    for (int i = 0; i < PLANT_IN; i++) {
        in[i] = i < NX ? x[i] : i < NX + NS ? p[i - NX] : t;
        sum += kind == OF_POINT ? point_slope[i] * creal(in[i]) : 0;
    }
    if (kind == OF_OUTPUT) {
        plant_of(NULL, in, out);
        return creal(out[row]);
    }
    moray_periodic_orbit_state(r->orbit, 0, ends);
    moray_periodic_orbit_state(r->orbit, T, ends + NX);
    memcpy(ends + 2 * NX, p, NP * sizeof *p);
    memcpy(ends + 2 * NX + NP, w, NW * sizeof *w);
    for (int i = 0; i < 2 * NX + NP + NW && kind == OF_ENDS; i++)
        sum += ends_slope[i] * ends[i];
    return sum;
}

static moray_status gradient(rig *r, int kind, double phase, int row, double *by)
{
    const double *p = moray_periodic_orbit_parameters(r->orbit), t = p ? phase * p[NS] : phase;
    switch (kind) {
    case OF_ENDS:
        return moray_periodic_orbit_ends_gradient(r->orbit, ends_slope, by);
    case OF_MEAN:
        return moray_periodic_orbit_mean_gradient(r->orbit, row, by);
    case OF_POINT:
        return moray_periodic_orbit_point_gradient(r->orbit, point_slope, t, by);
    default:
        return moray_periodic_orbit_output_gradient(r->orbit, row, t, by);
    }
}

static bool is_found(const rig *r, int k)
{
    return k == r->found[0] || k == r->found[1];
}

static double worst_gradient(rig *r, int kind, double phase, int row)
{
    const double h = 1e-4, w[NW] = {1, 0.3};
    double by[NP + 1], worst = 0;
    for (int k = 0; k <= NP; k++)
        by[k] = 77; // nothing is left of what was there
    solve(r, given, w);
    CHECK_OK(gradient(r, kind, phase, row, by), names[kind]);
    CHECK(by[NP] == 77, "nothing is written behind");
    for (int k = 0; k < NP; k++) {
        double at[2];
        for (int side = 0; side < 2 && !is_found(r, k); side++) {
            double p[NP];
            memcpy(p, given, sizeof p);
            p[k] += side ? h : -h;
            solve(r, p, w);
            at[side] = quantity(r, kind, phase, row);
        }
        worst = tap_worse(worst, fabs(by[k] - (is_found(r, k) ? 0 : (at[1] - at[0]) / (2 * h))));
    }
    return worst;
}

static void test_gradients(const int *found, const char *scheme)
{
    static const double phases[] = {0, 0.13, 0.5, 0.77, 1};
    rig r;
    rig_new(&r, found, scheme);
    for (int kind = 0; kind < KINDS; kind++)
        for (int k = 0; k < (kind == OF_ENDS ? 1 : kind == OF_MEAN ? NOUT : 5); k++) {
            const int row = kind == OF_OUTPUT || kind == OF_MEAN ? (k + 2) % NOUT : 0;
            const double worst = worst_gradient(&r, kind, phases[k], row);
            CHECK(worst < 1e-6, "%s, parameters %d and %d are found: %s at phase %g, off by %.1e", scheme, found[0],
                  found[1], names[kind], phases[k], worst);
        }
    rig_free(&r);
}

// ---- What is found -------------------------------------------------------------------------------------------------

// The side of w_0 is that of the guess, whatever has been asked of the orbit before; parameters that are found begin
// where p has them.
static void test_guesses(void)
{
    rig r;
    double by[NP], x[2][NX];
    rig_new(&r, (int[]){0, 2}, "lobatto4");
    for (int side = -1; side <= 1; side += 2) {
        solve(&r, given, (double[]){side * 0.9, 0.3});
        const double *w = moray_periodic_orbit_unknowns(r.orbit), *p = moray_periodic_orbit_parameters(r.orbit);
        CHECK_NEAR(w[0], side * sqrt(0.9 + 0.1 * w[1] * given[1]), 1e-10, "the root on its side");
        CHECK(p[1] == given[1] && p[NS] == given[NS] && fabs(p[0] - given[0]) > 1e-5 && fabs(p[2] - given[2]) > 1e-3,
              "the others stay: %g, %g, %g, %g", p[0], p[1], p[2], p[3]);
        moray_periodic_orbit_state(r.orbit, 0.7, x[0]);
        CHECK_OK(moray_periodic_orbit_output_gradient(r.orbit, 2, 0.4, by), "a gradient");
        CHECK_OK(moray_periodic_orbit_point_gradient(r.orbit, point_slope, 0.4, by), "another");
        solve(&r, given, (double[]){side * 1.1, 0.2});
        moray_periodic_orbit_state(r.orbit, 0.7, x[1]);
        for (int i = 0; i < NX; i++)
            CHECK_NEAR(x[1][i], x[0][i], 1e-10, "found again");
    }
    // A time that rounding has put behind the end is the end.
    const double period = moray_periodic_orbit_parameters(r.orbit)[NS];
    moray_periodic_orbit_state(r.orbit, period, x[0]);
    moray_periodic_orbit_state(r.orbit, nextafter(period, 9), x[1]);
    CHECK(memcmp(x[0], x[1], sizeof x[0]) == 0, "the end to the digit");
    // The integral of a rate is the way that the state has gone.
    double start[NX], end[NX];
    const double T = moray_periodic_orbit_parameters(r.orbit)[NS];
    for (int k = 0; k <= 10; k++) {
        moray_periodic_orbit_state(r.orbit, 0, start);
        moray_periodic_orbit_state(r.orbit, T * k / 10, end);
        for (int i = 0; i < NX; i++)
            CHECK_NEAR(moray_periodic_orbit_integral(r.orbit, i, T * k / 10), end[i] - start[i], 1e-10, "its way");
    }
    CHECK(isnan(moray_periodic_orbit_integral(r.orbit, -1, 1)) &&
              isnan(moray_periodic_orbit_integral(r.orbit, NOUT, 1)),
          "of outputs that there are");
    rig_free(&r);
}

// By whole messages; times from 0 to the period.
static void test_refused(void)
{
    rig r;
    char says[100];
    double by[NP];
    rig_new(&r, (int[]){1, NS}, "radau2");
    calls = 0;
    for (int kind = 0; kind < KINDS; kind++) {
        const moray_status status = gradient(&r, kind, 9, 0, by);
        CHECK(status.code == MORAY_INPUT && strcmp(status.text, "no orbit has been found yet") == 0, "%s: %s",
              names[kind], status.text);
    }
    CHECK(calls == 0, "nor is the plant asked: %d times", calls);
    solve(&r, given, (double[]){1, 0.3});
    const double T = moray_periodic_orbit_parameters(r.orbit)[NS];
    CHECK_OK(moray_periodic_orbit_monodromy(r.orbit, by), "slopes");
    calls = 0;
    for (int kind = OF_POINT; kind < KINDS; kind++) {
        static const double beyond[] = {-1e-9, 1 + 1e-9, NAN};
        for (int k = 0; k < 3; k++) {
            const moray_status status = gradient(&r, kind, beyond[k], 0, by);
            snprintf(says, sizeof says, "t = %g: must lie between 0 and the period, %g", beyond[k] * T, T);
            CHECK(status.code == MORAY_INPUT && strcmp(status.text, says) == 0, "%s", status.text);
        }
    }
    static const int rows[] = {-1, NOUT};
    for (int k = 0; k < 2; k++)
        for (int kind = OF_MEAN; kind < KINDS; kind += 2) {
            snprintf(says, sizeof says, "output %d of the plant: it has %d", rows[k], NOUT);
            const moray_status status = gradient(&r, kind, 0.5, rows[k], by);
            CHECK(status.code == MORAY_INPUT && strcmp(status.text, says) == 0, "%s", status.text);
        }
    CHECK(calls == 0, "again the plant is not asked: %d times", calls);
    rig_free(&r);
}

int main(void)
{
    static const int found[][FOUND] = {{0, 1}, {0, 2}, {1, NS}};
    static const char *const schemes[] = {"lobatto3", "radau2", "gauss2"};
    for (int k = 0; k < 3; k++)
        test_gradients(found[k], schemes[k]);
    test_guesses();
    test_refused();
    return tap_done();
}
