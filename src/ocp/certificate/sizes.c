// SPDX-License-Identifier: MIT
//
// How far everything that functions depend on moves at a solution.
#include "ocp/certificate/sizes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double least_part = 1e-3; // of a magnitude, or of what would matter to the objective, that makes a size
static const double driving = 0.1;     // of what it takes to move a state by its size

const struct phase_cache *moray_witness_cache(const struct witness *e, int p)
{
    return &e->solution->transcription->phase[p];
}

const struct phase_layout *moray_witness_layout(const struct witness *e, int p)
{
    return &e->solution->transcription->layout.phase[p];
}

double moray_witness_span(const struct witness *e, int p)
{
    return moray_witness_cache(e, p)->tf - moray_witness_cache(e, p)->t0;
}

// ---- Sizes from the trajectory ----

double moray_witness_width(moray_bounds bounds)
{
    const double width = bounds.upper - bounds.lower;
    return width < MORAY_ENDLESS ? width : 0;
}

// Of an input along the phase: its range, or a part of its magnitude where it hardly moves.
static double range_of(const struct witness *e, int p, int i)
{
    const struct phase_cache *cache = moray_witness_cache(e, p);
    double least = INFINITY, most = -INFINITY;
    for (int n = 0; n < moray_witness_layout(e, p)->nodes; n++) {
        if (!moray_witness_layout(e, p)->node[n].collocated)
            continue;
        least = fmin(least, cache->in[n * cache->map->n_in + i]);
        most = fmax(most, cache->in[n * cache->map->n_in + i]);
    }
    return fmax(most - least, least_part * fmax(-least, most));
}

void moray_size_by_range(struct witness *e, int p)
{
    const int time = moray_witness_cache(e, p)->map->n_in - 1, parameters = time - e->solution->transcription->ocp->ns;
    double *size = e->phase[p].size;
    for (int i = 0; i < parameters; i++)
        size[i] = range_of(e, p, i);
    for (int i = parameters; i < time; i++)
        size[i] = fabs(moray_solution_parameters(e->solution)[i - parameters]);
    size[time] = fabs(moray_witness_span(e, p));
    e->duration = fmax(e->duration, size[time]);
}

// ---- Sizes of what hardly moves, from what it does ----

// What is smaller than it takes to move a state that it drives is that large at least.
void moray_size_by_effect(struct witness *e, int p)
{
    const struct phase *phase = &e->solution->transcription->ocp->phase[p];
    const int n_out = moray_witness_cache(e, p)->map->n_out;
    double *size = e->phase[p].size;
    for (int j = 0; j < moray_witness_cache(e, p)->map->n_in - 1; j++) {
        double least = INFINITY;
        for (int i = 0; i < phase->nx; i++) {
            const double slope = fabs(moray_witness_span(e, p)) * e->phase[p].slope[j * n_out + i];
            if (size[i] > 0)
                least = fmin(least, size[i] / slope); // infinite without a slope
        }
        size[j] = isfinite(least) ? fmax(size[j], driving * least) : size[j];
        const double width = moray_witness_width(e->phase[p].box[j]);
        if (size[j] <= 0)
            size[j] = width > 0 ? width : 1;
        size[j] = width > 0 ? fmin(size[j], width) : size[j]; // further it never moves
    }
}

void moray_size_integrals(struct witness *e, int p)
{
    const struct phase *phase = &e->solution->transcription->ocp->phase[p];
    const struct phase_cache *cache = moray_witness_cache(e, p);
    for (int m = 0; m < phase->nq; m++) {
        double sum = 0;
        for (int n = 0; n < moray_witness_layout(e, p)->nodes; n++)
            sum += fabs(moray_witness_span(e, p) * moray_witness_layout(e, p)->node[n].weight *
                        cache->out[n * cache->map->n_out + phase->nx + phase->nc + m]);
        e->phase[p].integral[m] = fmax(e->phase[p].integral[m], sum);
    }
}

// Inputs of the endpoint: [x0, t0, xf, tf, q, and where read u0, uf] of each phase, s, and [x, u] of each observed
// time.
void moray_size_ends(struct witness *e)
{
    const moray_ocp *ocp = e->solution->transcription->ocp;
    double *size = e->end_size;
    for (int p = 0; p < ocp->phases; p++) {
        const struct phase *phase = &ocp->phase[p];
        for (int end = 0; end < 2; end++) {
            memcpy(size, e->phase[p].size, (size_t)phase->nx * sizeof *size);
            size[phase->nx] = e->duration;
            size += phase->nx + 1;
        }
        for (int m = 0; m < phase->nq; m++)
            *size++ = e->phase[p].integral[m] > 0 ? e->phase[p].integral[m] : 1;
        for (int end = 0; end < 2 && phase->end_controls; end++, size += phase->nu)
            memcpy(size, e->phase[p].size + phase->nx, (size_t)phase->nu * sizeof *size);
    }
    memcpy(size, e->phase[0].size + ocp->phase[0].nx + ocp->phase[0].nu, (size_t)ocp->ns * sizeof *size);
    size += ocp->ns;
    for (int p = 0; p < ocp->phases; p++)
        for (int k = 0; k < ocp->phase[p].observed.n; k++, size += ocp->phase[p].nx + ocp->phase[p].nu)
            memcpy(size, e->phase[p].size, (size_t)(ocp->phase[p].nx + ocp->phase[p].nu) * sizeof *size);
}

// What would matter to the objective, whose change by the quantity is `slope`, or by a part of what it may be at most.
static double mattering(moray_bounds bounds, double objective, double slope)
{
    const double width = moray_witness_width(bounds), most = width > 0 ? width : 1;
    return least_part * fmin(most, objective / slope);
}

// An integral that is 0 has only rounding for a sum; one that the objective knows nothing of, for a multiplier.
static void size_integrals_by_multiplier(struct witness *e, int p, double objective)
{
    const struct phase *phase = &e->solution->transcription->ocp->phase[p];
    const double *lambda = e->solution->iterate.lambda + moray_witness_layout(e, p)->integral_row;
    for (int m = 0; m < phase->nq; m++)
        e->phase[p].integral[m] = fmax(e->phase[p].integral[m], mattering(phase->q[m], objective, fabs(lambda[m])));
}

// A state whose displacement by its size would hardly change the objective, by its costate, may be larger: one that is
// 0 by symmetry has only rounding for a range.
moray_status moray_size_by_costate(struct witness *e, int p)
{
    const struct phase *phase = &e->solution->transcription->ocp->phase[p];
    const int nodes = moray_witness_layout(e, p)->nodes, nx = phase->nx;
    const double objective = moray_witness_objective(e);
    double *costate = calloc((size_t)nodes * (size_t)nx + 1, sizeof *costate);
    if (!costate)
        return moray_error(MORAY_MEMORY, "no memory for the certificate");
    moray_solution_nodes(e->solution, p, NULL, costate);
    for (int i = 0; i < nx; i++) {
        double largest = 0;
        for (int n = 0; n < nodes; n++)
            largest = fmax(largest, fabs(costate[n * nx + i]));
        e->phase[p].size[i] = fmax(e->phase[p].size[i], mattering(phase->x[i], objective, largest));
    }
    free(costate);
    size_integrals_by_multiplier(e, p, objective);
    return moray_ok();
}
