// SPDX-License-Identifier: MIT
//
// How large everything is, by its bounds, by the guess and by what drives it there.
#include "ocp/guess_sizes.h"

#include <math.h>
#include <string.h>

static const double least_size = 1e-11; // that is derived from others, of the largest known: less is what cancelled
enum { trial_nodes = 8 };               // at which integrands are looked at, about
enum { magnitudes = 15 };               // of durations, either way
static const double wide = 1e3;         // a box that large beside the values at its ends is no size
static const double solved = 1e-6;      // part of a size that may be what a solver leaves
static const double noise = 1e-9;       // part of a size that may be rounding
static const double rest = 1e-6;        // of what an integral may come to, its guess where there is nothing to do
static const double small = 1e-8;       // a guess as small as this may be rounding,
static const double digits = 1e-13;     // an end that is asked for only where it is left of 1, as by sin(M_PI)

bool moray_is_rounding(double value, double size)
{
    return !(fabs(value) > noise * size);
}

bool moray_is_far_below(double value, double size)
{
    return value * wide < size && value > solved * size;
}

double moray_known_size(moray_bounds bounds, double guess)
{
    if (bounds.lower > -MORAY_ENDLESS && bounds.upper < MORAY_ENDLESS && bounds.lower < bounds.upper)
        return fmax(-bounds.lower, bounds.upper);
    return guess > small && guess < MORAY_INFINITY ? guess : 0;
}

static double fixed_to(moray_bounds bounds)
{
    return moray_bounds_are_fixed(bounds) ? fabs(bounds.lower) : 0;
}

static bool both_ends_are_fixed(const struct phase *phase, int r)
{
    return moray_bounds_are_fixed(phase->x0[r]) && moray_bounds_are_fixed(phase->xf[r]);
}

// Of a state: that of its box, unless it is fixed at both ends to far less, or was found to be. What an end is fixed to
// is no rounding.
static double size_of_state(const struct phase *phase, int r, double guess, bool found)
{
    const bool asked = fmax(fixed_to(phase->x0[r]), fixed_to(phase->xf[r])) > digits;
    const double alone = asked && guess < MORAY_INFINITY ? guess : moray_known_size(moray_free(), guess);
    const double known = moray_known_size(phase->x[r], guess);
    return known == 0 || (both_ends_are_fixed(phase, r) && guess * wide < known) ? alone
           : found && moray_is_far_below(guess, known)                           ? guess
                                                                                 : known;
}

double moray_largest_in_phase(const struct phase_layout *layout, const double *x, int offset)
{
    double largest = 0;
    for (int n = 0; n < layout->nodes; n++)
        largest = fmax(largest, fabs(x[layout->node[n].x + offset]));
    return largest;
}

// The largest slopes among the nodes at the guess.
static void find_slopes(const struct transcription *t, int p)
{
    const struct phase_cache *cache = &t->phase[p];
    const int nnz = cache->map->jac.nnz;
    memset(cache->slope, 0, (size_t)nnz * sizeof *cache->slope);
    for (int n = 0; n < t->layout.phase[p].nodes; n++)
        for (int k = 0; k < nnz; k++)
            cache->slope[k] = fmax(cache->slope[k], fabs(cache->jac[n * nnz + k]));
}

// How far the input of an entry of the Jacobian, of size 1, moves the entry's state over the phase.
static double reach(const struct phase_cache *cache, int entry)
{
    return cache->slope[entry] * fabs(cache->tf - cache->t0);
}

// How far what is known moves a state over the phase, one cause alone.
static double known_reach(const struct transcription *t, int p, const double *size, int state)
{
    const struct phase_cache *cache = &t->phase[p];
    const int n = t->ocp->phase[p].nx + t->ocp->phase[p].nu, *col = cache->map->jac.col;
    double furthest = 0;
    for (int k = cache->row_start[state]; k < cache->row_start[state + 1]; k++)
        if (col[cache->entry[k]] < n)
            furthest = fmax(furthest, reach(cache, cache->entry[k]) * size[col[cache->entry[k]]]);
    return furthest;
}

