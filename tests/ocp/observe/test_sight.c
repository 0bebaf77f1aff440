// SPDX-License-Identifier: MIT
//
// Data that move over the mesh: what their rows say, against polynomials through the nodes; what they add to the
// gradient of the Lagrangian, against the Jacobian; in which intervals they are, and when they have left them.
#include "tap.h"

#include <string.h>
#include <tgmath.h>

#include "ocp/observe/sight.h"

enum { NX = 2, NU = 3, DATA = 5, INTERVALS = 3 };
static const double time_of[DATA] = {1.8, 1.1, 2.2, 1.1, 0.9};

static void go(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = at->x[1] * at->u[0] + sin(at->t) * at->u[2];
    out->f[1] = at->u[1] * at->u[1] - at->x[0] * at->t;
    out->c[0] = at->x[0] + at->u[1];
}

static void watch(const moray_node *at, moray_num *y, const void *data)
{
    (void)data;
    y[0] = at->x[0] + at->u[1] * at->u[2];
}

static void nothing(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase[0].tf;
}

static moray_ocp *problem(moray_bounds t0, moray_bounds tf)
{
    static const double value[DATA] = {0};
    const moray_phase_spec phase = {
        .name = "leg",
        .nx = NX,
        .nu = NU,
        .nc = 1,
        .continuous = go,
        .t0 = t0,
        .tf = tf,
        .c = MORAY_BOUNDS(moray_at_most(3)),
        .observed = {.n = DATA, .ny = 1, .time = time_of, .value = value, .observe = watch}};
    moray_ocp *ocp;
    CHECK_OK(moray_ocp_new(&ocp, &(moray_ocp_spec){.name = "seen", .phases = 1, .phase = &phase, .endpoint = nothing}),
             "problem");
    return ocp;
}

static struct transcription *transcribe(const moray_ocp *ocp, moray_family family, int stages, const double *edge,
                                        double t0, double tf)
{
    struct mesh mesh;
    struct transcription *t = NULL;
    CHECK_OK(moray_mesh_uniform(&mesh, INTERVALS, (struct method){family, stages}), "mesh");
    memcpy(mesh.edge, edge, (INTERVALS + 1) * sizeof *edge);
    mesh.t0 = t0, mesh.tf = tf;
    CHECK_OK(moray_transcription_new(&t, ocp, &mesh), "transcription");
    moray_mesh_free(&mesh);
    return t;
}

static double *random_point(const struct transcription *t, double t0, double tf)
{
    unsigned long long seed = 5;
    double *x = calloc((size_t)t->nlp.n, sizeof *x);
    for (int j = 0; j < t->nlp.n; j++)
        x[j] = tap_random(&seed, 0.2, 1);
    const struct phase_layout *layout = &t->layout.phase[0];
    if (layout->t0 != absent)
        x[layout->t0] = t0;
    if (layout->tf != absent)
        x[layout->tf] = tf;
    return x;
}

// ---- What the rows say ----

// Lagrange's polynomial through the collocated nodes of an interval that is 1 at the j-th of them, at tau.
static double lagrange(const struct phase_layout *layout, const struct interval *interval, int j, double tau)
{
    double product = 1;
    for (int i = interval->scheme->first; i <= interval->scheme->last; i++)
        if (i != j)
            product *= (tau - layout->node[interval->first + i].tau) /
                       (layout->node[interval->first + j].tau - layout->node[interval->first + i].tau);
    return product;
}

// Of that, from the start of its interval to tau, by Simpson's rule on many parts.
static double integral(const struct phase_layout *layout, const struct interval *interval, int j, double tau)
{
    enum { parts = 400 };
    const double from = layout->node[interval->first].tau, h = (tau - from) / parts;
    double sum = 0;
    for (int k = 0; k < parts; k++)
        sum += h / 6 *
               (lagrange(layout, interval, j, from + k * h) + 4 * lagrange(layout, interval, j, from + (k + 0.5) * h) +
                lagrange(layout, interval, j, from + (k + 1) * h));
    return sum;
}

static void test_rows(struct transcription *t, const double *x, const char *scheme)
{
    const struct phase_layout *layout = &t->layout.phase[0];
    double *g = calloc((size_t)t->nlp.m, sizeof *g), worst = 0;
    CHECK(t->nlp.constraints(t->nlp.self, x, true, g), "values");
    const double t0 = t->phase[0].t0, T = t->phase[0].tf - t0;
    for (int k = 0; k < DATA; k++) {
        const struct sight *sight = &layout->sight[k];
        const struct interval *interval = &layout->interval[sight->interval];
        const double tau = (time_of[k] - t0) / T;
        for (int r = 0; r < NX + NU; r++) {
            double seen = r < NX ? x[layout->node[interval->first].x + r] : 0;
            for (int j = interval->scheme->first; j <= interval->scheme->last; j++) {
                const int n = interval->first + j;
                seen += r < NX
                            ? T * integral(layout, interval, j, tau) * t->phase[0].out[n * t->phase[0].map->n_out + r]
                            : lagrange(layout, interval, j, tau) * x[layout->node[n].x + r];
            }
            worst = tap_worse(worst, fabs(g[sight->row + r] - (x[sight->x + r] - seen)));
        }
    }
    CHECK(worst < 1e-9, "%s: rows are what is seen less the polynomials: %.1e", scheme, worst);
    free(g);
}

