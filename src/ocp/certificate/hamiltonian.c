// SPDX-License-Identifier: MIT
//
// Along an optimum H' = dH/dt, with H = g + lambda f + mu c: constant where no function depends on time.
#include <math.h>
#include <stdlib.h>

#include "ocp/certificate/certify.h"

struct course {
    const struct witness *w;
    int p;
    double *H, *rate, *gained; // [nodes] H, dH/dt, and its integral from the start; NaN where not collocated
    double size;
};

static bool is_timeless(const struct witness *w, int p, int n)
{
    const moray_map *map = w->solution->transcription->phase[p].map;
    const double *slope = moray_witness_at(w, p, n)->jac + (map->n_in - 1) * map->n_out;
    for (int i = 0; i < map->n_out; i++)
        if (slope[i] != 0) // nor is it where differences find none
            return false;
    return true;
}

// dH/dt at a node, multipliers of path constraints as densities in time; *size: the sum of the terms of H.
static double rate_at(const struct course *c, int n, const double *costate, double *size)
{
    const struct transcription *t = c->w->solution->transcription;
    const struct phase *phase = &t->ocp->phase[c->p];
    const struct phase_layout *layout = &t->layout.phase[c->p];
    const struct phase_cache *cache = &t->phase[c->p];
    const double *lambda = c->w->solution->iterate.lambda, T = cache->tf - cache->t0;
    const double *out = cache->out + n * cache->map->n_out;
    const int n_out = cache->map->n_out, nx = phase->nx, nc = phase->nc;
    const double *slope = moray_witness_at(c->w, c->p, n)->jac + (cache->map->n_in - 1) * n_out;
    double rate = 0;
    *size = 0;
    for (int i = 0; i < n_out; i++) {
        const bool path = i >= nx && i < nx + nc;
        const double weight = i < nx ? costate[i]
                              : path ? lambda[layout->node[n].path + i - nx] / (T * layout->node[n].weight)
                                     : -lambda[layout->integral_row + i - nx - nc];
        rate += isfinite(slope[i]) ? weight * slope[i] : 0;
        *size += path ? 0 : fabs(weight * out[i]);
    }
    return rate;
}

// By the polynomials of every interval, as the scheme integrates.
static void integrate(const struct course *c)
{
    const struct transcription *t = c->w->solution->transcription;
    const struct phase_layout *layout = &t->layout.phase[c->p];
    const double T = t->phase[c->p].tf - t->phase[c->p].t0;
    double start = 0;
    for (int k = 0; k < layout->mesh.intervals; k++) {
        const struct interval *interval = &layout->interval[k];
        const int points = interval->scheme->points;
        for (int i = 0; i < points; i++) {
            double *gained = &c->gained[interval->first + i];
            *gained = start;
            for (int j = 0; j < points; j++)
                *gained += T * interval->width * interval->scheme->A[i * points + j] * c->rate[interval->first + j];
        }
        start = c->gained[interval->first + points - 1];
    }
}

// Mean over the phase: at the nodes beside a kink of a multiplier the Hamiltonian is of low order.
static void measure(const struct course *c, struct finding *drift)
{
    const struct transcription *t = c->w->solution->transcription;
    const struct phase_layout *layout = &t->layout.phase[c->p];
    double mean = 0, sum = 0, worst = 0, when = 0;
    for (int n = 0; n < layout->nodes; n++)
        if (layout->node[n].collocated)
            mean += layout->node[n].weight * (c->H[n] - c->gained[n]);
    for (int n = 0; n < layout->nodes; n++) {
        const double far = layout->node[n].collocated ? fabs(c->H[n] - c->gained[n] - mean) : 0;
        sum += layout->node[n].weight * far;
        if (far > worst) {
            worst = far;
            when = t->phase[c->p].t0 + (t->phase[c->p].tf - t->phase[c->p].t0) * layout->node[n].tau;
        }
    }
    if (c->size > 0)
        moray_find(drift, sum / c->size, c->p, when);
}

moray_status moray_hamiltonian_drift(const struct witness *w, int p, struct finding *drift, bool *autonomous)
{
    const struct transcription *t = w->solution->transcription;
    const int nodes = t->layout.phase[p].nodes, nx = t->ocp->phase[p].nx;
    double *block = calloc((size_t)nodes * (size_t)(nx + 3), sizeof *block);
    if (!block)
        return moray_error(MORAY_MEMORY, "no memory for the certificate");
    double *costate = block + 3 * nodes;
    struct course c = {w, p, block, block + nodes, block + 2 * nodes, 0};
    moray_solution_nodes(w->solution, p, NULL, costate);
    moray_solution_hamiltonian(w->solution, p, c.H);
    *autonomous = true;
    for (int n = 0; n < nodes; n++) {
        double size = 0;
        *autonomous = *autonomous && is_timeless(w, p, n);
        c.rate[n] = t->layout.phase[p].node[n].collocated ? rate_at(&c, n, costate + n * nx, &size) : 0;
        c.size = fmax(c.size, size);
    }
    integrate(&c);
    measure(&c, drift);
    free(block);
    return moray_ok();
}
