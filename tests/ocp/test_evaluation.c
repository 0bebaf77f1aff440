// SPDX-License-Identifier: MIT
//
// The programme's callbacks: what is said where a function is not finite, how often functions are asked, and the
// Hessian without the curvature of constraints. And patterns that are widened.
#include "tap.h"

#include <stdlib.h>
#include <string.h>
#include <tgmath.h>

#include "moray/ocp.h"
#include "ocp/transcription.h"
#include "ocp/widen.h"

enum { phases = 2, most = 200 };

// Where a number is beyond this, what is named by it is not finite, or shows more.
static const double beyond = 1e6;

static int asked;

static void go(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    const moray_num *x = at->x;
    asked++;
    out->f[0] = at->u[0] * x[1] + (creal(x[0]) > beyond ? x[0] * INFINITY : 0);
    out->f[1] = x[0] + 1e298 * sin(1e10 * (creal(x[1]) > beyond ? x[1] - creal(x[1]) : 0)) +
                (creal(at->u[0]) < -beyond ? x[1] : 0);
    out->c[0] = x[0] * x[0] + at->u[0];
    out->c[1] = at->u[0] * at->u[0] * at->s[0] + (creal(at->s[0]) > beyond ? x[1] * x[1] : 0);
    out->g[0] = at->u[0] * at->u[0] * x[1];
    out->g[1] = x[0] * at->s[0] * (creal(at->u[0]) > beyond ? NAN : 1);
}

static void see(const moray_node *at, moray_num *seen, const void *data)
{
    (void)data;
    seen[0] = at->x[1] + (creal(at->s[0]) > beyond ? at->x[0] * at->x[1] : 0);
}

static void pay(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    const moray_phase_ends *last = &at->phase[1];
    out->objective = at->phase[0].q[0] * last->q[1] + (creal(last->q[0]) > beyond ? INFINITY : 0);
    out->e[0] = last->xf[0] * at->s[0] + (creal(at->s[0]) > beyond ? last->xf[1] : 0);
    out->e[1] = at->phase[0].xf[1] + 10 * at->phase[0].t0 + last->tf + (creal(last->q[1]) > beyond ? NAN : 0);
}

static moray_ocp *make(const moray_map *endpoint)
{
    static const double time[] = {1.75, 1.125}, value[] = {0, 0};
    static const moray_bounds any[] = {{-MORAY_INFINITY, MORAY_INFINITY}, {-MORAY_INFINITY, MORAY_INFINITY}};
    static const char *const names[] = {"one", "two"}, *const e_names[] = {"first", "second"};
    moray_phase_spec phase[phases];
    for (int p = 0; p < phases; p++)
        phase[p] = (moray_phase_spec){.name = names[p],
                                      .nx = 2,
                                      .nu = 1,
                                      .nc = 2,
                                      .nq = 2,
                                      .continuous = go,
                                      .t0 = moray_fixed(0.5),
                                      .tf = moray_fixed(2 + p),
                                      .c = MORAY_BOUNDS_OF(any)};
    phase[1].observed =
        (moray_observations){.n = 2, .ny = 1, .time = time, .value = value, .observe = see, .events_only = true};
    moray_ocp *ocp;
    CHECK_OK(moray_ocp_new(&ocp, &(moray_ocp_spec){.name = "task",
                                                   .phases = phases,
                                                   .phase = phase,
                                                   .ns = 2,
                                                   .ne = 2,
                                                   .e = MORAY_BOUNDS_OF(any),
                                                   .e_names = e_names,
                                                   .endpoint = endpoint ? NULL : pay,
                                                   .endpoint_map = endpoint}),
             "a problem");
    return ocp;
}

static struct transcription *transcribe(const moray_ocp *ocp, int intervals)
{
    struct mesh mesh[phases];
    struct transcription *t;
    for (int p = 0; p < phases; p++)
        CHECK_OK(moray_mesh_uniform(&mesh[p], intervals, (struct method){MORAY_RADAU, 1}), "mesh");
    CHECK_OK(moray_transcription_new(&t, ocp, mesh), "transcribed");
    for (int p = 0; p < phases; p++)
        moray_mesh_free(&mesh[p]);
    return t;
}

static void fill(const struct transcription *t, double *x)
{
    unsigned long long seed = 3;
    for (int j = 0; j < t->nlp.n; j++)
        x[j] = tap_random(&seed, -1, 1);
}

// ---- Not finite ----

static void check_fails(struct transcription *t, int column, bool derivatives, const char *expected)
{
    double x[most], values[20 * most], lambda[most] = {0};
    const int before = t->failures;
    fill(t, x);
    x[column] = 2 * beyond;
    const bool told = t->nlp.objective(t, x, true, values);
    CHECK(told == derivatives && t->nlp.constraints(t, x, true, values) == derivatives, "values");
    CHECK(t->failures == before + (derivatives ? 0 : 2), "each is counted");
    CHECK(!t->nlp.gradient(t, x, true, values) && !t->nlp.jacobian(t, x, true, values) &&
              !t->nlp.hessian(t, x, true, 1, lambda, values),
          "derivatives");
    CHECK(t->failures == before + (derivatives ? 3 : 5) && t->failure.code == MORAY_NUMERIC &&
              strcmp(t->failure.text, expected) == 0,
          "%s", t->failure.text);
    fill(t, x);
    CHECK(t->nlp.hessian(t, x, true, 1, lambda, values) && t->nlp.constraints(t, x, true, values), "and then again");
}

