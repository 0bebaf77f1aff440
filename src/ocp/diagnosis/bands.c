// SPDX-License-Identifier: MIT
#include "ocp/diagnosis/bands.h"

#include <math.h>
#include <stdio.h>

#include "ocp/names.h"

static const double close_to_bound = 1e-5; // scaled

// Every column and row of the programme once, grouped as the user knows them, so that a diagnosis names things and
// times.
void moray_visit_bands(const struct transcription *t, void (*visit)(const struct band *band, void *self), void *self)
{
    const struct layout *layout = &t->layout;
    for (int p = 0; p < layout->phases; p++) {
        const struct phase *phase = &t->ocp->phase[p];
        for (int r = 0; r < phase->nx; r++)
            visit(&(struct band){band_state, false, p, r}, self);
        for (int r = 0; r < phase->nu; r++)
            visit(&(struct band){band_control, false, p, r}, self);
        for (int r = 0; r < phase->nc; r++)
            visit(&(struct band){band_path, true, p, r}, self);
        for (int r = 0; r < phase->nx; r++)
            visit(&(struct band){band_dynamics, true, p, r}, self);
        for (int m = 0; m < phase->nq; m++)
            visit(&(struct band){band_single, true, -1, layout->phase[p].integral_row + m}, self);
        if (layout->phase[p].length_row != absent)
            visit(&(struct band){band_single, true, -1, layout->phase[p].length_row}, self);
        const int next = p + 1 < layout->phases ? layout->phase[p + 1].node[0].x : layout->s;
        for (int j = layout->phase[p].q; j < next; j++)
            visit(&(struct band){band_single, false, -1, j}, self);
    }
    for (int j = layout->s; j < layout->columns; j++)
        visit(&(struct band){band_single, false, -1, j}, self);
    for (int i = layout->events; i < layout->rows; i++)
        visit(&(struct band){band_single, true, -1, i}, self);
}

int moray_band_members(const struct transcription *t, const struct band *band)
{
    return band->kind == band_single ? 1 : t->layout.phase[band->p].nodes;
}

// Column or row of the n-th node of a band, absent where it has none (controls and path constraints stand at collocated
// nodes only, dynamics behind the first).
int moray_band_member(const struct transcription *t, const struct band *band, int n)
{
    if (band->kind == band_single)
        return band->index;
    const struct phase_layout *layout = &t->layout.phase[band->p];
    const int nx = t->ocp->phase[band->p].nx;
    switch (band->kind) {
    case band_state:
        return layout->node[n].x + band->index;
    case band_control:
        return layout->node[n].collocated ? layout->node[n].x + nx + band->index : absent;
    case band_path:
        return layout->node[n].collocated ? layout->node[n].path + band->index : absent;
    default:
        return n > 0 ? layout->interval[0].defect + (n - 1) * nx + band->index : absent;
    }
}

void moray_band_name(const moray_solution *solution, const struct band *band, char *text, int size)
{
    const struct transcription *t = solution->transcription;
    const moray_ocp *ocp = t->ocp;
    char what[100];
    if (band->kind == band_single && band->rows) {
        moray_layout_row_name(&t->layout, ocp, solution->iterate.x, band->index, text, size);
        return;
    }
    if (band->kind == band_single) {
        moray_layout_column_name(&t->layout, ocp, solution->iterate.x, band->index, text, size);
        return;
    }
    const struct phase *phase = &ocp->phase[band->p];
    const int nx = phase->nx;
    if (band->kind == band_path)
        moray_phase_output_name(ocp, band->p, nx + band->index, what, sizeof what);
    else if (band->kind == band_dynamics)
        moray_phase_output_name(ocp, band->p, band->index, what, sizeof what);
    else
        moray_phase_input_name(ocp, band->p, (band->kind == band_state ? 0 : nx) + band->index, what, sizeof what);
    snprintf(text, (size_t)size, "%s of phase %s", what, phase->name);
}

struct standing moray_standing_of(const moray_solution *solution, bool row, int i)
{
    const moray_nlp *nlp = &solution->transcription->nlp;
    const double *scale = row ? nlp->g_scale : nlp->x_scale;
    struct standing s = {.value = row ? solution->iterate.g[i] : solution->iterate.x[i],
                         .lower = row ? nlp->g_lower[i] : nlp->x_lower[i],
                         .upper = row ? nlp->g_upper[i] : nlp->x_upper[i],
                         .scale = scale ? scale[i] : 1};
    s.fixed = s.lower == s.upper;
    s.at_lower = s.lower > -MORAY_INFINITY && s.scale * (s.value - s.lower) < close_to_bound;
    s.at_upper = s.upper < MORAY_INFINITY && s.scale * (s.upper - s.value) < close_to_bound;
    return s;
}
