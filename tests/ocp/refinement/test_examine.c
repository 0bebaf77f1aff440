// SPDX-License-Identifier: MIT
//
// What an interval's error and its violations are, at an iterate set by hand: against integrals of another quadrature
// and distances in closed form.
#include "tap.h"

#include <string.h>

#include "moray/ocp.h"

#include "ocp/refinement/examine.h"

enum { NX = 2, NC = 2, OUT = NX + NC + 1, FINE = 20000 };
static const double START = 3, SPAN = 4, SHIFT = 0.7;

// Rates of time alone, which no scheme of few stages hits.
struct rates {
    double f[NX], g, row; // of sines; of the second row
    double nan_after;     // a time, once begun
    bool begun;
};

static double wave(double t, int i)
{
    return sin((5 + 3 * i) * t + SHIFT * i);
}

static void rates_at(const moray_node *at, moray_rates *out, const void *data)
{
    const struct rates *rates = data;
    const moray_num t = at->t;
    out->f[0] = rates->f[0] * csin(5 * t);
    out->f[1] = rates->f[1] * csin(8 * t + SHIFT);
    out->c[0] = 0 * at->x[0];
    out->c[1] = rates->row * (t - START);
    out->g[0] = rates->g * csin(11 * t + 2 * SHIFT) + (rates->begun && creal(t) > rates->nan_after ? NAN : 0);
}

static void total(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase[0].q[0];
}

struct trial {
    moray_ocp *ocp;
    moray_solution *solution;
    struct witness w;
    struct examiner e;
};

// States at the nodes: constant but for the rates, so that what is between them is known.
static void begin(struct trial *of, struct rates *rates, const moray_bounds x[NX], const double level[NX])
{
    const moray_phase_spec phase = {.nx = NX,
                                    .nu = 1,
                                    .nc = NC,
                                    .nq = 1,
                                    .continuous = rates_at,
                                    .t0 = moray_fixed(START),
                                    .tf = moray_fixed(START + SPAN),
                                    .x = moray_bounds_of(x, NX),
                                    .c = MORAY_BOUNDS(moray_between(-1, 1), moray_between(-2.5, 1.5))};
    moray_settings settings = moray_settings_default();
    *of = (struct trial){0};
    settings.max_iterations = 0;
    settings.intervals = 6;
    CHECK_OK(moray_ocp_new(&of->ocp, &(moray_ocp_spec){.phases = 1, .phase = &phase, .endpoint = total, .data = rates}),
             "problem");
    CHECK_OK(moray_solve(of->ocp, &settings, NULL, &of->solution), "begun");
    rates->begun = true;
    struct transcription *t = of->solution->transcription;
    memset(of->solution->iterate.x, 0, (size_t)(4 * t->nlp.n + 2 * t->nlp.m) * sizeof(double));
    for (int n = 0; n < t->layout.phase[0].nodes; n++)
        memcpy(of->solution->iterate.x + t->layout.phase[0].node[n].x, level, NX * sizeof *level);
    of->solution->iterate.x[t->layout.phase[0].q] = -6;
    moray_transcription_jacobians(t, of->solution->iterate.x);
    CHECK_OK(moray_witness_of_sizes(&of->w, of->solution), "sizes");
    CHECK_OK(moray_examiner_new(&of->e, &of->w, 0), "examiner");
}

static void end(struct trial *of)
{
    moray_examiner_free(&of->e);
    moray_witness_free(&of->w);
    moray_solution_free(of->solution);
    moray_ocp_free(of->ocp);
}

// The polynomial through a wave at the collocated nodes of an interval, by Lagrange.
static double through(const struct phase_layout *layout, const struct interval *interval, int i, double tau)
{
    double sum = 0;
    for (int j = interval->scheme->first; j <= interval->scheme->last; j++) {
        const double at = layout->node[interval->first + j].tau;
        double product = wave(START + SPAN * at, i);
        for (int k = interval->scheme->first; k <= interval->scheme->last; k++) {
            const double other = layout->node[interval->first + k].tau;
            product *= k == j ? 1 : (tau - other) / (at - other);
        }
        sum += product;
    }
    return sum;
}

static double integral_of(const struct phase_layout *layout, const struct interval *interval, int i)
{
    double sum = 0;
    const double start = layout->node[interval->first].tau, step = interval->width / FINE;
    for (int k = 0; k < FINE; k++) {
        const double tau = start + (k + 0.5) * step;
        sum += SPAN * step * fabs(through(layout, interval, i, tau) - wave(START + SPAN * tau, i));
    }
    return sum;
}

// The worst of two states and an integral is each of them in turn.
static void test_error(struct rates *rates)
{
    const moray_bounds free[] = {moray_free(), moray_free()};
    struct trial of;
    begin(&of, rates, free, (double[]){-20, 30});
    const struct phase_layout *layout = &of.solution->transcription->layout.phase[0];
    const struct phase_witness *w = &of.w.phase[0];
    const double size[] = {20 + w->size[0], 30 + w->size[1], 6 + w->integral[0]};
    for (int i = 0; i <= NX; i++)
        CHECK_RELATIVE(of.e.size[i], size[i], 1e-12, "a size and a magnitude");
    for (int k = 0; k < layout->mesh.intervals; k++) {
        const struct interval *interval = &layout->interval[k];
        double worst = 0;
        for (int i = 0; i <= NX; i++)
            worst = fmax(worst, integral_of(layout, interval, i) * fabs(i < NX ? rates->f[i] : rates->g) / size[i]);
        const double error = moray_examiner_interval(&of.e, interval, NULL);
        CHECK(fabs(error - worst) < 5e-3 * worst, "interval %d: %.6g is %.6g", k, error, worst);
        CHECK(moray_examiner_error(&of.e, interval) == error, "which nothing outside exceeds");
    }
    end(&of);
}

