// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdlib.h>

#include "ocp/hold.h"
#include "ocp/solution.h"

static const double least_size = 1e-15; // that is derived from others
static const double noise = 1e-8;       // a guess as small as this may be rounding
static const double endless = 1e15;     // bounds from here on are no sizes

// Size of a quantity: that of its bounds where it has both, else of its guess; 0 where that says nothing.
static double known_size(moray_bounds bounds, double guess)
{
    if (bounds.lower > -endless && bounds.upper < endless && bounds.lower < bounds.upper)
        return fmax(fabs(bounds.lower), fabs(bounds.upper));
    return guess > noise && guess < MORAY_INFINITY ? guess : 0;
}

static double size_of(moray_bounds bounds, double guess)
{
    const double size = known_size(bounds, guess);
    return size > 0 ? size : 1;
}

static double largest_in_phase(const struct phase_layout *layout, const double *x, int offset)
{
    double largest = 0;
    for (int n = 0; n < layout->nodes; n++)
        largest = fmax(largest, fabs(x[layout->node[n].x + offset]));
    return largest;
}

// A time is measured from the other end of its phase, not from when clocks began.
static double size_of_time(moray_bounds bounds, double time, double other, double other_bound)
{
    const double size = size_of(bounds, fabs(time)), span = fabs(time - other);
    const bool boxed = bounds.lower > -MORAY_INFINITY && bounds.upper < MORAY_INFINITY;
    const double most = boxed ? fmax(fabs(bounds.upper - other_bound), fabs(bounds.lower - other_bound)) : span;
    return most > 0 && most < size ? most : size;
}

// How far an input of size 1 moves a state over the phase, by the largest slope among the nodes at the guess.
static double reach(const struct transcription *t, int p, int state, int input)
{
    const struct phase_cache *cache = &t->phase[p];
    const moray_map *map = cache->map;
    double largest = 0;
    for (int k = 0; k < map->jac.nnz; k++)
        if (map->jac.row[k] == state && map->jac.col[k] == input)
            for (int n = 0; n < t->layout.phase[p].nodes; n++)
                largest = fmax(largest, fabs(cache->jac[n * map->jac.nnz + k]));
    return largest * fabs(cache->tf - cache->t0);
}

// How far what is known moves a state over the phase, one cause alone.
static double known_reach(const struct transcription *t, int p, const double *size, int state)
{
    const struct phase *phase = &t->ocp->phase[p];
    double furthest = 0;
    for (int j = 0; j < phase->nx + phase->nu; j++)
        furthest = fmax(furthest, reach(t, p, state, j) * size[j]);
    return furthest;
}

// The size of an input that nothing else tells: for a state what those of known size move it by, else what it takes to
// move a state of known size by that, or by as much as another cause does where they hold each other in check. 0:
// nothing is known.
static double derived_size(const struct transcription *t, int p, const double *size, int i)
{
    const struct phase *phase = &t->ocp->phase[p];
    const double by_causes = i < phase->nx ? known_reach(t, p, size, i) : 0;
    double by_effects = INFINITY;
    for (int r = 0; r < phase->nx; r++)
        if (size[r] > 0 && reach(t, p, r, i) > 0)
            by_effects = fmin(by_effects, fmax(size[r], known_reach(t, p, size, r)) / reach(t, p, r, i));
    return by_causes > 0 ? by_causes : isfinite(by_effects) ? by_effects : 0;
}

static double largest_of(const double *size, int n)
{
    double largest = 1;
    for (int i = 0; i < n; i++)
        largest = fmax(largest, size[i]);
    return largest;
}

// A size far above all others comes from a slope that is rounding: where the guess is at rest or straight, say.
static bool is_size(double derived, double largest_known)
{
    return derived > least_size && derived < largest_known / noise;
}

static void derive_sizes(const struct transcription *t, int p, double *size)
{
    const int n = t->ocp->phase[p].nx + t->ocp->phase[p].nu;
    const double largest_known = largest_of(size, n);
    bool found = true;
    while (found) {
        found = false;
        for (int i = 0; i < n; i++) {
            const double derived = size[i] > 0 ? 0 : derived_size(t, p, size, i);
            if (is_size(derived, largest_known)) {
                size[i] = derived;
                found = true;
            }
        }
    }
    for (int i = 0; i < n; i++)
        size[i] = size[i] > 0 ? size[i] : 1;
}

static double largest_control(const struct phase_layout *layout, const double *x, int offset)
{
    double largest = 0;
    for (int n = 0; n < layout->nodes; n++)
        if (layout->node[n].collocated)
            largest = fmax(largest, fabs(x[layout->node[n].x + offset]));
    return largest;
}