// How fast a state moves with itself, over the phase.
static double own_reach(const struct phase_cache *cache, int state)
{
    for (int k = cache->row_start[state]; k < cache->row_start[state + 1]; k++)
        if (cache->map->jac.col[cache->entry[k]] == state)
            return reach(cache, cache->entry[k]);
    return 0;
}

// The size of an input that nothing else tells: for a state what those of known size move it by, else what it takes to
// move a state of known size by that, or by as much as another cause does where they hold each other in check. 0:
// nothing is known.
static double derived_size(const struct transcription *t, int p, const double *size, int i)
{
    const struct phase *phase = &t->ocp->phase[p];
    const struct phase_cache *cache = &t->phase[p];
    const moray_pattern *jac = &cache->map->jac;
    const double by_causes = i < phase->nx ? known_reach(t, p, size, i) : 0;
    double by_effects = INFINITY;
    for (int k = 0; k < jac->nnz && !(by_causes > 0); k++) {
        const int r = jac->row[k];
        if (jac->col[k] == i && r < phase->nx && size[r] > 0 && reach(cache, k) > 0)
            by_effects = fmin(by_effects, fmax(size[r], known_reach(t, p, size, r)) / reach(cache, k));
    }
    return by_causes > 0 ? by_causes : isfinite(by_effects) ? by_effects : 0;
}

static double largest_of(const double *size, int n)
{
    double largest = 1;
    for (int i = 0; i < n; i++)
        largest = fmax(largest, size[i]);
    return largest;
}

