// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "ocp/hold.h"
#include "ocp/solution.h"

// Linear interpolation of row-major samples v[n][width] at time.
static void interpolate(const moray_samples *samples, const double *v, int width, double time, double *out)
{
    int k = 0;
    while (k + 2 < samples->n && samples->time[k + 1] < time)
        k++;
    const int next = samples->n > 1 ? k + 1 : k;
    const double span = samples->time[next] - samples->time[k];
    const double part = span > 0 ? fmin(fmax((time - samples->time[k]) / span, 0), 1) : 0;
    for (int i = 0; i < width; i++)
        out[i] = (1 - part) * v[k * width + i] + part * v[next * width + i];
}

static moray_status check_samples(const struct phase *phase, const moray_samples *samples)
{
    if (samples->n < 0 || !samples->time || !samples->x || (phase->nu > 0 && !samples->u))
        return moray_error(MORAY_INPUT, "guess of phase %s: times, states or controls are missing", phase->name);
    for (int k = 0; k < samples->n; k++) {
        bool finite = isfinite(samples->time[k]);
        for (int i = 0; i < phase->nx; i++)
            finite = finite && isfinite(samples->x[k * phase->nx + i]);
        for (int i = 0; i < phase->nu; i++)
            finite = finite && isfinite(samples->u[k * phase->nu + i]);
        if (!finite)
            return moray_error(MORAY_INPUT, "guess of phase %s: sample %d is not finite", phase->name, k);
        if (k > 0 && samples->time[k] < samples->time[k - 1])
            return moray_error(MORAY_INPUT, "guess of phase %s: time %g of sample %d is before the one of sample %d",
                               phase->name, samples->time[k], k, k - 1);
    }
    return moray_ok();
}

static void guess_from_samples(const struct transcription *t, int p, const moray_samples *samples, double *x)
{
    const struct phase *phase = &t->ocp->phase[p];
    const struct phase_layout *layout = &t->layout.phase[p];
    const double first = samples->time[0], last = samples->time[samples->n - 1];
    if (layout->t0 != absent)
        x[layout->t0] = first;
    if (layout->tf != absent)
        x[layout->tf] = last;
    for (int n = 0; n < layout->nodes; n++) {
        const struct node *node = &layout->node[n];
        const double time = first + (last - first) * node->tau;
        interpolate(samples, samples->x, phase->nx, time, x + node->x);
        if (node->collocated)
            interpolate(samples, samples->u, phase->nu, time, x + node->x + phase->nx);
    }
}

static double within(double value, moray_bounds bounds)
{
    return fmin(fmax(value, bounds.lower), bounds.upper);
}

static bool is_boxed(moray_bounds bounds)
{
    return bounds.lower > -MORAY_INFINITY && bounds.upper < MORAY_INFINITY;
}

// The value at one end of a phase; where a limit on one side is all that is known of it, that of the other end.
static double end_value(moray_bounds end, moray_bounds other)
{
    const bool known = end.lower > -MORAY_INFINITY || end.upper < MORAY_INFINITY;
    if (!is_boxed(end) && is_boxed(other))
        return within(moray_bounds_middle(other), end);
    return moray_bounds_middle(known ? end : other);
}

static const double no_length = 1e-3; // of what the bounds leave: less is none

// A phase that may begin at any late time begins where the one before it ends.
static double start_after(const struct transcription *t, int p, const double *x, double otherwise)
{
    if (p == 0 || t->ocp->phase[p].t0.upper < MORAY_ENDLESS)
        return otherwise;
    const int before = t->layout.phase[p - 1].tf;
    return within(before != absent ? x[before] : t->ocp->phase[p - 1].tf.lower, t->ocp->phase[p].t0);
}

// Middles of the bounds; where those leave no length, the phases share what lies between in turn, or where that is
// endless last 1. A duration that has bounds is kept.
static void guess_times(const struct transcription *t, int p, double *x)
{
    const struct phase *phase = &t->ocp->phase[p];
    const struct phase_layout *layout = &t->layout.phase[p];
    const double start = phase->t0.lower, width = phase->tf.upper - start;
    double t0 = start_after(t, p, x, moray_bounds_middle(phase->t0)), tf = moray_bounds_middle(phase->tf);
    if (phase->tf.upper >= MORAY_ENDLESS)
        tf = fmax(phase->tf.lower, t0 + 1);
    else if (tf <= t0 && start <= -MORAY_ENDLESS)
        t0 = within(tf - 1, phase->t0);
    else if (tf - t0 <= no_length * width) {
        t0 = layout->t0 == absent ? start : within(start + width * p / t->ocp->phases, phase->t0);
        tf = layout->tf == absent ? phase->tf.upper : within(start + width * (p + 1) / t->ocp->phases, phase->tf);
    }
    if (phase->has_duration && (tf - t0 < phase->duration.lower || tf - t0 > phase->duration.upper)) {
        const double length = within(moray_bounds_middle(phase->duration), moray_between(0, MORAY_INFINITY));
        tf = within(t0 + length, phase->tf);
        t0 = within(tf - length, phase->t0);
    }
    if (layout->t0 != absent)
        x[layout->t0] = t0;
    if (layout->tf != absent)
        x[layout->tf] = tf;
}

