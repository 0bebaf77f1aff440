// SPDX-License-Identifier: MIT
#include "ocp/examine.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { samples_between = 5 }; // per point of the scheme, placed between the nodes

moray_status examiner_new(struct examiner *e, const moray_solution *solution, int p)
{
    const struct phase *phase = &solution->transcription->ocp->phase[p];
    double *block = calloc((size_t)(phase->map->n_in + phase->map->n_out + 3 * phase->nx), sizeof *block);
    if (!block)
        return moray_error(MORAY_MEMORY, "no memory to examine phase %s", phase->name);
    *e = (struct examiner){.solution = solution, .p = p, .in = block, .out = block + phase->map->n_in};
    e->x_size = e->out + phase->map->n_out;
    e->slope = e->x_size + phase->nx;
    e->error = e->slope + phase->nx;
    const struct phase_layout *layout = &solution->transcription->layout.phase[p];
    for (int r = 0; r < phase->nx; r++) {
        for (int n = 0; n < layout->nodes; n++)
            e->x_size[r] = fmax(e->x_size[r], fabs(solution->iterate.x[layout->node[n].x + r]));
        e->x_size[r] += 1;
    }
    return moray_ok();
}

void examiner_free(struct examiner *e)
{
    free(e->in);
}

void examiner_evaluate(struct examiner *e, double t, const double *x)
{
    const struct phase *phase = &e->solution->transcription->ocp->phase[e->p];
    moray_solution_at(e->solution, e->p, t, e->in, e->in + phase->nx);
    if (x)
        memcpy(e->in, x, (size_t)phase->nx * sizeof *x);
    memcpy(e->in + phase->nx + phase->nu, moray_solution_parameters(e->solution), (size_t)phase->ns * sizeof *e->in);
    e->in[phase->map->n_in - 1] = t;
    phase->map->value(phase->map->self, e->in, e->out);
}

// x~' at tau of the interval: the stage polynomials through f at the nodes.
static void interpolant_slope(struct examiner *e, const struct interval *interval, double tau)
{
    const struct transcription *t = e->solution->transcription;
    const struct phase *phase = &t->ocp->phase[e->p];
    double ell[MORAY_MAX_STAGES + 2], integral[MORAY_MAX_STAGES + 2];
    moray_scheme_basis(interval->scheme, tau, ell, integral);
    memset(e->slope, 0, (size_t)phase->nx * sizeof *e->slope);
    for (int j = interval->scheme->first; j <= interval->scheme->last; j++)
        for (int r = 0; r < phase->nx; r++)
            e->slope[r] += ell[j] * t->phase[e->p].out[(interval->first + j) * phase->map->n_out + r];
}

static double distance_outside(double value, moray_bounds bounds)
{
    if (isnan(value))
        return INFINITY;
    if (value < bounds.lower)
        return (bounds.lower - value) / (1 + fabs(bounds.lower));
    return value > bounds.upper ? (value - bounds.upper) / (1 + fabs(bounds.upper)) : 0;
}

static double worst_outside(const struct examiner *e)
{
    const struct phase *phase = &e->solution->transcription->ocp->phase[e->p];
    double worst = 0;
    for (int r = 0; r < phase->nx; r++)
        worst = fmax(worst, distance_outside(e->in[r], phase->x[r]));
    for (int r = 0; r < phase->nu; r++)
        worst = fmax(worst, distance_outside(e->in[phase->nx + r], phase->u[r]));
    for (int r = 0; r < phase->nc; r++)
        worst = fmax(worst, distance_outside(e->out[phase->nx + r], phase->c[r]));
    return worst;
}

// The midpoint rule, whose points lie between the nodes.
double examiner_interval(struct examiner *e, const struct interval *interval, double *outside)
{
    const struct transcription *t = e->solution->transcription;
    const struct phase_cache *cache = &t->phase[e->p];
    const int nx = t->ocp->phase[e->p].nx, count = samples_between * interval->scheme->points;
    const double T = cache->tf - cache->t0, start = t->layout.phase[e->p].node[interval->first].tau;
    memset(e->error, 0, (size_t)nx * sizeof *e->error);
    for (int k = 0; k < count; k++) {
        const double tau = (k + 0.5) / count;
        examiner_evaluate(e, cache->t0 + T * (start + tau * interval->width), NULL);
        interpolant_slope(e, interval, tau);
        for (int r = 0; r < nx; r++)
            e->error[r] += T * interval->width / count * fabs(e->slope[r] - e->out[r]) / e->x_size[r];
        if (outside)
            *outside = fmax(*outside, worst_outside(e));
    }
    double worst = 0;
    for (int r = 0; r < nx; r++)
        worst = fmax(worst, isnan(e->error[r]) ? INFINITY : e->error[r]);
    return worst;
}
