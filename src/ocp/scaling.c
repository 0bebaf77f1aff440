// SPDX-License-Identifier: MIT
#include "ocp/guess_sizes.h"

#include <math.h>
#include <stdlib.h>

#include "ocp/hold.h"
#include "ocp/observe/sight.h"

static double size_of(moray_bounds bounds, double guess)
{
    const double size = moray_known_size(bounds, guess);
    return size > 0 ? size : 1;
}

// A time is measured from the other end of its phase, not from when clocks began; once a duration was found, by that.
static double size_of_time(moray_bounds bounds, double time, double other, double other_bound, bool found)
{
    if (found && time != other)
        return fabs(time - other);
    const double size = size_of(bounds, fabs(time)), span = fabs(time - other);
    const bool boxed = bounds.lower > -MORAY_INFINITY && bounds.upper < MORAY_INFINITY;
    const double most = boxed ? fmax(fabs(bounds.upper - other_bound), fabs(bounds.lower - other_bound)) : span;
    return most > 0 && most < size ? most : size;
}

// size: scratch for states and controls, and for inputs and outputs.
static void scale_phase(struct transcription *t, int p, const double *x, enum sized_by point, double *size,
                        double *x_scale, double *g_scale)
{
    const bool found = point == by_solution;
    const struct phase *phase = &t->ocp->phase[p];
    const struct phase_layout *layout = &t->layout.phase[p];
    double t0, tf;
    moray_layout_span(&t->layout, t->ocp, x, p, &t0, &tf);
    moray_size_inputs(t, p, x, point, size);
    for (int n = 0; n < layout->nodes; n++)
        for (int r = 0; r < phase->nx + (layout->node[n].collocated ? phase->nu : 0); r++)
            x_scale[layout->node[n].x + r] = 1 / size[r];
    for (int k = 0; k < layout->mesh.intervals; k++) // a defect is an error in its state
        for (int i = 0; i < layout->interval[k].scheme->points - 1; i++)
            for (int r = 0; r < phase->nx; r++)
                g_scale[layout->interval[k].defect + i * phase->nx + r] = 1 / size[r];
    for (int end = 0; end < 2; end++)
        for (int r = 0; r < phase->nu && layout->u_row[end] != absent; r++)
            x_scale[layout->u_end[end] + r] = g_scale[layout->u_row[end] + r] = 1 / size[phase->nx + r];
    const double *in_node = x_scale + layout->node[1].x; // which every scheme collocates
    moray_fill_holds(layout, phase, in_node + phase->nx, g_scale);
    moray_fill_sights(layout, phase, in_node, false, x_scale);
    moray_fill_sights(layout, phase, in_node, true, g_scale);
    for (int m = 0; m < phase->nq; m++) {
        const double here = fabs(x[layout->q + m]);
        const double usual = moray_size_of_integral(t, p, m, found ? 0 : here, size, size + phase->nx + phase->nu);
        x_scale[layout->q + m] = g_scale[layout->integral_row + m] =
            1 / (found && !moray_is_rounding(here, usual) ? here : usual);
    }
    if (layout->t0 != absent)
        x_scale[layout->t0] = 1 / size_of_time(phase->t0, t0, tf, phase->tf.upper, found);
    if (layout->tf != absent)
        x_scale[layout->tf] = 1 / size_of_time(phase->tf, tf, t0, phase->t0.lower, found);
}

// A path constraint that is nowhere steep has one scale along its phase, by the steepest of its rows; another scales
// each row that is steep by itself. Scales are being collected, negative.
static void join_path_rows(const struct transcription *t, double *g_scale)
{
    for (int p = 0; p < t->ocp->phases; p++) {
        const struct phase_layout *layout = &t->layout.phase[p];
        for (int i = 0; i < t->ocp->phase[p].nc; i++) {
            double steepest = 0;
            for (int n = 0; n < layout->nodes; n++)
                if (layout->node[n].collocated)
                    steepest = fmin(steepest, g_scale[layout->node[n].path + i]);
            for (int n = 0; n < layout->nodes; n++)
                if (layout->node[n].collocated)
                    g_scale[layout->node[n].path + i] = fmin(g_scale[layout->node[n].path + i], fmax(steepest, -1));
        }
    }
}

// A row that is not a defect: the largest entry of its gradient in scaled variables becomes 1, in any units.
static void scale_row_groups(const struct transcription *t, const double *jac, const double *x_scale, double *g_scale)
{
    for (int k = 0; k < t->nlp.nnz_jac; k++) {
        const double slope = fabs(jac[k]) / x_scale[t->nlp.jac_col[k]];
        double *scale = &g_scale[t->nlp.jac_row[k]];
        if (*scale <= 0)
            *scale = fmin(*scale, -slope); // negative while being collected
    }
    join_path_rows(t, g_scale);
    for (int i = 0; i < t->nlp.m; i++)
        if (g_scale[i] <= 0)
            g_scale[i] = g_scale[i] < 0 ? -1 / g_scale[i] : 1;
}

static double moray_objective_scale(const struct transcription *t, const double *gradient, const double *x_scale)
{
    double largest = 0;
    for (int j = 0; j < t->nlp.n; j++)
        largest = fmax(largest, fabs(gradient[j]) / x_scale[j]);
    return largest > 0 ? fmin(fmax(1 / largest, 1e-12), 1e12) : 1;
}

// What a phase needs beside its states and controls: a point and its values.
static int scratch_of(const struct transcription *t)
{
    int most = 0;
    for (int p = 0; p < t->ocp->phases; p++) {
        const int needed = 2 * t->phase[p].map->n_in + t->phase[p].map->n_out;
        most = most > needed ? most : needed;
    }
    return most;
}

// One scale for a state or control along its whole phase, so that the transcription's structure survives the scaling;
// rows from the Jacobian at the guess; the objective so that its largest scaled slope is near 1.
moray_status moray_choose_scales(struct transcription *t, const double *x, enum sized_by point)
{
    const int n = t->nlp.n, m = t->nlp.m;
    double *work = calloc((size_t)(n + t->nlp.nnz_jac + scratch_of(t)) + 1, sizeof *work);
    free(t->scale);
    t->scale = calloc((size_t)(n + m) + 1, sizeof *t->scale);
    moray_status status = work && t->scale ? moray_ok() : moray_error(MORAY_MEMORY, "no memory for %d scales", n + m);
    if (!moray_failed(status) && !(t->nlp.jacobian(t, x, true, work + n) && t->nlp.gradient(t, x, false, work)))
        status = moray_error(MORAY_NUMERIC, "at the guess, %s", t->failure.text);
    if (!moray_failed(status)) {
        double *x_scale = t->scale, *g_scale = t->scale + n;
        for (int p = 0; p < t->ocp->phases; p++)
            scale_phase(t, p, x, point, work + n + t->nlp.nnz_jac, x_scale, g_scale);
        for (int i = 0; i < t->ocp->ns; i++)
            x_scale[t->layout.s + i] = 1 / size_of(t->ocp->s[i], fabs(x[t->layout.s + i]));
        scale_row_groups(t, work + n, x_scale, g_scale);
        t->nlp.x_scale = x_scale;
        t->nlp.g_scale = g_scale;
        t->nlp.f_scale = moray_objective_scale(t, work, x_scale);
    }
    free(work);
    return status;
}
