// SPDX-License-Identifier: MIT
//
// The first point of a solve, entry by entry: from bounds, from samples, and the times of phases.
#include "tap.h"

#include <stdlib.h>
#include <string.h>

#include "moray/ocp.h"
#include "ocp/solution.h"

#define FREE                                                                                                           \
    {                                                                                                                  \
        -MORAY_INFINITY, MORAY_INFINITY                                                                                \
    }
#define ABOVE(low)                                                                                                     \
    {                                                                                                                  \
        low, MORAY_INFINITY                                                                                            \
    }
#define BELOW(high)                                                                                                    \
    {                                                                                                                  \
        -MORAY_INFINITY, high                                                                                          \
    }

static void drift(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = 0.25 * at->u[0];
    out->f[1] = at->u[1] * at->s[1];
    out->g[0] = 3 * at->t;
    out->g[1] = at->u[0] + at->s[0];
}

static void verdict(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase[0].q[0];
}

static moray_solution *begin(moray_ocp **ocp, const moray_phase_spec *phase, int phases)
{
    moray_solution *solution = NULL;
    moray_settings settings = moray_settings_default();
    settings.max_iterations = 0;
    settings.scheme = "radau3";
    settings.intervals = 4;
    CHECK_OK(moray_ocp_new(ocp, &(moray_ocp_spec){.phases = phases,
                                                  .phase = phase,
                                                  .endpoint = verdict,
                                                  .ns = 2,
                                                  .s = MORAY_BOUNDS(moray_between(2, 5), moray_between(-2, 1))}),
             "problem");
    CHECK_OK(moray_solve(*ocp, &settings, NULL, &solution), "begun");
    return solution;
}

static const moray_phase_spec usual = {
    .nx = 2, .nu = 2, .nq = 2, .continuous = drift, .t0 = {1, 1}, .tf = {3, 3}, .u = MORAY_BOUNDS({-1, 4}, {-2, 0})};

// What stood there before has no part in a guess.
static double *nonsense(int n)
{
    double *x = calloc((size_t)n, sizeof *x);
    for (int j = 0; j < n; j++)
        x[j] = 1000 + j;
    return x;
}

// ---- From bounds: straight from end to end ----

static const struct line {
    moray_bounds x0, xf;
    double first, last;
} lines[] = {
    {{1, 1}, {4, 4}, 1, 4},       {{0, 2}, {4, 8}, 1, 6},   {FREE, {3, 3}, 3, 3},      {{2, 2}, FREE, 2, 2},
    {ABOVE(2), {5, 5}, 5, 5},     {ABOVE(2), {1, 1}, 2, 1}, {BELOW(2), {5, 5}, 2, 5},  {{1, 1}, BELOW(-2), 1, -2},
    {{1, 1}, ABOVE(-2), 1, 1},    {ABOVE(2), FREE, 2, 2},   {FREE, BELOW(-3), -3, -3}, {FREE, FREE, 0, 0},
    {ABOVE(2), BELOW(-3), 2, -3}, {{1, 3}, ABOVE(0), 2, 2}, {{-7, -5}, {1, 1}, -6, 1}, {ABOVE(2), ABOVE(5), 2, 5},
    {BELOW(2), BELOW(-5), 2, -5}, {{1, 1}, BELOW(3), 1, 1},
};

