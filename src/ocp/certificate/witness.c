// SPDX-License-Identifier: MIT
#include "ocp/certificate/witness.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "ocp/certificate/columns.h"
#include "ocp/hold.h"
#include "ocp/probe.h"

static const double least_part = 1e-3; // of a magnitude, or of what would matter to the objective, that makes a size
static const double driving = 0.1;     // of what it takes to move a state by its size
static const double trial_part = 0.1;  // of a size, by which inputs are moved
static const double silent = 1e-6;     // doubt of a derivative, relative, at which it says nothing
static const double endless = 1e15;    // width of bounds that say nothing

// ---- Memory ----

static const struct phase_cache *cache_of(const struct witness *e, int p)
{
    return &e->solution->transcription->phase[p];
}

static const struct phase_layout *layout_of(const struct witness *e, int p)
{
    return &e->solution->transcription->layout.phase[p];
}

static double span_of(const struct witness *e, int p)
{
    return cache_of(e, p)->tf - cache_of(e, p)->t0;
}

static moray_status allocate_phase(struct witness *e, int p, bool differences)
{
    const moray_map *map = cache_of(e, p)->map;
    const size_t n_in = (size_t)map->n_in, n_out = (size_t)map->n_out,
                 nq = (size_t)e->solution->transcription->ocp->phase[p].nq;
    struct phase_witness *phase = &e->phase[p];
    phase->size = calloc(n_in + n_out + nq + n_in * n_out, sizeof *phase->size);
    if (!phase->size)
        return moray_error(MORAY_MEMORY, "no memory for the certificate");
    phase->out_size = phase->size + n_in;
    phase->integral = phase->out_size + n_out;
    phase->slope = phase->integral + nq;
    return differences ? moray_kept_new(&phase->kept, map, layout_of(e, p)->nodes) : moray_ok();
}

static moray_status allocate(struct witness *e, bool differences)
{
    const struct transcription *t = e->solution->transcription;
    const size_t n_in = (size_t)t->endpoint->n_in, n_out = (size_t)t->endpoint->n_out;
    e->phase = calloc((size_t)t->ocp->phases, sizeof *e->phase);
    e->end_size = calloc(n_in + n_out, sizeof *e->end_size);
    if (!e->phase || !e->end_size)
        return moray_error(MORAY_MEMORY, "no memory for the certificate");
    e->end_out_size = e->end_size + n_in;
    if (differences)
        MORAY_TRY(moray_kept_new(&e->end, t->endpoint, 1));
    for (int p = 0; p < t->ocp->phases; p++)
        MORAY_TRY(allocate_phase(e, p, differences));
    return moray_ok();
}

void moray_witness_free(struct witness *e)
{
    for (int p = 0; e->phase && p < e->solution->transcription->ocp->phases; p++) {
        free(e->phase[p].size);
        moray_kept_free(&e->phase[p].kept);
    }
    moray_kept_free(&e->end);
    free(e->phase);
    free(e->end_size);
    *e = (struct witness){0};
}

// ---- Sizes from the trajectory ----

static double width_of(moray_bounds bounds)
{
    const double width = bounds.upper - bounds.lower;
    return width < endless ? width : 0;
}

// Of an input along the phase: its range, or a part of its magnitude where it hardly moves.
static double range_of(const struct witness *e, int p, int i)
{
    const struct phase_cache *cache = cache_of(e, p);
    double least = INFINITY, most = -INFINITY;
    for (int n = 0; n < layout_of(e, p)->nodes; n++) {
        if (!layout_of(e, p)->node[n].collocated)
            continue;
        least = fmin(least, cache->in[n * cache->map->n_in + i]);
        most = fmax(most, cache->in[n * cache->map->n_in + i]);
    }
    return fmax(most - least, least_part * fmax(fabs(least), fabs(most)));
}

static moray_bounds bounds_of(const struct witness *e, int p, int i)
{
    const moray_ocp *ocp = e->solution->transcription->ocp;
    const struct phase *phase = &ocp->phase[p];
    if (i < phase->nx)
        return phase->x[i];
    if (i < phase->nx + phase->nu)
        return phase->u[i - phase->nx];
    return i < phase->nx + phase->nu + phase->ns ? ocp->s[i - phase->nx - phase->nu] : moray_free();
}

static void take_ranges(struct witness *e, int p)
{
    const int time = cache_of(e, p)->map->n_in - 1, parameters = time - e->solution->transcription->ocp->ns;
    double *size = e->phase[p].size;
    for (int i = 0; i < time; i++)
        size[i] = i < parameters ? range_of(e, p, i) : fabs(cache_of(e, p)->in[i]);
    for (int i = parameters; i < time; i++)
        size[i] = fabs(moray_solution_parameters(e->solution)[i - parameters]);
    size[time] = fabs(span_of(e, p));
    e->duration = fmax(e->duration, size[time]);
}