// Straight from x0 to xf by the middles of their bounds; a state known at one end stays as it is there.
static void guess_from_bounds(const struct transcription *t, int p, double *x)
{
    const struct phase *phase = &t->ocp->phase[p];
    const struct phase_layout *layout = &t->layout.phase[p];
    guess_times(t, p, x);
    for (int n = 0; n < layout->nodes; n++) {
        const struct node *node = &layout->node[n];
        for (int r = 0; r < phase->nx; r++)
            x[node->x + r] = (1 - node->tau) * end_value(phase->x0[r], phase->xf[r]) +
                             node->tau * end_value(phase->xf[r], phase->x0[r]);
        for (int r = 0; r < phase->nu && node->collocated; r++)
            x[node->x + phase->nx + r] = moray_bounds_middle(phase->u[r]);
    }
}

// A final time that nothing bounds: as late as the states need to get to where they must.
static moray_status guess_endless_time(struct transcription *t, int p, double *x)
{
    const struct phase *phase = &t->ocp->phase[p];
    const struct phase_layout *layout = &t->layout.phase[p];
    const double t0 = start_after(t, p, x, t->phase[p].t0);
    double *size = calloc((size_t)(phase->nx + phase->nu) + 1, sizeof *size);
    if (!size)
        return moray_error(MORAY_MEMORY, "no memory for the guess of phase %s", phase->name);
    const double needed = moray_needed_duration(t, p, x, size);
    x[layout->tf] = fmax(phase->tf.lower, t0 + (needed > 0 ? needed : t->phase[p].tf - t->phase[p].t0));
    if (layout->t0 != absent)
        x[layout->t0] = t0;
    free(size);
    return moray_ok();
}

static moray_status guess_endless_times(struct transcription *t, const moray_guess *guess, double *x)
{
    for (int p = 0; p < t->ocp->phases; p++) {
        const struct phase *phase = &t->ocp->phase[p];
        const bool sampled = guess && (guess->from || (guess->phase && guess->phase[p].n != 0));
        if (!sampled && t->layout.phase[p].tf != absent && phase->tf.upper >= MORAY_ENDLESS && !phase->has_duration &&
            moray_transcription_jacobians(t, x))
            MORAY_TRY(guess_endless_time(t, p, x));
    }
    return moray_ok();
}

static moray_status check_sizes(const moray_ocp *ocp, const moray_ocp *other)
{
    if (ocp->phases != other->phases || ocp->ns != other->ns)
        return moray_error(MORAY_INPUT, "guess: the solution has %d phases and %d parameters, the problem %d and %d",
                           other->phases, other->ns, ocp->phases, ocp->ns);
    for (int p = 0; p < ocp->phases; p++)
        if (ocp->phase[p].nx != other->phase[p].nx || ocp->phase[p].nu != other->phase[p].nu)
            return moray_error(
                MORAY_INPUT, "guess of phase %s: the solution has %d states and %d controls, the problem %d and %d",
                ocp->phase[p].name, other->phase[p].nx, other->phase[p].nu, ocp->phase[p].nx, ocp->phase[p].nu);
    return moray_ok();
}

struct alignment moray_align(const moray_guess *guess, int p, double t0, double tf)
{
    double from, to;
    moray_solution_times(guess->from, p, &from, &to);
    if (!guess->along_time || !(to > from))
        return (struct alignment){0, 1};
    return (struct alignment){(t0 - from) / (to - from), (tf - t0) / (to - from)};
}