static void test_not_finite(void)
{
    moray_ocp *ocp = make(NULL);
    struct transcription *t = transcribe(ocp, 4);
    const struct phase_layout *one = &t->layout.phase[0], *two = &t->layout.phase[1];
    check_fails(t, one->node[2].x, false, "dynamics of state x[0] of phase one is not finite at t = 1.25");
    check_fails(t, two->node[4].x, false, "dynamics of state x[0] of phase two is not finite at t = 3");
    check_fails(t, two->node[1].x + 2, false, "integrand g[1] of phase two is not finite at t = 1.125");
    check_fails(t, two->node[3].x + 1, true, "dynamics of state x[1] of phase two is not finite at t = 2.375");
    check_fails(t, two->q, false, "objective of task is not finite");
    check_fails(t, two->q + 1, false, "event second of task is not finite");
    moray_transcription_free(t);
    moray_ocp_free(ocp);
}

static void test_fixed_times(void)
{
    double x[most], g[most];
    moray_ocp *ocp = make(NULL);
    struct transcription *t = transcribe(ocp, 4);
    fill(t, x);
    CHECK(t->nlp.constraints(t, x, true, g), "constraints");
    CHECK_NEAR(g[t->layout.events + 1] - x[t->layout.phase[0].node[4].x + 1], 10 * 0.5 + 3, 1e-14, "fixed times");
    moray_transcription_free(t);
    moray_ocp_free(ocp);
}

// ---- How often functions are asked ----

static int asked_by(struct transcription *t, const double *x, bool derivatives)
{
    asked = 0;
    CHECK(derivatives ? moray_transcription_jacobians(t, x) : moray_transcription_values(t, x), "evaluated");
    return asked;
}

static void test_asked(void)
{
    double x[most];
    moray_ocp *ocp = make(NULL);
    struct transcription *t = transcribe(ocp, 4);
    fill(t, x);
    CHECK(asked_by(t, x, false) == 8, "once at each collocated node: %d", asked);
    CHECK(asked_by(t, x, false) == 0, "not again at the same point: %d", asked);
    CHECK(asked_by(t, x, true) > 8 && asked_by(t, x, true) == 0, "nor for derivatives: %d", asked);
    CHECK(asked_by(t, x, false) == 0, "nor for values afterwards: %d", asked);
    x[t->nlp.n - 1] += 1e-9;
    CHECK(asked_by(t, x, false) == 8 && asked_by(t, x, true) > 8, "but at another: %d", asked);
    moray_transcription_free(t);
    moray_ocp_free(ocp);
}

// ---- Inputs that keep their values ----

static const bool *held_by;
static bool held_now[6]; // x, u, s, t

static void hold(void *self, const bool *held)
{
    (void)self;
    held_by = held;
    if (held)
        memcpy(held_now, held, sizeof held_now);
}

// Parameters whose bounds meet, and time where every phase has its times fixed.
static void check_held(struct transcription *t, bool first, bool second, bool time)
{
    t->nlp.hold(t, true);
    const bool want[6] = {false, false, false, first, second, time};
    CHECK(held_by && memcmp(held_now, want, sizeof want) == 0, "parameters %d, %d and time %d are held: %d, %d, %d",
          first, second, time, held_now[3], held_now[4], held_now[5]);
    t->nlp.hold(t, false);
    CHECK(!held_by, "until it ends");
}

static void test_held(void)
{
    moray_ocp *ocp = make(NULL);
    struct transcription *t = transcribe(ocp, 2);
    moray_map with_hold = *t->phase[1].map;
    with_hold.hold = hold;
    t->phase[1].map = &with_hold;
    double *lower = t->bounds + t->layout.s, *upper = lower + t->layout.columns;
    check_held(t, false, false, true);
    lower[1] = upper[1] = 3;
    check_held(t, false, true, true);
    lower[0] = upper[0] = -1;
    check_held(t, true, true, true);
    upper[1] = 4;
    for (int p = 0; p < phases; p++)
        for (int end = 0; end < 2; end++) {
            int *column = end ? &t->layout.phase[p].tf : &t->layout.phase[p].t0;
            *column = 0; // free
            check_held(t, true, false, false);
            *column = absent;
        }
    check_held(t, true, false, true);
    moray_transcription_free(t);
    moray_ocp_free(ocp);
}

// ---- Without the curvature of constraints ----