static void test_lines(void)
{
    for (size_t k = 0; k < sizeof lines / sizeof *lines; k++) {
        const struct line *line = &lines[k];
        moray_phase_spec phase = usual;
        const moray_bounds x0[] = {{9, 9}, line->x0}, xf[] = {{-1, -1}, line->xf};
        phase.x0 = (moray_bounds_list){x0, 2}, phase.xf = (moray_bounds_list){xf, 2};
        moray_ocp *ocp;
        moray_solution *solution = begin(&ocp, &phase, 1);
        struct transcription *t = solution->transcription;
        const struct phase_layout *layout = &t->layout.phase[0];
        double *x = nonsense(t->nlp.n);
        CHECK_OK(moray_fill_guess(t, NULL, x), "from bounds");
        for (int n = 0; n < layout->nodes; n++) {
            const double tau = layout->node[n].tau, *at = x + layout->node[n].x;
            CHECK(fabs(at[0] - (9 - 10 * tau)) < 1e-12 &&
                      fabs(at[1] - line->first - (line->last - line->first) * tau) < 1e-12,
                  "line %zu at %g: %g", k, tau, at[1]);
            CHECK(n == 0 || (at[2] == 1.5 && at[3] == -1), "controls in the middle");
        }
        CHECK(x[t->layout.s] == 3.5 && x[t->layout.s + 1] == -0.5, "parameters in the middle");
        CHECK(fabs(x[layout->q] - 12) < 1e-12 && fabs(x[layout->q + 1] - 10) < 1e-12,
              "integrals are what they come to");
        free(x);
        moray_solution_free(solution);
        moray_ocp_free(ocp);
    }
}

// ---- Times ----

static const struct span {
    moray_bounds t0, tf, duration;
    double first, last;
    bool has_duration;
} spans[] = {
    {{0, 0}, {0.5, 6}, FREE, 0, 3.25, false},
    {{1, 2}, {4, 6}, FREE, 1.5, 5, false},
    {{0, 4}, {0, 4}, FREE, 0, 4, false}, // no length: all that there is
    {{0, 4.001}, {0, 4.007}, FREE, 0, 4.007, false},
    {{0, 4}, {0, 4.1}, FREE, 2, 2.05, false}, // a little
    {{1, 5}, {0, 4}, FREE, 1, 4, false},
    {BELOW(5), {2, 2}, FREE, 1, 2, false},
    {{3, 3}, ABOVE(2), FREE, 3, 4, false},
    {{3, 3}, ABOVE(7), FREE, 3, 7, false},
    {{2, 4}, ABOVE(2), FREE, 3, 4, false},
    {{3, 3}, {2, 1e15}, FREE, 3, 4, false}, // endless
    {ABOVE(2), ABOVE(5), FREE, 2, 5, false},
    {{0, 10}, {0, 10}, {4, 10}, 0, 10, true}, // as long as may be
    {{0, 2}, {4, 8}, {5, 9}, 1, 6, true},     // as short
    {{0, 10}, {0, 10}, {4.5, 5.5}, 0, 5, true},
    {{0, 10}, {0, 10}, {4.5, 11}, 0, 10, true},
    {{0, 2}, {2, 4}, {3, 4}, 0.5, 4, true},
    {{0, 0}, {2, 4}, {1, 2.5}, 0, 2.25, true}, // the end is in the middle of what the duration leaves
};

static void test_spans(void)
{
    for (size_t k = 0; k < sizeof spans / sizeof *spans; k++) {
        const struct span *span = &spans[k];
        moray_phase_spec phase = usual;
        phase.t0 = span->t0, phase.tf = span->tf;
        if (span->has_duration)
            phase.duration = span->duration;
        moray_ocp *ocp;
        moray_solution *solution = begin(&ocp, &phase, 1);
        struct transcription *t = solution->transcription;
        double *x = nonsense(t->nlp.n), t0, tf;
        CHECK_OK(moray_fill_guess(t, NULL, x), "from bounds");
        moray_layout_span(&t->layout, t->ocp, x, 0, &t0, &tf);
        CHECK(fabs(t0 - span->first) < 1e-12 && fabs(tf - span->last) < 1e-12, "case %zu: from %g to %g", k, t0, tf);
        free(x);
        moray_solution_free(solution);
        moray_ocp_free(ocp);
    }
}

