// SPDX-License-Identifier: MIT
//
// What the Lagrangian bends down, against the eigenvalues of what the active constraints leave free; multipliers and
// slacks are set by hand.
#include "tap.h"

#include <string.h>

#include "moray/ocp.h"

#include "ocp/certificate/curvature.h"

// ---- Two parameters, the first of which bends the objective down ----

static const double H[2][2] = {{-3, 3}, {3, 5}};

static void still(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = 0 * at->x[0];
}

static void saddle(const moray_ends *at, moray_end_values *out, const void *data)
{
    const moray_num *s = at->s;
    (void)data;
    out->objective = (H[0][0] * s[0] * s[0] + 2 * H[0][1] * s[0] * s[1] + H[1][1] * s[1] * s[1]) / 2;
    out->e[0] = s[1]; // which nothing bounds
    out->e[1] = s[0];
}

// At s = 0; multipliers of the first parameter and of the row, which is the same.
struct edge {
    const char *what;
    moray_bounds s, e;
    double z_lower, z_upper, lambda;
    bool held;
};

#define NEVER                                                                                                          \
    {                                                                                                                  \
        -MORAY_INFINITY, MORAY_INFINITY                                                                                \
    }
#define BELOW(high)                                                                                                    \
    {                                                                                                                  \
        -MORAY_INFINITY, high                                                                                          \
    }
#define ABOVE(low)                                                                                                     \
    {                                                                                                                  \
        low, MORAY_INFINITY                                                                                            \
    }
static const struct edge edges[] = {
    {"no bound", NEVER, NEVER, 0, 0, 0, false},
    {"bounds far away", {-1, 1}, {-1, 1}, 0, 0, 0, false},
    {"one far below", ABOVE(-1), ABOVE(-1), 0, 0, 0, false},
    {"one far above", BELOW(1), BELOW(1), 0, 0, 0, false},
    {"an upper bound that pushes", {-1, 0}, NEVER, 0, 1e-3, 0, true},
    {"a lower bound that pushes", {0, 1}, NEVER, 1e-3, 0, 0, true},
    {"the upper alone", BELOW(0), NEVER, 0, 1e-3, 0, true},
    {"the lower alone", ABOVE(0), NEVER, 1e-3, 0, 0, true},
    {"bounds that touch and do not push", {0, 1}, {-1, 0}, 0, 0, 0, false},
    {"an upper bound of the row that pushes", NEVER, {-1, 0}, 0, 0, 1e-3, true},
    {"a lower one", NEVER, {0, 1}, 0, 0, -1e-3, true},
    {"the upper alone", NEVER, BELOW(0), 0, 0, 1e-3, true},
    {"the lower alone", NEVER, ABOVE(0), 0, 0, -1e-3, true},
    {"a row that pushes the wrong way", NEVER, {-1, 0}, 0, 0, -1e-5, false},
    {"another", NEVER, {0, 1}, 0, 0, 1e-5, false},
    {"an equation", NEVER, {0, 0}, 0, 0, 0, true},
    {"just off a bound that pushes", {-1e-4, 1}, NEVER, 1e-3, 0, 0, true},
    {"just below one", {-1, 1e-4}, NEVER, 0, 1e-3, 0, true},
    {"hardly pushed from afar", {-1, 1}, {-1, 1}, 1e-5, 1e-5, 1e-5, false},
    {"just off a row's", NEVER, {-1e-4, 1}, 0, 0, -1e-3, true},
    {"just below a row's", NEVER, {-1, 1e-4}, 0, 0, 1e-3, true},
};

static moray_solution *begin(moray_ocp **ocp, const moray_ocp_spec *spec, int intervals)
{
    moray_solution *solution = NULL;
    moray_settings settings = moray_settings_default();
    settings.max_iterations = 0;
    settings.intervals = intervals;
    CHECK_OK(moray_ocp_new(ocp, spec), "problem");
    CHECK_OK(moray_solve(*ocp, &settings, NULL, &solution), "begun");
    const moray_nlp *nlp = &solution->transcription->nlp;
    memset(solution->iterate.x, 0, (size_t)(4 * nlp->n + 2 * nlp->m) * sizeof(double));
    return solution;
}

static double worst_of(const struct witness *w, double *direction)
{
    double worst = NAN;
    CHECK_OK(moray_measure_curvature(w, &worst, direction), "curvature");
    return worst;
}

// Minus the least eigenvalue of H in sizes, of the second parameter alone where the first is held.
static double told(const double *size, double objective, bool held)
{
    const double a = H[0][0] * size[0] * size[0] / objective, b = H[0][1] * size[0] * size[1] / objective,
                 c = H[1][1] * size[1] * size[1] / objective;
    return held ? fmax(0, -c) : hypot((a - c) / 2, b) - (a + c) / 2;
}