// ---- Derivatives ----

// A slope that moves an output by no more than its last digits over all that the input does (a table that an argument
// has no part in, say) drives nothing.
static void note_slope(double *slope, double value, double size, double out)
{
    if (size <= 0 || fabs(value) * size > 16 * DBL_EPSILON * fabs(out))
        *slope = fmax(*slope, fabs(value));
}

// |output| at most, over all nodes.
static double largest_output(const struct phase_cache *cache, int nodes, int out)
{
    double most = 0;
    for (int n = 0; n < nodes; n++)
        most = fmax(most, fabs(cache->out[n * cache->map->n_out + out]));
    return most;
}

// Without differences, those in use.
static void take_in_use(struct witness *e, int p)
{
    const struct phase_cache *cache = cache_of(e, p);
    const moray_map *map = cache->map;
    const int nodes = layout_of(e, p)->nodes;
    for (int k = 0; k < map->jac.nnz; k++) {
        const int in = map->jac.col[k], out = map->jac.row[k];
        const double most = largest_output(cache, nodes, out);
        for (int n = 0; n < nodes; n++)
            if (layout_of(e, p)->node[n].collocated)
                note_slope(&e->phase[p].slope[in * map->n_out + out], cache->jac[n * map->jac.nnz + k],
                           e->phase[p].size[in], most);
    }
}

// most[n_out]: |output| at most.
static moray_status difference_node(struct phase_witness *w, const double *in, const double *step, const double *most)
{
    struct kept *k = &w->kept;
    const size_t n_out = (size_t)k->map->n_out, block = (size_t)k->map->n_in * n_out;
    MORAY_TRY(moray_difference_columns(k->map, in, step, k->jac, k->doubt, k->kink));
    for (size_t i = 0; i < block; i++)
        if (fabs(k->jac[i]) > k->doubt[i])
            note_slope(&w->slope[i], k->jac[i], w->size[i / n_out], most[i % n_out]);
    return moray_kept_add(k);
}

static moray_status difference_phase(struct witness *e, int p)
{
    const struct phase_cache *cache = cache_of(e, p);
    const size_t n_in = (size_t)cache->map->n_in, n_out = (size_t)cache->map->n_out;
    const int nodes = layout_of(e, p)->nodes;
    double *step = calloc(n_in + n_out, sizeof *step), *most = step ? step + n_in : NULL;
    moray_status status = step ? moray_ok() : moray_error(MORAY_MEMORY, "no memory for the certificate");
    for (size_t i = 0; i < n_in && step; i++) {
        step[i] = fmax(e->phase[p].size[i], 0.1 * least_part * width_of(bounds_of(e, p, (int)i)));
        step[i] = step[i] > 0 ? step[i] : 1;
    }
    for (size_t i = 0; i < n_out && step; i++)
        most[i] = largest_output(cache, nodes, (int)i);
    for (int n = 0; n < nodes && !moray_failed(status); n++)
        if (layout_of(e, p)->node[n].collocated)
            status = difference_node(&e->phase[p], cache->in + (size_t)n * n_in, step, most);
        else
            moray_kept_skip(&e->phase[p].kept);
    free(step);
    return status;
}

// ---- Sizes of what hardly moves, from what it does ----

// What is smaller than it takes to move a state that it drives is that large at least.
static void raise_by_effect(struct witness *e, int p)
{
    const struct phase *phase = &e->solution->transcription->ocp->phase[p];
    const int n_out = cache_of(e, p)->map->n_out;
    double *size = e->phase[p].size;
    for (int j = 0; j < cache_of(e, p)->map->n_in - 1; j++) {
        double least = INFINITY;
        for (int i = 0; i < phase->nx; i++) {
            const double slope = fabs(span_of(e, p)) * e->phase[p].slope[j * n_out + i];
            if (size[i] > 0 && slope > 0)
                least = fmin(least, size[i] / slope);
        }
        size[j] = isfinite(least) ? fmax(size[j], driving * least) : size[j];
        if (size[j] <= 0)
            size[j] = width_of(bounds_of(e, p, j)) > 0 ? width_of(bounds_of(e, p, j)) : 1;
    }
}

static void size_integrals(struct witness *e, int p)
{
    const struct phase *phase = &e->solution->transcription->ocp->phase[p];
    const struct phase_cache *cache = cache_of(e, p);
    for (int m = 0; m < phase->nq; m++) {
        double sum = 0;
        for (int n = 0; n < layout_of(e, p)->nodes; n++)
            sum += fabs(span_of(e, p) * layout_of(e, p)->node[n].weight *
                        cache->out[n * cache->map->n_out + phase->nx + phase->nc + m]);
        e->phase[p].integral[m] = fmax(e->phase[p].integral[m], sum);
    }
}

