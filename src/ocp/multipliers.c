// SPDX-License-Identifier: MIT
//
// Multipliers of a solution on one mesh as a start on another. Those of rows and bounds at a node are a density in time
// by the quadrature weight of the node; the densities are interpolated linearly. Those of the defects follow from the
// costates.
#include <stdlib.h>
#include <string.h>

#include "ocp/solution.h"

// The old mesh of a phase and the new.
struct transfer {
    struct alignment at;
    const moray_solution *from;
    moray_solution *to;
    int p;
    const struct phase_layout *old, *new;
    double *density, *here; // [old->nodes][width], [width]
};

// Where the entries of a node begin in a vector of multipliers.
enum kind { of_state, of_control, of_path };

static int place(const struct transfer *t, const struct node *node, enum kind kind)
{
    const int nx = t->to->transcription->ocp->phase[t->p].nx;
    return kind == of_path ? node->path : kind == of_control ? node->x + nx : node->x;
}

static void interpolate(const struct transfer *t, double tau_new, int width)
{
    const double tau = fmin(fmax(t->at.shift + t->at.stretch * tau_new, 0), 1);
    int k = 0;
    for (int step = t->old->nodes; step > 0; step /= 2) // the last node at or before tau
        while (k + step < t->old->nodes && t->old->node[k + step].tau <= tau)
            k += step;
    const int next = k + 1 < t->old->nodes ? k + 1 : k;
    const double span = t->old->node[next].tau - t->old->node[k].tau;
    const double part = span > 0 ? (tau - t->old->node[k].tau) / span : 0;
    for (int i = 0; i < width; i++)
        t->here[i] = (1 - part) * t->density[k * width + i] + part * t->density[next * width + i];
}

// Ends may not be collocated, and those of states have bounds of their own.
static void take_densities(const struct transfer *t, const double *source, enum kind kind, int width)
{
    for (int n = 0; n < t->old->nodes; n++) {
        const bool end = n == 0 || n == t->old->nodes - 1;
        const int near = t->old->node[n].collocated && !(end && kind == of_state) ? n : n > 0 ? n - 1 : 1;
        const struct node *node = &t->old->node[near];
        for (int i = 0; i < width; i++)
            t->density[n * width + i] = source[place(t, node, kind) + i] / node->weight;
    }
}

static void carry(const struct transfer *t, const double *source, double *target, enum kind kind, int width)
{
    take_densities(t, source, kind, width);
    for (int n = 0; n < t->new->nodes; n++) {
        const struct node *node = &t->new->node[n];
        if (!node->collocated)
            continue;
        interpolate(t, node->tau, width);
        for (int i = 0; i < width; i++)
            target[place(t, node, kind) + i] = t->at.stretch * node->weight * t->here[i];
    }
}

// Whether controls at an end, which are no node's, have columns on both meshes.
static bool have_own_controls(const struct transfer *t, int end)
{
    return t->new->u_row[end] != absent && t->old->u_row[end] != absent;
}

static void carry_bounds(const struct transfer *t, const double *source, double *target)
{
    const struct phase *phase = &t->to->transcription->ocp->phase[t->p];
    carry(t, source, target, of_state, phase->nx);
    carry(t, source, target, of_control, phase->nu);
    const size_t state = (size_t)phase->nx * sizeof *target; // at the ends they are no densities
    memcpy(target + t->new->node[0].x, source + t->old->node[0].x, state);
    memcpy(target + t->new->node[t->new->nodes - 1].x, source + t->old->node[t->old->nodes - 1].x, state);
    for (int end = 0; end < 2; end++)
        if (have_own_controls(t, end) || phase->bounds_end_controls)
            memcpy(target + t->new->u_end[end], source + t->old->u_end[end], (size_t)phase->nu * sizeof *target);
    memcpy(target + t->new->q, source + t->old->q, (size_t)phase->nq * sizeof *target);
    if (t->new->t0 != absent) // then in the old, too: a restart may only fix a time
        target[t->new->t0] = source[t->old->t0];
    if (t->new->tf != absent)
        target[t->new->tf] = source[t->old->tf];
}