// Phases share what lies between; one that may begin at any late time begins where the one before it ends.
static void test_turns(void)
{
    static const struct {
        moray_bounds t0[3], tf[3];
        double at[3][2];
    } cases[] = {{{{0, 6}, {0, 6}, {0, 6}}, {{0, 6}, {0, 6}, {0, 6}}, {{0, 2}, {2, 4}, {4, 6}}},
                 {{{2, 8}, {2, 8}, {2, 8}}, {{2, 8}, {2, 8}, {2, 8}}, {{2, 4}, {4, 6}, {6, 8}}},
                 {{{0, 0}, {1, 1e15}, ABOVE(0)}, {{2, 2}, {1, 9}, ABOVE(0)}, {{0, 2}, {2, 5}, {5, 6}}},
                 {{{0, 0}, ABOVE(0), ABOVE(0)}, {{2, 2}, ABOVE(0), ABOVE(0)}, {{0, 2}, {2, 3}, {3, 4}}},
                 {{{0, 0}, ABOVE(0), ABOVE(7)}, {{1, 3}, {5, 7}, ABOVE(0)}, {{0, 2}, {2, 6}, {7, 8}}}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        moray_phase_spec phase[3] = {usual, usual, usual};
        for (int p = 0; p < 3; p++)
            phase[p].t0 = cases[k].t0[p], phase[p].tf = cases[k].tf[p];
        moray_ocp *ocp;
        moray_solution *solution = begin(&ocp, phase, 3);
        struct transcription *t = solution->transcription;
        double *x = nonsense(t->nlp.n), t0, tf;
        CHECK_OK(moray_fill_guess(t, NULL, x), "from bounds");
        for (int p = 0; p < 3; p++) {
            moray_layout_span(&t->layout, t->ocp, x, p, &t0, &tf);
            CHECK(fabs(t0 - cases[k].at[p][0]) < 1e-12 && fabs(tf - cases[k].at[p][1]) < 1e-12,
                  "case %zu: phase %d from %g to %g", k, p, t0, tf);
        }
        free(x);
        moray_solution_free(solution);
        moray_ocp_free(ocp);
    }
}

// ---- From samples ----

enum { samples = 5 };
static const double when[] = {-4, -3, -3, 1, 6}, where[] = {0, 5, 2, 7, -6, 1, 4, 3, 9, -2}, // jumps at -3
    pushed[] = {0, -1, 1, 0, -1, -2, 3, 0, 0.5, -0.5};

static double between(const double *v, int width, int i, double time)
{
    const int k = time <= -3 ? 0 : time <= 1 ? 2 : 3;
    const double part = (time - when[k]) / (when[k + 1] - when[k]);
    return v[k * width + i] + part * (v[(k + 1) * width + i] - v[k * width + i]);
}