// A size far above all others comes from a slope that is rounding, where the guess is at rest or straight, say; one far
// below them is rounding itself, as of what cancels along a body of many links.
static bool is_size(double derived, double largest_known)
{
    return derived > least_size * largest_known && derived < largest_known / noise;
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

// An input moved by its size, as far as its box has room.
static double moved_within(double at, double size, moray_bounds box)
{
    return at + size <= box.upper ? at + size : fmax(at - size, box.lower);
}

// The integrand at a node, at most: as it is, and where each input moves by its size. work[n_in + n_out].
static double largest_integrand(const struct transcription *t, int p, int m, int n, const double *size, double *work)
{
    const struct phase *phase = &t->ocp->phase[p];
    const moray_map *map = t->phase[p].map;
    const double *at = t->phase[p].in + n * map->n_in;
    double *value = work + map->n_in, largest = 0;
    memcpy(work, at, (size_t)map->n_in * sizeof *work);
    for (int j = 0; j <= phase->nx + phase->nu; j++) {
        if (j < phase->nx + phase->nu)
            work[j] = moved_within(at[j], size[j], j < phase->nx ? phase->x[j] : phase->u[j - phase->nx]);
        map->value(map->self, work, value);
        const double here = fabs(value[phase->nx + phase->nc + m]);
        largest = isfinite(here) ? fmax(largest, here) : largest;
        work[j] = at[j];
    }
    return largest;
}

double moray_size_of_integral(const struct transcription *t, int p, int m, double guess, const double *size,
                              double *work)
{
    const double known = moray_known_size(t->ocp->phase[p].q[m], 0);
    double largest = 0;
    if (known > 0)
        return known;
    for (int n = 0; n < t->layout.phase[p].nodes; n += 1 + t->layout.phase[p].nodes / trial_nodes)
        if (t->layout.phase[p].node[n].collocated)
            largest = fmax(largest, largest_integrand(t, p, m, n, size, work));
    largest *= fabs(t->phase[p].tf - t->phase[p].t0);
    if (guess > rest * largest && guess < MORAY_INFINITY)
        return guess;
    return largest > 0 ? largest : 1;
}

static double largest_control(const struct phase_layout *layout, const double *x, int offset)
{
    double largest = 0;
    for (int n = 0; n < layout->nodes; n++)
        if (layout->node[n].collocated)
            largest = fmax(largest, fabs(x[layout->node[n].x + offset]));
    return largest;
}

// What bounds and the guess tell of an input; 0: they do not.
static double known_input(const struct transcription *t, int p, const double *x, bool found, int i)
{
    const struct phase *phase = &t->ocp->phase[p];
    const struct phase_layout *layout = &t->layout.phase[p];
    return i < phase->nx ? size_of_state(phase, i, moray_largest_in_phase(layout, x, i), found)
                         : moray_known_size(phase->u[i - phase->nx], largest_control(layout, x, i));
}

static void know_sizes(const struct transcription *t, int p, const double *x, bool found, double *size)
{
    for (int i = 0; i < t->ocp->phase[p].nx + t->ocp->phase[p].nu; i++)
        size[i] = known_input(t, p, x, found, i);
}

// Whether the guess alone tells how large an input is. A state that is fixed at both ends comes back whatever moves it.
static bool is_guessed(const struct phase *phase, int i)
{
    const moray_bounds bounds = i < phase->nx ? phase->x[i] : phase->u[i - phase->nx];
    return !(moray_known_size(bounds, 0) > 0) && !(i < phase->nx && both_ends_are_fixed(phase, i));
}

// Forgets what the guess tells where causes or effects of known size make it far more: the guess may stay where it
// starts, as a plan does that went straight on. How fast a state goes back on its own keeps it from its causes.
static void doubt_guesses(const struct transcription *t, int p, const double *x, double *size)
{
    const struct phase *phase = &t->ocp->phase[p];
    const int n = phase->nx + phase->nu;
    const double largest_known = largest_of(size, n);
    bool found = true;
    while (found) {
        found = false;
        for (int i = 0; i < n; i++) {
            const double own = i < phase->nx ? own_reach(&t->phase[p], i) : 0;
            const double needed = derived_size(t, p, size, i) / (1 + own);
            if (is_guessed(phase, i) && size[i] * wide < needed && is_size(needed, largest_known)) {
                size[i] = needed; // for what it causes in its turn
                found = true;
            }
        }
    }
    for (int i = 0; i < n; i++)
        size[i] = size[i] == known_input(t, p, x, false, i) ? size[i] : 0;
}

void moray_size_inputs(const struct transcription *t, int p, const double *x, enum sized_by point, double *size)
{
    find_slopes(t, p);
    know_sizes(t, p, x, point == by_solution, size);
    if (point == by_guess)
        doubt_guesses(t, p, x, size);
    derive_sizes(t, p, size);
}

// ---- Durations ----

// How far the dynamics of the guess move a state over the phase, or what is known does.
static double pace(const struct transcription *t, int p, const double *size, int state)
{
    const struct phase_cache *cache = &t->phase[p];
    double largest = 0;
    for (int n = 0; n < t->layout.phase[p].nodes; n++)
        if (t->layout.phase[p].node[n].collocated)
            largest = fmax(largest, fabs(cache->out[n * cache->map->n_out + state]));
    return fmax(largest * (cache->tf - cache->t0), known_reach(t, p, size, state));
}

// What is known, and states by their causes. What it would take to get somewhere is left out: it says nothing of how
// long that may last.
static void size_by_causes(const struct transcription *t, int p, const double *x, double *size)
{
    bool found = true;
    know_sizes(t, p, x, false, size);
    while (found) {
        found = false;
        for (int r = 0; r < t->ocp->phase[p].nx; r++)
            if (!(size[r] > 0) && (size[r] = pace(t, p, size, r)) > 0)
                found = true;
    }
}

// Whether every state that is fixed at both ends can have come from one to the other. none: whether none is.
static bool reaches(const struct transcription *t, int p, const double *size, bool *none)
{
    const struct phase *phase = &t->ocp->phase[p];
    bool reached = true;
    *none = true;
    for (int r = 0; r < phase->nx; r++) {
        const double way = fabs(phase->xf[r].lower - phase->x0[r].lower);
        if (!both_ends_are_fixed(phase, r) || !(way > 0))
            continue;
        *none = false;
        reached = reached && pace(t, p, size, r) >= way;
    }
    return reached;
}

double moray_needed_duration(struct transcription *t, int p, const double *x, double *size)
{
    struct phase_cache *cache = &t->phase[p];
    const double tf = cache->tf;
    double needed = 0;
    bool none = false;
    find_slopes(t, p);
    for (int k = -4 * magnitudes; k <= 4 * magnitudes && needed <= 0 && !none; k++) {
        cache->tf = cache->t0 + pow(10, k / 4.0);
        size_by_causes(t, p, x, size);
        if (reaches(t, p, size, &none) && !none)
            needed = cache->tf - cache->t0;
    }
    cache->tf = tf;
    return needed;
}