static void test_gauss_newton(void)
{
    double x[most], lambda[most], of_integrals[most] = {0}, got[20 * most], want[20 * most], full[20 * most];
    moray_ocp *ocp = make(NULL);
    struct transcription *t = transcribe(ocp, 3);
    fill(t, x);
    for (int i = 0; i < t->nlp.m; i++)
        lambda[i] = 1 + 0.1 * i;
    for (int p = 0; p < phases; p++)
        for (int m = 0; m < 2; m++)
            of_integrals[t->layout.phase[p].integral_row + m] = lambda[t->layout.phase[p].integral_row + m];
    CHECK(t->nlp.hessian(t, x, true, 0.7, lambda, full) && t->nlp.hessian(t, x, true, 0.7, of_integrals, want),
          "as it is");
    t->gauss_newton = true;
    CHECK(t->nlp.hessian(t, x, true, 0.7, lambda, got), "and without constraints");
    double worst = 0, apart = 0;
    for (int k = 0; k < t->nlp.nnz_hess; k++) {
        worst = tap_worse(worst, fabs(got[k] - want[k]));
        apart = tap_worse(apart, fabs(got[k] - full[k]));
    }
    CHECK(worst == 0 && apart > 0.1, "integrals, which may stand in the objective, keep theirs: %g, %g", worst, apart);
    moray_transcription_free(t);
    moray_ocp_free(ocp);
}

// ---- Wider patterns ----

static void test_widen(void)
{
    double x[most];
    int found;
    moray_ocp *ocp = make(NULL);
    struct transcription *t = transcribe(ocp, 30);
    const moray_map *before[] = {ocp->phase[0].map, ocp->phase[1].map, ocp->phase[1].observed.map, ocp->endpoint->map};
    fill(t, x);
    CHECK(moray_transcription_values(t, x), "an ordinary point");
    CHECK_OK(moray_widen_patterns(t, &found), "looked at");
    CHECK(found == 0 && ocp->phase[0].map == before[0] && ocp->endpoint->map == before[3], "shows nothing new");
    x[t->layout.s] = 2 * beyond;
    CHECK(moray_transcription_values(t, x), "another");
    CHECK_OK(moray_widen_patterns(t, &found), "looked at");
    // Of each phase c[1] by x[1], bent by it, a square; of what is seen by x[0], bent by both, a product; of an event.
    CHECK(found == 2 * 3 + 4 + 1, "%d dependences are new", found);
    const moray_map *after[] = {ocp->phase[0].map, ocp->phase[1].map, ocp->phase[1].observed.map, ocp->endpoint->map};
    for (int k = 0; k < 4; k++)
        CHECK(after[k] != before[k] && after[k]->jac.nnz == before[k]->jac.nnz + 1, "map %d has one slope more", k);
    CHECK(t->phase[0].map == before[0] && t->phase[1].map == before[1], "transcribed it stays what it was");
    CHECK_OK(moray_widen_patterns(t, &found), "once more");
    CHECK(found == 0 && ocp->phase[1].map == after[1] && ocp->phase[1].observed.map == after[2], "nothing is left");
    fill(t, x);
    x[t->layout.phase[1].node[1].x + 2] = -2 * beyond;
    CHECK(moray_transcription_values(t, x), "a point that shows more at its first collocated node");
    CHECK_OK(moray_widen_patterns(t, &found), "looked at");
    CHECK(found == 1 && ocp->phase[0].map == after[0] && ocp->phase[1].map != after[1], "%d dependence of one phase",
          found);
    moray_transcription_free(t);
    moray_ocp_free(ocp);
}

// A map that the user gave and whose pattern leaves an input out.
static void told(void *self, const double *in, double *out)
{
    (void)self;
    out[0] = in[0] * in[1];
    out[1] = in[2];
    out[2] = in[3];
}

static void told_slopes(void *self, const double *in, double *values)
{
    (void)self;
    values[0] = in[1];
    values[1] = values[2] = 1;
}

static void told_curvatures(void *self, const double *in, const double *weight, double *values)
{
    (void)self, (void)in, (void)weight;
    values[0] = 0;
}

static void test_given_maps(void)
{
    int row[] = {0, 1, 2}, col[] = {0, 2, 3}, one[] = {0}, found;
    double x[most];
    const moray_map map = {.n_in = 18,
                           .n_out = 3,
                           .jac = {3, row, col},
                           .hess = {1, one, one},
                           .value = told,
                           .jacobian = told_slopes,
                           .hessian = told_curvatures};
    moray_ocp *ocp = make(&map);
    struct transcription *t = transcribe(ocp, 2);
    const moray_map *before = ocp->endpoint->map;
    fill(t, x);
    CHECK(moray_transcription_values(t, x), "a point");
    CHECK_OK(moray_widen_patterns(t, &found), "looked at");
    CHECK(found == 0 && ocp->endpoint->map == before, "what the user gave is left as it is");
    moray_transcription_free(t);
    moray_ocp_free(ocp);
}

int main(void)
{
    test_not_finite();
    test_fixed_times();
    test_asked();
    test_held();
    test_gauss_newton();
    test_widen();
    test_given_maps();
    return tap_done();
}
