// SPDX-License-Identifier: MIT
//
// Levenberg and Marquardt within bounds, by single shooting. With the joints known the body has six states whose
// velocities the water damps, so that a run is a mild function of where it starts and a simulation of it needs no
// interior unknowns; and a start, a seed or a candidate of an experiment costs a few dozen simulations.
#include <math.h>
#include <string.h>

#include "moray/dense.h"
#include "moray/parallel.h"
#include "moray/snake/instruments.h"
#include "snake/identify/identify.h"

static const double least_damping = 1e-13, most_damping = 1e9, step_tolerance = 1e-10;

// ---- Steps ---------------------------------------------------------------------------------------------------------

static double scale_of(const moray_identify *v, int column)
{
    return column < v->spec.n ? v->scale[column] : first_scale;
}

static double *entry(const moray_identify *v, moray_estimate *at, int column)
{
    const int n = v->spec.n;
    return column < n ? &at->value[column] : &at->first[(column - n) / FIRST][(column - n) % FIRST];
}

// At a bound that the descent would cross, or not to be varied at all.
static bool is_held(const moray_identify *v, const moray_estimate *at, int column)
{
    if (column >= v->spec.n)
        return !moray_identify_first_varies(v, (column - v->spec.n) % FIRST);
    const double value = at->value[column], slope = v->gradient[column];
    return (value <= v->lower[column] && slope > 0) || (value >= v->upper[column] && slope < 0);
}

static bool damped_step(const moray_identify *v, const moray_estimate *at, double damping)
{
    const int m = v->columns;
    double largest = 0;
    for (int i = 0; i < m; i++)
        largest = fmax(largest, v->normal[i * m + i]);
    memcpy(v->work, v->normal, (size_t)m * (size_t)m * sizeof *v->work);
    for (int i = 0; i < m; i++) {
        const bool held = is_held(v, at, i);
        v->step[i] = held ? 0 : -v->gradient[i];
        v->work[i * m + i] += damping * (v->normal[i * m + i] + 1e-6 * largest) + 1e-300;
        for (int j = 0; j < m && held; j++)
            v->work[i * m + j] = v->work[j * m + i] = i == j;
    }
    return moray_dense_solve(m, v->work, 1, v->step);
}

// The step taken as far as the bounds let; its size in scales.
static double take_step(const moray_identify *v, const moray_estimate *at, moray_estimate *next)
{
    double size = 0;
    *next = *at;
    for (int i = 0; i < v->columns; i++) {
        double *to = entry(v, next, i);
        const double from = *to;
        *to += v->step[i] * scale_of(v, i);
        if (i < v->spec.n)
            *to = fmax(v->lower[i], fmin(v->upper[i], *to));
        size = fmax(size, fabs(*to - from) / scale_of(v, i));
    }
    return size;
}

// Raises the damping until the cost falls. False where it no longer does.
static bool descend(const moray_identify *v, moray_estimate *at, double *damping, double *size)
{
    for (; *damping < most_damping; *damping *= 8) {
        moray_estimate next;
        if (!damped_step(v, at, *damping))
            continue;
        *size = take_step(v, at, &next);
        if (!isfinite(*size))
            continue;
        if (moray_identify_cost(v, &next, &next.cost) && next.cost < at->cost) {
            *at = next;
            *damping = fmax(*damping / 16, least_damping);
            return true;
        }
        if (*size < step_tolerance)
            return false;
    }
    return false;
}

moray_status moray_identify_solve(const moray_identify *v, moray_estimate *at)
{
    double damping = 1e-3, size = INFINITY;
    at->converged = false;
    for (at->iterations = 0; at->iterations < v->spec.max_iterations; at->iterations++) {
        if (!moray_identify_equations(v, at, &at->cost))
            return at->why = moray_error(MORAY_NUMERIC, "the logs cannot be swum with these coefficients");
        const bool fell = descend(v, at, &damping, &size);
        if (!fell || size < step_tolerance) {
            at->converged = true;
            break;
        }
    }
    return at->why = moray_ok();
}

// ---- Several starts ------------------------------------------------------------------------------------------------

void moray_identify_start(const moray_identify *v, unsigned long seed, moray_estimate *at)
{
    unsigned long state = seed;
    *at = (moray_estimate){0};
    moray_unknowns world = v->spec.start;
    for (int k = 0; k < v->spec.n; k++) {
        at->value[k] = *moray_unknown_at(v->unknown[k], &world);
        if (seed == 0)
            continue;
        const double u = moray_random(&state), low = v->lower[k], high = v->upper[k];
        at->value[k] = low > 0 ? low * pow(high / low, u) : low + u * (high - low);
    }
    for (int r = 0; r < v->runs; r++)
        memcpy(at->first[r], v->run[r].guess, sizeof at->first[r]);
}

struct search {
    const moray_identify *of;
};

static void improve(int task, void *result, void *self) // a moray_task_fn
{
    moray_estimate *at = result;
    const struct search *set = self;
    moray_identify_start(set->of, (unsigned long)task, at);
    if (moray_failed(moray_identify_solve(set->of, at)))
        at->cost = INFINITY;
}

static void sort(int n, moray_estimate *at)
{
    for (int i = 1; i < n; i++)
        for (int j = i; j > 0 && at[j].cost < at[j - 1].cost; j--) {
            const moray_estimate kept = at[j];
            at[j] = at[j - 1];
            at[j - 1] = kept;
        }
}

moray_status moray_identify_search(const moray_identify *v, int starts, int jobs, moray_estimate *at)
{
    struct search set = {v};
    MORAY_TRY(moray_parallel(starts, sizeof *at, at, improve, &set, jobs));
    sort(starts, at);
    return isfinite(at[0].cost) ? moray_ok() : at[0].why;
}

moray_unknowns moray_identify_world(const moray_identify *v, const moray_estimate *at)
{
    return moray_identify_world_of(v, at->value);
}