// Below and above bounds on both sides of 0, of one state and the other: how far is relative to the size and the bound.
static void test_outside(void)
{
    static const struct {
        moray_bounds x[NX];
        int i;
        double far, bound;
    } cases[] = {{{{-5, 9}, {-40, 40}}, 0, 15, 5},    {{{-30, 30}, {-4, 28}}, 1, 2, 28},
                 {{{-30, -24}, {0, 40}}, 0, 4, 24},   {{{-30, 30}, {33, 40}}, 1, 3, 33},
                 {{{-20, 30}, {30, 40}}, 0, 0, 20},   {{{-40, -20}, {-40, 30}}, 0, 0, 20},
                 {{{-19, 30}, {-40, 10}}, 1, 20, 10}, {{{-4, 30}, {-40, 29.5}}, 0, 16, 4}};
    struct rates none = {.nan_after = INFINITY};
    for (size_t c = 0; c < sizeof cases / sizeof *cases; c++) {
        struct trial of;
        begin(&of, &none, cases[c].x, (double[]){-20, 30});
        const struct interval *interval = &of.solution->transcription->layout.phase[0].interval[2];
        const double expected = cases[c].far / (of.w.phase[0].size[cases[c].i] + cases[c].bound);
        double outside = 0, more = 77;
        CHECK(moray_examiner_interval(&of.e, interval, &outside) == 0, "no error");
        CHECK_RELATIVE(outside, expected, 1e-12, "how far outside");
        CHECK_RELATIVE(moray_examiner_error(&of.e, interval), expected / violation_slack, 1e-12, "by its slack");
        moray_examiner_interval(&of.e, interval, &more);
        CHECK(more == 77, "is raised, never lowered: %g", more);
        end(&of);
    }
}

// A row that rises or falls is worst at the last point between nodes, half a sample before the end.
static void test_row(double slope, double bound, bool sized)
{
    struct rates rates = {.row = slope, .nan_after = INFINITY};
    const moray_bounds free[] = {moray_free(), moray_free()};
    struct trial of;
    begin(&of, &rates, free, (double[]){-20, 30});
    const struct phase_layout *layout = &of.solution->transcription->layout.phase[0];
    double *size = &of.w.phase[0].out_size[NX + 1];
    *size = sized ? *size : 0; // as of what nothing moves, which is measured by its bound and 1
    for (int k = 0; k < layout->mesh.intervals; k++) {
        const struct interval *interval = &layout->interval[k];
        const int count = moray_points_between(interval, 5 * interval->scheme->points);
        const double tau = layout->node[interval->first].tau + interval->width * (1 - 0.5 / count);
        const double value = fabs(slope) * SPAN * tau, far = fmax(value - bound, 0);
        double outside = 0;
        moray_examiner_interval(&of.e, interval, &outside);
        CHECK_RELATIVE(outside, far / ((sized ? *size : 1) + bound), 1e-9, "the row outside");
    }
    end(&of);
}

static void test_not_a_number(void)
{
    struct rates rates = {.f = {1, 1}, .nan_after = START + SPAN * 0.7};
    const moray_bounds free[] = {moray_free(), moray_free()};
    struct trial of;
    begin(&of, &rates, free, (double[]){-20, 30});
    const struct phase_layout *layout = &of.solution->transcription->layout.phase[0];
    CHECK(moray_examiner_interval(&of.e, &layout->interval[0], NULL) < 1, "finite before");
    CHECK(isinf(moray_examiner_interval(&of.e, &layout->interval[layout->mesh.intervals - 1], NULL)), "infinite after");
    end(&of);
}

// An integral that nothing moves is measured by itself and 1; a phase without length is at its start.
static void test_nothing(void)
{
    struct rates rates = {.f = {1, 1}, .nan_after = INFINITY};
    const moray_bounds free[] = {moray_free(), moray_free()};
    struct trial of;
    struct examiner again;
    begin(&of, &rates, free, (double[]){-20, 30});
    of.w.phase[0].integral[0] = 0;
    CHECK_OK(moray_examiner_new(&again, &of.w, 0), "examiner");
    CHECK(again.size[NX] == 1 + 6, "an integral of -6 has the size %g", again.size[NX]);
    moray_examiner_free(&again);
    struct transcription *t = of.solution->transcription;
    t->phase[0].tf = t->phase[0].t0;
    moray_examiner_place(&of.e, &t->layout.phase[0].interval[0], START, NULL);
    CHECK(of.e.in[0] == -20 && of.e.in[1] == 30, "at the start: %g and %g", of.e.in[0], of.e.in[1]);
    end(&of);
}

static void test_points(void)
{
    const struct interval half = {.width = 0.5}, narrow = {.width = 2.5 / points_of_phase};
    CHECK(moray_points_between(&half, 7) == points_of_phase / 2, "its share of the phase");
    CHECK(moray_points_between(&narrow, 2) == 3, "no less than its share");
    CHECK(moray_points_between(&narrow, 7) == 7, "no fewer than are asked for");
}

int main(void)
{
    test_error(&(struct rates){{-9, 1}, 0.5, 0, INFINITY, false});
    test_error(&(struct rates){{0.5, -12}, 1, 0, INFINITY, false});
    test_error(&(struct rates){{1, 1}, -9, 0, INFINITY, false});
    test_outside();
    for (int sized = 0; sized < 2; sized++) {
        test_row(3, 1.5, sized);
        test_row(-3, 2.5, sized);
    }
    test_not_a_number();
    test_nothing();
    test_points();
    return tap_done();
}