// Inputs of the endpoint: [x0, t0, xf, tf, q, and where read u0, uf] of each phase, s, and [x, u] of each observed
// time.
static void size_ends(struct witness *e)
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

// A state whose displacement by its size would hardly change the objective, by its costate, may be larger: one that is
// 0 by symmetry has only rounding for a range.
static moray_status raise_by_costate(struct witness *e, int p)
{
    const struct phase *phase = &e->solution->transcription->ocp->phase[p];
    const int nodes = layout_of(e, p)->nodes, nx = phase->nx;
    const double objective = moray_witness_objective(e);
    double *costate = calloc((size_t)nodes * (size_t)nx + 1, sizeof *costate);
    if (!costate)
        return moray_error(MORAY_MEMORY, "no memory for the certificate");
    moray_solution_nodes(e->solution, p, NULL, costate);
    for (int i = 0; i < nx; i++) {
        double largest = 0;
        for (int n = 0; n < nodes; n++)
            largest = fmax(largest, fabs(costate[n * nx + i]));
        const double width = width_of(phase->x[i]), most = width > 0 ? width : 1;
        e->phase[p].size[i] = fmax(e->phase[p].size[i], least_part * fmin(most, objective / largest));
    }
    free(costate);
    return moray_ok();
}

// ---- Sizes of outputs ----

// Raises out_size[n_out] to what the outputs move by where an input moves by its size; a hundredth of that in doubt.
static void move_inputs(const moray_map *map, const double *in, const double *out, const double *size, double *work,
                        double *out_size)
{
    double *moved = work + map->n_in;
    memcpy(work, in, (size_t)map->n_in * sizeof *work);
    for (int j = 0; j < map->n_in; j++) {
        for (int side = -1; side <= 1; side += 2) {
            work[j] = in[j] + side * trial_part * size[j];
            map->value(map->self, work, moved);
            for (int i = 0; i < map->n_out; i++)
                if (isfinite(moved[i]))
                    out_size[i] = fmax(out_size[i], fabs(moved[i] - out[i]) / trial_part);
        }
        work[j] = in[j];
    }
}

static moray_status size_outputs(struct witness *e, int p)
{
    const struct phase_cache *cache = cache_of(e, p);
    const struct phase *phase = &e->solution->transcription->ocp->phase[p];
    const int n_in = cache->map->n_in, n_out = cache->map->n_out, g = phase->nx + phase->nc;
    double *work = calloc((size_t)(n_in + 2 * n_out), sizeof *work);
    if (!work)
        return moray_error(MORAY_MEMORY, "no memory for the certificate");
    double *here = work + n_in + n_out;
    for (int n = 0; n < layout_of(e, p)->nodes; n++) {
        const struct node *node = &layout_of(e, p)->node[n];
        if (!node->collocated)
            continue;
        memset(here, 0, (size_t)n_out * sizeof *here);
        move_inputs(cache->map, cache->in + n * n_in, cache->out + n * n_out, e->phase[p].size, work, here);
        for (int i = 0; i < n_out; i++)
            e->phase[p].out_size[i] = fmax(e->phase[p].out_size[i], here[i]);
        for (int m = 0; m < phase->nq; m++)
            e->phase[p].integral[m] += fabs(span_of(e, p)) * node->weight * here[g + m];
    }
    free(work);
    return moray_ok();
}

static moray_status size_end_outputs(struct witness *e)
{
    const struct transcription *t = e->solution->transcription;
    double *work = calloc((size_t)(t->endpoint->n_in + t->endpoint->n_out), sizeof *work);
    if (!work)
        return moray_error(MORAY_MEMORY, "no memory for the certificate");
    memset(e->end_out_size, 0, (size_t)t->endpoint->n_out * sizeof *e->end_out_size);
    move_inputs(t->endpoint, t->end_in, t->end_out, e->end_size, work, e->end_out_size);
    free(work);
    return moray_ok();
}

double moray_witness_objective(const struct witness *e)
{
    return e->end_out_size[0] > 0 ? e->end_out_size[0] : 1;
}

// ---- All of it ----

static moray_status gather(struct witness *e, bool differences)
{
    const struct transcription *t = e->solution->transcription;
    MORAY_TRY(allocate(e, differences));
    for (int p = 0; p < t->ocp->phases; p++) {
        take_ranges(e, p);
        if (differences)
            MORAY_TRY(difference_phase(e, p));
        else
            take_in_use(e, p);
        raise_by_effect(e, p);
        size_integrals(e, p);
    }
    size_ends(e);
    MORAY_TRY(size_end_outputs(e));
    for (int p = 0; p < t->ocp->phases; p++) {
        MORAY_TRY(raise_by_costate(e, p));
        MORAY_TRY(size_outputs(e, p));
        size_integrals(e, p);
    }
    size_ends(e);
    MORAY_TRY(size_end_outputs(e));
    if (!differences)
        return moray_ok();
    MORAY_TRY(moray_difference_columns(t->endpoint, t->end_in, e->end_size, e->end.jac, e->end.doubt, e->end.kink));
    return moray_kept_add(&e->end);
}

