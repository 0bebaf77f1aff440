// SPDX-License-Identifier: MIT
//
// Sizes of states, controls, integrals and times, and the scales of columns and rows, at points set by hand.
#include "tap.h"

#include <stdlib.h>

#include "moray/ocp.h"

#include "ocp/guess_sizes.h"

static moray_solution *begin(moray_ocp **ocp, const moray_ocp_spec *spec)
{
    moray_solution *solution = NULL;
    moray_settings settings = moray_settings_default();
    settings.max_iterations = 0;
    settings.scheme = "radau3";
    settings.intervals = 5;
    CHECK_OK(moray_ocp_new(ocp, spec), "problem");
    CHECK_OK(moray_solve(*ocp, &settings, NULL, &solution), "begun");
    return solution;
}

static void end(moray_solution *solution, moray_ocp *ocp)
{
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

// ---- Two phases of which everything has another size ----

enum { flat, steep, gentle, rows_of_path };

static void plant(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    const moray_num *x = at->x, *u = at->u;
    out->f[0] = x[1];
    out->f[1] = u[0];
    out->c[flat] = 0.01 * u[0];
    out->c[steep] = 3 * x[0] * x[0];
    out->c[gentle] = 0.02 * x[0] * x[0];
    out->g[0] = 5;
    out->g[1] = x[1] * x[1];
}

static void arrive(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase[0].q[0] + at->phase[1].q[1];
    out->e[0] = 7 * at->phase[1].xf[1];
    out->e[1] = at->phase[1].t0 - at->phase[0].tf;
}

static const double size_x[2][2] = {{2, 10}, {6, 1}}, size_u[2] = {3, 0.5}, q[2][2] = {{0.7, 0.3}, {90, 1e-12}};
static const double when[2][2] = {{0.5, 5}, {5.5, 8}}, speed = 2;

static double place(int p, int n)
{
    return 0.002 * (n + 1) * (n + 1) * (p + 1);
}

static void fill(const struct transcription *t, double *x)
{
    for (int p = 0; p < 2; p++) {
        const struct phase_layout *layout = &t->layout.phase[p];
        for (int n = 0; n < layout->nodes; n++) {
            x[layout->node[n].x] = place(p, n);
            x[layout->node[n].x + 1] = speed / (1 + 5 * p);
            if (layout->node[n].collocated)
                x[layout->node[n].x + 2] = 0.1;
        }
        for (int k = 0; k < 2; k++) {
            x[layout->q + k] = q[p][k];
            x[k ? layout->tf : layout->t0] = when[p][k];
        }
    }
}

static void check_columns(const struct transcription *t, int p, bool found)
{
    const struct phase_layout *layout = &t->layout.phase[p];
    const double *scale = t->nlp.x_scale, *of_row = t->nlp.g_scale;
    for (int n = 0; n < layout->nodes; n++) {
        for (int r = 0; r < 2; r++)
            CHECK_NEAR(scale[layout->node[n].x + r] * size_x[p][r], 1, 1e-12, "a state");
        if (layout->node[n].collocated)
            CHECK_NEAR(scale[layout->node[n].x + 2] * size_u[p], 1, 1e-12, "a control");
    }
    // The last integral is next to nothing: what it may come to, with a speed that moves by its size where its box has
    // room.
    const double fast = 1 - speed / 6, T = when[p][1] - when[p][0];
    for (int k = 0; k < 2; k++) {
        const double size = p == 1 && k == 1 ? fast * fast * T : q[p][k];
        CHECK_NEAR(scale[layout->q + k] * size, 1, 1e-9, "an integral");
        CHECK(of_row[layout->integral_row + k] == scale[layout->q + k], "and what defines it");
    }
    static const double boxes[2][2] = {{1, 8.8}, {6, 9}}; // as far as the box lets it be from the other end
    for (int k = 0; k < 2; k++)
        CHECK_NEAR(scale[k ? layout->tf : layout->t0] * (found ? T : boxes[p][k]), 1, 1e-12, "a time");
}

static void check_rows(const struct transcription *t, int p)
{
    const struct phase_layout *layout = &t->layout.phase[p];
    const double *scale = t->nlp.g_scale, widest = place(p, layout->nodes - 1);
    for (int k = 0; k < layout->mesh.intervals; k++)
        for (int i = 0; i < 6; i++)
            CHECK_NEAR(scale[layout->interval[k].defect + i] * size_x[p][i % 2], 1, 1e-12, "a defect");
    for (int n = 1; n < layout->nodes; n++) {
        const double own = 6 * place(p, n) * size_x[p][0], *row = scale + layout->node[n].path;
        CHECK_NEAR(row[flat] * 0.01 * size_u[p], 1, 1e-12, "as steep everywhere");
        CHECK_NEAR(row[steep] * fmax(own, 1), 1, 1e-12, "by itself where it is steep");
        CHECK_NEAR(row[gentle] * 0.04 * widest * size_x[p][0], 1, 1e-12, "where it is nowhere steep by the steepest");
    }
}

static void test_scales(void)
{
    const moray_bounds wide = moray_between(-50, 50), x[] = {{-1, 6}, {-1, 1}}, u[] = {{0, 0.5}};
    moray_phase_spec phase[2] = {{.nx = 2,
                                  .nu = 1,
                                  .nc = rows_of_path,
                                  .nq = 2,
                                  .continuous = plant,
                                  .t0 = moray_between(0.2, 1),
                                  .tf = moray_between(3, 9),
                                  .x = MORAY_BOUNDS(moray_between(-2, 1), moray_between(-4, 10)),
                                  .u = MORAY_BOUNDS(moray_between(-3, 2)),
                                  .c = MORAY_BOUNDS(wide, wide, wide)}};
    phase[1] = phase[0];
    phase[1].t0 = moray_between(4, 6), phase[1].tf = moray_between(7, 13);
    phase[1].x = (moray_bounds_list){x, 2}, phase[1].u = (moray_bounds_list){u, 1};
    moray_ocp *ocp;
    moray_solution *solution =
        begin(&ocp, &(moray_ocp_spec){.phases = 2,
                                      .phase = phase,
                                      .endpoint = arrive,
                                      .ne = 2,
                                      .e = MORAY_BOUNDS(moray_between(-9, 9), moray_at_least(0))});
    struct transcription *t = solution->transcription;
    fill(t, solution->iterate.x);
    for (int found = 0; found < 2; found++) {
        CHECK_OK(moray_choose_scales(t, solution->iterate.x, found), "scales");
        for (int p = 0; p < 2; p++) {
            check_columns(t, p, found);
            check_rows(t, p);
        }
        CHECK_NEAR(t->nlp.g_scale[t->layout.events], 1 / 7., 1e-12, "an event");
        CHECK_NEAR(t->nlp.g_scale[t->layout.events + 1], found ? 1 / 4.5 : 1 / 8.8, 1e-12, "one of times");
    }
    end(solution, ocp);
}

// ---- A time: from the other end of its phase ----

static void still(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = at->u[0];
}

static void nowhere(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase[0].xf[0];
}

static const struct span {
    moray_bounds t0, tf;
    double times[2], sizes[2]; // 0: it is fixed
    bool found;
} spans[] = {
    {{0.2, 1}, {3, 9}, {0.5, 5}, {4.5, 4.5}, true},
    {{0.2, 1}, {0.5, 9}, {0.75, 0.75}, {1, 8.8}, true},
    {{0.2, 1}, {3, 9}, {0.5, 0.5}, {1, 8.8}, false},
    {{100, 100}, {101, MORAY_INFINITY}, {100, 104}, {0, 4}, false},
    {{100, 100}, {103, 109}, {100, 104}, {0, 9}, false},
    {{-109, -103}, {-100, -100}, {-104, -100}, {9, 0}, false},
    {{-MORAY_INFINITY, -103}, {-100, -100}, {-104, -100}, {4, 0}, false},
    {{-104, 3}, {5, 5}, {-100, 5}, {104, 0}, false},
};

static void test_span(const struct span *span)
{
    const moray_phase_spec phase = {.nx = 1,
                                    .nu = 1,
                                    .continuous = still,
                                    .t0 = span->t0,
                                    .tf = span->tf,
                                    .x0 = MORAY_BOUNDS(moray_fixed(0)),
                                    .u = MORAY_BOUNDS(moray_between(-1, 1))};
    moray_ocp *ocp;
    moray_solution *solution = begin(&ocp, &(moray_ocp_spec){.phases = 1, .phase = &phase, .endpoint = nowhere});
    struct transcription *t = solution->transcription;
    for (int k = 0; k < 2; k++)
        if (span->sizes[k] > 0)
            solution->iterate.x[k ? t->layout.phase[0].tf : t->layout.phase[0].t0] = span->times[k];
    CHECK_OK(moray_choose_scales(t, solution->iterate.x, span->found), "scales");
    for (int k = 0; k < 2; k++)
        if (span->sizes[k] > 0)
            CHECK(fabs(t->nlp.x_scale[k ? t->layout.phase[0].tf : t->layout.phase[0].t0] * span->sizes[k] - 1) < 1e-12,
                  "time %d of case %d", k, (int)(span - spans));
    end(solution, ocp);
}

// ---- Sizes that follow from others: x0' = 4 x1 + side u, x1' = u / 2, over a time of 2 ----

static void chain(const moray_node *at, moray_rates *out, const void *data)
{
    out->f[0] = 4 * at->x[1] + *(const double *)data * at->u[0];
    out->f[1] = at->u[0] / 2;
}

#define FREE                                                                                                           \
    {                                                                                                                  \
        -MORAY_INFINITY, MORAY_INFINITY                                                                                \
    }
static const struct sized {
    const char *what;
    moray_bounds x[2], u, x0, xf; // the last of x[0]
    double side, at;              // of x[0] at the middle node
    bool found;
    double size[3], push; // the control at that node
} sized[] = {
    {"states from a control", {FREE, FREE}, {-3, 1}, FREE, FREE, 0, 0, false, {24, 3, 3}, 0},
    {"and by the strongest cause", {FREE, FREE}, {-3, 1}, FREE, FREE, 5, 0, false, {30, 3, 3}, 0},
    {"a control from a state", {FREE, {-5, 4}}, FREE, FREE, FREE, 0, 0, false, {40, 5, 5}, 0},
    {"what states need of it, the least", {{-8, 8}, {-5, 4}}, FREE, FREE, FREE, 2, 0, false, {8, 5, 5}, 0},
    {"or of it, what others do", {{-8, 8}, {-50, 4}}, FREE, FREE, FREE, 20, 0, false, {8, 50, 10}, 0},
    {"nothing", {FREE, FREE}, FREE, FREE, FREE, 0, 0, false, {1, 1, 1}, 0},
    {"a guess", {FREE, {-5, 4}}, {-3, 1}, FREE, FREE, 0, -0.5, false, {0.5, 5, 3}, 0},
    {"one that may be rounding", {FREE, {-5, 4}}, {-3, 1}, FREE, FREE, 0, 1e-9, false, {40, 5, 3}, 0},
    {"unless both ends ask for it", {FREE, {-5, 4}}, {-3, 1}, {1e-9, 1e-9}, {0, 0}, 0, 1e-9, false, {1e-9, 5, 3}, 0},
    {"or one where nothing drives it",
     {FREE, FREE},
     FREE,
     {1e-9, 1e-9},
     FREE,
     0,
     1e-9,
     false,
     {1e-9, 1.25e-10, 1.25e-10},
     0},
    {"or the other", {FREE, FREE}, FREE, FREE, {-1e-9, -1e-9}, 0, 1e-9, false, {1e-9, 1.25e-10, 1.25e-10}, 0},
    {"not one that causes move on from", {FREE, {-5, 4}}, {-3, 1}, {1e-9, 1e-9}, FREE, 0, 1e-9, false, {40, 5, 3}, 0},
    {"more than what an end is by rounding",
     {FREE, {-5, 4}},
     {-3, 1},
     FREE,
     {1e-16, 1e-16},
     0,
     1e-9,
     false,
     {40, 5, 3},
     0},
    {"a control's guess", {FREE, {-5, 4}}, FREE, FREE, FREE, 0, 0, false, {40, 5, 0.3}, -0.3},
    {"what is far below all others is rounding",
     {FREE, {-1e-3, 1e-3}},
     {-1e13, 9},
     FREE,
     FREE,
     0,
     0,
     false,
     {1, 1e-3, 1e13},
     0},
    {"a wide box", {{-1e4, 9}, {-5, 4}}, {-3, 1}, FREE, FREE, 0, 2, false, {1e4, 5, 3}, 0},
    {"is none where both ends are fixed", {{-1e4, 9}, {-5, 4}}, {-3, 1}, {1, 1}, {2, 2}, 0, 2, false, {2, 5, 3}, 0},
    {"not at one alone", {{-1e4, 9}, {-5, 4}}, {-3, 1}, {1, 1}, FREE, 0, 2, false, {1e4, 5, 3}, 0},
    {"nor is a narrower one", {{-1e3, 9}, {-5, 4}}, {-3, 1}, {1, 1}, {2, 2}, 0, 2, false, {1e3, 5, 3}, 0},
    {"nor where it was found far within", {{-1e4, 9}, {-5, 4}}, {-3, 1}, FREE, FREE, 0, 2, true, {2, 5, 3}, 0},
    {"but as next to nothing", {{-1e4, 9}, {-5, 4}}, {-3, 1}, FREE, FREE, 0, 1e-3, true, {1e4, 5, 3}, 0},
};

static void test_sized(const struct sized *want)
{
    const moray_phase_spec phase = {.nx = 2,
                                    .nu = 1,
                                    .continuous = chain,
                                    .t0 = moray_fixed(3),
                                    .tf = moray_fixed(5),
                                    .x = MORAY_BOUNDS(want->x[0], want->x[1]),
                                    .x0 = MORAY_BOUNDS(want->x0, moray_free()),
                                    .xf = MORAY_BOUNDS(want->xf, moray_free()),
                                    .u = MORAY_BOUNDS(want->u)};
    moray_ocp *ocp;
    moray_solution *solution =
        begin(&ocp, &(moray_ocp_spec){.phases = 1, .phase = &phase, .endpoint = nowhere, .data = &want->side});
    struct transcription *t = solution->transcription;
    double size[3], *x = solution->iterate.x;
    for (int j = 0; j < t->nlp.n; j++)
        x[j] = 0;
    x[t->layout.phase[0].node[7].x] = want->at, x[t->layout.phase[0].node[7].x + 2] = want->push;
    CHECK_OK(moray_choose_scales(t, x, want->found), "the caches are of this point");
    moray_size_inputs(t, 0, x, want->found, size);
    for (int i = 0; i < 3; i++)
        CHECK(fabs(size[i] - want->size[i]) <= 1e-9 * want->size[i], "%s: size %d is %g, not %g", want->what, i,
              size[i], want->size[i]);
    end(solution, ocp);
}

// ---- What an integral may come to ----

static void integrands(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    const moray_num *x = at->x, u = at->u[0];
    out->f[0] = x[1];
    out->f[1] = u;
    out->g[0] = 5 - x[0] * x[0] - x[1] * x[1] - 4 * u * u; // the most where nothing moves
    out->g[1] = 0.25 + x[0] * u + x[1] * u + x[0] * x[1];  // as much wherever one of them moves
    out->g[2] = x[0] + 10 * x[1] + 100 * u;
}

static void test_integral(void)
{
    static const struct {
        int which;
        moray_bounds q;
        double guess, size;
    } cases[] = {{0, FREE, 0.3, 0.3},
                 {0, FREE, 2.1e-5, 2.1e-5},
                 {0, FREE, 1.9e-5, 20},
                 {0, FREE, INFINITY, 20},
                 {0, FREE, MORAY_INFINITY, 20},
                 {0, {-8, 3}, 0.3, 8},
                 {0, {0, MORAY_INFINITY}, 0.3, 0.3},
                 {1, FREE, 0, 1},
                 {2, FREE, 0, 50}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        const moray_phase_spec phase = {.nx = 2,
                                        .nu = 1,
                                        .nq = 3,
                                        .continuous = integrands,
                                        .tf = moray_fixed(4),
                                        .x = MORAY_BOUNDS(moray_between(-1, 1), moray_between(-1, 1)),
                                        .u = MORAY_BOUNDS(moray_between(-1, 1)),
                                        .q = MORAY_BOUNDS(cases[k].q, moray_free(), moray_free())};
        moray_ocp *ocp;
        moray_solution *solution = begin(&ocp, &(moray_ocp_spec){.phases = 1, .phase = &phase, .endpoint = nowhere});
        struct transcription *t = solution->transcription;
        double work[100];
        for (int j = 0; j < t->nlp.n; j++)
            solution->iterate.x[j] = 0;
        CHECK_OK(moray_choose_scales(t, solution->iterate.x, false), "the caches are of this point");
        const double size =
            moray_size_of_integral(t, 0, cases[k].which, cases[k].guess, (double[]){0.5, 0.25, 0.125}, work);
        CHECK(fabs(size - cases[k].size) <= 1e-12 * cases[k].size, "case %zu: %g, not %g", k, size, cases[k].size);
        end(solution, ocp);
    }
}

// ---- How long it takes ----

static void push(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = at->x[1];
    out->f[1] = at->u[0];
}

// From rest a force of 1 moves as far as the square of the time, in powers of the fourth root of ten.
static void test_durations(void)
{
    static const double ways[] = {1, -1, 0.9, 1.1, 3.3e7, -2e-5, 0};
    static const double times[] = {0, 0, 0, 0.25, 4, -2.25, NAN};
    for (size_t k = 0; k < sizeof ways / sizeof *ways; k++) {
        const moray_phase_spec phase = {.nx = 2,
                                        .nu = 1,
                                        .continuous = push,
                                        .t0 = moray_fixed(2),
                                        .tf = moray_fixed(3),
                                        .x0 = MORAY_BOUNDS(moray_fixed(0), moray_fixed(0)),
                                        .xf = MORAY_BOUNDS(moray_fixed(ways[k]), moray_fixed(0)),
                                        .u = MORAY_BOUNDS(moray_between(-1, 1))};
        moray_ocp *ocp;
        moray_solution *solution = begin(&ocp, &(moray_ocp_spec){.phases = 1, .phase = &phase, .endpoint = nowhere});
        struct transcription *t = solution->transcription;
        double size[3], *x = solution->iterate.x;
        for (int j = 0; j < t->nlp.n; j++)
            x[j] = 0;
        CHECK_OK(moray_choose_scales(t, x, false), "the caches are of this point");
        for (int e = 0; e < t->phase[0].map->jac.nnz; e++)
            t->phase[0].slope[e] = 7; // as of another
        const double needed = moray_needed_duration(t, 0, x, size), expected = isnan(times[k]) ? 0 : pow(10, times[k]);
        CHECK(fabs(needed - expected) <= 1e-12 * expected, "%g away: a time of %g, not %g", ways[k], needed, expected);
        CHECK(t->phase[0].tf == 3, "the phase is left as it was");
        end(solution, ocp);
    }
}

static void test_numbers(void)
{
    CHECK(moray_known_size(moray_between(-3, 2), 9) == 3 && moray_known_size(moray_between(-3, 4), 9) == 4, "a box");
    CHECK(moray_known_size(moray_fixed(5), 9) == 9 && moray_known_size(moray_at_least(-3), 9) == 9 &&
              moray_known_size(moray_at_most(3), 9) == 9 && moray_known_size(moray_between(-1e15, 1), 9) == 9 &&
              moray_known_size(moray_between(-1, 1e15), 9) == 9,
          "none: the guess");
    CHECK(moray_known_size(moray_free(), 1e-9) == 0 && moray_known_size(moray_free(), INFINITY) == 0 &&
              moray_known_size(moray_free(), MORAY_INFINITY) == 0 && moray_known_size(moray_free(), 1.1e-8) == 1.1e-8,
          "nor that");
    CHECK(moray_is_rounding(1e-10, 1) && moray_is_rounding(-1e-10, 1) && moray_is_rounding(NAN, 1) &&
              !moray_is_rounding(1e-10, 0.01) && !moray_is_rounding(-1e-8, 1),
          "rounding");
    CHECK(moray_is_far_below(1, 1001) && !moray_is_far_below(1, 999) && !moray_is_far_below(1, 1.1e6) &&
              moray_is_far_below(1, 0.9e6),
          "far below, but not nothing");
}

int main(void)
{
    test_scales();
    for (size_t k = 0; k < sizeof spans / sizeof *spans; k++)
        test_span(&spans[k]);
    for (size_t k = 0; k < sizeof sized / sizeof *sized; k++)
        test_sized(&sized[k]);
    test_integral();
    test_durations();
    test_numbers();
    return tap_done();
}