// size: scratch for states and controls.
static void scale_phase(struct transcription *t, int p, const double *x, double *size, double *x_scale, double *g_scale)
{
    const struct phase *phase = &t->ocp->phase[p];
    const struct phase_layout *layout = &t->layout.phase[p];
    double t0, tf;
    moray_layout_span(&t->layout, t->ocp, x, p, &t0, &tf);
    for (int r = 0; r < phase->nx; r++)
        size[r] = known_size(phase->x[r], largest_in_phase(layout, x, r));
    for (int r = phase->nx; r < phase->nx + phase->nu; r++)
        size[r] = known_size(phase->u[r - phase->nx], largest_control(layout, x, r));
    derive_sizes(t, p, size);
    for (int n = 0; n < layout->nodes; n++)
        for (int r = 0; r < phase->nx + (layout->node[n].collocated ? phase->nu : 0); r++)
            x_scale[layout->node[n].x + r] = 1 / size[r];
    for (int k = 0; k < layout->mesh.intervals; k++) // a defect is an error in its state
        for (int i = 0; i < layout->interval[k].scheme->points - 1; i++)
            for (int r = 0; r < phase->nx; r++)
                g_scale[layout->interval[k].defect + i * phase->nx + r] = 1 / size[r];
    for (int end = 0; end < 2; end++)
        for (int r = 0; r < phase->nu && layout->u_row[end] >= 0; r++)
            x_scale[layout->u_end[end] + r] = g_scale[layout->u_row[end] + r] = 1 / size[phase->nx + r];
    moray_fill_holds(layout, phase, x_scale + layout->node[1].x + phase->nx, g_scale); // collocated where any is held
    for (int m = 0; m < phase->nq; m++)
        x_scale[layout->q + m] = g_scale[layout->integral_row + m] = 1 / size_of(phase->q[m], fabs(x[layout->q + m]));
    if (layout->t0 >= 0)
        x_scale[layout->t0] = 1 / size_of_time(phase->t0, t0, tf, phase->tf.upper);
    if (layout->tf >= 0)
        x_scale[layout->tf] = 1 / size_of_time(phase->tf, tf, t0, phase->t0.lower);
}

// A row that is not a defect: the largest entry of its gradient in scaled variables becomes at most 1.
static void scale_row_groups(const struct transcription *t, const double *jac, const double *x_scale, double *g_scale)
{
    for (int k = 0; k < t->nlp.nnz_jac; k++) {
        const double slope = fabs(jac[k]) / x_scale[t->nlp.jac_col[k]];
        double *scale = &g_scale[t->nlp.jac_row[k]];
        if (*scale <= 0)
            *scale = fmin(*scale, -slope); // negative while being collected
    }
    for (int i = 0; i < t->nlp.m; i++)
        if (g_scale[i] <= 0)
            g_scale[i] = g_scale[i] < -1 ? -1 / g_scale[i] : 1;
}

static double moray_objective_scale(const struct transcription *t, const double *gradient, const double *x_scale)
{
    double largest = 0;
    for (int j = 0; j < t->nlp.n; j++)
        largest = fmax(largest, fabs(gradient[j]) / x_scale[j]);
    return largest > 0 ? fmin(fmax(1 / largest, 1e-12), 1e12) : 1;
}

// One scale for a state or control along its whole phase, so that the transcription's structure survives the scaling;
// rows from the Jacobian at the guess; the objective so that its largest scaled slope is near 1.
moray_status moray_choose_scales(struct transcription *t, const double *x)
{
    const int n = t->nlp.n, m = t->nlp.m;
    double *work = calloc((size_t)(2 * n + t->nlp.nnz_jac) + 1, sizeof *work);
    free(t->scale);
    t->scale = calloc((size_t)(n + m) + 1, sizeof *t->scale);
    moray_status status = work && t->scale ? moray_ok() : moray_error(MORAY_MEMORY, "no memory for %d scales", n + m);
    if (!moray_failed(status) && !(t->nlp.jacobian(t, x, true, work + n) && t->nlp.gradient(t, x, false, work)))
        status = moray_error(MORAY_NUMERIC, "at the guess, %s", t->failure.text);
    if (!moray_failed(status)) {
        double *x_scale = t->scale, *g_scale = t->scale + n;
        for (int p = 0; p < t->ocp->phases; p++)
            scale_phase(t, p, x, work + n + t->nlp.nnz_jac, x_scale, g_scale);
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