static moray_status create(struct witness *e, const moray_solution *solution, bool differences)
{
    *e = (struct witness){.solution = solution};
    const moray_status status = gather(e, differences);
    if (moray_failed(status))
        moray_witness_free(e);
    return status;
}

moray_status moray_witness_new(struct witness *e, const moray_solution *solution)
{
    return create(e, solution, true);
}

moray_status moray_witness_of_sizes(struct witness *e, const moray_solution *solution)
{
    return create(e, solution, false);
}

bool moray_witness_speaks(double doubt, double kink, double size, double out_size)
{
    return (doubt + fabs(kink)) * size <= silent * out_size;
}

const struct kept *moray_witness_at(const struct witness *e, int p, int node)
{
    const struct kept *kept = p < 0 ? &e->end : &e->phase[p].kept;
    moray_kept_show(kept, p < 0 ? 0 : node);
    return kept;
}

void moray_witness_in_use(const struct witness *e, int p, int node, double *jac)
{
    const struct transcription *t = e->solution->transcription;
    const moray_map *map = p < 0 ? t->endpoint : t->phase[p].map;
    const double *values = p < 0 ? t->end_jac : t->phase[p].jac + node * map->jac.nnz;
    memset(jac, 0, (size_t)map->n_in * (size_t)map->n_out * sizeof *jac);
    for (int k = 0; k < map->jac.nnz; k++)
        jac[map->jac.col[k] * map->n_out + map->jac.row[k]] += values[k];
}

// ---- Sizes of the programme ----

void moray_witness_columns(const struct witness *e, double *size)
{
    const struct transcription *t = e->solution->transcription;
    for (int p = 0; p < t->ocp->phases; p++) {
        const struct phase *phase = &t->ocp->phase[p];
        const struct phase_layout *layout = layout_of(e, p);
        for (int n = 0; n < layout->nodes; n++)
            memcpy(size + layout->node[n].x, e->phase[p].size,
                   (size_t)(phase->nx + (layout->node[n].collocated ? phase->nu : 0)) * sizeof *size);
        memcpy(size + layout->q, e->phase[p].integral, (size_t)phase->nq * sizeof *size);
        for (int end = 0; end < 2; end++)
            if (layout->u_row[end] >= 0)
                memcpy(size + layout->u_end[end], e->phase[p].size + phase->nx, (size_t)phase->nu * sizeof *size);
        if (layout->t0 >= 0)
            size[layout->t0] = e->duration;
        if (layout->tf >= 0)
            size[layout->tf] = e->duration;
    }
    memcpy(size + t->layout.s, e->end_size + moray_endpoint_inputs(t->ocp) - t->ocp->ns,
           (size_t)t->ocp->ns * sizeof *size);
    for (int j = 0; j < t->layout.columns; j++)
        size[j] = size[j] > 0 ? size[j] : 1;
}

// A defect is an error in its state; other rows move with what they depend on.
void moray_witness_rows(const struct witness *e, double *size)
{
    const struct transcription *t = e->solution->transcription;
    for (int p = 0; p < t->ocp->phases; p++) {
        const struct phase *phase = &t->ocp->phase[p];
        const struct phase_layout *layout = layout_of(e, p);
        for (int n = 0; n < layout->nodes; n++)
            if (layout->node[n].collocated)
                memcpy(size + layout->node[n].path, e->phase[p].out_size + phase->nx, (size_t)phase->nc * sizeof *size);
        for (int k = 0; k < layout->mesh.intervals; k++)
            for (int i = 0; i < layout->interval[k].scheme->points - 1; i++)
                memcpy(size + layout->interval[k].defect + i * phase->nx, e->phase[p].size,
                       (size_t)phase->nx * sizeof *size);
        memcpy(size + layout->integral_row, e->phase[p].integral, (size_t)phase->nq * sizeof *size);
        for (int end = 0; end < 2; end++)
            if (layout->u_row[end] >= 0)
                memcpy(size + layout->u_row[end], e->phase[p].size + phase->nx, (size_t)phase->nu * sizeof *size);
        moray_fill_holds(layout, phase, e->phase[p].size + phase->nx, size);
        if (layout->length_row >= 0)
            size[layout->length_row] = e->duration;
    }
    memcpy(size + t->layout.events, e->end_out_size + 1, (size_t)t->ocp->ne * sizeof *size);
    for (int i = 0; i < t->layout.rows; i++)
        size[i] = size[i] > 0 ? size[i] : 1;
}
