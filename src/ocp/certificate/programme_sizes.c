// SPDX-License-Identifier: MIT
//
// The same sizes for the variables and the constraints of the programme.
#include "ocp/certificate/sizes.h"

#include <string.h>

#include "ocp/hold.h"
#include "ocp/observe/sight.h"
#include "ocp/probe.h"

void moray_witness_columns(const struct witness *e, double *size)
{
    const struct transcription *t = e->solution->transcription;
    for (int p = 0; p < t->ocp->phases; p++) {
        const struct phase *phase = &t->ocp->phase[p];
        const struct phase_layout *layout = moray_witness_layout(e, p);
        for (int n = 0; n < layout->nodes; n++)
            memcpy(size + layout->node[n].x, e->phase[p].size,
                   (size_t)(phase->nx + (layout->node[n].collocated ? phase->nu : 0)) * sizeof *size);
        memcpy(size + layout->q, e->phase[p].integral, (size_t)phase->nq * sizeof *size);
        for (int end = 0; end < 2; end++)
            if (layout->u_row[end] != absent)
                memcpy(size + layout->u_end[end], e->phase[p].size + phase->nx, (size_t)phase->nu * sizeof *size);
        moray_fill_sights(layout, phase, e->phase[p].size, false, size);
        if (layout->t0 != absent)
            size[layout->t0] = e->duration;
        if (layout->tf != absent)
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
        const struct phase_layout *layout = moray_witness_layout(e, p);
        for (int n = 0; n < layout->nodes; n++)
            if (layout->node[n].collocated)
                memcpy(size + layout->node[n].path, e->phase[p].out_size + phase->nx, (size_t)phase->nc * sizeof *size);
        for (int k = 0; k < layout->mesh.intervals; k++)
            for (int i = 0; i < layout->interval[k].scheme->points - 1; i++)
                memcpy(size + layout->interval[k].defect + i * phase->nx, e->phase[p].size,
                       (size_t)phase->nx * sizeof *size);
        memcpy(size + layout->integral_row, e->phase[p].integral, (size_t)phase->nq * sizeof *size);
        for (int end = 0; end < 2; end++)
            if (layout->u_row[end] != absent)
                memcpy(size + layout->u_row[end], e->phase[p].size + phase->nx, (size_t)phase->nu * sizeof *size);
        moray_fill_holds(layout, phase, e->phase[p].size + phase->nx, size);
        moray_fill_sights(layout, phase, e->phase[p].size, true, size);
        if (layout->length_row != absent)
            size[layout->length_row] = e->duration;
    }
    memcpy(size + t->layout.events, e->end_out_size + 1, (size_t)(t->endpoint->n_out - 1) * sizeof *size);
    for (int i = 0; i < t->layout.rows; i++)
        size[i] = size[i] > 0 ? size[i] : 1;
}