// The defect of point j has f_j, and of Gauss's last point only the state there, to itself but for the first point's.
static void carry_defects(const struct transfer *t)
{
    const int nx = t->to->transcription->ocp->phase[t->p].nx;
    moray_solution_nodes(t->from, t->p, NULL, t->density);
    for (int k = 0; k < t->new->mesh.intervals; k++) {
        const struct interval *interval = &t->new->interval[k];
        const moray_scheme *scheme = interval->scheme;
        for (int j = 1; j < scheme->points; j++) {
            const int entry = (j - 1) * scheme->points + j;
            const bool collocated = j <= scheme->last;
            const double factor = collocated ? scheme->b[j] / scheme->Q[entry] : 1 / scheme->P[entry];
            double *lambda = t->to->iterate.lambda + interval->defect + (j - 1) * nx;
            interpolate(t, t->new->node[interval->first + j].tau, nx);
            for (int r = 0; r < nx; r++)
                lambda[r] = -factor * t->here[r];
        }
    }
}

static moray_status carry_phase(const moray_guess *guess, moray_solution *to, int p)
{
    const moray_solution *from = guess->from;
    double t0, tf;
    moray_layout_span(&to->transcription->layout, to->transcription->ocp, to->iterate.x, p, &t0, &tf);
    const struct phase *phase = &to->transcription->ocp->phase[p];
    struct transfer t = {moray_align(guess, p, t0, tf),       from, to,  p, &from->transcription->layout.phase[p],
                         &to->transcription->layout.phase[p], NULL, NULL};
    const size_t width = (size_t)(phase->nx + phase->nu + phase->nc);
    t.density = calloc(((size_t)t.old->nodes + 1) * width, sizeof *t.density);
    if (!t.density)
        return moray_error(MORAY_MEMORY, "no memory for the multipliers of phase %s", phase->name);
    t.here = t.density + (size_t)t.old->nodes * width;
    carry_defects(&t);
    carry_bounds(&t, from->iterate.z_lower, to->iterate.z_lower);
    carry_bounds(&t, from->iterate.z_upper, to->iterate.z_upper);
    carry(&t, from->iterate.lambda, to->iterate.lambda, of_path, phase->nc);
    memcpy(to->iterate.lambda + t.new->integral_row, from->iterate.lambda + t.old->integral_row,
           (size_t)phase->nq * sizeof *t.here);
    for (int end = 0; end < 2; end++)
        if (have_own_controls(&t, end))
            memcpy(to->iterate.lambda + t.new->u_row[end], from->iterate.lambda + t.old->u_row[end],
                   (size_t)phase->nu * sizeof *t.here);
    if (t.new->length_row != absent)
        to->iterate.lambda[t.new->length_row] = from->iterate.lambda[t.old->length_row];
    free(t.density);
    return moray_ok();
}

// Of a problem whose times have not become fixed between them.
static bool same_places(const struct layout *one, const struct layout *other)
{
    bool same = one->columns == other->columns;
    for (int p = 0; p < one->phases && same; p++)
        same = moray_mesh_equal(&one->phase[p].mesh, &other->phase[p].mesh);
    return same;
}

moray_status moray_carry_multipliers(const moray_guess *guess, moray_solution *to)
{
    const moray_solution *from = guess->from;
    const struct layout *old = &from->transcription->layout, *new = &to->transcription->layout;
    const moray_ocp *ocp = to->transcription->ocp;
    if (!guess->along_time && same_places(old, new)) {
        memcpy(to->iterate.z_lower, from->iterate.z_lower, (size_t) new->columns * sizeof(double));
        memcpy(to->iterate.z_upper, from->iterate.z_upper, (size_t) new->columns * sizeof(double));
        memcpy(to->iterate.lambda, from->iterate.lambda, (size_t) new->rows * sizeof(double));
        return moray_ok();
    }
    for (int p = 0; p < ocp->phases; p++)
        MORAY_TRY(carry_phase(guess, to, p));
    const size_t parameters = (size_t)ocp->ns * sizeof(double), events = (size_t)(new->rows - new->events);
    memcpy(to->iterate.z_lower + new->s, from->iterate.z_lower + old->s, parameters);
    memcpy(to->iterate.z_upper + new->s, from->iterate.z_upper + old->s, parameters);
    memcpy(to->iterate.lambda + new->events, from->iterate.lambda + old->events, events * sizeof(double));
    return moray_ok();
}