// ---- Gradient ----

// f's part of the gradient, for multipliers of f: through its inputs, the times of its node, and T.
static void add_times(const struct transcription *t, double by_t0, double by_tf, double *gradient)
{
    const struct phase_layout *layout = &t->layout.phase[0];
    if (layout->t0 != absent)
        gradient[layout->t0] += by_t0;
    if (layout->tf != absent)
        gradient[layout->tf] += by_tf;
}

static void add_dynamics(const struct transcription *t, const double *lambda_f, double *gradient)
{
    const struct phase_layout *layout = &t->layout.phase[0];
    const moray_map *map = t->phase[0].map;
    const double T = t->phase[0].tf - t->phase[0].t0;
    for (int n = 0; n < layout->nodes; n++) {
        const struct node *node = &layout->node[n];
        for (int e = 0; e < map->jac.nnz && node->collocated; e++) {
            if (map->jac.row[e] >= NX)
                continue;
            const double slope = lambda_f[n * NX + map->jac.row[e]] * t->phase[0].jac[n * map->jac.nnz + e];
            if (map->jac.col[e] < NX + NU)
                gradient[node->x + map->jac.col[e]] += slope;
            else
                add_times(t, (1 - node->tau) * slope, node->tau * slope, gradient);
        }
        for (int r = 0; r < NX && node->collocated; r++) {
            const double by_T = lambda_f[n * NX + r] * t->phase[0].out[n * map->n_out + r] / T;
            add_times(t, -by_T, by_T, gradient);
        }
    }
}

static void test_gradient(struct transcription *t, const double *x, const char *scheme)
{
    const moray_nlp *nlp = &t->nlp;
    const struct phase_layout *layout = &t->layout.phase[0];
    unsigned long long seed = 11;
    const size_t n_f = (size_t)layout->nodes * NX;
    double *lambda = calloc((size_t)nlp->m, sizeof *lambda), *jac = calloc((size_t)nlp->nnz_jac, sizeof *jac);
    double *want = calloc((size_t)nlp->n, sizeof *want), *got = calloc((size_t)nlp->n, sizeof *got);
    double *lambda_f = calloc(n_f, sizeof *lambda_f), worst = 0, largest = 0;
    for (int k = 0; k < DATA; k++)
        for (int r = 0; r < NX + NU; r++)
            lambda[layout->sight[k].row + r] = tap_random(&seed, -1, 1);
    CHECK(nlp->jacobian(nlp->self, x, true, jac), "Jacobian");
    for (int e = 0; e < nlp->nnz_jac; e++)
        want[nlp->jac_col[e]] += lambda[nlp->jac_row[e]] * jac[e];
    moray_add_sights_to_dynamics(t, 0, lambda, lambda_f);
    add_dynamics(t, lambda_f, got);
    moray_add_sights(t, 0, lambda, got);
    for (int j = 0; j < nlp->n; j++) {
        worst = tap_worse(worst, fabs(got[j] - want[j]));
        largest = fmax(largest, fabs(want[j]));
    }
    CHECK(largest > 0.5 && worst < 1e-12 * largest, "%s: what they add to the gradient is J' lambda: %.1e of %.2g",
          scheme, worst, largest);
    free(lambda), free(jac), free(want), free(got), free(lambda_f);
}

// No entry stands for a time that is fixed.
static void test_pattern(const moray_nlp *nlp)
{
    int outside = 0;
    for (int k = 0; k < nlp->nnz_jac; k++)
        outside += nlp->jac_row[k] < 0 || nlp->jac_col[k] < 0 || nlp->jac_col[k] >= nlp->n;
    for (int k = 0; k < nlp->nnz_hess; k++)
        outside += nlp->hess_col[k] < 0 || nlp->hess_row[k] < nlp->hess_col[k] || nlp->hess_row[k] >= nlp->n;
    CHECK(outside == 0, "every entry has a place, but for %d", outside);
}