static void test_edge(const struct edge *edge)
{
    const moray_phase_spec phase = {
        .nx = 1, .continuous = still, .tf = moray_fixed(1), .x0 = MORAY_BOUNDS(moray_fixed(0))};
    const moray_ocp_spec spec = {.phases = 1,
                                 .phase = &phase,
                                 .endpoint = saddle,
                                 .ns = 2,
                                 .s = MORAY_BOUNDS(edge->s, moray_free()),
                                 .ne = 2,
                                 .e = MORAY_BOUNDS(moray_free(), edge->e)};
    moray_ocp *ocp = NULL;
    struct witness w;
    moray_solution *solution = begin(&ocp, &spec, 3);
    const struct transcription *t = solution->transcription;
    double size[200], direction[200];
    for (int n = 0; n < t->layout.phase[0].nodes; n++) // which has no say
        solution->iterate.x[t->layout.phase[0].node[n].x] = 7 * n;
    solution->iterate.z_lower[t->layout.s] = edge->z_lower;
    solution->iterate.z_upper[t->layout.s] = edge->z_upper;
    solution->iterate.lambda[t->layout.events + 1] = edge->lambda;
    CHECK_OK(moray_witness_of_sizes(&w, solution), "sizes");
    moray_witness_columns(&w, size);
    const double worst = worst_of(&w, direction), objective = moray_witness_objective(&w);
    const double expected = told(size + t->layout.s, objective, edge->held);
    CHECK(worst <= expected * (1 + 1e-9) && worst >= 0.85 * expected, "%s: bends down by %g, not %g", edge->what, worst,
          expected);
    double largest = 0;
    for (int j = 0; j < t->nlp.n; j++)
        largest = fmax(largest, fabs(direction[j]) / size[j]);
    CHECK_NEAR(largest, edge->held ? 0 : 1, 1e-9, "the direction has the size of what moves");
    moray_witness_free(&w);
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

// ---- Along a phase: whatever the mesh, what counts is how much of the phase a node stands for ----

enum bound { on_state, on_control, on_path, on_none };
static const double bend = 9e-5; // down, of the state; a fourth of it of the control, which moves twice as far

// Of the state or the control of a node, from the bounds, which are 0.
static double off(int n, bool control)
{
    return 100 * (1 + n % 2 + control * (n % 2));
}

static void ridge(const moray_node *at, moray_rates *out, const void *data)
{
    const moray_num x = at->x[0], u = at->u[0];
    out->f[0] = 0 * x;
    out->c[0] = u;
    out->g[0] = *(const enum bound *)data == on_state ? 100 - bend * x * x / 2
                                                      : 100 - bend / 4 * u * u / 2; // the integral hardly moves
}

static void total(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase[0].q[0];
}

// Multipliers of every node's bound, as many times what makes it hold.
static void push(moray_solution *solution, const struct witness *w, enum bound bound, double times)
{
    const struct transcription *t = solution->transcription;
    const struct phase_layout *layout = &t->layout.phase[0];
    double *size = calloc((size_t)(t->nlp.n + t->nlp.m), sizeof *size), *row = size + t->nlp.n;
    moray_witness_columns(w, size);
    moray_witness_rows(w, row);
    for (int n = 0; n < layout->nodes; n++) {
        const struct node *node = &layout->node[n];
        const int j = bound == on_path ? node->path : node->x + (bound == on_control);
        const double s = bound == on_path ? row[j] : size[j];
        const double multiplier =
            times * 1e-3 * off(n, bound != on_state) / (s * s) * node->weight * moray_witness_objective(w);
        if (bound == on_path)
            solution->iterate.lambda[j] = multiplier;
        else if (bound != on_none)
            solution->iterate.z_upper[j] = multiplier;
    }
    free(size);
}

static double free_bend(const struct witness *w, enum bound bound)
{
    const double size = w->phase[0].size[bound != on_state];
    return (bound == on_state ? bend : bend / 4) * size * size / moray_witness_objective(w);
}

static void test_ridge(enum bound bound, double times, int intervals)
{
    const moray_bounds below = moray_at_most(0), free = moray_free();
    const moray_phase_spec phase = {.nx = 1,
                                    .nu = 1,
                                    .nc = 1,
                                    .nq = 1,
                                    .continuous = ridge,
                                    .tf = moray_fixed(1),
                                    .x = MORAY_BOUNDS(bound == on_state ? below : free),
                                    .u = MORAY_BOUNDS(bound == on_control ? below : free),
                                    .c = MORAY_BOUNDS(bound == on_path ? below : free)};
    moray_ocp *ocp = NULL;
    struct witness w;
    moray_solution *solution =
        begin(&ocp, &(moray_ocp_spec){.phases = 1, .phase = &phase, .endpoint = total, .data = &bound}, intervals);
    const struct transcription *t = solution->transcription;
    const struct phase_layout *layout = &t->layout.phase[0];
    for (int n = 0; n < layout->nodes; n++)
        for (int control = 0; control < 2; control++)
            solution->iterate.x[layout->node[n].x + control] = -off(n, control);
    solution->iterate.lambda[layout->integral_row] = -1; // the objective is the integral
    t->nlp.jacobian(t->nlp.self, solution->iterate.x, true, (double[4000]){0});
    CHECK_OK(moray_witness_of_sizes(&w, solution), "sizes");
    push(solution, &w, bound, times);
    const double expected = bound != on_none && times > 1 ? 0 : free_bend(&w, bound), worst = worst_of(&w, NULL);
    CHECK(fabs(worst - expected) <= 2e-3 * expected, "%d intervals, bound %d, pushed by %g: bends down by %g, not %g",
          intervals, bound, times, worst, expected);
    moray_witness_free(&w);
    moray_solution_free(solution);
    moray_ocp_free(ocp);
}

int main(void)
{
    for (size_t k = 0; k < sizeof edges / sizeof *edges; k++)
        test_edge(&edges[k]);
    for (int bound = on_state; bound <= on_none; bound++)
        for (int intervals = 3; intervals <= 12; intervals += 9) {
            test_ridge(bound, 2, intervals);
            test_ridge(bound, 0.5, intervals);
        }
    return tap_done();
}