static void test_samples(void)
{
    moray_phase_spec phase = usual;
    phase.t0 = moray_between(-9, 0), phase.tf = moray_between(2, 9);
    moray_ocp *ocp;
    moray_solution *solution = begin(&ocp, &phase, 1);
    struct transcription *t = solution->transcription;
    const struct phase_layout *layout = &t->layout.phase[0];
    double *x = nonsense(t->nlp.n);
    const moray_samples table = {samples, when, where, pushed};
    CHECK_OK(moray_fill_guess(t, &(moray_guess){.phase = &table, .s = (double[]){4, 0.5}}, x), "from samples");
    CHECK(x[layout->t0] == -4 && x[layout->tf] == 6, "times of the first and the last");
    CHECK(x[t->layout.s] == 4 && x[t->layout.s + 1] == 0.5, "parameters as they are");
    for (int n = 0; n < layout->nodes; n++) {
        const double time = -4 + 10 * layout->node[n].tau, *at = x + layout->node[n].x;
        double off = 0;
        for (int i = 0; i < 2; i++) {
            off = tap_worse(off, fabs(at[i] - between(where, 2, i, time)));
            if (n > 0)
                off = tap_worse(off, fabs(at[2 + i] - between(pushed, 2, i, time)));
        }
        CHECK(off < 1e-12, "at %g what is between the samples: %.1e", time, off);
    }
    const moray_samples one = {1, when, where, pushed};
    CHECK_OK(moray_fill_guess(t, &(moray_guess){.phase = &one, .s = (double[]){40, 0.5}}, x), "from one");
    CHECK(x[layout->node[5].x + 1] == 5 && x[layout->node[5].x + 3] == -1, "it is so all along");
    CHECK(x[layout->tf] == 2 && x[t->layout.s] == 5, "within bounds");
    free(x);
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

static void check_refusal(struct transcription *t, const moray_samples *table, const double *s, const char *text)
{
    double *x = nonsense(t->nlp.n);
    const moray_status status = moray_fill_guess(t, &(moray_guess){.phase = table, .s = s}, x);
    CHECK(status.code == MORAY_INPUT && strstr(status.text, text), "refused: %s", status.text);
    free(x);
}

static void test_refusals(void)
{
    moray_phase_spec phase = usual;
    phase.name = "way";
    moray_ocp *ocp;
    moray_solution *solution = begin(&ocp, &phase, 1);
    struct transcription *t = solution->transcription;
    const moray_samples lacking[] = {{-1, when, where, pushed},
                                     {samples, NULL, where, pushed},
                                     {samples, when, NULL, pushed},
                                     {samples, when, where, NULL}};
    for (int k = 0; k < 4; k++)
        check_refusal(t, &lacking[k], NULL, "guess of phase way: times, states or controls are missing");
    for (int what = 0; what < 3; what++)
        for (int i = 0; i < (what ? 2 : 1); i++) {
            double time[samples], x[2 * samples], u[2 * samples];
            memcpy(time, when, sizeof time), memcpy(x, where, sizeof x), memcpy(u, pushed, sizeof u);
            *(what == 0 ? &time[3] : what == 1 ? &x[6 + i] : &u[6 + i]) = i ? INFINITY : NAN;
            check_refusal(t, &(moray_samples){samples, time, x, u}, NULL, "guess of phase way: sample 3 is not finite");
        }
    const double back[] = {-4, -3, -3.5, 1, 6};
    check_refusal(t, &(moray_samples){samples, back, where, pushed}, NULL,
                  "time -3.5 of sample 2 is before the one of sample 1");
    check_refusal(t, NULL, (double[]){3, NAN}, "parameter 1 is not finite");
    check_refusal(t, NULL, (double[]){INFINITY, 0}, "parameter 0 is not finite");
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

// A final time that nothing bounds is that of the samples.
static void test_endless(void)
{
    moray_phase_spec phase = usual;
    phase.tf = moray_at_least(2);
    moray_ocp *ocp;
    moray_solution *solution = begin(&ocp, &phase, 1);
    struct transcription *t = solution->transcription;
    double *x = nonsense(t->nlp.n);
    const moray_samples table = {samples, when, where, pushed};
    CHECK_OK(moray_fill_guess(t, &(moray_guess){.phase = &table}, x), "from samples");
    CHECK(x[t->layout.phase[0].tf] == 6, "until %g", x[t->layout.phase[0].tf]);
    free(x);
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

// ---- Without controls ----

static void fall(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = at->x[0];
}

static void lands(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase[0].xf[0];
}

static void test_uncontrolled(void)
{
    const moray_phase_spec phase = {.nx = 1, .continuous = fall, .tf = moray_fixed(1)};
    const moray_samples table = {2, (double[]){0, 1}, (double[]){5, 7}, NULL};
    moray_ocp *ocp;
    moray_solution *solution = NULL;
    CHECK_OK(moray_ocp_new(&ocp, &(moray_ocp_spec){.phases = 1, .phase = &phase, .endpoint = lands}), "problem");
    moray_settings settings = moray_settings_default();
    settings.max_iterations = 0;
    CHECK_OK(moray_solve(ocp, &settings, &(moray_guess){.phase = &table}, &solution), "it needs none");
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

int main(void)
{
    test_lines();
    test_spans();
    test_turns();
    test_samples();
    test_endless();
    test_refusals();
    test_uncontrolled();
    return tap_done();
}