// What it writes to does not matter.
static void test_by_time(const struct transcription *t)
{
    const size_t n = (size_t)t->layout.phase[0].nodes * 2 * NX;
    double *clean = calloc(n, sizeof *clean), *dirty = calloc(n, sizeof *dirty);
    double *lambda = calloc((size_t)t->nlp.m, sizeof *lambda);
    for (int i = 0; i < t->nlp.m; i++)
        lambda[i] = cos(i);
    for (size_t i = 0; i < n; i++)
        dirty[i] = 9;
    moray_sights_by_time(t, 0, lambda, clean);
    moray_sights_by_time(t, 0, lambda, dirty);
    CHECK(memcmp(clean, dirty, n * sizeof *clean) == 0, "by the times, from whatever was there");
    free(clean), free(dirty), free(lambda);
}

// ---- Places ----

static void test_fill(const moray_ocp *ocp, const struct transcription *t)
{
    static const double size[NX + NU] = {1, 2, 3, 4, 5};
    for (int of_rows = 0; of_rows < 2; of_rows++) {
        const int n = of_rows ? t->nlp.m : t->nlp.n;
        double *filled = calloc((size_t)n, sizeof *filled), sum = 0;
        int right = 0;
        moray_fill_sights(&t->layout.phase[0], &ocp->phase[0], size, of_rows, filled);
        for (int k = 0; k < DATA; k++)
            for (int r = 0; r < NX + NU; r++)
                right +=
                    filled[(of_rows ? t->layout.phase[0].sight[k].row : t->layout.phase[0].sight[k].x) + r] == size[r];
        for (int i = 0; i < n; i++)
            sum += filled[i];
        CHECK(right == DATA * (NX + NU) && sum == DATA * 15, "sizes of %s, and of nothing else",
              of_rows ? "rows" : "columns");
        free(filled);
    }
}

// At its edge a datum is in the interval that begins there, beyond the ends in the one at the end, and in the first
// where the phase has no length.
static void test_intervals(const moray_ocp *ocp)
{
    static const double begin[][2] = {{0.6, 2.9}, {0.9, 2.5}, {1.0, 1.7}, {0, 2.2}, {2, 3}, {1.1, 1.1}};
    static const double edges[] = {0, 0.4, 0.7, 1};
    for (size_t k = 0; k < sizeof begin / sizeof *begin; k++) {
        const double t0 = begin[k][0], T = begin[k][1] - t0;
        struct transcription *t = transcribe(ocp, MORAY_RADAU, 2, edges, t0, t0 + T);
        for (int i = 0; i < DATA; i++) {
            int interval = 0;
            for (int e = 1; e < INTERVALS; e++)
                interval += T > 0 && time_of[i] - t0 >= edges[e] * T;
            CHECK(t->layout.phase[0].sight[i].interval == interval, "from %g for %g: %g in interval %d", t0, T,
                  time_of[i], interval);
        }
        moray_transcription_free(t);
    }
    double edge[] = {0, (1.1 - 0.5) / (2.9 - 0.5), 0.8, 1};
    struct transcription *t = transcribe(ocp, MORAY_RADAU, 2, edge, 0.5, 2.9);
    CHECK(t->layout.phase[0].sight[1].interval == 1, "at an edge it is behind it");
    moray_transcription_free(t);
}

// With data at taus: those that are outside of their interval by more than a millionth of it have left it, but for the
// outer ends.
static void test_left(const moray_ocp *ocp)
{
    static const double edge[] = {0, 0.4, 0.7, 1};
    static const double little[] = {-1e-3, -6e-7, -2.5e-7, 0, 2.5e-7, 6e-7, 1e-3};
    int either[2] = {0, 0}, right = 0;
    for (int trial = 0; trial < DATA * 4 * 7 * 2; trial++) { // datum k a little beside edge e
        const int k = trial % DATA, e = trial / DATA % 4;
        const double T = 2.3 + 0.01 * k, at_edge = time_of[k] - edge[e] * T,
                     moved = at_edge - little[trial / (4 * DATA) % 7] * T;
        const double t0 = at_edge + (trial < DATA * 4 * 7 ? -1e-10 : 1e-10); // placed behind it, or before
        struct transcription *t = transcribe(ocp, MORAY_RADAU, 2, edge, t0, t0 + T);
        const struct phase_layout *layout = &t->layout.phase[0];
        double *x = random_point(t, moved, moved + T), *g = calloc((size_t)t->nlp.m, sizeof *g);
        struct mesh mesh = {0};
        bool want = false;
        for (int i = 0; i < DATA; i++) {
            const double tau = (time_of[i] - moved) / T, *own = edge + layout->sight[i].interval;
            const double slack = 1e-6 * (own[1] - own[0]);
            want = want || (tau < own[0] - slack && own[0] > 0) || (tau > own[1] + slack && own[1] < 1);
        }
        t->nlp.constraints(t->nlp.self, x, true, g);
        const bool left = moray_sights_left(t, &mesh);
        right += left == want && mesh.t0 == moved && mesh.tf == moved + T;
        either[left]++;
        free(x), free(g);
        moray_transcription_free(t);
    }
    CHECK(right == DATA * 4 * 7 * 2 && either[0] > 20 && either[1] > 20,
          "left or not as it should be: %d, %d of them left", right, either[1]);
}

