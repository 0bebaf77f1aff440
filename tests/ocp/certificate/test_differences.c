// SPDX-License-Identifier: MIT
//
// Derivatives of the programme that are off by a known amount, one at a time, along the three directions that they are
// asked along, in closed form.
#include "tap.h"

#include <string.h>

#include "moray/ocp.h"

#include "base/dense.h"
#include "ocp/certificate/differences.h"

enum { NS = 4, FIRST = 4, IN = FIRST + NS, OUT = 3, JAC = 8, HESS = 5, DIRECTIONS = 3 };
static int jac_row[JAC] = {0, 0, 0, 0, 1, 1, 1, 2}, jac_col[JAC] = {4, 5, 6, 7, 4, 5, 7, 6};
static int hess_row[HESS] = {4, 5, 5, 7, 7}, hess_col[HESS] = {4, 4, 5, 5, 7};
static const double at[NS] = {0.7, -1.2, 0, 2}, lambda[OUT] = {1, 1.5, -0.8}; // the first of the objective
static double corner, corner_in_use, off_jac[JAC], off_hess[HESS];
static enum { everywhere, here_alone, nowhere } defined;

static void value(void *self, const double *in, double *out)
{
    const double *s = in + FIRST;
    (void)self;
    out[0] = 40 * s[0] + 3 * s[0] * s[1] - 2 * s[1] * s[1] + corner * fabs(s[2]) + 5 * s[3] * s[3];
    out[1] = 7 * s[1] * s[3] + s[0] * s[0];
    out[2] = -4 * s[2];
    if (defined == nowhere || (defined == here_alone && memcmp(s, at, sizeof at)))
        out[0] = NAN;
}

// Without what is off.
static void slopes(const double *s, double *values)
{
    const double right[JAC] = {
        40 + 3 * s[1], 3 * s[0] - 4 * s[1], corner_in_use, 10 * s[3], 2 * s[0], 7 * s[3], 7 * s[1], -4};
    memcpy(values, right, sizeof right);
}

static void bends(const double *weight, double *values)
{
    const double right[HESS] = {2 * weight[1], 3 * weight[0], -4 * weight[0], 7 * weight[1], 10 * weight[0]};
    memcpy(values, right, sizeof right);
}

static void jacobian(void *self, const double *in, double *values)
{
    (void)self;
    slopes(in + FIRST, values);
    for (int k = 0; k < JAC; k++)
        values[k] += off_jac[k];
}

static void hessian(void *self, const double *in, const double *weight, double *values)
{
    (void)self, (void)in;
    bends(weight, values);
    for (int k = 0; k < HESS; k++)
        values[k] += off_hess[k];
}

static void still(const moray_node *node, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = 0 * node->x[0];
}

// Where a parameter stands in its box.
enum place { inside, at_lower, at_upper, fixed };

static moray_bounds box_of(enum place place, double x)
{
    return place == at_lower   ? moray_between(x, 60)
           : place == at_upper ? moray_between(-60, x)
           : place == fixed    ? moray_fixed(x)
                               : moray_between(-60, 60);
}

struct scales {
    double f, x; // of the objective, 0: none; of the parameters, 0: none
    bool rows;   // whether those of the solver stay
};

struct step {
    double size[NS], direction[NS];
};

static struct step step_along(const struct witness *w, const enum place *place, int which)
{
    struct step step;
    const struct transcription *t = w->solution->transcription;
    double size[400];
    moray_witness_columns(w, size);
    for (int j = 0; j < NS; j++) {
        const int column = t->layout.s + j;
        const double entry = moray_dense_entry(column, MORAY_DENSE_COLUMNS + which);
        step.size[j] = t->nlp.x_scale ? fmin(size[column], 1 / t->nlp.x_scale[column]) : size[column];
        const double inwards = which > 0 || place[j] == fixed ? 0 : place[j] == at_lower ? 1 : -1;
        step.direction[j] = 0.05 * fabs(entry) * step.size[j] * (place[j] == inside ? copysign(1, entry) : inwards);
    }
    return step;
}

static double disagree(double given, double found, double kink)
{
    return fmin(fabs(given - found - kink), fabs(given - found + kink)) / (1 + fabs(found));
}

static double expect_along(const struct transcription *t, const struct step *step, bool one_sided)
{
    double slope[JAC], bend[HESS], found[OUT] = {0}, given[OUT] = {0}, bent[NS] = {0}, told[NS] = {0}, worst = 0;
    const double f = t->nlp.f_scale > 0 ? t->nlp.f_scale : 1;
    slopes(at, slope);
    bends(lambda, bend);
    for (int k = 0; k < JAC; k++) {
        const double by = step->direction[jac_col[k] - FIRST];
        found[jac_row[k]] += (k == 2 ? 0 : slope[k]) * by;
        given[jac_row[k]] += (slope[k] + off_jac[k]) * by;
    }
    for (int k = 0; k < HESS; k++)
        for (int turn = 0; turn < 1 + (hess_row[k] != hess_col[k]); turn++) {
            const int i = (turn ? hess_col : hess_row)[k] - FIRST, j = (turn ? hess_row : hess_col)[k] - FIRST;
            bent[i] += f * step->size[i] * bend[k] * step->direction[j];
            told[i] += f * step->size[i] * (bend[k] + off_hess[k]) * step->direction[j];
        }
    const double kink = corner * fabs(step->direction[2]);
    for (int i = 0; i < OUT; i++) {
        const double scale = i == 0 ? f : t->nlp.g_scale ? t->nlp.g_scale[t->layout.events + i - 1] : 1;
        const double mean = found[i] + (i == 0 && one_sided ? kink : 0);
        worst = tap_worse(worst, disagree(scale * given[i], scale * mean, i == 0 && !one_sided ? scale * kink : 0));
    }
    for (int j = 0; j < NS; j++)
        worst = tap_worse(worst, disagree(told[j], bent[j], 0));
    return worst;
}

