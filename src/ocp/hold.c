// SPDX-License-Identifier: MIT
#include "ocp/hold.h"

#include <math.h>

static const double same = 1e-9; // distance of edges, in the length of the phase, that are one

bool moray_is_held(const struct phase *phase, int control)
{
    for (int i = 0; i < phase->n_held; i++)
        if (phase->held[i] == control)
            return true;
    return false;
}

static double edge_of(const struct phase *phase, int k)
{
    return phase->mesh ? phase->mesh[k] : (double)k / phase->intervals;
}

bool moray_holds_at(const struct phase *phase, double tau)
{
    for (int k = 0; k <= phase->intervals && phase->n_held > 0; k++)
        if (fabs(edge_of(phase, k) - tau) <= same)
            return true;
    return false;
}

moray_status moray_link_holds(struct phase_layout *layout, const struct phase *phase)
{
    int last = absent, hold = 0;
    for (int n = 0; n < layout->nodes; n++)
        layout->node[n].before = absent;
    if (phase->n_held == 0)
        return moray_ok();
    if (layout->mesh.method.family == MORAY_LOBATTO)
        return moray_error(MORAY_INPUT,
                           "phase %s holds controls, which jump, and this scheme has one control on both sides of an "
                           "edge: the scheme must be radau<s> or gauss<s>",
                           phase->name);
    for (int k = 0; k < layout->mesh.intervals; k++) {
        const struct interval *interval = &layout->interval[k];
        for (int j = interval->scheme->first; j <= interval->scheme->last; j++) {
            layout->node[interval->first + j].before = last;
            last = interval->first + j;
        }
        if (fabs(layout->mesh.edge[k + 1] - edge_of(phase, hold + 1)) <= same)
            hold++, last = absent;
        else if (layout->mesh.edge[k + 1] > edge_of(phase, hold + 1))
            break;
    }
    if (hold == phase->intervals)
        return moray_ok();
    return moray_error(MORAY_INPUT, "phase %s holds controls until %g of its length, where the mesh has no edge",
                       phase->name, edge_of(phase, hold + 1));
}

// Column of the i-th held control at a node.
static int column_of(const struct transcription *t, int p, int n, int i)
{
    const struct phase *phase = &t->ocp->phase[p];
    return t->layout.phase[p].node[n].x + phase->nx + phase->held[i];
}

void moray_assemble_holds(const struct transcription *t, int p, double *g)
{
    const struct phase_layout *layout = &t->layout.phase[p];
    for (int n = 0; n < layout->nodes; n++)
        for (int i = 0; i < t->ocp->phase[p].n_held && layout->node[n].before != absent; i++)
            g[layout->node[n].hold + i] =
                t->x[column_of(t, p, n, i)] - t->x[column_of(t, p, layout->node[n].before, i)];
}

void moray_walk_holds(const struct transcription *t, int p, triplets *out)
{
    const struct phase_layout *layout = &t->layout.phase[p];
    for (int n = 0; n < layout->nodes; n++)
        for (int i = 0; i < t->ocp->phase[p].n_held && layout->node[n].before != absent; i++) {
            triplets_put(out, layout->node[n].hold + i, column_of(t, p, n, i), 1);
            triplets_put(out, layout->node[n].hold + i, column_of(t, p, layout->node[n].before, i), -1);
        }
}

void moray_add_holds(const struct transcription *t, int p, const double *lambda, double *gradient)
{
    const struct phase_layout *layout = &t->layout.phase[p];
    for (int n = 0; n < layout->nodes; n++)
        for (int i = 0; i < t->ocp->phase[p].n_held && layout->node[n].before != absent; i++) {
            gradient[column_of(t, p, n, i)] += lambda[layout->node[n].hold + i];
            gradient[column_of(t, p, layout->node[n].before, i)] -= lambda[layout->node[n].hold + i];
        }
}

void moray_fill_holds(const struct phase_layout *layout, const struct phase *phase, const double *control, double *row)
{
    for (int n = 0; n < layout->nodes; n++)
        for (int i = 0; i < phase->n_held && layout->node[n].before != absent; i++)
            row[layout->node[n].hold + i] = control[phase->held[i]];
}

void moray_guess_holds(const struct transcription *t, int p, double *x)
{
    const struct phase_layout *layout = &t->layout.phase[p];
    for (int n = 0; n < layout->nodes; n++)
        for (int i = 0; i < t->ocp->phase[p].n_held && layout->node[n].before != absent; i++)
            x[column_of(t, p, n, i)] = x[column_of(t, p, layout->node[n].before, i)];
}