// The largest distance counts, of either sign, in sizes that are positive.
static void test_error(const moray_ocp *ocp)
{
    static const double edge[] = {0, 0.4, 0.7, 1}, sizes[NX + NU] = {2, 0.5, 0, -3, 4};
    struct transcription *t = transcribe(ocp, MORAY_RADAU, 2, edge, 0.6, 2.9);
    double *point = random_point(t, 0.7, 2.8), at[NX + 1 + NU];
    double *const place[] = {at, at + 1, at + NX + 1, at + NX + 2, at + NX + 3}; // what is between is of neither
    at[NX] = 1e9;
    CHECK(moray_transcription_values(t, point), "values");
    const double *seen = point + t->layout.phase[0].sight[2].x;
    for (int r = 0; r < NX + NU; r++) {
        const double size = sizes[r] > 0 ? sizes[r] : 1;
        for (int i = 0; i < NX + NU; i++)
            *place[i] = seen[i] + (i % 2 ? 1e-3 : -1e-3) * (sizes[i] > 0 ? sizes[i] : 1);
        *place[r] = seen[r] + 0.25 * size;
        CHECK_NEAR(moray_sight_error(t, 0, 2, at, at + NX + 1, sizes), 0.25, 1e-12, "above");
        *place[r] = seen[r] - 0.75 * size;
        CHECK_NEAR(moray_sight_error(t, 0, 2, at, at + NX + 1, sizes), 0.75, 1e-12, "and below");
    }
    CHECK(moray_sight_error(t, 0, 2, seen, seen + NX, sizes) == 0, "none at what is seen");
    free(point);
    moray_transcription_free(t);
}

// A phase without length has finite rows and derivatives.
static void test_no_length(const moray_ocp *ocp)
{
    static const double edge[] = {0, 0.4, 0.7, 1};
    struct transcription *t = transcribe(ocp, MORAY_LOBATTO, 3, edge, 0.6, 2.9);
    const moray_nlp *nlp = &t->nlp;
    double *x = random_point(t, 1.3, 1.3), sum = 0;
    double *out = calloc((size_t)(nlp->m + nlp->nnz_jac + nlp->nnz_hess), sizeof *out),
           *lambda = calloc((size_t)nlp->m, sizeof *lambda);
    for (int i = 0; i < nlp->m; i++)
        lambda[i] = 1 + 0.1 * i;
    CHECK(nlp->constraints(nlp->self, x, true, out), "values");
    CHECK(nlp->jacobian(nlp->self, x, false, out + nlp->m), "Jacobian");
    for (int i = 0; i < nlp->m + nlp->nnz_jac; i++)
        sum += fabs(out[i]);
    CHECK(isfinite(sum), "finite without length");
    free(x), free(out), free(lambda);
    moray_transcription_free(t);
}

int main(void)
{
    static const struct {
        moray_family family;
        int stages;
        const char *name;
    } schemes[] = {{MORAY_LOBATTO, 3, "lobatto3"}, {MORAY_LOBATTO, 4, "lobatto4"}, {MORAY_RADAU, 1, "radau1"},
                   {MORAY_RADAU, 3, "radau3"},     {MORAY_GAUSS, 2, "gauss2"},     {MORAY_GAUSS, 4, "gauss4"}};
    static const double edge[] = {0, 0.4, 0.7, 1};
    moray_ocp *ocp = problem(moray_between(0, 0.9), moray_between(2.2, 4));
    moray_ocp *from = problem(moray_fixed(0.7), moray_between(2.2, 4)),
              *to = problem(moray_between(0, 0.9), moray_fixed(2.8));
    moray_ocp *const problems[] = {ocp, from, to};
    for (size_t k = 0; k < 3 * sizeof schemes / sizeof *schemes; k++) {
        const moray_ocp *one = problems[k % 3];
        struct transcription *t = transcribe(one, schemes[k / 3].family, schemes[k / 3].stages, edge, 0.6, 2.9);
        double *x = random_point(t, 0.7, 2.8);
        test_rows(t, x, schemes[k / 3].name);
        test_gradient(t, x, schemes[k / 3].name);
        test_by_time(t);
        test_fill(one, t);
        test_pattern(&t->nlp);
        free(x);
        moray_transcription_free(t);
    }
    test_intervals(ocp);
    test_left(ocp);
    test_error(ocp);
    test_no_length(ocp);
    moray_ocp_free(ocp);
    moray_ocp_free(from);
    moray_ocp_free(to);
    return tap_done();
}
