// SPDX-License-Identifier: MIT
//
// A phase whose rates are set by their values at the nodes, and err by what is 0 there, and the mesh that becomes of
// it.
#ifndef TESTS_OCP_PIECES_H
#define TESTS_OCP_PIECES_H

#include "tap.h"

#include <string.h>

#include "moray/ocp.h"

#include "ocp/certificate/unseen.h"
#include "ocp/refinement/refine.h"

enum { N = 6, MOST = 8, QUANTITIES = 2, EXPECTED = 4 * N };
static const double t0 = 1, T = 3;
static double mesh[N + 1] = {0, 0.13, 0.3, 0.42, 0.66, 0.83, 1};

// Of the rate and the integrand: values at the nodes, and a part of what vanishes there.
struct piece {
    double y[QUANTITIES][MOST], off;
    double hidden; // a control's effect, which vanishes there too
    int lean;      // of that: to the start, to the end, or to a place between (0)
};
static struct piece piece[N];
static const moray_scheme *scheme; // NULL: before there is one
static bool held;                  // the control, over each interval of the first mesh

static double product(double tau, int without)
{
    double p = 1;
    for (int j = scheme->first; j <= scheme->last; j++)
        p *= j == without ? 1 : tau - scheme->node[j];
    return p;
}

static double leant(const struct piece *p, double tau)
{
    const double far = (tau - 0.37) / 0.1;
    return p->lean == 0 ? exp(-far * far) : p->lean < 0 ? 1 / (tau + 1e-3) : 1 / (1.001 - tau);
}

static void curve(const moray_node *at, moray_rates *out, const void *data)
{
    const double tau = (creal(at->t) - t0) / T;
    int k = 0;
    (void)data;
    while (k < N - 1 && tau > mesh[k + 1] + 1e-12)
        k++;
    const struct piece *p = &piece[k];
    const double local = (tau - mesh[k]) / (mesh[k + 1] - mesh[k]), all = scheme ? product(local, -1) : 0;
    double value[QUANTITIES] = {p->off * all, 0};
    for (int i = 0; i < QUANTITIES && scheme; i++)
        for (int j = scheme->first; j <= scheme->last; j++)
            value[i] += p->y[i][j] * product(local, j) / product(scheme->node[j], j);
    out->f[0] = value[0] + at->u[0] * (scheme ? p->hidden * all * leant(p, local) : 1);
    out->c[0] = 1e3 + at->x[0] * sin(40 * creal(at->t)) + at->u[0];
    out->g[0] = value[1];
}

static void still(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = 0 * at->x[0];
}

static void total(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase[1].xf[0] + at->phase[1].q[0];
}

// ---- The problem and its iterate ----

struct problem {
    moray_ocp *ocp;
    moray_solution *solution;
    struct witness w;
    struct examiner e;
    const struct phase_layout *layout;
    int s;
    double error[N];
};

static void begin(struct problem *b, const char *name)
{
    const moray_bounds none = moray_free();
    const moray_phase_spec phases[] = {{.nx = 1, .continuous = still, .tf = moray_fixed(1)},
                                       {.nx = 1,
                                        .nu = 1,
                                        .nc = 1,
                                        .nq = 1,
                                        .continuous = curve,
                                        .t0 = moray_fixed(t0),
                                        .tf = moray_fixed(t0 + T),
                                        .mesh = mesh,
                                        .intervals = N,
                                        .u = MORAY_BOUNDS(moray_between(-1, 1)),
                                        .c = MORAY_BOUNDS(none),
                                        .held = &held}};
    moray_settings settings = moray_settings_default();
    settings.max_iterations = 0;
    settings.scheme = name;
    scheme = NULL;
    memset(piece, 0, sizeof piece);
    CHECK_OK(moray_ocp_new(&b->ocp, &(moray_ocp_spec){.phases = 2, .phase = phases, .endpoint = total}), name);
    CHECK_OK(moray_solve(b->ocp, &settings, NULL, &b->solution), "begun");
    b->layout = &b->solution->transcription->layout.phase[1];
    scheme = b->layout->interval[0].scheme;
    b->s = scheme->stages;
}