static double measured(const struct witness *w)
{
    struct transcription *t = w->solution->transcription;
    double worst = -1;
    snprintf(t->failure.text, sizeof t->failure.text, "as it was");
    t->failures = 7;
    CHECK_OK(moray_difference_solution(w, &worst), "differences");
    CHECK(!strcmp(t->failure.text, "as it was") && t->failures == 7, "no failure is told: %s", t->failure.text);
    CHECK(!memcmp(t->x, w->solution->iterate.x, (size_t)t->nlp.n * sizeof *t->x), "the caches are the solution's");
    return worst;
}

static void check_off(const struct witness *w, const enum place *place, const char *what)
{
    double expected = 0;
    moray_transcription_jacobians(w->solution->transcription, w->solution->iterate.x);
    for (int which = 0; which < DIRECTIONS; which++) {
        const struct step step = step_along(w, place, which);
        expected = tap_worse(expected, expect_along(w->solution->transcription, &step, which == 0));
    }
    const double worst = measured(w);
    // Doubts of 1e-9 that rounding leaves count 1e4 times.
    CHECK(fabs(worst - expected) <= 1e-5 * expected + 1e-9, "%s: %.9g, expected %.9g", what, worst, expected);
}

static void check_all(const struct witness *w, const enum place *place)
{
    corner = corner_in_use = 0;
    check_off(w, place, "nothing is off");
    for (int k = 0; k < JAC + HESS; k++)
        for (int sign = -1; sign <= 1; sign += 2) {
            double *off = k < JAC ? &off_jac[k] : &off_hess[k - JAC];
            *off = sign * 0.3;
            check_off(w, place, k < JAC ? "a first derivative" : "a second derivative");
            *off = 0;
        }
    static const double in_use[] = {2, -2, 0, 3.5, -3.7, 0.4, -0.5};
    corner = 2;
    for (size_t k = 0; k < sizeof in_use / sizeof *in_use; k++) {
        corner_in_use = in_use[k];
        check_off(w, place, "at a corner");
    }
    corner = corner_in_use = 0;
}

static void check_undefined(const struct witness *w)
{
    off_jac[0] = 5;
    defined = here_alone;
    CHECK(measured(w) == 0, "where functions are defined here alone nothing is said");
    off_jac[0] = 0;
    defined = nowhere;
    CHECK(isinf(measured(w)), "where they are not here nothing is right");
    defined = everywhere;
}

static void test_places(const enum place *place, struct scales scales)
{
    const moray_map map = {.n_in = IN,
                           .n_out = OUT,
                           .jac = {JAC, jac_row, jac_col},
                           .hess = {HESS, hess_row, hess_col},
                           .value = value,
                           .jacobian = jacobian,
                           .hessian = hessian};
    const moray_phase_spec phase = {
        .nx = 1, .continuous = still, .tf = moray_fixed(1), .x0 = MORAY_BOUNDS(moray_fixed(0))};
    const moray_ocp_spec spec = {.phases = 1,
                                 .phase = &phase,
                                 .ns = NS,
                                 .s = MORAY_BOUNDS(box_of(place[0], at[0]), box_of(place[1], at[1]),
                                                   box_of(place[2], at[2]), box_of(place[3], at[3])),
                                 .ne = OUT - 1,
                                 .e = MORAY_BOUNDS(moray_free(), moray_free()),
                                 .endpoint_map = &map};
    moray_settings settings = moray_settings_default();
    moray_ocp *ocp = NULL;
    moray_solution *solution = NULL;
    struct witness w;
    settings.max_iterations = 0;
    settings.intervals = 3;
    CHECK_OK(moray_ocp_new(&ocp, &spec), "parameters");
    CHECK_OK(moray_solve(ocp, &settings, NULL, &solution), "begun");
    struct transcription *t = solution->transcription;
    memset(solution->iterate.x, 0, (size_t)(4 * t->nlp.n + 2 * t->nlp.m) * sizeof(double));
    memcpy(solution->iterate.x + t->layout.s, at, sizeof at);
    memcpy(solution->iterate.lambda + t->layout.events, lambda + 1, sizeof lambda - sizeof *lambda);
    CHECK(moray_transcription_jacobians(t, solution->iterate.x), "finite");
    CHECK_OK(moray_witness_of_sizes(&w, solution), "sizes");
    t->nlp.f_scale = scales.f;
    for (int j = 0; j < NS; j++) // of which some are larger than the sizes
        t->scale[t->layout.s + j] = scales.x * (j % 2 ? 1 : 1e-3);
    t->nlp.x_scale = scales.x > 0 ? t->nlp.x_scale : NULL;
    t->nlp.g_scale = scales.rows ? t->nlp.g_scale : NULL;
    check_all(&w, place);
    check_undefined(&w);
    moray_witness_free(&w);
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

int main(void)
{
    static const enum place places[][NS] = {
        {inside, inside, inside, inside}, {inside, at_lower, inside, at_upper}, {at_upper, fixed, inside, at_lower}};
    static const struct scales scales[] = {{50, 7, true}, {0, 0, false}, {0.3, 3, true}};
    for (size_t k = 0; k < sizeof places / sizeof *places; k++)
        for (size_t s = 0; s < sizeof scales / sizeof *scales; s++)
            test_places(places[k], scales[s]);
    return tap_done();
}
