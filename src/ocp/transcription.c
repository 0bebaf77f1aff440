// SPDX-License-Identifier: MIT
#include "ocp/transcription.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "ocp/names.h"
#include "ocp/probe.h"

enum { name_size = 100 };

const int *moray_node_columns(const struct transcription *t, int p, const struct node *node)
{
    const struct phase *phase = &t->ocp->phase[p];
    int *column = t->phase[p].column, i = 0;
    for (int r = 0; r < phase->nx; r++)
        column[i++] = node->x + r;
    for (int r = 0; r < phase->nu; r++)
        column[i++] = node->collocated ? node->x + phase->nx + r : -1;
    for (int r = 0; r < phase->ns; r++)
        column[i++] = t->layout.s + r;
    return column;
}

// ---- Evaluation ----

static bool all_finite(const double *values, int n, int *bad)
{
    for (*bad = 0; *bad < n; ++*bad)
        if (!isfinite(values[*bad]))
            return false;
    return true;
}

static bool fail_at_node(struct transcription *t, int p, int n, int bad)
{
    const struct phase_cache *cache = &t->phase[p];
    char name[name_size];
    moray_phase_output_name(t->ocp, p, bad, name, name_size);
    t->failures++;
    t->failure = moray_error(MORAY_NUMERIC, "%s of phase %s is not finite at t = %.6g", name, t->ocp->phase[p].name,
                             cache->t0 + (cache->tf - cache->t0) * t->layout.phase[p].node[n].tau);
    return false;
}

// All functions of a phase at its collocated nodes; x, u, s and t are gathered into the map's one vector of inputs.
static bool phase_values(struct transcription *t, int p)
{
    const struct phase *phase = &t->ocp->phase[p];
    const struct phase_layout *layout = &t->layout.phase[p];
    struct phase_cache *cache = &t->phase[p];
    const moray_map *map = t->phase[p].map;
    moray_layout_span(&t->layout, t->ocp, t->x, p, &cache->t0, &cache->tf);
    for (int n = 0; n < layout->nodes; n++) {
        const struct node *node = &layout->node[n];
        if (!node->collocated)
            continue;
        double *in = cache->in + n * map->n_in, *out = cache->out + n * map->n_out;
        int bad;
        memcpy(in, t->x + node->x, (size_t)(phase->nx + phase->nu) * sizeof *in);
        memcpy(in + phase->nx + phase->nu, t->x + t->layout.s, (size_t)phase->ns * sizeof *in);
        in[map->n_in - 1] = cache->t0 + (cache->tf - cache->t0) * node->tau;
        map->value(map->self, in, out);
        if (!all_finite(out, map->n_out, &bad))
            return fail_at_node(t, p, n, bad);
    }
    return true;
}

// Inputs of the endpoint map that are variables come through end_column; fixed times stay from the phases.
static bool end_values(struct transcription *t)
{
    const moray_map *map = t->endpoint;
    int bad, k = 0;
    for (int p = 0; p < t->ocp->phases; p++) {
        const int nx = t->ocp->phase[p].nx;
        t->end_in[k + nx] = t->phase[p].t0;
        t->end_in[k + 2 * nx + 1] = t->phase[p].tf;
        k += moray_end_inputs(&t->ocp->phase[p]);
    }
    for (int i = 0; i < map->n_in; i++)
        if (t->end_column[i] >= 0)
            t->end_in[i] = t->x[t->end_column[i]];
    map->value(map->self, t->end_in, t->end_out);
    if (all_finite(t->end_out, map->n_out, &bad))
        return true;
    char name[name_size];
    moray_endpoint_output_name(t->ocp, bad, name, name_size);
    t->failures++;
    t->failure = moray_error(MORAY_NUMERIC, "%s of %s is not finite", name, t->ocp->name);
    return false;
}

bool moray_transcription_values(struct transcription *t, const double *x)
{
    if (t->have_values && memcmp(t->x, x, (size_t)t->layout.columns * sizeof *x) == 0)
        return true;
    memcpy(t->x, x, (size_t)t->layout.columns * sizeof *x);
    t->have_values = t->have_jacobians = false;
    for (int p = 0; p < t->ocp->phases; p++)
        if (!phase_values(t, p))
            return false;
    t->have_values = end_values(t);
    return t->have_values;
}

