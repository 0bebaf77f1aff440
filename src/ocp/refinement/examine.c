// SPDX-License-Identifier: MIT
#include "ocp/refinement/examine.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { samples_between = 5 }; // per point of the scheme, placed between the nodes

moray_status moray_examiner_new(struct examiner *e, const struct witness *witness, int p)
{
    const moray_solution *solution = witness->solution;
    const struct phase *phase = &solution->transcription->ocp->phase[p];
    const struct phase_layout *layout = &solution->transcription->layout.phase[p];
    const int n = phase->nx + phase->nq;
    double *block = calloc((size_t)(phase->map->n_in + phase->map->n_out + 3 * n), sizeof *block);
    if (!block)
        return moray_error(MORAY_MEMORY, "no memory to examine phase %s", phase->name);
    *e = (struct examiner){.solution = solution, .p = p, .n = n, .in = block, .out = block + phase->map->n_in};
    e->witness = &witness->phase[p];
    e->slope = e->out + phase->map->n_out;
    e->error = e->slope + n;
    e->size = e->error + n;
    for (int i = 0; i < phase->nx; i++) {
        for (int node = 0; node < layout->nodes; node++)
            e->size[i] = fmax(e->size[i], fabs(solution->iterate.x[layout->node[node].x + i]));
        e->size[i] += e->witness->size[i];
    }
    for (int i = phase->nx; i < n; i++) {
        const double size = e->witness->integral[i - phase->nx];
        e->size[i] = (size > 0 ? size : 1) + fabs(solution->iterate.x[layout->q + i - phase->nx]);
    }
    return moray_ok();
}

void moray_examiner_free(struct examiner *e)
{
    free(e->in);
}

int moray_examiner_output(const struct examiner *e, int i)
{
    const struct phase *phase = &e->solution->transcription->ocp->phase[e->p];
    return i < phase->nx ? i : i + phase->nc;
}

int moray_points_between(const struct interval *interval, int at_least)
{
    const double share = ceil(points_of_phase * interval->width);
    return share > at_least ? (int)share : at_least;
}

// Parameters and time beside the state and control in e->in.
static void complete(struct examiner *e, double t)
{
    const struct phase *phase = &e->solution->transcription->ocp->phase[e->p];
    memcpy(e->in + phase->nx + phase->nu, moray_solution_parameters(e->solution), (size_t)phase->ns * sizeof *e->in);
    e->in[phase->map->n_in - 1] = t;
}

void moray_examiner_place(struct examiner *e, const struct interval *interval, double t, const double *x)
{
    const struct phase *phase = &e->solution->transcription->ocp->phase[e->p];
    const struct phase_cache *cache = &e->solution->transcription->phase[e->p];
    const double T = cache->tf - cache->t0;
    moray_solution_at_tau(e->solution, e->p, interval, T > 0 ? (t - cache->t0) / T : 0, e->in, e->in + phase->nx);
    if (x)
        memcpy(e->in, x, (size_t)phase->nx * sizeof *x);
    complete(e, t);
}

void moray_examiner_place_by_basis(struct examiner *e, const struct interval *interval, double t, const double *ell,
                                   const double *integral)
{
    const int nx = e->solution->transcription->ocp->phase[e->p].nx;
    moray_solution_by_basis(e->solution, e->p, interval, ell, integral, e->in, e->in + nx);
    complete(e, t);
}

static void evaluate(struct examiner *e)
{
    const moray_map *map = e->solution->transcription->ocp->phase[e->p].map;
    map->value(map->self, e->in, e->out);
}

void moray_examiner_evaluate(struct examiner *e, const struct interval *interval, double t, const double *x)
{
    moray_examiner_place(e, interval, t, x);
    evaluate(e);
}

// x~' and q~': the stage polynomials, whose values are ell, through f and g at the nodes.
static void interpolant_slope(struct examiner *e, const struct interval *interval, const double *ell)
{
    const struct transcription *t = e->solution->transcription;
    const struct phase *phase = &t->ocp->phase[e->p];
    memset(e->slope, 0, (size_t)e->n * sizeof *e->slope);
    for (int j = interval->scheme->first; j <= interval->scheme->last; j++) {
        const double *out = t->phase[e->p].out + (interval->first + j) * phase->map->n_out;
        for (int i = 0; i < e->n; i++)
            e->slope[i] += ell[j] * out[moray_examiner_output(e, i)];
    }
}

static double distance_outside(double value, moray_bounds bounds, double size)
{
    if (isnan(value))
        return INFINITY;
    const double bound = value < bounds.lower ? bounds.lower : bounds.upper;
    const double far = fmax(fmax(bounds.lower - value, value - bounds.upper), 0);
    return far > 0 ? far / ((size > 0 ? size : 1) + fabs(bound)) : 0;
}

// Interpolated controls are kept within their bounds.
static double worst_outside(const struct examiner *e)
{
    const struct phase *phase = &e->solution->transcription->ocp->phase[e->p];
    const double *in_size = e->witness->size, *out_size = e->witness->out_size;
    const int nx = phase->nx;
    double worst = 0;
    for (int r = 0; r < nx; r++)
        worst = fmax(worst, distance_outside(e->in[r], phase->x[r], in_size[r]));
    for (int r = nx; r < nx + phase->nc; r++)
        worst = fmax(worst, distance_outside(e->out[r], phase->c[r - nx], out_size[r]));
    return worst;
}

// The midpoint rule, whose points lie between the nodes.
double moray_examiner_interval(struct examiner *e, const struct interval *interval, double *outside)
{
    const struct transcription *t = e->solution->transcription;
    const struct phase_cache *cache = &t->phase[e->p];
    const int count = moray_points_between(interval, samples_between * interval->scheme->points);
    const double T = cache->tf - cache->t0, start = t->layout.phase[e->p].node[interval->first].tau;
    double ell[MORAY_MAX_STAGES + 2], integral[MORAY_MAX_STAGES + 2];
    memset(e->error, 0, (size_t)e->n * sizeof *e->error);
    for (int k = 0; k < count; k++) {
        const double tau = (k + 0.5) / count;
        moray_scheme_basis(interval->scheme, tau, ell, integral);
        moray_examiner_place_by_basis(e, interval, cache->t0 + T * (start + tau * interval->width), ell, integral);
        evaluate(e);
        interpolant_slope(e, interval, ell);
        for (int i = 0; i < e->n; i++)
            e->error[i] +=
                T * interval->width / count * fabs(e->slope[i] - e->out[moray_examiner_output(e, i)]) / e->size[i];
        if (outside)
            *outside = fmax(*outside, worst_outside(e));
    }
    double worst = 0;
    for (int i = 0; i < e->n; i++)
        worst = fmax(worst, isnan(e->error[i]) ? INFINITY : e->error[i]);
    return worst;
}

double moray_examiner_error(struct examiner *e, const struct interval *interval)
{
    double outside = 0;
    const double error = moray_examiner_interval(e, interval, &outside);
    return fmax(error, outside / violation_slack);
}