// With the pieces as they are now.
static void look(struct problem *b)
{
    const struct transcription *t = b->solution->transcription;
    memset(b->solution->iterate.x, 0, (size_t)(4 * t->nlp.n + 2 * t->nlp.m) * sizeof(double));
    for (int n = 0; n < b->layout->nodes; n++)
        b->solution->iterate.x[b->layout->node[n].x] = 2 * sin(3 * n);
    for (int i = 0; i < t->nlp.m; i++)
        b->solution->iterate.lambda[i] = 3 + sin(5 * i);
    CHECK(moray_transcription_jacobians(b->solution->transcription, b->solution->iterate.x), "finite");
    CHECK_OK(moray_witness_of_sizes(&b->w, b->solution), "sizes");
    CHECK_OK(moray_examiner_new(&b->e, &b->w, 1), "examiner");
    for (int k = 0; k < N; k++)
        b->error[k] = moray_examiner_error(&b->e, &b->layout->interval[k]);
}

static void look_away(struct problem *b)
{
    moray_examiner_free(&b->e);
    moray_witness_free(&b->w);
}

static void end(struct problem *b)
{
    moray_solution_free(b->solution);
    moray_ocp_free(b->ocp);
}

// ---- Pieces ----

static double legendre(int n, double tau)
{
    double before = 0, p = 1;
    for (int k = 0; k < n; k++) {
        const double next = ((2 * k + 1) * (2 * tau - 1) * p - k * before) / (k + 1);
        before = p, p = next;
    }
    return p;
}

// Coefficients fall by e^-rate; every other one is left out where `even`.
static struct piece smooth(double rate, bool even, double off)
{
    struct piece p = {.off = off};
    for (int i = 0; i < QUANTITIES; i++)
        for (int j = scheme->first; j <= scheme->last; j++)
            for (int k = 0; k < scheme->stages; k += 1 + even)
                p.y[i][j] += (i ? -3 : 2) * exp(-rate * k) * legendre(k, scheme->node[j]);
    return p;
}

static struct piece step(int last, double from, double to, double off)
{
    struct piece p = {.off = off};
    for (int i = 0; i < QUANTITIES; i++)
        for (int j = scheme->first; j <= scheme->last; j++)
            p.y[i][j] = j <= last ? from : to;
    return p;
}

// ---- What is expected ----

struct expected {
    int n;
    double edge[EXPECTED], raised[EXPECTED];
    int stages[EXPECTED];
    enum mesh_past past[EXPECTED];
};

static void add(struct expected *x, double edge, int stages, double raised, enum mesh_past past)
{
    x->edge[x->n] = edge, x->stages[x->n] = stages, x->raised[x->n] = raised, x->past[x->n++] = past;
}

static void check(struct problem *b, double tolerance, double worst, const struct expected *x)
{
    struct mesh found[2] = {{.intervals = 0}};
    double told = -1, alone = -1;
    CHECK_OK(moray_refine(b->solution, tolerance, found, &told), "refined");
    CHECK_OK(moray_refine(b->solution, tolerance, NULL, &alone), "measured");
    CHECK_RELATIVE(told, worst, 1e-12, "the largest error");
    CHECK(alone == told, "with meshes or without");
    const struct mesh *m = &found[1];
    CHECK(m->method.family == scheme->family && m->method.stages == b->layout->mesh.method.stages, "the method stays");
    CHECK(m->t0 == t0 && m->tf == t0 + T && m->edge[0] == 0, "so do the ends");
    CHECK(m->intervals == x->n, "%d intervals, expected %d", m->intervals, x->n);
    for (int k = 0; k < m->intervals && k < x->n; k++) {
        CHECK_NEAR(m->edge[k + 1], x->edge[k], 1e-12, "an edge");
        CHECK(m->stages[k] == x->stages[k] && m->past[k] == x->past[k], "interval %d: %d stages, expected %d; %d, %d",
              k, m->stages[k], x->stages[k], (int)m->past[k], (int)x->past[k]);
        CHECK_RELATIVE(m->raised_from[k], x->raised[k], 1e-12, "the error before stages are added");
    }
    for (int p = 0; p < 2; p++)
        moray_mesh_free(&found[p]);
}

#endif