static void guess_from_solution(const struct transcription *t, int p, const moray_guess *guess, double *x)
{
    const moray_solution *from = guess->from;
    const struct phase_layout *layout = &t->layout.phase[p], *old = &from->transcription->layout.phase[p];
    const size_t nodes = (size_t)(layout->q - layout->node[0].x);
    double t0, tf;
    moray_solution_times(from, p, &t0, &tf);
    if (layout->t0 != absent)
        x[layout->t0] = t0;
    if (layout->tf != absent)
        x[layout->tf] = tf;
    if (!guess->along_time && moray_mesh_equal(&old->mesh, &layout->mesh)) {
        memcpy(x + layout->node[0].x, from->iterate.x + old->node[0].x, nodes * sizeof *x);
        return;
    }
    moray_layout_span(&t->layout, t->ocp, x, p, &t0, &tf);
    const struct alignment a = moray_align(guess, p, t0, tf);
    for (int n = 0; n < layout->nodes; n++) {
        const struct node *node = &layout->node[n];
        moray_solution_at_tau(from, p, NULL, fmin(fmax(a.shift + a.stretch * node->tau, 0), 1), x + node->x,
                              node->collocated ? x + node->x + t->ocp->phase[p].nx : NULL);
    }
}

moray_guess moray_guess_from_solution(const moray_solution *solution)
{
    return (moray_guess){.from = solution};
}

// q, the controls at the ends and what moving data see of the guessed trajectory: what makes their definitions hold.
static void guess_defined(const struct transcription *t, const double *g, double *x)
{
    for (int p = 0; p < t->ocp->phases; p++) {
        const struct phase_layout *layout = &t->layout.phase[p];
        for (int m = 0; m < t->ocp->phase[p].nq; m++)
            x[layout->q + m] -= g[layout->integral_row + m];
        for (int end = 0; end < 2; end++)
            for (int r = 0; r < t->ocp->phase[p].nu && layout->u_row[end] != absent; r++)
                x[layout->u_end[end] + r] -= g[layout->u_row[end] + r];
        for (int k = 0; layout->sight && k < t->ocp->phase[p].observed.n; k++)
            for (int r = 0; r < t->ocp->phase[p].nx + t->ocp->phase[p].nu; r++)
                x[layout->sight[k].x + r] -= g[layout->sight[k].row + r];
    }
}

static void clamp(const struct transcription *t, double *x)
{
    for (int j = 0; j < t->layout.columns; j++)
        x[j] = fmin(fmax(x[j], t->nlp.x_lower[j]), t->nlp.x_upper[j]);
}

static moray_status fill_phase(struct transcription *t, int p, const moray_guess *guess, double *x)
{
    const struct phase *phase = &t->ocp->phase[p];
    const struct phase_layout *layout = &t->layout.phase[p];
    memset(x + layout->q, 0, (size_t)phase->nq * sizeof *x);
    if (layout->sight)
        memset(x + layout->sight[0].x, 0, (size_t)(phase->observed.n * (phase->nx + phase->nu)) * sizeof *x);
    for (int end = 0; end < 2; end++)
        for (int r = 0; r < phase->nu && layout->u_row[end] != absent; r++)
            x[layout->u_end[end] + r] = moray_bounds_middle(phase->u[r]);
    if (guess && guess->from) {
        guess_from_solution(t, p, guess, x);
    } else if (guess && guess->phase && guess->phase[p].n != 0) {
        MORAY_TRY(check_samples(phase, &guess->phase[p]));
        guess_from_samples(t, p, &guess->phase[p], x);
    } else {
        guess_from_bounds(t, p, x);
    }
    return moray_ok();
}

static moray_status fill_parameters(const struct transcription *t, const moray_guess *guess, double *x)
{
    const double *s = guess && guess->from ? moray_solution_parameters(guess->from) : guess ? guess->s : NULL;
    for (int i = 0; i < t->ocp->ns; i++) {
        x[t->layout.s + i] = s ? s[i] : moray_bounds_middle(t->ocp->s[i]);
        if (!isfinite(x[t->layout.s + i]))
            return moray_error(MORAY_INPUT, "guess: parameter %d is not finite", i);
    }
    return moray_ok();
}

moray_status moray_fill_guess(struct transcription *t, const moray_guess *guess, double *x)
{
    if (guess && guess->from)
        MORAY_TRY(check_sizes(t->ocp, guess->from->transcription->ocp));
    MORAY_TRY(fill_parameters(t, guess, x));
    for (int p = 0; p < t->ocp->phases; p++)
        MORAY_TRY(fill_phase(t, p, guess, x));
    clamp(t, x);
    for (int p = 0; p < t->ocp->phases; p++)
        moray_guess_holds(t, p, x); // of clamped ones
    MORAY_TRY(guess_endless_times(t, guess, x));
    double *g = calloc((size_t)t->layout.rows + 1, sizeof *g);
    if (!g)
        return moray_error(MORAY_MEMORY, "no memory for %d constraints", t->layout.rows);
    const bool ok = t->nlp.constraints(t, x, true, g);
    if (ok)
        guess_defined(t, g, x);
    clamp(t, x);
    free(g);
    return ok ? moray_ok() : moray_error(MORAY_NUMERIC, "at the guess, %s", t->failure.text);
}
