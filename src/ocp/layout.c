// SPDX-License-Identifier: MIT
#include "ocp/layout.h"

#include <stdlib.h>

#include "ocp/hold.h"
#include "ocp/observe/observed.h"
#include "ocp/observe/sight.h"

static moray_status need_scheme(struct layout *layout, moray_family family, int stages)
{
    if (stages < 1 || stages > MORAY_MAX_STAGES)
        return moray_error(MORAY_INPUT, "stages = %d: must be 1 to %d", stages, MORAY_MAX_STAGES);
    if (layout->scheme[family][stages].points)
        return moray_ok();
    return moray_scheme_new(&layout->scheme[family][stages], family, stages);
}

static moray_status allocate_phase(struct layout *layout, struct phase_layout *phase)
{
    const moray_family family = phase->mesh.method.family;
    phase->nodes = 1;
    for (int k = 0; k < phase->mesh.intervals; k++) {
        MORAY_TRY(need_scheme(layout, family, phase->mesh.stages[k]));
        phase->nodes += layout->scheme[family][phase->mesh.stages[k]].points - 1;
    }
    phase->node = calloc((size_t)phase->nodes, sizeof *phase->node);
    phase->interval = calloc((size_t)phase->mesh.intervals, sizeof *phase->interval);
    if (phase->node && phase->interval)
        return moray_ok();
    return moray_error(MORAY_MEMORY, "no memory for %d nodes", phase->nodes);
}

static void place_points(const struct layout *layout, struct phase_layout *phase)
{
    for (int k = 0, first = 0; k < phase->mesh.intervals; k++) {
        const double left = phase->mesh.edge[k], width = phase->mesh.edge[k + 1] - left;
        const moray_scheme *scheme = &layout->scheme[phase->mesh.method.family][phase->mesh.stages[k]];
        phase->interval[k] = (struct interval){.scheme = scheme, .first = first, .width = width};
        for (int j = 0; j < scheme->points; j++) {
            struct node *node = &phase->node[first + j];
            node->tau = j == scheme->points - 1 ? phase->mesh.edge[k + 1] : left + width * scheme->node[j];
            node->weight += width * scheme->b[j];
            node->collocated |= j >= scheme->first && j <= scheme->last;
        }
        first += scheme->points - 1;
    }
}

const struct interval *moray_layout_end(const struct phase_layout *phase, int end, double *ell)
{
    const struct interval *interval = &phase->interval[end ? phase->mesh.intervals - 1 : 0];
    double integral[MORAY_MAX_STAGES + 2];
    moray_scheme_basis(interval->scheme, end, ell, integral);
    return interval;
}

// The controls at an end are those of the node there; where it has none, columns and rows of their own if asked for.
static void number_end_controls(struct layout *layout, struct phase_layout *phase, const struct phase *p, int end)
{
    const struct node *node = &phase->node[end ? phase->nodes - 1 : 0];
    const bool wanted = p->end_controls || p->bounds_end_controls;
    phase->u_end[end] = phase->u_row[end] = absent;
    if (node->collocated) {
        phase->u_end[end] = node->x + p->nx;
    } else if (wanted) {
        phase->u_end[end] = layout->columns;
        phase->u_row[end] = layout->rows;
        layout->columns += p->nu;
        layout->rows += p->nu;
    }
}

// Columns and rows of a phase in the order of time, which keeps the factorisation's fill low.
static moray_status number_phase(struct layout *layout, struct phase_layout *phase, const struct phase *p)
{
    for (int n = 0; n < phase->nodes; n++) {
        phase->node[n].x = layout->columns;
        layout->columns += p->nx + (phase->node[n].collocated ? p->nu : 0);
        phase->node[n].path = layout->rows;
        layout->rows += phase->node[n].collocated ? p->nc : 0;
    }
    for (int k = 0; k < phase->mesh.intervals; k++) {
        phase->interval[k].defect = layout->rows;
        layout->rows += (phase->interval[k].scheme->points - 1) * p->nx;
    }
    phase->q = layout->columns;
    layout->columns += p->nq;
    phase->integral_row = layout->rows;
    layout->rows += p->nq;
    for (int end = 0; end < 2; end++)
        number_end_controls(layout, phase, p, end);
    phase->hold_row = layout->rows;
    for (int n = 0; n < phase->nodes; n++) {
        phase->node[n].hold = layout->rows;
        layout->rows += phase->node[n].before != absent ? p->n_held : 0;
    }
    phase->t0 = moray_bounds_are_fixed(p->t0) ? absent : layout->columns++;
    phase->tf = moray_bounds_are_fixed(p->tf) ? absent : layout->columns++;
    const bool may_turn = phase->t0 != absent && phase->tf != absent && p->t0.upper > p->tf.lower;
    const bool measured = phase->t0 != absent && phase->tf != absent && p->has_duration;
    phase->length_row = may_turn || measured ? layout->rows++ : absent;
    return moray_place_sights(layout, phase, p);
}

// Numbers columns and rows interval by interval along time, parameters and events last: the order in which bands are
// narrow.
moray_status moray_layout_new(struct layout *layout, const moray_ocp *ocp, const struct mesh *meshes)
{
    *layout = (struct layout){.phases = ocp->phases};
    layout->phase = calloc((size_t)ocp->phases, sizeof *layout->phase);
    moray_status status =
        layout->phase ? moray_ok() : moray_error(MORAY_MEMORY, "no memory for %d phases", ocp->phases);
    for (int p = 0; p < ocp->phases && !moray_failed(status); p++) {
        struct phase_layout *phase = &layout->phase[p];
        status = moray_mesh_copy(&phase->mesh, &meshes[p]);
        if (!moray_failed(status))
            status = moray_cut_at_observations(&phase->mesh, &ocp->phase[p]);
        if (!moray_failed(status))
            status = allocate_phase(layout, phase);
        if (moray_failed(status))
            break;
        place_points(layout, phase);
        status = moray_link_holds(phase, &ocp->phase[p]);
        if (!moray_failed(status))
            status = number_phase(layout, phase, &ocp->phase[p]);
    }
    layout->s = layout->columns;
    layout->columns += ocp->ns;
    layout->events = layout->rows;
    layout->rows += ocp->ne;
    for (int p = 0; p < ocp->phases; p++)
        layout->rows += moray_observed_events(&ocp->phase[p].observed);
    if (moray_failed(status))
        moray_layout_free(layout);
    return status;
}

void moray_layout_free(struct layout *layout)
{
    for (int p = 0; layout->phase && p < layout->phases; p++) {
        moray_mesh_free(&layout->phase[p].mesh);
        free(layout->phase[p].node);
        free(layout->phase[p].interval);
        free(layout->phase[p].sight);
    }
    free(layout->phase);
    for (int family = MORAY_LOBATTO; family <= MORAY_GAUSS; family++)
        for (int s = 0; s <= MORAY_MAX_STAGES; s++)
            moray_scheme_free(&layout->scheme[family][s]);
    *layout = (struct layout){0};
}

void moray_layout_span(const struct layout *layout, const moray_ocp *ocp, const double *x, int p, double *t0,
                       double *tf)
{
    const struct phase_layout *phase = &layout->phase[p];
    *t0 = phase->t0 == absent ? ocp->phase[p].t0.lower : x[phase->t0];
    *tf = phase->tf == absent ? ocp->phase[p].tf.lower : x[phase->tf];
}

double moray_layout_time(const struct layout *layout, const moray_ocp *ocp, const double *x, int p, double tau)
{
    double t0, tf;
    moray_layout_span(layout, ocp, x, p, &t0, &tf);
    return t0 + (tf - t0) * tau;
}