// Ipopt asks for gradient, Jacobian and Hessian at the same x: the maps' Jacobians are evaluated once for all three.
bool moray_transcription_jacobians(struct transcription *t, const double *x)
{
    if (!moray_transcription_values(t, x))
        return false;
    if (t->have_jacobians)
        return true;
    for (int p = 0; p < t->ocp->phases; p++) {
        const moray_map *map = t->phase[p].map;
        for (int n = 0; n < t->layout.phase[p].nodes; n++) {
            double *jac = t->phase[p].jac + n * map->jac.nnz;
            int bad;
            if (!t->layout.phase[p].node[n].collocated)
                continue;
            map->jacobian(map->self, t->phase[p].in + n * map->n_in, jac);
            if (!all_finite(jac, map->jac.nnz, &bad))
                return fail_at_node(t, p, n, map->jac.row[bad]);
        }
    }
    t->endpoint->jacobian(t->endpoint->self, t->end_in, t->end_jac);
    t->have_jacobians = true;
    return true;
}

// ---- The programme's callbacks ----

static bool nlp_objective(void *self, const double *x, bool fresh, double *f)
{
    (void)fresh;
    struct transcription *t = self;
    if (!moray_transcription_values(t, x))
        return false;
    *f = t->end_out[0];
    return true;
}

static bool nlp_gradient(void *self, const double *x, bool fresh, double *gradient)
{
    (void)fresh;
    struct transcription *t = self;
    if (!moray_transcription_jacobians(t, x))
        return false;
    memset(gradient, 0, (size_t)t->layout.columns * sizeof *gradient);
    const moray_pattern *jac = &t->endpoint->jac;
    for (int k = 0; k < jac->nnz; k++)
        if (jac->row[k] == 0 && t->end_column[jac->col[k]] >= 0)
            gradient[t->end_column[jac->col[k]]] += t->end_jac[k];
    return true;
}

static bool nlp_constraints(void *self, const double *x, bool fresh, double *g)
{
    (void)fresh;
    struct transcription *t = self;
    if (!moray_transcription_values(t, x))
        return false;
    moray_assemble_constraints(t, g);
    return true;
}

static bool nlp_jacobian(void *self, const double *x, bool fresh, double *values)
{
    (void)fresh;
    struct transcription *t = self;
    if (!moray_transcription_jacobians(t, x))
        return false;
    moray_triplets_start(&t->jac, values);
    moray_walk_jacobian(t, &t->jac);
    return true;
}

// Integrals may stand in the objective: what they bend stays.
static const double *without_curvature(struct transcription *t, const double *lambda)
{
    for (int p = 0; p < t->ocp->phases; p++) {
        const int row = t->layout.phase[p].integral_row;
        memcpy(t->no_lambda + row, lambda + row, (size_t)t->ocp->phase[p].nq * sizeof *lambda);
    }
    return t->no_lambda;
}

static bool nlp_hessian(void *self, const double *x, bool fresh, double sigma, const double *lambda, double *values)
{
    (void)fresh;
    struct transcription *t = self;
    if (!moray_transcription_jacobians(t, x))
        return false;
    moray_triplets_start(&t->hess, values);
    moray_walk_hessian(t, sigma, t->gauss_newton ? without_curvature(t, lambda) : lambda, &t->hess);
    int bad;
    return all_finite(values, t->hess.pattern.nnz, &bad);
}

static bool times_are_fixed(const struct transcription *t)
{
    bool fixed = true;
    for (int p = 0; p < t->ocp->phases; p++)
        fixed = fixed && t->layout.phase[p].t0 == absent && t->layout.phase[p].tf == absent;
    return fixed;
}

// The same inputs in every phase, for these may share a map.
static void nlp_hold(void *self, bool begins)
{
    struct transcription *t = self;
    const bool times = times_are_fixed(t);
    for (int p = 0; p < t->ocp->phases; p++) {
        const moray_map *map = t->phase[p].map;
        bool *held = t->phase[p].held;
        const int time = map->n_in - 1, s = time - t->ocp->ns;
        for (int i = 0; i < t->ocp->ns; i++)
            held[s + i] = t->nlp.x_lower[t->layout.s + i] == t->nlp.x_upper[t->layout.s + i];
        held[time] = times;
        if (map->hold)
            map->hold(map->self, begins ? held : NULL);
    }
}

void moray_transcription_callbacks(struct transcription *t)
{
    t->nlp.self = t;
    t->nlp.objective = nlp_objective;
    t->nlp.gradient = nlp_gradient;
    t->nlp.constraints = nlp_constraints;
    t->nlp.jacobian = nlp_jacobian;
    t->nlp.hessian = nlp_hessian;
    t->nlp.hold = nlp_hold;
}
